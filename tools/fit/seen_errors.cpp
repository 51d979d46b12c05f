// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fit/seen_errors.h"

#include <algorithm>

namespace vernier::fit {
namespace {

/// Scales follow the machine's own errors within the range from this share of the convention's
/// scale to the whole of it.
constexpr double kLeastShare = 1e-3;
/// Number of entries that the data determine (sum of shares) before the scale of their kind
/// follows them.
constexpr double kLeastDetermined = 4;

/// Of the lengths of linear axes.
constexpr int kLengths = 1;

/// Returns the convention's scale of that table's lengths, mm; 0 if it has no lengths.
double length_scale_mm(const Convention& convention, int table) {
  for (std::size_t i = 0; i < convention.kind.size(); ++i)
    if (convention.kind[i] == kLengths && convention.table[i] == table)
      return convention.scale[static_cast<Eigen::Index>(i)];
  return 0;
}

/// Lengths and angles of linear axes are the kinds 1 and 2, those of rotary ones 3 and 4.
int other_of(int kind) { return kind % 2 == 1 ? kind + 1 : kind - 1; }

}  // namespace

bool SeenErrors::Seen::mostly() const { return determined >= std::max(kLeastDetermined, entries / 2); }

double SeenErrors::Seen::variance() const { return squares / std::max(determined, 1e-9); }

SeenErrors::Seen SeenErrors::Seen::without(const Seen& other) const {
  return {squares - other.squares, determined - other.determined, entries - other.entries,
          moved - other.moved};
}

SeenErrors::SeenErrors(const Convention& convention, const Eigen::VectorXd& squares,
                       const Eigen::VectorXd& from_data, const Eigen::VectorXd& moved) {
  for (Eigen::Index i = 0; i < squares.size(); ++i) {
    const auto at = static_cast<std::size_t>(i);
    const int kind = convention.kind[at];
    for (Seen* seen : {&kinds_[kind], &tables_[{kind, convention.table[at]}]}) {
      seen->squares += squares[i];
      seen->determined += from_data[i];
      seen->entries += 1;
      seen->moved += moved[i];
    }
  }
  leaning_kinds_ = kinds_;
  leaning_tables_ = tables_;
  for (Eigen::Index i = 0; i < squares.size(); ++i) {
    const int table = convention.slope_of[static_cast<std::size_t>(i)];
    const double length_mm = table < 0 ? 0 : length_scale_mm(convention, table);
    if (length_mm <= 0) continue;
    const double share = convention.slope_mm[i] * convention.scale[i] / length_mm;
    for (Seen* seen : {&leaning_kinds_[kLengths], &leaning_tables_[{kLengths, table}]}) {
      seen->squares += share * share * squares[i];
      seen->determined += from_data[i];
      seen->entries += 1;
    }
  }
}

const SeenErrors::Seen& SeenErrors::of(const std::map<std::pair<int, int>, Seen>& tables, int kind,
                                       int table) {
  static const Seen kNothing;
  const auto found = tables.find({kind, table});
  return found == tables.end() ? kNothing : found->second;
}

bool SeenErrors::seen(int kind) const {
  const auto found = kinds_.find(kind);
  return kind != 0 && found != kinds_.end() && found->second.determined >= kLeastDetermined;
}

/// Combines the errors that are seen in the table with those expected from the other tables.
double SeenErrors::beside_others(int kind, int table) const {
  constexpr double kWorth = 4;  // weight of the others, in determined entries
  const Seen &all = kinds_.at(kind), &own = of(tables_, kind, table);
  const Seen others = all.without(own);
  const double expected = others.determined >= kLeastDetermined ? others.variance() : all.variance();
  return (own.squares + kWorth * expected) / (std::max(0.0, own.determined) + kWorth);
}

/// Returns the factor (squared) by which this table's entries of a kind exceed those of the
/// others; 1 if that is not visible.
double SeenErrors::times_larger(int kind, int table) const {
  constexpr double kChance = 2, kLeast = 2;  // factor that chance may cause; determined entries
  const Seen& own = of(leaning_tables_, kind, table);
  const auto all = leaning_kinds_.find(kind);
  if (all == leaning_kinds_.end()) return 1;
  const Seen others = all->second.without(own);
  if (own.determined < kLeast || others.determined < kLeast) return 1;
  return std::max(1.0, own.variance() / std::max(others.variance(), 1e-300) / kChance);
}

double SeenErrors::variance(int kind, int table) const {
  double variance = table < 0 ? kinds_.at(kind).variance() : beside_others(kind, table), most = 1;
  if (table >= 0 && !of(tables_, kind, table).mostly()) {
    const Seen &own = of(tables_, kind, table), &other = of(leaning_tables_, other_of(kind), table);
    const double times = times_larger(other_of(kind), table);
    // At this variance, the unseen kind moves the readings as much as the seen kind does at 1.
    const double exchange = own.moved > 0 ? other.moved / own.moved : 0;
    if (times > 1) {
      variance = std::max(variance * times, other.variance() * exchange);
      most = std::max(1.0, exchange);
    }
  }
  return std::clamp(variance, kLeastShare * kLeastShare, most);
}

}  // namespace vernier::fit
