// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/model/expression.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tools/model/chain/chain.h"
#include "tools/model/chain/evaluate.h"
#include "tools/model/machine.h"
#include "tools/model/machine_reader.h"

namespace vernier::expression_test {

using namespace vernier::model;
namespace {

const char* const kMachine = R"XML(<machine name="m"><variables>
  <static><k value="2"/><tau value="10"/></static>
  <machineaxes><X min="0" max="100"/><B rotary="true" min="-90" max="90"/></machineaxes>
  <inputs><T unit="degC" reference="20"/></inputs></variables>
  <transforms><sixdof n="1" X="X"/></transforms></machine>)XML";

/// Value of a text with X = 3, B = 30, T = 25, vX = 7, t = 1.
double value(const std::string& text) {
  const Machine machine = parse_machine(kMachine, "m.xml");
  States states = make_states(1, 2, {25});
  states.axis[0][0] = 3;
  states.axis[1][0] = 30;
  states.velocity[0][0] = 7;
  states.time[0] = 1;
  return model::evaluate(machine, *parse_expression_for(machine, text), states)[0];
}

TEST(Expression, FollowsThePrecedenceOfTheFormat) {
  EXPECT_DOUBLE_EQ(value("1+2*3"), 7);
  EXPECT_DOUBLE_EQ(value("-2^2"), -4);
  EXPECT_DOUBLE_EQ(value("2^3^2"), 512);
  EXPECT_DOUBLE_EQ(value("2^-1"), 0.5);
  EXPECT_DOUBLE_EQ(value("8/4/2"), 1);
  EXPECT_DOUBLE_EQ(value("5-3-1"), 1);
  EXPECT_DOUBLE_EQ(value("2*-3"), -6);
  EXPECT_DOUBLE_EQ(value("1+1=2"), 1);
  EXPECT_DOUBLE_EQ(value("(X=3)*5+(X<3)*7+(X>3)*9"), 5);
}

TEST(Expression, FunctionsTakeDegrees) {
  EXPECT_NEAR(value("sin(B)"), 0.5, 1e-15);
  EXPECT_NEAR(value("cos(60)"), 0.5, 1e-15);
  EXPECT_NEAR(value("tan(45)"), 1, 1e-15);
  EXPECT_NEAR(value("atan2(1,-1)"), 135, 1e-12);
  EXPECT_DOUBLE_EQ(value("log(exp(2))"), 2);
  EXPECT_DOUBLE_EQ(value("sqrt(16)+abs(-2)+sign(-5)+min(1,2)+max(1,2)"), 8);
}

TEST(Expression, KnowsWhatTheMachineAndItsMotionOffer) {
  EXPECT_DOUBLE_EQ(value("k*vX+T+t"), 2 * 7 + 25 + 1);
  EXPECT_DOUBLE_EQ(value("lXx+rBz"), 0);  // no table: 0
  EXPECT_DOUBLE_EQ(value("sinceX"), kLongWay);
  EXPECT_DOUBLE_EQ(value("run(\"\")"), 1);
  EXPECT_DOUBLE_EQ(value("run('other')"), 0);
}

TEST(Expression, NamesTheOffendingWord) {
  const Machine machine = parse_machine(kMachine, "m.xml");
  const auto word = [&](const std::string& text) {
    try {
      parse_expression_for(machine, text);
    } catch (const ExpressionError& error) {
      return error.word;
    }
    return std::string("accepted");
  };
  EXPECT_EQ(word("X+alhpa"), "alhpa");
  EXPECT_EQ(word("X+"), "X+");
  EXPECT_EQ(word("sim(X)"), "sim");
  EXPECT_EQ(word("1<2<3"), "<");
  EXPECT_EQ(word("2X"), "2X");
  EXPECT_EQ(word("1..2"), "1..2");
  EXPECT_EQ(word("sin"), "sin");
  EXPECT_EQ(word("(X"), "(X");
  EXPECT_EQ(word("X)"), ")");
  EXPECT_EQ(word("X+\u00b5"), "\u00b5");
  EXPECT_EQ(word("X+1e308"), "1e308");
  EXPECT_EQ(word(""), "");
  EXPECT_NE(word(std::string(100000, '(')), "accepted");
}

TEST(Expression, TextReadsBackToTheSameTree) {
  for (const char* text : {"-2^2", "(-2)^2", "a-(b-c)", "a/(b*c)", "a^b^c", "(a^b)^c", "-(a+b)", "a*-b",
                           "(a=b)+1", "min(a,b+1)", "lag(a,b)", "run(\"s1\")*k", "1e-07*a", "a-(-3)"}) {
    const ExprPtr tree = parse_expression(text);
    const std::string again = to_text(*tree);
    EXPECT_EQ(to_text(*parse_expression(again)), again) << text;
  }
  EXPECT_EQ(to_text(*parse_expression("a-(b-c)")), "a-(b-c)");
  EXPECT_EQ(to_text(*parse_expression("((a)*(b))")), "a*b");
}

TEST(Expression, PlaceholdersArePartOfANameInTemplatesOnly) {
  EXPECT_THROW(parse_expression("k*{q}"), ExpressionError);
  EXPECT_THROW(parse_template("k*{q"), ExpressionError);
  EXPECT_EQ(to_text(*parse_template("k*dir{q}*({hats 5})")), "k*dir{q}*{hats 5}");
}

/// A tree needs no parentheses to stay what it is, where text would.
TEST(Expression, WhatIsSubstitutedStaysOneOperand) {
  const auto with = [](const char* term, const ExprPtr& value) {
    return to_text(*substitute(parse_template(term),
                               [&](const std::string& name) { return name == "{q}" ? value : nullptr; }));
  };
  EXPECT_EQ(with("k*{q}", parse_expression("A+B")), "k*(A+B)");
  EXPECT_EQ(with("(X-{q})^2", make_number(-3)), "(X+3)^2");
  EXPECT_EQ(with("(X-{q})^2", make_number(3)), "(X-3)^2");
  EXPECT_EQ(with("(X-{q})^2", make_number(0)), "X^2");
  EXPECT_EQ(with("X-3", make_number(0)), "X-3");
}

TEST(Expression, LagOfARampTrailsByTau) {
  const Machine machine = parse_machine(kMachine, "m.xml");
  constexpr std::size_t kCount = 200;
  States states = make_states(kCount, 2, {0});
  for (std::size_t i = 0; i < kCount; ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    states.time[at] = static_cast<double>(i);
    states.input[0][at] = static_cast<double>(i);
  }
  const Column y = model::evaluate(machine, *parse_expression_for(machine, "lag(T,tau)"), states);
  EXPECT_DOUBLE_EQ(y[0], 0);
  for (const Eigen::Index i : {1, 10, 199}) {
    const double t = static_cast<double>(i);
    EXPECT_NEAR(y[i], t - 10 * (1 - std::exp(-t / 10)), 1e-9);  // exact answer to a ramp
  }
}

TEST(Expression, LagStartsAnewInEachRun) {
  const Machine machine = parse_machine(kMachine, "m.xml");
  States states = make_states(4, 2, {0});
  states.run_names = {"a", "b"};
  states.run = {0, 0, 1, 1};
  states.time << 0, 1, 2, 3;
  states.input[0] << 5, 5, 9, 9;
  const Column y = model::evaluate(machine, *parse_expression_for(machine, "lag(T,tau)"), states);
  EXPECT_DOUBLE_EQ(y[1], 5);
  EXPECT_DOUBLE_EQ(y[2], 9);
}

/// Second derivation: every derivative against central differences.
TEST(Expression, DerivativesAgreeWithDifferences) {
  Machine machine = parse_machine(kMachine, "m.xml");
  States states = make_states(3, 2, {0});
  states.axis[0] << 1, 2, 3;
  states.time << 0, 4, 9;
  states.input[0] << 1, 3, 2;
  for (const char* text : {"k*X+k^2", "sin(k*X*10)", "exp(-X/k)", "lag(k*T,tau)", "X/(k+tau)",
                           "sqrt(k)*atan2(k,X)", "max(k,1)*abs(-k)", "k^tau/1000", "tan(k)+log(k)"}) {
    const ExprPtr tree = parse_expression_for(machine, text);
    const ValueAndSlopes dual = Evaluator(machine, states, std::vector<char>(14, 1))(*tree);
    for (std::size_t s = 0; s < 2; ++s) {
      const double start = machine.statics[s].value, step = 1e-6 * start;
      machine.statics[s].value = start + step;
      const Column high = model::evaluate(machine, *tree, states);
      machine.statics[s].value = start - step;
      const Column low = model::evaluate(machine, *tree, states);
      machine.statics[s].value = start;
      for (std::size_t i = 0; i < 3; ++i) {
        double derivative = 0;
        for (const auto& [key, column] : dual.by)
          if (key == s) derivative = column[i];
        const auto at = static_cast<Eigen::Index>(i);
        const double expected = (high[at] - low[at]) / (2 * step);
        EXPECT_NEAR(derivative, expected, 1e-7 * (1 + std::abs(expected))) << text << " by static " << s;
      }
    }
  }
}

// A sum is a tree as deep as it is long: a million terms once ended the program that read them.
TEST(Expression, OfMoreTermsThanAnyMachineHasIsRefused) {
  const auto sum_of = [](std::size_t terms) {
    std::string text = "1";
    for (std::size_t i = 1; i < terms; ++i) text += "+1";
    return text;
  };
  EXPECT_NO_THROW(parse_expression(sum_of(3000)));
  for (const std::size_t terms : {5000u, 1'000'000u})
    EXPECT_THROW(parse_expression(sum_of(terms)), ExpressionError);
  EXPECT_THROW(parse_expression("1e999"), ExpressionError);
}

}  // namespace
}  // namespace vernier::expression_test
