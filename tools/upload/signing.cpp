// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/upload/signing.h"

#include <fmt/format.h>
#include <sodium.h>
#include <sys/stat.h>

#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <sstream>

#include "tables/image_format.h"
#include "tools/text/error.h"
#include "tools/text/files.h"

namespace vernier::upload {
namespace {

constexpr const char* kSecretTitle = "vernier board secret key";
constexpr const char* kPublicTitle = "vernier board public key";
constexpr const char* kIdentityTitle = "vernier board identity";

std::string base64(const std::uint8_t* bytes, std::size_t size) {
  std::string text(sodium_base64_ENCODED_LEN(size, sodium_base64_VARIANT_ORIGINAL), '\0');
  sodium_bin2base64(text.data(), text.size(), bytes, size, sodium_base64_VARIANT_ORIGINAL);
  text.resize(std::strlen(text.c_str()));
  return text;
}

void start_sodium() {
  if (sodium_init() < 0) throw std::runtime_error("the cryptographic library does not start");
}

}  // namespace

std::array<std::uint8_t, kPublicKeyBytes> SigningKey::public_part() const {
  std::array<std::uint8_t, kPublicKeyBytes> key{};
  crypto_sign_ed25519_sk_to_pk(key.data(), secret.data());
  return key;
}

std::string board_key_text(const BoardPublicKey& key) {
  char hex[2 * kPublicKeyBytes + 1];
  return sodium_bin2hex(hex, sizeof(hex), key.data(), key.size());
}

BoardPublicKey parse_board_key(const std::string& text) {
  const auto digits_of = [](const std::string& digits) -> std::optional<BoardPublicKey> {
    BoardPublicKey key{};
    std::size_t size = 0;
    const char* end = nullptr;
    const bool whole =
        digits.size() == 2 * kPublicKeyBytes &&
        sodium_hex2bin(key.data(), key.size(), digits.data(), digits.size(), nullptr, &size, &end) == 0 &&
        size == key.size() && end == digits.data() + digits.size();
    return whole ? std::optional(key) : std::nullopt;
  };
  if (const auto key = digits_of(text)) return *key;
  std::istringstream file(text::read_file(text));
  std::string title, line;
  std::getline(file, title);
  std::getline(file, line);
  const auto key = title == kIdentityTitle ? digits_of(line) : std::nullopt;
  if (!key)
    throw text::InputError(
        {text, 0}, "",
        "this is not the key of a board; expected 64 hexadecimal digits, or the file identity.pub");
  return *key;
}

std::array<std::uint8_t, 32> fresh_nonce() {
  start_sodium();
  std::array<std::uint8_t, 32> nonce{};
  randombytes_buf(nonce.data(), nonce.size());
  return nonce;
}

SigningKey new_key() {
  start_sodium();
  SigningKey key{};
  std::array<std::uint8_t, kPublicKeyBytes> unused{};
  crypto_sign_keypair(unused.data(), key.secret.data());
  return key;
}

std::string secret_key_text(const SigningKey& key) {
  return std::string(kSecretTitle) + "\n" + base64(key.secret.data(), key.secret.size()) + "\n";
}

std::string public_key_text(const SigningKey& key) {
  const auto part = key.public_part();
  return std::string(kPublicTitle) + "\n" + base64(part.data(), part.size()) + "\n";
}

SigningKey read_secret_key(const std::string& path) {
  start_sodium();
  std::istringstream text(text::read_file(path));
  struct stat info {};
  if (::stat(path.c_str(), &info) == 0 && (info.st_mode & (S_IRWXG | S_IRWXO)) != 0)
    throw text::InputError(
        fmt::format("{}: other users may read this secret key: set its permissions with chmod 600", path));
  std::string title, line;
  std::getline(text, title);
  std::getline(text, line);
  SigningKey key{};
  std::size_t size = 0;
  if (title != kSecretTitle ||
      sodium_base642bin(key.secret.data(), key.secret.size(), line.c_str(), line.size(), nullptr, &size,
                        nullptr, sodium_base64_VARIANT_ORIGINAL) != 0 ||
      size != key.secret.size())
    throw text::InputError(path + ":1: not a secret key of vernier keys");
  return key;
}

std::optional<SigningKey> given_key(const std::string& path) {
  if (!path.empty()) return read_secret_key(path);
  const char* const named = std::getenv("VERNIER_KEY");
  if (named == nullptr || *named == '\0') return std::nullopt;
  return read_secret_key(named);
}

std::vector<std::uint8_t> make_upload(const std::vector<std::uint8_t>& image, const SigningKey& key,
                                      std::uint64_t issued, std::uint32_t security,
                                      const std::string& board) {
  start_sodium();
  if (board.size() >= kBoardNameBytes)
    throw text::InputError(fmt::format("\"{}\": too long for the name of a board", board));
  ImageHeader inside;
  std::memcpy(&inside, image.data(), sizeof(inside));
  UploadHeader header{};
  std::memcpy(header.magic, kUploadMagic, sizeof(header.magic));
  header.header_bytes = sizeof(UploadHeader);
  header.image_bytes = static_cast<std::uint32_t>(image.size());
  header.issued = issued;
  header.fingerprint = inside.fingerprint;
  header.security = security;
  std::memcpy(header.board, board.data(), board.size());
  std::memcpy(header.key, key.public_part().data(), sizeof(header.key));
  crypto_sign_state state;
  crypto_sign_init(&state);
  crypto_sign_update(&state, reinterpret_cast<const std::uint8_t*>(&header), kSignedHeaderBytes);
  crypto_sign_update(&state, image.data(), image.size());
  crypto_sign_final_create(&state, header.signature, nullptr, key.secret.data());
  std::vector<std::uint8_t> upload(sizeof(header) + image.size());
  std::memcpy(upload.data(), &header, sizeof(header));
  std::memcpy(upload.data() + sizeof(header), image.data(), image.size());
  return upload;
}

std::vector<std::uint8_t> image_in(const std::vector<std::uint8_t>& upload) {
  std::uint32_t header_bytes = 0;
  if (upload.size() > offsetof(UploadHeader, image_bytes))
    std::memcpy(&header_bytes, upload.data() + offsetof(UploadHeader, header_bytes), sizeof(header_bytes));
  const bool known = header_bytes == sizeof(UploadHeader) || header_bytes == sizeof(UploadHeaderV1);
  if (!known || upload.size() < header_bytes)
    throw text::InputError("this tool did not send the upload that the board has");
  return {upload.begin() + static_cast<std::ptrdiff_t>(header_bytes), upload.end()};
}

SignedRequest sign_request(const SigningKey& key, const SignedRequestHead& head,
                           const std::vector<std::uint8_t>& rest) {
  start_sodium();
  SignedRequest request{};
  std::memcpy(request.key, key.public_part().data(), sizeof(request.key));
  std::memcpy(request.challenge, head.challenge, sizeof(request.challenge));
  crypto_sign_state state;
  crypto_sign_init(&state);
  crypto_sign_update(&state, reinterpret_cast<const std::uint8_t*>(&head), sizeof(head));
  crypto_sign_update(&state, rest.data(), rest.size());
  crypto_sign_final_create(&state, request.signature, nullptr, key.secret.data());
  return request;
}

}  // namespace vernier::upload
