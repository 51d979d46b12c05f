// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/workbench/files/sheets.h"

#include <fmt/format.h>

#include <algorithm>

#include "tools/format/columns.h"
#include "tools/format/csv_file.h"
#include "tools/import/logs/point_positions.h"
#include "tools/import/logs/robot_log.h"
#include "tools/text/error.h"
#include "tools/text/words.h"

namespace vernier::workbench {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kShown = 8;  // rows of a preview
/// How the log of a robot becomes the positions of the axes of a tracker's points, in the words of the page.
constexpr const char* kWithPoints =
    "take in their list, and choose this file in the field \"nominal\" of its panel";

std::string text_or_none(const nlohmann::json& request, const char* key) {
  const auto found = request.find(key);
  if (found == request.end() || found->is_null()) return {};
  if (!found->is_string()) throw text::InputError(std::string("\"") + key + "\" must be a text");
  return found->get<std::string>();
}

std::vector<std::string> list_or_none(const nlohmann::json& request, const char* key) {
  const auto found = request.find(key);
  if (found == request.end() || found->is_null()) return {};
  std::vector<std::string> list;
  if (!found->is_array()) throw text::InputError(std::string("\"") + key + "\" must be a list");
  for (const nlohmann::json& one : *found) {
    if (!one.is_string()) throw text::InputError(fmt::format("\"{}\" must be a list of texts", key));
    list.push_back(one.get<std::string>());
  }
  return list;
}

Json first_lines(const std::string& csv) {
  Json lines = Json::array();
  for (std::size_t at = 0; at < csv.size() && lines.size() <= kShown;) {
    const std::size_t end = std::min(csv.find('\n', at), csv.size());
    lines.push_back(csv.substr(at, end - at));
    at = end + 1;
  }
  return lines;
}

/// The points of a table of distances, for the fields of their positions: {"names", "axes": [{name, unit}],
/// "missing"}.
Json points_json(const importer::PointDistances& distances) {
  Json axes = Json::array();
  for (const importer::MissingAxis& axis : distances.axes)
    axes.push_back({{"name", axis.name}, {"unit", axis.rotary ? "deg" : "mm"}});
  return {{"names", distances.points}, {"axes", axes}, {"missing", distances.missing}};
}

/// The log of a robot, as the import refuses it, with the columns that a button of the page assigns:
/// {"robot":
/// [{column, name, unit}]}.
void add_robot_log(Json& json, const importer::RobotLog& log, const importer::SheetReading& reading) {
  Json columns = Json::array();
  if (!log.point.empty())
    for (const importer::RobotLog::Column& one : log.columns)
      columns.push_back({{"column", one.column},
                         {"name", one.name},
                         {"unit", one.unit.empty() ? reading.columns[one.column].unit : one.unit}});
  json["robot"] = columns;
  const char* const way_on = log.point.empty() ? "" : ", press \"This assignment is right\"";
  json["message"] = text::InputError({reading.sheet.file, reading.sheet.line[reading.table.heading_row]}, "",
                                     importer::why_not_read(log, kWithPoints) + way_on)
                        .what();
}

/// True if one of the columns is a reading of the measurement format. Without one the headings are those of a
/// spreadsheet, whatever their form: joint_a1 [deg],Tx [mm].
bool has_reading(const std::vector<format::CsvColumn>& columns) {
  const auto find = [&](std::string_view name) -> const format::CsvColumn* {
    const auto found = std::find_if(columns.begin(), columns.end(),
                                    [&](const format::CsvColumn& one) { return one.name == name; });
    return found == columns.end() ? nullptr : &*found;
  };
  return std::any_of(columns.begin(), columns.end(),
                     [&](const format::CsvColumn& one) { return format::is_reading(one, find); });
}

}  // namespace

bool begins_as_measurement(const std::string& text) {
  for (std::size_t at = text.starts_with("\xEF\xBB\xBF") ? 3 : 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string line = text::trimmed(text.substr(at, end - at));
    at = end + 1;
    if (line.empty() || line.front() == '#') continue;
    try {
      const auto commas = static_cast<std::size_t>(std::count(line.begin(), line.end(), ','));
      const format::CsvFile csv = format::parse_csv(line + "\n0" + std::string(commas, ',') + "\n", "");
      const bool units = std::any_of(csv.columns.begin(), csv.columns.end(),
                                     [](const format::CsvColumn& column) { return !column.unit.empty(); });
      return units && has_reading(csv.columns);
    } catch (const text::InputError&) {
      return false;
    }
  }
  return false;
}

