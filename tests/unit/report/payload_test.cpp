// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/report/payload.h"
#include "tools/report/thinning.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

namespace vernier::payload_test {

using namespace vernier::report;
namespace {

using Json = nlohmann::ordered_json;

// A second derivation of base64: decoding it.
std::string decoded(const std::string& text) {
  std::string bytes;
  std::uint32_t group = 0;
  int bits = 0;
  for (const char c : text) {
    if (c == '=') break;
    const auto digit =
        std::string("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/").find(c);
    EXPECT_NE(digit, std::string::npos) << c;
    group = group << 6 | static_cast<std::uint32_t>(digit);
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes.push_back(static_cast<char>(group >> bits & 0xffu));
  }
  return bytes;
}

std::vector<float> floats_of(const std::string& bytes) {
  std::vector<float> values;
  for (std::size_t i = 0; i + 3 < bytes.size(); i += 4) {
    std::uint32_t bits = 0;
    for (std::size_t k = 4; k-- > 0;) bits = bits << 8 | static_cast<unsigned char>(bytes[i + k]);
    values.push_back(std::bit_cast<float>(bits));
  }
  return values;
}

TEST(Payload, Base64IsThatOfTheStandard) {
  // RFC 4648, section 10.
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foob"), "Zm9vYg==");
  EXPECT_EQ(base64("fooba"), "Zm9vYmE=");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
}

TEST(Payload, Base64OfAnyBytesComesBack) {
  constexpr unsigned kSeed = 7;
  std::mt19937 random(kSeed);
  RecordProperty("seed", static_cast<int>(kSeed));
  for (std::size_t size = 0; size < 300; ++size) {
    std::string bytes;
    for (std::size_t i = 0; i < size; ++i) bytes.push_back(static_cast<char>(random() & 0xffu));
    ASSERT_EQ(decoded(base64(bytes)), bytes) << "seed " << kSeed;
  }
}

TEST(Payload, LongRowsArePackedAndComeBack) {
  Json row = Json::array();
  for (int i = 0; i < 100; ++i) row.push_back(0.1 * i - 3);
  row[7] = nullptr;
  row[8] = 1e300;
  const Json result = packed({{"deep", {{"row", row}}}});
  const auto values = floats_of(decoded(result["deep"]["row"]["f32"].get<std::string>()));
  ASSERT_EQ(values.size(), 100u);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i == 7 || i == 8) {
      EXPECT_TRUE(std::isnan(values[i]));
    } else {
      // Half an LSB of a float of that size.
      EXPECT_NEAR(static_cast<double>(values[i]), 0.1 * static_cast<double>(i) - 3, 4e-7);
    }
  }
}

TEST(Payload, FlagsArePackedAsBytes) {
  Json row = Json::array();
  for (int i = 0; i < 50; ++i) row.push_back(i % 2);
  EXPECT_EQ(decoded(packed(row)["u8"].get<std::string>()).size(), 50u);
  row[3] = 256;
  EXPECT_TRUE(packed(row).contains("f32"));
  row[3] = -1;
  EXPECT_TRUE(packed(row).contains("f32"));
}

TEST(Payload, ShortRowsAndTextsStay) {
  const Json value = {{"plane", {"X", "Y"}}, {"centre_mm", {1.5, 2.5}}, {"name", "a"}, {"none", nullptr}};
  EXPECT_EQ(packed(value), value);
}

TEST(Payload, ScriptJsonCannotLeaveItsElement) {
  const Json hostile = {{"</script><script>alert(1)</script>", "<!--<script>"},
                        {"line", "\xe2\x80\xa8"},
                        {"bytes", "\xff\xfe"}};
  const std::string text = script_json(hostile);
  EXPECT_EQ(text.find('<'), std::string::npos);
  EXPECT_EQ(text.find('>'), std::string::npos);
  for (const char c : text) ASSERT_TRUE(c >= ' ' && c <= '~');
  // What is in it is still the same text.
  EXPECT_EQ(Json::parse(text).begin().key(), "</script><script>alert(1)</script>");
  EXPECT_EQ(Json::parse(text).begin().value(), "<!--<script>");
}

TEST(Payload, HtmlIsEscaped) { EXPECT_EQ(escape_html("a<b>&\"'"), "a&lt;b&gt;&amp;&quot;&#39;"); }

