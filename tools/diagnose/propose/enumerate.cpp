// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/diagnose/propose/enumerate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <string_view>
#include <tuple>

#include "tools/diagnose/propose/pulls.h"
#include "tools/effects/probe.h"
#include "tools/maths/orthonormal.h"
#include "tools/model/chain/chain.h"
#include "tools/model/chain/chain_rows.h"
#include "tools/model/chain/evaluate.h"
#include "tools/vibration/signal_features.h"

namespace vernier::diagnose {
namespace {

using model::is_symbol;

bool is_wave(const model::Expr& node) { return node.op == model::Op::kSin || node.op == model::Op::kCos; }

/// Is the condition true for a node of the term that is inside no function?
template <class Is>
bool any_outside_functions(const model::Expr& node, const Is& is) {
  return is(node) || (model::function_name(node.op) == nullptr &&
                      std::any_of(node.args.begin(), node.args.end(),
                                  [&](const auto& arg) { return any_outside_functions(*arg, is); }));
}

bool grows_with_axis(const model::Expr& node) {
  return any_outside_functions(node, [](const model::Expr& one) { return is_symbol(one, "{q}"); });
}

/// Is {q} raised to a power, or multiplied by a sum?
bool is_bent_or_mixed(const model::Expr& node) {
  if (node.op == model::Op::kPower) return grows_with_axis(*node.args[0]);
  const auto is_sum = [](const model::ExprPtr& one) {
    return one->op == model::Op::kAdd || one->op == model::Op::kSubtract;
  };
  return node.op == model::Op::kMultiply && (is_sum(node.args[0]) || is_sum(node.args[1])) &&
         grows_with_axis(node);
}

/// Is the sign set by a wave? It has one value only if the wave never crosses zero.
bool is_switched_by_wave(const model::Expr& node) {
  return (node.op == model::Op::kSign && is_wave(*node.args[0])) ||
         std::any_of(node.args.begin(), node.args.end(),
                     [](const model::ExprPtr& arg) { return is_switched_by_wave(*arg); });
}

bool any_tree(const effects::EffectForm& form, bool (*is)(const model::Expr&)) {
  return std::any_of(form.trees.begin(), form.trees.end(),
                     [&](const model::ExprPtr& tree) { return is(*tree); });
}

std::vector<double> logarithmic(double low, double high, std::size_t count) {
  std::vector<double> grid;
  for (std::size_t i = 0; i < count; ++i)
    grid.push_back(low * std::pow(high / low, static_cast<double>(i) / static_cast<double>(count - 1)));
  return grid;
}

/// Is the term, or one summand of it, the same whatever the inputs are?
bool is_without_input(const model::Expr& term) {
  if (term.op == model::Op::kAdd || term.op == model::Op::kSubtract)
    return std::ranges::any_of(term.args, [](const model::ExprPtr& part) { return is_without_input(*part); });
  return !model::any_node(term, [](const model::Expr& node) {
    return std::ranges::any_of(std::array{"{T}", "{S}", "{L}", "{F}", "{V}"},
                               [&](std::string_view mark) { return is_symbol(node, mark); });
  });
}

/// Lists the candidates of one survey.
class Enumerator {
 public:
  Enumerator(const Evidence& evidence, const std::vector<effects::Effect>& effects)
      : evidence_(evidence),
        thresholds_(evidence.thresholds().candidates),
        extent_(evidence.thresholds().search.candidates),
        machine_(evidence.machine()),
        axes_(machine_),
        effects_(effects),
        pulls_(evidence) {
    for (std::size_t axis = 0; axis < machine_.axes.size(); ++axis) {
      own_.push_back(axes_.own(axis));
      range_.push_back(evidence.range_of(axis));
      shortest_.push_back(shortest_told_apart(evidence, axis));
    }
    is_outshone_ = outshone_places(evidence);
    distinct_ = distinct_places(evidence, true);
    find_sag();
    find_sums();
    has_normals_ =
        std::any_of(evidence.measurement().observations.begin(), evidence.measurement().observations.end(),
                    [](const model::Observation& o) { return o.kind == model::ObservationKind::kD; });
  }

