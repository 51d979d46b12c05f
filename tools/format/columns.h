// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tools/format/csv_file.h"
#include "tools/format/readings.h"
#include "tools/format/units.h"

namespace vernier::format {

/// Names of the columns of a measurement file, for code that reads or writes a column.
namespace columns {
inline constexpr std::array kPoint = {"x", "y", "z"};
inline constexpr std::array kRotation = {"rx", "ry", "rz"};
inline constexpr std::array kCentre = {"cx", "cy", "cz"};
inline constexpr std::array kNominalPoint = {"px", "py", "pz"};
inline constexpr std::array kNormal = {"nx", "ny", "nz"};
inline constexpr std::array kDirection = {"ax", "ay", "az"};
inline constexpr std::array kInclination = {"ix", "iy"};
inline constexpr std::array kBoard = {"bx", "by", "bz"};
inline constexpr std::array kBoardRotation = {"brx", "bry", "brz"};
inline constexpr const char* kSame = "same";
inline constexpr const char* kOn = "on";
/// Inputs with the position of an offset probe in the frame of the tool; not in the table of columns.
inline constexpr std::array kProbe = {"probeX", "probeY"};
inline constexpr const char* kLength = "length";
inline constexpr const char* kDeviation = "d";
inline constexpr const char* kDistance = "distance";
inline constexpr const char* kFrom = "from";
inline constexpr const char* kUncertainty = "u";
inline constexpr const char* kAngleUncertainty = "ua";
inline constexpr const char* kTime = "t";
inline constexpr const char* kFeed = "feed";
inline constexpr const char* kCurvature = "curv";
inline constexpr const char* kVisit = "visit";
inline constexpr const char* kRun = "run";
inline constexpr const char* kRole = "role";
inline constexpr const char* kCorrected = "corrected";
inline constexpr const char* kSetup = "setup";
inline constexpr const char* kClock = "clock";
inline constexpr const char* kBlock = "block";
}  // namespace columns

/// Purpose of a column.
enum class ColumnUse : std::uint8_t {
  kReading,      // the column contains a reading
  kBeside,       // a value that a reading in the same row needs: a centre, a normal
  kUncertainty,  // uncertainty of the readings in the row
  kMotion,       // state of the machine along its path
  kLabel         // label that assigns the row to a group
};

/// A group of columns with one meaning: "x y z", or a single column.
struct ColumnGroup {
  std::array<const char*, 3> names;
  std::size_t count;
  const char* unit;  // unit in which files are written; "": a number without unit, or a word
  ColumnUse use;
  const char* meaning;                     // description of one column and of several columns
  ReadingForm form = ReadingForm::kPoint;  // form of the reading, for kReading and kBeside
  bool words = false;                      // true: the column contains words, not numbers
  /// True if a later version of the format added the column, so that a machine file may use its name for an
  /// input. If a machine file uses the name, or the column has another unit, the column is a column of the
  /// user.
  bool later = false;
  bool filled = false;              // true: no cell may be empty
  bool in_terms = false;            // true: expressions use this name, so that it is reserved
  const char* or_unit = nullptr;    // unit of a second dimension that the column may have
  const char* if_absent = nullptr;  // meaning if the column is absent

