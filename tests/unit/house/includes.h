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

}  // namespace vernier::house
