// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/diagnose/propose/pool.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

namespace vernier::diagnose {

namespace {

double rank_of_place(effects::PlaceRule place) {
  switch (place) {
    case effects::PlaceRule::kOwn:
      return 0;
    case effects::PlaceRule::kPair:
    case effects::PlaceRule::kEachAxis:
      return 1;
    case effects::PlaceRule::kCross:
    case effects::PlaceRule::kNormal:
    case effects::PlaceRule::kBase:
    case effects::PlaceRule::kJoint:
    case effects::PlaceRule::kPoint:
      return 2;
    case effects::PlaceRule::kTurn:
    case effects::PlaceRule::kBaseTurn:
    case effects::PlaceRule::kLength:
    case effects::PlaceRule::kBend:
      return 3;
    default:
      return 4;
  }
}

/// Is the term a position times an input or a time? If the axis stands still, a term without the axis fits as
/// well.
bool is_position_times_another(const effects::EffectForm& form) {
  const auto is = [&](std::string_view name) {
    return form.any([&](const model::Expr& node) { return model::is_symbol(node, name); });
  };
  return is("{q}") && (form.asks_for_input() || is("t"));
}

/// Rank among forms that fit alike, simplest first: at the axis' own degree of freedom, then
/// across the axis, then anywhere; last what has a position in it beside another quantity. The steps are far
/// below any evidence.
double rank_of(const effects::Candidate& candidate, double step) {
  constexpr double kBesideAnother = 4;  // steps: behind all places
  const effects::EffectForm& form = *candidate.choice.form;
  return step * (rank_of_place(form.place) + (is_position_times_another(form) ? kBesideAnother : 0));
}

/// Is the first unknown that is scanned a period?
bool has_period(const effects::Candidate& candidate) {
  auto scanned = effects::scanned_unknowns(candidate);
  return !scanned.empty() && (*scanned.begin()).kind == effects::UnknownKind::kPeriod;
}

/// Calls visit(node) for each node of the terms of a candidate.
template <class Visit>
void walk_terms(const model::Machine& machine, const effects::Candidate& candidate, const Visit& visit) {
  model::Machine scratch = machine;
  effects::add_unknowns(scratch, candidate, {});
  for (const effects::CandidateTerm& term : candidate.terms)
    model::walk(*model::parse_expression_for(scratch, term.text), visit);
}

/// A gravity moment about a joint depends on the positions of all joints after it.
bool depends_on_no_other_axis(const model::Machine& machine, const effects::Candidate& candidate) {
  bool other = false;
  walk_terms(machine, candidate, [&](const model::Expr& node) {
    other = other || (node.op == model::Op::kSymbol && node.symbol.kind == model::SymbolKind::kAxis &&
                      node.symbol.index != *candidate.choice.axis);
  });
  return !other;
}

/// The extension of an axis bends the structure that carries it. A sag of a part that it carries,
/// or of the other branch, has no load that changes with it.
bool carries_not(const effects::AxisPlaces& axes, const effects::Choice& choice) {
  if (choice.form->place != effects::PlaceRule::kSag || !choice.axis || !choice.place) return false;
  const std::optional<effects::DofPlace>& own = axes.own(*choice.axis);
  return own && (choice.place->workpiece != own->workpiece || choice.place->transform > own->transform);
}

}  // namespace

std::set<std::pair<int, std::size_t>> drivers_of(const model::Machine& machine,
                                                 const effects::Candidate& candidate) {
  std::set<std::pair<int, std::size_t>> drivers;
  walk_terms(machine, candidate, [&](const model::Expr& node) {
    if (node.op == model::Op::kRunIs) drivers.insert({-1, 0});
    if (node.op != model::Op::kSymbol) return;
    const model::SymbolKind kind = node.symbol.kind;
    if (kind == model::SymbolKind::kStatic || kind == model::SymbolKind::kAxis) return;
    drivers.insert({static_cast<int>(kind), node.symbol.index});
  });
  return drivers;
}

bool change_in_time(const std::set<std::pair<int, std::size_t>>& drivers) {
  return std::any_of(drivers.begin(), drivers.end(), [](const auto& driver) {
    const auto kind = static_cast<model::SymbolKind>(driver.first);
    return driver.first < 0 || kind == model::SymbolKind::kInput || kind == model::SymbolKind::kTime ||
           kind == model::SymbolKind::kVisit;
  });
}

bool moves_alike(const Evidence& evidence, const effects::DofPlace& a, const effects::DofPlace& b) {
  const auto x = evidence.response(evidence.index_of(a)), y = evidence.response(evidence.index_of(b));
  return std::abs(x.dot(y)) > evidence.thresholds().shape.moves_alike * x.norm() * y.norm();
}

Pool::Pool(const Evidence& evidence, const Scanner& scanner)
    : evidence_(evidence),
      thresholds_(evidence.thresholds().pool),
      extent_(evidence.thresholds().search.pool),
      scanner_(scanner),
      axes_(evidence.machine()) {}

const effects::Candidate& Pool::candidate(std::size_t i) const {
  return scanner_.candidates()[items_[i].scored.candidate].candidate;
}

bool Pool::is_rare(const effects::Choice& choice) {
  // A jump between runs can follow any slow drift. It is named only if no continuous effect fits
  // as well. A term without a name is rarer than the causes with a name.
  return choice.effect->rare || choice.form->rare || !choice.runs.empty() ||
         choice.effect == &effects::custom_effect();
}

bool Pool::is_rarer(std::size_t rare, std::size_t usual) const {
  return is_rare(candidate(rare).choice) && !is_rare(candidate(usual).choice);
}

double Pool::penalty(const Scored& scored) const {
  const ScannedCandidate& item = scanner_.candidates()[scored.candidate];
  double cost = 2 * std::log(static_cast<double>(scanner_.candidates().size())) +
                rank_of(item.candidate, extent_.step_of_place) + item.penalty;
  const effects::Choice& choice = item.candidate.choice;
  if (is_rare(choice)) cost += thresholds_.rare;
  if (carries_not(axes_, choice)) cost += 2 * thresholds_.rare;
  // A scanned unknown counts as many tests as the grid has distinct values, if that exceeds the
  // penalty of a coefficient.
  for (std::size_t i = 0; i < item.grid.size(); ++i) {
    double tries = static_cast<double>(item.grid[i].size()) / extent_.points_per_try;
    if (item.fine.holds(scored.scanned.at(i))) tries += item.fine.tries();
    cost += std::max(0.0, 2 * std::log(tries) - std::log(static_cast<double>(evidence_.rows().size())));
  }
  return cost;
}

/// One key per effect and location. A second period at the same location has another key.
std::string Pool::place_key(const Scored& scored) const {
  const effects::Candidate& candidate = scanner_.candidates()[scored.candidate].candidate;
  const effects::Choice& c = candidate.choice;
  std::string key = c.effect->id;
  if (c.axis) key += fmt::format(" a{}", *c.axis);
  if (c.axis2) key += fmt::format(" b{}", *c.axis2);
  for (const std::string& input : c.inputs) key += " " + input;
  if (c.place) key += fmt::format(" {}.{}.{}", c.place->workpiece, c.place->transform, c.place->dof);
  if (has_period(candidate))
    key += fmt::format(" p{}", std::lround(extent_.periods_per_e * std::log(scored.scanned[0])));
  key += c.runs.size() == 1 ? " " + c.runs[0] : "";
  if (c.effect == &effects::custom_effect()) key += " " + c.term;
  return key;
}

void Pool::add(const std::vector<Scored>& scored, const Eigen::MatrixXd& beside) {
  std::vector<std::size_t> order(scored.size());
  const double noise = thresholds_.noise_share * evidence_.chi_square() / evidence_.freedom();
  const double scale = evidence_.noise_known() ? std::max(1.0, noise) : noise;
  std::vector<double> value(scored.size());
  for (std::size_t i = 0; i < scored.size(); ++i) {
    order[i] = i;
    value[i] =
        scored[i].gain / scale -
        static_cast<double>(scored[i].unknowns) * std::log(static_cast<double>(evidence_.rows().size())) -
        penalty(scored[i]);
  }
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::round(value[a] / kSameCriterion) > std::round(value[b] / kSameCriterion);
  });
  std::map<std::string, std::size_t> of_effect;
  std::size_t taken = 0;
  for (const std::size_t i : order) {
    std::size_t& count = of_effect[scanner_.candidates()[scored[i].candidate].candidate.choice.effect->id];
    if (taken >= extent_.most_at_once && count >= extent_.of_each_effect) continue;
    ++count;
    ++taken;
    Item item;
    item.scored = scored[i];
    if (value[i] > extent_.refined_above) scanner_.refine(item.scored, beside);
    const std::string key =
        place_key(item.scored) + " " +
        scanner_.candidates()[item.scored.candidate].candidate.choice.form->label +
        (item.scored.scanned.empty() ? "" : fmt::format(" {:.3g}", item.scored.scanned[0]));
    if (!keys_.insert(key).second) continue;
    item.columns = scanner_.projected(item.scored, &item.kept);
    if (item.columns.cols() > 0) items_.push_back(std::move(item));
  }
}

