// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/residual/before_after.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>
#include <set>

#include "tools/fit/fit.h"
#include "tools/fit/least_squares/statistics.h"
#include "tools/fit/set_up.h"
#include "tools/format/columns.h"
#include "tools/maths/factors.h"

namespace vernier::residual {
namespace {

using Index = Eigen::Index;

/// With fewer samples their scatter is not known.
constexpr std::size_t kLeastSamples = 5;
/// More samples are joined with their neighbours. No information is lost and the resampling stays
/// fast.
constexpr std::size_t kMostSamples = 400;
/// Blocks of rows of a side without pairs. They are long, so that successive blocks are nearly
/// independent (a path repeats its error from row to row).
constexpr std::size_t kBlocks = 20;
/// More feeds than these were not set by a user.
constexpr std::size_t kMostFeeds = 12;
constexpr double kTail = 0.025;         // on either side of 95 %
constexpr double kSamePosition = 1e-6;  // mm or deg: 1 nm, the last digit of a measurement file
/// Significant digits of a feed: of one pose, and of a group of rows with one feed. A measured feed varies by
/// some parts in a thousand. Feeds that a user sets differ by several per cent.
constexpr int kDigitsOfPose = 3, kDigitsOfGroup = 2;

double rounded(double value, double step) { return std::round(value / step) * step; }

/// Rounds to this number of significant digits.
double digits(double value, int count) {
  if (value == 0) return 0;
  const double step = std::pow(10.0, std::floor(std::log10(std::abs(value))) + 1 - count);
  return rounded(value, step);
}

model::Measurement as_commanded(const model::Measurement& m) {
  model::Measurement result = m;
  result.states = model::commanded_states(m);
  result.correction.clear();
  std::fill(result.check.begin(), result.check.end(), char{0});
  return result;
}

/// Returns the values that a user set before a reading. Rows of both sides with the same values
/// are one pose. Positions are rounded to 1 nm (and a similar part of a degree), feeds to three
/// digits, because they are read back and not typed.
std::vector<double> pose_of(const model::Measurement& m, std::size_t row) {
  const auto at = static_cast<Index>(row);
  std::vector<double> key;
  for (std::size_t i = 0; i < m.states.axis.size(); ++i) {
    key.push_back(rounded(m.states.axis[i][at], kSamePosition));
    key.push_back(m.states.direction[i][at]);
  }
  key.push_back(digits(m.states.feed[at], kDigitsOfPose));
  for (const model::Column& normal : m.states.normal) key.push_back(rounded(normal[at], kSamePosition));
  for (const Eigen::Matrix3Xd* point : {&m.centre, &m.nominal_point})
    for (Index k = 0; k < 3; ++k) {
      const double value = (*point)(k, at);
      key.push_back(std::isnan(value) ? 0 : rounded(value, kSamePosition));
    }
  return key;
}

/// Sums over the errors of one side.
struct Sums {
  double count = 0, sum = 0, squares = 0;
  void add(double error) {
    ++count;
    sum += error;
    squares += error * error;
  }
  void add(const Sums& other, double times = 1) {
    count += times * other.count;
    sum += times * other.sum;
    squares += times * other.squares;
  }
  double mean() const { return sum / count; }
  double rms() const { return std::sqrt(squares / count); }
  double spread() const {
    return count < 2 ? 0 : std::sqrt(std::max(0.0, (squares - sum * mean()) / (count - 1)));
  }
};

/// A side with the sample of each of its rows.
struct Side {
  model::Measurement rows;  // as commanded
  Eigen::VectorXd error;
  std::vector<std::size_t> sample;  // of each row; kNone: excluded
};
constexpr std::size_t kNone = static_cast<std::size_t>(-1);  // no sample

Side make_side(const model::Machine& machine, const model::Measurement& m) {
  Side side{as_commanded(m), errors_as_commanded(machine, m), {}};
  side.sample.assign(m.rows(), kNone);
  return side;
}

/// Rows of a side with a reading.
std::vector<char> read_rows(const Side& side) {
  std::vector<char> read(side.rows.rows(), 0);
  for (const model::Observation& o : side.rows.observations) read[o.row] = 1;
  return read;
}

/// Assigns poses to the rows of both sides. Returns false if they have too few common poses.
bool pair_poses(Side& before, Side& after, BeforeAfter& result) {
  struct Pose {
    std::array<std::vector<std::size_t>, 2> rows;
  };
  std::map<std::vector<double>, Pose> poses;
  std::vector<Pose*> in_order;
  std::array<std::size_t, 2> total{}, met{};
  const std::array<Side*, 2> sides = {&before, &after};
  for (std::size_t k = 0; k < 2; ++k) {
    const std::vector<char> read = read_rows(*sides[k]);
    for (std::size_t row = 0; row < read.size(); ++row) {
      if (read[row] == 0) continue;
      const auto [found, fresh] = poses.try_emplace(pose_of(sides[k]->rows, row));
      if (fresh) in_order.push_back(&found->second);
      found->second.rows[k].push_back(row);
      ++total[k];
    }
  }
  std::erase_if(in_order, [](const Pose* pose) { return pose->rows[0].empty() || pose->rows[1].empty(); });
  for (const Pose* pose : in_order)
    for (std::size_t k = 0; k < 2; ++k) met[k] += pose->rows[k].size();
  if (in_order.size() < kLeastSamples || 2 * met[0] < total[0] || 2 * met[1] < total[1]) return false;
  const std::size_t joined = (in_order.size() + kMostSamples - 1) / kMostSamples;
  for (std::size_t i = 0; i < in_order.size(); ++i)
    for (std::size_t k = 0; k < 2; ++k)
      for (const std::size_t row : in_order[i]->rows[k]) sides[k]->sample[row] = i / joined;
  result.paired = true;
  result.samples = in_order.size();
  result.unmatched_before = total[0] - met[0];
  result.unmatched_after = total[1] - met[1];
  return true;
}

/// Divides a side into blocks of neighbouring rows of one run, with numbers from `first` on.
/// Returns the next number.
std::size_t cut_blocks(Side& side, std::size_t first) {
  const std::vector<char> read = read_rows(side);
  const auto total = static_cast<std::size_t>(std::count(read.begin(), read.end(), char{1}));
  const std::size_t length = (total + kBlocks - 1) / kBlocks;
  std::map<std::size_t, std::pair<std::size_t, std::size_t>> open;  // of a run: block, rows in it
  std::size_t next = first;
  for (std::size_t row = 0; row < read.size(); ++row) {
    if (read[row] == 0) continue;
    auto [found, fresh] = open.try_emplace(side.rows.states.run[row], next, 0);
    if (fresh) ++next;
    if (found->second.second == length) found->second = {next++, 0};
    side.sample[row] = found->second.first;
    ++found->second.second;
  }
  return next;
}

/// The readings of a group.
struct PickedRows {
  std::optional<model::ObservationKind> kind;
  std::optional<double> feed;
  bool takes(const Side& side, const model::Observation& o) const {
    if (side.sample[o.row] == kNone) return false;
    if (kind ? o.kind != *kind : model::is_rotation(o.kind)) return false;
    return !feed || digits(side.rows.states.feed[static_cast<Index>(o.row)], kDigitsOfGroup) == *feed;
  }
};

/// The sums of one group by sample, and the result of resampling them.
class Resampler {
 public:
  /// first_after: index of the first sample of the second side; 0 if samples contain both sides.
  Resampler(std::size_t samples, std::size_t first_after, const BeforeAfterOptions& options)
      : samples_(samples), first_after_(first_after), options_(options) {}

