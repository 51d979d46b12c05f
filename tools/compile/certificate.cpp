// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/compile/certificate.h"

#include <fmt/format.h>

#include <cmath>

namespace vernier::compile {
namespace {

/// The compiler computes its bounds in double precision, Gappa with exact numbers.
constexpr double kProofMargin = 1e-9;

/// An exact number: Gappa reads "5b-3" as 5 * 2^-3.
std::string dyadic(std::int64_t count, int exponent) { return fmt::format("{}b{}", count, exponent); }

/// A double, all of its digits.
std::string exact(double value) {
  if (value == 0) return "0";
  int exponent = 0;
  const double mantissa = std::frexp(value, &exponent);
  std::int64_t count = std::llround(std::ldexp(mantissa, 53));
  exponent -= 53;
  while (count % 2 == 0) count /= 2, ++exponent;
  return dyadic(count, exponent);
}

constexpr const char* kPreface =
    "# Machine: {}, image {:016x}. Proof: gappa bound.g (exit status 0).\n"
    "# f_NAME: register NAME of the fixed-point program; e_NAME: the same value of the error equation, "
    "without\n"
    "# rounding. The statements to prove, |f - e| at most:\n"
    "{}# Assumed without proof: the declared ranges; the error of the format of each channel; d_NAME, the "
    "error of a table,\n"
    "# function, choice or lag, and s_NAME, its largest slope. A register from which a later evaluation "
    "starts counts as exact\n"
    "# for this evaluation. Not in this file: neglected terms, second order, and the conversion of an output "
    "to counts\n"
    "# (bound.json).\n\n";

constexpr const char* kLeastSquares =
    "# The correction is a least-squares solution. The bound in bound.json is that of its residual at the "
    "tool "
    "point. The\n"
    "# compiler composes it by matrix norms, in double precision (tools/docs/compile.md). This file does not "
    "prove it.\n";

std::string within(double magnitude) { return fmt::format("[-{0},{0}]", exact(magnitude)); }

class Script {
 public:
  explicit Script(const LoweredProgram& p) : p_(p) {}

  void write() {
    for (std::uint32_t i = 0; i < p_.constants.size(); ++i) constant(i);
    for (std::uint32_t i = 0; i < p_.channels.size(); ++i)
      channel(static_cast<std::uint32_t>(p_.constants.size()) + i);
    std::uint32_t at = p_.first_result();
    for (const Instruction& step : p_.instructions) {
      const std::uint32_t results = p_.results_of(step);
      definitions_ += "\n# " + p_.registers[at].name + "\n";
      switch (step.op) {
        case OpCode::kLinear:
          linear(step, at);
          break;
        case OpCode::kMultiply:
          multiply(step, at);
          break;
        case OpCode::kDot:
          dot(step, at);
          break;
        default:
          for (std::uint32_t k = 0; k < results; ++k) assumed(at + k);
      }
      at += results;
    }
  }

  /// States |fixed - exact| of a register. Returns the bound, in its unit.
  double claim(std::uint32_t id) {
    const Register& r = p_.registers[id];
    const double bound = r.error * (1 + kProofMargin) + std::ldexp(kProofMargin, -r.fraction_bits);
    join(goals_, fmt::format("{} - {}", fixed(id), real(id)), within(bound));
    return bound;
  }

  std::string text() const {
    const std::string given = hypotheses_.empty() ? "" : "  " + hypotheses_ + " ->\n";
    return definitions_ + "\n{\n" + given + "  " + goals_ + "\n}\n" + (hints_.empty() ? "" : "\n" + hints_);
  }

 private:
  std::string fixed(std::uint32_t id) const { return "f_" + p_.registers[id].name; }
  std::string real(std::uint32_t id) const { return "e_" + p_.registers[id].name; }
  /// The exact value that a later register refers to: of a register that is given, its actual value.
  std::string meant(std::uint32_t id) const { return p_.registers[id].given ? fixed(id) : real(id); }