  std::vector<ScannedCandidate> all() {
    for (const effects::Effect& effect : effects_)
      for (const effects::EffectForm& form : effect.forms) {
        if (!goes_with_readings(effect, form)) continue;
        effects::Choice choice;
        choice.effect = &effect;
        choice.form = &form;
        with_inputs(choice);
      }
    return std::move(list_);
  }

 private:
  /// Touches are readings along a normal. Readings that a trigger takes have no second clock.
  bool goes_with_readings(const effects::Effect& effect, const effects::EffectForm& form) const {
    if (form.place == effects::PlaceRule::kSeveral) return false;  // responses.h searches them
    if (effect.needs_touches) return has_normals_;
    return !(form.place == effects::PlaceRule::kEachAxis && has_normals_);
  }

  bool answers(const effects::DofPlace& place) const {
    const std::size_t at = evidence_.index_of(place);
    return evidence_.response(at).squaredNorm() > 0 && !is_outshone_[at];
  }

  /// The added row at the base gets effects that no row of the file can express. It gets no effect
  /// that an axis drives, because the transform of that axis carries such an effect.
  bool is_open(const effects::DofPlace& place, const effects::Choice& choice) const {
    if (!effects::is_stand_in(machine_, place)) return true;
    return !choice.axis && std::find(distinct_.begin(), distinct_.end(), place) != distinct_.end();
  }

  /// Finds the locations that rotate about a horizontal axis or move along gravity, on average
  /// over some rows.
  void find_sag() {
    model::Machine probed = machine_;
    std::vector<char> active(probed.statics.size(), 0);
    for (const effects::DofPlace& place : evidence_.places()) effects::add_probe(probed, place);
    active.resize(probed.statics.size(), 1);
    active.resize(probed.statics.size() + 6 * probed.axes.size(), 0);
    model::Machine table = machine_;
    table.tool.clear();  // W^-1 alone: from the base frame to the workpiece
    const model::ChainRows chain(probed, evidence_.measurement().states, active);
    const model::ChainRows base(table, evidence_.measurement().states);
    const Eigen::Vector3d gravity(machine_.gravity[0], machine_.gravity[1], machine_.gravity[2]);
    std::vector<double> across(evidence_.places().size(), 0), along(across.size(), 0);
    const std::size_t stride = std::max<std::size_t>(1, evidence_.measurement().rows() / 50);
    double count = 0;
    std::vector<model::Twist> twists;
    for (std::size_t row = 0; row < evidence_.measurement().rows(); row += stride) {
      chain.pose(row, twists);
      const Eigen::Vector3d down = base.pose(row).rotation * gravity;
      ++count;
      for (std::size_t k = 0; k < twists.size(); ++k) {
        const std::size_t place = chain.keys()[k] - machine_.statics.size();
        if (effects::is_angle(machine_, evidence_.places()[place])) {
          if (twists[k].rotation.norm() > 0)
            across[place] +=
                std::sqrt(1 - std::min(1.0, std::pow(twists[k].rotation.normalized().dot(down), 2)));
        } else if (twists[k].point.norm() > 0) {
          along[place] += std::abs(twists[k].point.normalized().dot(down));
        }
      }
    }
    for (std::size_t i = 0; i < across.size(); ++i) {
      const double share = effects::is_angle(machine_, evidence_.places()[i]) ? across[i] : along[i];
      const bool sags = share > thresholds_.sag_share * count;
      if (sags) sag_.push_back(evidence_.places()[i]);
    }
  }

