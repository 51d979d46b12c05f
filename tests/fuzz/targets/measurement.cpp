// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/model/measurement.h"

#include <cmath>

#include "tests/fuzz/target.h"
#include "tools/model/machine_reader.h"
#include "tools/text/error.h"

namespace vernier::fuzz {

using namespace vernier::model;
using namespace vernier::text;
namespace {

const Machine& machine() {
  static const Machine kMachine = parse_machine(
      "<machine name=\"m\"><variables><static><k value=\"1\"/><BaseShift run=\"a\" X=\"1\"/></static>"
      "<machineaxes><X min=\"0\" max=\"600\"/><C rotary=\"true\" rollover=\"true\"/></machineaxes>"
      "<inputs><T unit=\"degC\" reference=\"20\"/></inputs></variables>"
      "<transforms><sixdof n=\"1\" X=\"X*k\" rZ=\"C+lag(T,30)\"/></transforms></machine>",
      "m.xml");
  return kMachine;
}

void take(Bytes bytes) {
  try {
    const Measurement m = parse_measurement(text_of(bytes), "f.csv", machine());
    for (const Observation& o : m.observations)
      expect(std::isfinite(o.value), "a reading that is not finite");
  } catch (const InputError& error) {
    expect_place(error.what(), "f.csv");
  }
}

const Registered kTarget("measurement", take);

}  // namespace
}  // namespace vernier::fuzz
