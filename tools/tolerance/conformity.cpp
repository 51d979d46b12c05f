// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/tolerance/conformity.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "tools/fit/coverage/point_readings.h"
#include "tools/fit/coverage/reach.h"
#include "tools/kinematics/inverse.h"
#include "tools/maths/decompositions.h"
#include "tools/model/chain/chain.h"
#include "tools/model/chain/prediction.h"
#include "tools/model/chain/work_poses.h"
#include "tools/model/fit_record.h"
#include "tools/offline/corrector.h"
#include "tools/text/error.h"
#include "tools/tolerance/machine_sources.h"
#include "tools/tolerance/trials.h"

namespace vernier::tolerance {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// JCGM 101:2008, 7.2.2 and 7.9.2: trials of a block; drawn a thousand at a time.
constexpr Index kBlock = 10000, kAtOnce = 1000;
/// Trials through the whole chain that the linear ones are held against.
constexpr int kTried = 12;
/// Assumed lengths of errors that a model may lack, mm: period of an encoder, pitch of a screw, distance
/// between stations. Each class is treated alike and gives a separate interval.
struct Wavelengths {
  double shortest_mm, longest_mm;
};
constexpr std::array<Wavelengths, 3> kWavelengths = {{{1, 10}, {10, 60}, {60, 600}}};
/// Smaller values are ignored: a nanometre.
constexpr double kNothing_mm = 1e-6;
/// Largest error of a linear trial, as a share of the standard deviation.
constexpr double kLinearEnough = 0.05;

class ConformityRunner {
 public:
  ConformityRunner(const model::Machine& machine, const PlacedPart& part, const std::string& file,
                   const std::vector<effects::Effect>& catalogue, const ConformityOptions& options)
      : part_(part),
        options_(options),
        reach_(known(machine)),
        values_(part_values(part, options.frame, file)) {
    sources_ = machine_sources(reach_.machine(), reach_.parameters(), catalogue);
    find_columns();
    find_means(machine);
    result_.seed = options.seed;
    for (std::size_t k = 0; k < 3; ++k)
      result_.discrepancy_mm[k] = reach_.discrepancy_mm()[static_cast<Index>(k)];
    classes_ = reach_.discrepancy_mm().maxCoeff() > 0 ? kWavelengths.size() : 1;
    result_.stale = reach_.stale();
    result_.open_known = reach_.open_known();
    result_.outside = outside(machine);
  }

  PartConformity run() {
    Normals normals(options_.seed);
    try_chain(normals);
    for (const CharacteristicValue& value : values_.values) {
      CharacteristicResult one{value.feature, value.what, value.limits_mm, {}, {}, {}, {}, 0, 0, 0, false};
      one.outside = outside_[value.feature];
      result_.characteristics.push_back(std::move(one));
    }
    draw_lacks(normals);
    share_out(normals);
    simulate(normals);
    return std::move(result_);
  }

 private:
  static const model::Machine& known(const model::Machine& machine) {
    if (!machine.fitted)
      throw text::InputError({machine.file, 0}, machine.name,
                             "was never fitted (no <fitted>), so its uncertainty is not known; give "
                             "measurements, or a machine file that `vernier fit` wrote");
    return machine;
  }

  void find_columns() {
    const auto n = static_cast<Index>(reach_.parameters().size());
    raw_ = MatrixXd(
        model::linearise(reach_.machine(), fit::point_readings(part_.states), reach_.parameters()).jacobian);
    const MatrixXd columns =
        options_.frame == PartFrame::kMachine ? reach_.moved(part_.states, MatrixXd::Identity(n, n)) : raw_;
    columns_ = values_.map * columns;
    rigid_ = values_.map * (raw_ - columns);  // motion that the machine's frame removes from each
    const MatrixXd unmeasured = options_.frame == PartFrame::kMachine ? reach_.moved_unmeasured(part_.states)
                                                                      : reach_.unmeasured(part_.states);
    own_ = reach_.factor().cols();
    spread_.resize(values_.map.rows(), own_ + unmeasured.cols());
    spread_ << columns_ * reach_.factor(), values_.map * unmeasured;
  }

