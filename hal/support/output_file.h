// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include <system_error>

namespace vernier {

/// Writes the output of a program to `path`; every output of the tools and of the daemon uses this function.
/// An ordinary file, existing or not, is replaced as a whole through a temporary file beside it, which is on
/// the medium before its name changes. A reader, and a power failure, find the old file or the new one. Its
/// permissions are kept, and its owner if the system allows it. Links are followed and kept: the target of
/// the last link is replaced or made.
/// A device, pipe or terminal is written to and never replaced. The same applies to an open file of this
/// process (/dev/stdout, /dev/fd/N). Waits for the reader of a named pipe, as > of a shell does. Returns the
/// reason of a failure (a folder, a socket, no right, a full medium); an ordinary file is then unchanged.
/// setup, tool.
std::error_code write_output(const std::string& path, std::string_view text);

/// Makes the folder that outputs go to, with those above it; a link that leads nowhere yet is followed, and
/// stays. One that is there is good. Returns why not. setup, tool.
std::error_code make_output_folder(const std::string& path);

}  // namespace vernier
