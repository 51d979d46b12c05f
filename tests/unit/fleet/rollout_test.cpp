// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fleet/rollout.h"

#include <sys/stat.h>

#include <cstdlib>
#include <memory>
#include <nlohmann/json.hpp>

#include "tests/unit/firmware/daemon_process.h"
#include "tools/text/error.h"

namespace vernier::rollout_test {

using namespace vernier::fleet;
using namespace vernier::registry;
namespace {

TEST(Rollout, StagesAreNumbersOrShares) {
  using Ends = std::vector<std::size_t>;
  EXPECT_EQ(stage_ends("1,10%,50%,100%", 40), (Ends{1, 4, 20, 40}));
  EXPECT_EQ(stage_ends("1,10%,100%", 3), (Ends{1, 3}));
  EXPECT_EQ(stage_ends("2", 5), (Ends{2, 5})) << "the rest is the last stage";
  EXPECT_EQ(stage_ends("100", 5), (Ends{5}));
  for (const char* none : {"", "0", "1,x", "-1", "101%", "1.5"})
    EXPECT_THROW(stage_ends(none, 5), text::InputError) << none;
}

/// Three boards of simulated axes, a registry that knows them, an image for each.
class RolloutTest : public DaemonFolder {
 protected:
  RolloutTest() {
    write_file(directory_ + "/key", secret_key_text(key_));
    ::chmod((directory_ + "/key").c_str(), 0600);
    for (int i = 1; i <= 3; ++i) {
      const std::string name = "m" + std::to_string(i), folder = directory_ + "/" + name;
      std::filesystem::create_directories(folder);
      write_file(folder + "/key.pub", public_key_text(key_));
      write_file(folder + "/board.toml", kBoardText);
      boards_.push_back(std::make_unique<Daemon>(folder));
      std::string text = kSmallMachine;
      text.replace(text.find("0.0001"), 6, "0.0000" + std::to_string(i));
      write_file(directory_ + "/" + name + ".xml", text);
      EXPECT_EQ(vernier("compile " + name + ".xml -o image_" + name), 0) << said();
      EXPECT_EQ(vernier("fleet add " + name + " --registry fleet.db --url tcp://127.0.0.1:" +
                        std::to_string(boards_.back()->port())),
                0)
          << said();
    }
  }
  int vernier(const std::string& words) const {
    const int status = std::system(
        ("cd '" + directory_ + "' && " VERNIER_BIN_DIR "/vernier " + words + " >out.txt 2>&1").c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  std::string said() const { return read_file(directory_ + "/out.txt"); }
  int roll(const std::string& more) const {
    return vernier(
        "fleet rollout spring --registry fleet.db --images 'image_{machine}' --key key --signed-by tester "
        "--stages 1,100% "
        "--watch 0.3 --json states.json " +
        more);
  }
  std::string state(int i) const {
    return nlohmann::json::parse(
        read_file(directory_ + "/states.json"))["machines"][static_cast<std::size_t>(i - 1)]["state"];
  }
  SlotsReply slots(int i) const { return boards_[static_cast<std::size_t>(i - 1)]->client(key_).slots(); }
  std::vector<std::unique_ptr<Daemon>> boards_;
};

TEST_F(RolloutTest, StopsAtTheFirstWorseMachineAndTakesItBack) {
  // GIVEN a judge to whom the second machine is worse
  const std::string judge = "--judge 'test {machine} != m2 || { echo 3 um worse; exit 2; }'";
  // WHEN the images are rolled out
  EXPECT_EQ(roll(judge), 2) << said();
  // THEN the first is kept, the second taken back, the third was never asked
  EXPECT_EQ(state(1) + " " + state(2) + " " + state(3), "kept taken-back waiting") << said();
  EXPECT_NE(said().find("m2: judged worse: 3 um worse"), std::string::npos) << said();
  EXPECT_NE(slots(1).confirmed, kNoSlot);
  EXPECT_EQ(slots(2).confirmed, kNoSlot);
  EXPECT_EQ(slots(2).trial, kNoSlot);
  EXPECT_EQ(slots(3).newest_issued, 0u);
  const std::uint64_t first = slots(1).issued;
  // AND it stands until somebody lets it go on
  EXPECT_EQ(roll(""), 2);
  EXPECT_EQ(slots(3).newest_issued, 0u);
  EXPECT_EQ(roll("--go-on"), 0) << said();
  EXPECT_EQ(state(1) + " " + state(2) + " " + state(3), "kept kept kept");
  EXPECT_EQ(slots(1).issued, first) << "what was kept is left alone";
  EXPECT_NE(slots(3).confirmed_fingerprint, slots(2).confirmed_fingerprint) << "each has its own image";
  EXPECT_EQ(vernier("fleet list --registry fleet.db"), 0);
  EXPECT_NE(said().find("signed by tester"), std::string::npos) << said();
}

TEST_F(RolloutTest, AnInterruptedTrialIsTakenUpAgainAndAnAbsentBoardWaits) {
  // GIVEN an image on trial that somebody left, and a board that is off
  Client board = boards_[0]->client(key_);
  board.upload(upload(3e-5, 5), [](double) {});
  ASSERT_NE(slots(1).trial, kNoSlot);
  boards_[2]->end(SIGKILL);
  // WHEN the images are rolled out
  EXPECT_EQ(roll(""), 2) << said();
  // THEN the board's own image is on it, and the rest waits for the absent one
  EXPECT_EQ(state(1) + " " + state(2) + " " + state(3), "kept kept away") << said();
  EXPECT_EQ(slots(1).trial, kNoSlot);
}

TEST_F(RolloutTest, BadInputAsksNoBoard) {
  EXPECT_EQ(roll("--stages 1,x"), 1);
  std::filesystem::remove_all(directory_ + "/image_m3");
  EXPECT_EQ(roll("--machine m1 --machine m3"), 1);
  EXPECT_EQ(slots(1).newest_issued, 0u);
  EXPECT_EQ(vernier("fleet rollout none --registry fleet.db"), 1);
  EXPECT_EQ(vernier("fleet list"), 1) << "no registry was named";
}

}  // namespace
}  // namespace vernier::rollout_test
