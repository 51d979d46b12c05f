// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/compile/builder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "comp/sine.h"
#include "tools/maths/factors.h"

namespace vernier::compile {
namespace {

// Numbers of registers: constants below, then channels, then results.
constexpr std::uint32_t kFirstChannel = 512, kFirstResult = kFirstChannel + kMaxRegisters;
// Of a fraction: shifting a 32-bit register by more leaves no information.
constexpr int kMostBits = 50, kFewestBits = -30;

std::string identifier(const std::string& name) {
  std::string out;
  for (const char c : name) out += (std::isalnum(static_cast<unsigned char>(c)) != 0) ? c : '_';
  if (out.empty() || std::isdigit(static_cast<unsigned char>(out[0])) != 0) out = "v" + out;
  return out;
}

/// Words with another meaning in the printed program.
std::set<std::string> taken_names() {
  return {
      "lower",       "higher",    "linear",  "multiply", "magnitude", "sign_of",    "wrapped",   "look_up",
      "sine_cosine", "turns_of",  "product", "word_of",  "Word",      "ErrorTable", "lagged",    "step_lag",
      "start_lag",   "channel",   "lag",     "starting", "deviation", "equation",   "clamp",     "narrow",
      "round_shift", "saturate",  "std",     "vernier",  "generated", "View",       "Segment",   "Wrap",
      "LagState",    "alignas",   "and",     "asm",      "auto",      "bool",       "break",     "case",
      "catch",       "char",      "class",   "const",    "continue",  "default",    "delete",    "do",
      "double",      "else",      "enum",    "explicit", "export",    "extern",     "false",     "float",
      "for",         "friend",    "goto",    "if",       "inline",    "int",        "long",      "mutable",
      "namespace",   "new",       "not",     "operator", "or",        "private",    "protected", "public",
      "register",    "requires",  "return",  "short",    "signed",    "sizeof",     "static",    "struct",
      "switch",      "template",  "this",    "throw",    "true",      "try",        "typedef",   "typename",
      "union",       "unsigned",  "using",   "virtual",  "void",      "volatile",   "while",     "xor",
      "concept",     "constexpr", "nullptr", "noexcept"};
}

/// Two real factors as integers over one power of two: k ~ first / 2^shift, |first|, |second| <= kMaxFactor.
struct Factors {
  std::int32_t first = 0, second = 0;
  int shift = 0;
};

int room(double factor) {
  return factor == 0 ? 200 : 30 - static_cast<int>(std::ceil(std::log2(std::abs(factor)) - 1e-12));
}

Factors factors_for(double first, double second) {
  Factors f;
  f.shift = std::min({room(first), room(second), static_cast<int>(kMaxShift)});
  if (f.shift < 0) return f;
  const auto quantised = [&](double k) {
    return static_cast<std::int32_t>(std::lround(std::ldexp(k, f.shift)));
  };
  f.first = quantised(first);
  f.second = quantised(second);
  while (f.shift > 0 && f.first % 2 == 0 && f.second % 2 == 0) f.first /= 2, f.second /= 2, --f.shift;
  return f;
}

}  // namespace

int fraction_bits_for(double magnitude) {
  if (magnitude <= 0) return kMostBits;
  const int bits = static_cast<int>(std::floor(std::log2(2147483647.0 / magnitude)));
  return std::clamp(bits, kFewestBits, kMostBits);
}

ProgramBuilder::ProgramBuilder() : registers_(kFirstResult), ranges_(kFirstResult), names_(taken_names()) {}

double ProgramBuilder::lsb(Id id) const { return std::ldexp(1.0, -registers_[id].fraction_bits); }

std::string ProgramBuilder::unique(const std::string& name) {
  const std::string base = identifier(name);
  std::string result = base;
  for (int i = 2; !names_.insert(result).second; ++i) result = base + "_" + std::to_string(i);
  return result;
}

Equation ProgramBuilder::view() const {
  Equation e;
  e.terms = {p_.terms.data(), static_cast<std::uint32_t>(p_.terms.size())};
  e.tables = {table_views_.data(), static_cast<std::uint32_t>(table_views_.size())};
  e.wraps = {p_.wraps.data(), static_cast<std::uint32_t>(p_.wraps.size())};
  e.lag_count = p_.lag_count;
  return e;
}

namespace {

// All digits of a constant, however small, because a coefficient may be multiplied by a large
// register.
int bits_of_constant(double value) {
  constexpr int kMostDigits = 90;  // of a constant that is multiplied by the largest register
  const int bits = fraction_bits_for(std::abs(value));
  if (value == 0 || bits < kMostBits) return bits;
  return std::min(kMostDigits, static_cast<int>(std::log2(2147483647.0 / std::abs(value))));
}

}  // namespace

ProgramBuilder::Id ProgramBuilder::constant(double value) { return constant(value, bits_of_constant(value)); }

ProgramBuilder::Id ProgramBuilder::constant(double value, int fraction_bits) {
  const auto found = known_constants_.find({value, fraction_bits});
  if (found != known_constants_.end()) return found->second;
  const Id id = static_cast<Id>(p_.constants.size());
  if (id >= kFirstChannel)
    throw text::InputError("cannot be compiled: the equation has more constants than an image can contain");
  Register& r = registers_[id];
  r.fraction_bits = fraction_bits;
  const auto count = std::llround(std::ldexp(value, r.fraction_bits));
  r.name = unique("constant_" + std::to_string(id + 1));
  r.range = {value, value};
  r.error = r.own_error = std::abs(std::ldexp(static_cast<double>(count), -r.fraction_bits) - value);
  p_.constants.push_back(static_cast<std::int32_t>(count));
  ranges_[id] = {count, count};
  known_constants_[{value, fraction_bits}] = id;
  return id;
}

ProgramBuilder::Id ProgramBuilder::channel(Channel channel, double unit, double reach,
                                           const std::string& name) {
  const Id id = kFirstChannel + static_cast<Id>(p_.channels.size());
  if (id >= kFirstResult)
    throw text::InputError(
        "cannot be compiled: the machine file uses more inputs and motion quantities than an image can "
        "contain");
  const Interval exact{static_cast<double>(channel.low) * unit, static_cast<double>(channel.high) * unit};
  Register& r = registers_[id];
  r.fraction_bits = fraction_bits_for(std::max(exact.magnitude(), reach) * (1 + 1e-9));
  const double widest =
      std::max(std::abs(static_cast<double>(channel.low)), std::abs(static_cast<double>(channel.high)));
  while (std::ldexp(widest, -channel.pre_shift) > 2147483646.0) ++channel.pre_shift;
  double factor = unit * std::ldexp(1.0, r.fraction_bits + channel.pre_shift);
  while (factor > kMaxFactor) factor /= 2, --r.fraction_bits;
  Factors f = factors_for(factor, 0);
  // An input may be compared with a number (the selected tool point). Its format must be coarse
  // enough that integers are exact.
  const auto missed = [&] {
    return std::abs(std::ldexp(f.first, -f.shift) - factor) * std::ldexp(widest, -channel.pre_shift);
  };
  while (channel.kind == ChannelKind::kInput && missed() >= 0.25 && r.fraction_bits > 0) {
    factor /= 2, --r.fraction_bits;
    f = factors_for(factor, 0);
  }
  channel.multiplier = f.first;
  channel.shift = static_cast<std::uint8_t>(f.shift);
  r.name = unique(name);
  r.range = exact;
  const double scale_error = std::abs(std::ldexp(f.first, -f.shift) / factor - 1) * exact.magnitude();
  const double rounding = (f.shift > 0 ? 0.5 * lsb(id) : 0) +
                          (channel.pre_shift > 0 ? 0.5 * std::ldexp(unit, channel.pre_shift) : 0);
  r.error = r.own_error = scale_error + rounding;
  r.source = ErrorSource::kChannel;
  p_.channels.push_back(channel);
  ranges_[id] = {channel_value(channel, channel.low), channel_value(channel, channel.high)};
  return id;
}

ProgramBuilder::Id ProgramBuilder::imported(const LoweredProgram& other, std::uint32_t source) {
  const Id id = kFirstChannel + static_cast<Id>(p_.channels.size());
  if (id >= kFirstResult)
    throw text::InputError(
        "cannot be compiled: the machine file uses more inputs and motion quantities than an image can "
        "contain");
  registers_[id] = other.registers[source];
  registers_[id].name = unique(other.registers[source].name);
  registers_[id].uses.clear();
  ranges_[id] = other.ranges[source];
  p_.channels.push_back({});
  return id;
}

std::size_t ProgramBuilder::size() const {
  return registers_.size() - kFirstResult + p_.constants.size() + p_.channels.size();
}

ProgramBuilder::Id ProgramBuilder::append(const Instruction& step, std::vector<Register> results,
                                          bool& overflow) {
  const Id id = static_cast<Id>(registers_.size());
  std::vector<ValueRange> ranges(results.size());
  const ProgramFault fault = range_of(view(), step, id, ranges_.data(), ranges.data());
  overflow = fault == ProgramFault::kOverflow;
  if (overflow) return 0;
  if (fault != ProgramFault::kNone)
    throw std::logic_error("the compiler wrote an instruction that its verifier refuses: " + results[0].name +
                           ", fault " + std::to_string(static_cast<int>(fault)));
  for (Register& r : results) {
    r.name = unique(r.name);
    r.error = r.own_error;
    for (const Register::Use& use : r.uses) r.error += use.gain * error_of(use.from);
    registers_.push_back(std::move(r));
  }
  ranges_.insert(ranges_.end(), ranges.begin(), ranges.end());
  p_.instructions.push_back(step);
  if (registers_.size() - kFirstResult + p_.constants.size() + p_.channels.size() > kMaxRegisters)
    throw text::InputError(fmt::format("cannot be compiled: the equation needs more than {} registers",
                                       std::to_string(kMaxRegisters)));
  return id;
}

double ProgramBuilder::largest_count(Id id) const {
  return std::max(std::abs(static_cast<double>(ranges_[id].low)),
                  std::abs(static_cast<double>(ranges_[id].high)));
}

ProgramBuilder::Id ProgramBuilder::linear(double k, Id a, double l, Id b, const Interval& exact,
                                          const std::string& name) {
  Register meta;
  meta.name = name;
  meta.range = exact;
  const double input_error = std::abs(k) * error_of(a) + (l == 0 ? 0 : std::abs(l) * error_of(b));
  for (int bits = fraction_bits_for(exact.magnitude() + input_error); bits >= kFewestBits; --bits) {
    const double first = std::ldexp(k, bits - at(a).fraction_bits),
                 second = std::ldexp(l, bits - at(b).fraction_bits);
    const Factors f = factors_for(first, second);
    if (f.shift < 0) continue;
    meta.fraction_bits = bits;
    const double unit = std::ldexp(1.0, -bits);
    meta.own_error = std::abs(std::ldexp(f.first, -f.shift) - first) * largest_count(a) * unit +
                     std::abs(std::ldexp(f.second, -f.shift) - second) * largest_count(b) * unit +
                     (f.shift > 0 ? unit / 2 : 0);
    meta.uses = {{a, std::abs(k)}};
    if (l != 0) meta.uses.push_back({b, std::abs(l)});
    Instruction step{OpCode::kLinear,
                     static_cast<std::uint8_t>(f.shift),
                     static_cast<std::uint16_t>(a),
                     static_cast<std::uint16_t>(b),
                     0,
                     f.first,
                     f.second};
    bool overflow = false;
    const Id id = append(step, {meta}, overflow);
    if (!overflow) return id;
  }
  throw text::InputError(
      fmt::format("cannot be compiled: over the declared ranges a value is too large for 32 bits: {}", name));
}

ProgramBuilder::Id ProgramBuilder::product(Id a, Id b, const Interval& exact, const std::string& name) {
  const double size_a = at(a).range.magnitude(), size_b = at(b).range.magnitude();
  const double input_error = size_b * error_of(a) + size_a * error_of(b) + error_of(a) * error_of(b);
  const int sum_bits = at(a).fraction_bits + at(b).fraction_bits;
  const int finest = std::min(sum_bits, fraction_bits_for(exact.magnitude() + input_error));
  for (int bits = finest; bits >= kFewestBits && sum_bits - bits <= static_cast<int>(kMaxShift); --bits) {
    Register meta;
    meta.name = name;
    meta.range = exact;
    meta.fraction_bits = bits;
    meta.own_error = sum_bits > bits ? std::ldexp(0.5, -bits) : 0;
    meta.uses = {{a, size_b + error_of(b)}, {b, size_a}};
    Instruction step{OpCode::kMultiply,
                     static_cast<std::uint8_t>(sum_bits - bits),
                     static_cast<std::uint16_t>(a),
                     static_cast<std::uint16_t>(b),
                     0,
                     0,
                     0};
    bool overflow = false;
    const Id id = append(step, {meta}, overflow);
    if (!overflow) return id;
  }
  throw text::InputError(fmt::format(
      "cannot be compiled: over the declared ranges a product is too large for 32 bits: {}", name));
}

double ProgramBuilder::largest_value(const Product& p) const {
  return largest_count(p.a) * lsb(p.a) * (p.b ? largest_count(*p.b) * lsb(*p.b) : p.factor);
}

void ProgramBuilder::add_terms(const std::vector<Product>& products, int sum_bits, int result_bits,
                               Instruction& step, Register& meta) {
  for (const Product& p : products) {
    Id b = 0;
    if (p.b) {
      b = *p.b;
    } else {
      // A factor with the sum's own format needs no shift. Its error may be as large as the
      // result's rounding.
      const int wanted = sum_bits - at(p.a).fraction_bits, finest = bits_of_constant(p.factor);
      const double error = wanted < -60 ? 1 : std::ldexp(0.5, -wanted) * largest_count(p.a) * lsb(p.a);
      const bool meets = wanted <= finest && error <= std::ldexp(1.0, -result_bits);
      b = meets ? constant(p.factor, wanted) : constant(p.factor);
    }
    const Register &ra = at(p.a), &rb = at(b);
    meta.uses.push_back({p.a, rb.range.magnitude() + error_of(b)});
    meta.uses.push_back({b, ra.range.magnitude()});
    const int shift = ra.fraction_bits + rb.fraction_bits - sum_bits;
    if (shift > 0) meta.own_error += std::ldexp(1.0, -sum_bits);
    if (shift > 62) continue;  // a product is below 2^62: it is smaller than that unit
    p_.terms.push_back(
        {static_cast<std::uint16_t>(p.a), static_cast<std::uint16_t>(b), static_cast<std::uint16_t>(shift)});
    ++(p.minus ? step.b : step.a);
  }
}

ProgramBuilder::Id ProgramBuilder::dot(double constant_part, std::vector<Product> products,
                                       const Interval& exact, const std::string& name) {
  std::stable_partition(products.begin(), products.end(), [](const Product& p) { return !p.minus; });
  double size = std::abs(constant_part), input_error = 0;
  int finest = 100;
  for (const Product& p : products) {
    const Register& a = at(p.a);
    finest = std::min(finest, a.fraction_bits + (p.b ? at(*p.b).fraction_bits : bits_of_constant(p.factor)));
    size += largest_value(p);
    input_error += (p.b ? at(*p.b).range.magnitude() + error_of(*p.b) : p.factor) * error_of(p.a) +
                   (p.b ? a.range.magnitude() * error_of(*p.b) : 0);
  }
  // The sum keeps as many bits as fit below 2^62.
  finest = std::min(finest, 60 - std::ilogb(std::max(size, 1e-15) * 1.001));
  const std::size_t first_term = p_.terms.size();
  for (int bits = std::min(fraction_bits_for(exact.magnitude() + input_error), finest); bits >= kFewestBits;
       --bits) {
    const int sum_bits = std::min(finest, bits + static_cast<int>(kMaxShift));
    Register meta;
    meta.name = name;
    meta.addend = constant_part;
    meta.range = exact;
    meta.fraction_bits = bits;
    meta.own_error = sum_bits > bits ? std::ldexp(0.5, -bits) : 0;
    Instruction step{OpCode::kDot,
                     static_cast<std::uint8_t>(sum_bits - bits),
                     0,
                     0,
                     0,
                     0,
                     static_cast<std::int32_t>(first_term)};
    add_terms(products, sum_bits, bits, step, meta);
    if (constant_part != 0) {
      const int lift = std::max(0, std::ilogb(std::ldexp(constant_part, sum_bits)) - 29);
      step.c = static_cast<std::uint16_t>(lift);
      step.k = static_cast<std::int32_t>(std::llround(std::ldexp(constant_part, sum_bits - lift)));
      meta.own_error += std::abs(std::ldexp(step.k, lift - sum_bits) - constant_part);
    }
    bool overflow = false;
    const Id id = append(step, {meta}, overflow);
    if (!overflow) return id;
    p_.terms.resize(first_term);
  }
  throw text::InputError(
      fmt::format("cannot be compiled: over the declared ranges a value is too large for 32 bits: {}", name));
}

ProgramBuilder::Id ProgramBuilder::plain(Instruction step, int fraction_bits, const Interval& exact,
                                         double error, ErrorSource source, std::vector<Register::Use> uses,
                                         const std::string& name) {
  Register meta;
  meta.name = name;
  meta.range = exact;
  meta.fraction_bits = fraction_bits;
  meta.own_error = error;
  meta.source = source;
  meta.uses = std::move(uses);
  bool overflow = false;
  const Id id = append(step, {meta}, overflow);
  if (overflow)
    throw text::InputError(
        fmt::format("cannot be compiled: {} does not fit 32 bits over the declared ranges", name));
  return id;
}

ProgramBuilder::Id ProgramBuilder::reformat(Id a, int fraction_bits) {
  if (at(a).fraction_bits == fraction_bits) return a;
  // A constant in another format is another constant, without an instruction.
  if (a < kFirstChannel && std::abs(std::ldexp(at(a).range.low, fraction_bits)) < kMaxFactor)
    return constant(at(a).range.low, fraction_bits);
  const Factors f = factors_for(std::ldexp(1.0, fraction_bits - at(a).fraction_bits), 0);
  if (f.shift < 0 || f.first == 0)
    throw text::InputError(
        fmt::format("cannot be compiled: a value is compared with a value of another order of magnitude: {}",
                    at(a).name));
  const Instruction step{OpCode::kLinear,
                         static_cast<std::uint8_t>(f.shift),
                         static_cast<std::uint16_t>(a),
                         static_cast<std::uint16_t>(a),
                         0,
                         f.first,
                         0};
  return plain(step, fraction_bits, at(a).range, f.shift > 0 ? std::ldexp(0.5, -fraction_bits) : 0,
               ErrorSource::kRounding, {{a, 1}}, at(a).name + "_aligned");
}

ProgramBuilder::Id ProgramBuilder::look_up(Id position, LoweredTable table, std::vector<Register> results) {
  if (p_.tables.size() >= kMaxTables)
    throw text::InputError("cannot be compiled: the machine file has more tables than an image can contain");
  const Instruction step{OpCode::kLookUp,
                         0,
                         static_cast<std::uint16_t>(position),
                         static_cast<std::uint16_t>(p_.tables.size()),
                         0,
                         0,
                         0};
  table.name = unique(table.name);
  names_.insert({table.name + "_values", table.name + "_records"});
  p_.tables.push_back(std::move(table));
  table_views_.push_back(p_.tables.back().view());
  const std::string name = results[0].name;
  bool overflow = false;
  const Id id = append(step, std::move(results), overflow);
  if (overflow)
    throw text::InputError(fmt::format(
        "cannot be compiled: the slope of a table or function is too large for 32 bits: {}", name));
  return id;
}

ProgramBuilder::Id ProgramBuilder::sine_cosine(Id angle, const Interval& sine, const Interval& cosine) {
  const double per_count = std::ldexp(4294967296.0 / 360, -at(angle).fraction_bits);
  const int shift = std::min(30 - std::ilogb(per_count), static_cast<int>(kMaxShift));
  if (shift < 0)
    throw text::InputError(fmt::format(
        "cannot be compiled: an angle exceeds the largest number of turns of the fixed-point format: {}",
        at(angle).name));
  const double multiplier = std::round(std::ldexp(per_count, shift));
  // If rounding reaches 2^31, one less is equally accurate.
  const auto k = static_cast<std::int32_t>(std::min(multiplier, 2147483647.0));
  const double turning = std::abs(std::ldexp(k, -shift) / per_count - 1) * largest_count(angle) * lsb(angle) *
                             maths::kRadPerDeg +
                         std::ldexp(2 * 3.14159265358979323846, -32);
  Register r;
  r.fraction_bits = 30;
  r.own_error = turning + kSineErrorMilliLsb * 1e-3 * std::ldexp(1.0, -30);
  r.source = ErrorSource::kFunction;
  r.uses = {{angle, maths::kRadPerDeg}};
  std::vector<Register> results(2, r);
  const std::string name = at(angle).name.size() <= 36 ? at(angle).name : "angle";
  results[0].name = "sin_" + name;
  results[0].range = sine;
  results[1].name = "cos_" + name;
  results[1].range = cosine;
  bool overflow = false;
  return append(
      {OpCode::kSineCosine, static_cast<std::uint8_t>(shift), static_cast<std::uint16_t>(angle), 0, 0, k, 0},
      std::move(results), overflow);
}

std::uint16_t ProgramBuilder::add_wrap(const Wrap& wrap) {
  p_.wraps.push_back(wrap);
  return static_cast<std::uint16_t>(p_.wraps.size() - 1);
}

std::uint16_t ProgramBuilder::add_lag() {
  if (p_.lag_count >= kMaxLags)
    throw text::InputError("cannot be compiled: the machine file has more lags than an image can contain");
  return static_cast<std::uint16_t>(p_.lag_count++);
}

ProgramBuilder::Id ProgramBuilder::final_id(Id id) const {
  if (id < kFirstChannel) return id;
  const auto constants = static_cast<Id>(p_.constants.size());
  if (id < kFirstResult) return id - kFirstChannel + constants;
  return id - kFirstResult + constants + static_cast<Id>(p_.channels.size());
}

LoweredProgram ProgramBuilder::finish(const std::vector<std::pair<Output, Id>>& outputs) {
  const auto constants = static_cast<Id>(p_.constants.size()), channels = static_cast<Id>(p_.channels.size());
  const auto move_operand = [&](std::uint16_t& operand) {
    operand = static_cast<std::uint16_t>(final_id(operand));
  };
  for (Instruction& s : p_.instructions) {
    if (s.op == OpCode::kDot) continue;
    move_operand(s.a);
    const bool index = s.op == OpCode::kLookUp || s.op == OpCode::kWrap || s.op == OpCode::kLag;
    const bool one_operand = s.op == OpCode::kAbs || s.op == OpCode::kSign || s.op == OpCode::kSineCosine;
    if (!index && !one_operand) move_operand(s.b);
  }
  for (ProductTerm& t : p_.terms) move_operand(t.a), move_operand(t.b);
  for (Id id = 0; id < registers_.size(); ++id) {
    const bool gap =
        (id >= constants && id < kFirstChannel) || (id >= kFirstChannel + channels && id < kFirstResult);
    if (gap) continue;
    for (Register::Use& use : registers_[id].uses) use.from = final_id(use.from);
    p_.registers.push_back(registers_[id]);
    p_.ranges.push_back(ranges_[id]);
  }
  for (const auto& [output, id] : outputs) {
    p_.outputs.push_back(output);
    p_.outputs.back().source = static_cast<std::uint16_t>(final_id(id));
  }
  return std::move(p_);
}

}  // namespace vernier::compile
