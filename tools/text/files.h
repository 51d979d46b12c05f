// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

namespace vernier::text {

/// Writes `text` to `path` as write_output (hal/support/output_file.h) does: an ordinary file as a whole or
/// not at all, a device or pipe by writing to it, links followed. Throws InputError with the path where it
/// cannot. tool.
void write_file(const std::string& path, const std::string& text);

/// Makes the folder `path` for outputs, with those above it; one that is there is good. Throws InputError
/// with the path where it cannot. tool.
void make_folder(const std::string& path);

/// Would write_file(path) find a place? Asked before a long job, so that nothing is half written at its end.
/// Throws InputError as write_file would. tool.
void require_place(const std::string& path);

/// The whole of a file. Throws InputError where it cannot be read. tool.
std::string read_file(const std::string& path);

}  // namespace vernier::text
