// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "comp/compensator.h"
#include "firmware/core/cycle/wiring.h"
#include "hal/clock.h"
#include "tables/codes.h"
#include "tables/image_view.h"

namespace vernier {

/// Returns the axes and inputs of a correction image, in the order of the image: the wiring of a board made
/// for this image.
Wiring wiring_of(const ImageView& view);

/// A program, the state of its execution, and the devices of the board that the program uses. A BoundProgram
/// is built outside the tick; Cycle::use() starts to use the BoundProgram within one tick. Refers to the
/// image's bytes.
struct BoundProgram {
  /// The empty program, which is used if there is no image: it computes no correction.
  BoundProgram() noexcept : compensator(Program{}) {}
  /// Binds axis i and input i of the correction image to axis i and input i of the board. Not real-time safe.
  explicit BoundProgram(const ImageView& view) noexcept;

  bool empty() const noexcept { return program.axis_count == 0; }

  Program program;
  Compensator compensator;
  ShareProgram shares;                   // of the effects, for a live display
  View<ShareName> share_names;           // one per share
  std::uint32_t axis[kMaxAxes] = {};     // board's axis for each of the image
  std::uint32_t input[kMaxInputs] = {};  // board's input for each of the image
  bool reads_input[kMaxInputs] = {};     // per input of the image: whether its equation reads it
  InputMicro reference[kMaxInputs];      // per input of the image: its value before the first reading
};

/// Finds the axes and inputs of the correction image among those of the board, by name. bound: program made
/// from the same view. offender: receives the name that does not fit. Not real-time safe.
BindFault bind(const ImageView& view, const Wiring& wiring, TimeUs tick, BoundProgram& bound, Name& offender);

}  // namespace vernier
