// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/diagnose/propose/responses.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "tools/diagnose/propose/selection.h"
#include "tools/effects/input_class.h"
#include "tools/maths/rounding.h"
#include "tools/text/numbers.h"

namespace vernier::diagnose {
namespace {

/// One summand: a lagged temperature, times a power of the position, at one degree of freedom.
struct Summand {
  std::size_t input = 0;
  double delay_s = 0;
  int power = 0;
  effects::DofPlace place;
};

/// The position of an axis between -1 and 1, as a factor of a term.
struct Position {
  std::string text;    // "(Z-250)/250"
  int most_power = 0;  // that the positions of the rows determine
};

/// Searches the response of one structure: the transform that an axis moves.
class Structure {
 public:
  Structure(const Evidence& evidence, const effects::Effect& effect, const effects::AxisPlaces& axes,
            std::size_t axis)
      : evidence_(evidence),
        extent_(evidence.thresholds().search.candidates),
        pool_(evidence.thresholds().pool),
        machine_(evidence.machine()),
        effect_(effect),
        axes_(axes),
        axis_(axis),
        own_(*axes.own(axis)) {
    find_position();
    find_delays();
  }

  std::optional<ScannedCandidate> response(const Eigen::MatrixXd& beside) {
    list_summands();
    if (summands_.empty()) return std::nullopt;
    const std::vector<std::size_t> chosen = choose(beside);
    if (chosen.size() < 2) return std::nullopt;  // the catalogue has the forms of one summand
    std::vector<Summand> found;
    for (const std::size_t i : chosen) found.push_back(summands_[i]);
    ScannedCandidate item;
    item.candidate = effects::make_candidate(machine_, axes_, choice_of(found));
    item.penalty = 2 * std::log(static_cast<double>(summands_.size())) * static_cast<double>(chosen.size());
    return item;
  }

 private:
  void find_position() {
    const Evidence::Range range = evidence_.range_of(axis_);
    if (range.step <= 0) return;
    const auto [low, high] = range.outwards();
    position_.text = fmt::format("(({}-{})/{})", machine_.axes[axis_].name,
                                 text::number_text((low + high) / 2), text::number_text((high - low) / 2));
    const double places = (range.high - range.low) / range.step + 1;
    position_.most_power = static_cast<int>(std::min(places - 1, 2.0));
  }

  /// Delays from the spacing of the rows to the length of the longest run, by a constant factor.
  void find_delays() {
    const model::States& states = evidence_.measurement().states;
    std::map<std::size_t, std::pair<double, double>> ends;
    for (const std::size_t row : evidence_.rows()) {
      const double t = states.time[static_cast<Eigen::Index>(row)];
      const auto [run, is_new] = ends.try_emplace(states.run[row], t, t);
      run->second = {std::min(run->second.first, t), std::max(run->second.second, t)};
    }
    double longest = 0;
    for (const auto& [run, end] : ends) longest = std::max(longest, end.second - end.first);
    delays_ = {0};
    if (longest <= 0) return;
    constexpr double kFactor = 2;      // sums of two delays describe the delays between them
    constexpr double kShortest = 128;  // of the longest run
    const double rows = static_cast<double>(evidence_.rows().size()) / static_cast<double>(ends.size());
    const double shortest = std::max(longest / kShortest, extent_.time_least_steps * longest / rows);
    for (double delay = longest; delay >= shortest; delay /= kFactor)
      delays_.push_back(maths::to_two_digits(delay));
  }

  /// Degrees of freedom of the transform that the readings show.
  std::vector<effects::DofPlace> places() const {
    std::vector<effects::DofPlace> found;
    for (const effects::DofPlace& place : evidence_.places())
      if (place.workpiece == own_.workpiece && place.transform == own_.transform &&
          evidence_.response(evidence_.index_of(place)).squaredNorm() > 0)
        found.push_back(place);
    return found;
  }

  void list_summands() {
    const std::vector<effects::DofPlace> at = places();
    for (std::size_t input = 0; input < machine_.inputs.size(); ++input) {
      if (effects::class_of_input(machine_.inputs[input]) != effects::InputClass::kTemperature) continue;
      if (!evidence_.varies(evidence_.measurement().states.input[input])) continue;
      for (const double delay : delays_)
        for (const effects::DofPlace& place : at)
          for (int power = 0; power <= position_.most_power; ++power)
            summands_.push_back({input, delay, power, place});
    }
  }