  /// Finds sums of the angles of successive parallel joints. The direction of a link depends on
  /// them.
  void find_sums() {
    sums_.resize(machine_.axes.size());
    std::vector<std::size_t> rotary;
    for (std::size_t axis = 0; axis < machine_.axes.size(); ++axis)
      if (machine_.axes[axis].rotary && own_[axis] && !own_[axis]->workpiece) rotary.push_back(axis);
    std::sort(rotary.begin(), rotary.end(),
              [&](std::size_t a, std::size_t b) { return own_[a]->transform < own_[b]->transform; });
    const model::Machine nominal = model::nominal_machine(machine_);
    const model::States zero = model::make_states(1, nominal);
    model::Machine probed = nominal;
    std::vector<char> active(probed.statics.size(), 0);
    for (const std::size_t axis : rotary) effects::add_probe(probed, *own_[axis]);
    active.resize(probed.statics.size(), 1);
    active.resize(probed.statics.size() + 6 * probed.axes.size(), 0);
    std::vector<Eigen::Vector3d> direction(rotary.size(), Eigen::Vector3d::Zero());
    const model::ChainRows chain(probed, zero, active);
    std::vector<model::Twist> twists;
    chain.pose(0, twists);
    for (std::size_t k = 0; k < twists.size(); ++k)
      direction[chain.keys()[k] - machine_.statics.size()] = twists[k].rotation.normalized();
    for (std::size_t i = 0; i < rotary.size(); ++i) {
      // From the first joint that is parallel to this one without interruption, up to each joint
      // at or behind it.
      std::size_t first = i;
      while (first > 0 && std::abs(direction[first - 1].dot(direction[i])) > thresholds_.parallel_cosine)
        --first;
      for (std::size_t last = i; last < rotary.size(); ++last) {
        if (std::abs(direction[last].dot(direction[i])) < thresholds_.parallel_cosine) break;
        model::ExprPtr sum = model::make_symbol(machine_.axes[rotary[first]].name);
        for (std::size_t k = first + 1; k <= last; ++k) {
          const model::Op op =
              direction[k].dot(direction[first]) < 0 ? model::Op::kSubtract : model::Op::kAdd;
          sum = model::make_node(op, {sum, model::make_symbol(machine_.axes[rotary[k]].name)});
        }
        sums_[rotary[i]].push_back(model::to_text(*sum));
      }
    }
  }

  void with_inputs(const effects::Choice& choice) {
    const effects::EffectForm& form = *choice.form;
    if (!form.asks_for_input()) return with_axis(choice);
    const effects::InputClass wanted = form.asks_for("T")   ? effects::InputClass::kTemperature
                                       : form.asks_for("L") ? effects::InputClass::kLoad
                                       : form.asks_for("F") ? effects::InputClass::kFeature
                                                            : effects::InputClass::kOther;
    for (std::size_t i = 0; i < machine_.inputs.size(); ++i) {
      if (effects::class_of_input(machine_.inputs[i]) != wanted) continue;
      if (wanted == effects::InputClass::kOther && is_like_a_clock(i)) continue;
      const bool stands_still = !evidence_.varies(evidence_.measurement().states.input[i]);
      if (stands_still && has_a_part_without_input(form)) continue;
      effects::Choice one = choice;
      one.inputs = {machine_.inputs[i].name};
      one.units = {machine_.inputs[i].unit};
      if (form.asks_for("ref")) one.reference = evidence_.reference_of(i);
      if (!form.asks_for("S")) {
        with_axis(one);
        continue;
      }
      for (std::size_t k = i + 1; k < machine_.inputs.size(); ++k) {
        if (effects::class_of_input(machine_.inputs[k]) != wanted) continue;
        effects::Choice two = one;
        two.inputs.push_back(machine_.inputs[k].name);
        two.units.push_back(machine_.inputs[k].unit);
        with_axis(two);
      }
    }
  }

  /// Example: growth with an own reference, k*(T-20)+c. If the input stands still, the constant part alone
  /// would explain the rows.
  static bool has_a_part_without_input(const effects::EffectForm& form) {
    return std::ranges::any_of(form.trees,
                               [](const model::ExprPtr& tree) { return is_without_input(*tree); });
  }

