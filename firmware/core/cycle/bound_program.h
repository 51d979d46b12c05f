// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>

#include "comp/compensator.h"
#include "firmware/core/cycle/wiring.h"
#include "hal/clock.h"
#include "tables/codes.h"
#include "tables/image_view.h"

namespace vernier {

/// Returns the wiring (list of axes and inputs) of a board that is made for this image. The order is that of
/// the correction image.
Wiring wiring_of(const ImageView& view);

/// Memory for the dense form of one program. The memory is allocated when the board is constructed.
class DenseStore {
 public:
  DenseStore() = default;
  /// `cells`: number of cells; 0: no memory. Not real-time safe.
  explicit DenseStore(std::uint32_t cells)
      : size_(cells),
        cells_(cells == 0 ? nullptr : new DenseCell[cells]),
        frame_(cells == 0 ? nullptr : new DenseFrame) {}
  DenseMemory memory() const noexcept { return {cells_.get(), size_, frame_.get()}; }

 private:
  std::uint32_t size_ = 0;
  std::unique_ptr<DenseCell[]> cells_;
  std::unique_ptr<DenseFrame> frame_;
};

/// A compiled correction program, the state of its execution, and the devices of the board that the program
/// uses. A BoundProgram is built outside the tick. Cycle::use() then starts it within one tick. A
/// BoundProgram contains pointers to the bytes of the image.
struct BoundProgram {
  /// Constructs the empty program, which computes no correction. The empty program is used if there is no
  /// image.
  BoundProgram() noexcept : compensator(Program{}) {}
  /// Binds axis i and input i of the correction image to axis i and input i of the board. `dense`: memory for
  /// the dense form of the program, which must exist longer than the BoundProgram. If the memory is too small
  /// or absent, the program is interpreted. Not real-time safe.
  explicit BoundProgram(const ImageView& view, const DenseMemory& dense = {}) noexcept;

  bool empty() const noexcept { return program.axis_count == 0; }

  Program program;
  Compensator compensator;
  ShareProgram shares;                   // program for the shares of the effects, for a live display
  View<ShareName> share_names;           // one name for each share
  std::uint32_t axis[kMaxAxes] = {};     // for each axis of the image: index of the board's axis
  std::uint32_t input[kMaxInputs] = {};  // for each input of the image: index of the board's input
  bool reads_input[kMaxInputs] = {};     // for each input of the image: true if the equation uses the input
  InputMicro reference[kMaxInputs];      // for each input of the image: value that is used before the first
                                         // reading
};

/// Finds the axes and inputs of the correction image among those of the board, by name. `bound`: a program
/// made from the same view of the image. `offender`: receives the name of an axis or input of the image that
/// the board does not have. Not real-time safe.
BindFault bind(const ImageView& view, const Wiring& wiring, TimeUs tick, BoundProgram& bound, Name& offender);

}  // namespace vernier
