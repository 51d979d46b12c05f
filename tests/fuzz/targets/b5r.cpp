// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/ballbar/b5r_reader.h"

#include "tests/fuzz/target.h"
#include "tools/format/csv_file.h"
#include "tools/import/ballbar/ballbar_csv.h"

namespace vernier::fuzz {

using namespace vernier::importer;
using namespace vernier::format;
using namespace vernier::text;
namespace {

void take(Bytes bytes) {
  const MemoryFile file(bytes);
  try {
    parse_csv(ballbar_csv({read_b5r(file.path())}, {}).text, file.path());
  } catch (const InputError& error) {
    expect_place(error.what(), file.path());
  }
}

const Registered kTarget("b5r", take);

}  // namespace
}  // namespace vernier::fuzz
