// SPDX-License-Identifier: Apache-2.0
#include "comp/dense.h"

#include "comp/fixed.h"
#include "comp/sine.h"

// Each step ends with a jump to the function of the next step. A compiler that does not promise the jump (no
// optimisation) gets a loop over the steps.
#if defined(__clang__)
#define VERNIER_NEXT(step, frame, sum) [[clang::musttail]] return (step)[1].run((step) + 1, frame, sum)
#define VERNIER_JUMPS 1
#elif defined(__GNUC__) && defined(__OPTIMIZE__)
#define VERNIER_NEXT(step, frame, sum) return (step)[1].run((step) + 1, frame, sum)
#define VERNIER_JUMPS 1
#else
#define VERNIER_NEXT(step, frame, sum) return sum
#define VERNIER_JUMPS 0
#endif

namespace vernier {
namespace {

/// Kinds of products in a sum. A product without shift and with a constant factor needs the fewest
/// instructions.
enum class Kind : std::uint8_t { kScaled, kAdded, kSubtracted, kAddedShifted, kSubtractedShifted };
constexpr std::uint32_t kKindCount = 5;

/// Largest number of products of one step.
constexpr std::uint32_t most_of(Kind kind) noexcept { return kind == Kind::kScaled ? 8 : 4; }

// A register of a frame contains a value that fits int32.
inline std::int32_t narrow_of(const DenseFrame& frame, std::uint16_t index) noexcept {
  return static_cast<std::int32_t>(frame.registers[index]);
}

// Terms are added in another order than in the program: modulo 2^64 the order has no effect on the result.
template <Kind kKind>
inline std::uint64_t added(const DenseTerm& t, const Word* r, std::uint64_t sum) noexcept {
  if constexpr (kKind == Kind::kScaled) return sum + static_cast<std::uint64_t>(product(t.factor, r[t.a]));
  const std::int64_t both = product(r[t.a], r[t.b]);
  if constexpr (kKind == Kind::kAdded) return sum + static_cast<std::uint64_t>(both);
  if constexpr (kKind == Kind::kSubtracted) return sum - static_cast<std::uint64_t>(both);
  const auto part = static_cast<std::uint64_t>(both >> t.factor);
  return kKind == Kind::kAddedShifted ? sum + part : sum - part;
}

template <Kind kKind, std::uint32_t kCount>
inline std::uint64_t all_added(const DenseTerm* t, const Word* r, std::uint64_t sum) noexcept {
  sum = added<kKind>(*t, r, sum);
  if constexpr (kCount > 1) return all_added<kKind, kCount - 1>(t + 1, r, sum);
  return sum;
}

template <Kind kKind, std::uint32_t kCount, bool kFirst, bool kLast>
std::int64_t run_sum(const DenseStep* s, DenseFrame& f, std::int64_t sum) noexcept {
  const std::int64_t before = kFirst ? s->start : sum;
  const auto after = static_cast<std::int64_t>(
      all_added<kKind, kCount>(s->source.terms, f.registers, static_cast<std::uint64_t>(before)));
  if constexpr (kLast) f.registers[s->result] = word_of(after >> s->shift);
  VERNIER_NEXT(s, f, after);
}

template <Kind kKind, std::uint32_t kCount = most_of(kKind)>
DenseRun sum_of(std::uint32_t count, bool first, bool last) noexcept {
  if constexpr (kCount > 1)
    if (count < kCount) return sum_of<kKind, kCount - 1>(count, first, last);
  if (first) return last ? run_sum<kKind, kCount, true, true> : run_sum<kKind, kCount, true, false>;
  return last ? run_sum<kKind, kCount, false, true> : run_sum<kKind, kCount, false, false>;
}

DenseRun sum_of(Kind kind, std::uint32_t count, bool first, bool last) noexcept {
  switch (kind) {
    case Kind::kScaled:
      return sum_of<Kind::kScaled>(count, first, last);
    case Kind::kAdded:
      return sum_of<Kind::kAdded>(count, first, last);
    case Kind::kSubtracted:
      return sum_of<Kind::kSubtracted>(count, first, last);
    case Kind::kAddedShifted:
      return sum_of<Kind::kAddedShifted>(count, first, last);
    default:
      return sum_of<Kind::kSubtractedShifted>(count, first, last);
  }
}

template <OpCode kOp>
inline Word value_of(const DenseStep* s, const DenseFrame& f) noexcept {
  const Word a = f.registers[s->a];
  if constexpr (kOp == OpCode::kAbs) return magnitude(a);
  if constexpr (kOp == OpCode::kSign) return sign_of(a);
  if constexpr (kOp == OpCode::kWrap) return wrapped(*s->source.wrap, static_cast<std::int32_t>(a));
  const Word b = f.registers[s->b];
  if constexpr (kOp == OpCode::kMin) return lower(a, b);
  if constexpr (kOp == OpCode::kMax) return higher(a, b);
  if constexpr (kOp == OpCode::kEqual) return a == b ? 1 : 0;
  if constexpr (kOp == OpCode::kLess) return a < b ? 1 : 0;
}

template <OpCode kOp>
std::int64_t run_value(const DenseStep* s, DenseFrame& f, std::int64_t sum) noexcept {
  f.registers[s->result] = value_of<kOp>(s, f);
  VERNIER_NEXT(s, f, sum);
}

std::int64_t run_sine(const DenseStep* s, DenseFrame& f, std::int64_t) noexcept {
  const SineCosine both =
      sine_cosine(turns_of(narrow_of(f, s->a), static_cast<std::int32_t>(s->start), s->shift));
  Word* const out = f.registers + s->result;
  out[0] = both.sine;
  out[1] = both.cosine;
  VERNIER_NEXT(s, f, 0);
}

std::int64_t run_lag(const DenseStep* s, DenseFrame& f, std::int64_t) noexcept {
  const std::int32_t u = narrow_of(f, s->a);
  LagState& state = f.lags[s->b];
  if (f.starting) start_lag(state, u);
  f.registers[s->result] = step_lag(state, u, static_cast<std::int32_t>(s->start), s->shift);
  VERNIER_NEXT(s, f, 0);
}

std::int64_t run_any_table(const DenseStep* s, DenseFrame& f, std::int64_t) noexcept {
  look_up(*s->source.table, narrow_of(f, s->a), f.registers + s->result);
  VERNIER_NEXT(s, f, 0);
}

template <unsigned kDegree, unsigned kColumns>
std::int64_t run_table(const DenseStep* s, DenseFrame& f, std::int64_t) noexcept {
  look_up<kDegree, kColumns>(*s->source.table, narrow_of(f, s->a), f.registers + s->result);
  VERNIER_NEXT(s, f, 0);
}

DenseRun table_of(const ErrorTable& table) noexcept {
  const bool linear = table.degree == 1;
  if (table.columns == 6) return linear ? run_table<1, 6> : run_table<3, 6>;
  if (table.columns == 1) return linear ? run_table<1, 1> : run_table<3, 1>;
  return run_any_table;
}

std::int64_t run_end(const DenseStep*, DenseFrame&, std::int64_t sum) noexcept { return sum; }

DenseRun value_of(OpCode op) noexcept {
  switch (op) {
    case OpCode::kAbs:
      return run_value<OpCode::kAbs>;
    case OpCode::kMin:
      return run_value<OpCode::kMin>;
    case OpCode::kMax:
      return run_value<OpCode::kMax>;
    case OpCode::kSign:
      return run_value<OpCode::kSign>;
    case OpCode::kEqual:
      return run_value<OpCode::kEqual>;
    case OpCode::kLess:
      return run_value<OpCode::kLess>;
    default:
      return run_value<OpCode::kWrap>;
  }
}

/// Writes steps and terms, or only counts them if there is no memory.
class Writer {
 public:
  Writer(const Equation& equation, const DenseMemory& memory) noexcept : e_(equation), memory_(memory) {}

