// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <set>

#include "tools/commands/command.h"
#include "tools/commands/measure/import_kinds.h"
#include "tools/format/columns.h"
#include "tools/import/columns/column_guess.h"
#include "tools/import/columns/delimited.h"
#include "tools/import/columns/point_columns.h"
#include "tools/import/columns/sheet_wishes.h"
#include "tools/import/logs/machine_log.h"
#include "tools/import/logs/nominal_list.h"
#include "tools/import/tables/order_directions.h"
#include "tools/import/tables/survey.h"
#include "tools/model/machine_reader.h"
#include "tools/model/measurement.h"
#include "tools/sheet/encoding.h"
#include "tools/text/optional_json.h"
#include "tools/text/words.h"

namespace vernier::commands::import_cli {
namespace {

using Json = nlohmann::ordered_json;

struct SurveyArguments {
  std::string file, map, machine, separator, decimal, comment, directions;
  std::vector<std::string> columns, constants, nominal_columns;
  std::size_t skip = 0, check_every = 0;
  double radius_mm = 0;
  std::string log;      // of the machine, tracker only
  std::string nominal;  // list of the positions of the axes, tracker only
  importer::LogOptions log_options;
  bool header = false, fixed_camera = false;
  ImportOutput output;
};

/// The map file first, then the command line, which overrides it.
importer::ColumnMap map_of(const SurveyArguments& arguments, const CLI::App& kind) {
  importer::ColumnMap map;
  if (!arguments.map.empty()) importer::read_column_map(map, text::read_file(arguments.map), arguments.map);
  for (const std::string& words : arguments.columns) importer::add_column(map, words);
  for (const std::string& words : arguments.constants) importer::add_constant(map, words);
  if (kind.count("--separator") > 0) map.format.separator = importer::separator_of(arguments.separator);
  if (kind.count("--decimal") > 0) map.format.decimal_comma = arguments.decimal == "comma";
  if (kind.count("--comment") > 0) map.format.comment = arguments.comment == "none" ? "" : arguments.comment;
  if (kind.count("--skip") > 0) map.format.skip = arguments.skip;
  if (arguments.header) map.format.header = true;
  return map;
}

/// Omits the lines of a title above the table if the user states no number of lines. Returns a sentence that
/// quotes them; empty: there are none.
std::string omit_title(const std::string& text, const std::string& file, importer::DelimitedFormat& format) {
  if (format.skip > 0) return {};
  const importer::TitleLines titles = importer::title_lines(text, file, format);
  format.skip = titles.skip;
  if (titles.texts.empty()) return {};
  return fmt::format(
      "Above the table {} that the command does not read: \"{}\"",
      titles.texts.size() == 1 ? "is a line" : fmt::format("are {} lines", titles.texts.size()),
      text::joined(titles.texts, "\", \""));
}

double nominal_tolerance_mm(const SurveyArguments& arguments, const CLI::App& kind,
                            const model::Machine& machine) {
  return kind.count("--tolerance") > 0 ? arguments.log_options.tolerance_mm
                                       : importer::nominal_tolerance_mm(machine);
}

/// The assignments that the list of nominal positions needs beside these points; empty: none, or they are not
/// known.
std::string nominal_options_to_try(const SurveyArguments& arguments, const std::string& text,
                                   const importer::ColumnMap& map, const CLI::App& kind) {
  if (arguments.nominal.empty() || arguments.machine.empty()) return "";
  std::string options;
  try {
    importer::ImportTable table = importer::mapped_table(text, arguments.file, map);
    importer::finish_tracker(table);
    importer::NominalList list{text::read_file(arguments.nominal), arguments.nominal,
                               arguments.nominal_columns};
    list.call = [&](const std::vector<std::string>& words) {
      return options = options_of(kNominalColumn, words);
    };
    const model::Machine machine = model::read_machine(arguments.machine);
    importer::with_nominal(table, list, machine, nominal_tolerance_mm(arguments, kind, machine));
  } catch (const text::InputError&) {
    // The next call says what is wrong in the list.
  }
  return options;
}

/// Refuses a list of which no column has a meaning, with the call that reads it.
void refuse_without_columns(const SurveyArguments& arguments, const std::string& text,
                            const importer::ColumnMap& map, const CLI::App& kind, const std::string& title) {
  const importer::PointColumns point = importer::point_columns(text, arguments.file, map.format);
  // Only a tracker's list is points and their names alone.
  if (point.words.empty() || (point.by_order && kind.get_name() != "tracker"))
    throw text::InputError(
        "no column has a meaning: give --map FILE, or --column \"1=x[mm]\" for each column");
  const std::string nominal =
      nominal_options_to_try(arguments, text, importer::with_point_columns(map, point), kind);
  const bool comma = point.decimal_comma && !map.format.decimal_comma;
  throw text::InputError(fmt::format(
      "no column has a meaning: give --map FILE. {}{}, give: {}", title.empty() ? "" : title + ". ",
      fmt::format("If {} x, y and z of the points in the units of this call{}",
                  point.by_order ? "the first columns of numbers are" : "the columns of these names are",
                  nominal.empty() ? "" : ", and the columns of the list of nominal positions are the axes"),
      call_with(kind, {"--decimal", kNominalColumn},
                options_of("--column", point.words) +
                    (comma                         ? " --decimal comma"
                     : kind.count("--decimal") > 0 ? " --decimal " + arguments.decimal
                                                   : "") +
                    nominal)));
}

/// Refuses a list of points of which only some coordinates are read: the fit would use a third of the
/// readings without a word.
void refuse_unread_coordinates(const SurveyArguments& arguments, const std::string& text,
                               const importer::ColumnMap& map, const CLI::App& kind) {
  const importer::UnreadCoordinates unread = importer::unread_coordinates(text, arguments.file, map);
  if (unread.columns.empty()) return;
  const importer::PointColumns point = importer::point_columns(text, arguments.file, map.format);
  std::string missing, columns;
  std::vector<std::string> others;
  for (const std::string& one : unread.missing) missing += (missing.empty() ? "" : ", ") + one;
  for (const std::string& one : unread.columns) {
    columns += (columns.empty() ? "" : ", ") + one;
    others.push_back(fmt::format("{}=unused_{}", one, others.size() + 1));
  }
  const std::string whole =
      point.words.empty() ? fmt::format("give --column for {}", missing)
                          : "if the columns are x, y and z of the points, give: " +
                                call_with(kind, {"--column", "--map"}, options_of("--column", point.words));
  throw text::InputError(
      {arguments.file, 0}, missing,
      fmt::format(
          "the list has columns of numbers that are not read (column {}), and no column is {}: {}; if "
          "the instrument measured nothing else, give: {}",
          columns, missing, whole, call_with(kind, {}, options_of("--column", others))));
}

/// The call of the user with the points in another unit; empty if a map file states the columns.
std::string call_in_unit(const SurveyArguments& arguments, const CLI::App& kind, const std::string& unit) {
  std::vector<std::string> words = arguments.columns;
  std::size_t changed = 0;
  for (std::string& word : words) {
    const std::size_t name = word.rfind('=') + 1, bracket = word.find('[', name);
    const auto& point = format::columns::kPoint;
    if (bracket == std::string::npos ||
        std::find(std::begin(point), std::end(point), word.substr(name, bracket - name)) == std::end(point))
      continue;
    word.replace(bracket, std::string::npos, "[" + unit + "]");
    ++changed;
  }
  return changed == std::size(format::columns::kPoint)
             ? call_with(kind, {"--column"}, options_of("--column", words))
             : "";
}

Json summary(const std::string& kind, const importer::ImportTable& table) {
  Json columns = Json::array();
  for (const auto& column : table.columns)
    columns.push_back(column.name + (column.unit.empty() ? "" : "[" + column.unit + "]"));
  std::set<std::string> runs;
  if (const auto* run = table.find(format::columns::kRun)) runs.insert(run->cells.begin(), run->cells.end());
  std::size_t check = 0;
  if (const auto* role = table.find(format::columns::kRole))
    for (const std::string& cell : role->cells) check += cell == "check" ? 1 : 0;
  return {
      {"kind", kind}, {"n_rows", table.line.size()}, {"n_fit", table.line.size() - check}, {"n_check", check},
      {"runs", runs}, {"columns", columns}};
}

Json pairing_json(const importer::LoggedTable& logged) {
  const importer::Pairing& pairing = logged.pairing;
  Json unused = Json::array();
  for (const std::size_t j : pairing.unused)
    unused.push_back({{"begin_s", logged.dwells[j].begin_s}, {"end_s", logged.dwells[j].end_s}});
  return {{"dwells", logged.dwells.size()},
          {"paired", logged.table.line.size()},
          {"unmatched_lines", logged.unmatched_line},
          {"unused_dwells", unused},
          {"clock_offset_s", text::or_null(pairing.offset_s)},
          {"clock_offset_std_s", text::or_null(pairing.offset_std_s)},
          {"clock_drift", text::or_null(pairing.drift)},
          {"clock_drift_std", text::or_null(pairing.drift_std)},
          {"rms_mm", text::or_null(pairing.rms_mm)}};
}

void print_pairing(std::FILE* out, const importer::LoggedTable& logged, const std::string& file) {
  const importer::Pairing& pairing = logged.pairing;
  fmt::print(out, "{} of {} points paired with {} dwells", logged.table.line.size(), pairing.dwell.size(),
             logged.dwells.size());
  if (pairing.rms_mm)
    fmt::print(out, "; rms distance of the points from the positions of the nominal machine: {:.3g} mm",
               *pairing.rms_mm);
  fmt::print(out, "\n");
  if (pairing.offset_s)
    fmt::print(out, "clock of the log = {:.3f} +- {:.2g} s + (1 {:+.2g} +- {:.1g}) x the tracker's\n",
               *pairing.offset_s, *pairing.offset_std_s, *pairing.drift, *pairing.drift_std);
  for (const std::size_t line : logged.unmatched_line)
    fmt::print(out, "not paired: the point {}:{} agrees with no dwell of the log\n", file, line);
  for (const std::size_t j : pairing.unused)
    fmt::print(out, "not paired: the dwell of the log from {:.2f} to {:.2f} s has no point\n",
               logged.dwells[j].begin_s, logged.dwells[j].end_s);
}

void print_joined(std::FILE* out, const importer::NominalTable& joined, const std::string& list) {
  fmt::print(out, "{} points and the positions of {}, {}", joined.table.line.size(), list,
             importer::joined_by(joined));
  if (joined.rms_mm)
    fmt::print(out, "; rms distance of the points from the positions of the nominal machine: {:.3g} mm",
               *joined.rms_mm);
  fmt::print(out, "\n");
  if (!joined.note.empty()) fmt::print(out, "{}\n", joined.note);
  if (joined.unused_lines.empty()) return;
  constexpr std::size_t kPrinted = 10;
  std::string lines;
  for (std::size_t i = 0; i < std::min(kPrinted, joined.unused_lines.size()); ++i)
    lines += fmt::format("{}{}", i == 0 ? "" : ", ", joined.unused_lines[i]);
  fmt::print(out, "{} positions of {} have no point: {} {}{}\n", joined.unused_lines.size(), list,
             joined.unused_lines.size() == 1 ? "line" : "lines", lines,
             joined.unused_lines.size() > kPrinted ? ", ..." : "");
}

/// The note about directions that follow from an order: which one, and what it assumes.
std::string note_of_order(const std::vector<std::string>& columns, const SurveyArguments& arguments) {
  return fmt::format(
      "the approach directions ({}) follow from the order of the {} in {}: each axis has the direction of "
      "its "
      "last motion{}. Check that this is the order of the measurement",
      text::joined(columns, ", "), arguments.nominal.empty() ? "points" : "positions",
      arguments.nominal.empty() ? arguments.file : arguments.nominal,
      arguments.nominal.empty() ? "" : ", also of the motion to a position without a point");
}

/// A note about linear axes that move and have no direction; empty: none.
std::string note_without_directions(const importer::ImportTable& table, const model::Machine& machine) {
  std::vector<std::string> missing;
  for (const model::Axis& axis : machine.axes) {
    const std::string sense = format::axis_column(format::AxisQuantity::kSense, axis.name);
    if (axis.rotary || table.find(axis.name) == nullptr || table.find(sense) != nullptr) continue;
    const std::vector<std::string>& cells = table.find(axis.name)->cells;
    if (std::adjacent_find(cells.begin(), cells.end(), std::not_equal_to<>()) != cells.end())
      missing.push_back(sense);
  }
  if (missing.empty()) return {};
  return fmt::format(
      "the rows have no directions of the motion ({}), and a fit needs them for a backlash: if the rows are "
      "in the order of the measurement, import the file again with the directions (option --directions "
      "from-order of vernier import)",
      text::joined(missing, ", "));
}

/// The table with the positions of the axes, and where they came from.
struct Survey {
  importer::ImportTable table;
  std::optional<importer::LoggedTable> logged;
  std::optional<importer::NominalTable> joined;
  std::vector<std::string> notes;
};

void write_survey(const std::string& kind, const SurveyArguments& arguments, const Survey& survey) {
  const auto& [table, logged, joined, notes] = survey;
  const std::string text = importer::measurement_csv(table);
  Json result = summary(kind, table);
  if (logged) result["pairing"] = pairing_json(*logged);
  if (joined)
    result["nominal"] = {{"file", arguments.nominal},
                         {"names", joined->names.empty() ? Json(nullptr) : Json(joined->names)},
                         {"n_unused", joined->unused_lines.size()},
                         {"by_distances", joined->by_distances},
                         {"rms_mm", text::or_null(joined->rms_mm)}};
  if (!arguments.machine.empty()) {
    // The same reading that a fit will do, with the machine's axes and inputs.
    const model::Measurement read =
        model::parse_measurement(text, arguments.output.csv_path, model::read_machine(arguments.machine));
    result["n_obs"] = read.observations.size();
    result["n_excluded"] = read.excluded;
  }
  text::write_file(arguments.output.csv_path, text);
  if (logged) print_pairing(human_stream(arguments.output.json_path), *logged, arguments.file);
  if (joined) print_joined(human_stream(arguments.output.json_path), *joined, arguments.nominal);
  if (!notes.empty()) result["note"] = text::joined(notes, ". ");
  for (const std::string& note : notes)
    fmt::print(human_stream(arguments.output.json_path), "note: {}\n", note);
  write_json(arguments.output.json_path, result);
  fmt::print(human_stream(arguments.output.json_path), "{}: {} rows ({} fit, {} check)\n",
             arguments.output.csv_path, table.line.size(), result["n_fit"].get<std::size_t>(),
             result["n_check"].get<std::size_t>());
}

void run_survey(const std::string& kind_name, const SurveyArguments& arguments, const CLI::App& kind) {
  Survey survey;
  importer::ImportTable& table = survey.table;
  const std::string text = sheet::utf8_text(text::read_file(arguments.file));
  importer::ColumnMap map = map_of(arguments, kind);
  map.format.header = importer::has_header(map);
  const std::string title = omit_title(text, arguments.file, map.format);
  if (!title.empty()) survey.notes.push_back(title);
  const bool only_constants = std::all_of(map.columns.begin(), map.columns.end(),
                                          [](const auto& column) { return column.source.empty(); });
  if (only_constants) refuse_without_columns(arguments, text, map, kind, title);
  table = importer::mapped_table(text, arguments.file, map);
  if (kind_name == "tracker") {
    importer::finish_tracker(table);
    refuse_unread_coordinates(arguments, text, map, kind);
  } else if (kind_name == "camera") {
    importer::finish_camera(table, !arguments.fixed_camera);
  } else {
    importer::finish_probe(table, arguments.radius_mm);
  }
  for (const auto& [option, file] :
       {std::pair("--log", arguments.log), std::pair("--nominal", arguments.nominal)})
    if (!file.empty() && arguments.machine.empty())
      throw text::InputError(
          {}, option,
          "this option requires --machine: the machine file states the axis columns and the positions");
  if (!arguments.log.empty()) {
    survey.logged = importer::with_log(table, text::read_file(arguments.log), arguments.log,
                                       model::read_machine(arguments.machine), arguments.log_options);
    table = survey.logged->table;
  }
  if (!arguments.nominal.empty()) {
    importer::NominalList list = nominal_list(kind, arguments.nominal, arguments.nominal_columns);
    list.call_in_unit = [&](const std::string& unit) { return call_in_unit(arguments, kind, unit); };
    const model::Machine machine = model::read_machine(arguments.machine);
    survey.joined =
        importer::with_nominal(table, list, machine, nominal_tolerance_mm(arguments, kind, machine));
    table = survey.joined->table;
  }
  if (!arguments.machine.empty())
    require_axes(table, model::read_machine(arguments.machine), kind,
                 std::string("no column of the table is the position of this axis. ") +
                     (kind_name == "tracker" ? "If the positions are in another file, give --nominal FILE (a "
                                               "list with the names or in the order of the points) or --log "
                                               "FILE (a log with times). "
                                             : "") +
                     "If a column has the position, give --column with the name of the axis; if the axis did "
                     "not move, give its position: ");
  if (!arguments.directions.empty()) {
    importer::SheetWishes wishes;
    if (!arguments.machine.empty())
      for (const model::Axis& axis : model::read_machine(arguments.machine).axes)
        wishes.axes.push_back(axis.name);
    const importer::Guess guess(wishes);
    const auto is_axis = [&](const std::string& name) { return guess.is_axis(name); };
    survey.notes.push_back(note_of_order(
        survey.joined
            ? importer::add_directions_of_list(table, survey.joined->list, survey.joined->rows, is_axis)
            : importer::add_directions_from_order(table, is_axis),
        arguments));
  } else if (!arguments.machine.empty()) {
    if (std::string note = note_without_directions(table, model::read_machine(arguments.machine));
        !note.empty())
      survey.notes.push_back(std::move(note));
  }
  if (arguments.check_every > 0) importer::set_roles(table, arguments.check_every);
  write_survey(kind_name, arguments, survey);
}

void add_survey_options(CLI::App& kind, const std::shared_ptr<SurveyArguments>& arguments) {
  kind.add_option("file", arguments->file, "table of the instrument (text)")->type_name(kReads)->required();
  kind.add_option("--map", arguments->map,
                  "file with the column map: the meaning of each column of the table")
      ->type_name(kReads);
  kind.add_option("--column", arguments->columns,
                  "meaning of a column: \"3=x[mm]\" or \"Name=x[mm]\"; repeat the option for each column")
      ->allow_extra_args(false);
  kind.add_option("--set", arguments->constants,
                  "column with the same value in every row: \"run=s1\", \"u[um]=5\"")
      ->allow_extra_args(false);
  kind.add_option("--separator", arguments->separator, "space: blanks; default: auto")
      ->check(CLI::IsMember(importer::separator_words()));
  kind.add_option("--decimal", arguments->decimal, "decimal sign")->check(CLI::IsMember({"point", "comma"}));
  kind.add_option(
      "--skip", arguments->skip,
      "number of lines at the top of the file that are skipped; default: the lines of a title are found");
  kind.add_option(
      "--comment", arguments->comment,
      "mark of a comment: lines that begin with this text are skipped; none: no comments; default: #");
  kind.add_flag("--header", arguments->header,
                "the first line contains the column names (implied if --column uses a name)");
  kind.add_option(
          "--directions", arguments->directions,
          "from-order: an axis without a column of directions (dirX) has the direction of its last "
          "motion in the run; the points must be in the order of the measurement (with --nominal: the "
          "positions of the list)")
      ->check(CLI::IsMember({importer::kFromOrder}));
  kind.add_option("--check-every", arguments->check_every, "every Nth row gets the role check")
      ->check(CLI::Range(2, 1000000));
  kind.add_option("--machine", arguments->machine,
                  "machine file: check that a fit of this machine can read the result")
      ->type_name(kReads);
  add_import_output(kind, arguments->output);
  kind.callback([arguments, &kind] { run_survey(kind.get_name(), *arguments, kind); });
}

}  // namespace

void add_tracker_kind(CLI::App& kind) {
  const auto arguments = std::make_shared<SurveyArguments>();
  add_survey_options(kind, arguments);
  importer::LogOptions& log = arguments->log_options;
  kind.add_option("--log", arguments->log,
                  "log of the machine (CSV: t and all axes); the command pairs each point with a dwell of "
                  "the machine, by order, distances and times; requires --machine")
      ->type_name(kReads);
  kind.add_option("--nominal", arguments->nominal,
                  "list of the positions of the axes (table with a heading and a unit for each axis); the "
                  "command joins it by the names of the points, or by row number; requires --machine")
      ->type_name(kReads)
      ->excludes("--log");
  add_nominal_columns(kind, arguments->nominal_columns);
  kind.add_option("--dwell", log.dwell_s, "--log: least standstill, s")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  kind.add_option("--still", log.still, "--log: an axis is at rest if it stays within this range, mm or deg")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  kind.add_option("--tolerance", log.tolerance_mm,
                  "--log, --nominal: largest permitted difference between measured and nominal distance of "
                  "two points, mm; with --nominal the default is 5 for a robot")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  kind.footer(
      "Name the columns as in a measurement file, with the unit of the table: axes, inputs, x y z, u, run, "
      "role …\n"
      "An orientation is rx ry rz (rotation vector), rX rY rZ (angles of Rx*Ry*Rz) or qw qx qy qz "
      "(quaternion);\n"
      "the command converts angles and quaternions to rx ry rz.");
}

void add_camera_kind(CLI::App& kind) {
  const auto arguments = std::make_shared<SurveyArguments>();
  add_survey_options(kind, arguments);
  kind.add_flag(
      "--fixed-camera", arguments->fixed_camera,
      "the camera is fixed and the tool carries the board; default: the tool carries the camera and "
      "the board is fixed");
  kind.footer(
      "Each row: the axis positions, and the pose of the board in the frame of the camera (OpenCV solvePnP:\n"
      "tvec, rvec): x y z with the unit of the table, and rx ry rz (rotation vector), or rX rY rZ (angles "
      "of\n"
      "Rx*Ry*Rz), or qw qx qy qz (quaternion). Give u (of x y z) and ua (of the rotation), or --set "
      "u[mm]=0.1.");
}

void add_probe_kind(CLI::App& kind) {
  const auto arguments = std::make_shared<SurveyArguments>();
  add_survey_options(kind, arguments);
  kind.add_option("--radius", arguments->radius_mm,
                  "radius of the stylus ball (mm), if the recorded points are centres of the ball and the "
                  "nominal points are on the surface");
  kind.footer(
      "Each touch: the normal nx ny nz, the nominal point px py pz, and the deviation d or the recorded "
      "point\n"
      "mx my mz (then d = n*(m - p)), workpiece coordinates; and the axis positions at the touch.");
}

}  // namespace vernier::commands::import_cli
