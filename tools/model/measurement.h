// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "tools/format/readings.h"
#include "tools/model/machine.h"
#include "tools/model/states.h"

namespace vernier::model {

/// Kind of an observation. The kinds are the kinds of reading in the measurement format.
using ObservationKind = format::ReadingKind;
using format::is_direction;
using format::is_free_of_setup;
using format::is_inclination;
using format::is_of_thing;
using format::is_rotation;

/// One measured value of a row: mm, or deg for rotations.
struct Observation {
  ObservationKind kind = ObservationKind::kX;
  std::size_t row = 0;
  double value = 0;
};

/// A column of a measurement file that the machine file does not declare as an input. A physical effect that
/// is missing in the model may depend on a column that is not declared as an input. An empty cell
/// of such a column has the value NaN.
struct CandidateInput {
  std::string name, unit;
  Column value;
};

/// A column of words in a measurement file, without any change.
struct LabelColumn {
  std::string name;
  std::vector<std::string> value;
};

/// Value of `other_end` in a row without a distance reading.
inline constexpr std::size_t kNoRow = static_cast<std::size_t>(-1);

/// An object that the tool point touched: an unknown point (`same`), or an artefact of the machine file
/// (`on`). An artefact of type point without known values is an unknown point too. A touched object has
/// separate unknown values in each set-up, with one exception. Exception: an artefact with a stated position
/// and without a stated set-up is one body in several set-ups, each with its own BaseShift. An artefact that
/// is one body in several set-ups has the same values in all set-ups.
struct Thing {
  format::ReadingForm form = format::ReadingForm::kSame;
  std::string label, setup;  // setup: empty if the rows state no set-up
  Artefact artefact;

  bool is_unknown_point() const { return form == format::ReadingForm::kSame; }
  /// True if the object is in the measuring frame of its set-up; false if the object is in workpiece
  /// coordinates.
  bool in_measuring_frame() const { return artefact.place.has_value(); }
  /// True if the object has the same values in all set-ups.
  bool is_in_every_set_up() const { return in_measuring_frame() && !artefact.setup; }
  /// True if `other` is the same object in another measurement of the same machine.
  bool is(const Thing& other) const {
    return form == other.form && label == other.label && setup == other.setup;
  }
};

/// Value of `thing` in a row that touches no object.
inline constexpr std::size_t kNoThing = static_cast<std::size_t>(-1);

/// The rows of one or several measurement files, read for a machine (FORMATS section 2). A row with an empty
/// cell in an input column is not included. The member `excluded` is the number of rows that are not included
/// because an input cell is empty.
struct Measurement {
  std::vector<std::string> files;
  States states;
  std::vector<Observation> observations;  // sorted by row, and in each row by kind
  std::vector<CandidateInput> candidates;
  std::vector<LabelColumn> labels;
  Column uncertainty;                   // standard uncertainty u of the row, mm (deg for its rotations); 0 if
                                        // not given
  Column angle_uncertainty;             // standard uncertainty ua of the row's rotations, deg; 0 if not
                                        // given; empty if no row has ua
  std::vector<char> check;              // true if the row is a check row
  std::vector<std::size_t> file, line;  // measurement file and line of each row
  /// Correction that a board added to each axis in each row, mm or deg. `correction` is empty if no row has a
  /// correction. states.axis is the actual position of the machine: the commanded position plus the
  /// correction.
  std::vector<Column> correction;
  std::vector<std::string> corrected;  // fingerprint of the active image in each row; empty if no row has an
                                       // image
  Eigen::Matrix3Xd centre;             // centre point of the reading `length`, measuring frame, mm
  Eigen::Matrix3Xd nominal_point;      // nominal point of the reading `d`, workpiece coordinates, mm
  Eigen::Matrix3Xd direction;  // unit vector for the readings a1 and a2, measuring frame; empty if no row
                               // has it
  std::vector<std::size_t> other_end;  // row at the other end of a distance, otherwise kNoRow; empty if there
                                       // are no distances
  std::vector<Thing> things;           // the touched objects of `same` and `on`
  std::vector<std::size_t> thing;      // index of the touched object of each row, otherwise kNoThing; empty
                                       // if no row touches an object
  std::size_t excluded = 0;            // number of rows that were excluded because an input cell is empty
  std::vector<std::string>
      recorded;  // names of the motion columns (vX, feed, t ...) that at least one file has

