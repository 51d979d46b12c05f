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

/// Compiles a machine (FORMATS section 1). Throws InputError in one line if the machine cannot be compiled.
/// Throws LimitNotMet, which names the dominant term, if the bound exceeds the budget. machine_text: the
/// bytes of the machine file, for its hash.
CompiledMachine compile_machine(const model::Machine& machine, const std::string& machine_text,
                                const CompileOptions& options);

/// A compiled directory (`vernier compile -o DIR`), ready to execute: DIR/machine.xml and
/// DIR/machine.vimg.
struct LoadedImage {
  model::Machine machine;
  std::vector<std::uint64_t> words;  // the image, aligned as ImageView requires
  ImageView view;
  ImageWorkspace workspace;
};
/// Throws InputError if a file is missing, if the correction image is refused (with the cause), or if the
/// image does not belong to the machine.xml of the directory.
std::unique_ptr<LoadedImage> load_image_dir(const std::string& directory);
/// Loads an image from bytes instead of a directory. Throws InputError with the cause.
std::unique_ptr<LoadedImage> load_image(const std::vector<std::uint8_t>& image,
                                        const model::Machine& machine);

/// FNV-1a of a text.
std::uint64_t hash_of(const std::string& text);

}  // namespace vernier::compile
