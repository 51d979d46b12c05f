// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <nlohmann/json.hpp>

namespace vernier::report {

/// Returns `detail` with about `most` observations: every n-th observation, and the observations of the rows
/// in `worst`, with the rows to which they refer. The added key `thinned` contains {kept, of, step}. Long
/// circular runs are also thinned to every n-th sample. Throws std::invalid_argument if lengths or indices in
/// `detail` are inconsistent.
nlohmann::ordered_json thinned_detail(const nlohmann::ordered_json& detail, std::size_t most);

}  // namespace vernier::report