  /// Does a column increase with the rows, as a cycle counter or a time stamp does? It has the
  /// same information as time.
  bool is_like_a_clock(std::size_t input) const {
    const std::vector<std::size_t>& rows = evidence_.rows();
    Eigen::MatrixXd both(static_cast<Eigen::Index>(rows.size()), 2);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(i), row = static_cast<Eigen::Index>(rows[i]);
      both(at, 0) = static_cast<double>(rows[i]);
      both(at, 1) = evidence_.measurement().states.input[input][row];
    }
    const Eigen::ArrayXd steps = both.col(1).tail(both.rows() - 1) - both.col(1).head(both.rows() - 1);
    if ((steps >= 0).all() || (steps <= 0).all()) return true;
    both.rowwise() -= both.colwise().mean();
    const double common = both.col(0).dot(both.col(1));
    return std::abs(common) > thresholds_.like_a_clock * both.col(0).norm() * both.col(1).norm();
  }

  void with_axis(effects::Choice choice) {
    const effects::EffectForm& form = *choice.form;
    const bool driven = form.asks_for("q") || form.asks_for("hats") ||
                        form.place == effects::PlaceRule::kOwn || form.place == effects::PlaceRule::kCross ||
                        form.place == effects::PlaceRule::kTurn || form.place == effects::PlaceRule::kJoint;
    if (form.place == effects::PlaceRule::kEachAxis || !driven) return with_place(choice);
    for (std::size_t axis = 0; axis < machine_.axes.size(); ++axis) {
      if (!own_[axis]) continue;
      const bool turns =
          form.any([](const model::Expr& node) { return is_wave(node) && is_symbol(*node.args[0], "{q}"); });
      if (turns && !machine_.axes[axis].rotary) continue;  // degrees of a revolution, not millimetres
      // Once per revolution. The effect of gravity on an arm has that period at any travel.
      const bool own_wave = form.place == effects::PlaceRule::kOwn ||
                            form.place == effects::PlaceRule::kCross ||
                            form.place == effects::PlaceRule::kTurn;
      const double travel = range_[axis].high - range_[axis].low;
      if (turns && own_wave && travel < thresholds_.least_of_a_turn * 360) continue;
      if (!turns && machine_.axes[axis].rotary && !has_meaning_of_turns(form)) continue;
      effects::Choice one = choice;
      one.axis = axis;
      set_range(one, axis);
      if (form.place != effects::PlaceRule::kPair) {
        with_place(one);
        continue;
      }
      for (std::size_t other = axis + 1; other < machine_.axes.size(); ++other) {
        if (!own_[other] || machine_.axes[axis].rotary || machine_.axes[other].rotary) continue;
        effects::Choice two = one;
        two.axis2 = other;
        with_place(two);
      }
    }
  }

  /// A power of an angle has no meaning: errors of a rotary axis are periodic, or a table.
  static bool has_meaning_of_turns(const effects::EffectForm& form) {
    const auto bent = [](const model::Expr& tree) { return any_outside_functions(tree, is_bent_or_mixed); };
    if (form.asks_for("mid") || any_tree(form, bent)) return false;
    return form.place == effects::PlaceRule::kOwn || !any_tree(form, grows_with_axis);
  }

  /// A piecewise linear basis uses the measured range. A wave uses the declared range if that was
  /// measured too.
  void set_range(effects::Choice& choice, std::size_t axis) const {
    std::tie(choice.from, choice.to) = range_[axis].outwards();
    const model::Axis& item = machine_.axes[axis];
    if (choice.form->asks_for("hats") || !item.min || !item.max) return;
    if (choice.to - choice.from < thresholds_.declared_range_share * (*item.max - *item.min)) return;
    choice.from = *item.min;
    choice.to = *item.max;
  }

