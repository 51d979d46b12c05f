// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace vernier::house {

/// The `#include`s of `text` that the file at `path` (from the repository root) may not have, each as
/// `path:line: "word": why`. Empty when all is well. The rules are the table "who may include whom" of the
/// architecture: comp and tables stand alone, hal ports know only quantities, nobody but tools and tests
/// includes tools or tests.
std::vector<std::string> wrong_includes(const std::string& path, std::string_view text);

/// Rooms of the table of tools that use one which stands on a floor above them; empty when all is well.
std::vector<std::string> rooms_that_run_up();

/// Names of the types that a header defines outside of functions and other types.
std::vector<std::string> declared_types(std::string_view text);

}  // namespace vernier::house
