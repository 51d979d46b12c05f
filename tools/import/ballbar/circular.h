// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <optional>
#include <string>
#include <vector>

namespace vernier::importer {

/// One pass over a circle in one direction, in time order.
struct CircularPass {
  std::string label;
  int direction = +1;                // +1 from +A towards +B, -1 the other way round
  std::vector<double> angle_deg;     // of the programmed position about the programmed centre, 0..360
  std::vector<double> deviation_mm;  // measured radius - nominal radius
  std::optional<double> feed_mm_min;
};

/// Results of ISO 230-4 for one pass. Circular deviations refer to the least-squares centre and radius of the
/// pass; radial deviations refer to its centre and the nominal radius.
struct CircularPassResult {
  std::string label;
  int direction = +1;
  double centre_a_mm = 0, centre_b_mm = 0;  // of the least-squares circle
  double radius_mm = 0;
  double circular_deviation_um = 0;
  double max_circular_um = 0, min_circular_um = 0;
  double max_radial_um = 0, min_radial_um = 0;
  double max_deg = 0, min_deg = 0;  // where (the same for circular and radial)
  std::optional<double> feed_mm_min;
  std::vector<double> circular_um;  // of each sample, in the order given
};

/// Largest difference between the radii of the two directions at one angle, about the mean of both centres.
struct Hysteresis {
  double um = 0;
  double deg = 0;
};

/// Results of both directions about their mean centre and mean radius (ANSI/ASME B5.54), and the locations of
/// the extremes.
struct AboutMean {
  double max_um = 0, min_um = 0;
  double max_deg = 0, min_deg = 0;
};

struct CircularResult {
  double nominal_radius_mm = 0;
  std::vector<CircularPassResult> passes;
  /// This value and the following values are of the first pass in each direction; absent if one direction is
  /// missing.
  std::optional<double> bidirectional_um;
  std::optional<double> mean_centre_a_mm, mean_centre_b_mm, mean_radius_mm;
  std::optional<AboutMean> about_mean;
  /// Mean of the radii of both directions minus the nominal radius (ISO 230-4:2005). Each radius is that of
  /// the least-squares circle in true distances. The linearised circle of the other values lacks the term
  /// eccentricity squared over four radii.
  std::optional<double> mean_bidirectional_radial_um;
  std::optional<Hysteresis> hysteresis;  // sample i of one direction with sample i from the end of the other
  std::optional<Hysteresis> hysteresis_by_angle;  // at the same angle, linear between samples
};

/// Analyses passes about one centre by ISO 230-4. nominal_radius: mm. Each pass needs three samples at three
/// different angles; throws std::invalid_argument otherwise. The centre comes from the linearised least
/// squares deviation = c + a cos + b sin, as in the software of the instruments. Source: ISO
/// 230-4:1996, 3.4 to 3.6.
CircularResult analyse_circle(double nominal_radius_mm, const std::vector<CircularPass>& passes);

}  // namespace vernier::importer