  DenseSize write() noexcept {
    std::uint32_t result = e_.first_result();
    for (const Instruction& step : e_.instructions) {
      write(step, static_cast<std::uint16_t>(result));
      result += results_of(step, e_.tables);
    }
    add({run_end, {nullptr}, 0, 0, 0, 0, 0});
    return used_;
  }

 private:
  void add(const DenseStep& step) noexcept {
    if (memory_.steps != nullptr) memory_.steps[used_.steps] = step;
    ++used_.steps;
  }
  void add(const DenseTerm& term) noexcept {
    if (memory_.terms != nullptr) memory_.terms[used_.terms] = term;
    ++used_.terms;
  }
  bool is_constant(std::uint16_t index) const noexcept { return index < e_.constants.size; }

  void write(const Instruction& s, std::uint16_t result) noexcept {
    DenseStep step{nullptr, {nullptr}, s.k, result, s.a, s.b, s.shift};
    switch (s.op) {
      case OpCode::kLinear:
        return write_linear(s, result);
      case OpCode::kMultiply: {
        const ProductTerm both{s.a, s.b, 0};
        return write_sum(&both, 1, 1, 0, s.shift, result);
      }
      case OpCode::kDot:
        return write_sum(e_.terms.data + s.l, s.a, std::uint32_t{s.a} + s.b,
                         std::int64_t{s.k} * (std::int64_t{1} << s.c), s.shift, result);
      case OpCode::kLookUp:
        step.source.table = &e_.tables[s.b];
        step.run = table_of(e_.tables[s.b]);
        break;
      case OpCode::kSineCosine:
        step.run = run_sine;
        break;
      case OpCode::kLag:
        step.run = run_lag;
        break;
      case OpCode::kWrap:
        step.source.wrap = &e_.wraps[s.b];
        step.run = value_of(s.op);
        break;
      default:
        step.run = value_of(s.op);
    }
    add(step);
  }