  ReductionGroup group(const PickedRows& selection, const Side& before, const Side& after) {
    ReductionGroup result{selection.kind, selection.feed, {}, {}, {}, {}};
    parts_.assign(samples_, {});
    gather(selection, before, 0, result.before);
    gather(selection, after, 1, result.after);
    if (result.before.count == 0 || result.after.count == 0) return result;
    const std::vector<double> once(samples_, 1);
    const std::array<Sums, 2> all = {total(once, 0), total(once, 1)};
    figures(all[0], result.before);
    figures(all[1], result.after);
    if (all[0].squares > 0) result.reduction = 1 - all[1].rms() / all[0].rms();
    if (enough()) resample(all, result);
    return result;
  }

 private:
  void gather(const PickedRows& selection, const Side& side, std::size_t k, ErrorFigures& figures) {
    for (std::size_t i = 0; i < side.rows.observations.size(); ++i) {
      const model::Observation& o = side.rows.observations[i];
      if (!selection.takes(side, o)) continue;
      const double error = side.error[static_cast<Index>(i)] *
                           (model::is_rotation(o.kind) ? maths::kUradPerDeg : maths::kUmPerMm);
      parts_[side.sample[o.row]][k].add(error);
      ++figures.count;
      figures.largest = std::max(figures.largest, std::abs(error));
    }
  }

