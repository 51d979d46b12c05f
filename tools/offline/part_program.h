// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "tools/offline/corrector.h"

namespace vernier::offline {

/// Part of a cutting move in which no axis reverses; empty for a rapid move.
struct ProgramStretch {
  std::size_t line = 0;
  bool rapid = false;
  bool whole_circle = false;  // of the move that it belongs to
  model::States states;       // as if the machine were ideal, a millimetre or a tenth of a degree apart
};

struct PartProgramOptions {
  /// Largest allowed distance between the written path and the path that a correction at every moment would
  /// make, mm.
  double deviation_mm = 0.0005;
  /// Machine position of the program's zero, by axis: 0 if the program uses machine coordinates.
  std::vector<double> zero;
  int digits = 5;                                    // behind the point
  bool arcs = true;                                  // G2 and G3 are written; else chords alone
  std::function<void(const ProgramStretch&)> watch;  // called with every move in the order of the program
};

struct PartProgram {
  std::string text;
  std::size_t moves = 0, written = 0;  // blocks with a motion, before and after
  std::size_t arcs = 0;                // of those written
  /// Largest distance found between the written path and the path that is corrected at every moment, mm,
  /// before rounding to the digits of the program.
  double worst_mm = 0;
};

/// Reads a part program and writes it with the correction in its positions. Words: RS-274: G0 G1 G2 G3,
/// planes G17 to G19, G20/G21, G90/G91, G90.1/G91.1, G93/G94. A block is split if the correction along it is
/// not a straight line. An arc or helix is written as arcs in its plane, with I J K as steps, or as chords if
/// the chords reach as far; under G93 the parts share the block's time. The speed and direction of each axis
/// are those of the move and its F word. Words that cause no motion are not changed. `at`: positions of the
/// axes before the first block, and inputs. Throws InputError with file, line and word for words that would
/// be wrong in the output. Such words: cycles, cutter compensation, other zeros and rotations, parameters,
/// loops, an axis that was never commanded and that `at` does not name.
PartProgram corrected_program(const std::string& text, const std::string& file, const model::States& at,
                              const std::vector<char>& known, const PartProgramOptions& options,
                              Corrector& corrector);

}  // namespace vernier::offline
