// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/maths/chance.h"

#include <gtest/gtest.h>

#include <cmath>

namespace vernier::chance_test {

using namespace vernier::maths;
namespace {

TEST(Chance, FTailMeetsClosedForms) {
  // d1 = 2: P(F >= f) = (1 + 2 f / d2)^(-d2 / 2).
  for (const double d2 : {3.0, 10.0, 997.5, 3e4})
    for (const double f : {1e-3, 0.5, 1.0, 4.0, 40.0, 700.0})
      EXPECT_NEAR(log_f_tail(f, 2, d2), -d2 / 2 * std::log1p(2 * f / d2),
                  1e-9 * (1 + d2 * std::log1p(2 * f / d2)))
          << f << ' ' << d2;
  // d1 = d2 = 1: t with one degree of freedom, P(|t| >= 1) = 1/2.
  EXPECT_NEAR(std::exp(log_f_tail(1, 1, 1)), 0.5, 1e-12);
  EXPECT_EQ(log_f_tail(0, 3, 10), 0);
  EXPECT_EQ(log_f_tail(5, 3, 0), 0);
}

TEST(Chance, FTailMeetsTables) {
  // 5 % and 1 % points of the usual tables, four digits.
  EXPECT_NEAR(std::exp(log_f_tail(3.3258, 5, 10)), 0.05, 2e-5);
  EXPECT_NEAR(std::exp(log_f_tail(2.0772, 10, 60)), 0.04, 5e-3);
  EXPECT_NEAR(std::exp(log_f_tail(5.6363, 5, 10)), 0.01, 5e-6);
}

TEST(Chance, ChiSquareTailMeetsClosedForms) {
  for (const double x : {0.1, 2.0, 9.0, 60.0, 800.0}) {
    EXPECT_NEAR(log_chi_square_tail(x, 2), -x / 2, 1e-10 * (1 + x));
    EXPECT_NEAR(log_chi_square_tail(x, 4), -x / 2 + std::log1p(x / 2), 1e-10 * (1 + x));
  }
  EXPECT_NEAR(std::exp(log_chi_square_tail(3.841459, 1)), 0.05, 1e-7);
  EXPECT_NEAR(std::exp(log_chi_square_tail(1074.679, 1000)), 0.05, 1e-5);
}

TEST(Chance, CorrelationTailIsHalfOfBothSides) {
  // Table of r: 5 % one-sided at 10 pairs is 0.5494.
  EXPECT_NEAR(std::exp(log_correlation_tail(0.5494, 10)), 0.05, 2e-5);
  EXPECT_NEAR(std::exp(log_correlation_tail(-0.5494, 10)), 0.95, 2e-5);
  EXPECT_NEAR(std::exp(log_correlation_tail(0, 10)), 0.5, 1e-12);
}

TEST(UpperTail, QuantileIsTheInverse) {
  for (const double p : {0.4, 0.1, 1e-3, 1e-9, 1e-100})
    EXPECT_NEAR(std::log(upper_tail(upper_quantile(p)) / p), 0, 1e-9);
  EXPECT_NEAR(upper_quantile(0.01), 2.3263478740, 1e-9);
}

}  // namespace
}  // namespace vernier::chance_test
