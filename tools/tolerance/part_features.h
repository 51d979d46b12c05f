// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace vernier::tolerance {

enum class PartFeatureKind : std::uint8_t {
  kPoint,
  kPlane,
  kCylinder,  // hole or boss; if its length is not given, a circle
  kPath,      // path that a program cuts between two rapid moves
};
const char* kind_name(PartFeatureKind kind);

/// Characteristic of a feature for which a tolerance can be given.
enum class PartCharacteristic : std::uint8_t {
  kPosition,  // width or diameter of the zone about the nominal location that the feature needs, ISO 1101
  kSize,      // actual diameter minus nominal diameter
  kForm,      // width of the zone about the least-squares plane or cylinder that the feature needs
};
const char* characteristic_name(PartCharacteristic characteristic);

/// A feature of a part with its tolerances, in workpiece coordinates, mm.
struct PartFeature {
  std::string name;
  PartFeatureKind kind = PartFeatureKind::kPoint;
  Eigen::Vector3d at = Eigen::Vector3d::Zero();  // location of a point; for all other features the centre
  /// Unit normal of a point or plane, or axis of a cylinder. For a zero vector, the deviation of a point is
  /// evaluated in every direction.
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
  std::optional<Eigen::Vector3d> tool;  // direction of the tool at the feature; nullopt: the rotary axes do
                                        // not move
  double diameter_mm = 0, length_mm = 0, width_mm = 0;
  std::optional<double> position_mm, form_mm;    // widths of the tolerance zones
  std::optional<std::array<double, 2>> size_mm;  // limits of (actual diameter - nominal diameter)
  bool datum = false;                            // true: the feature is a datum of the part
  std::size_t line = 0;
};

/// Features and tolerances of a part, as on its drawing.
struct PartDrawing {
  std::string file;
  std::vector<PartFeature> features;
};

/// Reads the features of a part from CSV. Columns: feature, kind (point plane cylinder), x y z, and if needed
/// nx ny nz, i j k (direction of the tool), diameter, length, width, position, size (plus and minus) or
/// size_low and size_high, form, datum (yes). The header gives the unit of each column; a column without a
/// unit is in mm. Throws InputError with file, line and word of the error.
PartDrawing parse_part(const std::string& text, const std::string& file);

/// Returns the part after the rigid motion `place`, mm.
PartDrawing placed_at(const PartDrawing& part, const Eigen::Isometry3d& place);

}  // namespace vernier::tolerance
