// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tables/link_format.h"

namespace vernier {

/// Command line arguments of the program vernier-hal.
struct HelperArguments {
  std::string store, image, board, board_class;
  std::vector<std::string> public_keys;
  std::string address;  // address to which the program listens; empty: no link
  int port = 0;
  LinkAccess access = LinkAccess::kUpload;
  bool help = false, version = false;
};

extern const char* const kHelperUsage;
extern const char* const kHelperVersion;

/// Returns false if the arguments are not valid; kHelperUsage is the help text. Not real-time safe.
bool parse_helper_arguments(int argc, char** argv, HelperArguments& arguments);

}  // namespace vernier
