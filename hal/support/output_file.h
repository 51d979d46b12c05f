// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include <system_error>

namespace vernier {

/// Writes what a program was asked to leave at `path`; every output of the tools and of the daemon goes
/// through here. An ordinary file, there or not yet, is replaced as a whole by way of a temporary file beside
/// it, on the medium before its name changes: a reader, and a power cut, find the old one or the new one; its
/// permissions stay, and its owner where the system lets them. Links are followed and stay: what the last one
/// leads to is replaced, or made. A device, pipe or terminal is written to and never replaced, and so is an
/// open file of this process (/dev/stdout, /dev/fd/N). Waits for the reader of a named pipe, as a shell's >
/// does. Returns why not (a folder, a socket, no right, a full medium); an ordinary file is then as it was.
/// setup, tool.
std::error_code write_output(const std::string& path, std::string_view text);

/// Makes the folder that outputs go to, with those above it; a link that leads nowhere yet is followed, and
/// stays. One that is there is good. Returns why not. setup, tool.
std::error_code make_output_folder(const std::string& path);

}  // namespace vernier
