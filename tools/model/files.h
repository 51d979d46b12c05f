#pragma once
#include <string>

namespace vernier {

/// Writes `text` to `path` by way of a temporary file beside it, so that a reader sees the old file or the
/// whole new one. Throws InputError with the path where it cannot. tool.
void write_file(const std::string& path, const std::string& text);

/// The whole of a file. Throws InputError where it cannot be read. tool.
std::string read_file(const std::string& path);

}  // namespace vernier
