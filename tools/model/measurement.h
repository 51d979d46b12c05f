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

/// Kinds of reading are the measurement format's.
using ObservationKind = format::ReadingKind;
using format::is_direction;
using format::is_free_of_setup;
using format::is_inclination;
using format::is_rotation;

/// One measured number: mm, or deg for rotations.
struct Observation {
  ObservationKind kind = ObservationKind::kX;
  std::size_t row = 0;
  double value = 0;
};

/// A column that the machine file does not know: it may be the key to a missing effect. NaN where the cell is
/// empty.
struct CandidateInput {
  std::string name, unit;
  Column value;
};

/// A column of words, kept as it stands.
struct LabelColumn {
  std::string name;
  std::vector<std::string> value;
};

/// `other_end` of a row without a distance.
inline constexpr std::size_t kNoRow = static_cast<std::size_t>(-1);

/// The rows of one or several measurement files, bound to a machine (FORMATS section 2). Rows excluded for an
/// empty input cell are not in it, only counted.
struct Measurement {
  std::vector<std::string> files;
  States states;
  std::vector<Observation> observations;  // by row, in the order of their kinds
  std::vector<CandidateInput> candidates;
  std::vector<LabelColumn> labels;
  Column uncertainty;                   // u of the row, mm (deg for its rotations); 0 where not given
  Column angle_uncertainty;             // ua: of its rotations, deg; 0 where not given; empty: in all
  std::vector<char> check;              // role of the row
  std::vector<std::size_t> file, line;  // where the row stands
  /// What a board had added in each row, an entry an axis, mm or deg; empty: nothing. states.axis is where
  /// the machine stood, the commanded position with this added.
  std::vector<Column> correction;
  std::vector<std::string> corrected;  // fingerprint of the image that ran in each row; empty: none in all
  Eigen::Matrix3Xd centre;             // of `length`, measuring frame, mm
  Eigen::Matrix3Xd nominal_point;      // of `d`, workpiece coordinates, mm
  Eigen::Matrix3Xd direction;          // of a1 a2, unit vectors, measuring frame; empty: none in all
  std::vector<std::size_t> other_end;  // row at the other end of a distance, else kNoRow; empty: none in all
  std::size_t excluded = 0;            // rows with an empty input cell
  std::vector<std::string> recorded;   // names of the columns of motion that some file has (vX, feed, t ...)

  std::size_t rows() const { return states.count; }
  bool has_recorded(std::string_view name) const;
};

/// Standard uncertainty of a reading: ua of its row for a rotation that has one, else u; 0 where none is
/// given. mm or deg. tool.
double uncertainty_of(const Measurement& measurement, const Observation& observation);

/// The position that an axis was commanded to in each row (read, where that was logged), mm or deg: what was
/// set, and so what tells whether two rows are at one pose. states.axis less the correction, to 1e-9 as it
/// was written. tool.
Column commanded(const Measurement& measurement, std::size_t axis);
double commanded(const Measurement& measurement, std::size_t axis, Eigen::Index row);
/// The rows as they were commanded, without a correction. tool.
States commanded_states(const Measurement& measurement);

/// Fills `correction` (0 in all rows when called) of one file's rows where `corrected` names an image.
/// states.axis is as commanded. text: the file's own.
using ImageCorrection =
    std::function<void(Measurement& rows, const Machine& machine, const std::string& text)>;

/// Reads measurement files for a machine; columns in any order, units converted to the base units (an input
/// to the unit that the machine declares). images: for files that name an image and have no column of a
/// correction; without it such a file is refused. Throws InputError with file, line and word. tool.
Measurement read_measurement(const std::vector<std::string>& paths, const Machine& machine,
                             const ImageCorrection& images = {});

/// Throws InputError with file and line where `t` falls from one row of a run to its next: what depends on
/// time or lags has no meaning there. tool.
void require_time_order(const Measurement& measurement);

/// The rows `keep` of a measurement, any of them more than once, with their observations; a distance only
/// where both its ends are kept.
Measurement select_rows(const Measurement& all, const std::vector<std::size_t>& keep);

/// Appends rows bound to the same machine. Runs (and set-ups ...) of one name are one, or where `apart` none
/// of `next` is one of `all`. Throws InputError where a column stands in two units. tool.
void append_measurement(Measurement& all, Measurement next, bool apart = false);

/// The same from text (one file), for tests and imports.
Measurement parse_measurement(const std::string& text, const std::string& file, const Machine& machine,
                              const ImageCorrection& images = {});

}  // namespace vernier::model