  void with_place(effects::Choice& choice) {
    const effects::EffectForm& form = *choice.form;
    const auto at_each = [&](const std::vector<effects::DofPlace>& places, const auto& admitted) {
      for (const effects::DofPlace& place : places)
        if (answers(place) && is_open(place, choice) && admitted(place)) {
          effects::Choice one = choice;
          one.place = place;
          with_sum(one);
        }
    };
    const auto own = choice.axis ? own_[*choice.axis] : std::nullopt;
    const auto at_own_transform = [&](const effects::DofPlace& p) {
      return own && p.workpiece == own->workpiece && p.transform == own->transform;
    };
    const bool rotary = choice.axis && machine_.axes[*choice.axis].rotary;
    switch (form.place) {
      case effects::PlaceRule::kOwn:
        if (needs_linear(form) && rotary) return;
        at_each({*own}, [](const effects::DofPlace&) { return true; });
        break;
      case effects::PlaceRule::kCross:
        at_each(evidence_.places(), [&](const effects::DofPlace& p) {
          return at_own_transform(p) && !(p == *own) && !effects::is_angle(machine_, p);
        });
        break;
      case effects::PlaceRule::kTurn:
        at_each(evidence_.places(), [&](const effects::DofPlace& p) {
          return at_own_transform(p) && !(p == *own) && effects::is_angle(machine_, p);
        });
        break;
      case effects::PlaceRule::kLength:
      case effects::PlaceRule::kAngle:
        at_each(distinct_, [&](const effects::DofPlace& p) {
          return effects::is_angle(machine_, p) == (form.place == effects::PlaceRule::kAngle);
        });
        break;
      case effects::PlaceRule::kBase:
      case effects::PlaceRule::kBaseTurn:
        at_each(effects::carrier_places(machine_), [&](const effects::DofPlace& p) {
          return effects::is_angle(machine_, p) == (form.place == effects::PlaceRule::kBaseTurn);
        });
        break;
      case effects::PlaceRule::kSag:
        if (rotary && !form.any(is_wave)) return;
        at_each(distinct_, [&](const effects::DofPlace& p) {
          const auto sags = [&](const effects::DofPlace& x) {
            return std::find(sag_.begin(), sag_.end(), x) != sag_.end();
          };
          return rotary ? sags(*own) && !(p == *own) : sags(p) && !at_own_transform(p);
        });
        break;
      case effects::PlaceRule::kJoint:
        if (!rotary || std::find(sag_.begin(), sag_.end(), *own) == sag_.end()) return;
        at_each({*own}, [](const effects::DofPlace&) { return true; });
        break;
      case effects::PlaceRule::kLink:
      case effects::PlaceRule::kBend:
        at_each(distinct_, [&](const effects::DofPlace& p) { return pulls_.admits(form, p); });
        break;
      case effects::PlaceRule::kNormal:
        if (has_normals_ && !effects::base_places(machine_).empty()) with_sum(choice);
        break;
      case effects::PlaceRule::kPoint:
        for (const effects::DofPlace& place : points()) {
          choice.place = place;
          with_sum(choice);
        }
        break;
      case effects::PlaceRule::kEachAxis:
      case effects::PlaceRule::kPair:
        with_sum(choice);
        break;
      case effects::PlaceRule::kSeveral:
        break;
    }
  }

  /// Returns the tool point, or the point on the workpiece, if the readings show its place only together with
  /// free parameters of the model (the zero and the length of the last joint). One length of it alone would
  /// leave the whole error of the others in these parameters.
  std::vector<effects::DofPlace> points() const {
    std::vector<effects::DofPlace> found;
    for (const bool workpiece : {false, true}) {
      const std::vector<model::Transform>& branch = workpiece ? machine_.workpiece : machine_.tool;
      if (branch.empty() || branch.back().kind != model::TransformKind::kSixDof) continue;
      const effects::DofPlace last{workpiece, branch.size() - 1, 0};
      if (axes_.axis_of(last) || effects::is_stand_in(machine_, last)) continue;
      Eigen::MatrixXd columns(evidence_.residual().size(), 3);
      for (std::size_t d = 0; d < 3; ++d)
        columns.col(static_cast<Eigen::Index>(d)) =
            evidence_.response(evidence_.index_of({workpiece, last.transform, d}));
      const Eigen::VectorXd before = columns.colwise().norm();
      columns = evidence_.beside_model(columns);
      for (Eigen::Index d = 0; d < 3; ++d)
        if (columns.col(d).norm() <= evidence_.thresholds().shape.own * before[d]) columns.col(d).setZero();
      const Eigen::Index own = maths::orthonormal(columns, evidence_.thresholds().shape.own, nullptr).cols();
      if (own > 0 && own < 3) found.push_back(last);
    }
    return found;
  }

