// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "tables/image_view.h"
#include "tools/compile/types.h"
#include "tools/model/machine.h"

namespace vernier::compile {

/// Compiles a machine to a correction image (FORMATS section 1). If the machine cannot be compiled, throws
/// InputError with a message of one line. If the error bound exceeds the budget, throws LimitNotMet. The
/// message of LimitNotMet names the term with the largest error. `machine_text`: the bytes of the machine
/// file, from which its hash is computed.
CompiledMachine compile_machine(const model::Machine& machine, const std::string& machine_text,
                                const CompileOptions& options);

/// A compiled machine from a directory (`vernier compile -o DIR`), ready to execute. The files of a compiled
/// machine are DIR/machine.xml and DIR/machine.vimg.
struct LoadedImage {
  model::Machine machine;
  std::vector<std::uint64_t> words;  // the image, with the alignment that ImageView requires
  ImageView view;
  ImageWorkspace workspace;
};
/// Throws InputError if a file is missing, if the correction image is not valid (with the cause), or if the
/// image does not belong to the machine.xml of the directory.
std::unique_ptr<LoadedImage> load_image_dir(const std::string& directory);
/// Loads an image from bytes instead of a directory. Throws InputError with the cause if the image is not
/// valid.
std::unique_ptr<LoadedImage> load_image(const std::vector<std::uint8_t>& image,
                                        const model::Machine& machine);

/// Returns the FNV-1a hash of a text.
std::uint64_t hash_of(const std::string& text);

}  // namespace vernier::compile
