// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace vernier::format {

/// Kind of one measured number in a row. The numbers of the kinds are indices of all tables by kind.
enum class ReadingKind : std::uint8_t {
  kX,
  kY,
  kZ,
  kRx,
  kRy,
  kRz,
  kLength,
  kD,
  kA1,
  kA2,
  kDistance,
  kIx,
  kIy,
  kSameX,
  kSameY,
  kSameZ,
  kOn1,
  kOn2,
  kOn3,
  kBoardX,
  kBoardY,
  kBoardZ,
  kBoardRx,
  kBoardRy,
  kBoardRz
};

/// Form of a reading: the quantity that the instrument measures. Readings of one form have the same columns
/// and the same formula.
enum class ReadingForm : std::uint8_t {
  kPoint,
  kRotation,
  kLength,
  kDeviation,
  kDirection,
  kDistance,
  kInclination,
  kSame,
  kOn,
  kBoard,
  kBoardRotation
};

/// One form of reading. The columns of a form are in columns.h: the columns with the reading, and the columns
/// that the reading needs.
struct ReadingFormEntry {
  ReadingForm form;
  bool rotation;        // true: the reading is an angle, deg; false: a length, mm
  bool free_of_set_up;  // true: the set-up of the instrument (BaseShift) does not affect the reading
  /// True if a reading requires all columns of the form. If all columns of a form are required, a row in
  /// which one of the columns is empty has no reading of this form.
  bool together;
  /// True if the reading is a distance, which is never negative.
  bool never_negative;
  const char* subject;  // name of its residual in a sentence: "length error"; "%": the axis in capitals
  const char* meaning;  // description in one sentence
};

inline constexpr std::array kReadingForms = {
    ReadingFormEntry{ReadingForm::kPoint, false, false, false, false, "% error",
                     "Coordinates of the tool point in the measuring frame."},
    ReadingFormEntry{ReadingForm::kRotation, true, false, false, false, "rotation error about %",
                     "Rotation of the tool in the measuring frame, as a rotation vector."},
    ReadingFormEntry{ReadingForm::kLength, false, false, false, true, "length error",
                     "Distance of the tool point from a fixed centre."},
    ReadingFormEntry{ReadingForm::kDeviation, false, true, false, false, "deviation d",
                     "Deviation of the tool point from a nominal point along a unit normal."},
    ReadingFormEntry{ReadingForm::kDirection, true, false, true, false, "direction error",
                     "Direction of the tool axis or of a line of sight, as a unit vector."},
    ReadingFormEntry{ReadingForm::kDistance, false, false, false, true, "distance error",
                     "Distance of the tool point of this row from the tool point of another row."},
    ReadingFormEntry{ReadingForm::kInclination, true, true, false, false, "inclination error of tool axis %",
                     "Inclination of an axis of the tool's frame to the horizontal."},
    ReadingFormEntry{ReadingForm::kSame, false, true, true, false, "% error at an unknown point",
                     "The tool point met an unknown point that other rows met too."},
    ReadingFormEntry{ReadingForm::kOn, false, false, true, false, "distance from the artefact",
                     "The tool point touched an artefact of the machine file."},
    ReadingFormEntry{ReadingForm::kBoard, false, false, true, false, "% error of the board",
                     "Position of a board in the frame of the camera that the tool carries."},
    ReadingFormEntry{ReadingForm::kBoardRotation, true, false, true, false,
                     "rotation error of the board about %",
                     "Rotation of a board in the frame of the camera that the tool carries."},
};

constexpr const ReadingFormEntry& entry_of(ReadingForm form) {
  return kReadingForms[static_cast<std::size_t>(form)];
}

/// Properties of one kind of reading.
struct ReadingKindEntry {
  ReadingKind kind;
  const char* name;  // name in results and messages; also the name of its column, except for the two angles
                     // of a direction
  ReadingForm form;
  std::size_t component;  // component within its form, from 0
  const char* meaning;    // description in one sentence
};

