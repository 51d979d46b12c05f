// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/probe/touch_fit.h"

#include <gtest/gtest.h>

#include <random>

#include "tools/text/error.h"

namespace vernier::touch_fit_test {

using namespace vernier::probe;
using namespace vernier::text;
namespace {

using Eigen::VectorXd;

struct Line {
  VectorXd x, y;
  VectorXd operator()(const VectorXd& p) const { return y.array() - p(0) - p(1) * x.array(); }
};

Line noisy_line(std::uint64_t seed, int n) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise(0, 1e-3);
  Line line{VectorXd::LinSpaced(n, 0, 10), VectorXd(n)};
  for (int i = 0; i < n; ++i) line.y(i) = 2 + 0.5 * line.x(i) + noise(random);
  return line;
}

TEST(TouchFit, LosesATouchOfAGoodSetAboutAsOftenAsItSays) {
  int lost = 0;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    TouchFitOptions options;
    options.outlier_level = 0.05;
    lost +=
        fit_touches(noisy_line(seed, 20), VectorXd::Zero(2), options, {"a", "b"}).outliers.empty() ? 0 : 1;
  }
  EXPECT_NEAR(lost, 20, 3 * 4.4) << "of 400 sets, seeds 1 to 400";
}

TEST(TouchFit, GivesTheUncertaintyThatRepeatsShow) {
  double sum = 0, claimed = 0;
  constexpr int kSets = 300;
  for (std::uint64_t seed = 1; seed <= kSets; ++seed) {
    TouchFitOptions options;
    options.outlier_level = 0;
    const TouchFit fit = fit_touches(noisy_line(seed, 15), VectorXd::Zero(2), options, {"a", "b"});
    sum += std::pow(fit.value(1) - 0.5, 2), claimed += fit.covariance(1, 1);
  }
  EXPECT_NEAR(sum / claimed, 1, 0.25);
}

TEST(TouchFit, NamesWhatTheTouchesDoNotTellApart) {
  const Line line = noisy_line(1, 10);
  const TouchModel twice = [&](const VectorXd& p) -> VectorXd { return line.y.array() - p(0) - p(1); };
  try {
    fit_touches(twice, VectorXd::Zero(2), {}, {"tip radius", "pretravel"});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("tip radius, pretravel"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace vernier::touch_fit_test
