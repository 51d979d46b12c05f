// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/diagnose/propose/pulls.h"

#include <algorithm>
#include <cmath>

#include "tools/maths/orthonormal.h"
#include "tools/model/chain/chain.h"
#include "tools/model/chain/evaluate.h"

namespace vernier::diagnose {
namespace {

/// Angles of a sixdof: rX is its fourth degree of freedom.
constexpr std::size_t kFirstAngle = 3;

/// Is a column a sum of others, up to a cosine of `alike`?
bool is_held_by(const Eigen::VectorXd& column, const std::vector<Eigen::VectorXd>& others, double alike) {
  if (others.empty()) return false;
  Eigen::MatrixXd all(column.size(), static_cast<Eigen::Index>(others.size()));
  for (std::size_t i = 0; i < others.size(); ++i) all.col(static_cast<Eigen::Index>(i)) = others[i];
  const Eigen::MatrixXd basis = maths::orthonormal(all, 1e-6, nullptr);
  return (basis.transpose() * column).norm() > alike * column.norm();
}

}  // namespace

Pulls::Pulls(const Evidence& evidence)
    : evidence_(evidence), machine_(evidence.machine()), gravity_(machine_), axes_(machine_) {}

bool Pulls::asks(const effects::EffectForm& form) {
  return form.asks_for("across") || form.asks_for("across1") || form.asks_for("along") ||
         form.asks_for("moment");
}

bool Pulls::admits(const effects::EffectForm& form, const effects::DofPlace& place) const {
  if (place.workpiece) return false;
  if (form.place == effects::PlaceRule::kBend)
    return effects::transform_at(machine_, place).kind == model::TransformKind::kSixDof &&
           place.dof == kFirstAngle && gravity_.is_rigid(place);
  if (form.place != effects::PlaceRule::kLink) return true;
  // The own rotation of a joint is compliance.
  const auto axis = axes_.axis_of(place);
  return effects::is_angle(machine_, place) != form.asks_for("along") &&
         !(axis && axes_.is_own(*axis, place));
}

/// Driven by several axes, or by any; and small enough for a tick.
bool Pulls::is_told(const std::optional<effects::Wave>& wave, bool several) const {
  if (!wave || wave->terms() > evidence_.thresholds().search.candidates.most_terms_of_gravity) return false;
  const auto phases = wave->phases();
  if (!several) return !phases.empty();
  return phases.size() > 1 || std::any_of(phases.begin(), phases.end(), [](const std::vector<double>& by) {
           return std::count_if(by.begin(), by.end(), [](double one) { return one != 0; }) > 1;
         });
}

std::vector<effects::Choice> Pulls::variants(const effects::Choice& choice) const {
  using effects::PlaceRule;
  const effects::EffectForm& form = *choice.form;
  const effects::DofPlace& place = *choice.place;
  std::vector<effects::Choice> list;
  const std::size_t own = effects::local_axis(machine_, place);
  const bool joint = form.place == PlaceRule::kJoint;
  // About a joint, the sine and the cosine of a sum of parallel joints have their own forms.
  const auto is_several = [&](const std::optional<effects::Wave>& wave) {
    return joint ? is_told(wave, false) && wave->terms() > 1 : is_told(wave, true);
  };
  if (form.place == PlaceRule::kBend) {
    for (std::size_t toward = 0; toward < 3; ++toward) {
      effects::DofPlace a = place, b = place;
      a.dof = kFirstAngle + (toward == 0 ? 1 : 0);
      b.dof = kFirstAngle + (toward == 2 ? 1 : 2);
      const auto one = gravity_.across(a, toward), other = gravity_.across(b, toward);
      const bool told = is_told(one, false) && is_told(other, false);
      if (!told || !(is_several(one) || is_several(other))) continue;
      list.push_back(choice);
      list.back().toward = toward;
      list.back().place = a;
    }
    return list;
  }
  if (form.asks_for("moment")) {
    with_masses(choice, list);
    return list;
  }
  if (form.asks_for("along")) {
    if (is_several(gravity_.along(place))) list.push_back(choice);
    return list;
  }
  const std::size_t next = (own + 1) % 3, last = (own + 2) % 3;
  if (form.asks_for("across1")) {
    const auto one = gravity_.across(place, next), other = gravity_.across(place, last);
    const bool told =
        joint ? is_told(one, false) && is_told(other, false)
              : is_told(one, false) && is_told(other, false) && (is_several(one) || is_several(other));
    if (told) list.push_back(choice);
    return list;
  }
  for (const std::size_t toward : {next, last}) {
    if (!is_several(gravity_.across(place, toward))) continue;
    list.push_back(choice);
    list.back().toward = toward;
  }
  return list;
}

Eigen::VectorXd Pulls::column(const effects::Wave& wave) const {
  const model::ExprPtr expr =
      model::parse_expression_for(machine_, model::to_text(*wave.expression(machine_)));
  const model::Column all = model::evaluate(machine_, *expr, evidence_.measurement().states);
  Eigen::VectorXd read = evidence_.at_readings(all);
  read.array() -= read.mean();
  return read;
}

/// Masses in order from the tool to the base, first the load at the tip. A mass is excluded if its moment is
/// proportional to that of another over the rows, or to that of a bar at the joint itself.
void Pulls::with_masses(const effects::Choice& choice, std::vector<effects::Choice>& list) const {
  const effects::DofPlace& joint = *choice.place;
  const bool beside_own = choice.form->asks_for("across1");
  const double alike = evidence_.thresholds().candidates.same_moment;
  std::vector<Eigen::VectorXd> own, seen;
  for (const std::size_t turn : {std::size_t{1}, std::size_t{2}}) {
    const auto bar = gravity_.across(joint, (effects::local_axis(machine_, joint) + turn) % 3);
    if (is_told(bar, false)) own.push_back(column(*bar));
  }
  if (beside_own && own.size() < 2)
    return;  // a link that gravity does not turn in both directions has no separate unknown for each
  if (!beside_own) seen = own;
  for (std::size_t m = machine_.tool.size(); m-- > joint.transform;) {
    const auto wave = gravity_.moment(joint, m);
    if (!is_told(wave, true) || wave->phases().size() < 2) continue;
    Eigen::VectorXd here = column(*wave);
    const bool known = std::any_of(seen.begin(), seen.end(), [&](const Eigen::VectorXd& other) {
      return std::abs(here.dot(other)) > alike * here.norm() * other.norm();
    });
    if (known || !(here.norm() > 0) || (beside_own && is_held_by(here, own, alike))) continue;
    seen.push_back(std::move(here));
    list.push_back(choice);
    list.back().mass = m;
    // In addition to the joint's own link, one load is sufficient: that of the tool.
    if (beside_own) return;
  }
}

}  // namespace vernier::diagnose
