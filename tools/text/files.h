// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

namespace vernier::text {

/// Writes `text` to `path` in the same way as write_output (hal/support/output_file.h). An ordinary file is
/// replaced completely or not at all; a device or pipe is written directly; links are followed. Throws
/// InputError with the path if the write fails.
void write_file(const std::string& path, const std::string& text);

/// Creates the output folder `path` and the folders above it. An existing folder is no error. Throws
/// InputError with the path if the folder cannot be created.
void make_folder(const std::string& path);

/// Tests before a long computation whether write_file(path) can write the file. With this test, a computation
/// does not fail at its end because its output cannot be written. Throws InputError under the same conditions
/// as write_file.
void require_place(const std::string& path);

/// Returns the complete content of a file. Throws InputError if the file cannot be read.
std::string read_file(const std::string& path);

}  // namespace vernier::text
