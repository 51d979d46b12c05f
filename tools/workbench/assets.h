// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string_view>

namespace vernier::workbench {

/// workbench_page: the page of the workbench. The functions after it: its script (tools/workbench/web, one
/// bundle) and its style sheet.
std::string_view workbench_page();
std::string_view workbench_script();
std::string_view workbench_style();

}  // namespace vernier::workbench
