// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <set>
#include <string>

namespace vernier::house {

/// Tests that a page names in backquotes (`Subject.Behaviour`).
std::set<std::string> named_tests(const std::string& page);
/// Those of them that no source of tests/ has. Requires a checkout.
std::set<std::string> tests_that_are_missing(const std::set<std::string>& named);

}  // namespace vernier::house
