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
  const union DenseCell* next = nullptr;  // next step, if the steps are executed by a loop
};

union DenseCell;
/// Executes one step of a dense program and all steps after the step. `at`: first cell of the step; `sum`:
/// the sum of products so far. The result is the sum after the last step. Real-time safe.
using DenseRun = std::int64_t (*)(const DenseCell* at, DenseFrame& frame, std::int64_t sum) noexcept;

/// Registers and shift of one step. The step writes its results to the registers from `result` on.
struct DensePlace {
  std::uint16_t result, a, b;
  std::uint8_t shift;
};

/// One cell of a dense program. A step has three cells and one cell for each product: the function that
/// executes the step, its registers, its source, the terms of its products.
union DenseCell {
  std::int64_t start = 0;   // source: start of a sum with half of its last bit, or the factor k
  const ErrorTable* table;  // source
  const Wrap* wrap;         // source
  DenseRun run;
  DensePlace place;
  DenseTerm term;
};

/// Memory for the dense form of an equation. The memory belongs to the caller and must exist longer than its
/// user.
struct DenseMemory {
  DenseCell* cells = nullptr;
  std::uint32_t size = 0;  // number of cells
  DenseFrame* frame = nullptr;
};

/// Returns the number of cells that make_dense() needs for a VERIFIED equation (comp/verify.h). Not real-time
/// safe.
std::uint32_t dense_size(const Equation& equation) noexcept;

/// Converts a VERIFIED equation to its dense form. The dense form computes the same registers as
/// run_equation(), to the last bit, with fewer instructions: operands are decoded, constants are contained in
/// the products, and each number of products has its own code. make_dense() also copies the constants to the
/// frame. The tables and wraps of the equation must exist longer than the dense form. Returns false and
/// leaves the memory as it was if the memory is too small. Not real-time safe.
bool make_dense(const Equation& equation, const DenseMemory& memory) noexcept;

/// Executes the dense form of an equation. Before the call, the frame contains the channels, the lags and the
/// flag `starting` (see run_equation). The number of instructions does not depend on the values. Real-time
/// safe.
void run_dense(const DenseMemory& memory) noexcept;

}  // namespace vernier
