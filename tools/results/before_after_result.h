// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/residual/before_after.h"

namespace vernier::results {

/// Returns the result of `compare --before --after` as JSON (FORMATS section 6): before_um, after_um (rms),
/// reduction, interval, verdict, sentence, paired, samples, excluded rows and rows with a correction, and the
/// numbers for all readings and for each group.
nlohmann::ordered_json before_after_json(const residual::BeforeAfter& result);

/// Prints the result of `compare --before --after` for people: first the verdict, then the table.
void print_before_after(std::FILE* out, const residual::BeforeAfter& result);

/// Returns the data of `compare --before --after` for the HTML report (improvement_report_html).
nlohmann::ordered_json before_after_page(const residual::BeforeAfter& result, const std::string& machine,
                                         const std::vector<std::string>& files);

}  // namespace vernier::results
