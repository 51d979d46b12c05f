// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/model/expression.h"

#include <array>
#include <cmath>
#include <optional>

#include "tools/format/columns.h"
#include "tools/maths/factors.h"
#include "tools/text/numbers.h"

namespace vernier::model {
namespace {

/// Nesting deeper than this is refused, so that no input can exhaust the stack.
constexpr int kMaxDepth = 200;
/// A sum of n terms is a tree of depth n. Evaluation and destruction descend it, so nodes are
/// counted too. The longest term seen has some hundreds of nodes.
constexpr int kMaxNodes = 4000;

struct NamedFunction {
  const char* name;
  Op op;
  std::size_t arity;
};
constexpr std::array<NamedFunction, 12> kFunctions = {{{"sin", Op::kSin, 1},
                                                       {"cos", Op::kCos, 1},
                                                       {"tan", Op::kTan, 1},
                                                       {"atan2", Op::kAtan2, 2},
                                                       {"sqrt", Op::kSqrt, 1},
                                                       {"abs", Op::kAbs, 1},
                                                       {"exp", Op::kExp, 1},
                                                       {"log", Op::kLog, 1},
                                                       {"sign", Op::kSign, 1},
                                                       {"min", Op::kMin, 2},
                                                       {"max", Op::kMax, 2},
                                                       {"lag", Op::kLag, 2}}};

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Recursive descent, lowest precedence first: comparison, sum, product, sign, power, primary.
class Parser {
 public:
  explicit Parser(std::string_view text, bool placeholders = false)
      : text_(text), placeholders_(placeholders) {}

  ExprPtr whole() {
    ExprPtr result = comparison();
    skip_space();
    if (at_ < text_.size()) fail("unexpected here");
    return result;
  }

 private:
  ExprPtr comparison() {
    const Nesting nesting(*this);
    ExprPtr left = sum();
    const std::optional<Op> op = comparison_sign();
    if (!op) return left;
    left = make_node(*op, {left, sum()});
    const std::size_t before = at_;
    if (comparison_sign()) {
      at_ = before;
      skip_space();
      fail("two comparisons in a row are not allowed; use parentheses");
    }
    return left;
  }

  ExprPtr sum() {
    ExprPtr left = product();
    while (true) {
      if (take('+'))
        left = make_node(Op::kAdd, {left, product()});
      else if (take('-'))
        left = make_node(Op::kSubtract, {left, product()});
      else
        return left;
    }
  }

  ExprPtr product() {
    ExprPtr left = signed_power();
    while (true) {
      if (take('*'))
        left = make_node(Op::kMultiply, {left, signed_power()});
      else if (take('/'))
        left = make_node(Op::kDivide, {left, signed_power()});
      else
        return left;
    }
  }

  ExprPtr signed_power() {
    const Nesting nesting(*this);
    if (take('-')) return make_node(Op::kNegate, {signed_power()});
    if (take('+')) return signed_power();
    return power();
  }

  ExprPtr power() {
    ExprPtr base = primary();
    if (take('^')) return make_node(Op::kPower, {base, signed_power()});
    return base;
  }

  ExprPtr primary() {
    const Nesting nesting(*this);
    count_node();
    skip_space();
    if (at_ >= text_.size()) fail("a value is missing at the end");
    const char c = text_[at_];
    if (is_digit(c) || c == '.') return number();
    if (is_letter(c) || (placeholders_ && c == '{')) return name_or_call();
    if (take('(')) {
      ExprPtr inside = comparison();
      expect(')');
      return inside;
    }
    fail("a value is missing here");
  }

  ExprPtr number() {
    std::size_t end = at_;
    while (end < text_.size() && (is_digit(text_[end]) || text_[end] == '.')) ++end;
    if (end < text_.size() && (text_[end] == 'e' || text_[end] == 'E')) {
      std::size_t exponent = end + 1;
      if (exponent < text_.size() && (text_[exponent] == '+' || text_[exponent] == '-')) ++exponent;
      if (exponent < text_.size() && is_digit(text_[exponent])) {
        end = exponent;
        while (end < text_.size() && is_digit(text_[end])) ++end;
      }
    }
    const std::optional<double> value = text::parse_number(text_.substr(at_, end - at_));
    if (!value || (end < text_.size() && is_letter(text_[end]))) fail("not a number");
    at_ = end;
    return make_number(*value);
  }

  ExprPtr name_or_call() {
    const std::size_t start = at_;
    while (at_ < text_.size() && (is_letter(text_[at_]) || is_digit(text_[at_]) || skip_placeholder())) ++at_;
    const std::string name(text_.substr(start, at_ - start));
    if (!peek('(')) return symbol(name, start);
    if (name == format::columns::kRun) return run_label();
    for (const NamedFunction& function : kFunctions)
      if (name == function.name) return call(function);
    fail_at(start, name, "unknown function");
  }

  /// If the next character opens a placeholder, moves to its closing brace.
  bool skip_placeholder() {
    if (!placeholders_ || text_[at_] != '{') return false;
    const std::size_t end = text_.find('}', at_);
    if (end == std::string_view::npos) fail("{ without }");
    at_ = end;
    return true;
  }

