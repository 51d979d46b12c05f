// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/hidden_survey_alternatives.h"
#include "tests/support/hidden_survey_inputs.h"

#include <algorithm>
#include <limits>

namespace vernier::support {

using namespace vernier::text;
namespace {

/// Share of the truth's column that the alternative's columns cannot follow.
double missed(const Eigen::MatrixXd& basis, const Eigen::VectorXd& truth) {
  if (truth.size() == 0 || truth.squaredNorm() == 0) return 1;
  return 1 - (basis.transpose() * truth).squaredNorm() / truth.squaredNorm();
}

/// Temperatures and loads have a zero of their own (their reference); what a voltage is at zero nobody knows.
bool has_zero(const AlternativeTest& court, const Form& form) {
  return std::none_of(court.columns.begin(), court.columns.end(), [&](const LoggedColumn& c) {
    return c.unit == std::string("V") &&
           std::find(form.inputs.begin(), form.inputs.end(), c.name) != form.inputs.end();
  });
}

/// `with_reference`: an input's reference is one more unknown of the alternative.
void judge(const AlternativeTest& court, const Form& form, bool with_reference, std::vector<Cause>& accept,
           std::vector<Alternative>& alternatives) {
  if (is_accepted(accept, form.cause)) return;
  const Eigen::MatrixXd basis = orthonormal(court.form_columns(form, with_reference));
  if (basis.cols() == 0) return;
  const bool same_inputs = form.inputs == court.inputs;
  const double unseen = missed(basis, court.truth);
  // A smooth function that can also be a line says the same; a quantity that the truth does not know, without
  // a constant beside it, says something else however close it comes.
  const bool other_quantity = !with_reference && !same_inputs && !form.inputs.empty();
  if (!other_quantity && basis.cols() + form.free_numbers > court.truth_width && unseen < 0.02) return;
  if (same_inputs && is_by_speed(form) == court.by_speed && unseen < 1e-4)
    return accept.push_back(form.cause);
  const double excess = court.residual.squaredNorm() - (basis.transpose() * court.residual).squaredNorm() -
                        court.truth_chi_square;
  const auto same = std::find_if(alternatives.begin(), alternatives.end(),
                                 [&](const Alternative& r) { return r.cause == form.cause; });
  const Alternative alternative{form.cause, form.places.front().text, excess};
  if (same == alternatives.end())
    alternatives.push_back(alternative);
  else if (excess < same->excess)
    *same = alternative;
}

}  // namespace

bool is_by_speed(const Form& form) {
  return std::any_of(form.places.begin(), form.places.end(), [](const Place& place) {
    return place.text.find("feed") != std::string::npos || place.text.find("*v") != std::string::npos;
  });
}

double chi_square_with(const Eigen::MatrixXd& columns, const Eigen::VectorXd& residual) {
  return residual.squaredNorm() - (orthonormal(columns).transpose() * residual).squaredNorm();
}

bool is_accepted(const std::vector<Cause>& accept, const Cause& cause) {
  return std::any_of(accept.begin(), accept.end(), [&](const Cause& a) {
    return a.effect == cause.effect && (a.axis.empty() || a.axis == cause.axis) &&
           (a.input.empty() || a.input == cause.input);
  });
}

std::vector<Alternative> find_alternatives(const AlternativeTest& court, std::vector<Cause>& accept,
                                           Draw& draw) {
  std::vector<Alternative> alternatives;
  for (const EffectScan& scan : effect_scans())
    for (int step = 0; step < scan.steps; ++step) {
      // Half as wide again on both sides: a search may wander out of what is plausible.
      const Share share = [&] { return 2 * (step + 0.5) / scan.steps - 0.5; };
      for (const Form& form : forms_of(scan.effect, court.geometry, court.columns, court.runs, share, draw))
        for (const bool with_reference : {true, false})
          if (with_reference || (!form.reference_factor.empty() && has_zero(court, form)))
            judge(court, form, with_reference, accept, alternatives);
    }
  // A twin that was found late may have been an alternative under another of its forms.
  std::erase_if(alternatives, [&](const Alternative& r) { return is_accepted(accept, r.cause); });
  std::sort(alternatives.begin(), alternatives.end(),
            [](const Alternative& a, const Alternative& b) { return a.excess < b.excess; });
  return alternatives;
}

}  // namespace vernier::support