  /// Random samples of the discrepancy, one per class of wavelengths.
  void draw_lacks(Normals& normals) {
    lacks_.assign(classes_, MatrixXd::Zero(values_.map.rows(), kAtOnce));
    if (classes_ == 1) return;
    for (std::size_t c = 0; c < classes_; ++c)
      lacks_[c] =
          values_.map * draw_discrepancy(normals, part_.point, reach_.discrepancy_mm(),
                                         kWavelengths[c].shortest_mm, kWavelengths[c].longest_mm, kAtOnce);
  }

  /// Deviations of the points as the fitted machine makes them.
  void find_means(const model::Machine& machine) {
    Eigen::Matrix3Xd off = model::forward(reach_.machine(), part_.states).position - part_.point;
    if (options_.frame == PartFrame::kMachine) take_rigid_out(off);
    off_ = values_.map * off.reshaped();
    const bool rotary = options_.with_rotary || kinematics::linear_axes(machine).empty();
    offline::Corrector corrector(machine, {.with_rotary = rotary, .back = false});
    const MatrixXd commands = corrector.commands(part_.states);
    corrected_ = part_.states;
    for (std::size_t a = 0; a < machine.axes.size(); ++a)
      corrected_.axis[a] = commands.row(static_cast<Index>(a)).transpose().array();
    const Eigen::Matrix3Xd on = model::forward(reach_.machine(), corrected_).position - part_.point;
    on_ = values_.map * on.reshaped();
    for (const MachineSource& source : sources_) {
      Eigen::Matrix3Xd without =
          model::forward(without_source(reach_.machine(), source), part_.states).position - part_.point;
      if (options_.frame == PartFrame::kMachine) take_rigid_out(without, &source);
      alone_.emplace_back(off_ - values_.map * without.reshaped());
    }
  }

  /// The motion of the whole that fits the machine's deviations best over its work volume.
  void take_rigid_out(Eigen::Matrix3Xd& deviations, const MachineSource* without = nullptr) const {
    const model::WorkPoses poses = model::work_poses(reach_.machine());
    const model::Machine machine =
        without != nullptr ? without_source(reach_.machine(), *without) : reach_.machine();
    const Eigen::Matrix3Xd at = model::forward(model::nominal_machine(machine), poses.states).position;
    const Eigen::Matrix3Xd off = model::forward(machine, poses.states).position - at;
    const VectorXd motion = maths::least_norm(fit::rigid_motions(at), off.reshaped());
    const VectorXd moved = fit::rigid_motions(part_.point) * motion;
    deviations -= moved.reshaped(3, deviations.cols());
  }

  /// Where the part is and no axis was measured; marks the features of it.
  std::vector<std::string> outside(const model::Machine& machine) {
    std::vector<std::string> list;
    outside_.assign(part_.features.size(), false);
    for (const model::FitRecord::Range& range : machine.fitted->measured) {
      const auto axis = machine.find_axis(range.name);
      if (!axis) continue;
      const double slack = 0.01 * (range.max - range.min);
      const model::Column& q = part_.states.axis[*axis];
      if (q.minCoeff() < range.min - slack)
        list.push_back(fmt::format("{} {:g} to {:g}", range.name, q.minCoeff(), range.min));
      if (q.maxCoeff() > range.max + slack)
        list.push_back(fmt::format("{} {:g} to {:g}", range.name, range.max, q.maxCoeff()));
      for (std::size_t f = 0; f < part_.features.size(); ++f) {
        const auto own = q.segment(static_cast<Index>(part_.features[f].first),
                                   static_cast<Index>(part_.features[f].count));
        if (own.size() > 0 && (own.minCoeff() < range.min - slack || own.maxCoeff() > range.max + slack))
          outside_[f] = true;
      }
    }
    return list;
  }

  /// Rows of one draw of the parameters, through the whole chain, without and with the correction.
  std::pair<VectorXd, VectorXd> through_chain(const VectorXd& z) {
    const VectorXd change = reach_.factor() * z.head(own_);
    const VectorXd more = spread_.rightCols(spread_.cols() - own_) * z.tail(spread_.cols() - own_);
    model::Machine drawn = reach_.machine();
    reach_.parameters().set(drawn, reach_.parameters().get(drawn) + change);
    const VectorXd rigid = rigid_ * change;
    const auto rows = [&](const model::States& states) {
      const Eigen::Matrix3Xd off = model::forward(drawn, states).position - part_.point;
      return VectorXd(values_.map * off.reshaped() - rigid);
    };
    // The mean without its rigid part is what find_means() has: only changes are taken from the chain.
    if (base_.size() == 0) {
      const Eigen::Matrix3Xd off = model::forward(reach_.machine(), part_.states).position - part_.point;
      base_ = values_.map * off.reshaped();
    }
    return {off_ + rows(part_.states) - base_ + more, rows(corrected_) + more};
  }

