// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "tools/offline/corrector.h"

namespace vernier::offline {

/// A part of a cutting move in which no axis reverses. The part of a move is empty for a rapid move.
struct ProgramStretch {
  std::size_t line = 0;
  bool rapid = false;
  bool whole_circle = false;  // true: the move to which this part belongs is a whole circle
  model::States states;       // states of an ideal machine, at distances of a millimetre or a tenth of a
                              // degree
};

struct PartProgramOptions {
  /// Largest permitted distance between the written path and the path with a continuous correction, mm.
  double deviation_mm = 0.0005;
  /// Machine position of the program's zero point for each axis; 0 if the program uses machine coordinates.
  std::vector<double> zero;
  int digits = 5;                                    // number of digits after the decimal point
  bool arcs = true;                                  // true: arcs are written as G2 and G3; false: arcs are
                                                     // written as chords
  std::function<void(const ProgramStretch&)> watch;  // function that is called for every move in the order of
                                                     // the program
};

struct PartProgram {
  std::string text;
  std::size_t moves = 0, written = 0;  // number of blocks with a motion, before and after the correction
  std::size_t arcs = 0;                // number of written arcs
  /// Largest distance between the written path and the path with a continuous correction, mm, before rounding
  /// to the digits of the program.
  double worst_mm = 0;
};

/// Reads a part program and returns it with corrected positions. The permitted words are those of RS-274: G0
/// G1 G2 G3, planes G17 to G19, G20/G21, G90/G91, G90.1/G91.1, G93/G94. A block is split if the correction
/// along the block is not linear. An arc or helix is written as arcs in its plane, with relative I J K, or as
/// chords if the chords are long enough. Under G93, the parts of a block share the time of the block. The
/// speed and the direction of each axis are those of the move and of its F word. Words of the part program
/// that cause no motion are written without change. `at`: positions of the axes before the first block, and
/// values of the inputs. Throws InputError with file, line and word for words that would be wrong in the
/// output. Examples of forbidden words are cycles, cutter compensation, other zero points and rotations,
/// parameters, loops, and an axis whose position is unknown because it was never commanded and `at` does not
/// contain it.
PartProgram corrected_program(const std::string& text, const std::string& file, const model::States& at,
                              const std::vector<char>& known, const PartProgramOptions& options,
                              Corrector& corrector);

}  // namespace vernier::offline
