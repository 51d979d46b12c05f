// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/format/columns.h"

#include <algorithm>

namespace vernier::format {
namespace {

using enum ColumnUse;

constexpr ColumnGroup readings(const std::array<const char*, 3>& names, std::size_t count, const char* unit,
                               ReadingForm form, bool later, const char* meaning) {
  return {.names = names,
          .count = count,
          .unit = unit,
          .use = kReading,
          .meaning = meaning,
          .form = form,
          .later = later};
}
constexpr ColumnGroup beside(const std::array<const char*, 3>& names, const char* unit, ReadingForm form,
                             const char* meaning) {
  return {.names = names, .count = 3, .unit = unit, .use = kBeside, .meaning = meaning, .form = form};
}
constexpr std::array<const char*, 3> one(const char* name) { return {name, nullptr, nullptr}; }
constexpr ColumnGroup motion(const char* name, const char* unit, const char* meaning, const char* absent) {
  return {.names = one(name),
          .count = 1,
          .unit = unit,
          .use = kMotion,
          .meaning = meaning,
          .filled = true,
          .in_terms = true,
          .if_absent = absent};
}
constexpr ColumnGroup label(const char* name, bool later, const char* meaning, const char* absent) {
  return {.names = one(name),
          .count = 1,
          .unit = "",
          .use = kLabel,
          .meaning = meaning,
          .words = true,
          .later = later,
          .if_absent = absent};
}

constexpr ColumnGroup normal() {
  ColumnGroup group = beside(columns::kNormal, "", ReadingForm::kDeviation,
                             "unit normal at the nominal point, in workpiece coordinates");
  group.in_terms = true;
  return group;
}
constexpr ColumnGroup row_of_distance() {
  ColumnGroup group = label(columns::kFrom, true,
                            "the row at the other end of the distance: the label of this row in a column of "
                            "words, or the number of this row, from 1",
                            "`distance` is no reading");
  group.use = kBeside;
  group.form = ReadingForm::kDistance;
  return group;
}
constexpr ColumnGroup thing(const char* name, ReadingForm form, const char* meaning) {
  ColumnGroup group = label(name, true, meaning, nullptr);
  group.use = kReading;
  group.form = form;
  return group;
}
constexpr ColumnGroup uncertainty() {
  return {.names = one(columns::kUncertainty),
          .count = 1,
          .unit = "mm",
          .use = kUncertainty,
          .meaning = "standard uncertainty of each reading of the row; a fit weights by 1/u²",
          .filled = true,
          .or_unit = "deg",
          .if_absent = "`<instrument>` of the machine file, else the noise is estimated"};
}
constexpr ColumnGroup angle_uncertainty() {
  return {.names = one(columns::kAngleUncertainty),
          .count = 1,
          .unit = "arcsec",
          .use = kUncertainty,
          .meaning = "standard uncertainty of the angles of the row",
          .later = true,
          .if_absent = "`u`"};
}
constexpr ColumnGroup run() {
  ColumnGroup group =
      label(columns::kRun, false, "label of the pass or set-up that the row belongs to", "one run");
  group.in_terms = true;
  return group;
}

/// The order is that of messages and of the reference page: readings, the columns that they need, the rest.
constexpr std::array kGroups = {
    readings(columns::kPoint, 3, "mm", ReadingForm::kPoint, false,
             "measured tool point in the measuring frame; one or more of the three columns"),
    readings(columns::kRotation, 3, "deg", ReadingForm::kRotation, false,
             "measured rotation of the tool in the measuring frame, as a rotation vector; one or more of the "
             "three columns"),
    readings(one(columns::kLength), 1, "mm", ReadingForm::kLength, false,
             "measured distance of the tool point from a fixed centre, the full length"),
    readings(one(columns::kDeviation), 1, "mm", ReadingForm::kDeviation, false,
             "measured deviation of the tool point from the nominal point, positive along the normal"),
    readings(columns::kDirection, 3, "", ReadingForm::kDirection, true,
             "measured direction of the tool axis in the measuring frame, a unit vector; all three columns"),
    readings(one(columns::kDistance), 1, "mm", ReadingForm::kDistance, true,
             "measured distance between the tool points of this row and of another row"),
    readings({columns::kInclination[0], columns::kInclination[1], nullptr}, 2, "arcsec",
             ReadingForm::kInclination, true,
             "measured inclination of the tool's x axis and y axis to the horizontal; one of the two "
             "columns, or both"),
    thing(columns::kSame, ReadingForm::kSame,
          "label of the unknown point at which the tool point was in this row; `u` is the uncertainty of "
          "this coincidence"),
    thing(columns::kOn, ReadingForm::kOn,
          "name of the `<artefact>` that the tool point touched in this row; `u` is the uncertainty of the "
          "touch"),
    readings(columns::kBoard, 3, "mm", ReadingForm::kBoard, true,
             "measured position of a board in the frame of the camera that the tool carries; all three "
             "columns"),
    readings(columns::kBoardRotation, 3, "deg", ReadingForm::kBoardRotation, true,
             "measured rotation of the board in the frame of this camera, as a rotation vector; all three "
             "columns"),
    beside(columns::kCentre, "mm", ReadingForm::kLength, "the fixed centre, in the measuring frame"),
    normal(),
    beside(columns::kNominalPoint, "mm", ReadingForm::kDeviation,
           "the nominal point, in workpiece coordinates"),
    row_of_distance(),
    uncertainty(),
    angle_uncertainty(),
    motion(columns::kTime, "s", "time of the row; the time must not decrease within a run", "0"),
    motion(columns::kFeed, "mm/min", "feed along the path", "0"),
    motion(columns::kCurvature, "1/mm", "curvature of the path", "0"),
    motion(columns::kVisit, "", "number of rows since the start of the run, from 0", "the rows are counted"),
    run(),
    label(columns::kRole, false, "`fit`, or `check`: a held-out row that only tests the fit", "`fit`"),
    label(columns::kCorrected, false,
          "fingerprint of the correction image that was running; `--images` names the folder with the file "
          "of this image",
          "no correction was on"),
    label(columns::kSetup, true, "label of the set-up of the instrument, with a separate BaseShift", "`run`"),
    label(columns::kClock, true, "label of the rows with one unbroken time base", "`run`"),
    label(columns::kBlock, true, "label of the rows that cross-validation leaves out together", "`run`"),
};

}  // namespace

std::span<const ColumnGroup> column_groups() { return kGroups; }

const ColumnGroup* find_column(std::string_view name) {
  for (const ColumnGroup& group : kGroups)
    for (const char* const one : group.list())
      if (name == one) return &group;
  return nullptr;
}

const ColumnGroup& reading_columns(ReadingForm form) {
  return *std::find_if(kGroups.begin(), kGroups.end(),
                       [&](const ColumnGroup& group) { return group.use == kReading && group.form == form; });
}

std::vector<const ColumnGroup*> columns_beside(ReadingForm form) {
  std::vector<const ColumnGroup*> list;
  for (const ColumnGroup& group : kGroups)
    if (group.use == kBeside && group.form == form) list.push_back(&group);
  return list;
}

Dimension dimension_of(const ColumnGroup& group) { return find_unit(group.unit)->dimension; }

std::optional<Dimension> other_dimension_of(const ColumnGroup& group) {
  if (group.or_unit == nullptr) return std::nullopt;
  return find_unit(group.or_unit)->dimension;
}

std::string heading(std::string_view name, std::string_view unit) {
  return unit.empty() ? std::string(name) : std::string(name) + "[" + std::string(unit) + "]";
}

std::string heading(std::string_view name) { return heading(name, column_unit(name)); }

std::string headings(std::span<const char* const> names) {
  std::string text;
  for (const char* const name : names) text += (text.empty() ? "" : ",") + heading(name);
  return text;
}

const char* column_unit(std::string_view name) {
  const ColumnGroup* const group = find_column(name);
  return group == nullptr ? "" : group->unit;
}

std::string axis_column(AxisQuantity quantity, std::string_view axis) {
  return entry_of(quantity).prefix + std::string(axis);
}

const char* unit_of(AxisQuantity quantity, bool rotary) { return base_unit(dimension_of(quantity, rotary)); }

std::string axis_heading(AxisQuantity quantity, std::string_view axis, bool rotary) {
  return heading(axis_column(quantity, axis), unit_of(quantity, rotary));
}

std::optional<AxisColumnName> axis_column_named(std::string_view name,
                                                const std::function<bool(const std::string&)>& is_axis) {
  for (const AxisColumnEntry& column : kAxisColumns) {
    if (!name.starts_with(column.prefix)) continue;
    const std::string axis(name.substr(std::string_view(column.prefix).size()));
    if (!axis.empty() && is_axis(axis)) return AxisColumnName{column.quantity, axis};
  }
  return std::nullopt;
}

std::string words_of(std::span<const char* const> names) {
  std::string text;
  for (const char* const name : names) text += (text.empty() ? "" : " ") + std::string(name);
  return text;
}

std::string reading_column_names() {
  std::string names;
  for (const ColumnGroup& group : kGroups)
    if (group.use == kReading) names += (names.empty() ? "" : " ") + words_of(group.list());
  return names;
}

bool is_reading(const CsvColumn& column, const std::function<const CsvColumn*(std::string_view)>& find) {
  const ColumnGroup* const group = find_column(column.name);
  if (group == nullptr || group->use != kReading) return false;
  if (!group->later) return true;
  if (find(column.name) == nullptr) return false;
  const std::vector<const ColumnGroup*> needed = columns_beside(group->form);
  for (const ColumnGroup* const other : needed)
    for (const char* const name : other->list())
      if (find(name) == nullptr) return false;
  if (!needed.empty()) return true;
  const auto has_unit = [&](const CsvColumn& one) {
    const auto unit = find_unit(one.unit);
    return unit && unit->dimension == dimension_of(*group);
  };
  if (!entry_of(group->form).together) return has_unit(column);
  const auto list = group->list();
  return std::all_of(list.begin(), list.end(), [&](const char* name) {
    const CsvColumn* const one = find(name);
    return one != nullptr && has_unit(*one);
  });
}

bool is_name_of_terms(std::string_view name) {
  const ColumnGroup* const group = find_column(name);
  return group != nullptr && group->in_terms;
}

std::optional<std::string> angle_about(std::string_view axis) {
  if (axis.size() != 1 || axis[0] < 'A' || axis[0] > 'C') return std::nullopt;
  return columns::kRotation[static_cast<std::size_t>(axis[0] - 'A')];
}

bool is_role(std::string_view word) {
  return std::any_of(kRoles.begin(), kRoles.end(), [&](const char* role) { return word == role; });
}

}  // namespace vernier::format
