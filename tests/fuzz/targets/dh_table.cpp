// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/create/dh_table.h"

#include "tests/fuzz/target.h"
#include "tools/create/machine_plan.h"
#include "tools/text/error.h"

namespace vernier::fuzz {

using namespace vernier::create;
using namespace vernier::text;
namespace {

void take(Bytes bytes) {
  const std::string text = text_of(bytes);
  try {
    parse_dh_table(text, "f.txt");
  } catch (const InputError& error) {
    expect_place(error.what(), "f.txt");
  }
  try {
    parse_planned_axis(text);
  } catch (const InputError&) {  // an argument, of no file
  }
}

const Registered kTarget("dh_table", take);

}  // namespace
}  // namespace vernier::fuzz