  static void join(std::string& all, const std::string& name, const std::string& interval) {
    all += fmt::format("{}{} in {}", all.empty() ? "" : " /\\\n  ", name, interval);
  }
  void assume(const std::string& name, const std::string& interval) { join(hypotheses_, name, interval); }
  void assume_range(std::uint32_t id) {
    const Interval& r = p_.registers[id].range;
    assume(real(id), fmt::format("[{},{}]", exact(r.low), exact(r.high)));
  }
  void define(const std::string& name, const std::string& value) {
    definitions_ += name + " = " + value + ";\n";
  }
  void hint(const std::string& from, const std::string& to) { hints_ += from + " -> " + to + ";\n"; }

  void constant(std::uint32_t id) {
    define(fixed(id), dyadic(p_.constants[id], -p_.registers[id].fraction_bits));
    define(real(id), exact(p_.registers[id].range.low));
  }

  void channel(std::uint32_t id) {
    assume_range(id);
    assume(fmt::format("{} - {}", fixed(id), real(id)), within(p_.registers[id].own_error));
  }

  /// A table, a function, a choice or a lag: its own error and its slope are assumed.
  void assumed(std::uint32_t id) {
    const Register& r = p_.registers[id];
    std::string error = "d_" + r.name;
    assume(error, within(r.own_error));
    assume_range(id);
    for (std::size_t k = 0; k < r.uses.size(); ++k) {
      const Register::Use& use = r.uses[k];
      if (use.gain == 0 || p_.registers[use.from].given) continue;
      const std::string slope = fmt::format("s{}_{}", k, r.name);
      assume(slope, within(use.gain));
      error += fmt::format(" + {} * ({} - {})", slope, fixed(use.from), real(use.from));
    }
    define(fixed(id), fmt::format("{} + ({})", real(id), error));
    hint(fmt::format("{} - {}", fixed(id), real(id)), error);
  }

  /// The register is `sum`, rounded to its format: the instruction adds half a unit and truncates.
  /// The equation has `exact_sum`; `difference` = sum - exact_sum.
  void round(std::uint32_t id, const std::string& sum, const std::string& exact_sum,
             const std::string& difference, bool shifted) {
    const Register& r = p_.registers[id];
    define(real(id), exact_sum);
    if (!shifted) {
      define(fixed(id), sum);
      hint(fmt::format("{} - {}", fixed(id), real(id)), difference);
      return;
    }
    const std::string name = "m_" + r.name, half = dyadic(1, -r.fraction_bits - 1);
    define(name, sum);
    define(fixed(id), fmt::format("fixed<{},dn>({} + {})", -r.fraction_bits, name, half));
    hint(fmt::format("{} - {}", fixed(id), real(id)),
         fmt::format("({0} - ({1} + {2})) + {2} + ({1} - {3})", fixed(id), name, half, real(id)));
    hint(fmt::format("{} - {}", name, real(id)), difference);
  }

  void linear(const Instruction& step, std::uint32_t id) {
    const Register& r = p_.registers[id];
    std::string sum, exact_sum, difference;
    const auto part = [&](std::uint32_t from, std::int32_t factor, double gain) {
      const int exponent = p_.registers[from].fraction_bits - static_cast<int>(step.shift) - r.fraction_bits;
      const std::string k = dyadic(factor, exponent), c = exact(factor < 0 ? -gain : gain);
      const std::string_view plus = sum.empty() ? "" : " + ";
      sum += fmt::format("{}{} * {}", plus, fixed(from), k);
      exact_sum += fmt::format("{}{} * {}", plus, meant(from), c);
      difference += plus;
      if (!p_.registers[from].given)
        difference += fmt::format("({} - {}) * {} + ", fixed(from), real(from), k);
      difference += fmt::format("{} * ({} - {})", meant(from), k, c);
    };
    part(step.a, step.k, r.uses[0].gain);
    if (step.l != 0) part(step.b, step.l, r.uses[1].gain);
    round(id, sum, exact_sum, difference, step.shift > 0);
  }

