// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string_view>

namespace vernier::report {

/// report_script() returns the script that draws the plots (tools/report/web, one script). report_style()
/// returns the style sheet of the reports. report_german() returns the German translation
/// tools/report/languages/de.json.
std::string_view report_script();
std::string_view report_german();
std::string_view report_style();

}  // namespace vernier::report
