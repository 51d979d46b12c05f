// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace vernier::workbench {

/// Kind of a file in a project, which follows from the name of the file.
enum class FileKind : std::uint8_t { kMachine, kMeasurement, kInstrument, kReport, kImage, kKey, kOther };
/// Returns the name of a file kind for the page: "machine" ...
const char* kind_name(FileKind kind);

struct ProjectFile {
  std::string name;  // path relative to the project folder, with '/' between the parts
  FileKind kind = FileKind::kOther;
  std::uint64_t bytes = 0;
  std::int64_t modified_s = 0;  // time of the last change, s since 1970
};

/// True if a name is permitted for a file of a project. The name has one to three parts between '/', each of
/// 1 to 120 bytes. A part contains no control characters, '\' or ':', and does not start with '.', '-', '~'
/// or a blank.
bool is_project_name(std::string_view name);

/// Throws InputError with `name` if `path` is a symbolic link, a device or a pipe.
void refuse_special(const std::filesystem::path& path, const std::string& name);

/// The project folder that the workbench reads and writes. The workbench accesses no file outside this
/// folder. Names of files must be permitted (is_project_name), and no part of a name may be a symbolic link,
/// a device or a pipe.
class Project {
 public:
  /// Throws InputError if `directory` is not a folder.
  explicit Project(const std::string& directory);

  const std::filesystem::path& root() const { return root_; }
  /// Returns the path of an existing file or folder. Throws InputError with the name if the name is not
  /// permitted, contains a link, or does not exist.
  std::filesystem::path existing(const std::string& name) const;
  /// Returns the path of a file or folder that may be written. The file need not exist. Throws InputError if
  /// the name is not permitted, or if the path, or a folder at the path, contains a link, a device or a pipe.
  std::filesystem::path writable(const std::string& name) const;
  /// Writes a file. Another program reads either the old file or the complete new file.
  void save(const std::string& name, const std::string& bytes) const;
  /// Deletes a file, and the folder that contained it if this folder is then empty. Throws InputError if the
  /// name is not permitted, contains a link, or is not the name of a file.
  void remove(const std::string& name) const;
  /// Returns the files in the project folder and one level below, sorted by name. Hidden files and links are
  /// excluded, and only the first 2000 files are returned.
  std::vector<ProjectFile> list() const;

 private:
  std::filesystem::path checked(const std::string& name) const;
  void list_folder(const std::filesystem::path& folder, const std::string& prefix, bool deeper,
                   std::vector<ProjectFile>& files) const;

  std::filesystem::path root_;
};

}  // namespace vernier::workbench
