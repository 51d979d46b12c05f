// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/derive/tidy.h"

namespace vernier::derive {
namespace {

using GiNaC::ex;
/// Longer sums are not factored: it would need seconds and find nothing.
constexpr std::size_t kFactorTerms = 24;

/// sin(x)^n with n >= 2, at any position.
class SquaresOfSines : public GiNaC::map_function {
 public:
  ex operator()(const ex& e) override {
    if (GiNaC::is_a<GiNaC::power>(e) && is_call(e.op(0), "sin") && e.op(1).info(GiNaC::info_flags::posint) &&
        e.op(1) > 1) {
      const GiNaC::numeric n = GiNaC::ex_to<GiNaC::numeric>(e.op(1));
      const GiNaC::numeric half = GiNaC::iquo(n, 2);
      const ex angle = e.op(0).op(0);
      found = true;
      return GiNaC::pow(1 - GiNaC::pow(GiNaC::cos(angle), 2), half) * GiNaC::pow(e.op(0), n - 2 * half);
    }
    return e.map(*this);
  }
  bool found = false;
};

/// Returns the factors of a product with every sum in them multiplied out. The form does not
/// depend on GiNaC's inner order (its factors may be half factored, differently in each run).
ex with_flat_factors(const ex& product) {
  if (GiNaC::is_a<GiNaC::power>(product)) return GiNaC::pow(product.op(0).expand(), product.op(1));
  if (!GiNaC::is_a<GiNaC::mul>(product)) return product.expand();
  ex result = 1;
  for (std::size_t i = 0; i < product.nops(); ++i) result *= with_flat_factors(product.op(i));
  return result;
}

/// Returns factors of an expanded sum, with sines and the like as unknowns; the sum itself if that
/// fails.
ex factored(const ex& sum) {
  GiNaC::exmap unknowns;
  const ex polynomial = sum.to_polynomial(unknowns);
  const ex result =
      with_flat_factors(GiNaC::factor(polynomial)).subs(unknowns, GiNaC::subs_options::no_pattern);
  return (result - sum).expand().is_zero() ? result : sum;
}

}  // namespace

bool is_call(const GiNaC::ex& e, const char* name) {
  return GiNaC::is_a<GiNaC::function>(e) && GiNaC::ex_to<GiNaC::function>(e).get_name() == name;
}

ex expand_inside(const ex& expr) { return expr.expand(GiNaC::expand_options::expand_function_args); }

ex canonical(const ex& expr) {
  ex result = expr.expand();
  for (bool again = true; again;) {
    SquaresOfSines squares;
    const ex next = squares(result);
    again = squares.found;
    if (again) result = next.expand();
  }
  return result;
}

std::size_t term_count(const ex& expr) {
  if (expr.is_zero()) return 0;
  return GiNaC::is_a<GiNaC::add>(expr) ? expr.nops() : 1;
}

ex tidy(const ex& expr) {
  const ex plain = expr.expand(), reduced = canonical(plain);
  const ex& shorter = term_count(reduced) < term_count(plain) ? reduced : plain;
  const std::size_t terms = term_count(shorter);
  return terms < 2 || terms > kFactorTerms ? shorter : factored(shorter);
}

}  // namespace vernier::derive
