// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fleet/spool.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>

#include "tools/registry/open_database.h"
#include "tools/registry/registry.h"
#include "tools/text/error.h"
#include "tools/text/files.h"

namespace vernier::spool_test {

using namespace vernier::fleet;
using namespace vernier::registry;
namespace {

class SpoolFile : public testing::Test {
 protected:
  SpoolFile() { std::filesystem::create_directories(folder_); }
  ~SpoolFile() override { std::filesystem::remove_all(folder_); }
  static void put(Spool& spool, int count) {
    std::vector<SpoolRecord> records(static_cast<std::size_t>(count),
                                     SpoolRecord{0, "m", 5, std::string("\0\xff'", 3)});
    spool.take(records);
  }
  const std::string folder_ = testing::TempDir() + "spool_" + std::to_string(getpid()) + "_" +
                              testing::UnitTest::GetInstance()->current_test_info()->name();
  const std::string file_ = folder_ + "/store.db";
};

TEST_F(SpoolFile, NumbersGoOnAfterItsGatewayEnds) {
  std::string id;
  {
    Spool spool(file_, "g", 100);
    id = spool.id();
    put(spool, 3);
    EXPECT_EQ(spool.next_birth(), 0u);
  }
  Spool spool(file_, "g", 100);
  EXPECT_EQ(spool.id(), id);
  EXPECT_EQ(spool.next_birth(), 1u);
  put(spool, 1);
  const auto records = spool.after(1, 10);
  ASSERT_EQ(records.size(), 3u);
  EXPECT_EQ(records[0].number, 2u);
  EXPECT_EQ(records[2].number, 4u);
  EXPECT_EQ(records[2].payload, std::string("\0\xff'", 3));
}

TEST_F(SpoolFile, DamagedRecordsAreSetAsideAndTheOthersGoThrough) {
  {
    Spool spool(file_, "g", 100);
    put(spool, 6);
  }
  {
    const auto database = open_database(file_);
    database->run("UPDATE record SET payload = 'zz' WHERE number = 1");
    database->run("UPDATE record SET payload = 'abc' WHERE number = 2");
    database->run("UPDATE record SET time_ms = 'soon' WHERE number = 4");
  }
  Spool spool(file_, "g", 100);
  auto records = spool.after(0, 2);
  ASSERT_FALSE(records.empty()) << "the first two are damaged, the next are asked for";
  EXPECT_EQ(records[0].number, 3u);
  EXPECT_EQ(spool.after(0, 10).size(), 3u);
  EXPECT_EQ(spool.count_aside(), 3u);
  spool.set_aside({5});  // its payload says nothing to the gateway
  records = spool.after(0, 10);
  ASSERT_EQ(records.size(), 2u);
  EXPECT_EQ(records[1].number, 6u);
  const std::string aside = text::read_file(spool.aside());
  EXPECT_EQ(std::count(aside.begin(), aside.end(), '\n'), 4);
  EXPECT_NE(aside.find(R"("time_ms":"soon")"), std::string::npos) << aside;
  EXPECT_NE(aside.find(R"("payload":"zz")"), std::string::npos) << aside;
}

TEST_F(SpoolFile, IsOneGatewaysAndNoOtherProgramsFile) {
  {
    Spool spool(file_, "g", 100);
    EXPECT_THROW(Spool(file_, "g", 100), text::InputError)
        << "a second gateway would number the same samples";
    put(spool, 1);
  }
  EXPECT_NO_THROW(Spool(file_, "g", 100)) << "the first has ended";
  const std::string registry = folder_ + "/registry.db";
  { Registry tables(open_database(registry)); }
  EXPECT_THROW(Spool(registry, "g", 100), text::InputError);
  EXPECT_THROW(Registry(open_database(file_)), text::InputError) << "a store is no registry";
}

TEST_F(SpoolFile, RecordsLeaveWhenTheyAreStored) {
  Spool spool(file_, "g", 100);
  put(spool, 5);
  spool.stored(3);
  spool.stored(2);  // an old answer changes nothing
  put(spool, 1);
  EXPECT_EQ(spool.after(0, 10).front().number, 4u);
  EXPECT_EQ(spool.dropped(), 0u);
}

TEST_F(SpoolFile, WithoutRoomTheOldestGoAndAreCounted) {
  Spool spool(file_, "g", 4);
  put(spool, 3);
  put(spool, 3);
  EXPECT_EQ(spool.after(0, 10).front().number, 3u);
  EXPECT_EQ(spool.after(0, 10).size(), 4u);
  EXPECT_EQ(spool.dropped(), 2u);
  EXPECT_EQ(spool.gone(), 2u);
}

TEST_F(SpoolFile, ACopyForAnotherGatewayGetsAnIdOfItsOwn) {
  std::string id;
  {
    Spool spool(file_, "g", 100);
    id = spool.id();
    put(spool, 4);
    spool.stored(2);
    put(spool, 1);
  }
  Spool spool(file_, "h", 100);
  EXPECT_NE(spool.id(), id);
  EXPECT_EQ(spool.after(0, 10).front().number, 1u);
  EXPECT_EQ(spool.last(), 3u);
  EXPECT_EQ(spool.stored(), 0u);
}

}  // namespace
}  // namespace vernier::spool_test
