// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "tools/format/csv_file.h"
#include "tools/vibration/alignment.h"
#include "tools/vibration/signal_features.h"

namespace vernier::vibration {

/// One signal of a vibration record.
struct Signal {
  std::string name, unit;
  std::vector<double> value;
};

/// A vibration record: signals with a constant sample rate, and positions if the record contains them. The
/// CSV file has the column `t[s]`, or the sample rate is given; each other column that is not named as a
/// position is a signal.
struct VibrationRecord {
  double start_s = 0, rate_Hz = 0;
  std::vector<Signal> signals, positions;
  std::size_t samples = 0;
};

/// Reads a vibration record. `rate_Hz` is the sample rate of a record without a column t. If the record has a
/// column t, this column gives the sample rate, and its times must be uniform within 1 % of a sample period.
/// Throws InputError with line and word of the error: an empty or malformed cell, times that are not uniform,
/// no signal.
VibrationRecord read_vibration(const format::CsvFile& file, std::optional<double> rate_Hz,
                               const std::vector<std::string>& positions);

/// Adds the difference of two signals as a new signal, for example "wrist=hand-base". Throws InputError if a
/// signal is unknown, or if both signals have different units.
void add_difference(VibrationRecord& record, const std::string& definition);

/// Features that the command `vernier features` computes from each signal.
struct FeatureChoice {
  std::size_t window = 1500;
  std::vector<std::size_t> features;  // indices of the features in kFeatureNames
  bool centred = false;               // true: the mean of the record is subtracted first
};

/// Table with one column for each signal and feature (SIGNAL_FEATURE), in the order of the signals. Each
/// value is the feature of the window whose last sample is given in `ends`, as the board computes it at that
/// moment. A cell is empty if the record does not fill the window, or if the feature is 0/0.
struct FeatureColumns {
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> cells;  // cells[row][column]
  std::size_t empty_rows = 0;                   // number of rows for which the record does not fill the
                                                // window
};
FeatureColumns feature_columns(const VibrationRecord& record, const FeatureChoice& choice,
                               const std::vector<std::optional<std::size_t>>& ends);

/// Returns column `name` of a measurement file in its base unit (mm, deg, s, ...). Throws InputError if the
/// column is absent or a cell is not a number.
std::vector<double> numeric_column(const format::CsvFile& file, const std::string& name);

/// Returns the column `name` as lengths in um; an empty cell gives NaN. Throws InputError if the column is
/// absent, if its unit is not a length, or if a cell is not a number.
std::vector<double> measured_lengths_um(const format::CsvFile& file, const std::string& name);

/// Returns the second derivative of a position with respect to time; the intervals between the times may
/// differ. The series of accelerations has one value less than the positions at each end.
Series acceleration_of(const std::vector<double>& t_s, const std::vector<double>& position);

}  // namespace vernier::vibration