Eigen::MatrixXd Pool::columns(const std::vector<std::size_t>& items) const {
  Eigen::Index count = 0;
  for (const std::size_t i : items) count += items_[i].columns.cols();
  Eigen::MatrixXd all(evidence_.residual().size(), count);
  Eigen::Index at = 0;
  for (const std::size_t i : items) {
    all.middleCols(at, items_[i].columns.cols()) = items_[i].columns;
    at += items_[i].columns.cols();
  }
  return all;
}

SelectionProblem Pool::problem(std::vector<std::size_t>& items) const {
  items.clear();
  for (std::size_t i = 0; i < items_.size(); ++i)
    if (!items_[i].banned) items.push_back(i);
  return problem_of(items);
}

SelectionProblem Pool::problem_of(const std::vector<std::size_t>& items) const {
  Eigen::MatrixXd all = columns(items);
  // Unit columns keep the pivots comparable.
  for (Eigen::Index j = 0; j < all.cols(); ++j) all.col(j).normalize();
  SelectionProblem p = selection_problem(all, evidence_.residual());
  std::map<std::string, std::size_t> causes;
  Eigen::Index at = 0;
  for (const std::size_t i : items) {
    const Item& item = items_[i];
    SelectionEntry entry;
    entry.first = at;
    entry.count = item.columns.cols();
    entry.penalty = penalty(item.scored);
    entry.scanned = item.scored.scanned.size();
    entry.cause = causes.emplace(place_key(item.scored), causes.size()).first->second;
    at += entry.count;
    p.entries.push_back(entry);
  }
  p.freedom = evidence_.freedom();
  p.noise_known = evidence_.noise_known();
  p.least_pivot = kLeastPivot;
  return p;
}

