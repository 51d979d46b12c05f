// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

#include "tools/derive/error_equation.h"
#include "tools/derive/second_order.h"
#include "tools/derive/tidy.h"
#include "tools/model/chain/chain.h"
#include "tools/model/machine_reader.h"
#include "tools/text/files.h"

namespace vernier::closed_forms_test {

using namespace vernier::derive;
using namespace vernier::model;
using namespace vernier::text;
namespace {

using GiNaC::ex;
const std::string kRoot = VERNIER_SOURCE_DIR;
const std::string kColumn = kRoot + "/tests/data/column_machine/";

/// Published configuration -> our machine file.
const std::map<std::string, std::string> kFiles = {{"column_moving_table", "column_moving_table"},
                                                   {"moving_bridge", "moving_bridge"},
                                                   {"gantry", "gantry"},
                                                   {"l_shaped", "l_bridge"},
                                                   {"moving_horizontal_arm", "moving_horizontal_arm"},
                                                   {"fixed_horizontal_arm", "fixed_horizontal_arm"},
                                                   {"fixed_bridge", "fixed_bridge"}};

Machine reference_machine(const std::string& name) {
  return read_machine(kRoot + "/tables/machines/" + name + ".xml");
}

nlohmann::json json_of(const std::string& path) { return nlohmann::json::parse(read_file(path)); }

/// Expressions in the symbols of an equation.
class Reader {
 public:
  explicit Reader(const ErrorEquation& equation) {
    for (const ErrorParameter& p : equation.parameters) names_[p.name] = p.symbol;
    for (const NominalSymbol& n : equation.nominal) names_[n.name] = n.symbol;
  }
  ex operator()(const std::string& text) const {
    GiNaC::parser parse(names_, true);  // strict: an unknown name is an error
    return parse(text);
  }

