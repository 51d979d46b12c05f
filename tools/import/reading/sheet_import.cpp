// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/reading/sheet_import.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "tools/format/columns.h"
#include "tools/format/units.h"
#include "tools/import/columns/column_guess.h"
#include "tools/import/columns/columns_beside.h"
#include "tools/import/columns/odd_names.h"
#include "tools/import/columns/signed_positions.h"
#include "tools/import/columns/stated_order.h"
#include "tools/import/columns/values_beside.h"
#include "tools/import/reading/axis_rows.h"
#include "tools/import/reading/degree_cells.h"
#include "tools/import/reading/invalid_rows.h"
#include "tools/import/reading/odd_rows.h"
#include "tools/import/reading/other_quantities.h"
#include "tools/import/reading/paired_sheets.h"
#include "tools/import/reading/plain_cells.h"
#include "tools/import/reading/rows_below.h"
#include "tools/import/reading/side_runs.h"
#include "tools/import/reading/side_statistics.h"
#include "tools/import/reading/title_lines.h"
#include "tools/import/reading/title_positions.h"
#include "tools/import/reading/unused_texts.h"
#include "tools/import/reading/verdict_columns.h"
#include "tools/import/sizes/contradicting_repeats.h"
#include "tools/import/sizes/deviation_sizes.h"
#include "tools/import/sizes/mistyped_cells.h"
#include "tools/import/sizes/odd_runs.h"
#include "tools/import/sizes/outlying_cells.h"
#include "tools/import/sizes/point_rows.h"
#include "tools/import/sizes/position_sizes.h"
#include "tools/import/sizes/row_shift.h"
#include "tools/import/sizes/typed_cells.h"
#include "tools/import/tables/computed_rows.h"
#include "tools/import/tables/directions.h"
#include "tools/import/tables/run_signs.h"
#include "tools/import/tables/table_shape.h"
#include "tools/import/tables/thousands.h"
#include "tools/import/tables/wide_sheet.h"
#include "tools/import/words/foreign_letters.h"
#include "tools/import/words/sheet_words.h"
#include "tools/import/words/sign_words.h"
#include "tools/import/words/table_texts.h"
#include "tools/import/words/title_units.h"
#include "tools/sheet/formatted_columns.h"
#include "tools/sheet/several_tables.h"
#include "tools/sheet/sheet_number.h"
#include "tools/text/error.h"
#include "tools/text/words.h"

