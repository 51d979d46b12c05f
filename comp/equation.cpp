// SPDX-License-Identifier: Apache-2.0
#include "comp/equation.h"

#include "comp/fixed.h"

namespace vernier {
namespace {

std::int32_t run_lag(const Instruction& step, std::int32_t u, LagState* lags, bool starting) noexcept {
  LagState& state = lags[step.b];
  if (starting) start_lag(state, u);
  return step_lag(state, u, step.k, step.shift);
}

}  // namespace

void run_equation(const Equation& equation, std::int32_t* registers, LagState* lags, bool starting) noexcept {
  const std::int32_t* const r = registers;
  std::int32_t* out = registers + equation.first_result();
  for (const Instruction& step : equation.instructions) {
    std::int32_t result = 0;
    switch (step.op) {
      case OpCode::kLinear:
        result = linear(r[step.a], step.k, r[step.b], step.l, step.shift);
        break;
      case OpCode::kMultiply:
        result = multiply(r[step.a], r[step.b], step.shift);
        break;
      case OpCode::kMultiplyAdd:
        result = multiply_add(r[step.a], r[step.b], r[step.c], step.k, step.shift);
        break;
      case OpCode::kAbs:
        result = magnitude(r[step.a]);
        break;
      case OpCode::kMin:
        result = lower(r[step.a], r[step.b]);
        break;
      case OpCode::kMax:
        result = higher(r[step.a], r[step.b]);
        break;
      case OpCode::kSign:
        result = sign_of(r[step.a]);
        break;
      case OpCode::kEqual:
        result = r[step.a] == r[step.b] ? 1 : 0;
        break;
      case OpCode::kLess:
        result = r[step.a] < r[step.b] ? 1 : 0;
        break;
      case OpCode::kWrap:
        result = wrapped(equation.wraps[step.b], r[step.a]);
        break;
      case OpCode::kSegment:
        result = static_cast<std::int32_t>(segment_of(equation.tables[step.b], r[step.a]));
        break;
      case OpCode::kFraction:
        result = fraction_in(equation.tables[step.b][static_cast<std::uint32_t>(r[step.c])], r[step.a]);
        break;
      case OpCode::kLinearColumn: {
        const std::int32_t* const near = equation.columns[step.b].data + r[step.c];
        result = linear_between(near[0], near[1], r[step.a]);
        break;
      }
      case OpCode::kCubicColumn:
        result = cubic_between(equation.columns[step.b].data + std::ptrdiff_t{4} * r[step.c], r[step.a]);
        break;
      case OpCode::kLag:
        result = run_lag(step, r[step.a], lags, starting);
        break;
    }
    *out++ = result;
  }
}

}  // namespace vernier
