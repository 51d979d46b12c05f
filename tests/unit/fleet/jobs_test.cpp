// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/registry/jobs.h"

#include <atomic>
#include <fstream>
#include <set>
#include <thread>

#include "tests/unit/fleet/databases.h"
#include "tools/registry/shell_command.h"
#include "tools/text/files.h"

namespace vernier::jobs_test {

using namespace vernier::registry;
namespace {

class JobsTest : public OnBothDatabases {};
INSTANTIATE_TEST_SUITE_P(Fleet, JobsTest, testing::Values("sqlite", "postgres"), name_of_database);

TEST_P(JobsTest, AMachineHasOneJobInABatch) {
  Registry registry = this->registry();
  JobQueue queue(registry);
  EXPECT_EQ(queue.add("night", "echo {machine}", {"a", "b"}), 2);
  EXPECT_EQ(queue.add("night", "rm {machine}", {"b", "c"}), 1);
  EXPECT_EQ(queue.add("other", "true", {"a"}), 1);
  EXPECT_EQ(queue.jobs("night")[1].command, "echo 'b'");
}

TEST_P(JobsTest, AJobWhoseWorkerIsGoneIsTakenAgainAndAnswersOnce) {
  Registry registry = this->registry();
  JobQueue queue(registry);
  queue.add("night", "true", {"a"});
  const auto lost = queue.take("night", "first", -1, 3);  // its lease has run out at once
  ASSERT_TRUE(lost.has_value());
  const auto taken = queue.take("night", "second", 60, 3);
  ASSERT_TRUE(taken.has_value());
  EXPECT_EQ(taken->attempt, 2);
  EXPECT_FALSE(queue.take("night", "third", 60, 3).has_value());
  EXPECT_FALSE(queue.finish(*lost, 0, "late")) << "it is not the first worker's any more";
  EXPECT_FALSE(queue.renew(*lost, 60));
  EXPECT_TRUE(queue.renew(*taken, 60));
  EXPECT_TRUE(queue.finish(*taken, 0, "right"));
  EXPECT_FALSE(queue.finish(*taken, 0, "twice"));
  EXPECT_EQ(queue.jobs("night")[0].said, "right");
  EXPECT_FALSE(queue.is_open("night"));
}

TEST_P(JobsTest, AJobThatTakesItsWorkersWithItFails) {
  Registry registry = this->registry();
  JobQueue queue(registry);
  queue.add("night", "true", {"a"});
  for (int i = 0; i < 2; ++i) EXPECT_TRUE(queue.take("night", "w", -1, 2).has_value());
  EXPECT_FALSE(queue.take("night", "w", -1, 2).has_value());
  EXPECT_EQ(queue.counts("night").failed, 1);
  EXPECT_EQ(queue.again("night"), 1);
  EXPECT_TRUE(queue.take("night", "w", 60, 2).has_value());
}

TEST_P(JobsTest, FourWorkersDoEachJobOnce) {
  Registry registry = this->registry();
  JobQueue queue(registry);
  std::vector<std::string> machines;
  for (int i = 0; i < 40; ++i) machines.push_back("it's " + std::to_string(i));
  queue.add("night", "printf '%s\\n' {machine} >>'" + folder_ + "/done'; test {machine} != \"it's 7\"",
            machines);
  std::vector<std::thread> workers;
  std::atomic<bool> stop{false};
  std::atomic<std::int64_t> done{0};
  for (int i = 0; i < 4; ++i)
    workers.emplace_back([&, i] {
      done +=
          work({place_, "night", "w" + std::to_string(i), 60, 3}, stop, [](const Job&, const JobCounts&) {});
    });
  for (std::thread& worker : workers) worker.join();
  EXPECT_EQ(done, 40);
  std::ifstream file(folder_ + "/done");
  std::multiset<std::string> ran;
  for (std::string line; std::getline(file, line);) ran.insert(line);
  EXPECT_EQ(ran.size(), 40u);
  EXPECT_EQ(std::set<std::string>(ran.begin(), ran.end()).size(), 40u);
  EXPECT_EQ(queue.counts("night").failed, 1);
}

TEST(ShellCommands, SayHowTheyEndedAndTheirLastLine) {
  ShellCommand good("echo one; echo two; echo");
  EXPECT_TRUE(good.wait(std::chrono::seconds(20)));
  EXPECT_EQ(good.status(), 0);
  EXPECT_EQ(good.last_line(), "two");
  ShellCommand bad("head -c 100000 /dev/zero; echo; echo why >&2; exit 3");
  EXPECT_TRUE(bad.wait(std::chrono::seconds(20)));
  EXPECT_EQ(bad.status(), 3);
  EXPECT_EQ(bad.last_line(), "why");
  ShellCommand killed("kill -9 $$");
  EXPECT_TRUE(killed.wait(std::chrono::seconds(20)));
  EXPECT_EQ(killed.status(), 137);
  ShellCommand slow("sleep 1000");
  EXPECT_FALSE(slow.wait(std::chrono::milliseconds(50)));
  slow.end();
  EXPECT_TRUE(slow.ended());
}

}  // namespace
}  // namespace vernier::jobs_test