  /// A few trials both ways: tests whether the machine is linear in its uncertain parameters.
  void try_chain(Normals& normals) {
    const MatrixXd z = normals.draw(spread_.cols(), kTried);
    const MatrixXd many = spread_ * normals.draw(spread_.cols(), kAtOnce);
    for (int trial = 0; trial < kTried && spread_.cols() > 0; ++trial) {
      const auto [off, on] = through_chain(z.col(trial));
      const VectorXd linear = off_ + spread_ * z.col(trial);
      for (const CharacteristicValue& value : values_.values) {
        const double wrong = std::abs(value.of(off) - value.of(linear));
        VectorXd list(many.cols());
        if (trial == 0) {
          for (Index k = 0; k < many.cols(); ++k) list[k] = value.of(off_ + many.col(k));
          std_.push_back(std::sqrt((list.array() - list.mean()).square().mean()));
        }
        result_.linear_mm = std::max(result_.linear_mm, wrong);
        const auto at = static_cast<std::size_t>(&value - values_.values.data());
        if (wrong > kNothing_mm + kLinearEnough * std_[at]) result_.exact = true;
      }
    }
  }

  /// Contribution of each source: exact at the fitted machine, linear in the uncertain parameters.
  void share_out(Normals& normals) {
    constexpr Index kDraws = 1000;  // give a share to 3 %
    const MatrixXd z = normals.draw(spread_.cols(), kDraws);
    std::vector<MatrixXd> part(sources_.size()), open_part(sources_.size());
    for (std::size_t s = 0; s < sources_.size(); ++s) {
      part[s] = MatrixXd::Zero(spread_.rows(), spread_.cols());
      open_part[s] = MatrixXd::Zero(spread_.rows(), reach_.open().cols());
      for (const std::size_t p : sources_[s].parameters) {
        const auto column = columns_.col(static_cast<Index>(p));
        part[s].leftCols(own_) += column * reach_.factor().row(static_cast<Index>(p));
        open_part[s] += column * reach_.open().row(static_cast<Index>(p));
      }
    }
    const MatrixXd open = columns_ * reach_.open(), drawn = (spread_ * z).colwise() + off_;
    for (std::size_t v = 0; v < values_.values.size(); ++v) {
      const CharacteristicValue& value = values_.values[v];
      CharacteristicResult& one = result_.characteristics[v];
      const auto own = [&](const MatrixXd& all) { return all.middleRows(value.first, value.count); };
      const double process = std::pow(options_.process_mm, 2) * own(values_.map).squaredNorm();
      double lack = 0;
      for (const MatrixXd& all : lacks_)
        lack += own(all).squaredNorm() / static_cast<double>(all.cols()) / static_cast<double>(classes_);
      const double total = std::max(own(spread_).squaredNorm() + process + lack, 1e-300);
      one.process = process / total;
      one.discrepancy = lack / total;
      one.open = own(open).squaredNorm() / total;
      std::vector<std::size_t> won(sources_.size(), 0);
      for (Index k = 0; k < kDraws; ++k) ++won[first_of(value, drawn.col(k), part, z.col(k))];
      for (std::size_t s = 0; s < sources_.size(); ++s)
        one.sources.push_back({sources_[s].name, sources_[s].effect, fall(value, off_, alone_[s]),
                               static_cast<double>(won[s]) / static_cast<double>(kDraws),
                               own(spread_).cwiseProduct(own(part[s])).sum() / total,
                               own(open).cwiseProduct(own(open_part[s])).sum() / total});
      name_dominant(one);
    }
  }

  static double fall(const CharacteristicValue& value, const VectorXd& all, const VectorXd& of_source) {
    return std::abs(value.of(all)) - std::abs(value.of(all - of_source));
  }

