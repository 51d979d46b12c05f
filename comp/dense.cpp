// SPDX-License-Identifier: Apache-2.0
#include "comp/dense.h"

#include "comp/fixed.h"
#include "comp/sine.h"
#include "comp/three_tables.h"

// Each step ends with a jump to the function of the next step, so that a step needs no loop, no call and no
// return. A compiler that does not promise the jump (g++ without optimisation, clang with exceptions) gets a
// loop over the steps. VERNIER_HIDDEN hides from the compiler how a value was computed. A hidden address of
// the next step gives one addition and the jump through memory.
#ifdef VERNIER_LOOPS  // for the test of the loop
#define VERNIER_JUMPS 0
#elif defined(__clang__) ? !defined(__EXCEPTIONS) : defined(__GNUC__) && defined(__OPTIMIZE__)
#define VERNIER_JUMPS 1
#else
#define VERNIER_JUMPS 0
#endif
#if defined(__GNUC__)
#define VERNIER_HIDDEN(value) __asm__("" : "+r"(value))
#else
#define VERNIER_HIDDEN(value) static_cast<void>(value)
#endif
#if !VERNIER_JUMPS
#define VERNIER_NEXT(at, count, frame, sum) \
  (frame).next = (at) + (count);            \
  return sum
#elif defined(__clang__)
#define VERNIER_NEXT(at, count, frame, sum) \
  (at) += (count);                          \
  VERNIER_HIDDEN(at);                       \
  [[clang::musttail]] return (at)->run(at, frame, sum)
#else
#define VERNIER_NEXT(at, count, frame, sum) \
  (at) += (count);                          \
  VERNIER_HIDDEN(at);                       \
  return (at)->run(at, frame, sum)
#endif

