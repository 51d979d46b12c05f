// SPDX-License-Identifier: GPL-3.0-or-later
// `vernier diagnose` on measured machines, against what is known of them: the keys that come with the data.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/bench/diagnose/process.h"
#include "tools/text/files.h"

namespace vernier::real_test {

using namespace vernier::text;
namespace {

using nlohmann::json;

const std::string kVernier = std::string(VERNIER_BIN_DIR) + "/vernier";

class RealData : public testing::Test {
 protected:
  RealData() { std::filesystem::create_directories(scratch_); }
  ~RealData() override { std::filesystem::remove_all(scratch_); }

  json run(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), kVernier);
    for (const char* more : {"--json", "-"}) arguments.emplace_back(more);
    const bench::ProcessResult result = bench::run_process(arguments, scratch_ + "/err");
    EXPECT_EQ(result.status, 0) << read_file(scratch_ + "/err");
    return json::parse(result.output, nullptr, false);
  }
  json diagnose(const std::string& folder) const {
    return run({"diagnose", folder + "/machine.xml", folder + "/meas.csv"});
  }

  std::string scratch_ = testing::TempDir() + "diagnose_real_" + std::to_string(getpid());
};

/// Data that may be kept here, or elsewhere; empty where they are not to be had.
std::string folder_of(const std::string& name) {
  const std::string own = std::string(VERNIER_SOURCE_DIR) + "/tests/data/real/" + name;
  if (std::filesystem::exists(own)) return own;
  const char* extra = std::getenv("VERNIER_EXTRA_DATA");
  if (extra == nullptr) return {};
  const std::string other = std::string(extra) + "/" + name;
  return std::filesystem::exists(other) ? other : std::string();
}

std::vector<std::string> effects_of_ladder(const json& answer) {
  std::vector<std::string> effects;
  for (const json& step : answer.at("ladder"))
    if (!step.at("effect").is_null()) effects.push_back(step["effect"]);
  return effects;
}

/// Verdict and first effect of the key, and a ladder that gets as low as the key's.
void expect_key(const json& answer, const json& key, double tolerance_um) {
  const auto is_in = [](const json& list, const json& value) {
    return std::find(list.begin(), list.end(), value) != list.end();
  };
  EXPECT_TRUE(is_in(key.at("verdict_accept"), answer.at("verdict"))) << answer["verdict"];
  ASSERT_FALSE(answer.at("candidates").empty());
  EXPECT_TRUE(is_in(key.at("accept"), answer["candidates"][0].at("effect"))) << answer["candidates"][0];
  const json& before = key.at("ladder").front();
  const json& ladder = answer.at("ladder");
  ASSERT_GE(ladder.size(), 2U);
  EXPECT_NEAR(ladder[0].at("rms_um").get<double>(), before[1].get<double>(), 0.006);
  EXPECT_LE(ladder.back().at("rms_um").get<double>(), key["ladder"].back()[1].get<double>() + tolerance_um)
      << ladder;
  EXPECT_LE(ladder.back().at("check_rms_um").get<double>(),
            key["ladder"].back()[2].get<double>() + tolerance_um)
      << ladder;
}

TEST_F(RealData, ATouchProbeTriggersLateInProportionToTheFeed) {
  const std::string folder = folder_of("nist_probe");
  const json answer = diagnose(folder);
  // The same term with other digits of the delay: a hundredth of the published digits' last place.
  expect_key(answer, json::parse(read_file(folder + "/key.json")), 0.01);
  const json& first = answer["candidates"][0];
  ASSERT_FALSE(first.at("parameters").empty());
  // 6.15 ms, and the report's own scatter of 0.02 ms.
  EXPECT_NEAR(std::abs(first["parameters"][0].at("value").get<double>()), 0.00615, 0.00004);

  const std::string added = scratch_ + "/added.xml", fitted = scratch_ + "/fitted.xml";
  run({"add", first.at("add").get<std::string>(), folder + "/machine.xml", "-o", added});
  const json fit = run({"fit", added, folder + "/meas.csv", "-o", fitted});
  EXPECT_NEAR(fit.at("rms_um").get<double>(), 1.947, 0.01);
  const json after = run({"diagnose", fitted, folder + "/meas.csv"});
  EXPECT_EQ(after.at("verdict"), "consistent") << after["candidates"];
  EXPECT_EQ(after.at("ladder").size(), 1U);
}