  std::size_t first_of(const CharacteristicValue& value, const VectorXd& all,
                       const std::vector<MatrixXd>& part, const VectorXd& z) const {
    std::size_t best = 0;
    double most = -1e300;
    for (std::size_t s = 0; s < sources_.size(); ++s) {
      VectorXd of_source = alone_[s];
      of_source.segment(value.first, value.count) += part[s].middleRows(value.first, value.count) * z;
      const double now = fall(value, all, of_source);
      if (now > most) most = now, best = s;
    }
    return best;
  }

  void name_dominant(CharacteristicResult& one) const {
    const auto falls = [](const SourceShare& source) { return source.fall_mm > kNothing_mm; };
    const bool any = std::any_of(one.sources.begin(), one.sources.end(), falls);
    std::vector<SourceShare> by_chance = one.sources;
    std::stable_sort(by_chance.begin(), by_chance.end(),
                     [](const auto& a, const auto& b) { return a.largest > b.largest; });
    double sum = 0;
    for (const SourceShare& source : by_chance) {
      if (!any || sum >= options_.confidence) break;
      sum += source.largest;
      one.dominant.push_back(source.name);
    }
    std::stable_sort(one.sources.begin(), one.sources.end(),
                     [](const auto& a, const auto& b) { return a.fall_mm > b.fall_mm; });
  }

  using Tallies = std::vector<TrialTally>;

  void simulate(Normals& normals) {
    std::vector<Tallies> off(classes_, Tallies(values_.values.size())), on = off;
    const std::size_t least = 2 * static_cast<std::size_t>(kBlock);
    while (!off.front().empty()) {
      block(normals, off, on);
      result_.trials = off.front().front().trials();
      if (result_.trials >= options_.most_trials) break;
      if (result_.trials >= least && settled(off) && settled(on)) break;
      if (result_.trials >= least) expected_ = needed(off, on);
    }
    result_.settled = off.front().empty() || (settled(off) && settled(on));
    for (std::size_t v = 0; v < values_.values.size(); ++v) {
      result_.characteristics[v].off = expectation(off, v, off_);
      result_.characteristics[v].on = expectation(on, v, on_);
    }
  }

  void block(Normals& normals, std::vector<Tallies>& off, std::vector<Tallies>& on) {
    using Values = std::vector<std::vector<double>>;
    std::vector<Values> off_values(classes_, Values(values_.values.size())), on_values = off_values;
    if (result_.trials > 0) draw_lacks(normals);
    for (Index done = 0; done < kBlock; done += kAtOnce) {
      const MatrixXd z = normals.draw(spread_.cols(), kAtOnce);
      MatrixXd own = MatrixXd::Zero(values_.map.rows(), kAtOnce);
      if (options_.process_mm > 0)
        own = options_.process_mm * (values_.map * normals.draw(values_.map.cols(), kAtOnce));
      const MatrixXd change = result_.exact ? own : MatrixXd(own + spread_ * z);
      for (Index k = 0; k < kAtOnce; ++k) {
        VectorXd without = off_ + change.col(k), with = on_ + change.col(k);
        if (result_.exact) {
          const auto [chain_off, chain_on] = through_chain(z.col(k));
          without = chain_off + own.col(k);
          with = chain_on + own.col(k);
        }
        // Two draws turned into one: a thousand of them serve a block of ten thousand.
        const double angle = 2 * std::numbers::pi * normals.uniform();
        const auto other = (k + 1 + static_cast<Index>(normals.uniform() * (kAtOnce - 1))) % kAtOnce;
        for (std::size_t c = 0; c < classes_; ++c) {
          const VectorXd lack = std::cos(angle) * lacks_[c].col(k) + std::sin(angle) * lacks_[c].col(other);
          const VectorXd off_rows = without + lack, on_rows = with + lack;
          for (std::size_t v = 0; v < values_.values.size(); ++v) {
            off_values[c][v].push_back(values_.values[v].of(off_rows));
            on_values[c][v].push_back(values_.values[v].of(on_rows));
          }
        }
      }
      if (options_.progress)
        options_.progress(
            std::min(1.0, static_cast<double>(result_.trials + static_cast<std::size_t>(done)) / expected_));
    }
    for (std::size_t c = 0; c < classes_; ++c)
      for (std::size_t v = 0; v < values_.values.size(); ++v) {
        off[c][v].take(off_values[c][v], values_.values[v].limits_mm);
        on[c][v].take(on_values[c][v], values_.values[v].limits_mm);
      }
  }