 private:
  GiNaC::symtab names_;
};

ex component(const ErrorEquation& equation, std::size_t i) {
  ex sum = 0;
  for (std::size_t p = 0; p < equation.parameters.size(); ++p)
    sum += equation.sensitivity[p][i] * equation.parameters[p].symbol;
  return sum;
}

TEST(ClosedForms, SevenConfigurationsEqualThePublishedEquationsTermByTerm) {
  const auto published = json_of(kColumn + "equations.json")["configurations"];
  ASSERT_EQ(published.size(), 7U);
  for (const auto& [name, file] : kFiles) {
    const ErrorEquation equation = derive::derive(reference_machine(file));
    EXPECT_EQ(equation.parameters.size(), 21U) << name;
    const Reader read(equation);
    constexpr std::array<const char*, 3> kKeys = {"dX", "dY", "dZ"};
    for (std::size_t i = 0; i < 3; ++i) {
      const ex form = read(published[name][kKeys[i]].get<std::string>());
      EXPECT_TRUE(canonical(component(equation, i) - form).is_zero())
          << name << " " << kKeys[i] << ": " << canonical(component(equation, i) - form);
      EXPECT_FALSE(canonical(component(equation, i) - form - read("EAX*Z")).is_zero());
      const ex nominal = read(published[name]["nominal"][i].get<std::string>());
      EXPECT_TRUE((equation.position[i] - nominal).expand().is_zero()) << name;
    }
  }
}

TEST(ClosedForms, ColumnMachineEqualsTheEquationPrintedInTheNotes) {
  const auto paper = json_of(kColumn + "equations.json")["paper_final"];
  const ErrorEquation equation = derive::derive(reference_machine("column_moving_table"));
  const Reader read(equation);
  EXPECT_TRUE((component(equation, 0) - read(paper["dX"])).expand().is_zero());
  EXPECT_TRUE((component(equation, 1) - read(paper["dY"])).expand().is_zero());
  EXPECT_TRUE((component(equation, 2) - read(paper["dZ"])).expand().is_zero());
}

using Row = std::map<std::string, double>;

std::vector<std::pair<std::string, Row>> cases() {
  std::istringstream lines(read_file(kColumn + "cases.csv"));
  std::vector<std::string> names;
  std::vector<std::pair<std::string, Row>> result;
  for (std::string line, field; std::getline(lines, line);) {
    std::istringstream fields(line);
    std::vector<std::string> words;
    while (std::getline(fields, field, ',')) words.push_back(field);
    if (names.empty()) {
      names = words;
      continue;
    }
    Row row;
    for (std::size_t i = 1; i < words.size(); ++i) row[names.at(i)] = std::stod(words[i]);
    result.emplace_back(words[0], row);
  }
  return result;
}

/// The machine of a case: its errors as constant tables and statics, its tool point.
Machine case_machine(const std::string& configuration, const Row& row) {
  Machine machine = reference_machine(kFiles.at(configuration));
  for (const char* name : {"AL", "B1", "B2", "XP", "YP", "ZP"})
    machine.statics[*machine.find_static(name)].value = row.at(name);
  for (Table& table : machine.tables)
    for (Station& station : table.stations)
      for (std::size_t c = 0; c < 6; ++c) {
        const double value = row.at(std::string("E") + "XYZABC"[c] + machine.axes[table.axis].name);
        station.value[c] = c < 3 ? value : value * 180 / std::numbers::pi;
      }
  return machine;
}

States case_states(const Machine& machine, const Row& row) {
  States states = make_states(1, machine.axes.size(), {});
  for (std::size_t a = 0; a < 3; ++a) states.axis[a][0] = row.at(machine.axes[a].name);
  return states;
}

/// The notes' product: p_parent = T p + L with T the small-angle matrix, inverted exactly on the work side.
/// Independent of the chain code, of the machine files except for the order of the slides.
Eigen::Vector3d notes_product(const nlohmann::json& configuration, const Row& row) {
  const auto slide = [&](const std::string& a, Eigen::Matrix3d& turn, Eigen::Vector3d& shift) {
    const auto e = [&](const char* direction) { return row.at(std::string("E") + direction + a); };
    turn << 1, -e("C"), e("B"), e("C"), 1, -e("A"), -e("B"), e("A"), 1;
    const double at = row.at(a);
    shift = {e("X"), e("Y"), e("Z")};
    if (a == "X") shift += Eigen::Vector3d(at, -row.at("AL") * at, 0);
    if (a == "Y") shift += Eigen::Vector3d(0, at, 0);
    if (a == "Z") shift += Eigen::Vector3d(-row.at("B1") * at, -row.at("B2") * at, at);
  };
  Eigen::Vector3d p(row.at("XP"), row.at("YP"), row.at("ZP"));
  Eigen::Matrix3d turn;
  Eigen::Vector3d shift;
  const std::vector<std::string> tool = configuration["tool"], work = configuration["work"];
  for (auto a = tool.rbegin(); a != tool.rend(); ++a) {
    slide(*a, turn, shift);
    p = turn * p + shift;
  }
  for (const std::string& a : work) {
    slide(a, turn, shift);
    p = turn.inverse() * (p - shift);
  }
  return p;
}

TEST(ClosedForms, PublishedCasesAreReproduced) {
  constexpr double kPrinted = 0.51e-9;  // mm: half a unit of the last printed digit
  const auto published = json_of(kColumn + "equations.json")["configurations"];
  std::map<std::string, ErrorEquation> equations;
  for (const auto& [name, file] : kFiles) equations.emplace(name, derive::derive(reference_machine(file)));
  double worst_linear = 0, worst_product = 0, worst_chain = 0;
  const auto all = cases();
  ASSERT_EQ(all.size(), 56U);
  for (const auto& [name, row] : all) {
    const Reader read(equations.at(name));
    GiNaC::exmap numbers;
    for (const auto& [key, value] : row)
      if (key.size() < 4 && key[0] != 'd') numbers[read(key)] = value;
    const Machine machine = case_machine(name, row);
    const States states = case_states(machine, row);
    const Eigen::Vector3d chain = deviation(machine, states).col(0);
    const Eigen::Vector3d nominal = forward(nominal_machine(machine), states).position.col(0);
    const Eigen::Vector3d product = notes_product(published[name], row) - nominal;
    constexpr std::array<const char*, 3> kKeys = {"dX", "dY", "dZ"};
    for (Eigen::Index i = 0; i < 3; ++i) {
      const std::string key = kKeys[static_cast<std::size_t>(i)];
      const ex form = component(equations.at(name), static_cast<std::size_t>(i)).subs(numbers);
      const double linear = GiNaC::ex_to<GiNaC::numeric>(form.evalf()).to_double();
      worst_linear = std::max(worst_linear, std::abs(linear - row.at("linear_" + key)));
      worst_product = std::max(worst_product, std::abs(product[i] - row.at("full_" + key)));
      worst_chain = std::max(worst_chain, std::abs(chain[i] - row.at("full_" + key)));
    }
  }
  EXPECT_LT(worst_linear, kPrinted);
  EXPECT_LT(worst_product, kPrinted);
  // True rotations against small-angle matrices: three slides, 5e-5 * sqrt(3) rad each, levers up to 1.3 m;
  // |R - I - [e]x| <= |e|^2 a slide, twice that where the matrix is inverted. A lower bound keeps it honest.
  EXPECT_LT(worst_chain, 3 * 2 * 7.5e-9 * 1300);
  EXPECT_GT(worst_chain, 1e-8);
  std::printf("closed form %.2e mm, notes' product %.2e mm, chain %.2e mm off the printed cases\n",
              worst_linear, worst_product, worst_chain);
}

TEST(ClosedForms, FiveAxisJacobianEqualsThePublishedOne) {
  const auto model = json_of(kRoot + "/tests/data/spart/published_jacobian.json");
  const ErrorEquation equation = derive::derive(reference_machine("five_axis_bhead_ctable"));
  const Reader read(equation);
  ASSERT_EQ(equation.parameters.size(), 8U);
  constexpr std::array<const char*, 3> kKeys = {"dx", "dy", "dz"};
  for (std::size_t p = 0; p < 8; ++p) {
    const auto& column = model["jacobian"][equation.parameters[p].name];
    for (std::size_t i = 0; i < 3; ++i) {
      const ex form = read(column[kKeys[i]].get<std::string>());
      EXPECT_TRUE(canonical(equation.sensitivity[p][i] - form).is_zero())
          << equation.parameters[p].name << " " << kKeys[i] << ": " << equation.sensitivity[p][i];
    }
  }
  constexpr std::array<const char*, 3> kDirect = {"x", "y", "z"};
  constexpr std::array<const char*, 3> kAxis = {"sin(B)*cos(C)", "-sin(B)*sin(C)",
                                                "cos(B)"};  // the paper's tool axis
  for (std::size_t i = 0; i < 3; ++i) {
    const ex direct = read(model["direct"][kDirect[i]].get<std::string>());
    EXPECT_TRUE(canonical(equation.position[i] - direct).is_zero());
    const ex axis = read(kAxis[i]);
    EXPECT_TRUE(canonical(equation.tool_axis[i] - axis).is_zero());
  }
}

}  // namespace
}  // namespace vernier::closed_forms_test
