// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace vernier::provenance {

/// One input file of a command.
struct ProvenanceInput {
  std::string name;    // name with which the command read the file, relative to the folder of the command
  std::string sha256;  // SHA-256 of the bytes that the command read, 64 hexadecimal digits
};

/// Record of how an output file was made: program, command and inputs. `vernier again` uses this record to
/// make the file again.
struct Provenance {
  std::string program;               // name, version and commit of the program
  std::vector<std::string> command;  // arguments of the command, without the name of the program
  std::string folder;                // folder in which the command ran, relative to the folder of the file
  std::vector<ProvenanceInput> inputs;
};

/// True if the result of this command depends on its input files and arguments only. A provenance can come
/// from anybody: `vernier again` runs no other command.
bool makes_files_from_files(const std::string& command);

/// Records the inputs of this process from now on, and adds their provenance to its output files: HTML pages,
/// machine files (a comment at the end) and JSON objects (key "made_by"). Other output files, and files that
/// are copies of an input, are written without provenance. If the result of a command depends on more than
/// files (a board, a server, a fleet, a key), record_provenance does nothing.
void record_provenance(const std::vector<std::string>& arguments, const std::string& program);

/// Returns the provenance in the content of a file; nullopt if the file has none. Throws InputError with
/// `name` if the provenance in the file is not valid.
std::optional<Provenance> provenance_of(const std::string& content, const std::string& name);

/// Returns a text that can be in an XML or HTML comment. The returned text contains no two consecutive
/// hyphens, which would end the comment.
std::string in_comment(const std::string& text);

/// Returns the SHA-256 hash (FIPS 180-4) of bytes as 64 hexadecimal digits.
std::string sha256_of(const std::string& bytes);

}  // namespace vernier::provenance
