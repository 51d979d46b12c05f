// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <string>

#include "tools/compile/types.h"
#include "tools/model/machine.h"

namespace vernier::compile {

/// Returns the fixed-point program as readable C++ source: equation.h and equation.cpp. Equal fixed-point
/// programs give source files with equal bytes.
std::string print_header(const model::Machine& machine, const LoweredProgram& program,
                         std::uint64_t source_hash, std::uint64_t fingerprint);
std::string print_source(const model::Machine& machine, const LoweredProgram& program,
                         std::uint64_t source_hash);

}  // namespace vernier::compile
