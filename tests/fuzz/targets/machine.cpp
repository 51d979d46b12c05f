// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/model/machine.h"

#include "tests/fuzz/target.h"
#include "tools/model/machine_reader.h"
#include "tools/model/machine_writer.h"
#include "tools/text/error.h"

namespace vernier::fuzz {

using namespace vernier::model;
using namespace vernier::text;
namespace {

void take(Bytes bytes) {
  const std::string text = text_of(bytes);
  try {
    const Machine machine = parse_machine(text, "f.xml");
    const Machine again = parse_machine(update_machine_text(text, machine, false), "f.xml");
    expect(machine.statics.size() == again.statics.size(), "does not read back the same");
    for (std::size_t i = 0; i < machine.statics.size(); ++i)
      expect(machine.statics[i].value == again.statics[i].value, "a value does not read back the same");
  } catch (const InputError& error) {
    expect_place(error.what(), "f.xml");
  }
}

const Registered kTarget("machine", take);

}  // namespace
}  // namespace vernier::fuzz
