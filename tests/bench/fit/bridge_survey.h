// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <cstdint>

#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::bench {

using namespace vernier::model;

inline constexpr std::size_t kSetUps = 5;
inline constexpr double kUncertainty_mm = 0.002;  // of a laser tracer's position over this volume

/// Where the reflector sits against the tool's own point in each set-up, mm: known, and apart, so that the
/// angles of the last two axes have a lever. kOneTarget: everywhere the same.
inline constexpr double kOffset_mm[kSetUps][3] = {
    {0, 0, 0}, {150, 0, 40}, {0, 150, -40}, {-150, 0, -80}, {0, -150, 0}};
enum class Targets { kOneTarget, kFiveTargets };

/// A three-axis bridge seen by a tracker from five places.
struct Survey {
  Machine start;  // nominal: tables at zero, the tool at its drawing, set-ups as `Start` says
  Measurement readings;
  Targets targets;
};

/// Where the fit is told that the set-ups stand: to 0.1 mm and 0.01 deg, as a tracker aligned on a few
/// points, or at zero, 100 mm and 2 deg off.
enum class Start { kAligned, kFar };

/// Tables of `stations` stations on every axis with all six columns free, a BaseShift for each set-up, the
/// tool's three lengths: 18 * stations + 33 parameters. `points` random positions of the volume, x y z each,
/// of a machine with errors of 20 um and 20 urad.
Survey make_survey(std::size_t stations, std::size_t points, Targets targets, Start start,
                   std::uint64_t seed);

}  // namespace vernier::bench