  /// a * b of the program - a * b of the equation.
  std::string product_error(std::uint32_t a, std::uint32_t b) const {
    const bool exact_a = p_.registers[a].given, exact_b = p_.registers[b].given;
    if (exact_a && exact_b) return "0";
    const std::string da = fmt::format("({} - {})", fixed(a), real(a)),
                      db = fmt::format("({} - {})", fixed(b), real(b));
    if (exact_a) return fmt::format("{} * {}", fixed(a), db);
    if (exact_b) return fmt::format("{} * {}", da, fixed(b));
    return fmt::format("({0} * {1} + {2} * {3} + {0} * {3})", da, real(b), real(a), db);
  }

  void multiply(const Instruction& step, std::uint32_t id) {
    round(id, fmt::format("{} * {}", fixed(step.a), fixed(step.b)),
          fmt::format("{} * {}", meant(step.a), meant(step.b)), product_error(step.a, step.b),
          step.shift > 0);
  }

  void dot(const Instruction& step, std::uint32_t id) {
    const Register& r = p_.registers[id];
    const int sum_bits = r.fraction_bits + static_cast<int>(step.shift);
    std::string sum = dyadic(step.k, static_cast<int>(step.c) - sum_bits), exact_sum = exact(r.addend);
    std::string difference = fmt::format("({} - {})", sum, exact_sum);
    const std::size_t count = static_cast<std::size_t>(step.a) + step.b;
    for (std::size_t i = 0; i < count; ++i) {
      const ProductTerm& t = p_.terms[static_cast<std::size_t>(step.l) + i];
      const char* const sign = i < step.a ? "+" : "-";
      const std::string product = fmt::format("{} * {}", fixed(t.a), fixed(t.b));
      if (t.shift > 0) {
        const std::string cut = fmt::format("p{}_{}", i, r.name);
        define(cut, fmt::format("fixed<{},dn>({})", -sum_bits, product));
        sum += fmt::format(" {} {}", sign, cut);
        difference += fmt::format(" {} ({} - {})", sign, cut, product);
      } else {
        sum += fmt::format(" {} {}", sign, product);
      }
      exact_sum += fmt::format(" {} {} * {}", sign, meant(t.a), meant(t.b));
      difference += fmt::format(" {} {}", sign, product_error(t.a, t.b));
    }
    // Products below the last bit of the sum are not in the program.
    if (const std::size_t left_out = r.uses.size() / 2 - count; left_out > 0) {
      assume("l_" + r.name, within(std::ldexp(static_cast<double>(left_out), -sum_bits)));
      exact_sum += " + l_" + r.name;
      difference += " - l_" + r.name;
    }
    round(id, sum, exact_sum, difference, step.shift > 0);
  }

  const LoweredProgram& p_;
  std::string definitions_, hypotheses_, goals_, hints_;
};

}  // namespace

std::string print_certificate(const model::Machine& machine, const CompiledMachine& compiled) {
  const LoweredProgram& p = compiled.program;
  Script script(p);
  script.write();
  std::string claims;
  const auto claim = [&](std::uint32_t id, const std::string& name, const char* unit) {
    claims += fmt::format("#   {}: {:.6g} {}\n", name, script.claim(id), unit);
  };
  for (std::uint32_t id = 0; id < p.registers.size(); ++id)
    if (p.registers[id].given) claim(id, p.registers[id].name + " (an earlier evaluation)", "mm or deg");
  for (const Output& out : p.outputs) {
    const model::Axis& axis = machine.axes[out.axis];
    if (!p.registers[out.source].given)
      claim(out.source, "deviation of axis " + axis.name, axis.rotary ? "deg" : "mm");
  }
  if (compiled.least_squares) claims += kLeastSquares;
  return fmt::format(kPreface, machine.name, compiled.fingerprint, claims) + script.text();
}

}  // namespace vernier::compile
