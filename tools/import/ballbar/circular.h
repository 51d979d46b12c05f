// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <optional>
#include <string>
#include <vector>

namespace vernier::importer {

/// One pass over a circle in one direction, in time order.
struct CircularPass {
  std::string label;
  int direction = +1;                // +1: from +A towards +B; -1: the opposite direction
  std::vector<double> angle_deg;     // angle of the programmed position about the programmed centre, 0..360
  std::vector<double> deviation_mm;  // measured radius - nominal radius
  std::optional<double> feed_mm_min;
};

/// Results of ISO 230-4 for one pass. Circular deviations refer to the least-squares centre and radius of the
/// pass. Radial deviations refer to the least-squares centre of the pass and the nominal radius.
struct CircularPassResult {
  std::string label;
  int direction = +1;
  double centre_a_mm = 0, centre_b_mm = 0;  // centre of the least-squares circle
  double radius_mm = 0;
  double circular_deviation_um = 0;
  double max_circular_um = 0, min_circular_um = 0;
  double max_radial_um = 0, min_radial_um = 0;
  double max_deg = 0, min_deg = 0;  // angles of the largest and smallest deviation (equal for circular and
                                    // radial deviations)
  std::optional<double> feed_mm_min;
  std::vector<double> circular_um;  // circular deviation of each sample, in the order of the samples
};

/// Hysteresis: largest difference between the radii of the two directions at one angle, with the mean of both
/// centres as centre.
struct Hysteresis {
  double um = 0;
  double deg = 0;
};

/// Deviations of both directions from their mean centre and mean radius (ANSI/ASME B5.54), with the angles of
/// the extremes.
struct AboutMean {
  double max_um = 0, min_um = 0;
  double max_deg = 0, min_deg = 0;
};

struct CircularResult {
  double nominal_radius_mm = 0;
  std::vector<CircularPassResult> passes;
  /// The values below combine the first pass in the clockwise and the counter-clockwise direction. The values
  /// that combine both directions are missing if one direction is missing.
  std::optional<double> bidirectional_um;
  std::optional<double> mean_centre_a_mm, mean_centre_b_mm, mean_radius_mm;
  std::optional<AboutMean> about_mean;
  /// Mean of the radii of both directions minus the nominal radius (ISO 230-4:2005). For the mean
  /// bidirectional radial deviation, each radius is that of the least-squares circle with exact distances.
  /// All results except the mean bidirectional radial deviation use a linearised circle, which
  /// omits the term eccentricity squared over four radii.
  std::optional<double> mean_bidirectional_radial_um;
  std::optional<Hysteresis> hysteresis;  // compares sample i of one direction with sample i from the end of
                                         // the other direction
  std::optional<Hysteresis> hysteresis_by_angle;  // compares both directions at the same angle, with linear
                                                  // interpolation between samples
};

/// Analyses the passes of a circular test about one centre by ISO 230-4. `nominal_radius_mm`: radius of the
/// programmed circle. Each pass must have three samples at three different angles; otherwise analyse_circle
/// throws std::invalid_argument. The centre of a pass comes from the linearised least-squares fit deviation =
/// c + a cos + b sin, as in the software of the instruments. The definitions are those of ISO 230-4:1996, 3.4
/// to 3.6.
CircularResult analyse_circle(double nominal_radius_mm, const std::vector<CircularPass>& passes);

}  // namespace vernier::importer
