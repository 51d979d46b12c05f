// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include <system_error>

namespace vernier {

/// Writes the output of a program to `path`. All outputs of the tools and of the daemon use this function. An
/// ordinary file (existing or new) is replaced completely, through a temporary file in the same folder. The
/// temporary file is on the medium before its name changes. During the write, and after a power failure, a
/// reader finds either the complete old file or the complete new file. The file keeps its permissions, and
/// its owner if the system supports this. Symbolic links are followed and not changed. The target of the last
/// link is replaced or created. A device, a pipe or a terminal is written directly and never replaced. An
/// open file of this process (/dev/stdout, /dev/fd/N) is written in the same way as its target. If the output
/// is a named pipe, the function waits for its reader, as the operator > of a shell does. If the write fails,
/// the function returns the reason (a folder, a socket, no permission, a full medium). An ordinary file is
/// then unchanged.
std::error_code write_output(const std::string& path, std::string_view text);

/// Creates an output folder and the folders above it. A symbolic link to a folder that does not exist is
/// followed, and the link stays. If the folder already exists, this is not an error. If the folder cannot be
/// created, the function returns the reason.
std::error_code make_output_folder(const std::string& path);

}  // namespace vernier
