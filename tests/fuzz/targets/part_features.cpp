// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/tolerance/part_features.h"

#include "tests/fuzz/target.h"
#include "tools/text/error.h"

namespace vernier::fuzz {

using namespace vernier::text;
using namespace vernier::tolerance;
namespace {

void take(Bytes bytes) {
  try {
    placed_at(parse_part(text_of(bytes), "f.csv"), Eigen::Isometry3d(Eigen::Translation3d(1, 2, 3)));
  } catch (const InputError& error) {
    expect_place(error.what(), "f.csv");
  }
}

const Registered kTarget("part_features", take);

}  // namespace
}  // namespace vernier::fuzz
