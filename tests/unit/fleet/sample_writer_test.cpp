// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fleet/sample_writer.h"

#include <algorithm>
#include <random>

#include "tests/unit/fleet/databases.h"
#include "tools/registry/cells.h"

namespace vernier::sample_writer_test {

using namespace vernier::fleet;
using namespace vernier::registry;
namespace {

DeviceData sample(const std::string& spool, std::uint64_t number, std::uint64_t after,
                  const std::string& machine = "m", const std::string& fault = "none") {
  DeviceData one{"gateway of " + spool, machine, {}};
  one.payload.metrics = {{"Board/Tick", number, 1000 + number},
                         {"Board/Fault", fault, 1000 + number},
                         {"Axes/X/Position", 0.5 * static_cast<double>(number), 1000 + number},
                         {std::string(kSpoolMetric), spool, 1000 + number},
                         {std::string(kNumberMetric), number, 1000 + number},
                         {std::string(kAfterMetric), after, 1000 + number}};
  return one;
}

class SampleWriterTest : public OnBothDatabases {
 protected:
  /// With the machines that the tests' samples are of.
  Registry registry() const {
    Registry registry = OnBothDatabases::registry();
    for (const char* machine : {"m", "n"}) registry.put(FleetMachine{machine, "", "", 0, 1});
    return registry;
  }
  static std::vector<std::int64_t> numbers(Registry& registry, const std::string& spool) {
    std::vector<std::int64_t> all;
    for (const Row& row :
         registry.database().run("SELECT number FROM sample WHERE spool = $1 ORDER BY number", {spool}))
      all.push_back(whole(row[0]));
    return all;
  }
};
INSTANTIATE_TEST_SUITE_P(Fleet, SampleWriterTest, testing::Values("sqlite", "postgres"), name_of_database);

TEST_P(SampleWriterTest, RepeatedAndMissingRecordsComeOutEachOnce) {
  Registry registry = this->registry();
  SampleWriter writer(registry);
  auto receipts =
      writer.write({sample("a", 1, 0), sample("a", 2, 1), sample("a", 2, 1), sample("b", 1, 0, "n")});
  EXPECT_EQ(receipts["gateway of a"].stored, 2u);
  EXPECT_FALSE(receipts["gateway of a"].resend);
  receipts = writer.write({sample("a", 4, 3)});
  EXPECT_EQ(receipts["gateway of a"].stored, 2u);
  EXPECT_TRUE(receipts["gateway of a"].resend) << "number 3 is missing";
  // A writer that has just been started asks the database.
  SampleWriter other(registry);
  receipts = other.write({sample("a", 1, 0), sample("a", 2, 1), sample("a", 3, 2), sample("a", 4, 3)});
  EXPECT_EQ(receipts["gateway of a"].stored, 4u);
  EXPECT_EQ(numbers(registry, "a"), (std::vector<std::int64_t>{1, 2, 3, 4}));
  EXPECT_EQ(numbers(registry, "b"), (std::vector<std::int64_t>{1}));
  EXPECT_TRUE(registry.database().run("SELECT * FROM loss").empty());
}

TEST_P(SampleWriterTest, SamplesOfAMachineThatNobodyEnteredAreCountedAndNotStored) {
  Registry registry = this->registry();
  SampleWriter writer(registry);
  // GIVEN a store with records of an entered machine and of two others
  auto receipts = writer.write({sample("a", 1, 0), sample("a", 2, 1, "odd 'name'"), sample("a", 3, 2, "late"),
                                sample("a", 4, 3, "late", "position-jump")});
  // THEN the gateway may forget them, and only the entered machine's is stored
  EXPECT_EQ(receipts["gateway of a"].stored, 4u);
  EXPECT_EQ(numbers(registry, "a"), (std::vector<std::int64_t>{1}));
  EXPECT_EQ(registry.machines().size(), 2u);
  EXPECT_EQ(registry.live().size(), 1u);
  EXPECT_TRUE(registry.database().run("SELECT * FROM fault_event").empty());
  ASSERT_EQ(registry.not_entered().size(), 2u);
  EXPECT_EQ(registry.not_entered()[0].machine, "late");
  EXPECT_EQ(registry.not_entered()[0].samples, 2);
  EXPECT_EQ(writer.take_not_entered(), (std::vector<std::string>{"late", "odd 'name'"}));
  EXPECT_TRUE(writer.take_not_entered().empty());
  // WHEN the owner enters one, its samples are stored from then on
  registry.put(FleetMachine{"late", "", "", 0, 1});
  writer.write({sample("a", 5, 4, "late")});
  EXPECT_EQ(numbers(registry, "a"), (std::vector<std::int64_t>{1, 5}));
  EXPECT_TRUE(registry.database().run("SELECT * FROM loss").empty());
  // Names without end take a bounded place.
  std::vector<DeviceData> many;
  for (std::uint64_t n = 6; n < 306; ++n) many.push_back(sample("a", n, n - 1, "x" + std::to_string(n)));
  writer.write(many);
  EXPECT_EQ(registry.not_entered().size(), 101u);
  EXPECT_EQ(registry.not_entered()[0].machine, "");
  EXPECT_EQ(registry.not_entered()[0].samples, 202);
}

TEST_P(SampleWriterTest, WhatAGatewayGaveUpIsWrittenDownAsLost) {
  Registry registry = this->registry();
  SampleWriter writer(registry);
  writer.write({sample("a", 1, 0), sample("a", 5, 1), sample("a", 6, 5)});
  const auto lost = registry.database().run("SELECT after_number, before_number FROM loss");
  ASSERT_EQ(lost.size(), 1u);
  EXPECT_EQ(whole(lost[0][0]), 1);
  EXPECT_EQ(whole(lost[0][1]), 5);
}

TEST_P(SampleWriterTest, TwoWritersAtOnceDoNotDouble) {
  Registry first_registry = this->registry(), second_registry = this->registry();
  SampleWriter first(first_registry), second(second_registry);
  first.write({sample("a", 1, 0)});
  second.write({sample("a", 1, 0), sample("a", 2, 1)});
  // The first still believes that 1 is the last.
  EXPECT_THROW(first.write({sample("a", 2, 1), sample("a", 3, 2)}), DatabaseError);
  const auto receipts = first.write({sample("a", 2, 1), sample("a", 3, 2)});
  EXPECT_EQ(receipts.at("gateway of a").stored, 3u);
  EXPECT_EQ(numbers(first_registry, "a"), (std::vector<std::int64_t>{1, 2, 3}));
}

DeviceData stamped(DeviceData one, std::uint64_t time_ms, bool historical = false) {
  for (Metric& metric : one.payload.metrics) metric.time_ms = time_ms, metric.historical = historical;
  return one;
}

// The gateway's clock was 6 s ahead and was set back: what it says afterwards counts at once.
TEST_P(SampleWriterTest, GatewaysClockThatWasAheadDoesNotFreezeTheState) {
  Registry registry = this->registry();
  SampleWriter writer(registry);
  const auto now_ms = static_cast<std::uint64_t>(registry.database().now_us() / 1000);
  writer.write({stamped(sample("a", 1, 0), now_ms + 6000)});
  const LiveState ahead = registry.live().at(0);
  const LiveAge age = live_age(ahead, registry.database().now_us(), 30);
  EXPECT_TRUE(age.clock_off);
  EXPECT_NEAR(age.clock_s, 6, 2) << "the time that this test takes is in it";
  writer.write({stamped(sample("a", 2, 1, "m", "position-jump"), now_ms + 100)});
  EXPECT_EQ(registry.live().at(0).fault, "position-jump");
  // In one batch, too.
  writer.write({stamped(sample("a", 3, 2), now_ms + 9000),
                stamped(sample("a", 4, 3, "m", "input-missing"), now_ms + 200)});
  EXPECT_EQ(registry.live().at(0).fault, "input-missing");
  EXPECT_FALSE(live_age(registry.live().at(0), registry.database().now_us(), 30).clock_off);
}

// A second gateway takes the board over; its clock is right, the first one's was ahead.
TEST_P(SampleWriterTest, FreshSampleOfAnotherGatewayCountsWhateverTheClocks) {
  Registry registry = this->registry();
  SampleWriter writer(registry);
  writer.write({stamped(sample("a", 1, 0), 9'000'000)});
  writer.write({stamped(sample("b", 1, 0, "m", "position-jump"), 5'000)});
  EXPECT_EQ(registry.live().at(0).fault, "position-jump");
  // What then comes out of the first one's store is of before.
  writer.write({stamped(sample("a", 2, 1), 9'000'001, true)});
  EXPECT_EQ(registry.live().at(0).fault, "position-jump");
  EXPECT_EQ(registry.live().at(0).samples, 3);
}

TEST_P(SampleWriterTest, StateThatIsOldIsStaleAndNotOnline) {
  Registry registry = this->registry();
  SampleWriter writer(registry);
  const auto now_us = registry.database().now_us();
  writer.write({stamped(sample("a", 1, 0), static_cast<std::uint64_t>(now_us / 1000))});
  const LiveState live = registry.live().at(0);
  EXPECT_EQ(live_age(live, live.received_us + 29'000'000, 30).state, LiveAge::State::kOnline);
  EXPECT_EQ(live_age(live, live.received_us + 31'000'000, 30).state, LiveAge::State::kStale);
  writer.write({stamped(sample("a", 2, 1), static_cast<std::uint64_t>(now_us / 1000) - 60'000, true)});
  const LiveState waited = registry.live().at(0);
  EXPECT_EQ(live_age(waited, waited.received_us, 30).state, LiveAge::State::kStale) << "it had waited";
  EXPECT_FALSE(live_age(waited, waited.received_us, 30).clock_off) << "waiting is no clock";
  writer.online("", "m", false);
  EXPECT_EQ(live_age(registry.live().at(0), now_us, 30).state, LiveAge::State::kAway);
}

TEST_P(SampleWriterTest, ShuffledRepeatedDeliveriesEndComplete) {
  Registry registry = this->registry();
  std::mt19937 random(11);
  constexpr std::uint64_t kLast = 60;
  std::uint64_t stored = 0;
  for (int round = 0; round < 400 && stored < kLast; ++round) {
    SampleWriter writer(registry);
    std::vector<DeviceData> some;
    for (std::uint64_t n = stored - std::min<std::uint64_t>(stored, random() % 5) + 1;
         n <= kLast && random() % 8 != 0; ++n)
      if (random() % 10 != 0) some.push_back(sample("a", n, n - 1));
    if (random() % 3 == 0) std::shuffle(some.begin(), some.end(), random);
    for (const auto& [gateway, receipt] : writer.write(some)) stored = receipt.stored;
  }
  EXPECT_EQ(stored, kLast);
  EXPECT_EQ(numbers(registry, "a").size(), kLast);
}

TEST_P(SampleWriterTest, WhatWasForgottenIsNotTakenAgain) {
  Registry registry = this->registry();
  SampleWriter writer(registry);
  writer.write({sample("a", 1, 0), sample("a", 2, 1), sample("a", 3, 2)});
  EXPECT_EQ(registry.forget_samples(1'003'000), 2);  // taken at 1001, 1002 and 1003 ms
  SampleWriter(registry).write({sample("a", 1, 0), sample("a", 2, 1), sample("a", 3, 2), sample("a", 4, 3)});
  EXPECT_EQ(numbers(registry, "a"), (std::vector<std::int64_t>{3, 4}));
}

TEST_P(SampleWriterTest, KeepsTheNewestStateFaultsAndChecks) {
  Registry registry = this->registry();
  SampleWriter writer(registry);
  writer.write(
      {sample("a", 1, 0), sample("a", 2, 1, "m", "position-jump"), sample("a", 3, 2, "m", "position-jump")});
  // Another gateway's store brings an older sample later, which had waited there.
  DeviceData old = sample("b", 1, 0);
  for (Metric& metric : old.payload.metrics) metric.time_ms = 5, metric.historical = true;
  writer.write({old});
  const auto live = registry.live();
  ASSERT_EQ(live.size(), 1u);
  EXPECT_EQ(live[0].fault, "position-jump");
  EXPECT_EQ(live[0].samples, 4);
  EXPECT_EQ(live[0].gateway, "gateway of a");
  EXPECT_TRUE(live[0].online);
  EXPECT_EQ(live[0].values.at(2), std::pair(std::string("Axes/X/Position"), std::string("1.5")));
  EXPECT_EQ(registry.database().run("SELECT * FROM fault_event").size(), 1u) << "one that lasts is one";
  writer.online("gateway of a", "", false);
  EXPECT_FALSE(registry.live()[0].online);

  DeviceData checked = sample("a", 4, 3);
  checked.payload.metrics.push_back({"Check/Time", std::int64_t{77}});
  checked.payload.metrics.push_back({"Check/Verdict", std::string("changed")});
  writer.write({checked});
  DeviceData again = sample("a", 5, 4);
  again.payload.metrics.insert(again.payload.metrics.end(), checked.payload.metrics.end() - 2,
                               checked.payload.metrics.end());
  SampleWriter(registry).write({again});
  ASSERT_EQ(registry.checks("m").size(), 1u);
  EXPECT_EQ(registry.checks("m")[0].verdict, "changed");
}

}  // namespace
}  // namespace vernier::sample_writer_test
