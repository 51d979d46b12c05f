// SPDX-License-Identifier: GPL-3.0-or-later
#include "comp/probing/touch_filter.h"

#include <gtest/gtest.h>

#include <vector>

namespace vernier::touch_filter_test {
namespace {

struct Edge {
  std::int64_t us;
  bool made;
};

// All touches that a sequence of edges gives, asked every millisecond until 10 ms after the last one.
std::vector<Touch> touches_of(const std::vector<Edge>& edges, TouchFilter& filter) {
  std::vector<Touch> out;
  Touch touch;
  std::size_t next = 0;
  for (std::int64_t now = 1000; next < edges.size() || now < edges.back().us + 10'000; now += 1000) {
    for (; next < edges.size() && edges[next].us <= now; ++next)
      if (filter.edge(InstantNs(edges[next].us * 1000), edges[next].made, touch)) out.push_back(touch);
    if (filter.wait(InstantNs(now * 1000), touch)) out.push_back(touch);
  }
  return out;
}

TEST(TouchFilter, TakesTheFirstEdgeOfABouncingContact) {
  TouchFilter filter;
  const auto touches = touches_of({{5000, true},
                                   {5040, false},
                                   {5090, true},
                                   {5200, false},
                                   {5350, true},
                                   {60'000, false},
                                   {60'100, true},
                                   {60'150, false},
                                   {90'000, true},
                                   {120'000, false}},
                                  filter);
  ASSERT_EQ(touches.size(), 2u);
  EXPECT_EQ(touches[0].at, InstantNs(5'000'000));
  EXPECT_EQ(touches[0].bounces, 2);
  EXPECT_EQ(touches[0].kind, TouchKind::kTouch);
  EXPECT_EQ(touches[1].at, InstantNs(90'000'000));
  EXPECT_EQ(filter.counts().touches, 2u);
  EXPECT_EQ(filter.counts().bounces, 6u);
  EXPECT_EQ(filter.counts().missing, 0u);
}

TEST(TouchFilter, CountOfBouncesStopsAtItsLargest) {
  TouchFilter filter;
  std::vector<Edge> edges = {{0, true}};
  for (int i = 1; i <= 600; ++i) edges.push_back({i, i % 2 == 0});
  edges.back().made = true;
  const std::vector<Touch> touches = touches_of(edges, filter);
  ASSERT_EQ(touches.size(), 1u);
  EXPECT_EQ(touches[0].bounces, UINT8_MAX);
}

TEST(TouchFilter, DropsASpikeAndCountsIt) {
  TouchFilter filter;
  EXPECT_TRUE(touches_of({{5000, true}, {5020, false}}, filter).empty());
  EXPECT_EQ(filter.counts().spikes, 1u);
}

TEST(TouchFilter, SaysThatAReleaseWasLost) {
  TouchFilter filter;
  const auto touches = touches_of({{5000, true}, {40'000, true}, {60'000, false}}, filter);
  ASSERT_EQ(touches.size(), 2u);
  EXPECT_EQ(touches[1].at, InstantNs(40'000'000));
  EXPECT_EQ(touches[1].kind, TouchKind::kReleaseMissing);
  EXPECT_EQ(filter.counts().missing, 1u);
}

TEST(TouchFilter, SaysThatATouchWasLost) {
  TouchFilter filter;
  const auto touches = touches_of({{5000, false}, {40'000, true}, {60'000, false}}, filter);
  ASSERT_EQ(touches.size(), 2u);
  EXPECT_EQ(touches[0].kind, TouchKind::kMissed);
  EXPECT_EQ(touches[1].kind, TouchKind::kTouch);
  EXPECT_EQ(filter.counts().missing, 1u);
}

TEST(TouchFilter, ConcludesATouchThatAnEdgeAfterItsSettlingEnds) {
  TouchFilter filter(InstantNs(100'000));  // settles between two ticks
  const auto touches = touches_of({{5000, true}, {5400, false}}, filter);
  ASSERT_EQ(touches.size(), 1u);
  EXPECT_EQ(touches[0].at, InstantNs(5'000'000));
}

TEST(TouchFilter, TakesEveryEdgeAtOnceWithoutASettlingTime) {
  TouchFilter filter(InstantNs(0));
  EXPECT_EQ(touches_of({{5000, true}, {5010, false}, {5020, true}, {5030, false}}, filter).size(), 2u);
}

}  // namespace
}  // namespace vernier::touch_filter_test
