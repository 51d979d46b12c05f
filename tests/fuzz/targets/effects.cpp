// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/fuzz/target.h"
#include "tools/effects/catalogue.h"
#include "tools/text/error.h"

namespace vernier::fuzz {

using namespace vernier::effects;
using namespace vernier::text;
namespace {

void take(Bytes bytes) {
  try {
    parse_effects(text_of(bytes), "f.txt");
  } catch (const InputError& error) {
    expect_place(error.what(), "f.txt");
  }
}

const Registered kTarget("effects", take);

}  // namespace
}  // namespace vernier::fuzz
