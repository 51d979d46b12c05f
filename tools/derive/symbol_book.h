// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "tools/derive/types.h"

namespace vernier::derive {

/// The symbols of one derivation, and expressions of the machine in them. Values are in units of the machine
/// file (mm, deg); the symbols behind them are rad where the file has degrees.
class SymbolBook {
 public:
  explicit SymbolBook(const model::Machine& machine);

  /// The expression with all errors in it. Throws GiNaC's pole_error and std::logic_error where it has none.
  GiNaC::ex value(const model::Expr& expr);

  /// Statics without a unit are lengths or angles by where they act; called once all motions are known.
  /// Replaces degrees by radians in the motions.
  void settle_units(std::vector<ElementaryMotion>& motions);

  /// Gives every error its largest size, from the file or from `sizes`.
  void settle_sizes(const ErrorSizes& sizes);

  /// The word under which an error has no derivative, where `coefficient` depends on one; else empty.
  std::string rough_word(const GiNaC::ex& coefficient) const;

  /// `wanted`, or `other` where that is taken; taken from now on.
  std::string free_name(const std::string& wanted, const std::string& other);

  std::vector<ErrorParameter> parameters;
  std::vector<NominalSymbol> nominal;
  std::vector<OpaqueSymbol> opaque;
  std::vector<std::string> notes;

 private:
  GiNaC::ex symbol_value(const model::Expr& expr);
  GiNaC::ex static_value(std::size_t index);
  GiNaC::ex axis_value(std::size_t index);
  GiNaC::ex opaque_value(const model::Expr& expr);
  GiNaC::ex nominal_symbol(const model::Symbol& key, const std::string& name, const std::string& unit,
                           double file_units);
  GiNaC::ex error_symbol(const model::Symbol& key, const std::string& name, const std::string& source,
                         const std::string& unit, double file_units);
  std::string inferred_unit(const ErrorParameter& parameter,
                            const std::vector<ElementaryMotion>& motions) const;
  double file_size(const ErrorParameter& parameter) const;
  void find_turning_statics();

  const model::Machine& machine_;
  std::set<std::size_t> turning_;  // statics that act in a rotation
  std::map<std::pair<int, std::size_t>, GiNaC::ex> known_;
  std::map<std::string, GiNaC::ex> known_opaque_;
  std::set<std::string> names_;
  std::vector<std::pair<GiNaC::realsymbol, std::string>>
      rough_;  // stands for a derivative that does not exist
};

}  // namespace vernier::derive
