// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/logs/nominal_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "tools/format/columns.h"
#include "tools/text/numbers.h"
#include "tools/text/words.h"

namespace vernier::importer {
namespace {

std::string heading_of(const model::Axis& axis) {
  return format::axis_heading(format::AxisQuantity::kPosition, axis.name, axis.rotary);
}

bool states_a_unit(const OpenAxes& open) {
  return std::any_of(open.found.pairs.begin(), open.found.pairs.end(),
                     [&](const auto& pair) { return !open.columns[pair.column].unit.empty(); });
}

/// Takes the columns whose names or numbers are those of the axes, if their units are clear.
void settle_sure(ListedRows& list) {
  const OpenAxes& open = list.open;
  std::vector<std::size_t> bare;
  bool joints = true;
  for (const auto& [axis, column] : open.found.pairs) {
    joints = joints && open.axes[axis].rotary;
    if (open.columns[column].unit.empty()) bare.push_back(open.at[column]);
  }
  const bool degrees = joints && !states_a_unit(open) && exceeds_a_turn(list.reading, bare);
  if (!bare.empty() && !degrees) return;
  if (!bare.empty())
    list.note = fmt::format("{}: the columns of the joints ({} ...) have no unit: they are read in degrees",
                            list.reading.sheet.file, list.reading.table.headings[bare.front()].text);
  assign_open_axes(list);
  list.open = {};
}

/// The axes of `open` that are needed.
void keep_needed(OpenAxes& open, const std::function<bool(const std::string& axis)>& needed) {
  OpenAxes kept = open;
  kept.axes.clear();
  kept.found.pairs.clear();
  for (std::size_t a = 0; a < open.axes.size(); ++a) {
    if (!needed(open.axes[a].name)) continue;
    kept.axes.push_back(open.axes[a]);
    for (const JointColumns::Pair& pair : open.found.pairs)
      if (pair.axis == a) kept.found.pairs.push_back({kept.axes.size() - 1, pair.column});
  }
  open = std::move(kept);
}

std::string counted_words(const ListedRows& list, const SheetWishes::Assignment& wish) {
  const auto counting = list.counting.find(wish.column.name);
  return counting == list.counting.end() ? wish.heading : in_words({wish.heading, counting->second});
}

/// Takes signs and addends out of the assignments of the user: a word that is a heading as it stands has
/// none.
std::map<std::string, AxisCounting> take_counting(const NominalList& nominal, SheetWords& words) {
  std::map<std::string, AxisCounting> counting;
  std::vector<sheet::Heading> headings;
  for (std::string& word : words.columns) {
    const std::size_t at = word.find('=');
    if (at == std::string::npos) continue;
    const std::vector<CountedHeading> readings = counted_headings(word.substr(at + 1));
    if (readings.size() < 2) continue;
    if (headings.empty()) {
      SheetWords without = words;
      without.columns.clear();
      headings = read_as_sheet(nominal.bytes, nominal.file, without).table.headings;
    }
    for (const CountedHeading& one : readings) {
      const auto number = text::parse_count(one.heading);
      if (!(number && *number >= 1 && *number <= headings.size()) &&
          std::none_of(headings.begin(), headings.end(), [&](const sheet::Heading& heading) {
            return heading.text == one.heading || heading.name == one.heading;
          }))
        continue;
      if (!one.counting.is_that_of_machine())
        counting[text::trimmed(word.substr(0, std::min(at, word.find('['))))] = one.counting;
      word = word.substr(0, at + 1) + one.heading;
      break;
    }
  }
  return counting;
}

/// The words of the user's assignments, but for the axes that `words` assign, and then `words`.
std::vector<std::string> with_users_words(const ListedRows& list, std::vector<std::string> words) {
  std::vector<std::string> all;
  for (const SheetWishes::Assignment& wish : list.reading.wishes.assignments)
    if (std::none_of(words.begin(), words.end(), [&](const std::string& word) {
          return word.starts_with(wish.column.name + "[") || word.starts_with(wish.column.name + "=");
        }))
      all.push_back(format::heading(wish.column.name, wish.column.unit) + "=" + counted_words(list, wish));
  all.insert(all.end(), std::make_move_iterator(words.begin()), std::make_move_iterator(words.end()));
  return all;
}

}  // namespace

void assign_open_axes(ListedRows& list) {
  const OpenAxes& open = list.open;
  for (const JointColumns::Pair& pair : open.found.pairs) {
    const FreeColumn& free = open.columns[pair.column];
    SheetColumn& column = list.reading.columns[open.at[pair.column]];
    column.name = open.axes[pair.axis].name;
    column.unit = free.unit.empty() ? free.assumed : free.unit;
  }
}

ListedRows read_nominal_list(const NominalList& nominal, const model::Machine& machine,
                             const std::function<bool(const std::string& axis)>& needed) {
  SheetWords words;
  words.columns = nominal.columns;
  words.column_option = nominal.option;
  for (const model::Axis& axis : machine.axes) words.axes.push_back(axis.name);
  const std::map<std::string, AxisCounting> counting = take_counting(nominal, words);
  ListedRows list{read_as_sheet(nominal.bytes, nominal.file, words), {}, {}, {}, counting};
  OpenAxes& open = list.open;
  const sheet::Sheet& sheet = list.reading.sheet;
  for (std::size_t row = list.reading.table.first_data; row < sheet.rows.size(); ++row)
    if (!sheet::is_blank(sheet.rows[row])) list.rows.push_back(row);
  open = open_axes_without_units(machine, list.reading);
  if (!open.axes.empty() && open.complete() && open.found.sure) settle_sure(list);
  keep_needed(open, needed);
  return list;
}

bool asks_for_unit_of_angles(const ListedRows& list) {
  const OpenAxes& open = list.open;
  return open.complete() && !states_a_unit(open) &&
         std::any_of(open.axes.begin(), open.axes.end(), [](const MissingAxis& axis) { return axis.rotary; });
}

std::size_t column_of_axis(const ListedRows& list, const model::Axis& axis) {
  const std::vector<SheetColumn>& columns = list.reading.columns;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    if (columns[k].use != SheetColumn::Use::kColumn || columns[k].name != axis.name) continue;
    if (columns[k].unit.empty())
      throw text::InputError(
          list.heading(), list.reading.table.headings[k].text,
          "this heading has no unit: state the unit in the list or in the option, for example " +
              heading_of(axis));
    return k;
  }
  throw text::InputError(list.heading(), axis.name,
                         "the list of nominal positions has no column for this axis");
}

