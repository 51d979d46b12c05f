// SPDX-License-Identifier: Apache-2.0
#include "hal/linux/file_slot_store.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <iterator>
#include <vector>

namespace vernier {
namespace {

/// A descriptor that closes itself; close() returns true if all writes succeeded. Opens a regular file, or
/// the directory of O_DIRECTORY: another kind in its place (a pipe) neither blocks nor takes bytes.
class File {
 public:
  File(const std::string& path, int flags) noexcept
      : fd_(::open(path.c_str(), flags | O_CLOEXEC | O_NONBLOCK, 0600)) {
    struct stat status {};
    if (fd_ < 0 || (flags & O_DIRECTORY) != 0) return;
    if (::fstat(fd_, &status) == 0 && S_ISREG(status.st_mode)) return;
    ::close(fd_);
    fd_ = -1;
    errno = EINVAL;
  }
  ~File() {
    if (fd_ >= 0) ::close(fd_);
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  bool opened() const noexcept { return fd_ >= 0; }
  int fd() const noexcept { return fd_; }
  bool close() noexcept {
    const int fd = fd_;
    fd_ = -1;
    return ::close(fd) == 0;
  }

 private:
  int fd_;
};

HalFault read_at(const std::string& path, std::uint32_t offset, std::uint8_t* bytes,
                 std::uint32_t size) noexcept {
  const File file(path, O_RDONLY);
  if (!file.opened()) return errno == ENOENT ? HalFault::kNoReading : HalFault::kRefused;
  for (std::uint32_t done = 0; done < size;) {
    const ssize_t got = ::pread(file.fd(), bytes + done, size - done, off_t{offset} + done);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return HalFault::kRefused;
    if (got == 0) return HalFault::kNoReading;
    done += static_cast<std::uint32_t>(got);
  }
  return HalFault::kNone;
}

bool write_all(int fd, std::uint32_t offset, const std::uint8_t* bytes, std::uint32_t size) noexcept {
  for (std::uint32_t done = 0; done < size;) {
    const ssize_t put = ::pwrite(fd, bytes + done, size - done, off_t{offset} + done);
    if (put < 0 && errno == EINTR) continue;
    if (put <= 0) return false;
    done += static_cast<std::uint32_t>(put);
  }
  return true;
}

// A new file is on the medium only when its directory is.
bool sync_directory(const std::string& directory) noexcept {
  File file(directory, O_RDONLY | O_DIRECTORY);
  return file.opened() && ::fsync(file.fd()) == 0;
}

}  // namespace

FileSlotStore::FileSlotStore(std::string directory, std::uint32_t capacity)
    : directory_(std::move(directory)), capacity_(capacity) {
  for (std::size_t i = 0; i < std::size(records_); ++i)
    records_[i] = directory_ + "/record" + std::to_string(i);
  for (std::size_t i = 0; i < std::size(slots_); ++i)
    slots_[i] = directory_ + "/slot" + std::to_string(i) + ".vup";
}

HalFault FileSlotStore::read_record(std::uint32_t place, std::uint8_t* bytes, std::uint32_t size) noexcept {
  if (place >= std::size(records_)) return HalFault::kNoDevice;
  const HalFault fault = read_at(records_[place], 0, bytes, size);
  // A file that is there and too short was written once.
  return fault == HalFault::kNoReading && ::access(records_[place].c_str(), F_OK) == 0 ? HalFault::kRefused
                                                                                       : fault;
}

// A record that was begun must not look like the record before: what was not written as a whole is cut, which
// needs no room. Bytes behind the record are cut too.
HalFault FileSlotStore::write_record(std::uint32_t place, const std::uint8_t* bytes,
                                     std::uint32_t size) noexcept {
  if (place >= std::size(records_)) return HalFault::kNoDevice;
  File file(records_[place], O_WRONLY | O_CREAT);
  if (!file.opened()) return HalFault::kRefused;
  if (!write_all(file.fd(), 0, bytes, size) || ::ftruncate(file.fd(), off_t{size}) != 0 ||
      ::fsync(file.fd()) != 0) {
    if (::ftruncate(file.fd(), 0) == 0) ::fsync(file.fd());
    return HalFault::kRefused;
  }
  if (!file.close()) return HalFault::kRefused;
  return sync_directory(directory_) ? HalFault::kNone : HalFault::kRefused;
}

// Under another name first: a power failure leaves no file or a whole one.
HalFault FileSlotStore::reserve_record(std::uint32_t place, std::uint32_t size) noexcept {
  if (place >= std::size(records_)) return HalFault::kNoDevice;
  if (::access(records_[place].c_str(), F_OK) == 0) return HalFault::kNone;
  const std::string fresh = records_[place] + ".new";
  {
    File file(fresh, O_WRONLY | O_CREAT | O_TRUNC);
    const std::vector<std::uint8_t> ones(size, 0xff);
    if (!file.opened() || !write_all(file.fd(), 0, ones.data(), size) || ::fsync(file.fd()) != 0) {
      ::unlink(fresh.c_str());
      return HalFault::kRefused;
    }
  }
  if (::rename(fresh.c_str(), records_[place].c_str()) != 0) return HalFault::kRefused;
  return sync_directory(directory_) ? HalFault::kNone : HalFault::kRefused;
}

HalFault FileSlotStore::read_image(std::uint32_t slot, std::uint32_t offset, std::uint8_t* bytes,
                                   std::uint32_t size) noexcept {
  return slot < 2 ? read_at(slots_[slot], offset, bytes, size) : HalFault::kNoDevice;
}

HalFault FileSlotStore::write_image(std::uint32_t slot, std::uint32_t offset, const std::uint8_t* bytes,
                                    std::uint32_t size) noexcept {
  if (slot >= 2 || offset > capacity_ || size > capacity_ - offset) return HalFault::kNoDevice;
  File file(slots_[slot], O_WRONLY | O_CREAT);
  if (!file.opened() || !write_all(file.fd(), offset, bytes, size) || !file.close())
    return HalFault::kRefused;
  return HalFault::kNone;
}

HalFault FileSlotStore::finish_image(std::uint32_t slot, std::uint32_t size) noexcept {
  if (slot >= 2) return HalFault::kNoDevice;
  File file(slots_[slot], O_WRONLY);
  if (!file.opened() || ::ftruncate(file.fd(), off_t{size}) != 0) return HalFault::kRefused;
  if (::fsync(file.fd()) != 0 || !file.close()) return HalFault::kRefused;
  return sync_directory(directory_) ? HalFault::kNone : HalFault::kRefused;
}

}  // namespace vernier
