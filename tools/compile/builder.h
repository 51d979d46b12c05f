// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "tools/compile/types.h"

namespace vernier::compile {

/// Registers during the construction of the program. Constants, channels and results have three provisional
/// ranges of register numbers, because the number of constants is known only at the end. finish() closes the
/// gaps between the ranges.
class ProgramBuilder {
 public:
  using Id = std::uint32_t;

  ProgramBuilder();

  /// Adds a constant in the finest format that can represent it, or in the given format.
  Id constant(double value);
  Id constant(double value, int fraction_bits);
  /// Adds a channel. channel: with the range in the quantity's own counts; unit: size of a count in the
  /// machine file's unit; reach: largest magnitude that must be representable in addition to the range
  /// (stations of a table).
  Id channel(Channel channel, double unit, double reach, const std::string& name);

  /// Makes register `source` of the other program a channel of this program.
  Id imported(const LoweredProgram& other, std::uint32_t source);

  /// Adds k*a + l*b. exact: interval of the exact value.
  Id linear(double k, Id a, double l, Id b, const Interval& exact, const std::string& name);
  Id product(Id a, Id b, const Interval& exact, const std::string& name);
  /// A product of two registers, or of a register and a factor; added or subtracted.
  struct Product {
    Id a;
    std::optional<Id> b;
    double factor = 1;  // > 0; if there is no b
    bool minus = false;
  };
  /// Adds constant + the sum of products, rounded once. exact: interval of the exact value.
  Id dot(double constant, std::vector<Product> products, const Interval& exact, const std::string& name);
  /// Adds an operation whose result has the given format and needs no shift. error: error of the operation
  /// itself, in the unit of the result.
  Id plain(Instruction step, int fraction_bits, const Interval& exact, double error, ErrorSource source,
           std::vector<Register::Use> uses, const std::string& name);
  /// Adds one interpolation in a table to the program. The interpolation has one result per column, in the
  /// order of `results` (name, format, range, own error and uses). Returns the first result.
  Id look_up(Id position, LoweredTable table, std::vector<Register> results);
  /// Adds sine and cosine of an angle in deg. The cosine is in the register after the returned register.
  Id sine_cosine(Id angle, const Interval& sine, const Interval& cosine);
  /// Returns register a in the given format. If `a` already has the format, no instruction is added.
  Id reformat(Id a, int fraction_bits);

  /// From this call on, the value of the register counts as exact (Register::given).
  void give(Id id) { registers_[id].given = true; }

  std::uint16_t add_wrap(const Wrap& wrap);
  std::uint16_t add_lag();

  const Register& at(Id id) const { return registers_[id]; }
  const ValueRange& counts(Id id) const { return ranges_[id]; }
  double lsb(Id id) const;
  /// Returns the number of registers so far.
  std::size_t size() const;
  /// Returns the index of a register in the finished program. Valid after the last addition.
  Id final_id(Id id) const;
  LoweredProgram finish(const std::vector<std::pair<Output, Id>>& outputs);

 private:
  Id append(const Instruction& step, std::vector<Register> results, bool& overflow);
  /// Error that a register propagates.
  double error_of(Id id) const { return registers_[id].given ? 0 : registers_[id].error; }
  double largest_count(Id id) const;
  double largest_value(const Product& p) const;
  // Adds the terms of a sum in the format of sum_bits, for a result of result_bits. `meta` gets
  // their errors and uses.
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

/// Returns the largest number of fraction bits with which `magnitude` fits int32; at most 50.
int fraction_bits_for(double magnitude);

}  // namespace vernier::compile
