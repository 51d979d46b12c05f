// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <vector>

#include "tools/compile/types.h"
#include "tools/model/machine.h"

namespace vernier::compile {

/// Returns the bytes of a correction image (format: tables/image_format.h).
std::vector<std::uint8_t> write_image(const model::Machine& machine, const LoweredProgram& program,
                                      const LoweredShares& shares, std::uint32_t tick_us,
                                      std::uint64_t source_hash, std::uint32_t accepted_rules,
                                      std::uint64_t& fingerprint);

}  // namespace vernier::compile
