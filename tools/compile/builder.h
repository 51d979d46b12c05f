// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "tools/compile/types.h"

namespace vernier::compile {

/// The registers of a fixed-point program while the program is built. Constants, channels and results have
/// three provisional ranges of register numbers, because the number of constants is known only at the end.
/// The function finish() removes the gaps between the ranges.
class ProgramBuilder {
 public:
  using Id = std::uint32_t;

  ProgramBuilder();

  /// Adds a constant in the finest format that can represent it, or in the given format.
  Id constant(double value);
  Id constant(double value, int fraction_bits);
  /// Adds a channel (an input quantity of the program). `channel`: with its range in counts of the quantity;
  /// `unit`: size of a count in the unit of the machine file; `reach`: largest magnitude that must be
  /// representable besides the range (stations of a table).
  Id channel(Channel channel, double unit, double reach, const std::string& name);

  /// Makes the register `source` of another program a channel of this program.
  Id imported(const LoweredProgram& other, std::uint32_t source);

  /// Adds an instruction for the linear combination k*a + l*b of two registers. `exact`: interval of the
  /// exact result.
  Id linear(double k, Id a, double l, Id b, const Interval& exact, const std::string& name);
  Id product(Id a, Id b, const Interval& exact, const std::string& name);
  /// A product of two registers, or of a register and a factor, which is added to a sum or subtracted from
  /// it.
  struct Product {
    Id a;
    std::optional<Id> b;
    double factor = 1;  // factor > 0; used if the product has no register b
    bool minus = false;
  };
  /// Adds a constant plus a sum of products; the result is rounded once. `exact`: interval of the exact
  /// result.
  Id dot(double constant, std::vector<Product> products, const Interval& exact, const std::string& name);
  /// Adds an operation whose result has the given format and needs no shift. `error`: error of the operation
  /// itself, in the unit of the result.
  Id plain(Instruction step, int fraction_bits, const Interval& exact, double error, ErrorSource source,
           std::vector<Register::Use> uses, const std::string& name);
  /// Adds one interpolation in a table to the program. The interpolation has one result per column, in the
  /// order of `results` (name, format, range, own error and uses). look_up() returns the register of the
  /// first column.
  Id look_up(Id position, LoweredTable table, std::vector<Register> results);
  /// Adds the sine and the cosine of an angle in deg, and returns the register of the sine. The cosine is in
  /// the register after the register of the sine.
  Id sine_cosine(Id angle, const Interval& sine, const Interval& cosine);
  /// Returns a register with the value of `a` in the given format. If the register `a` already has the given
  /// format, reformat() adds no instruction.
  Id reformat(Id a, int fraction_bits);

  /// From this call on, the value of a register counts as exact, without an error (Register::given).
  void give(Id id) { registers_[id].given = true; }

  std::uint16_t add_wrap(const Wrap& wrap);
  std::uint16_t add_lag();

  const Register& at(Id id) const { return registers_[id]; }
  const ValueRange& counts(Id id) const { return ranges_[id]; }
  double lsb(Id id) const;
  /// Returns the number of registers that were added so far.
  std::size_t size() const;
  /// Returns the number of a register in the finished program. final_id() is valid after the last register
  /// was added.
  Id final_id(Id id) const;
  LoweredProgram finish(const std::vector<std::pair<Output, Id>>& outputs);

 private:
  Id append(const Instruction& step, std::vector<Register> results, bool& overflow);
  /// Returns the error of a register that every instruction that reads the register must include.
  double error_of(Id id) const { return registers_[id].given ? 0 : registers_[id].error; }
  double largest_count(Id id) const;
  double largest_value(const Product& p) const;
  // Adds the terms of a sum with `sum_bits` fraction bits, for a result with `result_bits` fraction bits.
  // `meta`: the register that receives the errors and uses of the terms.
  void add_terms(const std::vector<Product>& products, int sum_bits, int result_bits, Instruction& step,
                 Register& meta);
  std::string unique(const std::string& name);
  Equation view() const;

  LoweredProgram p_;
  std::vector<Register> registers_;
  std::vector<ValueRange> ranges_;
  std::map<std::pair<double, int>, Id> known_constants_;
  std::set<std::string> names_;
  std::vector<ErrorTable> table_views_;
};

/// Returns the largest number of fraction bits, at most 50, with which `magnitude` fits int32.
int fraction_bits_for(double magnitude);

}  // namespace vernier::compile