namespace vernier {
namespace {

/// Kinds of products in a sum. A product without shift and with a constant factor needs the fewest
/// instructions.
enum class Kind : std::uint8_t { kScaled, kAdded, kSubtracted, kAddedShifted, kSubtractedShifted };
constexpr Kind kLastKind = Kind::kSubtractedShifted;
constexpr std::uint32_t kKindCount = static_cast<std::uint32_t>(kLastKind) + 1;

/// True for a small target: fewer functions, for which a program needs more steps.
constexpr bool kSmall = sizeof(void*) < 8 || VERNIER_JUMPS == 0;

/// Largest number of products of one step.
constexpr std::uint32_t most_of(Kind kind) noexcept {
  return kind == Kind::kScaled ? (kSmall ? 4 : 8) : (kSmall ? 2 : 4);
}

// Cells of a step.
constexpr std::uint32_t kPlace = 1, kSource = 2, kTerms = 3;
constexpr std::uint32_t kLowest = 2, kHighest = 3;  // of a step with limits

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
inline std::uint64_t all_added(const DenseCell* t, const Word* r, std::uint64_t sum) noexcept {
  sum = added<kKind>(t->term, r, sum);
  if constexpr (kCount > 1) return all_added<kKind, kCount - 1>(t + 1, r, sum);
  return sum;
}

template <Kind kFirst, Kind... kMore>
inline std::uint64_t each_added(const DenseCell* t, const Word* r, std::uint64_t sum) noexcept {
  sum = added<kFirst>(t->term, r, sum);
  if constexpr (sizeof...(kMore) > 0) return each_added<kMore...>(t + 1, r, sum);
  return sum;
}

/// Shifts the sum and writes the result.
inline std::int64_t finished(const DenseCell* at, DenseFrame& f, std::uint64_t sum) noexcept {
  const std::int64_t result = static_cast<std::int64_t>(sum) >> at[kPlace].place.shift;
  f.registers[at[kPlace].place.result] = word_of(result);
  return result;
}

/// Part of a sum: products of one kind.
template <Kind kKind, std::uint32_t kCount, bool kFirst, bool kLast>
std::int64_t run_part(const DenseCell* at, DenseFrame& f, std::int64_t sum) noexcept {
  const std::int64_t before = kFirst ? at[kSource].start : sum;
  const std::uint64_t after =
      all_added<kKind, kCount>(at + kTerms, f.registers, static_cast<std::uint64_t>(before));
  sum = kLast ? finished(at, f, after) : static_cast<std::int64_t>(after);
  VERNIER_NEXT(at, kTerms + kCount, f, sum);
}

/// A whole sum of few products.
template <Kind... kKinds>
std::int64_t run_whole(const DenseCell* at, DenseFrame& f, std::int64_t sum) noexcept {
  sum = finished(
      at, f, each_added<kKinds...>(at + kTerms, f.registers, static_cast<std::uint64_t>(at[kSource].start)));
  VERNIER_NEXT(at, kTerms + sizeof...(kKinds), f, sum);
}

/// Largest number of products in a sum that one step computes for every combination of kinds.
constexpr std::uint32_t kMostWhole = kSmall ? 2 : 3;

// The kinds increase: each combination of kinds has one function.
template <Kind kLeast, Kind... kKinds>
DenseRun whole_of(const Kind* kinds, std::uint32_t count) noexcept {
  constexpr std::uint32_t kKnown = sizeof...(kKinds);
  if constexpr (kKnown == kMostWhole) {
    return run_whole<kKinds...>;
  } else {
    if constexpr (kKnown > 0)
      if (count == kKnown) return run_whole<kKinds...>;
    if constexpr (kLeast == kLastKind) {
      return whole_of<kLeast, kKinds..., kLeast>(kinds, count);
    } else {
      constexpr Kind kNext = static_cast<Kind>(static_cast<std::uint8_t>(kLeast) + 1);
      return kinds[kKnown] == kLeast ? whole_of<kLeast, kKinds..., kLeast>(kinds, count)
                                     : whole_of<kNext, kKinds...>(kinds, count);
    }
  }
}

template <Kind kKind, std::uint32_t kCount = most_of(kKind)>
DenseRun part_of(std::uint32_t count, bool first, bool last) noexcept {
  if constexpr (kCount > 1)
    if (count < kCount) return part_of<kKind, kCount - 1>(count, first, last);
  if (first) return last ? run_part<kKind, kCount, true, true> : run_part<kKind, kCount, true, false>;
  return last ? run_part<kKind, kCount, false, true> : run_part<kKind, kCount, false, false>;
}

DenseRun part_of(Kind kind, std::uint32_t count, bool first, bool last) noexcept {
  switch (kind) {
    case Kind::kScaled:
      return part_of<Kind::kScaled>(count, first, last);
    case Kind::kAdded:
      return part_of<Kind::kAdded>(count, first, last);
    case Kind::kSubtracted:
      return part_of<Kind::kSubtracted>(count, first, last);
    case Kind::kAddedShifted:
      return part_of<Kind::kAddedShifted>(count, first, last);
    default:
      return part_of<Kind::kSubtractedShifted>(count, first, last);
  }
}

template <OpCode kOp>
inline Word value_of(const DenseCell* at, const DenseFrame& f) noexcept {
  const DensePlace& place = at[kPlace].place;
  const Word a = f.registers[place.a];
  if constexpr (kOp == OpCode::kAbs) return magnitude(a);
  if constexpr (kOp == OpCode::kSign) return sign_of(a);
  if constexpr (kOp == OpCode::kWrap) return wrapped(*at[kSource].wrap, static_cast<std::int32_t>(a));
  const Word b = f.registers[place.b];
  if constexpr (kOp == OpCode::kMin) return lower(a, b);
  if constexpr (kOp == OpCode::kMax) return higher(a, b);
  if constexpr (kOp == OpCode::kEqual) return a == b ? 1 : 0;
  if constexpr (kOp == OpCode::kLess) return a < b ? 1 : 0;
}

template <OpCode kOp>
std::int64_t run_value(const DenseCell* at, DenseFrame& f, std::int64_t sum) noexcept {
  f.registers[at[kPlace].place.result] = value_of<kOp>(at, f);
  VERNIER_NEXT(at, kTerms, f, sum);
}

/// Value limited by two constants: kMax, then kMin. `kOfSum`: the value is the result of the step before, a
/// sum.
template <bool kOfSum>
std::int64_t run_limits(const DenseCell* at, DenseFrame& f, std::int64_t sum) noexcept {
  const std::int64_t value = kOfSum ? sum : f.registers[at[kPlace].place.a];
  const std::int64_t above = higher(value, at[kLowest].start);
  const std::int64_t within = lower(above, at[kHighest].start);
  Word* const out = f.registers + at[kPlace].place.result;
  out[0] = word_of(above);
  out[1] = word_of(within);
  VERNIER_NEXT(at, kHighest + 1, f, within);
}

std::int64_t run_sine(const DenseCell* at, DenseFrame& f, std::int64_t) noexcept {
  const DensePlace& place = at[kPlace].place;
  const SineCosine both =
      sine_cosine(turns_of(narrow_of(f, place.a), static_cast<std::int32_t>(at[kSource].start), place.shift));
  Word* const out = f.registers + place.result;
  out[0] = both.sine;
  out[1] = both.cosine;
  VERNIER_NEXT(at, kTerms, f, 0);
}

std::int64_t run_lag(const DenseCell* at, DenseFrame& f, std::int64_t) noexcept {
  const DensePlace& place = at[kPlace].place;
  const std::int32_t u = narrow_of(f, place.a);
  LagState& state = f.lags[place.b];
  if (f.starting) start_lag(state, u);
  f.registers[place.result] = step_lag(state, u, static_cast<std::int32_t>(at[kSource].start), place.shift);
  VERNIER_NEXT(at, kTerms, f, 0);
}

std::int64_t run_any_table(const DenseCell* at, DenseFrame& f, std::int64_t) noexcept {
  const DensePlace& place = at[kPlace].place;
  look_up(*at[kSource].table, narrow_of(f, place.a), f.registers + place.result);
  VERNIER_NEXT(at, kTerms, f, 0);
}

// Columns one after another: four columns in vectors of 128 bits need more instructions, because SSE2 has no
// signed product and no signed shift of 64 bits.
template <unsigned kDegree, unsigned kColumns>
inline void columns(const std::int32_t* c, std::int64_t fraction, Word* out) noexcept {
  Word value = kDegree == 1 ? linear_between(c, fraction) : cubic_between(c, fraction);
  VERNIER_HIDDEN(value);
  *out = value;
  if constexpr (kColumns > 1) columns<kDegree, kColumns - 1>(c + kDegree + 1, fraction, out + 1);
}

template <unsigned kDegree, unsigned kColumns, bool kGrid>
std::int64_t run_table(const DenseCell* at, DenseFrame& f, std::int64_t) noexcept {
  const DensePlace& place = at[kPlace].place;
  const ErrorTable& table = *at[kSource].table;
  const std::int32_t held = higher(narrow_of(f, place.a), table.records[0]);
  const std::uint32_t piece = kGrid ? grid_piece(table, held) : searched_piece(table, held);
  const std::int32_t* const record =
      table.records + std::size_t{piece} * (kSegmentWords + kColumns * (kDegree + 1));
  columns<kDegree, kColumns>(record + kSegmentWords, fraction_in(segment_at(record), held),
                             f.registers + place.result);
  VERNIER_NEXT(at, kTerms, f, 0);
}

template <unsigned kDegree, unsigned kColumns>
DenseRun table_of(const ErrorTable& table) noexcept {
  return table.grid_multiplier != 0 ? run_table<kDegree, kColumns, true>
                                    : run_table<kDegree, kColumns, false>;
}
DenseRun table_of(const ErrorTable& table) noexcept {
  const bool linear = table.degree == 1;
  if (table.columns == 6) return linear ? table_of<1, 6>(table) : table_of<3, 6>(table);
  if (table.columns == 1) return linear ? table_of<1, 1>(table) : table_of<3, 1>(table);
  return run_any_table;
}

#if VERNIER_THREE_TABLES
std::int64_t run_three_tables(const DenseCell* at, DenseFrame& f, std::int64_t) noexcept {
  const DensePlace& place = at[kPlace].place;
  const Word* const r = f.registers;
  const Word last = r[at[kSource].term.a];
  look_up_three(at + kTerms, lanes::Int4{r[place.a], r[place.b], last, last}, f.registers + place.result);
  VERNIER_NEXT(at, kTerms + kThreeWords, f, 0);
}
#endif

std::int64_t run_end(const DenseCell*, DenseFrame&, std::int64_t sum) noexcept { return sum; }

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

/// Writes the cells, or only counts them if there is no memory.
class Writer {
 public:
  Writer(const Equation& equation, DenseCell* cells) noexcept : e_(equation), cells_(cells) {}

