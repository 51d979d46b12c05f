// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "tools/derive/types.h"

namespace vernier::derive {

/// The symbols of one derivation. The class converts the expressions of the machine to symbols of the
/// computer algebra. The values of the expressions are in the units of the machine file (mm, deg). The
/// symbol of an angle is in rad, and to_deg converts it in the expression.
class SymbolBook {
 public:
  explicit SymbolBook(const model::Machine& machine);

  /// Returns the expression with all errors included. Throws pole_error of GiNaC and std::logic_error if the
  /// expression has no value.
  GiNaC::ex value(const model::Expr& expr);

  /// Determines whether statics without a unit are lengths or angles. The degree of freedom on which a static
  /// acts determines this. Call settle_units once, after all motions are known. settle_units also replaces
  /// degrees by radians in the motions.
  void settle_units(std::vector<ElementaryMotion>& motions);

  /// Sets the largest size of every error, from the machine file or from `sizes`.
  void settle_sizes(const ErrorSizes& sizes);

  /// Returns the name of a function (for example abs) that makes an error not differentiable, if
  /// `coefficient` depends on such a function; otherwise an empty text.
  std::string rough_word(const GiNaC::ex& coefficient) const;

  /// Returns the name `wanted`, or `other` if `wanted` is already used. The returned name then counts as
  /// used.
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
  std::vector<std::pair<GiNaC::realsymbol, std::string>> rough_;  // symbols that replace a derivative that
                                                                  // does not exist
};

}  // namespace vernier::derive
