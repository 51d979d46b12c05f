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

/// Kind of an observation: the kinds of reading of the measurement format.
using ObservationKind = format::ReadingKind;
using format::is_direction;
using format::is_free_of_setup;
using format::is_inclination;
using format::is_of_thing;
using format::is_rotation;

/// One measured number: mm, or deg for rotations.
struct Observation {
  ObservationKind kind = ObservationKind::kX;
  std::size_t row = 0;
  double value = 0;
};

/// A column that the machine file does not declare. A missing effect may depend on such a column. NaN: the
/// cell is empty.
struct CandidateInput {
  std::string name, unit;
  Column value;
};

/// A column of words, unchanged.
struct LabelColumn {
  std::string name;
  std::vector<std::string> value;
};

/// `other_end` of a row without a distance.
inline constexpr std::size_t kNoRow = static_cast<std::size_t>(-1);

/// An object that the tool point touched: an unknown point (`same`; an artefact of type point without known
/// values), or an artefact of the machine file. Each touched object has separate unknown values in each
/// set-up. An exception is an artefact with a stated position and without a stated set-up: it is one body
/// that stands in several set-ups, each with its own BaseShift, and it has the same values in all of them.
struct Thing {
  format::ReadingForm form = format::ReadingForm::kSame;
  std::string label, setup;  // setup: empty if rows state none
  Artefact artefact;

  bool is_unknown_point() const { return form == format::ReadingForm::kSame; }
  /// True if the object is in the measuring frame of its set-up; false if the object is in workpiece
  /// coordinates.
  bool in_measuring_frame() const { return artefact.place.has_value(); }
  /// True if the object has the same values in all set-ups.
  bool is_in_every_set_up() const { return in_measuring_frame() && !artefact.setup; }
  /// True if both are the same object, in two measurements of one machine.
  bool is(const Thing& other) const {
    return form == other.form && label == other.label && setup == other.setup;
  }
};

/// Value of `thing` in a row that touched no object.
inline constexpr std::size_t kNoThing = static_cast<std::size_t>(-1);

/// The rows of one or several measurement files, bound to a machine (FORMATS section 2). Rows with an empty
/// input cell are not included; the measurement contains only their number.
struct Measurement {
  std::vector<std::string> files;
  States states;
  std::vector<Observation> observations;  // by row, in the order of their kinds
  std::vector<CandidateInput> candidates;
  std::vector<LabelColumn> labels;
  Column uncertainty;                   // u of the row, mm (deg for its rotations); 0 where not given
  Column angle_uncertainty;             // ua: of its rotations, deg; 0 if not given; empty: given in no row
  std::vector<char> check;              // role of the row
  std::vector<std::size_t> file, line;  // file and line of the row
  /// Correction that a board added in each row, one entry per axis, mm or deg. Empty: no
  /// correction. states.axis is the actual position of the machine: the commanded position plus
  /// the correction.
  std::vector<Column> correction;
  std::vector<std::string>
      corrected;                   // fingerprint of the active image in each row; empty: no image in any row
  Eigen::Matrix3Xd centre;         // of `length`, measuring frame, mm
  Eigen::Matrix3Xd nominal_point;  // of `d`, workpiece coordinates, mm
  Eigen::Matrix3Xd direction;      // of a1 a2, unit vectors, measuring frame; empty: in no row
  std::vector<std::size_t> other_end;  // row at the other end of a distance, else kNoRow; empty: no distances
  std::vector<Thing> things;           // of `same` and `on`
  std::vector<std::size_t> thing;      // of the row, else kNoThing; empty: in no row
  std::size_t excluded = 0;            // rows with an empty input cell
  std::vector<std::string>
      recorded;  // names of the columns of motion that at least one file has (vX, feed, t ...)

  std::size_t rows() const { return states.count; }
  bool has_recorded(std::string_view name) const;
  std::size_t thing_of(std::size_t row) const { return thing.empty() ? kNoThing : thing[row]; }
  /// The distance of this row is between two unknown points (`same` at both ends), not between tool points.
  bool is_between_things(std::size_t row) const;
};

/// Name of the set-up of a measurement file: the file name without folder and ending; with_folder: with the
/// name of the folder ("b/survey"), for two files of one name. The rows of a file without a column `setup`
/// belong to `<BaseShift setup="NAME">` of the machine file, if there is one.
std::string set_up_of_file(const std::string& path, bool with_folder = false);

/// Returns the standard uncertainty of a reading. For a rotation the result is ua of its row if given, else
/// u. The result is 0 if the row has no uncertainty. mm or deg.
double uncertainty_of(const Measurement& measurement, const Observation& observation);

/// True if the set-up of the instrument does not change the reading. An object without a known position is in
/// workpiece coordinates.
bool is_free_of_set_up(const Measurement& measurement, const Observation& observation);

/// Returns the commanded position of an axis in each row (the read position, if it was logged), mm or deg.
/// Two rows with the same commanded positions are at one pose. The commanded position is states.axis minus
/// the correction, rounded to 1e-9 as it was written.
Column commanded(const Measurement& measurement, std::size_t axis);
double commanded(const Measurement& measurement, std::size_t axis, Eigen::Index row);
/// Returns the rows at their commanded positions, without a correction.
States commanded_states(const Measurement& measurement);

/// Computes `correction` in the rows of one file where `corrected` names an image. `correction` is 0 in all
/// rows before the call. states.axis is the commanded position. text: the text of the file.
using ImageCorrection =
    std::function<void(Measurement& rows, const Machine& machine, const std::string& text)>;

/// Reads measurement files for a machine. Columns may be in any order. Units are converted to the base units
/// (an input to the unit that the machine declares). images: for files that name an image but have no
/// correction column. Without `images` a file that names an image is refused. Throws InputError with file,
/// line and word.
Measurement read_measurement(const std::vector<std::string>& paths, const Machine& machine,
                             const ImageCorrection& images = {});

/// Throws InputError with file and line if `t` decreases from one row of a run to the next. In rows without
/// time order, time-dependent terms and lags have no meaning.
void require_time_order(const Measurement& measurement);

/// Returns the rows `keep` of a measurement with their observations. `keep` may contain a row several times.
/// A distance is included only if the rows of both its ends are included.
Measurement select_rows(const Measurement& all, const std::vector<std::size_t>& keep);

/// Appends rows that are bound to the same machine. Runs (and set-ups ...) with the same name are merged. If
/// `apart`, a run of `next` is never merged with a run of `all`. Throws InputError if a column has two units.
void append_measurement(Measurement& all, Measurement next, bool apart = false);

/// Reads one measurement file from a text, for tests and imports.
Measurement parse_measurement(const std::string& text, const std::string& file, const Machine& machine,
                              const ImageCorrection& images = {});

}  // namespace vernier::model
