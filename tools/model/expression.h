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

/// Operation of a node in an expression tree. All angles in expressions are in degrees (`sin cos tan` take
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
  kLag,  // lag(u, tau): first-order lag of u over the time t; in each run the state starts at the first value
         // of u
};

/// Kind of quantity to which a name in an expression refers, after the name is resolved for a machine.
enum class SymbolKind : std::uint8_t {
  kUnresolved,
  kStatic,        // index: Machine::statics
  kAxis,          // index: Machine::axes; value (1 + scalefactor) * raw
  kInput,         // index: Machine::inputs
  kTableValue,    // index: axis * 6 + column, column 0..5 = X Y Z rX rY rZ; mm and deg
  kVelocity,      // index: axis; mm/s or deg/s
  kAcceleration,  // index: axis; mm/s^2 or deg/s^2
  kDirection,     // index: axis; -1, 0, +1
  kSince,         // index: axis; travel since the last reversal of direction, mm or deg
  kFeed,          // feed, mm/min
  kCurvature,     // curvature of the path, 1/mm
  kNormal,        // index 0..2: nx ny nz of the row
  kTime,          // time, s
  kVisit,         // number of rows since the start of the run
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
  double number = 0;          // for kNumber: the value
  std::string name;           // for kSymbol: the name as written; for kRunIs: the label of the run
  Symbol symbol;              // for kSymbol, after the name is resolved
  std::vector<ExprPtr> args;  // operands in their order
};

/// An error in the text of an expression, with the position and the word of the error.
class ExpressionError : public std::runtime_error {
 public:
  ExpressionError(std::size_t offset_, std::string word_, const std::string& what)
      : std::runtime_error(what), offset(offset_), word(std::move(word_)) {}
  std::size_t offset;
  std::string word;
};

/// Parses an expression in the syntax of FORMATS (tools/docs/formats.md). Names in the parsed expression stay
/// unresolved. Throws ExpressionError if the text is not an expression.
ExprPtr parse_expression(std::string_view text);

/// Parses a template: an expression with placeholders. Names in a template may contain text in braces ({q},
/// dir{q}, {hats 5}). The braces are a part of a name until substitute() replaces the name.
ExprPtr parse_template(std::string_view text);

/// Returns the expression with some of its names replaced. The function `replace` is called for every name of
/// the expression. `replace` returns the replacement, or null if the name is not changed.
ExprPtr substitute(const ExprPtr& expr, const std::function<ExprPtr(const std::string&)>& replace);

/// Returns the expression as text with the fewest parentheses. The parser converts the text of an
/// expression back to the same expression.
std::string to_text(const Expr& expr);

ExprPtr make_number(double value);
/// Returns a symbol node with a name that is not resolved.
ExprPtr make_symbol(std::string name);
/// Returns an expression with the value 1 in the rows of one run and 0 in all other rows.
ExprPtr make_run(std::string label);
/// Returns the difference left - value as the simplest expression: "x", "x-3", "x+3".
ExprPtr subtract_number(ExprPtr left, double value);
ExprPtr make_node(Op op, std::vector<ExprPtr> args);

/// Returns true if the expression contains only numbers. If the expression contains only numbers, `value` is
/// set to the value of the expression. Returns false if the expression contains a symbol. If the expression
/// contains a symbol, the content of `value` has no meaning.
bool is_constant(const Expr& expr, double& value);

/// Returns the name of a function in expressions ("sin"); nullptr if the operation is an operator or a leaf.
const char* function_name(Op op);
/// Returns the names of all functions of the expression language: sin, cos …
std::vector<std::string> function_names();
/// True if `name` is a function or a fixed quantity of the expression language (t, feed, run, sin ...).
bool is_reserved_word(std::string_view name);

/// Returns the result of one operation on plain numbers. A comparison in an expression has the
/// value 1 (true) or 0 (false). Do not call apply() for a leaf or for kLag.
double apply(Op op, double a, double b);

/// Calls visit(node) for every node of the expression; the children of a node come before the node.
template <class Visit>
void walk(const Expr& expr, const Visit& visit) {
  for (const ExprPtr& arg : expr.args) walk(*arg, visit);
  visit(expr);
}

/// True if `is(node)` is true for at least one node of the expression.
template <class Is>
bool any_node(const Expr& expr, const Is& is) {
  bool found = false;
  walk(expr, [&](const Expr& node) { found = found || is(node); });
  return found;
}

/// True if the node is a symbol with the name `name`.
inline bool is_symbol(const Expr& node, std::string_view name) {
  return node.op == Op::kSymbol && node.name == name;
}

/// True if the expression depends on the symbol.
inline bool has_symbol(const Expr& expr, const Symbol& symbol) {
  return any_node(expr, [&](const Expr& node) { return node.op == Op::kSymbol && node.symbol == symbol; });
}

}  // namespace vernier::model
