// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/residual/omnibus.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>

#include "tools/residual/repeats.h"

namespace vernier::residual {
namespace {

/// Tests of one sort share a part of the probability of a false alarm.
struct Sort {
  double part = 0;
  std::vector<std::pair<double, std::string>> log_p;

  void add(double value, const std::string& by) { log_p.emplace_back(value, by); }
};

/// Sorts of tests, in the order of kParts.
enum SortIndex : std::size_t { kMeans, kColumns, kProducts, kJoint, kPeriods, kNeighbours, kRepeats, kSorts };
/// Part of the probability of a false alarm that each sort receives (Bonferroni with weights; their sum is
/// 1). The weights are chosen: errors of one column first, then products of two. They decide only the power:
/// with any weights the probability of a false alarm is at most the level.
constexpr std::array<double, kSorts> kParts = {0.03, 0.40, 0.20, 0.15, 0.10, 0.08, 0.04};

/// Joint tests: polynomials of every column up to these orders. kOfPairs: second order of every column and
/// the products of pairs. The last has every function of a column (kMostDegree in recorded.cpp).
constexpr int kOfPairs = 3;
constexpr std::array kJointOrders = {1, 2, kOfPairs, 8};

class Tester {
 public:
  Tester(const std::vector<KindSample>& samples, const std::vector<RecordedColumn>& columns)
      : samples_(samples), columns_(columns) {
    for (const KindSample& sample : samples) {
      centred_.push_back(sample.moments);
      maths::condition_on(centred_.back(), {0});
      projected_.push_back(sample.projected);
      maths::condition_on(projected_.back(), {0});
    }
  }

  void constants(Sort& sort) const {
    const BasisTerm constant{Shape::kConstant, kNoColumn, {}, 0, {0}, {}};
    std::vector<const maths::Moments*> all;
    std::vector<maths::Explained> parts;
    for (const KindSample& sample : samples_) {
      sort.add(maths::log_p(sample.projected, maths::explained(sample.projected, {}, constant.subject)),
               std::string("mean of ") + sample.name());
      all.push_back(&sample.moments);
      parts.push_back(maths::explained(sample.moments, {}, constant.subject));
    }
    if (samples_.size() > 1) sort.add(maths::log_p_together(all, parts), "means");
  }

  /// Tests every term of one column (products: of two), each kind separately and all together.
  void terms(Sort& sort, bool products) const {
    using Key = std::tuple<std::size_t, std::size_t, Shape, int>;
    std::map<Key, std::pair<std::vector<const maths::Moments*>, std::vector<maths::Explained>>> together;
    for (std::size_t k = 0; k < samples_.size(); ++k)
      for (const BasisTerm& term : samples_[k].basis->terms) {
        if (term.shape == Shape::kConstant || (term.shape == Shape::kProduct) != products) continue;
        const maths::Explained part = maths::explained(projected_[k], term.adjust, term.subject);
        if (part.rank > 0)
          sort.add(maths::log_p(projected_[k], part),
                   std::string(samples_[k].name()) + " against " + label(term));
        auto& [moments, parts] =
            together[{term.column, term.second.value_or(kNoColumn), term.shape, term.order}];
        moments.push_back(&centred_[k]);
        parts.push_back(maths::explained(centred_[k], term.adjust, term.subject));
      }
    for (const auto& [key, all] : together)
      if (all.second.size() > 1) {
        const auto& [first, second, shape, order] = key;
        const BasisTerm term{shape, first, second == kNoColumn ? std::optional<std::size_t>() : second,
                             order, {},    {}};
        sort.add(maths::log_p_together(all.first, all.second), "all kinds against " + label(term));
      }
  }

  /// Tests all columns together, if there are enough rows for the coefficients.
  void joint(Sort& sort) const {
    for (const bool axes_only : {true, false})
      for (const int order : kJointOrders) {
        std::vector<const maths::Moments*> all;
        std::vector<maths::Explained> parts;
        for (std::size_t k = 0; k < samples_.size(); ++k) {
          const maths::FunctionSet set = joint_set(samples_[k], axes_only, order);
          if (set.size() < 2 || 2.0 * static_cast<double>(set.size()) > centred_[k].freedom) continue;
          sort.add(maths::log_p(projected_[k], maths::explained(projected_[k], {}, set)),
                   std::string(samples_[k].name()) + " against all columns together");
          all.push_back(&centred_[k]);
          parts.push_back(maths::explained(centred_[k], {}, set));
        }
        if (parts.size() > 1)
          sort.add(maths::log_p_together(all, parts), "all kinds against all columns together");
      }
  }

