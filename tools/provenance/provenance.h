// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace vernier::provenance {

/// One input of a command.
struct ProvenanceInput {
  std::string name;    // as the command read it, relative to the folder of the command
  std::string sha256;  // of the bytes that the command read, 64 hexadecimal digits
};

/// How a file was made. `vernier again` uses it to make the file again.
struct Provenance {
  std::string program;               // name, version and commit
  std::vector<std::string> command;  // arguments, without the name of the program
  std::string folder;                // in which the command ran, relative to the folder of the file
  std::vector<ProvenanceInput> inputs;
};

/// True if the result of this command depends on its input files and arguments only. A provenance can come
/// from anybody: `vernier again` runs no other command.
bool makes_files_from_files(const std::string& command);

/// Records the inputs of this process from now on, and adds the provenance to its output files: HTML pages,
/// machine files (a comment at the end) and JSON objects (key "made_by"). All other files, and a file that is
/// the copy of an input, are written as they are. For a command whose result depends on more than files (a
/// board, a server, a fleet, a key) the function does nothing.
void record_provenance(const std::vector<std::string>& arguments, const std::string& program);

/// Provenance of a file with this content; nullopt if the file has none. Throws InputError with `name` if the
/// provenance is malformed.
std::optional<Provenance> provenance_of(const std::string& content, const std::string& name);

/// Returns the text in the form for an XML or HTML comment, without two consecutive hyphens, which would end
/// the comment.
std::string in_comment(const std::string& text);

/// SHA-256 (FIPS 180-4), 64 hexadecimal digits.
std::string sha256_of(const std::string& bytes);

}  // namespace vernier::provenance
