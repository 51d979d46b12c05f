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

/// Sizes of a known artefact and of the nominal stylus.
struct CalibrationSetup {
  CalibrationArtefact artefact = CalibrationArtefact::kSphere;
  double size_mm = 0;  // block: distance between its faces; ring, sphere: diameter
  std::optional<double> ball_radius_mm = std::nullopt;  // nominal radius of the stylus ball
  double outlier_level = 0.01;
  /// Conditions under which the touches were made. If these conditions are given, touches that are not valid
  /// are reported.
  std::optional<double> clearance_mm = std::nullopt, overtravel_mm = std::nullopt;
  TouchConditions conditions = {};
};

/// A parameter of the probe calibration with its standard uncertainty.
struct Calibrated {
  std::string name, unit;
  double value = 0, std = 0;
};

/// Returns the parameter with the name `name`; null if there is no such parameter.
const Calibrated* find_calibrated(const std::vector<Calibrated>& parameters, const std::string& name);

/// Adds a sentence for each touch that a fit excluded as an outlier, with the line and the residual of the
/// touch.
void say_outliers(const TouchFit& fit, const TouchTable& table, std::vector<std::string>& findings);

/// Properties of a touch probe, from touches of an artefact.
///
/// If a touch is made at the speed v along the approach, the recorded position is late by v * delay - a *
/// delay^2 / 2, and by the pretravel. The pretravel is the same for all touches. For a probe with three
/// contacts, a lobe p3 cos 3(phi - phi3) is added, where phi is the azimuth of the approach. Touches cannot
/// distinguish a constant pretravel from the radius of the stylus ball. The touches determine only the
/// difference radius - pretravel, which is the effective tip radius.
struct ProbeCalibration {
  TouchFit fit;
  /// Order of the parameters: delay_ms if the touches determine it; delay_spread (standard deviation of the
  /// delay from touch to touch) if the scatter increases with the feed; the parameters of the artefact.
  std::vector<Calibrated> parameters;
  std::optional<double> line_intercept_um, line_slope_um_per_mm_min;  // for a block: difference of the
                                                                      // positions at both faces as a linear
                                                                      // function of the feed
  std::optional<double> line_intercept_std_um, line_slope_std;
  bool delay_found = false, lobes_found = false;
  std::vector<std::string> findings;  // sentences for people: coverage, outliers, parameters that cannot be
                                      // distinguished

  const Calibrated* find(const std::string& name) const { return find_calibrated(parameters, name); }
};

/// Reads the touches and determines the parameters of the probe and of the artefact. All artefacts need the
/// column feed[mm/min]. A block needs the columns upper and lower (mm: recorded position of the stylus at the
/// upper and the lower face), and optionally angle[deg] (rotation of the probe about its axis). A ring or
/// sphere needs the columns x, y, z, and optionally a[mm/s^2] (acceleration along the approach, negative
/// during braking) and u. A ring has no z; a sphere without z was touched in the plane through its centre.
/// Throws InputError if a column is missing or not valid. The equations for the block are those of NISTIR
/// 6415, 1999, equations 1 and 2. Throws InputError also for a result that no probe can have (a delay outside
/// -1..100 ms, a tip larger than the artefact).
ProbeCalibration calibrate_probe(TouchTable& table, const CalibrationSetup& setup);

/// Calibrations with the same touches in groups, compared with the calibration of all touches.
struct GroupComparison {
  struct Group {
    std::string value;  // value of the column for this group
    std::size_t touches = 0;
    std::vector<Calibrated> parameters;
  };
  std::vector<Group> groups;  // in the order of the file
  double chance = 1;          // p-value: probability of such differences between the groups if there is no
                              // true difference (F test)
  std::string words;
};

/// Calibrates the touches for each value of a column separately, and compares the results with the
/// calibration of all touches. Throws InputError if the column does not exist, if there is only one group, or
/// if a group is too small.
GroupComparison compare_groups(const TouchTable& table, const CalibrationSetup& setup,
                               const std::string& column, const ProbeCalibration& all);

}  // namespace vernier::probe
