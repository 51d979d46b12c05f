// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "tools/format/csv_file.h"
#include "tools/vibration/alignment.h"
#include "tools/vibration/signal_features.h"

namespace vernier::vibration {

/// One signal of an accelerometer record.
struct Signal {
  std::string name, unit;
  std::vector<double> value;
};

/// An accelerometer record: evenly sampled signals, and positions if the record has them. CSV: `t[s]` or a
/// given rate; every other column is a signal unless it is named as a position.
struct VibrationRecord {
  double start_s = 0, rate_Hz = 0;
  std::vector<Signal> signals, positions;
  std::size_t samples = 0;
};

/// `rate_Hz`: of a record without t. Without rate_Hz, t must be even to 1 % of a sample period and gives the
/// rate. Throws InputError with line and word: an empty or malformed cell, uneven t, no signal.
VibrationRecord read_vibration(const format::CsvFile& file, std::optional<double> rate_Hz,
                               const std::vector<std::string>& positions);

/// Adds the signal `name` = a - b ("wrist=hand-base"); throws InputError for an unknown signal or a
/// difference of two units.
void add_difference(VibrationRecord& record, const std::string& definition);

/// Features that `vernier features` computes of each signal.
struct FeatureChoice {
  std::size_t window = 1500;
  std::vector<std::size_t> features;  // indices of kFeatureNames
  bool centred = false;               // the record's mean is subtracted first
};

/// A column for each signal and feature (SIGNAL_FEATURE), signals outermost. Each value is the feature of the
/// window that ends at the sample of `ends`, as on the board at that moment. A value is empty if a window is
/// not full or a feature is 0/0.
struct FeatureColumns {
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> cells;  // by row, then column
  std::size_t empty_rows = 0;                   // no full window
};
FeatureColumns feature_columns(const VibrationRecord& record, const FeatureChoice& choice,
                               const std::vector<std::optional<std::size_t>>& ends);

/// Returns column `name` of a measurement file in its base unit (mm, deg, s, ...). Throws InputError if the
/// column is absent or a cell is not a number.
std::vector<double> numeric_column(const format::CsvFile& file, const std::string& name);

/// Returns column `name` as lengths in um, NaN for an empty cell. Throws InputError if the column is absent,
/// is not a length, or a cell is not a number.
std::vector<double> measured_lengths_um(const format::CsvFile& file, const std::string& name);

/// Returns the second derivative of a position over (uneven) times, as a record. The record has one value
/// less at each end.
Series acceleration_of(const std::vector<double>& t_s, const std::vector<double>& position);

}  // namespace vernier::vibration
