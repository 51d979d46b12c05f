// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/offline/part_program.h"

#include "tests/fuzz/target.h"
#include "tools/model/machine_reader.h"
#include "tools/offline/positions.h"
#include "tools/text/error.h"

namespace vernier::fuzz {

using namespace vernier::model;
using namespace vernier::offline;
using namespace vernier::text;
namespace {

const Machine& machine() {
  static const Machine kMachine = parse_machine(
      "<machine name=\"m\"><variables><static><k value=\"1e-4\"/></static><machineaxes><X min=\"0\" "
      "max=\"600\"/>"
      "<Y min=\"0\" max=\"400\"/><Z min=\"-300\" max=\"0\"/></machineaxes></variables>"
      "<transforms><sixdof n=\"1\" X=\"X+k*X\" Y=\"Y\" Z=\"Z\"/></transforms></machine>",
      "m.xml");
  return kMachine;
}

/// A part program; or, where it begins with a capital letter X, a list of positions.
void take(Bytes bytes) {
  if (bytes.size() > 4000) return;  // a long move is many solutions
  const std::string text = text_of(bytes);
  const States at = make_states(1, machine().axes.size(), {});
  try {
    Corrector corrector(machine());
    if (!text.empty() && text[0] == 'X') {
      corrected_positions(text, "f.csv", at, corrector);
    } else {
      PartProgramOptions options;
      options.deviation_mm = 0.05;
      options.zero = {0, 0, 0};
      corrected_program(text, "f.ngc", at, {0, 0, 0}, options, corrector);
    }
  } catch (const InputError& error) {
    expect_place(error.what(), "f.");
  }
}

const Registered kTarget("part_program", take);

}  // namespace
}  // namespace vernier::fuzz