  /// Returns the number of cells.
  std::uint32_t write() noexcept {
    std::uint32_t result = e_.first_result();
    for (std::uint32_t i = 0; i < e_.instructions.size;) {
      const std::uint32_t end = i + write_from(i, static_cast<std::uint16_t>(result));
      for (; i < end; ++i) result += results_of(e_.instructions[i], e_.tables);
    }
    add([](DenseCell& cell) { cell.run = run_end; });
    return used_;
  }

 private:
  /// Kind and dense form of one product.
  struct Product {
    Kind kind;
    DenseTerm term;
  };

  template <class Set>
  void add(Set set) noexcept {
    if (cells_ != nullptr) set(cells_[used_]);
    ++used_;
  }
  void add_head(DenseRun run, const DensePlace& place) noexcept {
    add([&](DenseCell& cell) { cell.run = run; });
    add([&](DenseCell& cell) { cell.place = place; });
  }
  void add_start(std::int64_t start) noexcept {
    add([&](DenseCell& cell) { cell.start = start; });
  }
  void add_term(const DenseTerm& term) noexcept {
    add([&](DenseCell& cell) { cell.term = term; });
  }

  // Writes the step that begins with instruction i; returns its number of instructions.
  std::uint32_t write_from(std::uint32_t i, std::uint16_t result) noexcept {
    const Instruction* const s = e_.instructions.data + i;
    const std::uint32_t left = e_.instructions.size - i;
#if VERNIER_THREE_TABLES
    if (left >= 3 && are_three_tables(s, result)) {
      write_three_tables(s, result);
      return 3;
    }
#endif
    if (left >= 2 && are_limits(s[0], s[1], result)) {
      write_limits(s[0], s[1], result, i > 0 && is_sum(e_.instructions[i - 1]));
      return 2;
    }
    write(*s, result);
    return 1;
  }

#if VERNIER_THREE_TABLES
  // No position of the three may be a result of the three.
  bool are_three_tables(const Instruction* s, std::uint16_t result) const noexcept {
    for (int i = 0; i < 3; ++i)
      if (s[i].op != OpCode::kLookUp || s[i].a >= result || !may_be_of_three(e_.tables[s[i].b])) return false;
    return true;
  }
  void write_three_tables(const Instruction* s, std::uint16_t result) noexcept {
    add_head(run_three_tables, {result, s[0].a, s[1].a, 0});
    add_term({0, s[2].a, 0});
    const ThreeTables three = three_tables(e_.tables[s[0].b], e_.tables[s[1].b], e_.tables[s[2].b]);
    const std::int64_t* const parts[] = {three.first, three.multiplier, three.shift, three.last,
                                         three.records};
    for (const std::int64_t* const part : parts)
      for (int i = 0; i < 4; ++i) add_start(part[i]);
  }
#endif

