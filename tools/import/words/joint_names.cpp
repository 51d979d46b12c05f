// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/words/joint_names.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <optional>

#include "tools/format/units.h"
#include "tools/import/words/sheet_words.h"
#include "tools/text/numbers.h"
#include "tools/text/words.h"

namespace vernier::importer {
namespace {

/// The letters and digits of a name in small letters, without the words that say only that it is an axis.
std::string core_of(const std::string& name) {
  std::string core, word;
  const auto end_word = [&] {
    static constexpr const char* kEmpty[] = {"joint", "axis", "position", "pos", "angle"};
    if (std::find(std::begin(kEmpty), std::end(kEmpty), word) == std::end(kEmpty)) core += word;
    word.clear();
  };
  for (const char c : text::in_small_letters(name)) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0)
      word += c;
    else
      end_word();
  }
  end_word();
  return core;
}

/// A name that ends with a number: "actual_q_0" has the stem "actual_q_" and the number 0.
struct Numbered {
  std::string stem;
  std::size_t number = 0;
};

std::optional<Numbered> numbered(const std::string& name) {
  const std::size_t last = name.find_last_not_of("0123456789");
  if (last == std::string::npos || last + 1 == name.size()) return std::nullopt;
  const auto number = text::parse_count(std::string_view(name).substr(last + 1));
  if (!number) return std::nullopt;
  return Numbered{name.substr(0, last + 1), *number};
}

/// Can the unit be that of the axis? `stated`: a heading without a unit is not enough.
bool has_unit(const MissingAxis& axis, const FreeColumn& column, bool stated) {
  if (column.unit.empty()) return !stated;
  const auto unit = format::find_unit(column.unit);
  return unit && unit->dimension == (axis.rotary ? format::Dimension::kAngle : format::Dimension::kLength);
}

/// True for a number of the pose or the row: "Pose", "Nr.".
bool counts_rows(const FreeColumn& column) { return column.unit.empty() && heads_counting(column.heading); }

using JointPairs = std::vector<JointColumns::Pair>;

JointPairs by_names(const std::vector<MissingAxis>& axes, const std::vector<FreeColumn>& columns) {
  JointPairs pairs;
  for (std::size_t a = 0; a < axes.size(); ++a) {
    std::size_t found = 0, at = 0;
    for (std::size_t k = 0; k < columns.size(); ++k)
      if (!core_of(axes[a].name).empty() && core_of(columns[k].name) == core_of(axes[a].name) &&
          has_unit(axes[a], columns[k], true))
        ++found, at = k;
    if (found != 1) return {};
    pairs.push_back({a, at});
  }
  return pairs;
}

/// Families of names that differ by their number alone, by the stem: the indices of the names, in the order
/// of their numbers.
std::map<std::string, std::map<std::size_t, std::size_t>> families_of(const std::vector<std::string>& names) {
  std::map<std::string, std::map<std::size_t, std::size_t>> families;
  for (std::size_t k = 0; k < names.size(); ++k)
    if (const auto name = numbered(names[k])) families[name->stem].emplace(name->number, k);
  return families;
}

std::map<std::string, std::map<std::size_t, std::size_t>> families_of(
    const std::vector<FreeColumn>& columns) {
  std::vector<std::string> names;
  for (const FreeColumn& column : columns) names.push_back(column.name);
  return families_of(names);
}

/// The numbers of axes whose names have one stem; empty for other axes.
std::vector<std::size_t> numbers_of(const std::vector<MissingAxis>& axes) {
  std::vector<std::size_t> numbers;
  std::string stem;
  for (const MissingAxis& axis : axes) {
    const auto name = numbered(axis.name);
    if (!name || (!numbers.empty() && name->stem != stem)) return {};
    stem = name->stem;
    numbers.push_back(name->number);
  }
  return numbers;
}

/// JointPairs of one family for each family with the numbers of the axes.
std::vector<JointPairs> by_numbers(const std::vector<MissingAxis>& axes,
                                   const std::vector<FreeColumn>& columns) {
  const std::vector<std::size_t> numbers = numbers_of(axes);
  std::vector<JointPairs> all;
  for (const auto& [stem, family] : families_of(columns)) {
    JointPairs pairs;
    for (std::size_t a = 0; a < numbers.size(); ++a)
      if (const auto found = family.find(numbers[a]);
          found != family.end() && has_unit(axes[a], columns[found->second], true))
        pairs.push_back({a, found->second});
    if (!numbers.empty() && pairs.size() == axes.size() && family.size() == axes.size()) all.push_back(pairs);
  }
  return all;
}

JointPairs by_order(const std::vector<MissingAxis>& axes, const std::vector<FreeColumn>& columns) {
  const auto in_order = [&](const std::vector<std::size_t>& order) {
    JointPairs pairs;
    for (std::size_t a = 0; a < axes.size() && order.size() == axes.size(); ++a)
      if (has_unit(axes[a], columns[order[a]], false)) pairs.push_back({a, order[a]});
    return pairs.size() == axes.size() ? pairs : JointPairs{};
  };
  std::vector<JointPairs> all;
  for (const auto& [stem, family] : families_of(columns)) {
    std::vector<std::size_t> order;
    for (const auto& [number, k] : family) order.push_back(k);
    if (JointPairs pairs = in_order(order); !pairs.empty()) all.push_back(std::move(pairs));
  }
  if (all.size() == 1) return all.front();
  if (all.size() > 1) return {};
  std::vector<std::size_t> order;
  for (std::size_t k = 0; k < columns.size(); ++k)
    if (!counts_rows(columns[k]) && std::any_of(axes.begin(), axes.end(), [&](const MissingAxis& axis) {
          return has_unit(axis, columns[k], false);
        }))
      order.push_back(k);
  return in_order(order);
}

}  // namespace

JointColumns joint_columns(const std::vector<MissingAxis>& axes, const std::vector<FreeColumn>& columns) {
  if (axes.empty()) return {};
  if (JointPairs pairs = by_names(axes, columns); !pairs.empty())
    return {std::move(pairs), true, "by their names"};
  std::vector<JointPairs> numbers = by_numbers(axes, columns);
  if (numbers.size() == 1) return {std::move(numbers.front()), true, "by their numbers"};
  if (numbers.size() > 1) return {};  // actual and target positions, for example
  return {by_order(axes, columns), false, "by their order"};
}

std::string axis_names(const std::vector<MissingAxis>& axes) {
  std::string names;
  for (const MissingAxis& axis : axes) names += (names.empty() ? "" : ",") + axis.name;
  return names;
}

std::string joint_series(const std::vector<std::string>& names) {
  constexpr std::size_t kFewestJoints = 5;  // fewer numbered columns are runs or points as well
  for (const auto& [stem, family] : families_of(names)) {
    const std::size_t first = family.begin()->first, last = family.rbegin()->first;
    if (family.size() >= kFewestJoints && first < 2 && last - first + 1 == family.size())
      return names[family.begin()->second] + " to " + names[family.rbegin()->second];
  }
  return "";
}

std::string column_word(const MissingAxis& axis, const FreeColumn& column) {
  const std::string assumed = !column.assumed.empty() ? column.assumed : axis.rotary ? "deg" : "mm";
  return axis.name + (column.unit.empty() ? "[" + assumed + "]" : "") + "=" + column.heading;
}

}  // namespace vernier::importer
