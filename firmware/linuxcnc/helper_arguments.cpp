// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware/linuxcnc/helper_arguments.h"

#include <getopt.h>

#include <cstdlib>
#include <cstring>

namespace vernier {
namespace {

// "127.0.0.1:1502".
bool parse_listen(const std::string& text, HelperArguments& arguments) {
  const std::size_t colon = text.rfind(':');
  if (colon == std::string::npos || colon == 0) return false;
  char* end = nullptr;
  const long port = std::strtol(text.c_str() + colon + 1, &end, 10);
  if (end == text.c_str() + colon + 1 || *end != '\0' || port < 0 || port > 65535) return false;
  arguments.address = text.substr(0, colon);
  arguments.port = static_cast<int>(port);
  return true;
}

bool parse_access(const char* text, LinkAccess& access) {
  constexpr const char* kNames[] = {"read", "command", "upload"};
  for (int i = 0; i < 3; ++i)
    if (std::strcmp(text, kNames[i]) == 0) return access = static_cast<LinkAccess>(i), true;
  return false;
}

}  // namespace

const char* const kHelperUsage =
    "usage: loadusr -W vernier-hal --store DIR --public-key FILE [--listen ADDRESS:PORT] [--image DIR]\n"
    "Keeps the images of the realtime component vernier (loadrt vernier axes=...) and serves its link.\n"
    "  --store DIR            folder of the two slots; created if it does not exist\n"
    "  --public-key FILE      key whose signature is trusted (vernier keys); up to eight times\n"
    "  --listen ADDRESS:PORT  Modbus TCP for vernier upload, watch, record, touches and the workbench\n"
    "  --access A             rights of clients of this link: read, command or upload (default)\n"
    "  --image DIR            starts with the image that `vernier compile -o DIR` wrote, as the confirmed "
    "image\n"
    "  --board NAME           name of the board for which images are signed; --class NAME: class of the "
    "board\n"
    "  -V, --version          print the version and end\n"
    "Exit status: 0 ended, 1 bad input or usage, 2 the component is not there, or was started with another\n"
    "store, other keys or another name of the board.\n";

const char* const kHelperVersion = "vernier-hal " VERNIER_VERSION " (" VERNIER_COMMIT ")\n";

bool parse_helper_arguments(int argc, char** argv, HelperArguments& arguments) {
  const option kOptions[] = {
      {"store", required_argument, nullptr, 's'},  {"public-key", required_argument, nullptr, 'k'},
      {"listen", required_argument, nullptr, 'l'}, {"access", required_argument, nullptr, 'a'},
      {"image", required_argument, nullptr, 'i'},  {"board", required_argument, nullptr, 'b'},
      {"class", required_argument, nullptr, 'c'},  {"help", no_argument, nullptr, 'h'},
      {"version", no_argument, nullptr, 'V'},      {nullptr, 0, nullptr, 0}};
  for (int c = 0; (c = getopt_long(argc, argv, "hV", kOptions, nullptr)) != -1;) {
    if (c == 's') arguments.store = optarg;
    if (c == 'k') arguments.public_keys.emplace_back(optarg);
    if (c == 'l' && !parse_listen(optarg, arguments)) return false;
    if (c == 'a' && !parse_access(optarg, arguments.access)) return false;
    if (c == 'i') arguments.image = optarg;
    if (c == 'b') arguments.board = optarg;
    if (c == 'c') arguments.board_class = optarg;
    if (c == 'h') return arguments.help = true;
    if (c == 'V') return arguments.version = true;
    if (c == '?') return false;
  }
  return optind == argc && !arguments.store.empty() && !arguments.public_keys.empty();
}

}  // namespace vernier
