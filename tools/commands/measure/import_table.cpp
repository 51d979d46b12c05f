// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "tools/commands/command.h"
#include "tools/commands/measure/import_kinds.h"
#include "tools/fit/noise/contradicting_rows.h"
#include "tools/import/columns/column_guess.h"
#include "tools/import/columns/delimited.h"
#include "tools/import/distances/distance_table.h"
#include "tools/import/logs/open_axes.h"
#include "tools/import/logs/point_positions.h"
#include "tools/import/logs/robot_log.h"
#include "tools/import/reading/sheet_import.h"
#include "tools/import/tables/survey.h"
#include "tools/import/words/joint_names.h"
#include "tools/lint/lint_table.h"
#include "tools/model/machine_reader.h"
#include "tools/model/measurement.h"
#include "tools/sheet/sheet_number.h"
#include "tools/text/error.h"
#include "tools/text/words.h"

namespace vernier::commands::import_cli {
namespace {

using Json = nlohmann::ordered_json;

struct TableArguments {
  std::string file, profile, save_profile, machine, output, json;
  std::vector<std::string> points;  // of distances between named points
  std::string nominal;              // list of the positions of these points
  std::vector<std::string> nominal_columns;
  importer::SheetWords words;
  std::size_t check_every = 0;
  bool preview = false;
};

void print_columns(std::FILE* out, const importer::SheetReading& reading) {
  const auto& [wishes, sheet, table, columns, runs, distances] = reading;
  fmt::print(out, "{}: {}\n", sheet.file, importer::how_read(sheet));
  if (table.has_headings)
    fmt::print(out, "headings in line {}{}{}, data from line {}\n",
               table.upper_row ? fmt::format("{} and ", sheet.line[*table.upper_row]) : "",
               sheet.line[table.heading_row],
               table.units_row > 0 ? fmt::format(", units in line {}", sheet.line[table.units_row]) : "",
               sheet.line[table.first_data]);
  if (runs > 0)
    fmt::print(out, "{} columns, one per run and direction, are read as one column of readings\n", runs);
  for (std::size_t k = 0; k < columns.size(); ++k)
    fmt::print(out, "  {:>2}  {:<24} {:<26} {}\n", k + 1, table.headings[k].text,
               importer::becomes(columns[k]), columns[k].why);
  for (const importer::SheetColumn& column : columns)
    if (column.turned)
      fmt::print(out, "deviation of {}: {} nominal - actual, its sign is reversed\n", column.name,
                 wishes.turned ? "given as" : "labelled");
  for (const std::string& note : sheet.notes) fmt::print(out, "note: {}\n", note);
}

void print_rows(std::FILE* out, const std::string& csv) {
  constexpr std::size_t kShown = 6;
  std::size_t at = 0;
  for (std::size_t line = 0; line < kShown && at < csv.size(); ++line) {
    const std::size_t end = std::min(csv.find('\n', at), csv.size());
    fmt::print(out, "{}\n", csv.substr(at, end - at));
    at = end + 1;
  }
}

/// Refuses the log of a robot that needs an assignment, with one call that states all of it, and with the
/// call for points in another file.
void refuse_robot_log(const model::Machine& machine, const importer::SheetReading& reading,
                      const TableArguments& arguments, const CLI::App& kind) {
  const std::optional<importer::RobotLog> log = importer::robot_log(machine, reading);
  if (!log) return;
  const std::string tracker =
      "import their list (POINTS) with this file as the positions of the axes: vernier import tracker "
      "POINTS" +
      options_of("--nominal", {arguments.file}) + options_of("--machine", {arguments.machine}) +
      options_of(kNominalColumn, log->joints) + " -o NEW.csv";
  std::vector<std::string> words = log->joints;
  words.insert(words.end(), log->point.begin(), log->point.end());
  std::string why = importer::why_not_read(*log, tracker);
  if (!log->point.empty()) why += ", give: " + call_with(kind, {"--unit"}, options_of("--column", words));
  throw text::InputError({reading.sheet.file, reading.sheet.line[reading.table.heading_row]}, "", why);
}

/// The other sheets with tables, with a command for each: only one sheet is read.
void note_other_sheets(sheet::Sheet& sheet, const CLI::App& kind) {
  if (kind.count("--sheet") > 0 || sheet.tables_beside.empty()) return;
  std::string names, calls;
  const std::string stem = sheet.file.substr(0, sheet.file.rfind('.'));
  for (const std::string& name : sheet.tables_beside) {
    names += (names.empty() ? "\"" : ", \"") + name + "\"";
    std::string in_file = name;
    std::replace_if(
        in_file.begin(), in_file.end(), [](char c) { return c == ' ' || c == '/' || c == '\\'; }, '_');
    calls += fmt::format("{}{} --sheet {} -o {}", calls.empty() ? "" : "; ",
                         call_of(kind, {"--output", "--json", "--preview", "--save-profile"}),
                         lint::quoted_for_shell(name), lint::quoted_for_shell(stem + "_" + in_file + ".csv"));
  }
  sheet.notes.push_back(
      fmt::format("the workbook has more sheets with tables, which are not read: {}; to read them, "
                  "give: {}",
                  names, calls));
}

/// Refuses distances between named points without their positions, with the call to complete.
void refuse_without_positions(const importer::PointDistances& distances, const CLI::App& kind) {
  if (!distances.asks_positions) return;
  throw importer::refusal_for_positions(
      distances,
      fmt::format("give: {}", call_with(kind, {"--preview"}, importer::options_of_points(distances))));
}

/// The points of the options, and of the list of nominal positions.
importer::NamedPoints points_of(const TableArguments& arguments, const model::Machine* machine,
                                const CLI::App& kind) {
  importer::NamedPoints points =
      importer::stated_points(arguments.points, arguments.words.constants, machine);
  points.tolerance_mm = arguments.words.points.tolerance_mm;
  if (arguments.nominal.empty()) return points;
  if (machine == nullptr)
    throw text::InputError(
        {}, "--nominal",
        "this option requires --machine: the machine file states the axes whose positions the list has");
  importer::add_listed_points(points, arguments.words.constants,
                              nominal_list(kind, arguments.nominal, arguments.nominal_columns), *machine);
  return points;
}

void run_table(const TableArguments& arguments, const CLI::App& kind) {
  importer::SheetWishes wishes;
  if (!arguments.profile.empty())
    importer::read_sheet_profile(wishes, text::read_file(arguments.profile), arguments.profile);
  importer::SheetWords words = arguments.words;
  std::optional<model::Machine> machine;
  if (!arguments.machine.empty()) machine = model::read_machine(arguments.machine);
  if (machine)
    for (const model::Axis& axis : machine->axes) words.axes.push_back(axis.name);
  words.points = points_of(arguments, machine ? &*machine : nullptr, kind);
  const std::string bytes = text::read_file(arguments.file);
  importer::SheetReading reading = importer::read_as_sheet(bytes, arguments.file, words, wishes);
  importer::OpenAxes open;
  if (reading.distances) refuse_without_positions(*reading.distances, kind);
  if (machine && !reading.distances) {
    refuse_robot_log(*machine, reading, arguments, kind);
    open = importer::open_axes(*machine, reading);
    if (open.found.sure) {
      const std::vector<std::string> more = open.words();
      words.columns.insert(words.columns.end(), more.begin(), more.end());
      words.found = open.headings();
      reading = importer::read_as_sheet(bytes, arguments.file, words, std::move(wishes));
      reading.sheet.notes.push_back(
          fmt::format("columns with other names are the axes of the machine, {}: {}", open.found.why,
                      text::joined(more, ", ")));
      open = {};
    }
  }
  note_other_sheets(reading.sheet, kind);
  const sheet::Sheet& sheet = reading.sheet;
  std::FILE* out = human_stream(arguments.json);
  if (arguments.preview) print_columns(out, reading);
  importer::ImportTable read = [&] {
    try {
      return importer::table_of_reading(reading);
    } catch (const text::InputError&) {
      // The corrections start from the assignment that was recognised.
      if (!arguments.preview) print_columns(stderr, reading);
      throw;
    }
  }();
  if (!open.found.pairs.empty())
    require_axes(
        read, *machine, kind,
        "no column of the table has the name of this axis. As many other columns may be the axes in the "
        "order of the machine file. If this assignment and its units are right, give: ",
        open.words());
  else if (machine)
    require_axes(
        read, *machine, kind,
        "no column of the table is the position of this axis. If a column has this position under "
        "another heading, give --column \"NAME[unit]=HEADING\" with the name of the axis; if the axis "
        "did not move, give its position: ");
  if (arguments.check_every > 0) importer::set_roles(read, arguments.check_every);
  const std::string csv = importer::measurement_csv(read);
  Json result = {{"kind", "table"},
                 {"encoding", sheet.workbook ? "workbook" : sheet::encoding_name(sheet.encoding)},
                 {"separator", sheet.workbook ? Json(nullptr) : Json(sheet::separator_word(sheet.separator))},
                 {"decimal", sheet.decimal_comma ? "comma" : "point"},
                 {"n_rows", read.line.size()},
                 {"columns", importer::columns_json(reading)},
                 {"notes", sheet.notes}};
  if (reading.distances) result["points"] = reading.distances->points;
  std::string contradiction;
  if (!arguments.machine.empty()) {
    model::Measurement m =
        model::parse_measurement(csv, arguments.file, model::read_machine(arguments.machine));
    // The lines of a note are those of the file that is written.
    if (!arguments.output.empty()) m.files.front() = arguments.output;
    if (const auto rows = fit::contradicting_rows(m); !rows.empty()) {
      contradiction = fit::contradiction_in_words(m, rows);
      result["notes"].push_back(contradiction);
    }
    result["n_obs"] = m.observations.size();
    result["n_excluded"] = m.excluded;
  }
  const auto print_note = [&] {
    if (!contradiction.empty()) fmt::print(out, "note: {}\n", contradiction);
  };
  if (arguments.preview) {
    print_note();
    print_rows(out, csv);
    write_json(arguments.json, result);
    fmt::print(out, "preview: the first of {} rows; no file is written\n", read.line.size());
    return;
  }
  if (arguments.output.empty())
    throw text::InputError("the output is missing: give -o MEAS.csv (or --preview)");
  text::write_file(arguments.output, csv);
  if (!arguments.save_profile.empty())
    text::write_file(arguments.save_profile,
                     importer::sheet_profile(sheet, reading.table, reading.columns, reading.wishes));
  write_json(arguments.json, result);
  print_columns(out, reading);
  print_note();
  fmt::print(out, "{}: {} rows\n", arguments.output, read.line.size());
}

}  // namespace

void add_table_kind(CLI::App& kind) {
  const auto arguments = std::make_shared<TableArguments>();
  kind.add_option("file", arguments->file, "the table")->type_name(kReads)->required();
  kind.add_option("-o,--output", arguments->output, "Measurement file to write (CSV)")->type_name(kWrites);
  kind.add_flag("--preview", arguments->preview,
                "print the meaning of the columns and the first rows, and write nothing");
  kind.add_option(
          "--column", arguments->words.columns,
          "meaning of a column: \"x[mm]=X ist\" (heading or number); repeat the option for each column")
      ->allow_extra_args(false);
  kind.add_option("--deviation", arguments->words.deviations,
                  "column with deviations, \"X[um]=Abweichung\": the measured position is the position of X "
                  "plus this deviation; repeat the option for each column. A size alone (20mm, 2deg) is the "
                  "largest plausible deviation of all columns")
      ->allow_extra_args(false);
  kind.add_option("--leave", arguments->words.left,
                  "heading of a column that the command ignores; repeat the option for each column")
      ->allow_extra_args(false);
  kind.add_option("--set", arguments->words.constants,
                  "column with the same value in every row: \"run=s1\", \"u[um]=5\"")
      ->allow_extra_args(false);
  kind.add_option(
          "--fill", arguments->words.fill,
          "heading of a column whose empty cells have the value above them; repeat the option for each "
          "column")
      ->allow_extra_args(false);
  kind.add_flag("--one-motion", arguments->words.one_motion,
                "columns of several axes side by side are poses of all axes, not several tables");
  kind.add_option("--point", arguments->points,
                  "commanded position of a named point, \"A=30,30,0.2\", for a table of distances between "
                  "points (AB, A-B, P1-P2); repeat the option for each point")
      ->allow_extra_args(false);
  kind.add_option(
          "--nominal", arguments->nominal,
          "list of the positions of the points (table with a column of names, and a heading and a unit "
          "for each axis), in place of --point; requires --machine")
      ->type_name(kReads);
  add_nominal_columns(kind, arguments->nominal_columns);
  kind.add_option(
          "--tolerance", arguments->words.points.tolerance_mm,
          "--point, --nominal: largest permitted difference of a nominal distance of the table from the "
          "distance of the stated points, mm")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  kind.add_option("--sign", arguments->words.sign,
                  "sign of all deviations of the table, if its texts do not state the sign clearly")
      ->check(CLI::IsMember({"actual-nominal", "nominal-actual"}));
  kind.add_option("--directions", arguments->words.directions,
                  "from-order: an axis without a column of directions (dirX) has the direction of its last "
                  "motion in the run; the rows must be in the order of the measurement")
      ->check(CLI::IsMember({importer::kFromOrder}));
  kind.add_option("--unit", arguments->words.unit,
                  "unit of the lengths and angles whose heading has no unit");
  kind.add_option("--separator", arguments->words.separator, "default: detected and printed")
      ->check(CLI::IsMember(importer::separator_words()));
  kind.add_option("--decimal", arguments->words.decimal, "decimal sign; default: detected and printed")
      ->check(CLI::IsMember({"point", "comma"}));
  kind.add_option(
      "--sheet", arguments->words.sheet,
      "sheet of a workbook, by name or number; default: the first sheet that has rows of numbers");
  kind.add_option("--table", arguments->words.table,
                  "number of the table, from 1, if the file has several tables below each other");
  kind.add_option("--skip", arguments->words.skip, "number of lines at the top to skip");
  kind.add_option(
      "--comment", arguments->words.comment,
      "mark of a comment: lines that begin with this text are skipped; none: no comments; default: #");
  kind.add_option("--profile", arguments->profile,
                  "read the file with the settings of this profile (--save-profile)")
      ->type_name(kReads);
  kind.add_option("--save-profile", arguments->save_profile,
                  "write the settings of this call as a profile for further files")
      ->type_name(kWrites);
  kind.add_option("--check-every", arguments->check_every, "every Nth row gets the role check")
      ->check(CLI::Range(2, 1000000));
  kind.add_option("--machine", arguments->machine,
                  "machine file: the command finds the columns of its axes, and checks that a fit can read "
                  "the result")
      ->type_name(kReads);
  kind.add_option("--json", arguments->json,
                  "file for the result as JSON, for programs; - for standard output")
      ->type_name(kWrites);
  kind.footer(
      "The command reads headings in their usual forms: X [mm], X(mm), X soll, X ist in \u00b5m, Abweichung "
      "X;\n"
      "also in two lines or with a row of units. If the table has a column for each run and direction (1+ 1- "
      "2+ 2-,\n"
      "Run 1 fwd, hin 1, Messung 1 \u2191), each reading becomes a row. \"(Soll-Ist)\" or "
      "\"(nominal-actual)\" after\n"
      "the heading of a deviation inverts its sign, with a note. The command prints the detected settings; "
      "with\n"
      "--preview it writes no file.");
  kind.callback([arguments, &kind] { run_table(*arguments, kind); });
}

}  // namespace vernier::commands::import_cli
