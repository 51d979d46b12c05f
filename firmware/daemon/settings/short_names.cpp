// SPDX-License-Identifier: Apache-2.0
#include "firmware/daemon/settings/short_names.h"

#include "firmware/daemon/settings/units.h"
#include "hal/support/register_block.h"

namespace vernier {
namespace {

constexpr std::int64_t kLastRegister = 65535;
/// Of a block: sequence number, valid bits and one value.
constexpr std::int64_t kLastBlock = kLastRegister - RegisterBlock::kValues - 1;

}  // namespace

void use_short_names(SignalSource& output, double max_correction) {
  if ((output.kind == "modbus" || output.kind == "canopen") && !output.numbers.contains("range") &&
      !output.texts.contains("range"))
    output.numbers["range"] = max_correction;
  if (output.kind != "modbus") return;
  output.only({"address", "port", "device", "baud", "parity", "unit", "register", "scale", "sequence",
               "valid", "echo", "range", "polarity", "period_ms", "timeout_ms", "delay_ms"});
  const std::int64_t value = output.whole("register", 0, kLastRegister - 1);
  const std::int64_t sequence = output.whole("sequence", 0, kLastBlock);
  const std::int64_t valid = output.whole("valid", sequence + 1, 0, kLastRegister);
  const double scale = output.number("scale");
  if (!(scale > 0 && scale <= 1e6)) output.fail_at("scale", "scale must be above 0, and at most 1e6 um");
  // One request writes all registers, so that the controller never reads a new value with an old number.
  if (valid != sequence + RegisterBlock::kValid - RegisterBlock::kSequence)
    output.fail_at("valid", "valid must be the register after sequence (" + std::to_string(sequence + 1) +
                                "): the board writes one block");
  const std::int64_t after = value - sequence - RegisterBlock::kValues, place = after / 2;
  if (after < 0 || after % 2 != 0 || place >= RegisterBlock::kPlaces)
    output.fail_at("register", "register must be sequence + 2 + 2 * n, n from 0 to " +
                                   std::to_string(RegisterBlock::kPlaces - 1) +
                                   ": a value has two registers of the block that begins at sequence");
  output.kind = "modbus-out";
  output.numbers.erase("sequence"), output.numbers.erase("valid"), output.numbers.erase("scale");
  output.numbers["register"] = static_cast<double>(sequence);
  output.numbers["place"] = static_cast<double>(place);
  output.numbers["resolution"] = scale * kMmPerUm;
}

}  // namespace vernier