namespace vernier::importer {
namespace {

SheetWishes wishes_of(const SheetWords& words, SheetWishes wishes) {
  if (!words.separator.empty()) wishes.format.separator = separator_of(words.separator);
  if (!words.decimal.empty()) {
    if (words.decimal != "comma" && words.decimal != "point")
      throw text::InputError(fmt::format("\"{}\": a decimal sign is comma or point", words.decimal));
    wishes.format.decimal_comma = words.decimal == "comma";
  }
  if (!words.comment.empty()) wishes.format.comment = words.comment == "none" ? "" : words.comment;
  if (words.skip) wishes.format.skip = *words.skip;
  if (words.table) wishes.format.table = words.table;
  if (!words.sheet.empty()) wishes.format.sheet = words.sheet;
  if (!words.axes.empty()) wishes.axes = words.axes;
  wishes.fill.insert(wishes.fill.end(), words.fill.begin(), words.fill.end());
  wishes.one_motion |= words.one_motion;
  if (!words.sign.empty()) wishes.turned = turned_of(words.sign);
  if (!words.directions.empty()) {
    if (words.directions != kFromOrder)
      throw text::InputError(fmt::format("--directions {}: only {} is known", words.directions, kFromOrder));
    wishes.directions_from_order = true;
  }
  if (!words.unit.empty()) {
    const auto unit = sheet::unit_meant(words.unit);
    if (!unit)
      throw text::InputError("--unit " + words.unit + ": unknown unit; known are " + format::known_units());
    wishes.unit = *unit;
  }
  for (const std::string& one : words.constants) {
    ColumnMap map;
    add_constant(map, one);
    wishes.constants.push_back(map.columns.front());
  }
  return wishes;
}

/// The wishes with the columns that the user assigned. An assignment that is not valid for the headings
/// before the runs are joined is valid later, or is refused later.
SheetWishes with_columns(const SheetWords& words, const sheet::SheetTable& table, SheetWishes wishes) {
  for (const std::string& one : words.columns) try {
      assign_column(wishes, table, one);
    } catch (const text::InputError&) {
      continue;
    }
  return wishes;
}

/// Does an empty cell of this column have the value above it? A run or a set-up that only its first row names
/// applies to the rows below; other columns only if the user states it.
bool is_filled_down(const SheetReading& reading, std::size_t k) {
  const SheetColumn& column = reading.columns[k];
  if (column.use == SheetColumn::Use::kLeft) return false;
  for (const std::string& wish : reading.wishes.fill)
    if (find_heading(reading.table, wish) == k) return true;
  return column.use == SheetColumn::Use::kColumn &&
         (column.name == format::columns::kRun || column.name == format::columns::kSetup);
}

/// Refuses to fill a cell of a row that has a word where the other rows have numbers: a mean or another row
/// that is no measurement would get the position of the row above it.
void refuse_to_fill(const SheetReading& reading, std::size_t row, std::size_t filled) {
  const sheet::Sheet& sheet = reading.sheet;
  for (std::size_t k = 0; k < reading.columns.size(); ++k) {
    const std::string& cell = sheet.rows[row][k];
    const auto number = [&](const std::string& text) {
      return sheet::plain_number(text, sheet.decimal_comma).has_value();
    };
    if (k == filled || is_missing(cell) || number(cell)) continue;
    std::size_t numbers = 0, words = 0;
    for (std::size_t other = reading.table.first_data; other < sheet.rows.size(); ++other) {
      if (is_missing(sheet.rows[other][k])) continue;
      ++(number(sheet.rows[other][k]) ? numbers : words);
    }
    const std::string advice = advice_for_text(cell);
    if (numbers > words)
      throw text::InputError(
          {sheet.file, sheet.line[row]}, cell,
          fmt::format("{}this row has a word where the other rows have a number (\"{}\"), and no value for "
                      "\"{}\": if the row is no measurement (a mean, a sum), delete the row; otherwise write "
                      "the value into the empty cell",
                      advice.empty() ? "" : advice + "; ", reading.table.headings[k].text,
                      reading.table.headings[filled].text));
  }
}

void fill_down(SheetReading& reading) {
  sheet::Sheet& sheet = reading.sheet;
  for (std::size_t k = 0; k < reading.columns.size(); ++k) {
    const std::size_t first = reading.table.first_data;
    if (first >= sheet.rows.size() || sheet.rows[first][k].empty() || !is_filled_down(reading, k)) continue;
    std::size_t filled = 0;
    std::string above;
    for (std::size_t row = first; row < sheet.rows.size(); ++row) {
      std::vector<std::string>& cells = sheet.rows[row];
      if (sheet::is_blank(cells)) continue;
      if (!cells[k].empty()) {
        above = cells[k];
        continue;
      }
      refuse_to_fill(reading, row, k);
      cells[k] = above;
      ++filled;
    }
    if (filled > 0)
      sheet.notes.push_back(fmt::format("{} empty cells below \"{}\" get the value above them", filled,
                                        reading.table.headings[k].text));
  }
}

/// Notes the columns of numbers with few values: a fit leaves out rows without a value.
void note_sparse_columns(SheetReading& reading) {
  for (std::size_t k = 0; k < reading.columns.size(); ++k) {
    const SheetColumn& column = reading.columns[k];
    if (column.use == SheetColumn::Use::kLeft || column.words) continue;
    std::size_t empty = 0, rows = 0;
    for (std::size_t row = reading.table.first_data; row < reading.sheet.rows.size(); ++row) {
      const std::vector<std::string>& cells = reading.sheet.rows[row];
      if (sheet::is_blank(cells)) continue;
      ++rows;
      empty += cells[k].empty() ? 1 : 0;
    }
    if (2 * empty > rows)
      reading.sheet.notes.push_back(fmt::format(
          "{} of {} cells below \"{}\" are empty; if the value above them applies, give --fill \"{}\"", empty,
          rows, reading.table.headings[k].text, reading.table.headings[k].text));
  }
}

/// Notes columns of numbers without a heading that no option names: they are inputs, and may be a second run.
void note_unnamed_columns(SheetReading& reading) {
  for (std::size_t k = 0; k < reading.columns.size(); ++k)
    if (const SheetColumn& column = reading.columns[k];
        column.use == SheetColumn::Use::kColumn && column.why == "by its heading" &&
        reading.table.headings[k].text == std::to_string(k + 1) && column.name.starts_with("column_"))
      reading.sheet.notes.push_back(fmt::format(
          "column {0} has no heading and is read as an input of the machine ({1}), such as a temperature: if "
          "it has readings, write its heading; --leave {0} leaves it out",
          k + 1, column.name));
}

/// Notes deviations beside a rotary axis that moves: sensors on the rotating part measure in their own frame,
/// and then a deviation is not along the axis that its heading names.
void note_rotating_frame(SheetReading& reading) {
  const auto moves = [&](std::size_t k) {
    std::set<std::string> values;
    for (std::size_t row = reading.table.first_data; row < reading.sheet.rows.size(); ++row)
      if (!sheet::is_blank(reading.sheet.rows[row])) values.insert(reading.sheet.rows[row][k]);
    return values.size() > 1;
  };
  std::string rotary, columns;
  for (std::size_t k = 0; k < reading.columns.size(); ++k) {
    const SheetColumn& column = reading.columns[k];
    const std::string& heading = reading.table.headings[k].text;
    if (column.use == SheetColumn::Use::kColumn && is_angle(column.unit) && column.name.size() == 1 &&
        moves(k))
      rotary = column.name;
    if (column.use != SheetColumn::Use::kDeviation || column.why != "by its heading" || is_angle(column.unit))
      continue;
    columns += fmt::format(" --column \"{}[{}]={}\"", text::in_small_letters(column.name),
                           column.unit.empty() ? "um" : column.unit, heading);
  }
  if (!rotary.empty() && !columns.empty())
    reading.sheet.notes.push_back(
        fmt::format("the axis {} rotates: if the instrument is fixed on the part that rotates (R-test), its "
                    "deviations are not "
                    "along the axes of the machine; then give{}",
                    rotary, columns));
}

/// Name of the axis whose position a column of readings has: X for x, A for rx; empty for other columns.
std::string axis_measured(const std::string& reading) {
  for (const char* const axis : {"X", "Y", "Z", "A", "B", "C"})
    if (reading_of(axis) == reading) return axis;
  return "";
}

/// Notes the divisions of dial gauges and unusual sizes; a size that only a wrong unit or a wrong cell
/// explains is a doubt of its column.
/// `found`: headings that the program assigned itself, so that the user stated no unit.
void judge_sizes(SheetReading& reading, const std::vector<std::string>& found) {
  const Guess guess(reading.wishes);
  std::vector<SizedColumn> sized;
  for (std::size_t k = 0; k < reading.columns.size(); ++k) {
    const SheetColumn& column = reading.columns[k];
    const bool by_user = std::find(found.begin(), found.end(), reading.table.headings[k].text) == found.end();
    SizedColumn one;
    if (column.use != SheetColumn::Use::kLeft) {
      const bool deviation = column.use == SheetColumn::Use::kDeviation;
      one = {deviation ? SizedColumn::Use::kDeviation : SizedColumn::Use::kPosition,
             column.name,
             column.unit,
             column.to_target ? text::in_small_letters(column.name) : column.name,
             (column.why == "as given" && by_user) || column.why == "by the profile",
             column.why == "by the profile",
             deviation ? "" : axis_measured(column.name),
             !deviation && guess.is_axis(column.name)};
    }
    sized.push_back(std::move(one));
  }
  note_decimal_parts(reading.sheet, reading.table, sized);
  std::vector<SizeDoubt> doubts = judge_angle_units(reading.sheet, reading.table, sized);
  remove_whole_turns(reading.sheet, reading.table, sized);
  for (SizeDoubt& doubt : judge_raw_readings(reading.sheet, reading.table, sized))
    doubts.push_back(std::move(doubt));
  for (SizeDoubt& doubt : judge_small_motions(reading.sheet, reading.table, sized))
    doubts.push_back(std::move(doubt));
  for (SizeDoubt& doubt : judge_row_shift(reading.sheet, reading.table, sized))
    doubts.push_back(std::move(doubt));
  for (SizeDoubt& doubt : judge_points(reading.sheet, reading.table, sized))
    doubts.push_back(std::move(doubt));
  for (SizeDoubt& doubt : judge_measured_positions(reading.sheet, reading.table, sized))
    doubts.push_back(std::move(doubt));
  for (SizeDoubt& doubt :
       judge_deviation_sizes(reading.sheet, reading.table, sized, reading.wishes.plausible))
    doubts.push_back(std::move(doubt));
  // A run or a direction in another unit is named as such.
  for (SizeDoubt& doubt : judge_mixed_units(reading.sheet, reading.table, sized))
    doubts.push_back(std::move(doubt));
  for (SizeDoubt& doubt : judge_targets(reading.sheet, reading.table, sized))
    doubts.push_back(std::move(doubt));
  for (SizeDoubt& doubt : judge_lost_signs(reading.sheet, reading.table, sized))
    doubts.push_back(std::move(doubt));
  for (const SizeDoubt& doubt : doubts) {
    SheetColumn& column = reading.columns[doubt.column];
    if (!column.doubt.empty()) continue;
    column.doubt_place = {reading.sheet.file, doubt.line};
    column.doubt_word = doubt.word.empty() ? reading.table.headings[doubt.column].text : doubt.word;
    column.doubt = doubt.text;
  }
  if (!doubts.empty()) return;
  note_outlying_cells(reading.sheet, reading.table, sized);
  note_mistyped_cells(reading.sheet, reading.table, sized);
  note_contradicting_repeats(reading.sheet, reading.table, sized);
  note_odd_runs(reading.sheet, reading.table, sized);
  note_other_scales(reading.sheet, reading.table, sized);
}

/// Notes the titles that stated the units of deviations and positions.
void note_units(SheetReading& reading) {
  std::set<std::pair<bool, std::string>> noted;
  for (const SheetColumn& column : reading.columns) {
    const bool deviation = column.use == SheetColumn::Use::kDeviation;
    if (!column.unit_from.empty() && noted.insert({deviation, column.unit_from}).second)
      reading.sheet.notes.push_back(
          note_of_title_unit(deviation ? "deviations" : "positions", {column.unit, column.unit_from}));
  }
}

/// Notes the texts that stated the sign, and texts of other tables that state one for themselves.
void note_signs(SheetReading& reading) {
  if (reading.wishes.turned) return;
  std::set<std::string> noted;
  bool deviations = false;
  for (const SheetColumn& column : reading.columns) {
    const bool deviation = column.use == SheetColumn::Use::kDeviation;
    if (!deviation && column.sign_from.empty()) continue;  // a deviation of a length states it too
    deviations |= deviation;
    if (!column.sign_text.empty()) continue;  // the table is refused
    if (column.sign_from.empty() || !noted.insert(column.sign_from).second) continue;
    reading.sheet.notes.push_back(
        fmt::format("the sign of the deviations is {}, by the text \"{}\"; if this is wrong, give --sign {}",
                    column.turned ? "nominal - actual" : "actual - nominal", column.sign_from,
                    column.turned ? "actual-nominal" : "nominal-actual"));
  }
  for (const sheet::TextElsewhere& other : reading.sheet.elsewhere) {
    const SignSaid said =
        other.table && deviations ? sign_said(other.text, SignPlace::kTitle) : SignSaid::kNothing;
    if (said == SignSaid::kNothing || !noted.insert(other.text).second) continue;
    reading.sheet.notes.push_back(
        fmt::format("the sheet {} has the text \"{}\"; if it is about this sheet too, give --sign "
                    "nominal-actual or --sign "
                    "actual-nominal",
                    other.sheet, other.text));
  }
}

void leave_columns(SheetReading& reading, const std::vector<std::string>& left) {
  for (const std::string& heading : left) {
    if (find_heading(reading.table, heading) == std::string::npos)
      refuse_heading(reading.table, "--leave", heading);
    SheetColumn column;
    column.use = SheetColumn::Use::kLeft;
    reading.wishes.assignments.push_back({heading, column, {}});
  }
}

/// True if an option or a profile states the column of an axis: the table then has positions, and is no table
/// of distances between named points.
bool assigns_axis(const SheetWords& words, const SheetWishes& wishes) {
  const Guess guess(wishes);
  const auto names_axis = [&](const std::string& side) {
    return guess.is_axis(text::trimmed(side.substr(0, side.find('['))));
  };
  for (const std::vector<std::string>* const list : {&words.columns, &words.deviations})
    for (const std::string& one : *list)
      if (const std::size_t sign = one.find('='); sign != std::string::npos)
        if (names_axis(one.substr(0, sign)) || names_axis(one.substr(sign + 1))) return true;
  return std::any_of(wishes.assignments.begin(), wishes.assignments.end(),
                     [&](const auto& wish) { return guess.is_axis(wish.column.name); });
}

/// A table of distances between named points.
void read_distances(SheetReading& reading, const PairSheet& pairs, const SheetWords& words) {
  for (const std::string& one : words.columns) assign_column(reading.wishes, reading.table, one);
  leave_columns(reading, words.left);
  std::string ask;
  reading.columns = distance_columns(reading.sheet, reading.table, pairs, reading.wishes, ask);
  reading.distances =
      distances_of(reading.sheet, reading.table, pairs, reading.columns, reading.wishes, words.points, ask);
  for (const std::string& note : reading.distances->notes) reading.sheet.notes.push_back(note);
  // The table is shown with the names of its points.
  for (std::size_t row = reading.table.first_data; row < reading.sheet.rows.size(); ++row)
    restore_pair(reading.sheet.rows[row][pairs.column], pairs);
}

/// Positions of points are for tables of distances only.
void refuse_points(const SheetWords& words, const SheetReading& reading) {
  if (words.points.points.empty()) return;
  throw text::InputError(
      {reading.sheet.file, reading.sheet.line[reading.table.heading_row]},
      words.points.list.empty() ? "--point" : "--nominal",
      "the table has no column with pairs of points (AB, A-B, P1-P2): if it has distances between named "
      "points, write one row for each distance, with the names of its two points in one cell and the "
      "distance "
      "in the next one (AB; 170.31); if it has none, omit this option");
}

}  // namespace

ImportTable table_of_reading(const SheetReading& reading) {
  if (!reading.distances)
    return table_of_sheet(reading.sheet, reading.table, reading.columns, reading.wishes);
  if (reading.distances->refusal) throw text::InputError(*reading.distances->refusal);
  return reading.distances->table;
}

SheetReading read_as_sheet(const std::string& bytes, const std::string& file, const SheetWords& words,
                           SheetWishes wishes) {
  SheetReading result;
  result.wishes = wishes_of(words, std::move(wishes));
  std::vector<std::string> known;
  for (const NamedPoint& one : words.points.points) known.push_back(one.name);
  const std::string lines = lines_of_pairs(bytes, known);
  result.sheet = sheet::read_sheet(lines.empty() ? bytes : lines, file, result.wishes.format);
  sheet::take_number_formats(result.sheet);
  const std::set<std::size_t> degrees = convert_degree_cells(result.sheet);
  leave_tolerances(result.sheet);
  const std::optional<PairSheet> pairs =
      assigns_axis(words, result.wishes) ? std::nullopt : take_pairs(result.sheet, known);
  sheet::keep_table(result.sheet, result.wishes.format.table);
  const std::vector<RunLine> run_lines = take_run_lines(result.sheet);
  take_sentences_below_headings(result.sheet);
  sheet::move_units_below_headings(result.sheet);
  result.table = sheet::parts_of_sheet(result.sheet);
  add_run_lines(result.sheet, result.table, run_lines);
  note_title_alone(result.sheet, result.table);
  note_foreign_letters(result.sheet, result.table);
  state_degrees(result.table, degrees);
  refuse_transposed(result.sheet, result.table);
  leave_words_below(result.sheet, result.table);
  note_short_rows(result.sheet, result.table);
  const sheet::SheetTable written = result.table;  // with the headings of the file
  const std::vector<TableText> texts = sentences_about(result.sheet, written);
  leave_state_lines(result.sheet, result.table);
  leave_invalid_rows(result.sheet, result.table);
  if (!pairs) note_repeated_readings(result.sheet, result.table);
  note_failed_formulas(result.sheet, result.table);
  read_slopes_as_angles(result.sheet, result.table);
  refuse_counts_below(result.sheet, result.table);
  const bool axes_left = std::any_of(words.left.begin(), words.left.end(), [&](const std::string& one) {
    return find_heading(result.table, one) != std::string::npos;
  });
  std::vector<std::string> named = words.columns;
  named.insert(named.end(), words.deviations.begin(), words.deviations.end());
  leave_side_statistics(result.sheet, result.table, named);
  leave_results(result.sheet, result.table, named);
  named.insert(named.end(), words.left.begin(), words.left.end());
  for (const SheetWishes::Assignment& wish : result.wishes.assignments) named.push_back(wish.heading);
  leave_computed_rows(result.sheet, result.table);
  if (!result.wishes.format.table)
    join_paired_sheet(result.sheet, result.table, bytes, result.wishes.format,
                      result.wishes.format.sheet.empty());
  leave_verdicts(result.sheet, result.table, named);
  settle_roles(result.sheet, result.table, named);
  settle_uncertainties(result.sheet, result.table, named);
  if (pairs) {
    read_distances(result, *pairs, words);
    note_signs(result);
    note_unused_texts(result.sheet, written, texts, result.columns);
    return result;
  }
  refuse_points(words, result);
  split_signed_positions(result.sheet, result.table);
  note_order_of_time(result.sheet, result.table);
  apply_sign_column(result.sheet, result.table, named);
  leave_differences(result.sheet, result.table, named);
  bool unfolded_axes =
      !axes_left && unfold_axes(result.sheet, result.table, result.wishes, AxisCells::kAboveToo);
  stack_runs(result.sheet, result.table);
  result.runs = unfold_runs(result.sheet, result.table, with_columns(words, result.table, result.wishes));
  split_runs(result.sheet, result.table);
  // Runs side by side are one column of readings now.
  if (!axes_left && !unfolded_axes) {
    unfolded_axes = unfold_axes(result.sheet, result.table, result.wishes, AxisCells::kInEachRow);
    const bool assigned =
        !words.columns.empty() || !words.deviations.empty() || !result.wishes.assignments.empty();
    if (!unfolded_axes) refuse_unread_axes(result.sheet, result.table, result.wishes, assigned);
  }
  add_run_of_title(result.sheet, result.table, result.wishes.constants,
                   result.wishes.format.table.has_value() && result.runs == 0);
  apply_direction_codes(result.sheet, result.table, result.wishes);
  if (result.runs == 0)
    add_stated_directions(result.sheet, result.table, with_columns(words, result.table, result.wishes));
  for (const std::string& one : words.columns)
    assign_column(result.wishes, result.table, one, words.column_option);
  for (const std::string& one : words.deviations) assign_deviation(result.wishes, one);
  for (const std::string& heading : words.fill)
    if (find_heading(result.table, heading) == std::string::npos)
      refuse_heading(result.table, "--fill", heading);
  leave_columns(result, words.left);
  add_positions_of_titles(result.sheet, result.table, result.wishes);
  if (words.decimal.empty())
    settle_thousands(result.sheet, result.table,
                     columns_by_headings(result.sheet, result.table, result.wishes));
  result.columns = columns_of_sheet(result.sheet, result.table, result.wishes);
  refuse_another_axis(result.sheet, result.table, result.columns, result.wishes);
  note_axis_of_name(result.sheet, result.table, result.columns, result.wishes);
  fill_down(result);
  settle_directions(result.sheet, result.table, result.columns, result.runs > 0);
  note_units(result);
  note_signs(result);
  if (!unfolded_axes) note_sparse_columns(result);  // the rows of the other axes have no reading
  note_unnamed_columns(result);
  note_rotating_frame(result);
  judge_other_quantities(result.sheet, result.table, result.columns);
  judge_sizes(result, words.found);
  note_exchanged_headings(result.sheet, result.table, result.columns);
  note_unused_texts(result.sheet, written, texts, result.columns);
  note_heading_words(result.sheet, written, result.table, result.columns, result.wishes, words.found);
  note_odd_names(result.sheet, result.table, result.columns);
  note_columns_beside(result.sheet, result.table, result.columns, result.wishes);
  if (result.wishes.directions_from_order)
    result.sheet.notes.push_back(
        "an axis without a column of directions has the direction of its last motion in the run (0: before "
        "its "
        "first motion); this is right if the rows are in the order of the measurement, and if the axes moved "
        "to each position without overshoot");
  return result;
}

std::string how_read(const sheet::Sheet& sheet) {
  const std::string doubt =
      sheet.decimal_doubtful ? " (the sign could also separate thousands: give --decimal)" : "";
  if (sheet.workbook)
    return "workbook, sheet \"" + sheet.sheet + "\"" +
           (sheet.sheets.size() > 1 ? " of " + text::joined(sheet.sheets, ", ") : "") +
           (sheet.decimal_comma ? fmt::format(", numbers stored as text have a decimal comma{}", doubt) : "");
  return fmt::format("{}, columns separated by {}, decimal {}{}", sheet::encoding_name(sheet.encoding),
                     sheet::separator_word(sheet.separator), sheet.decimal_comma ? "comma" : "point", doubt);
}

std::string becomes(const SheetColumn& column) {
  const std::string unit = column.unit.empty() ? "" : "[" + column.unit + "]";
  switch (column.use) {
    case SheetColumn::Use::kColumn:
      return column.name + unit + (column.words ? " (words)" : "");
    case SheetColumn::Use::kDeviation:
      if (column.to_target)
        return fmt::format("target of {}: position {} this column, {}", column.name,
                           column.turned ? "+" : "-", unit);
      return fmt::format("position of {} {} this column, {}", column.name, column.turned ? "-" : "+", unit);
    case SheetColumn::Use::kLeft:
      return "left out";
  }
  return "";
}

nlohmann::ordered_json columns_json(const SheetReading& reading) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (std::size_t k = 0; k < reading.columns.size(); ++k) {
    const SheetColumn& column = reading.columns[k];
    const char* use = column.use == SheetColumn::Use::kColumn      ? "column"
                      : column.use == SheetColumn::Use::kDeviation ? "deviation"
                                                                   : "left";
    list.push_back({{"heading", reading.table.headings[k].text},
                    {"use", use},
                    {"name", column.name},
                    {"unit", column.unit},
                    {"why", column.why}});
    if (column.turned) list.back()["sign"] = "nominal - actual";
  }
  return list;
}

}  // namespace vernier::importer
