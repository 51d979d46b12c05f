// SPDX-License-Identifier: GPL-3.0-or-later
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "tools/commands/command.h"
#include "tools/text/error.h"
#include "tools/upload/signing.h"

namespace vernier::commands::keys_cli {
namespace {

struct Arguments {
  std::string directory = ".", json;
};

// Created unreadable for others from its first byte on, and never over an existing key.
void write_secret(const std::string& path, const std::string& text) {
  const int fd = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  if (fd < 0) throw text::InputError(path + ": " + std::strerror(errno));
  const bool written =
      ::write(fd, text.data(), text.size()) == static_cast<ssize_t>(text.size()) && ::fsync(fd) == 0;
  const bool closed = ::close(fd) == 0;
  if (written && closed) return;
  ::unlink(path.c_str());
  throw text::InputError(path + ": cannot be written");
}

void run(const Arguments& arguments) {
  text::make_folder(arguments.directory);
  const std::string secret = arguments.directory + "/vernier.key",
                    open = arguments.directory + "/vernier.pub";
  if (std::filesystem::exists(open))
    throw text::InputError(
        fmt::format("{}: the file exists; a key is never overwritten, give another directory", open));
  const upload::SigningKey key = upload::new_key();
  write_secret(secret, upload::secret_key_text(key));
  text::write_file(open, upload::public_key_text(key));
  fmt::print(human_stream(arguments.json),
             "{}  secret key: signs uploads (`vernier upload --key`); keep it only on the computer that "
             "makes the images\n"
             "{}  public key: copy it to the board, and name it as public_key in the board file\n",
             secret, open);
  write_json(arguments.json, {{"secret_key", secret}, {"public_key", open}});
}

}  // namespace

void register_keys(CLI::App& vernier) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* const command = vernier.add_subcommand("keys",
                                                   "Make a key pair: the secret key signs correction images, "
                                                   "and a board with the public key accepts these images");
  command
      ->add_option("-o,--output", arguments->directory, "directory for vernier.key (secret) and vernier.pub")
      ->type_name(kWritesFolder)
      ->capture_default_str();
  command->add_option("--json", arguments->json,
                      "file for the result as JSON, for programs; - for standard output");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace vernier::commands::keys_cli