  /// Effects on lengths (thermal growth, squareness) do not apply to rotary axes.
  static bool needs_linear(const effects::EffectForm& form) { return form.asks_for("T"); }

  void with_sum(const effects::Choice& choice) {
    if (Pulls::asks(*choice.form)) {
      for (const effects::Choice& one : pulls_.variants(choice)) finish(one);
      return;
    }
    if (!choice.form->asks_for("sum")) return with_runs(choice);
    for (const std::string& sum : sums_[*choice.axis]) {
      // The two-link forms are the same as one link if the sum is the joint itself.
      if (choice.form->asks_for("q") && sum == machine_.axes[*choice.axis].name) continue;
      effects::Choice one = choice;
      one.sum = sum;
      with_runs(one);
    }
  }

  void with_runs(const effects::Choice& choice) {
    if (!choice.form->asks_for("runs")) return with_hats(choice);
    std::set<std::size_t> seen;
    for (const std::size_t row : evidence_.rows()) seen.insert(evidence_.measurement().states.run[row]);
    if (seen.size() < 2) return;
    const auto& names = evidence_.measurement().states.run_names;
    effects::Choice all = choice;
    for (const std::size_t run : seen) {
      effects::Choice one = choice;
      one.runs = {names[run]};
      finish(one);
      if (run != *seen.begin()) all.runs.push_back(names[run]);
    }
    if (all.runs.size() > 1 && all.runs.size() <= thresholds_.most_steps_of_runs) finish(all);
  }

  void with_hats(const effects::Choice& choice) {
    if (choice.form->asks_for("hats")) {
      const auto nodes = static_cast<double>(choice.form->hats);
      const Evidence::Range& range = range_[*choice.axis];
      if (range.step <= 0 || (range.high - range.low) / range.step + 1 < nodes) return;
      if (nodes * thresholds_.readings_per_hat > static_cast<double>(evidence_.rows().size())) return;
      if (!is_each_hat_read(choice)) return;
    }
    finish(choice);
  }

  /// Was the axis read near every station of a table? For a table with an approach direction, in
  /// both directions? An end is reached in one direction only.
  bool is_each_hat_read(const effects::Choice& choice) const {
    const std::size_t axis = *choice.axis;
    const double length = range_[axis].high - range_[axis].low;
    const double spacing = length / static_cast<double>(choice.form->hats - 1);
    const std::string sense = "dir{q}";
    const bool both = choice.form->any([&](const model::Expr& node) { return is_symbol(node, sense); });
    for (const int one : both ? std::vector<int>{-1, 1} : std::vector<int>{0}) {
      const std::vector<double> read =
          evidence_.places_read(axis, one, evidence_.thresholds().shape.apart * length);
      const std::size_t end = both ? 1 : 0;
      if (read.size() < choice.form->hats - 2 * end) return false;
      for (std::size_t k = end; k + end < choice.form->hats; ++k) {
        const double station = range_[axis].low + static_cast<double>(k) * spacing;
        if (std::none_of(read.begin(), read.end(),
                         [&](double q) { return std::abs(q - station) <= spacing / 2; }))
          return false;
      }
    }
    return true;
  }

  std::vector<double> grid_of(const effects::Choice& choice, const effects::UnknownRule& rule) const {
    switch (rule.kind) {
      case effects::UnknownKind::kTime: {
        const Evidence::Range range = evidence_.time_range();
        const double length = range.high - range.low;
        if (length <= 0) return {};
        return logarithmic(std::max(extent_.time_least_steps * range.step, length / extent_.time_least_part),
                           extent_.time_most * length, extent_.time_values);
      }
      case effects::UnknownKind::kTravel: {
        const Evidence::Range& range = range_[*choice.axis];
        const double length = range.high - range.low;
        if (length <= 0) return {};
        return logarithmic(length / extent_.travel_least_part, length / extent_.travel_most_part,
                           extent_.travel_values);
      }
      case effects::UnknownKind::kPeriod:
        return periods(*choice.axis);
      case effects::UnknownKind::kGrid:
        return logarithmic(rule.low, rule.high, rule.count);
      default:
        return {};
    }
  }

