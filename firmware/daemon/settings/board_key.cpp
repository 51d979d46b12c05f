// SPDX-License-Identifier: Apache-2.0
#include "firmware/daemon/settings/board_key.h"

#include <fcntl.h>
#include <sodium.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string_view>

#include "firmware/daemon/settings/key_file.h"
#include "hal/support/output_file.h"

namespace vernier {
namespace {

/// A descriptor that is closed at the end of its scope.
class OpenFile {
 public:
  OpenFile(const std::string& path, int flags) : fd_(::open(path.c_str(), flags | O_CLOEXEC | O_NONBLOCK)) {}
  ~OpenFile() {
    if (fd_ >= 0) ::close(fd_);
  }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  int fd() const { return fd_; }

 private:
  int fd_;
};

[[noreturn]] void fail(const std::string& path, const char* what) {
  throw BoardError{path + ": " + (what == nullptr ? std::strerror(errno) : what)};
}

}  // namespace

BoardKey::BoardKey(const std::string& store) {
  if (sodium_init() < 0) throw BoardError{"the cryptographic library does not start"};
  const std::string path = store + "/identity.key", open = store + "/identity.pub";
  if (::access(path.c_str(), F_OK) != 0 && errno == ENOENT) make(path);
  read(path);
  if (::access(open.c_str(), F_OK) == 0) return;
  if (const auto failed = write_output(open, "vernier board identity\n" + text() + "\n"))
    throw BoardError{open + ": " + failed.message()};
}

BoardKey::~BoardKey() { sodium_memzero(secret_.data(), secret_.size()); }

// Unreadable for others from its first byte on; a power cut leaves no key or a whole one.
void BoardKey::make(const std::string& path) {
  crypto_sign_keypair(public_.data(), secret_.data());
  const mode_t before = ::umask(S_IRWXG | S_IRWXO);
  const auto failed =
      write_output(path, std::string_view(reinterpret_cast<const char*>(secret_.data()), secret_.size()));
  ::umask(before);
  if (failed) throw BoardError{path + ": " + failed.message()};
}

void BoardKey::read(const std::string& path) {
  const OpenFile file(path, O_RDONLY);
  struct stat info {};
  if (file.fd() < 0 || ::fstat(file.fd(), &info) != 0) fail(path, nullptr);
  if ((info.st_mode & (S_IRWXG | S_IRWXO)) != 0)
    fail(path, "other users may read this secret key; set the permissions of the file with chmod 600");
  std::array<std::uint8_t, 65> bytes{};
  if (::read(file.fd(), bytes.data(), bytes.size()) != 64)
    fail(path, "is no key of a board; remove the file, and enter the new key in the registry");
  std::memcpy(secret_.data(), bytes.data(), secret_.size());
  sodium_memzero(bytes.data(), bytes.size());
  std::array<std::uint8_t, 32> seed{};
  crypto_sign_ed25519_sk_to_seed(seed.data(), secret_.data());
  std::array<std::uint8_t, 64> again{};
  crypto_sign_seed_keypair(public_.data(), again.data(), seed.data());
  const bool whole = sodium_memcmp(again.data(), secret_.data(), again.size()) == 0;
  sodium_memzero(seed.data(), seed.size());
  sodium_memzero(again.data(), again.size());
  if (!whole) fail(path, "is damaged; remove the file, and enter the new key in the registry");
}

HalFault BoardKey::sign(const std::uint8_t* message, std::uint32_t size, std::uint8_t* signature) noexcept {
  crypto_sign_state state;
  crypto_sign_init(&state);
  crypto_sign_update(&state, message, size);
  return crypto_sign_final_create(&state, signature, nullptr, secret_.data()) == 0 ? HalFault::kNone
                                                                                   : HalFault::kRefused;
}

std::string BoardKey::text() const {
  char hex[2 * kPublicBytes + 1];
  return sodium_bin2hex(hex, sizeof(hex), public_.data(), public_.size());
}

}  // namespace vernier
