// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <map>
#include <string>
#include <vector>

#include "comp/shares.h"
#include "tools/compile/derive.h"
#include "tools/compile/functions.h"

namespace vernier::compile {

/// Where an error of the fixed-point program comes from.
enum class ErrorSource : std::uint8_t { kRounding, kTable, kFunction, kChannel, kLag };
constexpr std::size_t kErrorSourceCount = 5;  // of ErrorSource
const char* name_of(ErrorSource source);

/// What the compiler knows about one register: format, range and where its error comes from. The value it
/// stands for is count / 2^fraction_bits in the unit of the machine file.
struct Register {
  std::string name;  // unique, a C++ identifier
  int fraction_bits = 0;
  Interval range;        // of the exact value
  double error = 0;      // bound of |register - exact value|, same unit
  double own_error = 0;  // the part that arises in this register
  ErrorSource source = ErrorSource::kRounding;
  bool given = false;  // what uses it is meant for the value that it has: its error does not go on
  struct Use {
    std::uint32_t from;
    double gain;  // |d this / d from| at most
  };
  std::vector<Use> uses;
};

/// A table of the program, owned (comp/error_table.h says what its records hold).
struct LoweredTable {
  std::string name;
  std::uint16_t columns = 0, degree = 1;
  std::uint32_t pieces = 0;
  std::uint32_t grid_multiplier = 0, grid_shift = 0;
  std::vector<std::int32_t> records;

  ErrorTable view() const { return {records.data(), pieces, columns, degree, grid_multiplier, grid_shift}; }
};

/// A fixed-point program with its stores, owned.
struct LoweredProgram {
  std::vector<std::int32_t> constants;
  std::vector<Channel> channels;
  std::vector<Instruction> instructions;
  std::vector<ProductTerm> terms;
  std::vector<LoweredTable> tables;
  std::vector<Wrap> wraps;
  std::vector<Output> outputs;
  std::uint32_t lag_count = 0;
  std::vector<Register> registers;              // one per constant, channel and result
  std::map<NodeId, std::uint32_t> register_of;  // of the nodes that have one
  std::vector<ValueRange> ranges;               // of the registers, as the verifier proves them

  std::uint32_t first_result() const {
    return static_cast<std::uint32_t>(constants.size() + channels.size());
  }
  std::uint32_t results_of(const Instruction& step) const {
    return step.op == OpCode::kLookUp ? tables[step.b].columns : step.op == OpCode::kSineCosine ? 2u : 1u;
  }
};

/// The shares of the effects in the corrections: an equation whose channels are registers of the tick.
struct LoweredShares {
  std::vector<std::int32_t> constants;
  std::vector<std::uint16_t> sources;
  std::vector<Instruction> instructions;
  std::vector<ProductTerm> terms;
  std::vector<Share> shares;
  std::vector<std::string> names;  // one per share: the effect's
  std::vector<double> largest;     // |share| at most, mm or deg
  std::size_t left_out = 0;        // shares that the image has no room for
};

/// Chooses formats by interval analysis and writes the straight-line program with a proved error bound per
/// register. tick_us: the cycle time for lags and slew limits. Throws InputError where a format or the size
/// does not suffice. tool.
LoweredProgram lower(const model::Machine& machine, const Derivation& derivation, std::uint32_t tick_us);

/// The shares of derivation.parts, computed from the registers of `tick` (the same derivation, lowered).
/// tool.
LoweredShares lower_shares(const model::Machine& machine, const Derivation& derivation,
                           const LoweredProgram& tick);

}  // namespace vernier::compile
