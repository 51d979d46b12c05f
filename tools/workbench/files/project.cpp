// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/workbench/files/project.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>

#include "tools/import/kinds.h"
#include "tools/text/error.h"
#include "tools/text/files.h"

namespace vernier::workbench {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostFiles = 2000, kMostParts = 3, kMostBytesOfPart = 120;

bool is_part(std::string_view part) {
  if (part.empty() || part.size() > kMostBytesOfPart) return false;
  if (std::string_view(".-~ ").find(part.front()) != std::string_view::npos) return false;
  return std::none_of(part.begin(), part.end(), [](char c) {
    return static_cast<unsigned char>(c) < 0x20 || c == 0x7f || c == '\\' || c == ':';
  });
}

std::string lower_extension(const fs::path& path) {
  std::string text = path.extension().string();
  std::transform(text.begin(), text.end(), text.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return text;
}

FileKind kind_of(const fs::path& path) {
  const std::string extension = lower_extension(path);
  if (extension == ".xml") return FileKind::kMachine;
  if (extension == ".csv") return FileKind::kMeasurement;
  if (importer::import_kind_of(extension) != nullptr) return FileKind::kInstrument;
  for (const char* table : {".xlsx", ".txt", ".tsv", ".dat", ".asc", ".json"})
    if (extension == table) return FileKind::kInstrument;
  if (extension == ".html") return FileKind::kReport;
  if (extension == ".vimg") return FileKind::kImage;
  if (extension == ".key" || extension == ".pub") return FileKind::kKey;
  return FileKind::kOther;
}

std::int64_t seconds(fs::file_time_type time) {
  const auto since = std::chrono::file_clock::to_sys(time).time_since_epoch();
  return std::chrono::duration_cast<std::chrono::seconds>(since).count();
}

}  // namespace

const char* kind_name(FileKind kind) {
  static constexpr std::array<const char*, 7> kNames = {"machine", "measurement", "instrument", "report",
                                                        "image",   "key",         "other"};
  return kNames[static_cast<std::size_t>(kind)];
}

bool is_project_name(std::string_view name) {
  std::size_t parts = 0;
  while (true) {
    const auto slash = name.find('/');
    if (!is_part(name.substr(0, slash)) || ++parts > kMostParts) return false;
    if (slash == std::string_view::npos) return true;
    name.remove_prefix(slash + 1);
  }
}

void refuse_special(const fs::path& path, const std::string& name) {
  std::error_code failed;
  const fs::file_status status = fs::symlink_status(path, failed);
  if (fs::is_symlink(status))
    throw text::InputError(fmt::format("\"{}\": a symbolic link, which the workbench does not follow", name));
  if (fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status))
    throw text::InputError(fmt::format("\"{}\": neither a file nor a folder", name));
}

Project::Project(const std::string& directory) {
  std::error_code failed;
  root_ = fs::canonical(directory, failed);
  if (failed || !fs::is_directory(root_))
    throw text::InputError(fmt::format("{}: this folder does not exist", directory));
}

fs::path Project::checked(const std::string& name) const {
  if (!is_project_name(name))
    throw text::InputError(fmt::format("\"{}\": this name is not allowed for a file of a project", name));
  fs::path path = root_;
  for (const fs::path& part : fs::path(name)) {
    path /= part;
    refuse_special(path, name);
  }
  return path;
}

fs::path Project::existing(const std::string& name) const {
  fs::path path = checked(name);
  std::error_code failed;
  if (!fs::is_regular_file(path, failed) && !fs::is_directory(path, failed))
    throw text::InputError(fmt::format("\"{}\": the project has no file of this name", name));
  return path;
}

fs::path Project::writable(const std::string& name) const {
  fs::path path = checked(name);
  // A command with a folder as argument chooses the names of the files in it.
  std::error_code failed;
  for (fs::recursive_directory_iterator at(path, failed), end; !failed && at != end; at.increment(failed))
    refuse_special(at->path(), name + "/" + at->path().lexically_relative(path).generic_string());
  return path;
}

void Project::save(const std::string& name, const std::string& bytes) const {
  text::write_file(writable(name).string(), bytes);
}

void Project::remove(const std::string& name) const {
  const fs::path path = existing(name);
  std::error_code failed;
  if (!fs::is_regular_file(path, failed))
    throw text::InputError("\"" + name + "\": a folder; only files can be deleted");
  if (!fs::remove(path, failed) || failed)
    throw text::InputError("\"" + name + "\": cannot be deleted: " + failed.message());
  // A folder without files would keep its name from the next result of a command.
  for (fs::path folder = path.parent_path(); folder != root_; folder = folder.parent_path())
    if (!fs::is_empty(folder, failed) || !fs::remove(folder, failed)) return;
}

void Project::list_folder(const fs::path& folder, const std::string& prefix, bool deeper,
                          std::vector<ProjectFile>& files) const {
  std::error_code failed;
  for (fs::directory_iterator at(folder, failed), end; !failed && at != end; at.increment(failed)) {
    const std::string name = prefix + at->path().filename().string();
    std::error_code skip;
    if (!is_project_name(name) || at->is_symlink(skip) || files.size() >= kMostFiles) continue;
    if (at->is_directory(skip)) {
      if (deeper) list_folder(at->path(), name + "/", false, files);
    } else if (at->is_regular_file(skip)) {
      files.push_back({name, kind_of(at->path()), at->file_size(skip), seconds(at->last_write_time(skip))});
    }
  }
}

std::vector<ProjectFile> Project::list() const {
  std::vector<ProjectFile> files;
  list_folder(root_, "", true, files);
  std::sort(files.begin(), files.end(),
            [](const ProjectFile& a, const ProjectFile& b) { return a.name < b.name; });
  return files;
}

}  // namespace vernier::workbench
