// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "tools/offline/corrector.h"

namespace vernier::offline {

/// Part of a cutting move in which no axis turns round; of a rapid move nothing.
struct ProgramStretch {
  std::size_t line = 0;
  bool rapid = false;
  bool whole_circle = false;  // of the move that it belongs to
  model::States states;       // as if the machine were ideal, a millimetre or a tenth of a degree apart
};

struct PartProgramOptions {
  /// How far the written path may leave the one that a correction at every moment would make, mm.
  double deviation_mm = 0.0005;
  /// Machine position of the program's zero, by axis: 0 where the program's coordinates are the machine's.
  std::vector<double> zero;
  int digits = 5;                                    // behind the point
  bool arcs = true;                                  // G2 and G3 are written; else chords alone
  std::function<void(const ProgramStretch&)> watch;  // is told every move in the order of the program
};

struct PartProgram {
  std::string text;
  std::size_t moves = 0, written = 0;  // blocks with a motion, before and after
  std::size_t arcs = 0;                // of those written
  /// Largest distance found between the written path and the one that is corrected at every moment, mm,
  /// before the digits of the program: between every two places that the blocks were laid through.
  double worst_mm = 0;
};

/// A part program (RS-274: G0 G1 G2 G3, planes G17 to G19, G20/G21, G90/G91, G90.1/G91.1, G93/G94) with the
/// correction in its positions. A block is split where the correction along it is no straight line; an arc or
/// helix is written as arcs in its plane, with I J K as steps, and as chords where these reach as far; under
/// G93 the parts share the block's time. Speeds and senses of a move are those of its direction and F word.
/// What is no motion stays as it stands. `at`: where the axes stand before
/// the first block, and inputs. Throws InputError with file, line and word for what would be wrong if it were
/// passed on: cycles, compensation of the cutter, other zeros and rotations, parameters, loops, an axis that
/// was never commanded and that `at` does not name. tool.
PartProgram corrected_program(const std::string& text, const std::string& file, const model::States& at,
                              const std::vector<char>& known, const PartProgramOptions& options,
                              Corrector& corrector);

}  // namespace vernier::offline
