// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/fuzz/target.h"
#include "tools/check/history.h"
#include "tools/text/error.h"

namespace vernier::fuzz {

using namespace vernier::check;
using namespace vernier::text;
namespace {

void take(Bytes bytes) {
  try {
    const std::string written = history_text(parse_history(text_of(bytes), "f.json"));
    expect(history_text(parse_history(written, "f.json")) == written, "does not read back the same");
  } catch (const InputError& error) {
    expect_place(error.what(), "f.json");
  }
}

const Registered kTarget("check_history", take);

}  // namespace
}  // namespace vernier::fuzz