  static void figures(const Sums& sums, ErrorFigures& to) {
    to.mean = sums.mean();
    to.spread = sums.spread();
    to.rms = sums.rms();
  }

  Sums total(const std::vector<double>& times, std::size_t k) const {
    Sums sums;
    for (std::size_t i = 0; i < samples_; ++i) sums.add(parts_[i][k], times[i]);
    return sums;
  }

  std::size_t filled(std::size_t k) const {
    return static_cast<std::size_t>(
        std::count_if(parts_.begin(), parts_.end(), [k](const auto& part) { return part[k].count > 0; }));
  }
  bool enough() const { return std::min(filled(0), filled(1)) >= kLeastSamples; }

  /// Logarithm of rms after / rms before, and its standard uncertainty: the scatter of the
  /// first-order contributions of the samples.
  struct Ratio {
    double value = 0, std = 0;
  };
  Ratio ratio(const std::array<Sums, 2>& all, const std::vector<double>& times) const {
    double sum = 0, count_before = 0, count_after = 0;
    for (std::size_t i = 0; i < samples_; ++i) {
      if (times[i] == 0) continue;
      double pull = 0;
      for (std::size_t k = 0; k < 2; ++k) {
        const Sums& part = parts_[i][k];
        const double own = part.squares / all[k].squares - part.count / all[k].count;
        pull += (k == 0 ? -0.5 : 0.5) * own;
      }
      sum += times[i] * pull * pull;
      (first_after_ != 0 && i >= first_after_ ? count_after : count_before) += times[i];
    }
    const double least = first_after_ == 0 ? count_before : std::min(count_before, count_after);
    return {0.5 * std::log(all[1].squares / all[1].count / (all[0].squares / all[0].count)),
            std::sqrt(sum * least / std::max(1.0, least - 1))};
  }

  void draw(std::mt19937_64& random, std::vector<double>& times) const {
    std::fill(times.begin(), times.end(), 0);
    const auto draw_from = [&](std::size_t begin, std::size_t end) {
      std::uniform_int_distribution<std::size_t> any(begin, end - 1);
      for (std::size_t i = begin; i < end; ++i) ++times[any(random)];
    };
    if (first_after_ > 0) draw_from(0, first_after_);
    draw_from(first_after_, samples_);
  }

  void resample(const std::array<Sums, 2>& all, ReductionGroup& result) const {
    std::mt19937_64 random(options_.seed);  // the same random samples for every group
    std::vector<double> times(samples_, 1), student;
    std::array<std::array<std::vector<double>, 3>, 2> drawn;
    const Ratio whole = all[0].squares > 0 && all[1].squares > 0 ? ratio(all, times) : Ratio{};
    for (std::size_t r = 0; r < options_.resamples; ++r) {
      draw(random, times);
      const std::array<Sums, 2> now = {total(times, 0), total(times, 1)};
      if (now[0].count == 0 || now[1].count == 0) continue;
      for (std::size_t k = 0; k < 2; ++k) {
        drawn[k][0].push_back(now[k].mean());
        drawn[k][1].push_back(now[k].spread());
        drawn[k][2].push_back(now[k].rms());
      }
      if (whole.std <= 0 || now[0].squares <= 0 || now[1].squares <= 0) continue;
      if (const Ratio own = ratio(now, times); own.std > 0)
        student.push_back((own.value - whole.value) / own.std);
    }
    for (std::size_t k = 0; k < 2; ++k) {
      ErrorFigures& side = k == 0 ? result.before : result.after;
      side.mean_interval = middle(drawn[k][0]);
      side.spread_interval = middle(drawn[k][1]);
      side.rms_interval = middle(drawn[k][2]);
    }
    if (2 * student.size() < options_.resamples) return;
    const ConfidenceInterval t = middle(student);
    result.interval = {1 - std::exp(whole.value - t.low * whole.std),
                       1 - std::exp(whole.value - t.high * whole.std)};
  }