  std::vector<double> periods(std::size_t axis) const {
    const Evidence::Range& range = range_[axis];
    const double length = range.high - range.low;
    std::vector<double> grid;
    if (length <= 0 || range.step <= 0) return grid;
    const CandidateExtent& to = extent_;
    // Even steps cannot distinguish a period below two of them from a longer one. Uneven steps
    // can.
    const double shortest = std::max(range.even ? to.steps_per_period * range.step : 0, shortest_[axis]);
    const double fastest = to.most_periods / std::max(length, to.most_periods * shortest);
    // A long wave on even positions may be the alias of a short one.
    const bool aliased = !machine_.axes[axis].rotary && shortest_[axis] > 0;
    const double longest = aliased ? to.longest_aliased_share : to.longest_period_share;
    for (double f = 1 / (longest * length); f <= fastest; f += 1 / (to.periods_per_range * length))
      grid.push_back(1 / f);
    if (machine_.axes[axis].rotary)
      for (double harmonic = 1; harmonic <= static_cast<double>(to.harmonics_of_turn); ++harmonic)
        if (harmonic / 360 <= fastest && length > thresholds_.least_of_a_period * 360 / harmonic)
          grid.push_back(360 / harmonic);
    // At two even steps a wave has lost its sine. It may still be the only form of the true wave.
    if (range.even && !grid.empty()) grid.push_back(2 * range.step);
    std::sort(grid.begin(), grid.end());
    return grid;
  }

  void finish(effects::Choice choice) {
    // Starts of the scanned unknowns: any value of the grid, to complete the candidate.
    ScannedCandidate item;
    for (const effects::UnknownRule& rule : choice.effect->unknowns) {
      if (rule.kind == effects::UnknownKind::kLinear || !uses(*choice.form, rule.name)) continue;
      const std::vector<double> grid = grid_of(choice, rule);
      if (grid.empty()) return;
      choice.start[rule.name] = grid[grid.size() / 2];
    }
    item.candidate = effects::make_candidate(machine_, axes_, choice);
    if (any_tree(*choice.form, is_switched_by_wave) && never_changes(item.candidate)) return;
    for (const effects::CandidateUnknown& unknown : effects::scanned_unknowns(item.candidate))
      item.grid.push_back(grid_of(choice, *choice.effect->find_unknown(unknown.rule)));
    item.most_driven = extent_.driven_out;
    item.may_lose_columns = choice.form->asks_for("hats") || choice.runs.size() > 1 ||
                            choice.form->place == effects::PlaceRule::kPoint;
    add_fine_periods(item);
    list_.push_back(std::move(item));
  }

  /// Does the candidate's first term have the same value in all rows?
  bool never_changes(const effects::Candidate& candidate) const {
    model::Machine scratch = machine_;
    for (const std::size_t unknown : effects::add_unknowns(scratch, candidate, {}))
      scratch.statics[unknown].value = 1;
    const model::Column column =
        model::evaluate(scratch, *model::parse_expression_for(scratch, candidate.terms.front().text),
                        evidence_.measurement().states);
    const auto& rows = evidence_.rows();
    return std::all_of(rows.begin(), rows.end(), [&](std::size_t row) {
      return column[static_cast<Eigen::Index>(row)] == column[static_cast<Eigen::Index>(rows.front())];
    });
  }

  /// A wave alone is also searched below the grid.
  void add_fine_periods(ScannedCandidate& item) {
    if (item.grid.size() != 1 || !item.candidate.choice.axis) return;
    for (const effects::CandidateUnknown& unknown : effects::scanned_unknowns(item.candidate))
      if (unknown.kind != effects::UnknownKind::kPeriod) return;
    const std::size_t axis = *item.candidate.choice.axis;
    const auto known = fine_.find(axis);
    FinePeriods fine = known != fine_.end()
                           ? known->second
                           : fine_[axis] = fine_periods(evidence_, axis, item.grid[0], shortest_.at(axis));
    if (!fine.any()) return;
    fine.carrier = carrier_of(evidence_, item.candidate, fine);
    if (fine.carrier.size() > 0) item.fine = std::move(fine);
  }