  std::size_t rows() const { return states.count; }
  bool has_recorded(std::string_view name) const;
  std::size_t thing_of(std::size_t row) const { return thing.empty() ? kNoThing : thing[row]; }
  /// True if the distance reading of a row is between two unknown points (`same` at both ends), not between
  /// two tool points.
  bool is_between_things(std::size_t row) const;
};

/// Returns the name of the set-up of a measurement file: the file name without folder and ending.
/// `with_folder`: true adds the name of the folder ("b/survey"), if two files have the same name. If a file
/// has no column `setup`, its rows belong to `<BaseShift setup="NAME">` of the machine file, if such a
/// BaseShift exists.
std::string set_up_of_file(const std::string& path, bool with_folder = false);

/// Returns the standard uncertainty of a reading. For a rotation, the standard uncertainty is ua of its row;
/// if ua is not given, it is u. The standard uncertainty of a reading is in mm or deg. The function
/// uncertainty_of() returns 0 if the row has no uncertainty.
double uncertainty_of(const Measurement& measurement, const Observation& observation);

/// True if the set-up of the instrument has no influence on the reading. A touched object without a known
/// position is in workpiece coordinates.
bool is_free_of_set_up(const Measurement& measurement, const Observation& observation);

/// Returns the commanded position of an axis in each row, mm or deg. If the position was logged, it is the
/// read position. Two rows with the same commanded positions are at one pose. The commanded position is
/// states.axis minus the correction, rounded to 1e-9.
Column commanded(const Measurement& measurement, std::size_t axis);
double commanded(const Measurement& measurement, std::size_t axis, Eigen::Index row);
/// Returns the states of the rows at their commanded positions, without the correction.
States commanded_states(const Measurement& measurement);

/// Function that computes `correction` in the rows of one file in which the column `corrected` names an
/// image. Before the call, `correction` is 0 in all rows, and states.axis is the commanded position. `text`:
/// the text of the measurement file.
using ImageCorrection =
    std::function<void(Measurement& rows, const Machine& machine, const std::string& text)>;

/// Reads one or several measurement files for a machine. The columns of a measurement file may be in any
/// order. Values are converted to the base units. An input is converted to the unit that the machine
/// declares. `images`: function for files that name an image but have no correction column. If `images` is
/// empty, a file that names an image is an error. For an invalid file, throws InputError with file, line and
/// word.
Measurement read_measurement(const std::vector<std::string>& paths, const Machine& machine,
                             const ImageCorrection& images = {});

/// Throws InputError with file and line if the time `t` decreases from one row of a run to the next row. In
/// rows that are not in time order, time-dependent terms and lags have no meaning.
void require_time_order(const Measurement& measurement);

/// Returns the measurement that contains only the rows `keep` with their observations. The list `keep` may
/// contain a row several times. A distance reading is included only if the rows of both its ends are
/// included.
Measurement select_rows(const Measurement& all, const std::vector<std::size_t>& keep);

/// Appends the rows of another measurement of the same machine. Runs and set-ups with the same name in both
/// measurements are merged. `apart`: true keeps the runs of `next` separate from the runs of `all`, also if
/// they have the same name. Throws InputError if a column has different units in the two measurements.
void append_measurement(Measurement& all, Measurement next, bool apart = false);

/// Reads one measurement file from its text; used by tests and imports.
Measurement parse_measurement(const std::string& text, const std::string& file, const Machine& machine,
                              const ImageCorrection& images = {});

}  // namespace vernier::model
