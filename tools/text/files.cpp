#include "tools/text/files.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "hal/support/output_file.h"
#include "tools/text/error.h"

namespace vernier {

std::string read_file(const std::string& path) {
  if (std::filesystem::is_directory(path)) throw InputError({path, 0}, "", "is a folder, not a file");
  std::ifstream file(path, std::ios::binary);
  if (!file) throw InputError({path, 0}, "", std::string("cannot be read: ") + std::strerror(errno));
  std::ostringstream text;
  text << file.rdbuf();
  if (file.bad()) throw InputError({path, 0}, "", std::string("cannot be read: ") + std::strerror(errno));
  return text.str();
}

void write_file(const std::string& path, const std::string& text) {
  if (const auto failed = write_output(path, text))
    throw InputError({path, 0}, "", "cannot be written: " + failed.message());
}

void make_folder(const std::string& path) {
  if (const auto failed = make_output_folder(path))
    throw InputError({path, 0}, "", "cannot be made a folder: " + failed.message());
}

}  // namespace vernier