Json sheet_preview(const std::string& bytes, const std::string& file, const importer::SheetWords& words,
                   const model::Machine* machine) {
  const importer::SheetReading reading = importer::read_as_sheet(bytes, file, words);
  const sheet::Sheet& sheet = reading.sheet;
  std::string how = importer::how_read(sheet);
  for (const std::string& note : sheet.notes) how += "; " + note;
  Json json = {{"how", how},
               {"workbook", sheet.workbook},
               {"sheet", sheet.sheet},
               {"sheets", sheet.sheets},
               {"tables_beside", sheet.tables_beside},
               {"separator", sheet::separator_word(sheet.separator)},
               {"decimal", sheet.decimal_comma ? "comma" : "point"},
               {"heading_line",
                reading.table.has_headings ? Json(sheet.line[reading.table.heading_row]) : Json(nullptr)},
               {"columns", importer::columns_json(reading)},
               {"rows", Json::array()}};
  if (reading.distances) json["points"] = points_json(*reading.distances);
  // A doubt that the user can answer by confirming the meaning of the column.
  for (std::size_t k = 0; k < reading.columns.size(); ++k)
    if (!reading.columns[k].doubt.empty()) json["columns"][k]["doubt"] = reading.columns[k].doubt;
  for (std::size_t row = reading.table.first_data; row < sheet.rows.size() && json["rows"].size() < kShown;
       ++row)
    json["rows"].push_back(sheet.rows[row]);
  try {
    const importer::ImportTable table = importer::table_of_reading(reading);
    json["csv"] = first_lines(importer::measurement_csv(table));
    json["n_rows"] = table.line.size();
    json["message"] = nullptr;
  } catch (const text::InputError& error) {
    json["csv"] = Json::array();
    json["n_rows"] = 0;
    json["message"] = error.what();
  }
  if (machine != nullptr && !reading.distances)
    if (const auto log = importer::robot_log(*machine, reading)) add_robot_log(json, *log, reading);
  return json;
}

importer::NamedPoints sheet_points(const nlohmann::json& request, const importer::SheetWords& words,
                                   const model::Machine* machine, const ReadsFile& reads) {
  importer::NamedPoints points =
      importer::stated_points(list_or_none(request, "point"), words.constants, machine);
  points.tolerance_mm = words.points.tolerance_mm;
  const std::string list = text_or_none(request, "nominal");
  if (!list.empty() && machine == nullptr)
    throw text::InputError("choose a machine first: the list of positions has a column for each of its axes");
  if (!list.empty())
    importer::add_listed_points(
        points, words.constants,
        {reads(list), list, list_or_none(request, "nominal-column"), "--nominal-column"}, *machine);
  return points;
}

importer::SheetWords sheet_words(const nlohmann::json& request) {
  importer::SheetWords words;
  words.separator = text_or_none(request, "separator");
  words.decimal = text_or_none(request, "decimal");
  words.comment = text_or_none(request, "comment");
  words.sheet = text_or_none(request, "sheet");
  words.unit = text_or_none(request, "unit");
  words.sign = text_or_none(request, "sign");
  words.directions = text_or_none(request, "directions");
  if (const auto skip = request.find("skip"); skip != request.end() && skip->is_number_integer())
    words.skip = static_cast<std::size_t>(std::max<std::int64_t>(0, skip->get<std::int64_t>()));
  if (const auto table = request.find("table"); table != request.end() && table->is_number_integer())
    words.table = static_cast<std::size_t>(std::max<std::int64_t>(0, table->get<std::int64_t>()));
  words.columns = list_or_none(request, "column");
  words.deviations = list_or_none(request, "deviation");
  words.left = list_or_none(request, "leave");
  words.constants = list_or_none(request, "set");
  words.fill = list_or_none(request, "fill");
  if (const auto tolerance = request.find("tolerance"); tolerance != request.end() && tolerance->is_number())
    words.points.tolerance_mm = tolerance->get<double>();
  const auto motion = request.find("one-motion");
  words.one_motion = motion != request.end() && motion->is_boolean() && motion->get<bool>();
  return words;
}

}  // namespace vernier::workbench
