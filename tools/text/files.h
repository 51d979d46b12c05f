// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

namespace vernier::text {

/// Writes `text` to `path` as write_output (hal/support/output_file.h) does. An ordinary file is
/// written completely or not at all. A device or pipe is written directly. Links are followed.
/// Throws InputError with the path if it cannot. tool.
void write_file(const std::string& path, const std::string& text);

/// Creates the folder `path` for outputs, and its parents. An existing folder is accepted. Throws
/// InputError with the path if it cannot. tool.
void make_folder(const std::string& path);

/// Tests whether write_file(path) can write. Called before a long job, so that the job does not
/// fail at its end. Throws InputError as write_file would. tool.
void require_place(const std::string& path);

/// Returns the whole of a file. Throws InputError if it cannot be read. tool.
std::string read_file(const std::string& path);

}  // namespace vernier::text