  ExprPtr symbol(const std::string& name, std::size_t start) {
    if (name == format::columns::kRun || is_function(name))
      fail_at(start, name, "the argument of a function must be in parentheses");
    return make_symbol(name);
  }

  ExprPtr call(const NamedFunction& function) {
    expect('(');
    std::vector<ExprPtr> args{comparison()};
    while (args.size() < function.arity) {
      expect(',');
      args.push_back(comparison());
    }
    expect(')');
    return make_node(function.op, std::move(args));
  }

  ExprPtr run_label() {
    expect('(');
    skip_space();
    const char quote = at_ < text_.size() ? text_[at_] : ' ';
    if (quote != '"' && quote != '\'') fail("run needs a label in quotes");
    const std::size_t end = text_.find(quote, at_ + 1);
    if (end == std::string_view::npos) fail("the label's closing quote is missing");
    ExprPtr node = make_run(std::string(text_.substr(at_ + 1, end - at_ - 1)));
    at_ = end + 1;
    expect(')');
    return node;
  }

  static bool is_function(std::string_view name) {
    for (const NamedFunction& function : kFunctions)
      if (name == function.name) return true;
    return false;
  }

  std::optional<Op> comparison_sign() {
    if (take('=')) return Op::kEqual;
    if (take('<')) return Op::kLess;
    if (take('>')) return Op::kGreater;
    return std::nullopt;
  }

  void skip_space() {
    while (at_ < text_.size() &&
           (text_[at_] == ' ' || text_[at_] == '\t' || text_[at_] == '\n' || text_[at_] == '\r'))
      ++at_;
  }
  bool peek(char c) {
    skip_space();
    return at_ < text_.size() && text_[at_] == c;
  }
  bool take(char c) {
    if (!peek(c)) return false;
    ++at_;
    return true;
  }
  void expect(char c) {
    if (!take(c)) fail(std::string("'") + c + "' is missing here");
  }

  // Every node of the tree is made of a primary, or joins a primary to the tree.
  void count_node() {
    if (++nodes_ > kMaxNodes) fail("the expression is too long");
  }

  [[noreturn]] void fail(const std::string& what) {
    std::size_t end = at_;
    if (end < text_.size() && (is_letter(text_[end]) || is_digit(text_[end]) || text_[end] == '.')) {
      while (end < text_.size() && (is_letter(text_[end]) || is_digit(text_[end]) || text_[end] == '.'))
        ++end;
    } else if (end < text_.size()) {
      // A letter of another alphabet has several bytes.
      do ++end;
      while (end < text_.size() && (static_cast<unsigned char>(text_[end]) & 0xC0U) == 0x80U);
    }
    const std::string_view word = at_ < text_.size() ? text_.substr(at_, end - at_) : text_;
    fail_at(at_, std::string(word), what);
  }
  [[noreturn]] void fail_at(std::size_t offset, std::string word, const std::string& what) {
    throw ExpressionError(offset, std::move(word), what);
  }

  struct Nesting {
    explicit Nesting(Parser& parser) : parser_(parser) {
      if (++parser_.depth_ > kMaxDepth) parser_.fail("the expression has too many nested parentheses");
    }
    ~Nesting() { --parser_.depth_; }
    Nesting(const Nesting&) = delete;
    Nesting& operator=(const Nesting&) = delete;
    Parser& parser_;
  };

