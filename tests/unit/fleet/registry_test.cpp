// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/registry/registry.h"

#include <limits>
#include <map>

#include "tests/unit/fleet/databases.h"
#include "tools/registry/cells.h"
#include "tools/registry/due.h"
#include "tools/text/error.h"
#include "tools/text/wall_time.h"

namespace vernier::registry_test {

using namespace vernier::registry;
namespace {

constexpr std::int64_t kDay = 86'400'000'000;

class RegistryTest : public OnBothDatabases {};
INSTANTIATE_TEST_SUITE_P(Fleet, RegistryTest, testing::Values("sqlite", "postgres"), name_of_database);

TEST_P(RegistryTest, KeepsMachinesCalibrationsAndChecks) {
  Registry registry = this->registry();
  const std::string odd = "O-Brien.s_mill";
  registry.put(FleetMachine{odd, "tcp://h", "it's a \"note\" \u00b5; DROP TABLE machine", 7, 5});
  registry.put(FleetMachine{odd, "tcp://g", "other", 0.5, 9});
  ASSERT_EQ(registry.machines().size(), 1u);
  EXPECT_EQ(registry.machine(odd).url, "tcp://g");
  EXPECT_EQ(registry.machine(odd).check_days, 0.5);
  EXPECT_EQ(registry.machine(odd).added_us, 5);
  EXPECT_THROW(registry.machine("none"), text::InputError);

  RecordedCalibration one{odd, "m.xml", "aa", "0123", "d.csv", "bb", "who", "c.csv", "cc", 100};
  registry.put(one);
  one.at_us = 200, one.model = "n.xml";
  registry.put(one);
  ASSERT_EQ(registry.calibrations(odd).size(), 2u);
  EXPECT_EQ(registry.calibrations(odd)[0].model, "n.xml");
  EXPECT_EQ(registry.calibrations("")[1].signed_by, "who");
  one.machine = "nobody has added it", one.at_us = 300;
  EXPECT_EQ(registry.calibrations("other").size(), 0u);

  FleetCheck check{odd, "monday", "valid", "nothing", 1.0440707723548708e268, 100, 1000};
  const std::vector<FleetReading> readings = {{odd, "sxy", "rad", 1000, 1.25e-6, 1e-7}};
  EXPECT_TRUE(registry.put(check, readings));
  EXPECT_FALSE(registry.put(check, readings)) << "a check counts once";
  ASSERT_EQ(registry.checks(odd).size(), 1u);
  EXPECT_EQ(registry.checks(odd)[0].evidence, 1.0440707723548708e268);
  check.label = "tuesday", check.evidence = std::numeric_limits<double>::max();
  EXPECT_TRUE(registry.put(check, {}));
  EXPECT_EQ(registry.checks(odd)[1].evidence, std::numeric_limits<double>::max());
  ASSERT_EQ(registry.readings(0).size(), 1u);
  EXPECT_EQ(registry.readings(0)[0].value, 1.25e-6);
  EXPECT_TRUE(registry.readings(1001).empty());
}

// A registry of an older version: its machine keeps a name that is not allowed now until it gets another one.
TEST_P(RegistryTest, OldNameIsReplacedWithAllEntries) {
  Registry registry = this->registry();
  const std::string old = "O'Brien's \"mill\" \u00b5";
  EXPECT_THROW(registry.put(FleetMachine{old, "", "", 0, 1}), text::InputError);
  registry.put(FleetMachine{"other", "", "", 0, 1});
  registry.database().run(
      "INSERT INTO machine (name, url, note, check_days, added_us) VALUES ($1, 'tcp://h', 'n', 7, 5)", {old});
  registry.put(RecordedCalibration{old, "m.xml", "aa", "0123", "d.csv", "bb", "who", "c.csv", "cc", 100});
  registry.put(FleetCheck{old, "monday", "valid", "", 1, 100, 1000}, {{old, "sxy", "rad", 1000, 1e-6, 1e-7}});
  EXPECT_THROW(registry.give_name(old, "other"), text::InputError);
  EXPECT_THROW(registry.give_name(old, "a b"), text::InputError);
  EXPECT_THROW(registry.give_name("none", "new"), text::InputError);
  EXPECT_EQ(registry.machine(old).url, "tcp://h");
  registry.give_name(old, "mill");
  EXPECT_THROW(registry.machine(old), text::InputError);
  EXPECT_EQ(registry.machine("mill").check_days, 7);
  EXPECT_EQ(registry.machine("mill").added_us, 5);
  EXPECT_EQ(registry.calibrations("mill").size(), 1u);
  EXPECT_EQ(registry.checks("mill").size(), 1u);
  EXPECT_EQ(registry.readings(0).at(0).machine, "mill");
}

TEST_P(RegistryTest, VersionTwoIsConvertedAndItsJobsStay) {
  {
    Registry registry = this->registry();
    registry.put(FleetMachine{"m", "", "", 0, 1});
    registry.database().run("DROP TABLE answer");
    registry.database().run("DROP TABLE not_entered");
    registry.database().run("CREATE TABLE job (batch TEXT NOT NULL)");
    registry.database().run("UPDATE fleet_schema SET version = 2");
  }
  Registry registry = this->registry();
  EXPECT_TRUE(registry.not_entered().empty());
  EXPECT_TRUE(registry.database().run("SELECT * FROM answer").empty());
  EXPECT_TRUE(registry.database().run("SELECT * FROM job").empty());
  EXPECT_EQ(registry.machines().size(), 1u);
}

TEST_P(RegistryTest, SecondProgramFindsTheTables) {
  Registry first = this->registry(), second = this->registry();
  first.put(FleetMachine{"m", "", "", 0, 1});
  EXPECT_EQ(second.machines().size(), 1u);
  first.database().run("UPDATE fleet_schema SET version = 1000");
  EXPECT_THROW(this->registry(), text::InputError);
}

TEST_P(RegistryTest, TransactionThatIsNotCommittedDidNotHappen) {
  Registry registry = this->registry();
  try {
    Transaction transaction(registry.database());
    registry.put(FleetMachine{"m", "", "", 0, 1});
    registry.database().run("INSERT INTO nowhere VALUES (1)");
    transaction.commit();
    FAIL();
  } catch (const DatabaseError&) {
  }
  EXPECT_TRUE(registry.machines().empty());
  registry.put(FleetMachine{"m", "", "", 0, 1});
  EXPECT_EQ(registry.machines().size(), 1u);
}

TEST_P(RegistryTest, SaysWhichMachinesAreDueAndWhy) {
  Registry registry = this->registry();
  const std::int64_t now = 100 * kDay;
  for (const char* name : {"fresh", "late", "never", "changed", "recalibrated", "unasked"})
    registry.put(FleetMachine{name, "", "", std::string(name) == "unasked" ? 0.0 : 7.0, kDay});
  const auto check = [&](const char* machine, std::int64_t day, const char* verdict) {
    registry.put(FleetCheck{machine, "l", verdict, "", 0, 100, day * kDay}, {});
  };
  check("fresh", 99, "valid");
  check("late", 90, "valid");
  check("changed", 99, "changed");
  check("recalibrated", 98, "valid");
  registry.put(RecordedCalibration{"recalibrated", "m", "", "", "", "", "who", "", "", 99 * kDay});
  std::map<std::string, std::string> why;
  for (const DueMachine& one : due_machines(registry, now)) why[one.machine] = one.why;
  EXPECT_EQ(why["fresh"], "");
  EXPECT_EQ(why["late"], "the date of the next check has come");
  EXPECT_EQ(why["never"], "never checked");
  EXPECT_EQ(why["changed"], "the verdict of the last check: changed");
  EXPECT_EQ(why["recalibrated"], "not checked since its calibration");
  EXPECT_EQ(why["unasked"], "");
  EXPECT_EQ(due_machines(registry, now).front().machine, "never") << "the longest overdue comes first";
}

TEST(FleetTime, IsReadAndWrittenInUtc) {
  EXPECT_EQ(text::utc_text(0), "1970-01-01T00:00:00Z");
  EXPECT_EQ(text::parse_utc("2026-11-23T13:05:53Z"), 1795439153000000);
  EXPECT_EQ(text::utc_text(1795439153000000), "2026-11-23T13:05:53Z");
  EXPECT_EQ(text::parse_utc("1970-01-02"), kDay);
  for (const char* none : {"", "yesterday", "2026-13-01", "2026-11-23 13:05 x"})
    EXPECT_FALSE(text::parse_utc(none)) << none;
}

}  // namespace
}  // namespace vernier::registry_test