  bool is_constant(std::uint16_t index) const noexcept { return index < e_.constants.size; }
  static bool is_sum(const Instruction& s) noexcept {
    return s.op == OpCode::kLinear || s.op == OpCode::kMultiply || s.op == OpCode::kDot;
  }
  // kMax of a register and a constant, then kMin of this result and a constant, in the order of the compiler.
  bool are_limits(const Instruction& s, const Instruction& next, std::uint16_t result) const noexcept {
    return s.op == OpCode::kMax && next.op == OpCode::kMin && next.a == result && is_constant(s.b) &&
           is_constant(next.b);
  }
  void write_limits(const Instruction& s, const Instruction& next, std::uint16_t result,
                    bool after_sum) noexcept {
    // The step before writes one result if it is a sum: the register before this result.
    const bool of_sum = after_sum && s.a + 1 == result;
    add_head(of_sum ? run_limits<true> : run_limits<false>, {result, s.a, s.b, 0});
    add_start(e_.constants[s.b]);
    add_start(e_.constants[next.b]);
  }

  void write(const Instruction& s, std::uint16_t result) noexcept {
    const DensePlace place{result, s.a, s.b, s.shift};
    switch (s.op) {
      case OpCode::kLinear:
        return write_linear(s, place);
      case OpCode::kMultiply: {
        const ProductTerm both{s.a, s.b, 0};
        return write_sum(&both, 1, 1, half_of(s.shift), place);
      }
      case OpCode::kDot:
        return write_sum(e_.terms.data + s.l, s.a, std::uint32_t{s.a} + s.b,
                         std::int64_t{s.k} * (std::int64_t{1} << s.c) + half_of(s.shift), place);
      case OpCode::kLookUp:
        add_head(table_of(e_.tables[s.b]), place);
        return add([&](DenseCell& cell) { cell.table = &e_.tables[s.b]; });
      case OpCode::kWrap:
        add_head(value_of(s.op), place);
        return add([&](DenseCell& cell) { cell.wrap = &e_.wraps[s.b]; });
      case OpCode::kSineCosine:
        add_head(run_sine, place);
        return add_start(s.k);
      case OpCode::kLag:
        add_head(run_lag, place);
        return add_start(s.k);
      default:
        add_head(value_of(s.op), place);
        add_start(0);
    }
  }