bool Pool::same_cause(std::size_t a, std::size_t b) const {
  const effects::Choice &x = candidate(a).choice, &y = candidate(b).choice;
  if (is_custom(a) || is_custom(b)) return x.effect == y.effect && x.term == y.term;
  const bool one_cause =
      x.effect == y.effect || (!x.effect->cause.empty() && x.effect->cause == y.effect->cause);
  return one_cause && x.axis == y.axis && x.axis2 == y.axis2 && x.inputs == y.inputs;
}

bool Pool::same_columns(std::size_t a, std::size_t b) const {
  const Eigen::MatrixXd x = maths::orthonormal(items_[a].columns, 1e-6, nullptr);
  const Eigen::MatrixXd y = maths::orthonormal(items_[b].columns, 1e-6, nullptr);
  if (x.cols() != y.cols()) return false;
  // Squares of the cosines between the two spans. The smallest of them decides.
  const double common = (x.transpose() * y).squaredNorm();
  return static_cast<double>(x.cols()) - common < thresholds_.same_share;
}

bool Pool::is_function_of_an_axis(std::size_t i) const {
  const effects::Candidate& one = candidate(i);
  return one.choice.axis && one.choice.place && one.terms.size() == 1 &&
         drivers_of(evidence_.machine(), one).empty() && depends_on_no_other_axis(evidence_.machine(), one);
}

double Pool::common_share(std::size_t item, std::size_t other) const {
  const Eigen::MatrixXd basis = maths::orthonormal(items_[other].columns, 1e-6, nullptr);
  return (basis.transpose() * items_[item].columns).squaredNorm() / items_[item].columns.squaredNorm();
}

double Pool::witnesses(std::size_t item) const {
  const Eigen::VectorXd square = items_[item].columns.rowwise().squaredNorm();
  return std::pow(square.sum(), 2) / square.squaredNorm();
}

bool Pool::is_richer(std::size_t general, std::size_t special) const {
  const auto unknowns = [&](std::size_t i) {
    return items_[i].columns.cols() + static_cast<Eigen::Index>(items_[i].scored.scanned.size());
  };
  if (unknowns(general) <= unknowns(special)) return false;
  // Time may follow a jump between runs closely, but it is not a richer form of the same term.
  const auto mine = drivers_of(evidence_.machine(), candidate(general)),
             its = drivers_of(evidence_.machine(), candidate(special));
  return std::includes(mine.begin(), mine.end(), its.begin(), its.end());
}

bool Pool::contains(std::size_t general, std::size_t special) const {
  if (!is_richer(general, special)) return false;
  const Eigen::MatrixXd x = maths::orthonormal(items_[general].columns, 1e-6, nullptr);
  const Eigen::MatrixXd y = maths::orthonormal(items_[special].columns, 1e-6, nullptr);
  if (x.cols() < y.cols()) return false;
  return static_cast<double>(y.cols()) - (x.transpose() * y).squaredNorm() < thresholds_.held_share;
}

bool Pool::same_kind(std::size_t a, std::size_t b) const {
  // Each input is a separate quantity. Speed is one quantity for all axes.
  const auto kinds = [&](std::size_t i) {
    std::set<std::pair<int, std::size_t>> found;
    for (const auto& [kind, index] : drivers_of(evidence_.machine(), candidate(i))) {
      const bool mere_count = kind == static_cast<int>(model::SymbolKind::kVisit) ||
                              kind == static_cast<int>(model::SymbolKind::kSince);
      if (!mere_count) found.insert({kind, kind == static_cast<int>(model::SymbolKind::kInput) ? index : 0});
    }
    return found;
  };
  return kinds(a) == kinds(b);
}

std::optional<double> Pool::period_of(std::size_t i) const {
  auto value = (*this)[i].scored.scanned.begin();
  for (const effects::CandidateUnknown& unknown : effects::scanned_unknowns(candidate(i))) {
    if (unknown.kind == effects::UnknownKind::kPeriod) return *value;
    ++value;
  }
  return std::nullopt;
}

}  // namespace vernier::diagnose
