// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "tools/probe/conditions.h"
#include "tools/probe/touch_fit.h"
#include "tools/probe/touch_table.h"

namespace vernier::probe {

enum class CalibrationArtefact { kBlock, kRing, kSphere };

/// Sizes of a known artefact and of a nominal stylus.
struct CalibrationSetup {
  CalibrationArtefact artefact = CalibrationArtefact::kSphere;
  double size_mm = 0;  // block: distance of its faces; ring, sphere: diameter
  std::optional<double> ball_radius_mm = std::nullopt;  // nominal, of the stylus ball
  double outlier_level = 0.01;
  /// Conditions of the touches. If they are given, invalid touches are reported.
  std::optional<double> clearance_mm = std::nullopt, overtravel_mm = std::nullopt;
  TouchConditions conditions = {};
};

/// A parameter of the calibration with its standard uncertainty.
struct Calibrated {
  std::string name, unit;
  double value = 0, std = 0;
};

/// Returns the parameter of this name; null if no parameter has the name.
const Calibrated* find_calibrated(const std::vector<Calibrated>& parameters, const std::string& name);

/// Adds a sentence for each touch that a fit excluded, with the line and the residual of the touch.
void say_outliers(const TouchFit& fit, const TouchTable& table, std::vector<std::string>& findings);

/// Properties of a probe from touches of an artefact.
///
/// A touch at speed v along the approach is recorded late by v * delay - a * delay^2 / 2, and by the
/// pretravel. The pretravel is a constant. For a probe with three contacts, a lobe p3 cos 3(phi - phi3) of
/// the azimuth phi of the approach is added. Touches cannot distinguish the constant pretravel from the
/// radius of the stylus ball. The touches determine only the difference radius - pretravel: the effective tip
/// radius.
struct ProbeCalibration {
  TouchFit fit;
  /// Order: delay_ms first, if the touches determine it; then delay_spread, its standard deviation from touch
  /// to touch, if the scatter grows with the feed; then the parameters of the artefact.
  std::vector<Calibrated> parameters;
  std::optional<double> line_intercept_um, line_slope_um_per_mm_min;  // block: difference against feed
  std::optional<double> line_intercept_std_um, line_slope_std;
  bool delay_found = false, lobes_found = false;
  std::vector<std::string> findings;  // in plain sentences: coverage, outliers, what cannot be distinguished

  const Calibrated* find(const std::string& name) const { return find_calibrated(parameters, name); }
};

/// Reads touches and determines the parameters of the probe and the artefact. Columns: feed[mm/min]. Block:
/// upper, lower (mm: recorded position of the stylus at the upper and the lower face), angle[deg] (of the
/// probe about its axis, optional). Ring, sphere: x, y, z (no z for a ring; a sphere without z was touched in
/// the plane through its centre), a[mm/s^2] along the approach (optional, negative while braking), u
/// (optional). Throws InputError. Source of the block's form: NISTIR 6415, 1999, equations 1 and 2. A
/// result that no probe can have (a delay outside -1..100 ms, a tip larger than the artefact) also throws
/// InputError.
ProbeCalibration calibrate_probe(TouchTable& table, const CalibrationSetup& setup);

/// Calibrations of the same touches by groups.
struct GroupComparison {
  struct Group {
    std::string value;  // of the column
    std::size_t touches = 0;
    std::vector<Calibrated> parameters;
  };
  std::vector<Group> groups;  // in the order of the file
  double chance = 1;          // probability that groups without a difference differ as much (F test)
  std::string words;
};

/// Calibrates the touches of each value of a column separately and compares with a calibration of all. Throws
/// InputError: a column that does not exist, only one group, or a group that is too small.
GroupComparison compare_groups(const TouchTable& table, const CalibrationSetup& setup,
                               const std::string& column, const ProbeCalibration& all);

}  // namespace vernier::probe
