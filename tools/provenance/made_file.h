// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "tools/provenance/provenance.h"

namespace vernier::provenance {

/// An output file of a command, and the content that a repetition of the command gives.
struct Remade {
  std::string name, text;
};

/// An output file with a provenance, and the command that makes the file again.
class MadeFile {
 public:
  /// Reads the provenance of a file, or of `improve.json` or `bound.json` in a folder. Throws InputError if
  /// the file has no provenance, or if its command does more than make files from files.
  explicit MadeFile(const std::string& file_or_folder);

  const std::string& file() const { return file_; }
  const std::string& content() const { return content_; }
  const Provenance& made() const { return made_; }

  /// Names of the inputs whose bytes differ from the bytes that the command read. Throws InputError if an
  /// input is missing.
  std::vector<std::string> changed_inputs() const;

  /// Runs the command again in a temporary folder, with copies of the inputs. Returns the file with its new
  /// content; if the user named a folder, also every other file that the command writes into that folder. The
  /// texts have the program version of the first run. Throws LimitNotMet if the command does not make the
  /// file.
  std::vector<Remade> remade() const;

 private:
  class Mirror;

  std::string as_made(const std::filesystem::path& made, const Mirror& mirror) const;
  bool is_input(const std::filesystem::path& path, const Mirror& mirror) const;
  void require_harmless() const;
  std::filesystem::path at(const std::string& name) const { return (folder_ / name).lexically_normal(); }
  void make_folder_of(const std::string& word, const Mirror& mirror) const;

  std::string file_, content_;
  bool whole_folder_ = false;
  Provenance made_;
  std::filesystem::path place_, folder_;  // of the file; in which the command ran
};

}  // namespace vernier::provenance
