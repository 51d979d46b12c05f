// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/fuzz/target.h"
#include "tools/exchange/component_csv.h"
#include "tools/exchange/screw_comp.h"
#include "tools/model/machine_reader.h"
#include "tools/text/error.h"

namespace vernier::fuzz {

using namespace vernier::exchange;
using namespace vernier::model;
using namespace vernier::text;
namespace {

const Machine& machine() {
  static const Machine kMachine = parse_machine(
      "<machine name=\"m\"><variables><machineaxes><X min=\"0\" max=\"600\"/><Y min=\"0\" max=\"400\"/>"
      "</machineaxes></variables><transforms><sixdof n=\"1\" X=\"X\" Y=\"Y\"/></transforms></machine>",
      "m.xml");
  return kMachine;
}

template <class Read>
void refused_or_read(const Read& read) {
  try {
    read();
  } catch (const InputError& error) {
    expect_place(error.what(), "f.txt");
  }
}

/// Tables of other controllers.
void take(Bytes bytes) {
  const std::string text = text_of(bytes);
  refused_or_read([&] { parse_axis_csv(text, "f.txt", machine()); });
  refused_or_read([&] { parse_isg_csv(text, "f.txt", machine()); });
  refused_or_read([&] { parse_screw(text, "f.txt", ScrewType::kActual); });
  refused_or_read([&] { parse_screw(text, "f.txt", ScrewType::kTrim); });
}

const Registered kTarget("tables", take);

}  // namespace
}  // namespace vernier::fuzz
