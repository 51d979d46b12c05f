// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace vernier::workbench {

/// Kind of a file of a project, by its name.
enum class FileKind : std::uint8_t { kMachine, kMeasurement, kInstrument, kReport, kImage, kKey, kOther };
/// Returns the name of a kind as the page writes it: "machine" ...
const char* kind_name(FileKind kind);

struct ProjectFile {
  std::string name;  // relative to the project, parts joined by '/'
  FileKind kind = FileKind::kOther;
  std::uint64_t bytes = 0;
  std::int64_t modified_s = 0;  // since 1970
};

/// True if the name is allowed for a file of a project: one to three parts between '/', each of 1 to 120
/// bytes, without control characters, '\' and ':', not starting with '.', '-', '~' or a blank.
bool is_project_name(std::string_view name);

/// Throws InputError with the name if `path` is a symbolic link, a device or a pipe.
void refuse_special(const std::filesystem::path& path, const std::string& name);

/// The folder that the workbench reads and writes; the workbench accesses no file outside the folder. Names
/// are checked as above, and no part of a name may be a symbolic link, a device or a pipe.
class Project {
 public:
  /// Throws InputError if `directory` is not a folder.
  explicit Project(const std::string& directory);

  const std::filesystem::path& root() const { return root_; }
  /// Returns the path of an existing file or folder. Throws InputError with the name: a name that is not
  /// allowed, a link, no such file.
  std::filesystem::path existing(const std::string& name) const;
  /// Returns a path that may be written; the file need not exist. Throws InputError as above, and if a folder
  /// contains a link, a device or a pipe.
  std::filesystem::path writable(const std::string& name) const;
  /// Writes a file; a reader gets either the old file or the complete new file.
  void save(const std::string& name, const std::string& bytes) const;
  /// Returns the files in the folder and one level below, by name; without hidden files and links, and only
  /// the first 2000.
  std::vector<ProjectFile> list() const;

 private:
  std::filesystem::path checked(const std::string& name) const;
  void list_folder(const std::filesystem::path& folder, const std::string& prefix, bool deeper,
                   std::vector<ProjectFile>& files) const;

  std::filesystem::path root_;
};

}  // namespace vernier::workbench
