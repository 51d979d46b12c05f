// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <nlohmann/json.hpp>

namespace vernier::report {

/// `detail` with at most about `most` observations: every n-th of them and those of the rows in `worst`, with
/// the rows that they refer to; `thinned` contains {kept, of, step}. Long circular runs are thinned likewise.
/// Throws std::invalid_argument if lengths or indices contradict one another. tool.
nlohmann::ordered_json thinned_detail(const nlohmann::ordered_json& detail, std::size_t most);

}  // namespace vernier::report
