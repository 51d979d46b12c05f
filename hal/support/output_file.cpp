// SPDX-License-Identifier: Apache-2.0
#include "hal/support/output_file.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <optional>

namespace vernier {
namespace {

namespace fs = std::filesystem;

constexpr int kMostLinks = 40;  // as many as the kernel follows: path_resolution(7)

std::error_code last_error() { return {errno, std::generic_category()}; }

/// A descriptor that closes itself.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  bool opened() const { return number_ >= 0; }
  int number() const { return number_; }
  std::error_code close() {
    const int number = number_;
    number_ = -1;
    return number >= 0 && ::close(number) != 0 ? last_error() : std::error_code();
  }

 private:
  int number_;
};

std::error_code write_all(int to, std::string_view text) {
  while (!text.empty()) {
    const ssize_t put = ::write(to, text.data(), text.size());
    if (put >= 0) {
      text.remove_prefix(static_cast<std::size_t>(put));
    } else if (errno == EAGAIN) {  // another process made the shared end non-blocking
      pollfd room{to, POLLOUT, 0};
      ::poll(&room, 1, -1);
    } else if (errno != EINTR) {
      return last_error();
    }
  }
  return {};
}

/// The number of the open file of this process that /dev/stdout, /dev/fd/N or /proc/self/fd/N is. Its name
/// leads to the opened file; a file that replaced it would not reach the processes that have it open.
std::optional<int> own_descriptor(const fs::path& path) {
  std::error_code failed;
  const fs::path folder = fs::canonical(path.parent_path().empty() ? "." : path.parent_path(), failed);
  if (failed || folder != "/proc/" + std::to_string(::getpid()) + "/fd") return std::nullopt;
  const std::string name = path.filename().string();
  int number = -1;
  const auto end = std::from_chars(name.data(), name.data() + name.size(), number);
  if (end.ec != std::errc() || end.ptr != name.data() + name.size()) return std::nullopt;
  return number;
}

/// Where a path ends, links followed; the end need not be there yet.
struct End {
  fs::path path;
  std::optional<int> open_file;  // of this process
};

std::error_code follow(End& end) {
  for (int links = 0; links <= kMostLinks; ++links) {
    if (end.open_file = own_descriptor(end.path); end.open_file) return {};
    std::error_code no_link;
    const fs::path next = fs::read_symlink(end.path, no_link);
    if (no_link) return {};
    end.path = end.path.parent_path() / next;
  }
  return std::make_error_code(std::errc::too_many_symbolic_link_levels);
}

std::error_code write_to_open_file(int number, std::string_view text) {
  // Earlier output is written first.
  if (number == STDOUT_FILENO) std::fflush(stdout);
  Descriptor to(::fcntl(number, F_DUPFD_CLOEXEC, 0));
  if (!to.opened()) return last_error();
  if (const auto failed = write_all(to.number(), text)) return failed;
  return to.close();
}

std::error_code write_to_device(const std::string& path, std::string_view text) {
  Descriptor to(::open(path.c_str(), O_WRONLY | O_NOCTTY | O_CLOEXEC));
  if (!to.opened()) return last_error();
  if (const auto failed = write_all(to.number(), text)) return failed;
  return to.close();
}

/// A new file beside `target`; `name` is its path.
int open_beside(const fs::path& target, mode_t mode, fs::path& name) {
  static std::atomic<unsigned> count{0};
  for (;;) {
    name = target.parent_path() /
           (".vernier" + std::to_string(::getpid()) + "." + std::to_string(count.fetch_add(1)));
    const int number = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
    if (number >= 0 || errno != EEXIST) return number;  // one that a killed process left is passed over
  }
}

/// The same access rights as the old file: no other user gets access.
std::error_code keep_access(int to, const struct stat& old) {
  constexpr mode_t kPermissions = 0777;
  // A file of another owner becomes a file of the writer if its ownership cannot be changed.
  const bool given =
      ::fchown(to, old.st_uid, old.st_gid) == 0 || ::fchown(to, static_cast<uid_t>(-1), old.st_gid) == 0;
  const mode_t mode = old.st_mode & (given ? kPermissions : kPermissions & ~mode_t{S_IRWXG});
  return ::fchmod(to, mode) == 0 ? std::error_code() : last_error();
}

std::error_code fill(Descriptor& to, std::string_view text, const struct stat* old) {
  if (old != nullptr)
    if (const auto failed = keep_access(to.number(), *old)) return failed;
  if (const auto failed = write_all(to.number(), text)) return failed;
  if (::fsync(to.number()) != 0) return last_error();
  return to.close();
}

/// old: the existing file, null without one.
std::error_code replace(const fs::path& target, std::string_view text, const struct stat* old) {
  fs::path name;
  Descriptor to(open_beside(target, old != nullptr ? S_IRUSR | S_IWUSR : 0666, name));
  if (!to.opened()) return last_error();
  std::error_code failed = fill(to, text, old);
  if (!failed && ::rename(name.c_str(), target.c_str()) != 0) failed = last_error();
  if (failed) {
    ::unlink(name.c_str());
    return failed;
  }
  // The new name too must survive a power cut; not every file system can be asked.
  const fs::path folder = target.parent_path().empty() ? "." : target.parent_path();
  const Descriptor names(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (names.opened()) ::fsync(names.number());
  return {};
}

}  // namespace

std::error_code write_output(const std::string& path, std::string_view text) {
  End end{path, {}};
  if (const auto failed = follow(end)) return failed;
  if (end.open_file) return write_to_open_file(*end.open_file, text);
  // By the path as given: the kernel has the last word on which links may be followed.
  struct stat old {};
  if (::stat(path.c_str(), &old) != 0)
    return errno == ENOENT ? replace(end.path, text, nullptr) : last_error();
  if (S_ISDIR(old.st_mode)) return std::make_error_code(std::errc::is_a_directory);
  return S_ISREG(old.st_mode) ? replace(end.path, text, &old) : write_to_device(path, text);
}

std::error_code make_output_folder(const std::string& path) {
  End end{path, {}};
  if (!end.path.has_filename()) end.path = end.path.parent_path();  // "name/"
  if (const auto failed = follow(end)) return failed;
  std::error_code failed;
  fs::create_directories(end.path, failed);
  return failed;
}

}  // namespace vernier