/// All kinds of readings, in the order of ReadingKind. A direction has two angles as readings, a1 and a2,
/// which are perpendicular to the direction.
inline constexpr std::array kReadingKinds = {
    ReadingKindEntry{ReadingKind::kX, "x", ReadingForm::kPoint, 0,
                     "The x coordinate of the tool point in the measuring frame."},
    ReadingKindEntry{ReadingKind::kY, "y", ReadingForm::kPoint, 1,
                     "The y coordinate of the tool point in the measuring frame."},
    ReadingKindEntry{ReadingKind::kZ, "z", ReadingForm::kPoint, 2,
                     "The z coordinate of the tool point in the measuring frame."},
    ReadingKindEntry{ReadingKind::kRx, "rx", ReadingForm::kRotation, 0,
                     "The rotation of the tool about x of the measuring frame."},
    ReadingKindEntry{ReadingKind::kRy, "ry", ReadingForm::kRotation, 1,
                     "The rotation of the tool about y of the measuring frame."},
    ReadingKindEntry{ReadingKind::kRz, "rz", ReadingForm::kRotation, 2,
                     "The rotation of the tool about z of the measuring frame."},
    ReadingKindEntry{ReadingKind::kLength, "length", ReadingForm::kLength, 0,
                     "The distance of the tool point from a fixed centre."},
    ReadingKindEntry{ReadingKind::kD, "d", ReadingForm::kDeviation, 0,
                     "The deviation of the tool point along a unit normal from a nominal point."},
    ReadingKindEntry{ReadingKind::kA1, "a1", ReadingForm::kDirection, 0,
                     "The first angle between the tool axis and the measured direction."},
    ReadingKindEntry{ReadingKind::kA2, "a2", ReadingForm::kDirection, 1,
                     "The second angle between the tool axis and the measured direction, across the first."},
    ReadingKindEntry{ReadingKind::kDistance, "distance", ReadingForm::kDistance, 0,
                     "The distance between the tool points of two rows."},
    ReadingKindEntry{ReadingKind::kIx, "ix", ReadingForm::kInclination, 0,
                     "The inclination of the tool's x axis to the horizontal."},
    ReadingKindEntry{ReadingKind::kIy, "iy", ReadingForm::kInclination, 1,
                     "The inclination of the tool's y axis to the horizontal."},
    ReadingKindEntry{ReadingKind::kSameX, "same_x", ReadingForm::kSame, 0,
                     "The x distance of the tool point from the unknown point, 0 when it is met."},
    ReadingKindEntry{ReadingKind::kSameY, "same_y", ReadingForm::kSame, 1,
                     "The y distance of the tool point from the unknown point, 0 when it is met."},
    ReadingKindEntry{ReadingKind::kSameZ, "same_z", ReadingForm::kSame, 2,
                     "The z distance of the tool point from the unknown point, 0 when it is met."},
    ReadingKindEntry{ReadingKind::kOn1, "on_1", ReadingForm::kOn, 0,
                     "The distance of the tool point from the artefact: from its surface, or the first "
                     "component from a point or across a line."},
    ReadingKindEntry{ReadingKind::kOn2, "on_2", ReadingForm::kOn, 1,
                     "The second component from a point or across a line."},
    ReadingKindEntry{ReadingKind::kOn3, "on_3", ReadingForm::kOn, 2, "The third component from a point."},
    ReadingKindEntry{ReadingKind::kBoardX, "bx", ReadingForm::kBoard, 0,
                     "The x coordinate of the board in the frame of the camera on the tool."},
    ReadingKindEntry{ReadingKind::kBoardY, "by", ReadingForm::kBoard, 1,
                     "The y coordinate of the board in the frame of the camera on the tool."},
    ReadingKindEntry{ReadingKind::kBoardZ, "bz", ReadingForm::kBoard, 2,
                     "The z coordinate of the board in the frame of the camera on the tool."},
    ReadingKindEntry{ReadingKind::kBoardRx, "brx", ReadingForm::kBoardRotation, 0,
                     "The rotation of the board about x of the camera on the tool."},
    ReadingKindEntry{ReadingKind::kBoardRy, "bry", ReadingForm::kBoardRotation, 1,
                     "The rotation of the board about y of the camera on the tool."},
    ReadingKindEntry{ReadingKind::kBoardRz, "brz", ReadingForm::kBoardRotation, 2,
                     "The rotation of the board about z of the camera on the tool."},
};
inline constexpr std::size_t kReadingKindCount = kReadingKinds.size();

