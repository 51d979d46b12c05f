// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware/daemon/settings/calibration.h"

#include "firmware/daemon/settings/key_file.h"
#include "tests/fuzz/target.h"

namespace vernier::fuzz {
namespace {

/// The short files of a board: points of an output's calibration, a public key.
void take(Bytes bytes) {
  const MemoryFile file(bytes);
  try {
    read_calibration_points(file.path(), false);
  } catch (const BoardError& error) {
    expect_place(error.what, file.path());
  }
  try {
    read_public_key(file.path());
  } catch (const BoardError& error) {
    expect_place(error.what, file.path());
  }
}

const Registered kTarget("calibration", take);

}  // namespace
}  // namespace vernier::fuzz
