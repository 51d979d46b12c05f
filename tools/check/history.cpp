// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/check/history.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "tools/model/fit_record.h"
#include "tools/text/error.h"
#include "tools/text/numbers.h"
#include "tools/text/words.h"

namespace vernier::check {
namespace {

using Json = nlohmann::ordered_json;
using Eigen::Index;

/// Of the file's form. Version 1 took the set-up as almost that of the machine file: its records are not
/// comparable.
constexpr int kVersion = 2, kVersionOfOldSetUps = 1;

Json numbers(const Eigen::MatrixXd& matrix) {
  Json list = Json::array();
  for (Index j = 0; j < matrix.cols(); ++j)
    for (Index i = 0; i < matrix.rows(); ++i) list.push_back(matrix(i, j));
  return list;
}

Eigen::MatrixXd matrix_of(const Json& list, Index rows, Index columns) {
  if (list.size() != static_cast<std::size_t>(rows * columns))
    throw std::invalid_argument("the history file contains a matrix of the wrong size");
  Eigen::MatrixXd matrix(rows, columns);
  std::size_t at = 0;
  for (Index j = 0; j < columns; ++j)
    for (Index i = 0; i < rows; ++i) matrix(i, j) = list[at++].get<double>();
  return matrix;
}

}  // namespace

std::string identity_of(const model::Machine& machine) {
  std::string text = machine.name;
  for (std::size_t i = 0; i < machine.fitted->parameters.size(); ++i) {
    const std::string& name = machine.fitted->parameters[i];
    if (name.starts_with("BaseShift") || name.starts_with("ToolShift"))
      continue;  // a parameter of a set-up, not of the machine
    text += " " + name + "=" + text::number_text(machine.fitted->values[static_cast<Index>(i)]);
  }
  return text;
}

std::string history_text(const CheckHistory& history) {
  Json json = {{"format", "vernier-checks"}, {"version", kVersion}, {"machine", history.machine}};
  json["checks"] = Json::array();
  for (const CheckRecord& check : history.checks) {
    Json quantities = Json::array();
    for (const CheckedQuantity& one : check.quantities)
      quantities.push_back({{"name", one.name}, {"unit", one.unit}, {"of_instrument", one.of_instrument}});
    json["checks"].push_back({{"label", check.label},
                              {"readings", check.readings},
                              {"beyond_set_up", check.beyond_set_up},
                              {"parameters", check.parameters},
                              {"suspects", quantities},
                              {"gram", numbers(check.gram)},
                              {"moment", numbers(check.moment)},
                              {"rest", check.rest},
                              {"square", check.square},
                              {"freedom", check.freedom}});
  }
  return json.dump(1) + "\n";
}

CheckHistory parse_history(const std::string& text, const std::string& file) {
  try {
    if (text::nests_deeper_than(text, text::kMostJsonDepth))
      throw std::invalid_argument("the JSON of the history file is nested too deeply");
    const Json json = Json::parse(text);
    if (json.at("format") != "vernier-checks")
      throw std::invalid_argument("the key format is not vernier-checks");
    if (json.at("version") == kVersionOfOldSetUps) return {"", {}};
    if (json.at("version") != kVersion)
      throw std::invalid_argument("this program does not support this version of the history file");
    CheckHistory history{json.at("machine").get<std::string>(), {}};
    for (const Json& one : json.at("checks")) {
      CheckRecord check;
      check.label = one.at("label").get<std::string>();
      check.readings = one.at("readings").get<std::size_t>();
      check.beyond_set_up = one.at("beyond_set_up").get<double>();
      check.parameters = one.at("parameters").get<std::size_t>();
      for (const Json& quantity : one.at("suspects"))
        check.quantities.push_back({quantity.at("name").get<std::string>(),
                                    quantity.at("unit").get<std::string>(),
                                    quantity.at("of_instrument").get<bool>()});
      const auto count = static_cast<Index>(check.quantities.size());
      check.gram = matrix_of(one.at("gram"), count, count);
      check.moment = matrix_of(one.at("moment"), count, 1);
      check.rest = one.at("rest").get<double>();
      check.square = one.value("square", 0.0);  // older histories have none
      check.freedom = one.at("freedom").get<double>();
      if (check.parameters > check.quantities.size())
        throw std::invalid_argument("a check has more parameters than tested quantities");
      history.checks.push_back(std::move(check));
    }
    return history;
  } catch (const std::exception& error) {
    throw text::InputError({file, 0}, "",
                           fmt::format("this file is not a history of checks: {}", error.what()));
  }
}

}  // namespace vernier::check
