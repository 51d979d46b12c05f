// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

namespace vernier::text {

/// Writes `text` to `path` like write_output (hal/support/output_file.h): an ordinary file as a whole or not
/// at all; a device or pipe by writing to it; links are followed. Throws InputError with the path if that
/// fails.
void write_file(const std::string& path, const std::string& text);

/// Makes the folder `path` for outputs and the folders above it; an existing folder is accepted. Throws
/// InputError with the path if that fails.
void make_folder(const std::string& path);

/// Tests before a long job whether write_file(path) can write. A job then does not fail at its end because
/// its output cannot be written. Throws InputError as write_file does.
void require_place(const std::string& path);

/// The whole of a file. Throws InputError if the file cannot be read.
std::string read_file(const std::string& path);

}  // namespace vernier::text
