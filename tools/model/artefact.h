// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace vernier::model {

/// Type of an object that the tool point can touch.
enum class ArtefactType : std::uint8_t { kPoint, kLine, kPlane, kSphere, kCylinder };
/// Words of the attribute `type` in the machine file, in the order of ArtefactType.
inline constexpr std::array<const char*, 5> kArtefactTypes = {"point", "line", "plane", "sphere", "cylinder"};
/// Returns the artefact type with the name `word`; nullopt if no type has this name.
std::optional<ArtefactType> artefact_type_named(std::string_view word);

/// An artefact: an object that the tool point touches (`<artefact>` of the machine file). A value that the
/// machine file states is known, with its standard uncertainty. A value that the machine file does not state
/// is unknown, and a fit eliminates this value. A stated position of an artefact is in the measuring frame of
/// the set-up. An artefact without a stated position is in workpiece coordinates.
struct Artefact {
  std::string name;
  ArtefactType type = ArtefactType::kPoint;
  std::optional<double> radius;                    // radius of a sphere or a cylinder, mm
  double u_radius = 0;                             // standard uncertainty of the radius, mm; 0: exact
  std::optional<std::array<double, 3>> place;      // position: the point, the centre, or a point of the line
                                                   // or plane, mm
  double u_place = 0;                              // standard uncertainty of each coordinate of the position,
                                                   // mm; 0: exact
  std::optional<std::array<double, 3>> direction;  // direction of a line, an axis or a normal: a unit vector
  std::optional<std::string> setup;                // set-up that contains the artefact; no value: every
                                                   // set-up
  std::string tip;      // name of the static with the radius of the probe tip, mm; empty: the tip has no
                        // radius
  bool inside = false;  // true: the tip touches from inside (a bore, a ring)
  std::size_t line = 0;

  bool has_radius() const { return type == ArtefactType::kSphere || type == ArtefactType::kCylinder; }
  bool has_direction() const { return type != ArtefactType::kPoint && type != ArtefactType::kSphere; }
  /// Returns the number of readings of one touch: 3 for a point, 2 for a line, 1 for a surface.
  std::size_t dimension() const;
};

/// Parses a length with or without a unit: "12.5mm", "0.5um", "12.5" (mm). Returns the length in mm; nullopt
/// if the text is not a length.
std::optional<double> length_in_mm(std::string_view text);

}  // namespace vernier::model
