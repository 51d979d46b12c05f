// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/ballbar/trace_reader.h"

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
    TraceSetup setup;
    setup.feed_mm_min = 1000;
    parse_csv(ballbar_csv({read_ballbar_trace(file.path(), setup)}, {}).text, file.path());
  } catch (const InputError& error) {
    expect_place(error.what(), file.path());
  }
}

const Registered kTarget("trace", take);

}  // namespace
}  // namespace vernier::fuzz
