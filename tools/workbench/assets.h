// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string_view>

namespace vernier::workbench {

/// Returns the HTML page of the workbench. workbench_script() returns the script of the page
/// (tools/workbench/web, one bundle), and workbench_style() returns its style sheet.
std::string_view workbench_page();
std::string_view workbench_script();
std::string_view workbench_style();

}  // namespace vernier::workbench
