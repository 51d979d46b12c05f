// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "comp/compensator.h"

namespace vernier {

/// Reason why a program is not safe to execute.
enum class ProgramFault : std::uint8_t {
  kNone = 0,
  kTooLong = 1,   // the program has more registers, lags, axes or inputs than the cycle has memory for
  kChannel = 2,   // channel index, limits, shift or multiplier out of range
  kTable = 3,     // the stations are not increasing, or lengths, reciprocals or the grid are inconsistent
  kWrap = 4,      // period, reciprocal or shift inconsistent
  kOpCode = 5,    // unknown operation
  kOperand = 6,   // an operand is a register that is not yet written, or an index out of range
  kShift = 7,     // shift or factor outside the limits of fixed.h
  kOverflow = 8,  // a result can exceed the range of int32
  kLag = 9,       // the state of a lag is used twice or never
  kOutput = 10,   // output axis, source, shift or limits out of range
};

/// Smallest and largest value that a register can have, for all inputs.
struct ValueRange {
  std::int64_t low = 0;
  std::int64_t high = 0;
};

/// Proves by interval arithmetic with integers that a program cannot overflow, shift by a wrong number or
/// access memory outside its arrays. `ranges`: memory for kMaxRegisters ranges; it receives the range of
/// every register. The proof assumes only that the sizes of the views are correct. Not real-time safe.
ProgramFault verify_program(const Program& program, ValueRange* ranges) noexcept;

/// Returns the work of one tick of a verified program, or of one evaluation of its shares. The unit of this
/// work is about one product in a sum of products. Instructions, terms, steps of searches, columns, sines and
/// lags have different weights, which were measured (tests/bench/weights). Not real-time safe.
std::uint64_t work_of(const Equation& equation, std::uint32_t channels) noexcept;

/// Returns the number of cache lines (64 bytes) of the tables that one execution may read if the caches are
/// empty. The counted cache lines are the steps of a search that are more than a cache line apart, and the
/// record that is found. Not real-time safe.
std::uint64_t lines_of(const Equation& equation) noexcept;

/// True if grid_piece finds every segment of the table, from one count after its start to one count before
/// its end. At a station both neighbouring segments have the same value. The segments must be in increasing
/// order. Not real-time safe.
bool grid_finds_every_piece(const ErrorTable& table) noexcept;

/// Computes the ranges of all results of one instruction (results_of) from the ranges of all earlier
/// registers. The compiler uses these ranges to select number formats. `position` is the first register that
/// the instruction writes. Not real-time safe.
ProgramFault range_of(const Equation& equation, const Instruction& step, std::uint32_t position,
                      const ValueRange* ranges, ValueRange* results) noexcept;

}  // namespace vernier