  std::string_view text_;
  bool placeholders_;
  std::size_t at_ = 0;
  int depth_ = 0, nodes_ = 0;
};

/// Precedence of the printed form of a node. A child with lower precedence is put in parentheses.
int strength(const Expr& expr) {
  switch (expr.op) {
    case Op::kEqual:
    case Op::kLess:
    case Op::kGreater:
      return 1;
    case Op::kAdd:
    case Op::kSubtract:
      return 2;
    case Op::kMultiply:
    case Op::kDivide:
      return 3;
    case Op::kNegate:
      return 4;
    case Op::kPower:
      return 5;
    case Op::kNumber:
      return std::signbit(expr.number) ? 4 : 6;
    default:
      return 6;
  }
}

std::string wrapped(const Expr& expr, int at_least) {
  return strength(expr) >= at_least ? to_text(expr) : "(" + to_text(expr) + ")";
}

std::string binary_text(const Expr& expr, const char* sign, int left, int right) {
  return wrapped(*expr.args[0], left) + sign + wrapped(*expr.args[1], right);
}

}  // namespace

ExprPtr parse_expression(std::string_view text) { return Parser(text).whole(); }

ExprPtr parse_template(std::string_view text) { return Parser(text, true).whole(); }

ExprPtr substitute(const ExprPtr& expr, const std::function<ExprPtr(const std::string&)>& replace) {
  if (expr->op == Op::kSymbol) {
    ExprPtr other = replace(expr->name);
    return other ? other : expr;
  }
  if (expr->args.empty()) return expr;
  std::vector<ExprPtr> args;
  for (const ExprPtr& arg : expr->args) args.push_back(substitute(arg, replace));
  if (expr->op == Op::kSubtract && args[1]->op == Op::kNumber && expr->args[1]->op == Op::kSymbol)
    return subtract_number(args[0], args[1]->number);
  return args == expr->args ? expr : make_node(expr->op, std::move(args));
}

ExprPtr make_number(double value) {
  auto node = std::make_shared<Expr>();
  node->number = value;
  return node;
}

ExprPtr make_symbol(std::string name) {
  auto node = std::make_shared<Expr>();
  node->op = Op::kSymbol;
  node->name = std::move(name);
  return node;
}

ExprPtr make_run(std::string label) {
  auto node = std::make_shared<Expr>();
  node->op = Op::kRunIs;
  node->name = std::move(label);
  return node;
}

ExprPtr subtract_number(ExprPtr left, double value) {
  if (value == 0) return left;
  return value < 0 ? make_node(Op::kAdd, {std::move(left), make_number(-value)})
                   : make_node(Op::kSubtract, {std::move(left), make_number(value)});
}

ExprPtr make_node(Op op, std::vector<ExprPtr> args) {
  auto node = std::make_shared<Expr>();
  node->op = op;
  node->args = std::move(args);
  return node;
}

const char* function_name(Op op) {
  for (const NamedFunction& function : kFunctions)
    if (op == function.op) return function.name;
  return nullptr;
}

std::vector<std::string> function_names() {
  std::vector<std::string> names;
  for (const NamedFunction& function : kFunctions) names.emplace_back(function.name);
  return names;
}

bool is_reserved_word(std::string_view name) {
  if (format::is_name_of_terms(name)) return true;
  for (const NamedFunction& function : kFunctions)
    if (name == function.name) return true;
  return false;
}

std::string to_text(const Expr& expr) {
  switch (expr.op) {
    case Op::kNumber:
      return text::number_text(expr.number);
    case Op::kSymbol:
      return expr.name;
    case Op::kRunIs: {
      const char quote = expr.name.find('"') == std::string::npos ? '"' : '\'';
      return std::string("run(") + quote + expr.name + quote + ")";
    }
    case Op::kNegate:
      return "-" + wrapped(*expr.args[0], 4);
    case Op::kAdd:
      return binary_text(expr, "+", 2, 3);
    case Op::kSubtract:
      return binary_text(expr, "-", 2, 3);
    case Op::kMultiply:
      return binary_text(expr, "*", 3, 4);
    case Op::kDivide:
      return binary_text(expr, "/", 3, 4);
    case Op::kPower:
      return binary_text(expr, "^", 6, 4);
    case Op::kEqual:
      return binary_text(expr, "=", 2, 2);
    case Op::kLess:
      return binary_text(expr, "<", 2, 2);
    case Op::kGreater:
      return binary_text(expr, ">", 2, 2);
    default:
      break;
  }
  std::string text = std::string(function_name(expr.op)) + "(";
  for (std::size_t i = 0; i < expr.args.size(); ++i) text += (i ? "," : "") + to_text(*expr.args[i]);
  return text + ")";
}

double apply(Op op, double a, double b) {
  switch (op) {
    case Op::kNegate:
      return -a;
    case Op::kAdd:
      return a + b;
    case Op::kSubtract:
      return a - b;
    case Op::kMultiply:
      return a * b;
    case Op::kDivide:
      return a / b;
    case Op::kPower:
      return std::pow(a, b);
    case Op::kEqual:
      return a == b ? 1 : 0;
    case Op::kLess:
      return a < b ? 1 : 0;
    case Op::kGreater:
      return a > b ? 1 : 0;
    case Op::kSin:
      return std::sin(a * maths::kRadPerDeg);
    case Op::kCos:
      return std::cos(a * maths::kRadPerDeg);
    case Op::kTan:
      return std::tan(a * maths::kRadPerDeg);
    case Op::kAtan2:
      return std::atan2(a, b) / maths::kRadPerDeg;
    case Op::kSqrt:
      return std::sqrt(a);
    case Op::kAbs:
      return std::abs(a);
    case Op::kExp:
      return std::exp(a);
    case Op::kLog:
      return std::log(a);
    case Op::kSign:
      return a > 0 ? 1 : a < 0 ? -1 : 0;
    case Op::kMin:
      return std::min(a, b);
    case Op::kMax:
      return std::max(a, b);
    case Op::kNumber:
    case Op::kSymbol:
    case Op::kRunIs:
    case Op::kLag:
      break;
  }
  throw std::logic_error("apply: not an operation on plain numbers");
}

bool is_constant(const Expr& expr, double& value) {
  if (expr.op == Op::kNumber) {
    value = expr.number;
    return true;
  }
  if (expr.op == Op::kSymbol || expr.op == Op::kRunIs || expr.op == Op::kLag) return false;
  double a = 0, b = 0;
  if (!is_constant(*expr.args[0], a)) return false;
  if (expr.args.size() > 1 && !is_constant(*expr.args[1], b)) return false;
  value = apply(expr.op, a, b);
  return true;
}

}  // namespace vernier::model
