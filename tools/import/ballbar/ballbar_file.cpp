// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/ballbar/ballbar_file.h"

namespace vernier::importer {

std::optional<double> printed_result(const BallbarFile& file, const std::string& analysis,
                                     const std::string& version, const std::string& feature) {
  for (const auto& candidate : file.analyses) {
    if (candidate.name != analysis || candidate.version != version) continue;
    for (const auto& printed : candidate.features) {
      if (printed.name == feature) return printed.value;
    }
  }
  return std::nullopt;
}

}  // namespace vernier::importer
