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
  kCylinder,  // hole or boss; without length a circle
  kPath,      // cut of a program between two rapid moves
};
const char* kind_name(PartFeatureKind kind);

/// Property of a feature that may be out of tolerance.
enum class PartCharacteristic : std::uint8_t {
  kPosition,  // width or diameter of the zone about its true place that it takes up, ISO 1101
  kSize,      // actual - nominal diameter
  kForm,      // width of the zone about its least-squares plane or cylinder
};
const char* characteristic_name(PartCharacteristic characteristic);

/// A feature of a part with its tolerances. Workpiece coordinates, mm.
struct PartFeature {
  std::string name;
  PartFeatureKind kind = PartFeatureKind::kPoint;
  Eigen::Vector3d at = Eigen::Vector3d::Zero();  // the point; the middle of the others
  /// Unit normal of a point or plane, axis of a cylinder; 0: a point that is judged in every direction.
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
  std::optional<Eigen::Vector3d> tool;  // direction of the tool there; nullopt: the rotary axes do not move
  double diameter_mm = 0, length_mm = 0, width_mm = 0;
  std::optional<double> position_mm, form_mm;    // zones
  std::optional<std::array<double, 2>> size_mm;  // limits of actual - nominal diameter
  bool datum = false;                            // reference of the other features
  std::size_t line = 0;
};

/// A part with its features, as on its drawing.
struct PartDrawing {
  std::string file;
  std::vector<PartFeature> features;
};

/// Reads a part from CSV. Columns: feature, kind (point plane cylinder), x y z, and if needed nx ny nz, i j k
/// (direction of the tool), diameter, length, width, position, size (plus and minus) or size_low and
/// size_high, form, datum (yes). The header gives the unit of a column; without a unit it is mm. Throws
/// InputError with file, line and word.
PartDrawing parse_part(const std::string& text, const std::string& file);

/// Returns the part after a rigid motion, mm.
PartDrawing placed_at(const PartDrawing& part, const Eigen::Isometry3d& place);

}  // namespace vernier::tolerance
