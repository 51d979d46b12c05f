// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cstdlib>

#include "tools/derive/print_equation.h"
#include "tools/model/machine_reader.h"
#include "tools/text/files.h"

namespace vernier::printing_test {

using namespace vernier::derive;
using namespace vernier::model;
using namespace vernier::text;
namespace {

const std::string kRoot = VERNIER_SOURCE_DIR;
constexpr std::uint64_t kSeed = 20260101;

DerivedMachine derived(const std::string& name) {
  DerivedMachine d{derive::derive(read_machine(kRoot + "/tables/machines/" + name + ".xml")), {}, {}, 200};
  d.bound = bound_second_order(d.equation);
  d.sampled = sample_second_order(d.equation, d.samples, kSeed);
  return d;
}

/// Compares with the file under tests/golden; VERNIER_UPDATE_GOLDEN=1 in the environment rewrites it.
void expect_golden(const std::string& file, const std::string& text) {
  const std::string path = kRoot + "/tests/golden/" + file;
  if (std::getenv("VERNIER_UPDATE_GOLDEN") != nullptr) write_file(path, text);
  EXPECT_EQ(text, read_file(path)) << file;
}

TEST(PrintedEquation, IsTheGoldenOne) {
  for (const std::string name :
       {"column_moving_table", "five_axis_bhead_ctable", "xy_hybrid_mill", "ur10e"}) {
    const DerivedMachine d = derived(name);
    expect_golden("derive_" + name + ".txt", print_text(d));
    expect_golden("derive_" + name + ".tex", print_latex(d));
  }
}

TEST(PrintedEquation, TextReadsBackToTheSameExpressions) {
  for (const std::string name : {"five_axis_bhead_ctable", "ur10e", "fibre_placement_dh"}) {
    const ErrorEquation e = derive::derive(read_machine(kRoot + "/tables/machines/" + name + ".xml"));
    GiNaC::symtab names;
    for (const ErrorParameter& p : e.parameters) names[p.name] = p.symbol;
    for (const NominalSymbol& n : e.nominal) names[n.name] = n.symbol;
    for (const Abbreviation& a : e.abbreviations) names[a.symbol.get_name()] = a.symbol;
    for (std::size_t c = 0; c < 6; ++c) {
      GiNaC::ex sum = 0;
      for (std::size_t p = 0; p < e.parameters.size(); ++p)
        sum += e.sensitivity[p][c] * e.parameters[p].symbol;
      GiNaC::parser read(names, true);
      const GiNaC::ex again = read(print_component(e, c, Notation::kText));
      EXPECT_TRUE((again - sum).expand().is_zero()) << name << " component " << c;
    }
  }
}

TEST(PrintedEquation, PutsSignsAndFractionsWhereTheyBelong) {
  const GiNaC::realsymbol a("a"), b("b"), c("c");
  const auto text = [](const GiNaC::ex& e) { return print(e, Notation::kText); };
  EXPECT_EQ(text(-a * (b - a)), "a*(a - b)");
  EXPECT_EQ(text(a / (b * c)), "a/(b*c)");
  EXPECT_EQ(text(-GiNaC::pow(a, -2) / 3), "-1/3/a^2");
  EXPECT_EQ(text(GiNaC::pow(b - a, 2)), "(a - b)^2");
  EXPECT_EQ(text(GiNaC::pow(b - a, 3)), "-(a - b)^3");
  EXPECT_EQ(text(GiNaC::sqrt(b - a)), "sqrt(-a + b)");
  EXPECT_EQ(print(a * GiNaC::sin(b) / 2, Notation::kLatex), "\\frac{1}{2} \\, a \\, \\sin\\left(b\\right)");
  EXPECT_EQ(latex_name("EXX"), "E_{XX}");
  EXPECT_EQ(latex_name("d_lAx"), "\\Delta \\mathrm{lAx}");
}

}  // namespace
}  // namespace vernier::printing_test
