// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/report/thinning.h"

#include <algorithm>
#include <set>
#include <stdexcept>

#include "tools/report/payload.h"

namespace vernier::report {
namespace {

using Json = nlohmann::ordered_json;

[[noreturn]] void contradiction(const std::string& what) { throw std::invalid_argument("report: " + what); }

std::size_t index_below(const Json& value, std::size_t count, const char* what) {
  if (!value.is_number_integer() || value.get<std::int64_t>() < 0 || value.get<std::size_t>() >= count) {
    contradiction(std::string(what) + " is no index below " + std::to_string(count));
  }
  return value.get<std::size_t>();
}

// The entries `which` of a row of values.
Json selected(const Json& values, const std::vector<std::size_t>& which) {
  Json result = Json::array();
  for (const std::size_t i : which) result.push_back(values.at(i));
  return result;
}

std::size_t row_count(const Json& detail) {
  if (detail.contains("column_data") && !detail["column_data"].empty())
    return detail["column_data"][0].size();
  return detail.contains("row_check") ? detail["row_check"].size() : 0;
}

void check_lengths(const Json& detail) {
  const std::size_t rows = row_count(detail);
  if (detail.value("columns", Json::array()).size() != detail.value("column_data", Json::array()).size())
    contradiction("columns and column_data differ in number");
  for (const Json& column : detail.value("column_data", Json::array())) {
    if (column.size() != rows) contradiction("columns of different length");
  }
  for (const char* key : {"row_run", "row_check", "row_line"}) {
    if (detail.contains(key) && detail[key].size() != rows)
      contradiction(std::string(key) + " and the columns differ in length");
  }
  const Json& observations = detail.at("observations");
  const std::size_t kinds = observations.at("kind").size(), count = observations.at("row").size();
  for (const char* key : {"kind_index", "residual"}) {
    if (observations.at(key).size() != count)
      contradiction(std::string("observations: ") + key + " and row differ in length");
  }
  for (const Json& kind : observations["kind_index"]) index_below(kind, kinds, "kind_index");
  for (const Json& row : observations["row"]) index_below(row, rows, "an observation's row");
}

std::set<std::size_t> worst_rows(const Json& detail) {
  std::set<std::size_t> rows;
  for (const Json& worst : detail.value("worst", Json::array()))
    rows.insert(index_below(worst.at("row"), row_count(detail), "a worst row"));
  return rows;
}

std::size_t largest_kind(const Json& observations) {
  std::vector<std::size_t> count(observations.at("kind").size() + 1, 0);
  for (const Json& kind : observations.at("kind_index")) ++count[kind.get<std::size_t>()];
  return *std::max_element(count.begin(), count.end());
}

// Counted within each kind. The kinds alternate in the list, and a count over all would omit whole
// kinds.
std::vector<std::size_t> observations_to_keep(const Json& detail, std::size_t step) {
  const std::set<std::size_t> worst = worst_rows(detail);
  const Json& observations = detail.at("observations");
  std::vector<std::size_t> seen(observations.at("kind").size(), 0), keep;
  for (std::size_t i = 0; i < observations.at("row").size(); ++i) {
    const std::size_t nth = seen[observations["kind_index"][i].get<std::size_t>()]++;
    if (nth % step == 0 || worst.contains(observations["row"][i].get<std::size_t>())) keep.push_back(i);
  }
  return keep;
}

// Keeps those rows that an observation refers to, and renumbers.
void keep_rows(Json& detail) {
  std::set<std::size_t> used = worst_rows(detail);
  for (const Json& row : detail["observations"]["row"]) used.insert(row.get<std::size_t>());
  const std::vector<std::size_t> rows(used.begin(), used.end());
  const auto renumbered = [&rows](const Json& row) {
    return static_cast<std::size_t>(std::lower_bound(rows.begin(), rows.end(), row.get<std::size_t>()) -
                                    rows.begin());
  };
  if (detail.contains("column_data")) {
    for (Json& column : detail["column_data"]) column = selected(column, rows);
  }
  for (const char* key : {"row_run", "row_check", "row_line"}) {
    if (detail.contains(key)) detail[key] = selected(detail[key], rows);
  }
  for (Json& row : detail["observations"]["row"]) row = renumbered(row);
  if (detail.contains("worst")) {
    for (Json& worst : detail["worst"]) worst["row"] = renumbered(worst["row"]);
  }
}

void thin_circle(Json& run, std::size_t most) {
  const std::size_t count = run.at("angle_deg").size();
  for (const char* key : {"measured_um", "model_um", "check"}) {
    if (run.contains(key) && !run[key].is_null() && run[key].size() != count)
      contradiction(std::string("circular: ") + key + " and angle_deg differ in length");
  }
  if (count <= most) return;
  const std::size_t step = (count + most - 1) / most;
  std::vector<std::size_t> keep;
  for (std::size_t i = 0; i < count; i += step) keep.push_back(i);
  for (const char* key : {"angle_deg", "measured_um", "model_um", "check"}) {
    if (run.contains(key) && !run[key].is_null()) run[key] = selected(run[key], keep);
  }
}

}  // namespace

Json thinned_detail(const Json& detail, std::size_t most) {
  Json result = detail;
  if (result.contains("circular")) {
    for (Json& circle : result["circular"]) {
      for (Json& run : circle.at("runs")) thin_circle(run, most);
    }
  }
  if (!result.contains("observations")) return result;
  check_lengths(result);
  const std::size_t count = result["observations"]["row"].size();
  Json& observations = result["observations"];
  // The page shows residuals only.
  observations.erase("measured");
  observations.erase("model");
  const std::size_t largest = largest_kind(observations);
  if (largest <= most) return result;
  const std::size_t step = (largest + most - 1) / most;
  const std::vector<std::size_t> keep = observations_to_keep(result, step);
  for (const char* key : {"row", "kind_index", "residual"})
    observations[key] = selected(observations[key], keep);
  keep_rows(result);
  result["thinned"] = {{"kept", keep.size()}, {"of", count}, {"step", step}};
  return result;
}

}  // namespace vernier::report
