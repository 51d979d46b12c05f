// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fleet/sparkplug.h"

#include <gtest/gtest.h>

#include <random>

namespace vernier::sparkplug_test {

using namespace vernier::fleet;
namespace {

TEST(Sparkplug, PayloadComesBackAsItWas) {
  SparkplugPayload payload;
  payload.time_ms = 1'700'000'000'123;
  payload.seq = 255;
  payload.metrics = {{"a", 1.5, 1'700'000'000'000},
                     {"b", std::int64_t{-3}, 1, true},
                     {"c", UINT64_MAX, 2},
                     {"d", true, 3},
                     {"e", std::string("\u00b5 \u20ac \U0001F9ED x"), 4}};
  const auto back = decode(encode(payload));
  ASSERT_TRUE(back.has_value());
  EXPECT_EQ(back->time_ms, payload.time_ms);
  EXPECT_EQ(back->seq, payload.seq);
  EXPECT_EQ(back->metrics, payload.metrics);
}

TEST(Sparkplug, WhatIsNoTextIsLeftOut) {
  for (const std::string& none :
       {std::string("a\0b", 3), std::string("\xff"), std::string("\xc0\x80"), std::string("\xed\xa0\x80"),
        std::string("\xe2\x82"), std::string("\xf5\x80\x80\x80"), std::string("\xc3x")}) {
    SparkplugPayload payload;
    payload.metrics = {{"good", none}, {none, 1.0}, {"kept", 2.0}};
    const auto read = decode(encode(payload));
    ASSERT_TRUE(read.has_value());
    ASSERT_EQ(read->metrics.size(), 1u);
    EXPECT_EQ(read->metrics[0].name, "kept");
    EXPECT_FALSE(fits_a_topic("a" + none));
  }
}

// Bytes by hand from the specification's table of fields: timestamp = 1, metrics = 2, seq = 3; name = 1,
// timestamp = 3, datatype = 4, double_value = 13.
TEST(Sparkplug, BytesAreThoseOfTheSpecification) {
  SparkplugPayload payload;
  payload.time_ms = 1;
  payload.seq = 2;
  payload.metrics = {{"x", 1.0}};
  const std::string metric =
      std::string("\x0a\x01x\x18\x01\x20\x0a\x69", 8) + std::string("\0\0\0\0\0\0\xf0\x3f", 8);
  EXPECT_EQ(encode(payload), std::string("\x08\x01\x12", 3) + static_cast<char>(metric.size()) + metric +
                                 std::string("\x18\x02", 2));
}

TEST(Sparkplug, AnyBytesAreReadOrRefused) {
  std::mt19937 random(7);
  SparkplugPayload payload;
  payload.metrics = {{"name", 2.0}, {"text", std::string("word")}};
  const std::string good = encode(payload);
  for (int i = 0; i < 20'000; ++i) {
    std::string bytes = good;
    for (int k = 0; k < 3; ++k) bytes[random() % bytes.size()] = static_cast<char>(random());
    bytes.resize(random() % (bytes.size() + 1));
    const auto read = decode(bytes);
    EXPECT_LE(read ? read->metrics.size() : 0, bytes.size());
  }
}

TEST(Sparkplug, TopicsAreThoseOfEdgeNodes) {
  EXPECT_EQ(topic_text({"g", "n", "d", SparkplugKind::kDData}), "spBv1.0/g/DDATA/n/d");
  EXPECT_EQ(topic_text({"g", "n", "", SparkplugKind::kNBirth}), "spBv1.0/g/NBIRTH/n");
  const auto topic = parse_topic("spBv1.0/g/DBIRTH/n/machine 4");
  ASSERT_TRUE(topic.has_value());
  EXPECT_EQ(topic->device, "machine 4");
  for (const char* none :
       {"", "spBv1.0/g/DDATA/n", "spBv1.0/g/NDATA/n/d", "spBv1.0/STATE/host", "spAv1.0/g/NDATA/n",
        "spBv1.0/g/XDATA/n", "spBv1.0/g/NDATA/", "spBv1.0/g/DDATA/n/d/e"})
    EXPECT_FALSE(parse_topic(none).has_value()) << none;
  EXPECT_FALSE(fits_a_topic("a/b"));
  EXPECT_FALSE(fits_a_topic(""));
}

TEST(Sparkplug, StateIsReadByItsWords) {
  EXPECT_EQ(online_of(state_text(true, 5)), true);
  EXPECT_EQ(online_of(state_text(false, 5)), false);
  for (const char* none : {"", "ONLINE", "{}", "{\"online\":1}", "[true]", "{\"online\":true"})
    EXPECT_FALSE(online_of(none).has_value()) << none;
  EXPECT_FALSE(online_of(std::string(100'000, '[')).has_value());
}

}  // namespace
}  // namespace vernier::sparkplug_test
