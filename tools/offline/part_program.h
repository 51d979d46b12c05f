// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/offline/corrector.h"

namespace vernier::offline {

struct PartProgramOptions {
  /// How far the written path may leave the one that a correction at every moment would make, mm.
  double deviation_mm = 0.0005;
  /// Machine position of the program's zero, by axis: 0 where the program's coordinates are the machine's.
  std::vector<double> zero;
  int digits = 5;  // behind the point
};

struct PartProgram {
  std::string text;
  std::size_t moves = 0, written = 0;  // blocks with a motion, before and after
};

/// A part program (RS-274: G0 G1 G2 G3, planes G17 to G19, G20/G21, G90/G91, G93/G94) with the correction in
/// its positions. A block is split where the correction is no straight line along it; arcs become chords, in
/// every plane, helices included; under G93 the parts share the block's time. Speeds and senses of a move are
/// those of its direction and F word. What is no motion stays as it stands. `at`: where the axes stand before
/// the first block, and inputs. Throws InputError with file, line and word for what would be wrong if it were
/// passed on: cycles, compensation of the cutter, other zeros and rotations, parameters, loops, an axis that
/// was never commanded and that `at` does not name. tool.
PartProgram corrected_program(const std::string& text, const std::string& file, const model::States& at,
                              const std::vector<char>& known, const PartProgramOptions& options,
                              Corrector& corrector);

}  // namespace vernier::offline