constexpr const ReadingKindEntry& entry_of(ReadingKind kind) {
  return kReadingKinds[static_cast<std::size_t>(kind)];
}
constexpr ReadingForm form_of(ReadingKind kind) { return entry_of(kind).form; }
/// Returns the component of a kind within its form, from 0.
constexpr std::size_t component_of(ReadingKind kind) { return entry_of(kind).component; }
/// Returns the name of a kind in results and messages: "x", "a1".
constexpr const char* name_of(ReadingKind kind) { return entry_of(kind).name; }
/// True if the readings of this kind are angles, deg. Other kinds are lengths, mm.
constexpr bool is_rotation(ReadingKind kind) { return entry_of(form_of(kind)).rotation; }
/// Returns the unit of a kind: "mm" or "deg".
constexpr const char* unit_of(ReadingKind kind) { return is_rotation(kind) ? "deg" : "mm"; }
/// Returns the unit of a residual in results: "um" or "urad".
constexpr const char* report_unit_of(ReadingKind kind) { return is_rotation(kind) ? "urad" : "um"; }
/// True if the set-up of the instrument does not affect a reading of this kind.
constexpr bool is_free_of_setup(ReadingKind kind) { return entry_of(form_of(kind)).free_of_set_up; }
constexpr bool is_direction(ReadingKind kind) { return form_of(kind) == ReadingForm::kDirection; }
/// True if the reading is the pose of a board (the measuring frame) that a camera on the tool measures.
constexpr bool is_of_board(ReadingKind kind) {
  return form_of(kind) == ReadingForm::kBoard || form_of(kind) == ReadingForm::kBoardRotation;
}
constexpr bool is_inclination(ReadingKind kind) { return form_of(kind) == ReadingForm::kInclination; }
/// True if the value of the reading is 0 because the tool point touched an object. The object is an unknown
/// point or an artefact whose unknown values a fit eliminates.
constexpr bool is_of_thing(ReadingKind kind) {
  return form_of(kind) == ReadingForm::kSame || form_of(kind) == ReadingForm::kOn;
}

/// Returns the kind with the name `name`; nullopt if no kind has this name.
std::optional<ReadingKind> kind_named(std::string_view name);
/// Returns the names of a set of kinds. Bit n of `kinds` is kind n.
std::vector<std::string> names_of_kinds(std::uint32_t kinds);
/// Returns the unit of a kind in results, by the name of the kind; "um" if no kind has this name.
const char* report_unit_of(std::string_view name);

/// Returns the name of the residual of a kind in a sentence: "X error", "rotation error about Z", "length
/// error".
std::string subject_of(ReadingKind kind);

/// A reading with the name that `vernier new --reading` uses. A reading kind has one form, or several forms
/// that one instrument measures together.
struct SurveyReading {
  const char* word;
  std::array<ReadingForm, 2> forms;
  std::size_t form_count;
  const char* instruments;
  std::span<const ReadingForm> list() const { return std::span(forms).first(form_count); }
};

inline constexpr std::array kSurveyReadings = {
    SurveyReading{"point", {ReadingForm::kPoint}, 1, "tracker, 3-D probe on a known sphere, camera"},
    SurveyReading{"length", {ReadingForm::kLength}, 1, "ball bar, telescoping bar"},
    SurveyReading{"touch", {ReadingForm::kDeviation}, 1, "dial gauge, touch probe on a known surface"},
    SurveyReading{"pose", {ReadingForm::kPoint, ReadingForm::kRotation}, 2, "six-degree tracker"},
    SurveyReading{"rotation", {ReadingForm::kRotation}, 1, "autocollimator, angle interferometer"},
    SurveyReading{"direction", {ReadingForm::kDirection}, 1, "theodolite, camera on the tool axis"},
    SurveyReading{"distance", {ReadingForm::kDistance}, 1, "step gauge, ball plate, length between points"},
    SurveyReading{"inclination", {ReadingForm::kInclination}, 1, "electronic level on the tool"},
    SurveyReading{"same", {ReadingForm::kSame}, 1, "socket, cone or tip met from many poses"},
    SurveyReading{"on", {ReadingForm::kOn}, 1, "touch probe on a sphere, plane or ring of unknown place"},
    SurveyReading{"board", {ReadingForm::kBoard}, 1, "camera on the tool, place of a board"},
    SurveyReading{
        "board-rotation", {ReadingForm::kBoardRotation}, 1, "camera on the tool, rotation of a board"},
    SurveyReading{"board-pose",
                  {ReadingForm::kBoard, ReadingForm::kBoardRotation},
                  2,
                  "camera on the tool, place and rotation of a board (hand-eye calibration)"},
};

/// Returns the survey reading with the name `word`; nullptr if there is no such reading.
const SurveyReading* survey_reading(std::string_view word);
/// Returns the names of all survey readings as text, with `last` before the last name: "point, length, touch
/// …".
std::string survey_words(const std::string& last);

}  // namespace vernier::format