std::string way_on(const NominalList& nominal, const ListedRows& list,
                   const std::vector<std::string>& words) {
  const std::vector<std::string> all = with_users_words(list, words);
  if (nominal.call) return nominal.call(all);
  std::string options;
  for (const std::string& word : all)
    options += fmt::format("{}{} \"{}\"", options.empty() ? "" : " ", nominal.option, word);
  return options;
}

void refuse_open_axes(const NominalList& nominal, const ListedRows& list, const model::Machine& machine,
                      const std::string& units) {
  const OpenAxes& open = list.open;
  std::string names;
  bool without_column = false, bare = false;
  const auto pair_of = [&](std::size_t axis) {
    return std::find_if(open.found.pairs.begin(), open.found.pairs.end(),
                        [&](const auto& pair) { return pair.axis == axis; });
  };
  for (std::size_t a = 0; a < open.axes.size(); ++a) {
    names += (names.empty() ? "" : ", ") + open.axes[a].name;
    const auto pair = pair_of(a);
    const bool named = pair != open.found.pairs.end() && open.columns[pair->column].name == open.axes[a].name;
    without_column = without_column || !named;
    bare = bare || (pair != open.found.pairs.end() && open.columns[pair->column].unit.empty());
  }
  std::string what = without_column
                         ? "the list of nominal positions has no column with the name of these axes"
                         : "the headings of these axes have no unit in the list of nominal positions";
  if (open.complete()) {
    if (without_column)
      what += open.found.sure
                  ? fmt::format(", and its columns {} .. {} have no unit",
                                open.columns[open.found.pairs.front().column].heading,
                                open.columns[open.found.pairs.back().column].heading)
                  : ", and as many other columns may be the axes in the order of the machine file";
    what += units;
    what += fmt::format(". If this assignment{} right, give: ", bare ? " and its units are" : " is");
    throw text::InputError(list.heading(), names, what + way_on(nominal, list, open.words()));
  }
  std::vector<std::string> words = open.words();
  for (std::size_t a = 0; a < open.axes.size(); ++a)
    if (pair_of(a) == open.found.pairs.end())
      words.push_back(heading_of(machine.axes[*machine.find_axis(open.axes[a].name)]) + "=HEADING");
  std::string headings;
  for (const sheet::Heading& heading : list.reading.table.headings)
    headings += (headings.empty() ? "" : ", ") + heading.text;
  throw text::InputError(
      list.heading(), names,
      fmt::format("{}: state their columns, with a heading of the list in the place of HEADING ({}), and "
                  "the unit of the values: {}",
                  what, headings, way_on(nominal, list, words)));
}

}  // namespace vernier::importer
