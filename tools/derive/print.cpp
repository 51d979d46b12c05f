// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/derive/print.h"

#include <algorithm>
#include <cctype>
#include <sstream>
#include <vector>

namespace vernier::derive {
namespace {

using GiNaC::ex;

/// Text of a value without its sign.
struct Piece {
  bool negative = false;
  std::string text;
  int rank = 0;  // order within a product: numbers, symbols and powers, functions, sums
};

class Printer {
 public:
  explicit Printer(Notation notation) : latex_(notation == Notation::kLatex) {}

  std::string whole(const ex& e) {
    const Piece p = piece(e);
    return (p.negative ? "-" : "") + p.text;
  }

 private:
  Piece piece(const ex& e) {
    if (GiNaC::is_a<GiNaC::numeric>(e)) return number(GiNaC::ex_to<GiNaC::numeric>(e));
    if (GiNaC::is_a<GiNaC::symbol>(e)) {
      const std::string name = GiNaC::ex_to<GiNaC::symbol>(e).get_name();
      return {false, latex_ ? latex_name(name) : name, 1};
    }
    if (GiNaC::is_a<GiNaC::constant>(e)) return {false, latex_ ? "\\pi" : "Pi", 1};
    if (GiNaC::is_a<GiNaC::add>(e)) return {false, sum(e), 3};
    if (GiNaC::is_a<GiNaC::mul>(e)) return product(e);
    if (GiNaC::is_a<GiNaC::power>(e)) return product(e);
    if (GiNaC::is_a<GiNaC::function>(e)) return function(e);
    throw std::logic_error("an expression that cannot be printed");
  }

  Piece number(const GiNaC::numeric& n) {
    const bool negative = n.is_negative();
    std::ostringstream out;
    const GiNaC::numeric size = GiNaC::abs(n);
    if (latex_ && size.is_rational() && !size.is_integer())
      out << "\\frac{" << size.numer() << "}{" << size.denom() << "}";
    else
      out << size;
    return {negative, out.str(), 0};
  }

  /// The terms of a sum, in order of their text without sign.
  std::vector<Piece> terms(const ex& e) {
    std::vector<Piece> result;
    for (std::size_t i = 0; i < e.nops(); ++i) result.push_back(piece(e.op(i)));
    std::sort(result.begin(), result.end(), [](const Piece& a, const Piece& b) { return a.text < b.text; });
    return result;
  }

  std::string sum(const ex& e) {
    std::string text;
    for (const Piece& p : terms(e)) {
      if (text.empty())
        text = (p.negative ? "-" : "") + p.text;
      else
        text += (p.negative ? " - " : " + ") + p.text;
    }
    return text;
  }

  /// A factor; sums get parentheses and a first term without minus.
  Piece factor(const ex& e) {
    if (!GiNaC::is_a<GiNaC::add>(e)) return piece(e);
    const bool negative = terms(e).front().negative;
    return {negative, "(" + sum(negative ? ex(-e).expand() : e) + ")", 3};
  }

  Piece power_of(const ex& base, const ex& exponent) {
    if (exponent.is_equal(1)) return factor(base);
    const std::string root = whole(base);
    if (exponent.is_equal(GiNaC::numeric(1, 2)))
      return {false, latex_ ? "\\sqrt{" + root + "}" : "sqrt(" + root + ")", 2};
    Piece below = factor(base);
    const bool even = exponent.info(GiNaC::info_flags::even);
    const bool odd = exponent.info(GiNaC::info_flags::odd);
    if (below.negative && !even && !odd) below = {false, "(" + root + ")", 3};
    const bool atom = below.rank == 1 || below.rank == 3 || (!latex_ && below.rank == 2);
    const std::string inner = atom ? below.text : "(" + below.text + ")";
    const std::string top = whole(exponent);
    const bool simple = exponent.info(GiNaC::info_flags::nonnegint);
    const std::string mark = latex_ ? "^{" + top + "}" : simple ? "^" + top : "^(" + top + ")";
    return {below.negative && odd, inner + mark, 1};
  }

  Piece product(const ex& e) {
    std::vector<Piece> over, under;
    bool negative = false;
    const auto take = [&](const ex& f) {
      ex base = f, exponent = 1;
      if (GiNaC::is_a<GiNaC::power>(f)) base = f.op(0), exponent = f.op(1);
      const bool divides = exponent.info(GiNaC::info_flags::negative);
      Piece p = power_of(base, divides ? ex(-exponent) : exponent);
      negative = negative != p.negative;
      if (p.text != "1") (divides ? under : over).push_back(std::move(p));
    };
    if (GiNaC::is_a<GiNaC::power>(e))
      take(e);
    else
      for (std::size_t i = 0; i < e.nops(); ++i) take(e.op(i));
    const auto order = [](const Piece& a, const Piece& b) {
      return a.rank != b.rank ? a.rank < b.rank : a.text < b.text;
    };
    std::sort(over.begin(), over.end(), order);
    std::sort(under.begin(), under.end(), order);
    const int rank = over.size() == 1 && under.empty() ? over[0].rank : 2;
    return {negative, fraction(joined(over), under), rank};
  }

  std::string joined(const std::vector<Piece>& factors) {
    if (factors.empty()) return "1";
    std::string text;
    for (const Piece& p : factors) text += (text.empty() ? "" : latex_ ? " \\, " : "*") + p.text;
    return text;
  }

  std::string fraction(const std::string& over, const std::vector<Piece>& under) {
    if (under.empty()) return over;
    const std::string below = joined(under);
    if (latex_) return "\\frac{" + over + "}{" + below + "}";
    return over + "/" + (under.size() > 1 ? "(" + below + ")" : below);
  }

  Piece function(const ex& e) {
    std::string args;
    for (std::size_t i = 0; i < e.nops(); ++i) args += (i == 0 ? "" : ", ") + whole(e.op(i));
    std::string name = GiNaC::ex_to<GiNaC::function>(e).get_name();
    if (!latex_) return {false, name + "(" + args + ")", 2};
    name = name == "atan2" ? "\\operatorname{atan2}" : "\\" + name;
    return {false, name + "\\left(" + args + "\\right)", 2};
  }

  bool latex_;
};

std::string escaped(const std::string& name) {
  std::string result;
  for (const char c : name) result += c == '_' ? std::string("\\_") : std::string(1, c);
  return result;
}

}  // namespace

std::string print(const ex& expr, Notation notation) { return Printer(notation).whole(expr); }

std::string latex_name(const std::string& name) {
  const auto letter = [](char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; };
  if (name.size() > 2 && name.compare(0, 2, "d_") == 0) return "\\Delta " + latex_name(name.substr(2));
  if (name.size() > 2 && name[0] == 'E' && std::string("XYZABC").find(name[1]) != std::string::npos)
    return "E_{" + escaped(name.substr(1)) + "}";
  if (name.size() == 1) return name;
  if (letter(name[0]) &&
      std::all_of(name.begin() + 1, name.end(), [](char c) { return c >= '0' && c <= '9'; }))
    return name.substr(0, 1) + "_{" + name.substr(1) + "}";
  return "\\mathrm{" + escaped(name) + "}";
}

}  // namespace vernier::derive