  std::span<const char* const> list() const { return std::span(names).first(count); }
};

/// Returns all columns whose meaning is the same for every machine.
std::span<const ColumnGroup> column_groups();

/// Returns the column of the format with the name `name`; nullptr if the format has no such column. Names are
/// case-sensitive.
const ColumnGroup* find_column(std::string_view name);
/// reading_columns returns the columns with the readings of a form. columns_beside returns the columns that
/// these readings need in the same row.
const ColumnGroup& reading_columns(ReadingForm form);
std::vector<const ColumnGroup*> columns_beside(ReadingForm form);

/// dimension_of returns the dimension that a column must have. other_dimension_of returns the second
/// dimension of the column `u`; nullopt for other columns.
Dimension dimension_of(const ColumnGroup& group);
std::optional<Dimension> other_dimension_of(const ColumnGroup& group);
/// Returns the unit of a column in files; "" for a number without unit, a word, or a column that the format
/// does not have.
const char* column_unit(std::string_view name);
/// Returns the heading of a column: "x[mm]", "nx".
std::string heading(std::string_view name, std::string_view unit);
/// Returns the name of a column with the unit of the table: "feed[mm/min]".
std::string heading(std::string_view name);

/// Returns the headings of several columns as one header: "x[mm],y[mm],z[mm]".
std::string headings(std::span<const char* const> names);

/// A quantity that has one column for each axis.
enum class AxisQuantity : std::uint8_t { kPosition, kSense, kSince, kSpeed, kAcceleration, kCorrection };

struct AxisColumnEntry {
  AxisQuantity quantity;
  const char* prefix;  // text before the name of the axis
  Dimension linear, rotary;
  const char* unit;  // unit in files for a linear axis
  bool in_terms;     // true: expressions use this name
  const char* meaning;
  const char* if_absent;
};

inline constexpr std::array kAxisColumns = {
    AxisColumnEntry{AxisQuantity::kPosition, "", Dimension::kLength, Dimension::kAngle, "mm", true,
                    "commanded or read position of the axis", "an error"},
    AxisColumnEntry{AxisQuantity::kSense, "dir", Dimension::kNone, Dimension::kNone, "", true,
                    "approach direction: direction of the last motion of the axis, 1 or −1; 0: not known",
                    "0"},
    AxisColumnEntry{AxisQuantity::kSince, "since", Dimension::kLength, Dimension::kAngle, "mm", true,
                    "travel of the axis since its last reversal",
                    "computed from dir and the positions of successive rows; a long way if not known"},
    AxisColumnEntry{AxisQuantity::kSpeed, "v", Dimension::kSpeed, Dimension::kAngularSpeed, "mm/s", true,
                    "speed of the axis at the reading", "0"},
    AxisColumnEntry{AxisQuantity::kAcceleration, "a", Dimension::kAcceleration,
                    Dimension::kAngularAcceleration, "mm/s^2", true,
                    "acceleration of the axis at the reading", "0"},
    AxisColumnEntry{AxisQuantity::kCorrection, "correction", Dimension::kLength, Dimension::kAngle, "um",
                    false, "correction that a board added to the commanded position of the axis in this row",
                    "0"},
};

constexpr const AxisColumnEntry& entry_of(AxisQuantity quantity) {
  return kAxisColumns[static_cast<std::size_t>(quantity)];
}
/// Returns the name of the column for a quantity of an axis: "dirX".
std::string axis_column(AxisQuantity quantity, std::string_view axis);
constexpr Dimension dimension_of(AxisQuantity quantity, bool rotary) {
  return rotary ? entry_of(quantity).rotary : entry_of(quantity).linear;
}
/// Returns the unit of a quantity: "mm/s", "deg/s"; "" for a number without unit.
const char* unit_of(AxisQuantity quantity, bool rotary);

/// Returns the heading of the column for a quantity of an axis: "vX[mm/s]", "vC[deg/s]".
std::string axis_heading(AxisQuantity quantity, std::string_view axis, bool rotary);

/// Parts of the name of an axis column: the quantity and the axis.
struct AxisColumnName {
  AxisQuantity quantity;
  std::string axis;
};
/// Returns the axis and the quantity of a column name; nullopt if the column does not belong to an axis. An
/// axis whose name is exactly the column name has precedence.
std::optional<AxisColumnName> axis_column_named(std::string_view name,
                                                const std::function<bool(const std::string&)>& is_axis);

/// Returns names of columns in one text, for messages: "nx ny nz".
std::string words_of(std::span<const char* const> names);
/// Returns the columns of all readings as text for messages: "x y z rx …".
std::string reading_column_names();

/// True if a column contains a reading in a file with this header. A column of the first version of the
/// format is identified as a reading by its name. A column of a later version is a reading only if the header
/// has the columns and units that belong to it: `from` with `distance`; the unit of an angle for `ix` and
/// `iy`; all of `ax ay az` without a unit. `find`: function that finds a column of the header by its name.
/// The function `find` returns nullptr if the header has no such column, or if the machine file uses the name
/// for an input.
bool is_reading(const CsvColumn& column, const std::function<const CsvColumn*(std::string_view)>& find);

/// True if expressions use a quantity with this name (t, feed, nx …). The name of a quantity that expressions
/// use is not permitted for an axis or input.
bool is_name_of_terms(std::string_view name);

/// Returns the name of the reading for the angle of a rotary axis: rx, ry, rz for A, B, C (ISO 841); nullopt
/// for other axes.
std::optional<std::string> angle_about(std::string_view axis);

/// Permitted words in the column `role`. An empty cell in the column `role` means `fit`.
inline constexpr const char* kFitRole = "fit";
inline constexpr const char* kCheckRole = "check";
inline constexpr std::array kRoles = {kFitRole, kCheckRole};
bool is_role(std::string_view word);
inline constexpr const char* kRoleRule = "a role is fit or check";

}  // namespace vernier::format
