#include "tools/model/files.h"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "tools/model/error.h"

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
  const std::string temporary = path + ".new" + std::to_string(getpid());
  const auto fail = [&] {
    const int reason = errno;
    std::remove(temporary.c_str());
    throw InputError({path, 0}, "", std::string("cannot be written: ") + std::strerror(reason));
  };
  std::FILE* file = std::fopen(temporary.c_str(), "wb");
  if (file == nullptr) fail();
  const bool written = std::fwrite(text.data(), 1, text.size(), file) == text.size() &&
                       std::fflush(file) == 0 && fsync(fileno(file)) == 0;
  if (std::fclose(file) != 0 || !written) fail();
  if (std::rename(temporary.c_str(), path.c_str()) != 0) fail();
}

}  // namespace vernier
