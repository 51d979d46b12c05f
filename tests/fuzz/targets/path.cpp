// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulate/path.h"

#include <cmath>

#include "tests/fuzz/target.h"
#include "tools/text/error.h"

namespace vernier::fuzz {

using namespace vernier::format;
using namespace vernier::model;
using namespace vernier::simulate;
using namespace vernier::text;
namespace {

void take(Bytes bytes) {
  try {
    const Path path(text_of(bytes), "f.csv");
    if (path.has("X")) path.numbers("X", Dimension::kLength);
    const Column& time = path.time();
    if (time.size() > 0 && std::abs(time[time.size() - 1] - time[0]) < 10) ticks_of(path, 0.001);
  } catch (const InputError& error) {
    expect_place(error.what(), "f.csv");
  }
}

const Registered kTarget("path", take);

}  // namespace
}  // namespace vernier::fuzz
