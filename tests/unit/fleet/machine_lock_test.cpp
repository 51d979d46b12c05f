// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/registry/machine_lock.h"

#include <chrono>
#include <thread>

#include "tests/unit/fleet/databases.h"
#include "tools/registry/cells.h"
#include "tools/registry/open_database.h"

namespace vernier::machine_lock_test {

using namespace vernier::registry;
namespace {

class MachineLockTest : public OnBothDatabases {};
INSTANTIATE_TEST_SUITE_P(Fleet, MachineLockTest, testing::Values("sqlite", "postgres"), name_of_database);

void pause_s(double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); }

TEST_P(MachineLockTest, SecondCallerIsRefusedAndTakesNothing) {
  Registry first = this->registry(), second = this->registry();
  MachineLocks held(first, {"b", "c"}, "rollout spring", 60);
  try {
    MachineLocks late(second, {"a", "b"}, "rollout autumn", 60);
    FAIL() << "two callers have one machine";
  } catch (const text::LimitNotMet& error) {
    EXPECT_NE(std::string(error.what()).find("b: another call works on this machine (rollout spring"),
              std::string::npos)
        << error.what();
  }
  // All or none: the machine that was free is free still.
  MachineLocks other(second, {"a"}, "rollout autumn", 60);
  EXPECT_NO_THROW(held.require());
}

TEST_P(MachineLockTest, LockIsGivenBackAtTheEnd) {
  Registry first = this->registry(), second = this->registry();
  { MachineLocks held(first, {"a"}, "one", 60); }
  EXPECT_NO_THROW(MachineLocks(second, {"a"}, "two", 60));
}

TEST_P(MachineLockTest, LeaseOfAKilledCallerEndsAndItsHolderIsToldSo) {
  Registry first = this->registry(), second = this->registry();
  // GIVEN a caller that does not renew its lease
  MachineLocks stopped(first, {"a"}, "one", 1);
  EXPECT_THROW(MachineLocks(second, {"a"}, "two", 1), text::LimitNotMet);
  pause_s(1.2);
  // WHEN another takes the machine
  MachineLocks next(second, {"a"}, "two", 60);
  // THEN the first may do nothing more, and its end takes nothing from the second
  EXPECT_THROW(stopped.require(), LockLost);
  EXPECT_NO_THROW(next.require());
}

TEST_P(MachineLockTest, LeaseThatIsRenewedIsHeld) {
  Registry first = this->registry(), second = this->registry();
  MachineLocks held(first, {"a"}, "one", 1);
  for (int i = 0; i < 8; ++i) {
    pause_s(0.25);
    held.renew();
    EXPECT_THROW(MachineLocks(second, {"a"}, "two", 1), text::LimitNotMet) << i;
  }
}

TEST_P(MachineLockTest, OneOfManyCallersHasTheMachine) {
  constexpr int kCallers = 8;
  { Registry made = this->registry(); }
  std::atomic<int> have{0}, refused{0};
  std::vector<std::thread> callers;
  std::atomic<bool> done{false};
  for (int i = 0; i < kCallers; ++i)
    callers.emplace_back([&] {
      Registry mine = this->registry();
      try {
        MachineLocks lock(mine, {"x", "y"}, "race", 60);
        ++have;
        while (!done) pause_s(0.01);
      } catch (const text::LimitNotMet&) {
        ++refused;
      }
    });
  for (int i = 0; i < 2000 && have + refused < kCallers; ++i) pause_s(0.01);
  EXPECT_EQ(have, 1);
  EXPECT_EQ(refused, kCallers - 1);
  done = true;
  for (std::thread& caller : callers) caller.join();
}

// A registry that was made by the version before: its rows stay, and the new columns are there.
TEST_P(MachineLockTest, RegistryOfVersion1IsBroughtUpToDate) {
  {
    const auto database = open_database(place_);
    for (const char* sql :
         {"CREATE TABLE fleet_schema (version BIGINT NOT NULL)", "INSERT INTO fleet_schema VALUES (1)",
          "CREATE TABLE machine (name TEXT PRIMARY KEY, url TEXT NOT NULL, note TEXT NOT NULL, check_days "
          "DOUBLE PRECISION NOT NULL, added_us BIGINT NOT NULL)",
          "INSERT INTO machine VALUES ('m', 'tcp://h', '', 7, 5)",
          "CREATE TABLE shape (id TEXT PRIMARY KEY, names TEXT NOT NULL)",
          "INSERT INTO shape VALUES ('s', '[]')",
          "CREATE TABLE live (machine TEXT PRIMARY KEY, gateway TEXT NOT NULL, online BIGINT NOT NULL, at_us "
          "BIGINT NOT NULL, samples BIGINT NOT NULL, mode TEXT NOT NULL, fault TEXT NOT NULL, image TEXT NOT "
          "NULL, shape TEXT NOT NULL, sample_values TEXT NOT NULL)",
          "INSERT INTO live VALUES ('m', 'g', 1, 5, 1, 'active', 'none', '', 's', '[]')",
          "CREATE TABLE rollout (name TEXT NOT NULL, machine TEXT NOT NULL, stage BIGINT NOT NULL, place "
          "BIGINT NOT NULL, image TEXT NOT NULL, state TEXT NOT NULL, said TEXT NOT NULL, at_us BIGINT NOT "
          "NULL, PRIMARY KEY (name, machine))"})
      database->run(sql);
  }
  Registry registry = this->registry();
  EXPECT_EQ(registry.machine("m").url, "tcp://h");
  EXPECT_EQ(registry.machine("m").board, "");
  ASSERT_EQ(registry.live().size(), 1u);
  EXPECT_EQ(registry.live()[0].received_us, 0);
  EXPECT_EQ(live_age(registry.live()[0], registry.database().now_us(), 1e12).state, LiveAge::State::kStale)
      << "when it was heard is not known";
  EXPECT_NO_THROW(MachineLocks(registry, {"m"}, "one", 60));
  EXPECT_NO_THROW(this->registry()) << "it is brought up to date once";
}

TEST_P(MachineLockTest, KeyOfABoardIsTrustedOnceAndForOneMachine) {
  Registry registry = this->registry();
  registry.put(FleetMachine{"a", "", "", 0, 1, "board-a", ""});
  registry.put(FleetMachine{"b", "", "", 0, 1, "board-b", ""});
  EXPECT_TRUE(registry.trust_board_key("a", "0123"));
  EXPECT_EQ(registry.machine("a").board_key, "0123");
  EXPECT_FALSE(registry.trust_board_key("b", "0123")) << "another machine has it";
  EXPECT_FALSE(registry.trust_board_key("a", "4567")) << "one is entered";
  EXPECT_EQ(registry.machine("a").board_key, "0123");
}

}  // namespace
}  // namespace vernier::machine_lock_test
