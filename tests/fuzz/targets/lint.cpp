// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/lint/machine_lint.h"

#include "tests/fuzz/target.h"
#include "tools/lint/lint.h"
#include "tools/lint/measurement_lint.h"
#include "tools/text/error.h"

namespace vernier::fuzz {

using namespace vernier::lint;
using namespace vernier::text;
namespace {

// `lint` tells all that is wrong: it gives findings where others throw.
void take(Bytes bytes) {
  const std::string text = text_of(bytes);
  try {
    if (linted_kind_of(text, "f") == LintedKind::kMachine)
      lint_machine(text, "f");
    else
      lint_measurement(text, "f", nullptr);
  } catch (const InputError& error) {
    expect_place(error.what(), "f");
  }
}

const Registered kTarget("lint", take);

}  // namespace
}  // namespace vernier::fuzz