// `rows` rows with `kinds` observations each, kinds taking turns; residual of observation i is i.
Json a_detail(std::size_t rows, std::size_t kinds) {
  Json detail = {{"columns", {{{"name", "X"}, {"unit", "mm"}}}},
                 {"column_data", {Json::array()}},
                 {"row_check", Json::array()},
                 {"worst", Json::array()}};
  Json observations = {{"kind", Json::array()},
                       {"row", Json::array()},
                       {"kind_index", Json::array()},
                       {"residual", Json::array()}};
  for (std::size_t kind = 0; kind < kinds; ++kind) observations["kind"].push_back("k" + std::to_string(kind));
  for (std::size_t row = 0; row < rows; ++row) {
    detail["column_data"][0].push_back(10.0 * static_cast<double>(row));
    detail["row_check"].push_back(row % 2);
    for (std::size_t kind = 0; kind < kinds; ++kind) {
      observations["row"].push_back(row);
      observations["kind_index"].push_back(kind);
      observations["residual"].push_back(row * kinds + kind);
    }
  }
  detail["observations"] = observations;
  return detail;
}

TEST(Thinning, LeavesWhatIsShortEnough) {
  const Json detail = a_detail(100, 2);
  EXPECT_EQ(thinned_detail(detail, 100), detail);
}

TEST(Thinning, KeepsEveryKindAndTheWorstAndEachValueWithItsRow) {
  Json detail = a_detail(1000, 6);
  detail["worst"].push_back({{"row", 501}, {"line", 503}, {"kind", "k1"}, {"residual", 1.0}});
  const Json thin = thinned_detail(detail, 100);
  EXPECT_EQ(thin["thinned"]["of"], 6000);
  EXPECT_EQ(thin["thinned"]["step"], 10);
  const Json& kept = thin["observations"];
  EXPECT_EQ(kept["row"].size(), thin["thinned"]["kept"].get<std::size_t>());
  std::vector<std::size_t> count(6, 0);
  for (std::size_t i = 0; i < kept["row"].size(); ++i) {
    const auto original = kept["residual"][i].get<std::size_t>();
    const auto row = kept["row"][i].get<std::size_t>();
    // The residual tells which observation it was: its row's column and kind must have come along.
    EXPECT_EQ(thin["column_data"][0][row].get<double>(), 10.0 * static_cast<double>(original / 6));
    EXPECT_EQ(kept["kind_index"][i], original % 6);
    ++count[original % 6];
  }
  for (const std::size_t of_kind : count) EXPECT_EQ(of_kind, 101u);
  EXPECT_EQ(thin["column_data"][0][thin["worst"][0]["row"].get<std::size_t>()], 5010.0);
}

TEST(Thinning, IsTheSameEveryTime) {
  const Json detail = a_detail(5000, 3);
  EXPECT_EQ(thinned_detail(detail, 700).dump(), thinned_detail(detail, 700).dump());
}

TEST(Thinning, LongCircleIsThinnedTogether) {
  Json run = {{"label", "CCW"},
              {"angle_deg", Json::array()},
              {"measured_um", Json::array()},
              {"model_um", nullptr},
              {"check", Json::array()}};
  for (int i = 0; i < 1000; ++i) {
    run["angle_deg"].push_back(i);
    run["measured_um"].push_back(2 * i);
    run["check"].push_back(0);
  }
  const Json thin = thinned_detail({{"circular", {{{"runs", {run}}}}}}, 100)["circular"][0]["runs"][0];
  ASSERT_EQ(thin["angle_deg"].size(), 100u);
  EXPECT_EQ(thin["angle_deg"][99], 990);
  EXPECT_EQ(thin["measured_um"][99], 1980);
  EXPECT_EQ(thin["check"].size(), 100u);
}

TEST(Thinning, ContradictionsAreRefused) {
  const auto spoilt = [](auto spoil) {
    Json detail = a_detail(10, 2);
    spoil(detail);
    return detail;
  };
  EXPECT_THROW(thinned_detail(spoilt([](Json& d) { d["observations"]["residual"].erase(0); }), 5),
               std::invalid_argument);
  EXPECT_THROW(thinned_detail(spoilt([](Json& d) { d["observations"]["row"][0] = 10; }), 5),
               std::invalid_argument);
  EXPECT_THROW(thinned_detail(spoilt([](Json& d) { d["observations"]["row"][0] = -1; }), 5),
               std::invalid_argument);
  EXPECT_THROW(thinned_detail(spoilt([](Json& d) { d["observations"]["kind_index"][0] = 2; }), 5),
               std::invalid_argument);
  EXPECT_THROW(thinned_detail(spoilt([](Json& d) { d["row_check"].erase(0); }), 5), std::invalid_argument);
  EXPECT_THROW(thinned_detail(spoilt([](Json& d) { d["columns"].push_back("Y"); }), 5),
               std::invalid_argument);
  EXPECT_THROW(thinned_detail(spoilt([](Json& d) {
                                d["worst"].push_back({{"row", 10}});
                              }),
                              5),
               std::invalid_argument);
}

}  // namespace
}  // namespace vernier::payload_test