/// Samples are missing from the wireless record: its angles are wrong, and no machine error may be named.
TEST_F(RealData, ABallBarRecordWithLostSamplesIsTheInstrument) {
  const json answer = diagnose(folder_of("ur10e_ballbar"));
  EXPECT_EQ(answer.at("verdict"), "instrument");
}

class ElsewhereData : public RealData {
 protected:
  /// True where the data are there; else the test is skipped and says so.
  bool found(const char* name) {
    folder_ = folder_of(name);
    return !folder_.empty();
  }
  std::string folder_;
};

TEST_F(ElsewhereData, ALinearAxisHasBacklashFirst) {
  if (!found("ess_b02_x")) GTEST_SKIP() << "VERNIER_EXTRA_DATA has no ess_b02_x";
  const json answer = diagnose(folder_), key = json::parse(read_file(folder_ + "/key.json"));
  EXPECT_EQ(answer.at("verdict"), "missing-effect");
  EXPECT_EQ(effects_of_ladder(answer), std::vector<std::string>{"backlash"});
  const json &step = answer.at("ladder").back(), &same = key.at("ladder")[1];
  EXPECT_NEAR(step.at("rms_um").get<double>(), same[1].get<double>(), 0.006);
  EXPECT_NEAR(step.at("check_rms_um").get<double>(), same[2].get<double>(), 0.006);
  // Known shortfall: the key goes on to a drift and a reversal of eight values along the axis (check rms 1.8
  // um). Without u the score takes the noise from the fit before a step, which contains both.
}

TEST_F(ElsewhereData, ARobotBendsAtItsSecondJoint) {
  if (!found("abb_irb120")) GTEST_SKIP() << "VERNIER_EXTRA_DATA has no abb_irb120";
  const json answer = diagnose(folder_);
  EXPECT_EQ(answer.at("verdict"), "missing-effect");
  const json& ladder = answer.at("ladder");
  ASSERT_GE(ladder.size(), 3U);
  EXPECT_EQ(effects_of_ladder(answer)[0], "joint-compliance");
  EXPECT_EQ(effects_of_ladder(answer)[1], "cyclic-error");
  // The key's own two terms: the same minimum to the last published digit.
  for (const auto& [step, fit_um, check_um] :
       {std::tuple{std::size_t{1}, 82.925, 96.504}, {std::size_t{2}, 77.141, 75.379}}) {
    EXPECT_NEAR(ladder[step].at("rms_um").get<double>(), fit_um, 0.002);
    EXPECT_NEAR(ladder[step].at("check_rms_um").get<double>(), check_um, 0.002);
  }
  // No third step: a period of joint 4 would lower the fit to 69 um and raise the check rms. The three points
  // of a pose share an error, so they are no three witnesses for it.
  EXPECT_EQ(ladder.size(), 3U);
}

TEST_F(ElsewhereData, APrinterGrowsWithItsFrame) {
  if (!found("voron_2004")) GTEST_SKIP() << "VERNIER_EXTRA_DATA has no voron_2004";
  const json answer = diagnose(folder_);
  EXPECT_EQ(answer.at("verdict"), "missing-effect");
  EXPECT_EQ(effects_of_ladder(answer)[0], "thermal-offset");
  // The key's two temperatures reach 8.7 / 6.9 um. With their lags the fit gets below the key's third step;
  // on the check rows it does not: what would help there (the hot end) moved in one block only, and nothing
  // that one block alone shows is accepted.
  const json& end = answer.at("ladder").back();
  EXPECT_LE(end.at("rms_um").get<double>(), 6.943);
  EXPECT_LE(end.at("check_rms_um").get<double>(), 6.891);
}

}  // namespace
}  // namespace vernier::real_test
