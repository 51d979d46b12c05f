// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fleet/rollout.h"

#include <sys/stat.h>

#include <chrono>
#include <cstdlib>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

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
      EXPECT_EQ(vernier("fleet add " + name + " --registry fleet.db --trust --url " + url(i)), 0) << said();
    }
  }
  int vernier(const std::string& words) const {
    const int status = std::system(
        ("cd '" + directory_ + "' && " VERNIER_BIN_DIR "/vernier " + words + " >out.txt 2>&1").c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  std::string said() const { return read_file(directory_ + "/out.txt"); }
  std::string url(int i) const {
    return "tcp://127.0.0.1:" + std::to_string(boards_[static_cast<std::size_t>(i - 1)]->port());
  }
  /// more: options; --stages and --watch are given here where `more` has none.
  static std::string rollout_words(const std::string& more) {
    std::string words =
        "fleet rollout spring --registry fleet.db --images 'image_{machine}' --key key "
        "--signed-by tester --settle 2 --lease 5 " +
        more;
    if (more.find("--stages") == std::string::npos) words += " --stages 1,100%";
    if (more.find("--watch") == std::string::npos) words += " --watch 0.3";
    return words;
  }
  int roll(const std::string& more) const { return vernier(rollout_words("--json states.json " + more)); }
  /// A call that runs beside this test.
  pid_t roll_beside(const std::string& more) const {
    const pid_t pid = ::fork();
    if (pid != 0) return pid;
    const std::string line = "cd '" + directory_ + "' && exec " VERNIER_BIN_DIR "/vernier " +
                             rollout_words(more) + " >beside.txt 2>&1";
    ::execl("/bin/sh", "sh", "-c", line.c_str(), nullptr);
    ::_exit(127);
  }
  static int ended(pid_t pid) {
    int status = 0;
    ::waitpid(pid, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  nlohmann::json answer() const { return nlohmann::json::parse(read_file(directory_ + "/states.json")); }
  std::string state(int i) const { return answer()["machines"][static_cast<std::size_t>(i - 1)]["state"]; }
  std::string states() const { return state(1) + " " + state(2) + " " + state(3); }
  /// An image is kept and active on a board before the rollout.
  void keep_by_hand(int i) const {
    Client board = boards_[static_cast<std::size_t>(i - 1)]->client(key_);
    board.upload(upload(2e-5, 1), [](double) {});
    board.confirm();
    EXPECT_TRUE(wait_for([&] { return board.newest().mode == Mode::kActive; }));
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
  EXPECT_EQ(states(), "kept taken-back waiting") << said();
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
  EXPECT_EQ(states(), "kept kept kept");
  EXPECT_TRUE(answer()["assurance"]["holds"]) << answer();
  EXPECT_NE(answer()["assurance"]["not_covered"].dump().find("--judge is missing"), std::string::npos)
      << answer();
  EXPECT_EQ(slots(1).issued, first) << "what was kept is left alone";
  EXPECT_NE(slots(3).confirmed_fingerprint, slots(2).confirmed_fingerprint) << "each has its own image";
  EXPECT_EQ(vernier("fleet list --registry fleet.db"), 0);
  EXPECT_NE(said().find("signed by tester"), std::string::npos) << said();
}

TEST_F(RolloutTest, TrialOfSomebodyElseIsNeverGivenUpSilentlyAndAnAbsentBoardWaits) {
  // GIVEN an image on trial that somebody began by hand, and a board that is off
  Client board = boards_[0]->client(key_);
  board.upload(upload(3e-5, 5), [](double) {});
  ASSERT_NE(slots(1).trial, kNoSlot);
  boards_[2]->end(SIGKILL);
  // WHEN the images are rolled out
  EXPECT_EQ(roll(""), 2) << said();
  // THEN the trial runs on, and who called is told
  EXPECT_EQ(states(), "refused waiting waiting") << said();
  EXPECT_NE(said().find("begun by another caller"), std::string::npos) << said();
  EXPECT_EQ(slots(1).newest_issued, 5u);
  EXPECT_NE(slots(1).trial, kNoSlot);
  // AND with the word for that the board's own image is on it, and the rest waits for the absent one
  EXPECT_EQ(roll("--take-over-trial"), 2) << said();
  EXPECT_EQ(states(), "kept kept away") << said();
  EXPECT_EQ(slots(1).trial, kNoSlot);
  EXPECT_FALSE(answer()["assurance"]["holds"]) << answer();
}

TEST_F(RolloutTest, TrialOfACallerThatWasKilledIsTakenUpAgainWhenItsLockEnds) {
  // GIVEN a caller that was killed during the first trial
  const pid_t beside = roll_beside("--watch 20");
  ASSERT_TRUE(wait_for([&] { return slots(1).trial != kNoSlot; }));
  ::kill(beside, SIGKILL);
  ended(beside);
  // THEN its lock holds another caller off, nothing is changed ...
  EXPECT_EQ(roll(""), 2);
  EXPECT_NE(said().find("another call works on this machine"), std::string::npos) << said();
  EXPECT_NE(slots(1).trial, kNoSlot);
  // ... until its lease ends; the trial is then known as the rollout's own.
  std::this_thread::sleep_for(std::chrono::milliseconds(5500));
  EXPECT_EQ(roll(""), 0) << said();
  EXPECT_EQ(states(), "kept kept kept") << said();
}

TEST_F(RolloutTest, OfTwoCallersOneIsRefusedAndNothingIsTakenBack) {
  const pid_t beside = roll_beside("--watch 2 --json first.json");
  ASSERT_TRUE(wait_for([&] { return slots(1).trial != kNoSlot; }));
  EXPECT_EQ(roll(""), 2) << said();
  EXPECT_NE(said().find("m1: another call works on this machine"), std::string::npos) << said();
  // Another rollout of one of the machines is held off as well.
  EXPECT_EQ(
      vernier("fleet rollout autumn --registry fleet.db --images 'image_{machine}' --key key --signed-by x "
              "--machine m3"),
      2)
      << said();
  EXPECT_EQ(ended(beside), 0) << read_file(directory_ + "/beside.txt");
  for (int i = 1; i <= 3; ++i) EXPECT_NE(slots(i).confirmed, kNoSlot) << i;
}

TEST_F(RolloutTest, SwappedAddressesAreNoticedBeforeAnythingIsSent) {
  // GIVEN boards of one name whose addresses were swapped
  ASSERT_EQ(vernier("fleet add m1 --registry fleet.db --url " + url(2)), 0);
  ASSERT_EQ(vernier("fleet add m2 --registry fleet.db --url " + url(1)), 0);
  // WHEN the images are rolled out THEN the key tells it, and no board was touched
  EXPECT_EQ(roll(""), 2) << said();
  EXPECT_EQ(states(), "refused waiting waiting") << said();
  EXPECT_NE(said().find("differs from the expected key"), std::string::npos) << said();
  for (int i = 1; i <= 3; ++i) EXPECT_EQ(slots(i).newest_issued, 0u) << i;
}

TEST_F(RolloutTest, BoardOfAnotherNameIsRefusedAndAnEntryWithoutANameToo) {
  ASSERT_EQ(vernier("fleet add m1 --registry fleet.db --board mill-1"), 0);
  EXPECT_EQ(roll("--machine m1"), 2) << said();
  EXPECT_NE(said().find("the name of this board is test, but mill-1 was expected"), std::string::npos)
      << said();
  EXPECT_EQ(slots(1).newest_issued, 0u);
  ASSERT_EQ(vernier("fleet add m1 --registry fleet.db --board ''"), 0);
  EXPECT_EQ(roll("--machine m1"), 1) << said();
  EXPECT_NE(said().find("has no board name for this machine"), std::string::npos) << said();
}

TEST_F(RolloutTest, KeyThatIsNotEnteredIsTrustedOnFirstUseAndToldSo) {
  ASSERT_EQ(vernier("fleet add m1 --registry fleet.db --board other"), 0);
  ASSERT_EQ(vernier("fleet add m1 --registry fleet.db --board test"), 0);
  EXPECT_EQ(roll("--machine m1"), 0) << said();
  EXPECT_NE(answer()["assurance"]["not_covered"].dump().find("trusted on first use"), std::string::npos);
  ASSERT_EQ(vernier("fleet add m1 --registry fleet.db --url " + url(2)), 0);
  EXPECT_EQ(roll("--machine m1"), 2) << "from then on the key counts";
  EXPECT_EQ(state(1), "not-in-effect") << said();
}

TEST_F(RolloutTest, ImageThatIsNeverInEffectIsNotKept) {
  // GIVEN boards that correct nothing: one was switched off, one has an axis of weight 0, one has a fault
  keep_by_hand(1);
  const std::uint64_t before = slots(1).confirmed_fingerprint;
  Client first = boards_[0]->client(key_);
  first.command(Command::kDeactivate);
  EXPECT_TRUE(wait_for([&] { return first.newest().mode == Mode::kReady; }));
  boards_[1]->client(key_).weight(0, 0);
  EXPECT_TRUE(wait_for([&] { return boards_[1]->client().state().axes[0].weight == 0; }));
  // WHEN images are rolled out to each THEN none is kept, with the reason
  EXPECT_EQ(roll("--machine m1"), 2) << said();
  EXPECT_EQ(state(1), "taken-back") << said();
  EXPECT_NE(said().find("the board is in mode ready, not active"), std::string::npos) << said();
  EXPECT_EQ(slots(1).trial, kNoSlot);
  EXPECT_EQ(slots(1).confirmed_fingerprint, before);
  EXPECT_EQ(
      vernier("fleet rollout second --registry fleet.db --images 'image_{machine}' --key key --signed-by x "
              "--machine m2"),
      2);
  EXPECT_NE(said().find("axis X has the weight 0"), std::string::npos) << said();
  EXPECT_EQ(slots(2).newest_issued, 0u) << "nothing was sent";
}

TEST_F(RolloutTest, ImageThatIsSwitchedOffDuringItsTrialIsTakenBack) {
  const pid_t beside = roll_beside("--machine m1 --watch 5 --json first.json");
  Client board = boards_[0]->client(key_);
  ASSERT_TRUE(wait_for([&] { return board.newest().mode == Mode::kActive; }));
  board.weight(1, 0.5);
  EXPECT_EQ(ended(beside), 2) << read_file(directory_ + "/beside.txt");
  EXPECT_EQ(slots(1).confirmed, kNoSlot);
  EXPECT_EQ(slots(1).trial, kNoSlot);
  EXPECT_NE(read_file(directory_ + "/beside.txt").find("axis Y has the weight 0.5"), std::string::npos);
}

TEST_F(RolloutTest, KeptBoardThatIsAwayOrOffStopsTheRollout) {
  // GIVEN a first board that is killed while the second is judged
  const std::string kill =
      "--judge 'test {machine} != m2 || kill -9 " + std::to_string(boards_[0]->pid()) + "'";
  EXPECT_EQ(roll("--stages 1,2,100% " + kill), 2) << said();
  // THEN the third is not begun, and the first is not called kept
  EXPECT_EQ(states(), "away kept waiting") << said();
  EXPECT_EQ(slots(3).newest_issued, 0u);
  // WHEN the first is back, and the second is switched off THEN that stops it too
  boards_[0] = std::make_unique<Daemon>(directory_ + "/m1");
  ASSERT_EQ(vernier("fleet add m1 --registry fleet.db --url " + url(1)), 0);
  boards_[1]->client(key_).command(Command::kDeactivate);
  EXPECT_EQ(roll("--stages 1,2,100%"), 2) << said();
  EXPECT_EQ(state(2), "not-in-effect") << said();
  EXPECT_EQ(slots(3).newest_issued, 0u);
  // AND on again it goes on to its end.
  boards_[1]->client(key_).command(Command::kActivate);
  EXPECT_EQ(roll("--stages 1,2,100%"), 0) << said();
  EXPECT_EQ(states(), "kept kept kept") << said();
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
