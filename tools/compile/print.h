// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <string>

#include "tools/compile/types.h"
#include "tools/model/machine.h"

namespace vernier::compile {

/// Returns the program as readable C++: equation.h and equation.cpp. Equal programs give equal bytes.
std::string print_header(const model::Machine& machine, const LoweredProgram& program,
                         std::uint64_t source_hash, std::uint64_t fingerprint);
std::string print_source(const model::Machine& machine, const LoweredProgram& program,
                         std::uint64_t source_hash);

}  // namespace vernier::compile
