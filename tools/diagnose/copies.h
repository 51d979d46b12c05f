// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "tools/model/measurement.h"

namespace vernier::diagnose {

/// The rows of a measurement without copied readings, and the sentence that states the number of copies.
struct WithoutCopies {
  std::vector<std::size_t> kept;
  std::string sentence;
};

/// Excludes rows that repeat the readings of the previous row at the same position in every digit. Repeated
/// readings are excluded only if the file repeats nearly all readings of its dwells in this way. Rows with
/// digit-for-digit equal readings are copies, not independent readings. Returns nullopt for a file with only
/// a few repeated readings: with a coarse resolution, some readings are equal by chance.
std::optional<WithoutCopies> without_copies(const model::Measurement& rows);

}  // namespace vernier::diagnose
