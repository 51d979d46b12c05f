// SPDX-License-Identifier: Apache-2.0
#include "comp/equation.h"

#include "comp/fixed.h"
#include "comp/sine.h"

namespace vernier {
namespace {

Word run_lag(const Instruction& step, Word u, LagState* lags, bool starting) noexcept {
  LagState& state = lags[step.b];
  if (starting) start_lag(state, static_cast<std::int32_t>(u));
  return step_lag(state, static_cast<std::int32_t>(u), step.k, step.shift);
}

Word run_dot(const Instruction& step, const ProductTerm* terms, const std::int32_t* r) noexcept {
  std::int64_t sum = std::int64_t{step.k} * (std::int64_t{1} << step.c);
  const ProductTerm* t = terms + step.l;
  for (const ProductTerm* const end = t + step.a; t != end; ++t) sum += product(r[t->a], r[t->b]) >> t->shift;
  for (const ProductTerm* const end = t + step.b; t != end; ++t) sum -= product(r[t->a], r[t->b]) >> t->shift;
  return word_of(round_shift(sum, step.shift));
}

// The verifier has tested every operation code: the switch below needs no check.
inline void never_reached() noexcept {
#if defined(__GNUC__)
  __builtin_unreachable();
#endif
}

}  // namespace

void run_equation(const Equation& equation, std::int32_t* registers, LagState* lags, bool starting) noexcept {
  const std::int32_t* const r = registers;
  const ProductTerm* const terms = equation.terms.data;
  std::int32_t* out = registers + equation.first_result();
  for (const Instruction& step : equation.instructions) {
    Word result = 0;
    switch (step.op) {
      case OpCode::kLinear:
        result = linear(r[step.a], step.k, r[step.b], step.l, step.shift);
        break;
      case OpCode::kMultiply:
        result = multiply(r[step.a], r[step.b], step.shift);
        break;
      case OpCode::kDot:
        result = run_dot(step, terms, r);
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
      case OpCode::kLookUp:
        look_up(equation.tables[step.b], r[step.a], out);
        out += equation.tables[step.b].columns;
        continue;
      case OpCode::kSineCosine: {
        const SineCosine both = sine_cosine(turns_of(r[step.a], step.k, step.shift));
        *out++ = both.sine;
        result = both.cosine;
        break;
      }
      case OpCode::kLag:
        result = run_lag(step, r[step.a], lags, starting);
        break;
      default:
        never_reached();
    }
    *out++ = static_cast<std::int32_t>(result);
  }
}

}  // namespace vernier
