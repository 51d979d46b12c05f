// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "tools/model/measurement.h"

namespace vernier::diagnose {

/// The rows without copies, and the sentence that states their number.
struct WithoutCopies {
  std::vector<std::size_t> kept;
  std::string sentence;
};

/// Excludes rows that repeat the readings of the row before at the same position, digit for digit, if the
/// file repeats nearly all readings of its stays like that. Such rows are copies, and not independent
/// readings. Returns nullopt for other files: readings of a coarse resolution agree now and then.
std::optional<WithoutCopies> without_copies(const model::Measurement& rows);

}  // namespace vernier::diagnose