  static bool uses(const effects::EffectForm& form, const std::string& name) {
    return form.any([&](const model::Expr& node) { return is_symbol(node, name); });
  }

  const Evidence& evidence_;
  const CandidateThresholds& thresholds_;
  const CandidateExtent& extent_;
  const model::Machine& machine_;
  effects::AxisPlaces axes_;
  const std::vector<effects::Effect>& effects_;
  Pulls pulls_;
  std::vector<std::optional<effects::DofPlace>> own_;
  std::vector<Evidence::Range> range_;
  std::vector<double>
      shortest_;  // shortest period that the positions of an axis distinguish from longer ones
  std::map<std::size_t, FinePeriods> fine_;  // of an axis, without carrier
  std::vector<char> is_outshone_;            // by location
  std::vector<effects::DofPlace> distinct_, sag_;
  std::vector<std::vector<std::string>> sums_;
  bool has_normals_ = false;
  std::vector<ScannedCandidate> list_;
};

}  // namespace

bool ScannedCandidate::is_driven_out(std::size_t unknown, double found, double value) const {
  const std::vector<double>& range = grid[unknown];
  // To the next wave that the range distinguishes.
  if (fine.holds(found)) return !(std::abs(1 / value - 1 / found) * fine.length <= 1);
  return !(value >= range.front() / most_driven && value <= range.back() * most_driven);
}

std::vector<char> outshone_places(const Evidence& evidence) {
  const std::vector<effects::DofPlace>& places = evidence.places();
  const CandidateThresholds& to = evidence.thresholds().candidates;
  std::vector<double> norm;
  for (std::size_t i = 0; i < places.size(); ++i) norm.push_back(evidence.response(i).norm());
  std::vector<char> outshone(places.size(), 0);
  for (std::size_t i = 0; i < places.size(); ++i)
    for (std::size_t k = 0; k < places.size() && outshone[i] == 0; ++k) {
      if (effects::is_angle(evidence.machine(), places[i]) !=
          effects::is_angle(evidence.machine(), places[k]))
        continue;
      const double both = norm[i] * norm[k];
      if (!(norm[k] > to.outshone * norm[i]) || both == 0) continue;
      outshone[i] = 1 - std::abs(evidence.response(i).dot(evidence.response(k))) / both < kSamePlace ? 1 : 0;
    }
  return outshone;
}

std::vector<effects::DofPlace> distinct_places(const Evidence& evidence, bool angles_apart) {
  std::vector<effects::DofPlace> places;
  std::vector<Eigen::VectorXd> seen;
  std::vector<std::size_t> order(evidence.places().size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_partition(order.begin(), order.end(), [&](std::size_t i) {
    return !effects::is_stand_in(evidence.machine(), evidence.places()[i]);
  });
  const std::vector<char> outshone = outshone_places(evidence);
  for (const std::size_t i : order) {
    if (outshone[i] != 0) continue;
    Eigen::VectorXd column = evidence.response(i);
    const double norm = column.norm();
    if (norm == 0) continue;
    column /= norm;
    const auto is_kind = [&](const effects::DofPlace& place) {
      return effects::is_angle(evidence.machine(), place);
    };
    bool known = false;
    for (std::size_t k = 0; k < seen.size() && !known; ++k)
      known = (!angles_apart || is_kind(places[k]) == is_kind(evidence.places()[i])) &&
              1 - std::abs(column.dot(seen[k])) < kSamePlace;
    if (known) continue;
    seen.push_back(column);
    places.push_back(evidence.places()[i]);
  }
  return places;
}

std::vector<ScannedCandidate> enumerate_candidates(const Evidence& evidence,
                                                   const std::vector<effects::Effect>& effects) {
  return Enumerator(evidence, effects).all();
}

}  // namespace vernier::diagnose
