// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/part/measured_part.h"

#include <fmt/format.h>

#include <cmath>

#include "tools/format/csv_file.h"
#include "tools/part/part_column.h"
#include "tools/part/surface/s_part.h"
#include "tools/text/numbers.h"

namespace vernier::part {
namespace {

/// Largest distance of a nominal point from a flank; a point beyond it belongs to no flank (the flanks are
/// known to rounding; files have three or four decimals).
constexpr double kOnSurfaceMm = 0.05;

std::string point_text(const Eigen::Vector3d& p) {
  return fmt::format("({:g}, {:g}, {:g})", p.x(), p.y(), p.z());
}

/// `nullopt` if the point is so far from the surface that the search for its foot point does not converge.
std::optional<SurfaceFoot> foot_near(const RuledSurface& surface, const Eigen::Vector3d& position) {
  try {
    return nearest(surface, position);
  } catch (const std::runtime_error&) {
    return std::nullopt;
  }
}

PartPoint place_on_part(const Eigen::Vector3d& position, const text::Place& place) {
  PartPoint best;
  double best_mm = -1;
  for (std::size_t flank = 0; flank < s_part().size(); ++flank) {
    const std::optional<SurfaceFoot> foot = foot_near(s_part()[flank], position);
    if (!foot) continue;
    const double apart_mm = std::hypot(foot->distance_mm, foot->across_mm);
    if (best_mm >= 0 && apart_mm >= best_mm) continue;
    best_mm = apart_mm;
    best = {flank, foot->u, foot->v};
  }
  // Of the part's height that a point may lie beyond its edges.
  constexpr double kEdge = kOnSurfaceMm / kPartHeightMm;
  if (best_mm < 0)
    throw text::InputError(place, point_text(position),
                           "this point is not on the part: the distance to both flanks is too large");
  if (best_mm > kOnSurfaceMm || best.v < -kEdge || best.v > 1 + kEdge)
    throw text::InputError(
        place, point_text(position),
        fmt::format(
            "this point is not on the part: {:.3g} mm from the nearest flank, at {:.3g} of its height",
            best_mm, best.v));
  return best;
}

}  // namespace

MeasuredPart read_measured_part(const std::string& text, const std::string& file) {
  const format::CsvFile csv = format::parse_csv(text, file);
  const auto length = [&](const char* name, bool required) {
    return PartColumn(csv, name, format::Dimension::kLength, required);
  };
  const PartColumn x = length("sx", true), y = length("sy", true), z = length("sz", true),
                   defect = length("defect", true), u = length("u", false);
  MeasuredPart part{file, {}};
  for (std::size_t row = 0; row < csv.rows.size(); ++row) {
    const text::Place place{file, csv.line[row]};
    MeasuredPoint point;
    point.line = csv.line[row];
    const Eigen::Vector3d position(x.at(row), y.at(row), z.at(row));
    point.defect_mm = defect.at(row);
    if (u.present()) point.uncertainty_mm = u.at(row);
    if (u.present() && !(point.uncertainty_mm > 0))
      throw text::InputError(place, text::number_text(point.uncertainty_mm),
                             "u must be a standard uncertainty above 0");
    point.at = place_on_part(position, place);
    part.points.push_back(point);
  }
  return part;
}

}  // namespace vernier::part
