// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware/daemon/settings/board_file.h"

#include "firmware/daemon/settings/feature_settings.h"
#include "tests/fuzz/target.h"

namespace vernier::fuzz {
namespace {

void take(Bytes bytes) {
  const MemoryFile file(bytes);
  try {
    feature_requests(read_board_file(file.path()));
  } catch (const BoardError& error) {
    // Also of a key's file that the board file names.
    expect(error.what.find('/') != std::string::npos || error.what.find(':') != std::string::npos,
           "an error that names no place");
  }
}

const Registered kTarget("board_file", take);

}  // namespace
}  // namespace vernier::fuzz
