// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/part/measured_part.h"

#include "tests/fuzz/target.h"
#include "tools/text/error.h"

namespace vernier::fuzz {

using namespace vernier::part;
using namespace vernier::text;
namespace {

void take(Bytes bytes) {
  if (bytes.size() > 4000) return;  // each row is a search on both flanks
  try {
    read_measured_part(text_of(bytes), "f.csv");
  } catch (const InputError& error) {
    expect_place(error.what(), "f.csv");
  }
}

const Registered kTarget("measured_part", take);

}  // namespace
}  // namespace vernier::fuzz