  bool settled(const std::vector<Tallies>& classes) const {
    return std::all_of(classes.begin(), classes.end(), [&](const Tallies& all) { return settled(all); });
  }

  /// The discrepancy is known to about a tenth: its intervals are computed with half the resolution.
  double tolerance() const { return classes_ > 1 ? 2 * options_.tolerance : options_.tolerance; }

  bool settled(const std::vector<TrialTally>& tallies) const {
    return std::all_of(tallies.begin(), tallies.end(), [&](const TrialTally& one) {
      return one.doubt() <= tolerance() * one.std() + kNothing_mm;
    });
  }

  /// Estimated number of trials, from those so far: the uncertainty falls with the root of their number.
  double needed(const std::vector<Tallies>& off, const std::vector<Tallies>& on) const {
    double worst = 1;
    for (const auto* classes : {&off, &on})
      for (const Tallies& list : *classes)
        for (const TrialTally& one : list)
          worst = std::max(worst, one.doubt() / (tolerance() * one.std() + kNothing_mm));
    return std::min(static_cast<double>(options_.most_trials),
                    static_cast<double>(result_.trials) * worst * worst + static_cast<double>(kBlock));
  }

  /// The widest of the classes' intervals, and the chance that is least favourable to a verdict.
  Expectation expectation(const std::vector<Tallies>& classes, std::size_t v, const VectorXd& mean) const {
    const CharacteristicValue& value = values_.values[v];
    const TrialTally& first = classes.front()[v];
    Expectation e{value.of(mean), first.mean(), first.std(), first.low(), first.high(), 0, {}, {}};
    double least = first.conforming(), most = least;
    for (const Tallies& one : classes) {
      e.std = std::max(e.std, one[v].std());
      e.low = std::min(e.low, one[v].low());
      e.high = std::max(e.high, one[v].high());
      least = std::min(least, one[v].conforming());
      most = std::max(most, one[v].conforming());
    }
    e.u95 = (e.high - e.low) / 2;
    if (!value.limits_mm) return e;
    e.verdict = least >= options_.confidence      ? PartVerdict::kConforms
                : most <= 1 - options_.confidence ? PartVerdict::kDoesNotConform
                                                  : PartVerdict::kCannotBeSaid;
    e.probability = *e.verdict == PartVerdict::kDoesNotConform ? most : least;
    if (outside_[value.feature]) e.verdict = PartVerdict::kCannotBeSaid;
    return e;
  }

  const PlacedPart& part_;
  const ConformityOptions& options_;
  fit::Reach reach_;
  PartValues values_;
  std::vector<MachineSource> sources_;
  MatrixXd raw_;                       // 3 N x p: of the points, by parameter
  MatrixXd columns_, rigid_, spread_;  // of the map's rows, by parameter; by column of the factor and more
  std::vector<bool> outside_;          // a feature
  Index own_ = 0;                      // columns of the factor; the others have no readings
  std::size_t classes_ = 1;            // of wavelengths of the discrepancy
  std::vector<MatrixXd> lacks_;        // a class: rows of the map, draws
  model::States corrected_;
  VectorXd off_, on_, base_;     // rows of the map at the fitted machine, without and with its correction
  std::vector<VectorXd> alone_;  // of each source
  std::vector<double> std_;      // of each value, from linear trials
  double expected_ = 3.0 * static_cast<double>(kBlock);  // trials, for the progress
  PartConformity result_;
};

}  // namespace

const char* verdict_words(PartVerdict verdict) {
  switch (verdict) {
    case PartVerdict::kConforms:
      return "conforms";
    case PartVerdict::kDoesNotConform:
      return "does not conform";
    case PartVerdict::kCannotBeSaid:
      return "cannot be said";
  }
  return "";
}

PartConformity part_conformity(const model::Machine& machine, const PlacedPart& part, const std::string& file,
                               const std::vector<effects::Effect>& catalogue,
                               const ConformityOptions& options) {
  return ConformityRunner(machine, part, file, catalogue, options).run();
}

}  // namespace vernier::tolerance