  void periods(Sort& sort) const {
    for (std::size_t k = 0; k < samples_.size(); ++k) {
      const Eigen::VectorXd rest = samples_[k].without({0});
      for (const RecordedColumn& column : columns_) {
        if (column.kind != ColumnKind::kAxis) continue;
        const auto best = strongest_period(samples_[k], column, rest);
        if (!best) continue;
        const double scan = std::log(static_cast<double>(best->tried));
        sort.add(std::min(0.0, maths::log_p(centred_[k], best->part) + scan),
                 std::string(samples_[k].name()) + " against a period of " + column.name);
      }
    }
  }

  void neighbours(Sort& sort, const model::Measurement& m) const {
    std::vector<const RecordedColumn*> axes, all;
    for (const RecordedColumn& column : columns_) {
      if (column.kind == ColumnKind::kTime || column.kind == ColumnKind::kVisit) continue;
      if (column.kind == ColumnKind::kAxis || column.kind == ColumnKind::kDirection) axes.push_back(&column);
      if (column.kind != ColumnKind::kRun) all.push_back(&column);
    }
    std::map<std::vector<std::size_t>, std::array<std::vector<std::pair<std::size_t, std::size_t>>, 2>> pairs;
    for (const KindSample& sample : samples_) {
      const Eigen::VectorXd rest = sample.without({0});
      for (const std::size_t phase : {0u, 1u})
        sort.add(serial_pairs(sample, m, rest, phase).log_p,
                 fmt::format("{} against the order of the rows", std::string(sample.name())));
      auto found = pairs.find(sample.rows);
      if (found == pairs.end()) {
        found = pairs.try_emplace(sample.rows).first;
        if (!axes.empty()) found->second[0] = neighbour_pairs(sample, axes);
        if (all.size() > axes.size()) found->second[1] = neighbour_pairs(sample, all);
      }
      for (const auto& list : found->second)
        if (!list.empty())
          sort.add(correlate(rest, list).log_p,
                   std::string(sample.name()) + " against its neighbours in position");
    }
  }

 private:
  std::string label(const BasisTerm& term) const {
    std::string name = columns_[term.column].name;
    if (term.second) name += " times " + columns_[*term.second].name;
    return name;
  }

  maths::FunctionSet joint_set(const KindSample& sample, bool axes_only, int order) const {
    const auto wanted = [&](std::size_t column) {
      const ColumnKind kind = columns_[column].kind;
      return axes_only ? kind == ColumnKind::kAxis || kind == ColumnKind::kDirection
                       : kind != ColumnKind::kTime && kind != ColumnKind::kVisit;
    };
    maths::FunctionSet set;
    for (const BasisTerm& term : sample.basis->terms) {
      if (term.shape == Shape::kConstant || !wanted(term.column)) continue;
      const bool product = term.shape == Shape::kProduct;
      if (product ? order != kOfPairs || !wanted(*term.second) : term.order > (order == kOfPairs ? 2 : order))
        continue;
      set.insert(set.end(), term.subject.begin(), term.subject.end());
    }
    std::sort(set.begin(), set.end());
    set.erase(std::unique(set.begin(), set.end()), set.end());
    return set;
  }

  const std::vector<KindSample>& samples_;
  const std::vector<RecordedColumn>& columns_;
  /// Without the mean. A fit's Jacobian couples the kinds. Tests of several kinds together ignore
  /// it (conservative), those of one kind use it.
  std::vector<maths::Moments> centred_, projected_;
};

}  // namespace

Omnibus omnibus_test(const std::vector<KindSample>& samples, const std::vector<RecordedColumn>& columns,
                     const model::Measurement& m, const Repeats& repeats) {
  const Tester tester(samples, columns);
  std::array<Sort, kSorts> sorts;
  for (std::size_t i = 0; i < kSorts; ++i) sorts[i].part = kParts[i];
  tester.constants(sorts[kMeans]);
  tester.terms(sorts[kColumns], false);
  tester.terms(sorts[kProducts], true);
  tester.joint(sorts[kJoint]);
  tester.periods(sorts[kPeriods]);
  tester.neighbours(sorts[kNeighbours], m);
  if (repeats.log_p) sorts[kRepeats].add(*repeats.log_p, "lack of fit against repeats");
  double whole = 0;
  for (const Sort& sort : sorts) whole += sort.log_p.empty() ? 0 : sort.part;
  Omnibus result;
  double least = 0;
  for (const Sort& sort : sorts)
    for (const auto& [log_p, by] : sort.log_p) {
      ++result.tried;
      const double value = log_p + std::log(static_cast<double>(sort.log_p.size()) * whole / sort.part);
      if (value >= least) continue;
      least = value;
      result.by = by;
    }
  result.p = std::exp(std::min(0.0, least));
  return result;
}

}  // namespace vernier::residual