  /// The middle 95 % of a list.
  static ConfidenceInterval middle(std::vector<double>& list) {
    std::sort(list.begin(), list.end());
    const auto at = [&](double share) {
      return list[static_cast<std::size_t>(std::lround(share * static_cast<double>(list.size() - 1)))];
    };
    return {at(kTail), at(1 - kTail)};
  }

  std::size_t samples_, first_after_;
  const BeforeAfterOptions& options_;
  std::vector<std::array<Sums, 2>> parts_;
};

std::set<model::ObservationKind> kinds_of(const Side& side) {
  std::set<model::ObservationKind> kinds;
  for (const model::Observation& o : side.rows.observations) kinds.insert(o.kind);
  return kinds;
}

/// Returns the feeds that a user set, to two digits. Empty if there is one feed, or if there are
/// too many.
std::vector<double> feeds_of(const Side& before, const Side& after) {
  if (!before.rows.has_recorded(format::columns::kFeed) || !after.rows.has_recorded(format::columns::kFeed))
    return {};
  std::set<double> feeds;
  for (const Side* side : {&before, &after})
    for (const double feed : side->rows.states.feed) feeds.insert(digits(feed, kDigitsOfGroup));
  if (feeds.size() < 2 || feeds.size() > kMostFeeds) return {};
  return {feeds.begin(), feeds.end()};
}

std::vector<PickedRows> selections(const Side& before, const Side& after) {
  std::vector<PickedRows> list;
  std::set<model::ObservationKind> kinds = kinds_of(before);
  const std::set<model::ObservationKind> other = kinds_of(after);
  std::erase_if(kinds, [&](model::ObservationKind kind) { return !other.contains(kind); });
  const std::vector<double> feeds = feeds_of(before, after);
  for (const model::ObservationKind kind : kinds) list.push_back({kind, {}});
  for (const double feed : feeds) list.push_back({{}, feed});
  if (kinds.size() > 1)
    for (const double feed : feeds)
      for (const model::ObservationKind kind : kinds) list.push_back({kind, feed});
  return list;
}

std::size_t corrected_rows(const model::Measurement& m) {
  std::size_t count = 0;
  for (std::size_t row = 0; row < m.rows(); ++row)
    count += std::any_of(m.correction.begin(), m.correction.end(),
                         [&](const model::Column& c) { return c[static_cast<Index>(row)] != 0; });
  return count;
}

void require_length(const model::Measurement& m) {
  if (std::all_of(m.observations.begin(), m.observations.end(),
                  [](const model::Observation& o) { return model::is_rotation(o.kind); }))
    throw text::InputError(
        {m.files.front(), 0}, "",
        "the measurement has no reading of a length; a comparison requires at least one such reading");
}

}  // namespace

Helped BeforeAfter::verdict() const {
  if (all.interval && all.interval->low > 0) return Helped::kHelped;
  if (all.interval && all.interval->high < 0) return Helped::kMadeWorse;
  return Helped::kCannotBeTold;
}

Eigen::VectorXd errors_as_commanded(const model::Machine& machine, const model::Measurement& measurement) {
  const model::Measurement rows = as_commanded(measurement);
  model::Machine nominal = model::nominal_machine(machine);
  nominal.base_shifts = machine.base_shifts;
  nominal.tool_shifts = machine.tool_shifts;
  return fit::residuals(fit::set_up(nominal, rows), rows);
}

BeforeAfter compare_before_after(const model::Machine& machine, const model::Measurement& before,
                                 const model::Measurement& after, const BeforeAfterOptions& options) {
  require_length(before);
  require_length(after);
  Side first = make_side(machine, before), second = make_side(machine, after);
  BeforeAfter result;
  result.corrected_before = corrected_rows(before);
  result.corrected_after = corrected_rows(after);
  std::size_t samples = 0, first_after = 0;
  if (pair_poses(first, second, result)) {
    samples = 1 + *std::max_element(first.sample.begin(), first.sample.end(), [](auto a, auto b) {
                return a + 1 < b + 1;  // kNone is handled like 0
              });
  } else {
    first_after = cut_blocks(first, 0);
    samples = result.samples = cut_blocks(second, first_after);
  }
  Resampler resampler(samples, first_after, options);
  result.all = resampler.group({}, first, second);
  for (const PickedRows& selection : selections(first, second)) {
    const ReductionGroup group = resampler.group(selection, first, second);
    if (group.before.count > 0 && group.after.count > 0) result.groups.push_back(group);
  }
  return result;
}

}  // namespace vernier::residual
