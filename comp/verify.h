// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "comp/compensator.h"

namespace vernier {

/// Reason why a program is not safe to run.
enum class ProgramFault : std::uint8_t {
  kNone = 0,
  kTooLong = 1,   // more registers, lags, axes or inputs than the cycle has memory for
  kChannel = 2,   // channel index, limits, shift or multiplier out of range
  kTable = 3,     // stations not increasing, lengths, reciprocals or grid inconsistent
  kWrap = 4,      // period, reciprocal or shift inconsistent
  kOpCode = 5,    // unknown operation
  kOperand = 6,   // a register that is not written yet, or an index outside
  kShift = 7,     // shift or factor outside the limits of fixed.h
  kOverflow = 8,  // a result that could leave int32
  kLag = 9,       // a state used twice or never
  kOutput = 10,   // output axis, source, shift or limits out of range
};

/// Smallest and largest value that a register can have, for all inputs.
struct ValueRange {
  std::int64_t low = 0;
  std::int64_t high = 0;
};

/// Proves by interval analysis of the integers that no run of the program can overflow, shift wrongly or read
/// outside the memory. ranges: room for kMaxRegisters; receives the range of every register. The verification
/// assumes only that the sizes of the views are correct. Not real-time safe.
ProgramFault verify_program(const Program& program, ValueRange* ranges) noexcept;

/// Returns the work of one tick of a verified program, or of one evaluation of its shares. Unit: about one
/// product of a sum. Instructions, terms, steps of searches, columns, sines and lags are weighted.
/// tests/bench/weights measured the weights. Not real-time safe.
std::uint64_t work_of(const Equation& equation, std::uint32_t channels) noexcept;

/// Returns the number of cache lines (64 bytes) of the tables that one run may read when the caches are
/// empty: the steps of a search that are further apart than a line, and the record found. Not real-time safe.
std::uint64_t lines_of(const Equation& equation) noexcept;

/// True if grid_piece finds every piece from one count after its start to one count before its end. At a
/// station both neighbours have the same value. The segments must be in order. Not real-time safe.
bool grid_finds_every_piece(const ErrorTable& table) noexcept;

/// Computes the ranges of the results of one instruction (results_of many) from the ranges of all earlier
/// registers. The compiler chooses formats with these ranges. `position` is the first register that the
/// instruction writes. Not real-time safe.
ProgramFault range_of(const Equation& equation, const Instruction& step, std::uint32_t position,
                      const ValueRange* ranges, ValueRange* results) noexcept;

}  // namespace vernier