  void write_linear(const Instruction& s, const DensePlace& place) noexcept {
    add_head(s.l == 0 ? run_whole<Kind::kScaled> : run_whole<Kind::kScaled, Kind::kScaled>, place);
    add_start(half_of(s.shift));
    add_term({s.k, s.a, 0});
    if (s.l != 0) add_term({s.l, s.b, 0});
  }

  static std::int64_t half_of(unsigned shift) noexcept { return (std::int64_t{1} << shift) >> 1; }

  Product product_of(const ProductTerm& t, bool added) const noexcept {
    if (t.shift != 0) return {added ? Kind::kAddedShifted : Kind::kSubtractedShifted, {t.shift, t.a, t.b}};
    const bool first = is_constant(t.a);
    if (first || is_constant(t.b)) {
      const std::int32_t value = e_.constants[first ? t.a : t.b];
      // The negative value of INT32_MIN is no int32.
      if (added || value != INT32_MIN) return {Kind::kScaled, {added ? value : -value, first ? t.b : t.a, 0}};
    }
    return {added ? Kind::kAdded : Kind::kSubtracted, {0, t.a, t.b}};
  }

  // Products of one kind are beside each other: in one step, or in steps of at most most_of(kind) products.
  void write_sum(const ProductTerm* terms, std::uint32_t plus, std::uint32_t count, std::int64_t start,
                 const DensePlace& place) noexcept {
    std::uint32_t left[kKindCount] = {};
    for (std::uint32_t i = 0; i < count; ++i)
      ++left[static_cast<std::uint32_t>(product_of(terms[i], i < plus).kind)];
    if (count <= kMostWhole) write_whole(left, count, start, place);
    std::uint32_t open = count;
    for (std::uint32_t k = 0; k < kKindCount; ++k) {
      const Kind kind = static_cast<Kind>(k);
      std::uint32_t room = 0;  // products that the step still takes
      for (std::uint32_t i = 0; i < count; ++i) {
        const Product one = product_of(terms[i], i < plus);
        if (one.kind != kind) continue;
        if (room == 0 && count > kMostWhole) {
          room = lower(left[k], most_of(kind));
          add_head(part_of(kind, room, open == count, open == room), place);
          add_start(start);
          left[k] -= room;
          open -= room;
        }
        add_term(one.term);
        --room;
      }
    }
  }
  void write_whole(const std::uint32_t* counts, std::uint32_t count, std::int64_t start,
                   const DensePlace& place) noexcept {
    Kind kinds[kMostWhole];
    std::uint32_t n = 0;
    for (std::uint32_t k = 0; k < kKindCount; ++k)
      for (std::uint32_t i = 0; i < counts[k]; ++i) kinds[n++] = static_cast<Kind>(k);
    add_head(whole_of<Kind::kScaled>(kinds, count), place);
    add_start(start);
  }

  const Equation& e_;
  DenseCell* const cells_;
  std::uint32_t used_ = 0;
};

}  // namespace

std::uint32_t dense_size(const Equation& equation) noexcept { return Writer(equation, nullptr).write(); }

bool make_dense(const Equation& equation, const DenseMemory& memory) noexcept {
  if (dense_size(equation) > memory.size) return false;
  Writer(equation, memory.cells).write();
  for (std::uint32_t i = 0; i < equation.constants.size; ++i)
    memory.frame->registers[i] = equation.constants[i];
  return true;
}

void run_dense(const DenseMemory& memory) noexcept {
#if VERNIER_JUMPS
  memory.cells->run(memory.cells, *memory.frame, 0);
#else
  std::int64_t sum = 0;
  DenseFrame& frame = *memory.frame;
  for (frame.next = memory.cells; frame.next->run != run_end;) sum = frame.next->run(frame.next, frame, sum);
#endif
}

}  // namespace vernier