  /// "k3*((Z-250)/250)^2*(lag(T_front,600)-20)"
  std::string text_of(const Summand& s, std::size_t number) const {
    const std::string& name = machine_.inputs[s.input].name;
    std::string term = fmt::format("k{}", number);
    if (s.power > 0) term += "*" + position_.text;
    if (s.power > 1) term += fmt::format("^{}", s.power);
    const std::string reference = text::number_text(evidence_.reference_of(s.input));
    term += s.delay_s > 0 ? fmt::format("*(lag({},{})-{})", name, text::number_text(s.delay_s), reference)
                          : fmt::format("*({}-{})", name, reference);
    return term;
  }

  effects::Choice choice_of(std::vector<Summand> found) const {
    std::stable_sort(found.begin(), found.end(),
                     [](const Summand& a, const Summand& b) { return a.place.dof < b.place.dof; });
    effects::Choice choice;
    choice.effect = &effect_;
    choice.form = &effect_.forms.front();
    choice.axis = axis_;
    choice.place = found.front().place;
    choice.reference = evidence_.reference_of(found.front().input);
    for (std::size_t i = 0; i < found.size(); ++i) {
      const model::Input& input = machine_.inputs[found[i].input];
      if (std::find(choice.inputs.begin(), choice.inputs.end(), input.name) == choice.inputs.end()) {
        choice.inputs.push_back(input.name);
        choice.units.push_back(input.unit);
      }
      const bool same = i > 0 && found[i].place == found[i - 1].place;
      if (!same)
        choice.term += (i > 0 ? "|" : "") + fmt::format("{}:", effects::dof_name(machine_, found[i].place));
      choice.term += (same ? "+" : "") + text_of(found[i], i + 1);
    }
    return choice;
  }

  /// Returns the unit columns of all summands, beside the model and `beside`. A column that these contain
  /// becomes zero.
  Eigen::MatrixXd columns(const Eigen::MatrixXd& beside) const {
    ColumnMaker maker(evidence_);
    Eigen::MatrixXd all(evidence_.residual().size(), static_cast<Eigen::Index>(summands_.size()));
    for (std::size_t i = 0; i < summands_.size(); ++i)
      all.col(static_cast<Eigen::Index>(i)) =
          maker.columns(effects::make_candidate(machine_, axes_, choice_of({summands_[i]})), {});
    const Eigen::RowVectorXd before = all.colwise().norm();
    all = evidence_.beside_model(all);
    all -= beside * (beside.transpose() * all);
    for (Eigen::Index j = 0; j < all.cols(); ++j) {
      const double norm = all.col(j).norm();
      if (norm > pool_.least_own * before[j])
        all.col(j) /= norm;
      else
        all.col(j).setZero();
    }
    return all;
  }

  std::vector<std::size_t> choose(const Eigen::MatrixXd& beside) const {
    const Eigen::MatrixXd all = columns(beside);
    const Eigen::VectorXd residual =
        evidence_.residual() - beside * (beside.transpose() * evidence_.residual());
    SelectionProblem p = selection_problem(all, residual);
    p.freedom = std::max(1.0, evidence_.freedom() - static_cast<double>(beside.cols()));
    p.noise_known = evidence_.noise_known();
    p.least_pivot = kLeastPivot;
    for (Eigen::Index j = 0; j < all.cols(); ++j)
      p.entries.push_back(
          {j, 1, 2 * std::log(static_cast<double>(all.cols())), 0, static_cast<std::size_t>(j)});
    return select(p, extent_.most_of_response).chosen;
  }

  const Evidence& evidence_;
  const CandidateExtent& extent_;
  const PoolThresholds& pool_;
  const model::Machine& machine_;
  const effects::Effect& effect_;
  const effects::AxisPlaces& axes_;
  std::size_t axis_;
  effects::DofPlace own_;
  Position position_;
  std::vector<double> delays_;
  std::vector<Summand> summands_;
};

}  // namespace

std::vector<ScannedCandidate> enumerate_responses(const Evidence& evidence,
                                                  const std::vector<effects::Effect>& effects,
                                                  const Eigen::MatrixXd& beside) {
  const auto effect = std::find_if(effects.begin(), effects.end(),
                                   [](const effects::Effect& e) { return e.has_found_terms(); });
  if (effect == effects.end()) return {};
  const effects::AxisPlaces axes(evidence.machine());
  std::vector<ScannedCandidate> list;
  for (std::size_t axis = 0; axis < evidence.machine().axes.size(); ++axis) {
    if (!axes.own(axis) || evidence.machine().axes[axis].rotary) continue;
    if (std::optional<ScannedCandidate> item = Structure(evidence, *effect, axes, axis).response(beside))
      list.push_back(std::move(*item));
  }
  return list;
}

}  // namespace vernier::diagnose
