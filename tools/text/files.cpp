// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/text/files.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <utility>

#include "hal/support/output_file.h"
#include "tools/text/error.h"
#include "tools/text/file_hooks.h"

namespace vernier::text {
namespace {

FileHooks& hooks() {
  static FileHooks of_process;
  return of_process;
}

}  // namespace

void set_file_hooks(FileHooks hooks) { text::hooks() = std::move(hooks); }

std::string read_file(const std::string& path) {
  if (std::filesystem::is_directory(path)) throw InputError({path, 0}, "", "is a folder, not a file");
  std::ifstream file(path, std::ios::binary);
  if (!file) throw InputError({path, 0}, "", std::string("cannot be read: ") + std::strerror(errno));
  std::ostringstream text;
  text << file.rdbuf();
  if (file.bad()) throw InputError({path, 0}, "", std::string("cannot be read: ") + std::strerror(errno));
  std::string bytes = text.str();
  if (hooks().read) hooks().read(path, bytes);
  return bytes;
}

void write_file(const std::string& path, const std::string& text) {
  if (const auto failed = write_output(path, hooks().write ? hooks().write(path, text) : text))
    throw InputError({path, 0}, "", "cannot be written: " + failed.message());
}

void require_place(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code none;
  const fs::path end = fs::weakly_canonical(path, none);
  const bool replaced = !fs::exists(end, none) || fs::is_regular_file(end, none);
  const fs::path folder = end.parent_path().empty() ? "." : end.parent_path();
  const bool can = replaced ? ::access(folder.c_str(), W_OK | X_OK) == 0 : ::access(end.c_str(), W_OK) == 0;
  if (!can) throw InputError({path, 0}, "", std::string("cannot be written: ") + std::strerror(errno));
  if (fs::is_directory(end, none)) throw InputError({path, 0}, "", "cannot be written: is a folder");
  if (replaced && !fs::is_directory(folder, none))
    throw InputError({path, 0}, "", "cannot be written: Not a directory");
}

void make_folder(const std::string& path) {
  if (const auto failed = make_output_folder(path))
    throw InputError({path, 0}, "", "cannot be made a folder: " + failed.message());
}

}  // namespace vernier::text
