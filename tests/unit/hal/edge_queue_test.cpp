// SPDX-License-Identifier: GPL-3.0-or-later
// The edges of a probe's line: their order, and that none goes missing without a word.
#include "hal/support/edge_queue.h"

#include <gtest/gtest.h>

#include <random>

#include "hal/sim/sim_probe_line.h"

namespace vernier::edge_queue_test {
namespace {

std::string taken(EdgeQueue& queue) {
  std::string all;
  ProbeEdge edge;
  for (HalFault fault; (fault = queue.take(edge)) != HalFault::kNoReading;)
    all += fault == HalFault::kRefused ? "?" : (edge.made ? "+" : "-") + std::to_string(edge.at.count);
  return all;
}

TEST(EdgeQueue, GivesEdgesInTheirOrder) {
  EdgeQueue queue;
  EXPECT_TRUE(queue.empty());
  queue.put({InstantNs(1), true}), queue.put({InstantNs(5), false}), queue.put({InstantNs(7), true});
  EXPECT_EQ(taken(queue), "+1-5+7");
  EXPECT_TRUE(queue.empty());
  EXPECT_EQ(queue.losses(), 0u);
}

TEST(EdgeQueue, TwoTouchesInARowHaveLostALettingGo) {
  EdgeQueue queue;
  queue.put({InstantNs(1), true}), queue.put({InstantNs(5), true}), queue.put({InstantNs(7), false});
  EXPECT_EQ(taken(queue), "+1?+5-7");
  EXPECT_EQ(queue.losses(), 1u);
}

TEST(EdgeQueue, NumberLeftOutIsALoss) {
  EdgeQueue queue;
  queue.put({InstantNs(1), true}, 8), queue.put({InstantNs(2), false}, 9),
      queue.put({InstantNs(5), true}, 12);
  EXPECT_EQ(taken(queue), "+1-2?+5");
  queue.put({InstantNs(6), false}, 13);
  EXPECT_EQ(taken(queue), "-6") << "numbers go on over an empty queue";
  queue.put({InstantNs(7), true}, UINT32_MAX);
  EXPECT_EQ(taken(queue), "?+7");
}

TEST(EdgeQueue, LossIsToldAlsoWhereNoEdgeFollows) {
  EdgeQueue queue;
  queue.put({InstantNs(1), true});
  queue.put_loss();
  EXPECT_FALSE(queue.empty());
  EXPECT_EQ(taken(queue), "+1?");
  queue.put({InstantNs(2), true});
  EXPECT_EQ(taken(queue), "+2") << "after a loss either kind may come";
}

TEST(EdgeQueue, FullQueueKeepsTheOldestAndTellsTheLoss) {
  EdgeQueue queue;
  std::string kept;
  for (int i = 0; i < 300; ++i) {
    queue.put({InstantNs(i), i % 2 == 0});
    if (i < static_cast<int>(EdgeQueue::kRoom)) kept += (i % 2 == 0 ? "+" : "-") + std::to_string(i);
  }
  EXPECT_EQ(queue.room(), 0u);
  EXPECT_EQ(taken(queue), kept + "?");
}

TEST(EdgeQueue, EveryLossInAnySequenceIsTold) {
  constexpr unsigned kSeed = 1;
  RecordProperty("seed", kSeed);
  std::mt19937 random(kSeed);
  EdgeQueue queue;
  bool lost = false;
  std::int64_t expected = 1;
  for (std::uint32_t number = 1; number < 200'000; ++number) {
    lost = random() % 10 == 0;  // an edge that the queue never sees
    if (!lost) queue.put({InstantNs(number), number % 2 == 0}, number);
    if (random() % 4 != 0) continue;
    ProbeEdge edge;
    for (HalFault fault; (fault = queue.take(edge)) != HalFault::kNoReading;) {
      if (fault == HalFault::kRefused) {
        expected = -1;
        continue;
      }
      ASSERT_TRUE(expected < 0 || edge.at.count == expected) << edge.at.count << " follows unsaid";
      ASSERT_EQ(edge.made, edge.at.count % 2 == 0);
      expected = edge.at.count + 1;
    }
  }
  EXPECT_GT(queue.losses(), 10'000u);
}

TEST(SimProbeLine, DeliversWhatWasPutIn) {
  SimProbeLine line(InstantNs(250));
  ProbeLine& probe = line;
  ProbeEdge edge;
  EXPECT_EQ(probe.read_edge(edge), HalFault::kNoReading);
  EXPECT_EQ(probe.resolution(), InstantNs(250));
  line.put(InstantNs(12), true), line.put_loss(), line.put(InstantNs(13), false);
  ASSERT_EQ(probe.read_edge(edge), HalFault::kNone);
  EXPECT_EQ(edge.at, InstantNs(12));
  EXPECT_TRUE(edge.made);
  EXPECT_EQ(probe.read_edge(edge), HalFault::kRefused);
  EXPECT_EQ(edge.at, InstantNs(12)) << "a failed read leaves its result untouched";
  ASSERT_EQ(probe.read_edge(edge), HalFault::kNone);
  EXPECT_FALSE(edge.made);
}

}  // namespace
}  // namespace vernier::edge_queue_test
