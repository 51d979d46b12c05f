// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/effects/gravity.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/maths/factors.h"
#include "tools/model/chain/chain.h"
#include "tools/model/chain/evaluate.h"
#include "tools/text/numbers.h"

namespace vernier::effects {
namespace {

constexpr double kRounding = 1e-9;     // rounding error of directions and of factors of an axis in a sum
constexpr double kLeastOfTerm = 1e-6;  // a smaller term of a wave is a rounding error

bool is_zero(const std::vector<double>& by) {
  return std::all_of(by.begin(), by.end(), [](double one) { return one == 0; });
}

std::vector<double> sum_of(const std::vector<double>& a, const std::vector<double>& b, double sense) {
  std::vector<double> sum = a;
  for (std::size_t i = 0; i < sum.size(); ++i) {
    sum[i] += sense * b[i];
    if (std::abs(sum[i]) < kRounding) sum[i] = 0;
  }
  return sum;
}

/// Writes sin and cos of -x with those of x. The factor of the first axis becomes positive.
double make_forward(std::vector<double>& by) {
  const auto first = std::find_if(by.begin(), by.end(), [](double one) { return one != 0; });
  if (first == by.end() || *first > 0) return 1;
  for (double& one : by) one = one == 0 ? 0 : -one;
  return -1;
}

/// "J2+J3-2*J4".
std::string text_of(const std::vector<double>& by, const model::Machine& machine) {
  std::string text;
  for (std::size_t i = 0; i < by.size(); ++i) {
    if (by[i] == 0) continue;
    text += by[i] < 0 ? "-" : text.empty() ? "" : "+";
    if (std::abs(by[i]) != 1) text += text::number_text(std::abs(by[i])) + "*";
    text += machine.axes[i].name;
  }
  return text;
}

/// Returns a position of an axis that is on no special value.
double somewhere(std::size_t axis) { return 17.3 + 3.7 * static_cast<double>(axis); }

/// Returns values of an expression with all axes at zero, with each axis in turn at 1, and with
/// all axes at arbitrary positions.
Eigen::VectorXd samples(const model::Machine& nominal, const model::Expr& expr) {
  const std::size_t axes = nominal.axes.size();
  model::States states = model::make_states(axes + 2, nominal);
  for (std::size_t i = 0; i < axes; ++i) {
    states.axis[i].setZero();
    states.axis[i][static_cast<Eigen::Index>(i) + 1] = 1;
    states.axis[i][static_cast<Eigen::Index>(axes) + 1] = somewhere(i);
  }
  return model::evaluate(nominal, expr, states).matrix();
}

/// Returns the degrees of freedom of a transform in the order of action.
std::vector<std::size_t> order_of(const model::Transform& transform) {
  if (transform.kind == model::TransformKind::kSixDof) return {0, 1, 2, 3, 4, 5};
  return {1, 0, 2, 3};  // Tz(d) Rz(theta) Tx(a) Rx(alpha)
}

}  // namespace

std::size_t local_axis(const model::Machine& machine, const DofPlace& place) {
  if (transform_at(machine, place).kind == model::TransformKind::kSixDof) return place.dof % 3;
  return place.dof < 2 ? 2 : 0;
}

Wave Wave::constant(double value) {
  Wave wave;
  if (value != 0) wave.terms_[{}] = value;
  return wave;
}

void Wave::add(const Wave& other, double scale) {
  if (scale == 0) return;
  for (const auto& [factors, value] : other.terms_) terms_[factors] += scale * value;
}

Wave Wave::times(const Factor& factor) const {
  Wave product;
  for (const auto& [factors, value] : terms_) {
    std::vector<Factor> all = factors;
    const auto same = std::find(all.begin(), all.end(), factor);
    if (same != all.end() && factor.kind == Factor::Kind::kSine) {
      // sin^2 = 1 - cos^2 makes the representation unique.
      all.erase(same);
      product.terms_[all] += value;
      const Factor cosine{Factor::Kind::kCosine, factor.by};
      all.insert(all.end(), {cosine, cosine});
      std::sort(all.begin(), all.end());
      product.terms_[all] -= value;
      continue;
    }
    all.push_back(factor);
    std::sort(all.begin(), all.end());
    product.terms_[all] += value;
  }
  return product;
}

Wave Wave::times(const Wave& other) const {
  Wave product;
  for (const auto& [factors, value] : other.terms_) {
    Wave part = *this;
    for (const Factor& factor : factors) part = part.times(factor);
    product.add(part, value);
  }
  return product;
}

Wave Wave::cleaned(double scale) const {
  Wave clean;
  for (const auto& [factors, value] : terms_)
    if (std::abs(value) > kLeastOfTerm * scale) clean.terms_[factors] = value;
  return clean;
}

bool Wave::is_constant() const {
  return std::all_of(terms_.begin(), terms_.end(), [](const auto& term) { return term.first.empty(); });
}

std::set<std::vector<double>> Wave::phases() const {
  std::set<std::vector<double>> found;
  for (const auto& [factors, value] : terms_)
    for (const Factor& factor : factors) found.insert(factor.by);
  return found;
}

model::ExprPtr Wave::expression(const model::Machine& machine) const {
  std::string text;
  for (const auto& [factors, value] : terms_) {
    const double size = std::stod(fmt::format("{:.6g}", std::abs(value)));
    std::string term = size == 1 && !factors.empty() ? "" : text::number_text(size);
    for (const Factor& factor : factors) {
      const std::string angle = text_of(factor.by, machine);
      if (!term.empty()) term += "*";
      term += factor.kind == Factor::Kind::kPosition ? angle
              : factor.kind == Factor::Kind::kSine   ? "sin(" + angle + ")"
                                                     : "cos(" + angle + ")";
    }
    text += (value < 0 ? "-" : text.empty() ? "" : "+") + term;
  }
  return model::parse_expression(text.empty() ? "0" : text);
}

GravityChain::GravityChain(const model::Machine& machine)
    : gravity_(machine.gravity[0], machine.gravity[1], machine.gravity[2]) {
  const model::Machine nominal = model::nominal_machine(machine);
  for (const model::Axis& axis : nominal.axes)
    range_.push_back({axis.min.value_or(-1), axis.max.value_or(1)});
  for (const bool workpiece : {false, true}) build(nominal, workpiece);
}

void GravityChain::build(const model::Machine& nominal, bool workpiece) {
  const auto axes = static_cast<Eigen::Index>(nominal.axes.size());
  std::vector<Turn> turns;
  Eigen::Matrix3d home = Eigen::Matrix3d::Identity();
  bool known = true;
  const auto& branch = workpiece ? nominal.workpiece : nominal.tool;
  for (std::size_t t = 0; t < branch.size(); ++t)
    for (const std::size_t d : order_of(branch[t])) {
      Motion motion;
      motion.place = {workpiece, t, d};
      motion.is_angle = is_angle(nominal, motion.place);
      motion.local = Eigen::Vector3d::Unit(static_cast<Eigen::Index>(local_axis(nominal, motion.place)));
      const Eigen::VectorXd value = samples(nominal, *branch[t].dof[d]);
      motion.constant = value[0];
      double whole = value[0];
      for (Eigen::Index i = 0; i < axes; ++i) {
        const double slope = value[i + 1] - value[0];
        motion.by.push_back(std::abs(slope) < kRounding ? 0 : std::round(slope / kRounding) * kRounding);
        whole += slope * somewhere(static_cast<std::size_t>(i));
      }
      known = known && value.allFinite() && std::abs(whole - value[axes + 1]) <= 1e-6 * (1 + std::abs(whole));
      motion.known = known;
      if (known && motion.is_angle) {
        const Eigen::Vector3d axis = home * motion.local;
        if (!is_zero(motion.by)) {
          const double same = turns.empty() ? 0 : turns.back().axis.dot(axis);
          if (std::abs(same) > 1 - kRounding)
            turns.back().by = sum_of(turns.back().by, motion.by, same > 0 ? 1 : -1);
          else
            turns.push_back({axis, motion.by});
        }
        home = home * Eigen::AngleAxisd(maths::kRadPerDeg * motion.constant, motion.local).toRotationMatrix();
      }
      motion.turns = turns;
      motion.home = home;
      motions_.push_back(std::move(motion));
    }
}

const GravityChain::Motion* GravityChain::find(const DofPlace& place) const {
  const auto found =
      std::find_if(motions_.begin(), motions_.end(), [&](const Motion& one) { return one.place == place; });
  return found == motions_.end() || !found->known ? nullptr : &*found;
}

/// R(w, -x) v = w (w.v) + cos x (v - w (w.v)) - sin x (w x v), Rodrigues, one turn after the other.
std::array<Wave, 3> GravityChain::turned_back(std::array<Wave, 3> vector, const std::vector<Turn>& turns,
                                              std::size_t from) {
  for (std::size_t k = from; k < turns.size(); ++k) {
    const Eigen::Vector3d& w = turns[k].axis;
    const Eigen::Matrix3d stays = w * w.transpose(), turning = Eigen::Matrix3d::Identity() - stays;
    Eigen::Matrix3d cross;
    cross << 0, -w.z(), w.y(), w.z(), 0, -w.x(), -w.y(), w.x(), 0;
    std::vector<double> by = turns[k].by;
    if (is_zero(by)) continue;
    const double sense = make_forward(by);
    std::array<Wave, 3> next;
    for (Eigen::Index i = 0; i < 3; ++i) {
      Wave level, sine;
      for (Eigen::Index j = 0; j < 3; ++j) {
        const Wave& part = vector.at(static_cast<std::size_t>(j));
        next.at(static_cast<std::size_t>(i)).add(part, stays(i, j));
        level.add(part, turning(i, j));
        sine.add(part, -sense * cross(i, j));
      }
      next.at(static_cast<std::size_t>(i)).add(level.times({Wave::Factor::Kind::kCosine, by}), 1);
      next.at(static_cast<std::size_t>(i)).add(sine.times({Wave::Factor::Kind::kSine, by}), 1);
    }
    for (Wave& wave : next) wave = wave.cleaned(1);
    vector = std::move(next);
  }
  return vector;
}

namespace {

std::array<Wave, 3> fixed(const Eigen::Vector3d& v) {
  return {Wave::constant(v.x()), Wave::constant(v.y()), Wave::constant(v.z())};
}

}  // namespace

std::optional<std::array<Wave, 3>> GravityChain::direction(const DofPlace& place) const {
  const Motion* const motion = find(place);
  if (motion == nullptr) return std::nullopt;
  const std::array<Wave, 3> home = turned_back(fixed(gravity_), motion->turns, 0);
  std::array<Wave, 3> local;
  for (Eigen::Index i = 0; i < 3; ++i) {
    Wave& wave = local.at(static_cast<std::size_t>(i));
    for (Eigen::Index j = 0; j < 3; ++j) wave.add(home.at(static_cast<std::size_t>(j)), motion->home(j, i));
    wave = wave.cleaned(1);
  }
  return local;
}

std::optional<Wave> GravityChain::across(const DofPlace& angle, std::size_t toward) const {
  const auto down = direction(angle);
  if (!down) return std::nullopt;
  Eigen::Index own = 0;
  find(angle)->local.maxCoeff(&own);
  if (static_cast<std::size_t>(own) == toward) return std::nullopt;
  // (t x g) . a for unit vectors of one frame: +- the component along the third.
  const std::size_t third = 3 - toward - static_cast<std::size_t>(own);
  const bool cyclic = (toward + 1) % 3 == third;  // t x third = a
  Wave wave;
  wave.add((*down).at(third), cyclic ? 1 : -1);
  return wave;
}

bool GravityChain::may_turn(const DofPlace& angle) const {
  const auto down = direction(angle);
  if (!down) return true;
  Eigen::Index own = 0;
  find(angle)->local.maxCoeff(&own);
  const auto at = static_cast<std::size_t>(own);
  return (*down).at((at + 1) % 3).terms() + (*down).at((at + 2) % 3).terms() > 0;
}

bool GravityChain::is_rigid(const DofPlace& transform) const {
  return std::all_of(motions_.begin(), motions_.end(), [&](const Motion& one) {
    const bool within = one.place.workpiece == transform.workpiece &&
                        one.place.transform == transform.transform && one.is_angle;
    return !within || (one.known && one.constant == 0 && is_zero(one.by));
  });
}

std::optional<Wave> GravityChain::along(const DofPlace& length) const {
  const auto down = direction(length);
  if (!down) return std::nullopt;
  Eigen::Index own = 0;
  find(length)->local.maxCoeff(&own);
  return (*down).at(static_cast<std::size_t>(own));
}

std::optional<Wave> GravityChain::moment(const DofPlace& joint, std::size_t transform) const {
  const Motion* const at = find(joint);
  if (at == nullptr || transform < joint.transform) return std::nullopt;
  const Eigen::Vector3d axis = at->home * at->local;
  Wave sum;
  double reach = 0;
  for (const Motion* piece = at + 1; piece != motions_.data() + motions_.size(); ++piece) {
    if (piece->place.workpiece != joint.workpiece || piece->place.transform > transform) break;
    if (!piece->known) return std::nullopt;
    if (piece->is_angle) continue;
    // The term in its own frame: both the joint's axis and gravity are rotated back into it.
    const std::array<Wave, 3> a = turned_back(fixed(axis), piece->turns, at->turns.size());
    const std::array<Wave, 3> g = turned_back(fixed(gravity_), piece->turns, 0);
    const Eigen::Vector3d l = piece->home * piece->local;
    Wave level;  // a . (l x g) = l . (g x a)
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
      level.add(g.at(j).times(a.at(k)), l[static_cast<Eigen::Index>(i)]);
      level.add(g.at(k).times(a.at(j)), -l[static_cast<Eigen::Index>(i)]);
    }
    double longest = std::abs(piece->constant);
    sum.add(level, piece->constant);
    for (std::size_t i = 0; i < piece->by.size(); ++i) {
      if (piece->by[i] == 0) continue;
      std::vector<double> one(piece->by.size(), 0.0);
      one[i] = 1;
      sum.add(level.times({Wave::Factor::Kind::kPosition, one}), piece->by[i]);
      longest += std::abs(piece->by[i]) * std::max(std::abs(range_[i][0]), std::abs(range_[i][1]));
    }
    reach += longest;
  }
  if (!(reach > 0)) return std::nullopt;
  Wave whole;
  whole.add(sum, 1 / reach);
  return whole.cleaned(1);
}

}  // namespace vernier::effects
