// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include <system_error>

namespace vernier {

/// Writes the output of a program to `path`; every output of the tools and of the daemon uses this function.
/// An ordinary file, existing or not, is replaced as a whole through a temporary file in the same folder. The
/// temporary file is on the medium before its name changes. After a power failure, or during the write, a
/// reader finds the complete old file or the complete new file. The file keeps its permissions, and its owner
/// if the system supports this. Symbolic links are followed and stay: the target of the last link is replaced
/// or created. A device, pipe or terminal is written to and never replaced. The same rule is valid for an
/// open file of this process (/dev/stdout, /dev/fd/N). Waits for the reader of a named pipe, as > of a shell
/// does. Returns the reason of a failure (a folder, a socket, no right, a full medium); an ordinary file is
/// then unchanged.
std::error_code write_output(const std::string& path, std::string_view text);

/// Makes an output folder and the folders above it. A symbolic link to a folder that does not exist is
/// followed, and the link stays. If the folder already exists, this is not an error. Returns the reason of a
/// failure.
std::error_code make_output_folder(const std::string& path);

}  // namespace vernier
