// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "comp/equation.h"

namespace vernier {

/// One product of a sum in the dense form of a program. A factor that is a constant of the program is
/// contained in the term.
struct DenseTerm {
  std::int32_t factor;  // constant factor of the product, or the shift of a product of two registers
  std::uint16_t a, b;   // registers
};

/// Memory that the execution of a dense program changes.
struct DenseFrame {
  Word registers[kMaxRegisters] = {};
  LagState* lags = nullptr;
  bool starting = false;
};

struct DenseStep;
/// Executes one step and all steps after the step. `sum`: the sum of products so far. The result is the last
/// sum. Real-time safe.
using DenseRun = std::int64_t (*)(const DenseStep* step, DenseFrame& frame, std::int64_t sum) noexcept;

/// One step of a dense program: the function that executes the step, and its operands.
struct DenseStep {
  union Source {
    const DenseTerm* terms;
    const ErrorTable* table;
    const Wrap* wrap;
  };
  DenseRun run = nullptr;
  Source source{nullptr};
  std::int64_t start = 0;  // start of a sum with half of its last bit, or the factor k of the instruction
  std::uint16_t result = 0, a = 0, b = 0;
  std::uint8_t shift = 0;
};

/// Number of steps and terms of the dense form of an equation.
struct DenseSize {
  std::uint32_t steps = 0, terms = 0;
};

/// Memory for the dense form of an equation: arrays of `size.steps` steps and `size.terms` terms, and the
/// frame. The memory belongs to the caller and must exist longer than its user.
struct DenseMemory {
  DenseStep* steps = nullptr;
  DenseTerm* terms = nullptr;
  DenseFrame* frame = nullptr;
  DenseSize size;
};

/// Returns the memory that make_dense() needs for a VERIFIED equation (comp/verify.h). Not real-time safe.
DenseSize dense_size(const Equation& equation) noexcept;

/// Converts a VERIFIED equation to its dense form. The dense form computes the same registers as
/// run_equation(), to the last bit, with fewer instructions: operands are decoded, constants are contained in
/// the products, and each number of products has its own code. make_dense() also copies the constants to the
/// frame. The tables and wraps of the equation must exist longer than the dense form. Returns false and leaves
/// the memory as it was if the memory is too small. Not real-time safe.
bool make_dense(const Equation& equation, const DenseMemory& memory) noexcept;

/// Executes the dense form of an equation. Before the call, the frame contains the channels, the lags and the
/// flag `starting` (see run_equation). The number of instructions does not depend on the values. Real-time
/// safe.
void run_dense(const DenseMemory& memory) noexcept;

}  // namespace vernier
