// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace vernier::model {

/// Operation of a node of an expression. Angles are degrees throughout (`sin cos tan` take
/// degrees, `atan2` returns degrees).
enum class Op : std::uint8_t {
  kNumber,
  kSymbol,
  kRunIs,
  kNegate,
  kAdd,
  kSubtract,
  kMultiply,
  kDivide,
  kPower,
  kEqual,
  kLess,
  kGreater,
  kSin,
  kCos,
  kTan,
  kAtan2,
  kSqrt,
  kAbs,
  kExp,
  kLog,
  kSign,
  kMin,
  kMax,
  kLag,  // lag(u, tau): first-order lag over t, state starts at u's first value in each run
};

/// The quantity that a name in an expression refers to, after the name is resolved against a machine.
enum class SymbolKind : std::uint8_t {
  kUnresolved,
  kStatic,        // index: Machine::statics
  kAxis,          // index: Machine::axes; value (1 + scalefactor) * raw
  kInput,         // index: Machine::inputs
  kTableValue,    // index: axis * 6 + column, column 0..5 = X Y Z rX rY rZ; mm and deg
  kVelocity,      // index: axis; mm/s or deg/s
  kAcceleration,  // index: axis; mm/s^2 or deg/s^2
  kDirection,     // index: axis; -1, 0, +1
  kSince,         // index: axis; travel since the last reversal, mm or deg
  kFeed,          // mm/min
  kCurvature,     // 1/mm
  kNormal,        // index 0..2: nx ny nz of the row
  kTime,          // s
  kVisit,         // rows since the start of the run
};

struct Symbol {
  SymbolKind kind = SymbolKind::kUnresolved;
  std::size_t index = 0;
  bool operator==(const Symbol&) const = default;
};

struct Expr;
using ExprPtr = std::shared_ptr<const Expr>;

/// A node of an immutable expression tree.
struct Expr {
  Op op = Op::kNumber;
  double number = 0;          // kNumber
  std::string name;           // kSymbol: as written; kRunIs: the label
  Symbol symbol;              // kSymbol, after resolution
  std::vector<ExprPtr> args;  // operands in order
};

/// An error in the text of an expression, with the position and the word of the error.
class ExpressionError : public std::runtime_error {
 public:
  ExpressionError(std::size_t offset_, std::string word_, const std::string& what)
      : std::runtime_error(what), offset(offset_), word(std::move(word_)) {}
  std::size_t offset;
  std::string word;
};

/// Parses an expression of FORMATS (tools/docs/formats.md). Names stay unresolved. Throws ExpressionError.
ExprPtr parse_expression(std::string_view text);

/// Parses a term with placeholders. Names may contain text in braces ({q}, dir{q}, {hats 5}). The braces are
/// a part of the name until substitute() replaces the name.
ExprPtr parse_template(std::string_view text);

/// Returns the expression with some of its names replaced. `replace` is called for every name. `replace`
/// returns the replacement, or null if the name stays.
ExprPtr substitute(const ExprPtr& expr, const std::function<ExprPtr(const std::string&)>& replace);

/// Returns a text that parses back to the same expression, with the fewest parentheses.
std::string to_text(const Expr& expr);

ExprPtr make_number(double value);
/// Returns a symbol with an unresolved name.
ExprPtr make_symbol(std::string name);
/// Returns an expression that is 1 in the rows of one run and 0 in other rows.
ExprPtr make_run(std::string label);
/// Returns left - value in its simplest form: "x", "x-3", "x+3".
ExprPtr subtract_number(ExprPtr left, double value);
ExprPtr make_node(Op op, std::vector<ExprPtr> args);

/// Returns true if the expression contains only numbers, and sets `value` to its value. Returns false if the
/// expression contains a symbol; `value` is then not used.
bool is_constant(const Expr& expr, double& value);

/// Returns the function's name in expressions ("sin"), or nullptr for operators and leaves.
const char* function_name(Op op);
/// Returns the names of all functions: sin, cos …
std::vector<std::string> function_names();
/// True if `name` is a function or a fixed quantity of the expression language (t, feed, run, sin ...).
bool is_reserved_word(std::string_view name);

/// Returns the value of one operation on plain numbers. Comparisons give 1 or 0. apply() must not be called
/// for leaves and kLag.
double apply(Op op, double a, double b);

/// Calls visit(node) for every node, children first.
template <class Visit>
void walk(const Expr& expr, const Visit& visit) {
  for (const ExprPtr& arg : expr.args) walk(*arg, visit);
  visit(expr);
}

/// Returns true if `is(node)` is true for any node of the expression.
template <class Is>
bool any_node(const Expr& expr, const Is& is) {
  bool found = false;
  walk(expr, [&](const Expr& node) { found = found || is(node); });
  return found;
}

/// True if the node is a symbol with this name.
inline bool is_symbol(const Expr& node, std::string_view name) {
  return node.op == Op::kSymbol && node.name == name;
}

/// True if the expression depends on the symbol.
inline bool has_symbol(const Expr& expr, const Symbol& symbol) {
  return any_node(expr, [&](const Expr& node) { return node.op == Op::kSymbol && node.symbol == symbol; });
}

}  // namespace vernier::model
