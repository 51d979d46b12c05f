// SPDX-License-Identifier: GPL-3.0-or-later
// `vernier upload` and `vernier board` tell nothing to a board that is not the one that was meant.
#include <sys/stat.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "tests/unit/firmware/daemon_process.h"
#include "tools/text/error.h"

namespace vernier::board_claim_test {
namespace {

class BoardClaimTest : public DaemonFolder {
 protected:
  BoardClaimTest() {
    write_file(directory_ + "/key", secret_key_text(key_));
    ::chmod((directory_ + "/key").c_str(), 0600);
    std::string machine = kSmallMachine;
    machine.replace(machine.find("0.0001"), 6, "0.00001");
    write_file(directory_ + "/small.xml", machine);
    daemon_ = std::make_unique<Daemon>(directory_);
    to_ = " --to tcp://127.0.0.1:" + std::to_string(daemon_->port()) + " --key key ";
  }
  int vernier(const std::string& words) const {
    const int status = std::system(
        ("cd '" + directory_ + "' && " VERNIER_BIN_DIR "/vernier " + words + " >out.txt 2>&1").c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  /// The board runs an image, so that it takes commands.
  void make_active() const {
    Client board = daemon_->client(key_);
    board.upload(upload(2e-5, 1), [](double) {});
    board.confirm();
    EXPECT_TRUE(wait_for([&] { return board.newest().mode == Mode::kActive; }));
  }
  std::string said() const { return read_file(directory_ + "/out.txt"); }
  nlohmann::json answer() const { return nlohmann::json::parse(read_file(directory_ + "/answer.json")); }
  std::string key_of_board() const {
    return board_key_text(daemon_->client().proved_key().value_or(BoardPublicKey{}));
  }
  std::unique_ptr<Daemon> daemon_;
  std::string to_;
};

TEST_F(BoardClaimTest, NothingIsConfirmedOrGivenUpOnAnotherBoard) {
  daemon_->client(key_).upload(upload(2e-5, 1), [](double) {});
  for (const char* action : {"--confirm", "--revert"}) {
    EXPECT_EQ(vernier("upload " + std::string(action) + to_ + "--board mill-1"), 2) << said();
    EXPECT_NE(said().find("the name of this board is test, but mill-1 was expected; nothing was sent"),
              std::string::npos)
        << said();
    EXPECT_NE(daemon_->client().slots().trial, kNoSlot) << "the trial runs on";
    EXPECT_EQ(daemon_->client().slots().confirmed, kNoSlot);
  }
  EXPECT_EQ(vernier("upload --confirm" + to_ + "--board test --json answer.json"), 0) << said();
  EXPECT_EQ(answer()["board"], "test");
  EXPECT_TRUE(answer()["assurance"]["holds"]) << answer();
  EXPECT_EQ(daemon_->client().slots().issued, 1u);
}

TEST_F(BoardClaimTest, NothingIsUploadedToAnotherBoard) {
  ASSERT_EQ(vernier("compile small.xml -o image"), 0) << said();
  EXPECT_EQ(vernier("upload image" + to_ + "--board mill-1"), 2) << said();
  EXPECT_EQ(daemon_->client().slots().newest_issued, 0u);
  EXPECT_EQ(vernier("upload image" + to_ + "--json answer.json"), 0) << said();
  EXPECT_NE(answer()["assurance"]["not_covered"].dump().find("no --board was given"), std::string::npos);
}

TEST_F(BoardClaimTest, NothingIsToldToAnotherBoard) {
  make_active();
  for (const char* action :
       {"activate", "deactivate", "clear", "hold", "release", "weight --axis X --weight 0"}) {
    const std::uint64_t refused = daemon_->client().health().refused_commands;
    EXPECT_EQ(vernier("board " + std::string(action) + to_ + "--board mill-1"), 2) << action << said();
    EXPECT_NE(said().find("nothing was sent"), std::string::npos) << said();
    EXPECT_FALSE(daemon_->client().newest().holding);
    EXPECT_EQ(daemon_->client().state().axes[0].weight, 1);
    EXPECT_EQ(daemon_->client().health().refused_commands, refused);
  }
  EXPECT_EQ(vernier("board hold" + to_ + "--board test"), 0) << said();
}

TEST_F(BoardClaimTest, KeyIsProvedByTheBoardThatHasIt) {
  make_active();
  ASSERT_EQ(vernier("board identify" + to_ + "--json answer.json"), 0) << said();
  EXPECT_EQ(answer()["board_key"], key_of_board());
  EXPECT_EQ(vernier("board hold" + to_ + "--board test --board-key " + key_of_board()), 0) << said();
  EXPECT_EQ(vernier("board release" + to_ + "--board test --board-key store/identity.pub"), 0) << said();
  EXPECT_EQ(vernier("board hold" + to_ + "--board test --board-key " + std::string(64, 'a')), 2) << said();
  EXPECT_NE(said().find("differs from the expected key"), std::string::npos) << said();
  EXPECT_FALSE(daemon_->client().newest().holding);
  EXPECT_EQ(vernier("board hold" + to_ + "--board-key 0123"), 1) << said();
}

TEST_F(BoardClaimTest, BoardThatWasStartedAgainProvesItselfAgainAndAnotherKeyIsNoticed) {
  const auto key = daemon_->client().proved_key();
  ASSERT_TRUE(key.has_value());
  daemon_->end(SIGKILL);
  daemon_ = std::make_unique<Daemon>(directory_);
  EXPECT_EQ(daemon_->client().proved_key(), key) << "the key outlives a start";
  daemon_->end(SIGKILL);
  // Another board in its place, with the same name.
  std::filesystem::remove(directory_ + "/store/identity.key");
  daemon_ = std::make_unique<Daemon>(directory_);
  Client client = daemon_->client(key_);
  EXPECT_NO_THROW(client.require_board({"test", std::nullopt}));
  EXPECT_THROW(client.require_board({"test", key}), LimitNotMet);
  EXPECT_THROW(client.require_board({"tset", std::nullopt}), LimitNotMet);
}

TEST_F(BoardClaimTest, KeyThatOthersMayReadProvesNothing) {
  ASSERT_TRUE(daemon_->client().proved_key().has_value()) << "the key is made before the links answer";
  daemon_->end(SIGKILL);
  ASSERT_EQ(::chmod((directory_ + "/store/identity.key").c_str(), 0644), 0);
  daemon_ = std::make_unique<Daemon>(directory_);
  Client client = daemon_->client(key_);
  EXPECT_NE(daemon_->log().find("cannot prove its identity"), std::string::npos) << daemon_->log();
  EXPECT_FALSE(client.proved_key().has_value());
  EXPECT_THROW(client.require_board({"test", BoardPublicKey{}}), LimitNotMet);
}

TEST_F(BoardClaimTest, SecretHalfIsForItsOwnerAlone) {
  struct stat info {};
  ASSERT_TRUE(daemon_->client().proved_key().has_value());
  ASSERT_EQ(::stat((directory_ + "/store/identity.key").c_str(), &info), 0);
  EXPECT_EQ(info.st_mode & 0777u, 0600u);
}

}  // namespace
}  // namespace vernier::board_claim_test
