// SPDX-License-Identifier: Apache-2.0
#include "hal/linux/sysfs_attribute.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstring>

#include "hal/linux/file_lock.h"
#include "hal/linux/system_time.h"

namespace vernier {
namespace {

constexpr std::size_t kLongestText = 64;  // of a number in an attribute
constexpr std::int64_t kMicro = 1'000'000, kMostWhole = 1'000'000'000'000;

bool is_digit(char c) noexcept { return c >= '0' && c <= '9'; }

}  // namespace

std::optional<SysfsAttribute> SysfsAttribute::open(const std::string& path, Use use, std::string& error) {
  const int flags = use == Use::kRead ? O_RDONLY : use == Use::kWrite ? O_WRONLY : O_RDWR;
  // An empty path would be the working directory's business in some calls and an error in others.
  const int fd = path.empty() ? (errno = ENOENT, -1) : ::open(path.c_str(), flags | O_CLOEXEC);
  if (fd >= 0) return SysfsAttribute(fd);
  error = (path.empty() ? "an empty path" : path) + ": " + std::strerror(errno);
  return std::nullopt;
}

SysfsAttribute::SysfsAttribute(SysfsAttribute&& other) noexcept : fd_(other.fd_) { other.fd_ = -1; }

SysfsAttribute& SysfsAttribute::operator=(SysfsAttribute&& other) noexcept {
  std::swap(fd_, other.fd_);
  return *this;
}

bool SysfsAttribute::lock() noexcept { return lock_descriptor(fd_); }

SysfsAttribute::~SysfsAttribute() {
  if (fd_ >= 0) ::close(fd_);
}

HalFault SysfsAttribute::write_text(const char* text, std::size_t size) noexcept {
  for (int i = 0; i < kMostInterruptions; ++i) {
    const ssize_t put = ::pwrite(fd_, text, size, 0);
    // A driver accepts an attribute as a whole or not at all.
    if (put == static_cast<ssize_t>(size)) return HalFault::kNone;
    if (put >= 0 || errno != EINTR) return HalFault::kRefused;
  }
  return HalFault::kRefused;
}

HalFault SysfsAttribute::write(std::int64_t value) noexcept {
  char text[kLongestText];
  char* const end = std::to_chars(text, text + sizeof(text) - 1, value).ptr;
  *end = '\n';
  return write_text(text, static_cast<std::size_t>(end - text) + 1);
}

HalFault SysfsAttribute::write(const std::string& word) noexcept {
  return write_text(word.data(), word.size());
}

HalFault SysfsAttribute::read_micro(std::int64_t& micro) noexcept {
  char text[kLongestText];
  for (int i = 0; i < kMostInterruptions; ++i) {
    const ssize_t got = ::pread(fd_, text, sizeof(text), 0);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0 || !parse_micro(text, static_cast<std::size_t>(got), micro)) return HalFault::kNoReading;
    return HalFault::kNone;
  }
  return HalFault::kNoReading;
}

HalFault SysfsAttribute::read(std::int64_t& value) noexcept {
  std::int64_t micro = 0;
  if (read_micro(micro) != HalFault::kNone || micro % kMicro != 0) return HalFault::kNoReading;
  value = micro / kMicro;
  return HalFault::kNone;
}

bool parse_micro(const char* text, std::size_t size, std::int64_t& micro) noexcept {
  std::size_t at = 0;
  const bool negative = at < size && text[at] == '-';
  at += negative ? 1 : 0;
  if (at == size || !is_digit(text[at])) return false;
  std::int64_t whole = 0, fraction = 0, weight = kMicro;
  for (; at < size && is_digit(text[at]); ++at)
    if ((whole = 10 * whole + (text[at] - '0')) > kMostWhole) return false;
  if (at < size && text[at] == '.') {
    if (++at == size || !is_digit(text[at])) return false;
    for (; at < size && is_digit(text[at]); ++at) fraction += (weight /= 10) * (text[at] - '0');
  }
  // An attribute ends with a line feed; any text after it is ignored.
  if (at < size && text[at] != '\n') return false;
  const std::int64_t value = whole * kMicro + fraction;
  micro = negative ? -value : value;
  return true;
}

}  // namespace vernier
