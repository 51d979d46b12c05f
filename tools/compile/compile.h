// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tables/image_view.h"
#include "tools/compile/bound.h"
#include "tools/model/states.h"

namespace vernier::compile {

struct CompileOptions {
  std::uint32_t tick_us = 1000;      // cycle time that lags and slew limits are computed for
  std::optional<double> budget_um;   // largest error bound allowed on any axis
  std::uint32_t accepted_rules = 0;  // of the safety sheet, recorded in the image
  /// A correction whose one step leaves more than this is evaluated again at the corrected position.
  double most_second_order_um = 0.1;
  double most_second_order_deg = 2e-4;  // the same of the tool's direction: a tenth of what is asked for
};

struct CompiledMachine {
  std::vector<std::uint8_t> image;
  LoweredProgram program;
  LoweredShares shares;
  std::vector<OutputBound> bounds;
  std::optional<LeastSquares> least_squares;  // where turning axes are corrected too
  std::optional<Orientation> orientation;     // where the direction of the tool is corrected
  std::optional<TiltBound> tilt;
  int evaluations = 1;                 // of the deviation: more where one step is not enough
  std::size_t operations_of_one = 0;   // a tick, with one evaluation
  std::vector<std::string> switching;  // comparisons and the like: the bound holds away from their steps
  std::vector<std::string> notes;      // what the user should know of the correction, a sentence each
  std::string header, source;          // equation.h, equation.cpp
  std::uint64_t fingerprint = 0;
};

/// Compiles a machine (FORMATS section 1). Throws InputError in one line where it cannot, LimitNotMet where
/// the bound exceeds the budget, naming the term to blame. machine_text: the file's bytes, for its hash.
/// tool.
CompiledMachine compile_machine(const model::Machine& machine, const std::string& machine_text,
                                const CompileOptions& options);

/// Of each state: does it stand where two axes tilt the tool nearly the same way, so that the correction of
/// its direction is damped? All false where no direction is corrected. tool.
std::vector<bool> damped_poses(const model::Machine& machine, const model::States& states);

/// A compiled directory (`vernier compile -o DIR`) ready to run: DIR/machine.xml and DIR/machine.vimg.
struct LoadedImage {
  model::Machine machine;
  std::vector<std::uint64_t> words;  // the image, aligned as ImageView wants it
  ImageView view;
  ImageWorkspace workspace;
};
/// Throws InputError where a file is missing, the image is refused (with the cause) or is not of that
/// machine.xml. tool.
std::unique_ptr<LoadedImage> load_image_dir(const std::string& directory);
/// The same from bytes. Throws InputError with the cause.
std::unique_ptr<LoadedImage> load_image(const std::vector<std::uint8_t>& image,
                                        const model::Machine& machine);

/// FNV-1a of a text.
std::uint64_t hash_of(const std::string& text);

}  // namespace vernier::compile