  const DenseTerm* next_term() const noexcept {
    return memory_.terms == nullptr ? nullptr : memory_.terms + used_.terms;
  }

  void write_linear(const Instruction& s, std::uint16_t result) noexcept {
    const std::uint32_t count = s.l == 0 ? 1 : 2;
    add({sum_of(Kind::kScaled, count, true, true), {next_term()}, half_of(s.shift), result, 0, 0, s.shift});
    add(DenseTerm{s.k, s.a, 0});
    if (count == 2) add(DenseTerm{s.l, s.b, 0});
  }

  static std::int64_t half_of(unsigned shift) noexcept { return (std::int64_t{1} << shift) >> 1; }

  /// Kind and dense form of one product.
  struct Known {
    Kind kind;
    DenseTerm term;
  };
  Known known(const ProductTerm& t, bool added) const noexcept {
    if (t.shift != 0)
      return {added ? Kind::kAddedShifted : Kind::kSubtractedShifted, {t.shift, t.a, t.b}};
    const bool first = is_constant(t.a);
    if (first || is_constant(t.b)) {
      const std::int32_t value = e_.constants[first ? t.a : t.b];
      // The negative value of INT32_MIN is no int32.
      if (added || value != INT32_MIN) return {Kind::kScaled, {added ? value : -value, first ? t.b : t.a, 0}};
    }
    return {added ? Kind::kAdded : Kind::kSubtracted, {0, t.a, t.b}};
  }

  void write_sum(const ProductTerm* terms, std::uint32_t plus, std::uint32_t count, std::int64_t constant,
                 std::uint8_t shift, std::uint16_t result) noexcept {
    std::uint32_t left[kKindCount] = {};
    for (std::uint32_t i = 0; i < count; ++i) ++left[static_cast<std::uint32_t>(known(terms[i], i < plus).kind)];
    std::uint32_t open = count;
    for (std::uint32_t k = 0; k < kKindCount; ++k) {
      const Kind kind = static_cast<Kind>(k);
      std::uint32_t room = 0;
      for (std::uint32_t i = 0; i < count; ++i) {
        const Known one = known(terms[i], i < plus);
        if (one.kind != kind) continue;
        if (room == 0) {
          room = lower(left[k], most_of(kind));
          left[k] -= room;
          add({sum_of(kind, room, open == count, open == room), {next_term()}, constant + half_of(shift),
               result, 0, 0, shift});
          open -= room;
        }
        add(one.term);
        --room;
      }
    }
  }

  const Equation& e_;
  const DenseMemory& memory_;
  DenseSize used_;
};

}  // namespace

DenseSize dense_size(const Equation& equation) noexcept { return Writer(equation, {}).write(); }

bool make_dense(const Equation& equation, const DenseMemory& memory) noexcept {
  const DenseSize need = dense_size(equation);
  if (need.steps > memory.size.steps || need.terms > memory.size.terms) return false;
  Writer(equation, memory).write();
  for (std::uint32_t i = 0; i < equation.constants.size; ++i)
    memory.frame->registers[i] = equation.constants[i];
  return true;
}

void run_dense(const DenseMemory& memory) noexcept {
#if VERNIER_JUMPS
  memory.steps->run(memory.steps, *memory.frame, 0);
#else
  std::int64_t sum = 0;
  for (const DenseStep* s = memory.steps; s->run != run_end; ++s) sum = s->run(s, *memory.frame, sum);
#endif
}

}  // namespace vernier
