// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace vernier::model {

/// What a tool point touches.
enum class ArtefactType : std::uint8_t { kPoint, kLine, kPlane, kSphere, kCylinder };
/// Words of the attribute `type`, in the order of ArtefactType.
inline constexpr std::array<const char*, 5> kArtefactTypes = {"point", "line", "plane", "sphere", "cylinder"};
/// Returns the type of this word; nullopt: no type has the word.
std::optional<ArtefactType> artefact_type_named(std::string_view word);

/// An artefact that the tool point touches (`<artefact>` of the machine file). A stated value is known, with
/// its standard uncertainty. A value that is not stated is unknown, and a fit eliminates this value. The
/// position of an artefact is in the measuring frame of the set-up. An artefact without a stated position is
/// in workpiece coordinates.
struct Artefact {
  std::string name;
  ArtefactType type = ArtefactType::kPoint;
  std::optional<double> radius;                    // of a sphere or a cylinder, mm
  double u_radius = 0;                             // mm; 0: exact
  std::optional<std::array<double, 3>> place;      // a point, a centre, or a point of the line or plane, mm
  double u_place = 0;                              // of each coordinate, mm; 0: exact
  std::optional<std::array<double, 3>> direction;  // of a line, an axis, a normal: a unit vector
  std::optional<std::string> setup;                // set-up in which it stands; no value: every set-up
  std::string tip;      // static that is the radius of the tip, mm; empty: the tool point touches
  bool inside = false;  // touched from inside: a bore, a ring
  std::size_t line = 0;

  bool has_radius() const { return type == ArtefactType::kSphere || type == ArtefactType::kCylinder; }
  bool has_direction() const { return type != ArtefactType::kPoint && type != ArtefactType::kSphere; }
  /// Number of readings of one touch: 3 of a point, 2 of a line, 1 of a surface.
  std::size_t dimension() const;
};

/// Parses a length with or without a unit: "12.5mm", "0.5um", "12.5" (mm). Returns mm; nullopt: no length.
std::optional<double> length_in_mm(std::string_view text);

}  // namespace vernier::model
