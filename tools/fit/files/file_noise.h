// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::fit {

/// Estimated standard uncertainty of the readings of a measurement file that states no u, although other
/// readings of the survey have u.
struct FileNoise {
  std::size_t file = 0;  // index in Measurement::files
  std::string name;      // of the file
  bool rotations = false;
  bool beside_u = true;  // false: no reading of the survey has u
  double u = 0;          // mm; deg if `rotations`
  double std = 0;        // standard uncertainty of `u`, same unit
  double freedom = 0;    // degrees of freedom of the estimate
  enum class Source : std::uint8_t { kRepeats, kRepeatsInRuns, kFit, kGivenMachine };
  Source source = Source::kFit;
  /// True if the fit of the whole survey does not repeat this value: the estimate did not converge.
  bool open = false;
  bool from_repeats() const { return source == Source::kRepeats || source == Source::kRepeatsInRuns; }
  /// Returns a sentence with the value, its uncertainty, its source and what to do.
  std::string sentence() const;
};

/// Estimates u of the readings without u, if other fit readings of the survey have u, or if repeats show that
/// the files without u come from instruments of different noise (a ratio of at least 3). Without this
/// estimate a reading without u has the weight of u = 1 mm beside the others. The unit of the estimate is the
/// lengths or the rotations of one file. The estimate is
/// - the standard deviation of repeats in the file, if the repeats have at least 5 degrees of freedom;
/// - otherwise that of repeats in other runs (set-ups) of the file, beside an offset of each run;
/// - otherwise the residual of the file beside a fit of all files, over its degrees of freedom (readings
///   minus the trace of their part of the hat matrix). The fit is repeated with the estimate until the
///   estimate changes by less than 2 % (variance components: W. Förstner 1979). Outliers count as three
///   standard deviations. The first value is the residual of the given machine; if the fit of the file alone
///   leaves less than a third of the result, the estimate begins again with that residual.
/// The function writes the estimates into `rows` (also for check rows of the file). Files without fit rows do
/// not change. Returns the estimates; empty if all fit readings have u, or if none has and
/// the files are alike. Throws InputError if a
/// file has less than 5 degrees of freedom.
std::vector<FileNoise> estimate_file_noise(const model::Machine& machine, model::Measurement& rows);

/// As estimate_file_noise(), but without a fit: if a file has no repeats, the estimate is the rms of
/// `residual` (measured - given machine) over the fit rows of the file. Throws no error for few readings.
std::vector<FileNoise> file_noise_of_residual(model::Measurement& rows, const Eigen::VectorXd& residual);

/// Estimates the values that came from a fit again, with another machine (a machine with an additional
/// effect). `rows` is bound to `machine`. Returns true if a value changed by more than 10 %; `rows` and
/// `noise` then have the new values, otherwise they are unchanged.
bool estimate_file_noise_again(const model::Machine& machine, model::Measurement& rows,
                               std::vector<FileNoise>& noise);

}  // namespace vernier::fit
