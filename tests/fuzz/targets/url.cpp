// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/upload/url.h"

#include "tests/fuzz/target.h"
#include "tools/text/error.h"

namespace vernier::fuzz {

using namespace vernier::text;
using namespace vernier::upload;
namespace {

void take(Bytes bytes) {
  try {
    const BoardUrl url = parse_url(text_of(bytes));
    expect(!url.scheme.empty() && url.port >= 0 && url.port <= 65535, "an address that is none");
    for (const auto& [name, value] : url.options) url.number(name, 0);
  } catch (const InputError&) {
  }
}

const Registered kTarget("url", take);

}  // namespace
}  // namespace vernier::fuzz
