// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/residual/recorded.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "tools/format/columns.h"
#include "tools/maths/factors.h"
#include "tools/model/chain/touched_positions.h"

namespace vernier::residual {
namespace {

namespace columns = format::columns;
using format::AxisQuantity;

// Of a polynomial: eight bends in a range are a curve. More are tested as a period.
constexpr int kMostDegree = 8;
constexpr std::size_t kMostRuns = 40;           // more runs are tested only through `visit` and `t`
constexpr std::size_t kMostRunsOfProducts = 8;  // more runs would need more products than there are readings
constexpr double kHalfTurn = 180;               // deg: an axis with this travel has harmonics
constexpr std::size_t kRowsPerRun = 4;          // minimum: the mean of a run is better than a reading
/// A curve is also tested with this degree, between the parabola and kMostDegree: a test with fewer
/// coefficients finds a smaller curve with two or three bends.
constexpr int kMiddleDegree = 4;
/// More values of a column need no exact count: every polynomial that is tested has fewer coefficients.
constexpr std::size_t kMostLevels = 64;
/// Half of the values are in an eighth of the range: a polynomial over the values would describe the others.
constexpr double kCrowded = 0.75;
/// Functions have the length 1: a product with a smaller square is zero except for rounding.
constexpr double kZeroSquare = 1e-24;

class Recorder {
 public:
  Recorder(const std::vector<std::size_t>& rows, std::vector<RecordedColumn>& list)
      : rows_(rows), list_(list) {}

  void add(const std::string& name, const std::string& unit, ColumnKind kind, const model::Column& value,
           bool rotary = false) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const std::size_t row : rows_) {
      const double v = value[static_cast<Eigen::Index>(row)];
      if (std::isnan(v)) continue;
      low = std::min(low, v);
      high = std::max(high, v);
    }
    if (high > low) list_.push_back({name, unit, kind, rotary && high - low >= kHalfTurn, value});
  }

 private:
  const std::vector<std::size_t>& rows_;
  std::vector<RecordedColumn>& list_;
};

void add_motion(Recorder& recorder, const model::Machine& machine, const model::Measurement& m) {
  const model::States& s = m.states;
  for (std::size_t i = 0; i < machine.axes.size(); ++i) {
    const std::string& axis = machine.axes[i].name;
    const auto motion = [&](AxisQuantity quantity, ColumnKind kind, const model::Column& v) {
      const std::string name = format::axis_column(quantity, axis);
      if (m.has_recorded(name))
        recorder.add(name, format::unit_of(quantity, machine.axes[i].rotary), kind, v);
    };
    motion(AxisQuantity::kSense, ColumnKind::kDirection, s.direction[i]);
    motion(AxisQuantity::kSpeed, ColumnKind::kMotion, s.velocity[i]);
    motion(AxisQuantity::kAcceleration, ColumnKind::kMotion, s.acceleration[i]);
    motion(AxisQuantity::kSince, ColumnKind::kMotion, s.since[i]);
  }
  const auto path = [&](const char* name, const model::Column& v) {
    if (m.has_recorded(name)) recorder.add(name, format::column_unit(name), ColumnKind::kMotion, v);
  };
  path(columns::kFeed, s.feed);
  path(columns::kCurvature, s.curvature);
}

bool is_recorded(const RecordedColumn& column, const std::vector<std::size_t>& rows) {
  return std::any_of(rows.begin(), rows.end(), [&](std::size_t row) {
    return !std::isnan(column.value[static_cast<Eigen::Index>(row)]);
  });
}

/// Returns values of a column on some rows, scaled to -1..1; 0 if not recorded. By rank if most
/// values are near one end. At least one of the rows must have a value.
Eigen::VectorXd scaled(const RecordedColumn& column, const std::vector<std::size_t>& rows, bool may_rank) {
  std::vector<double> known;
  for (const std::size_t row : rows) {
    const double v = column.value[static_cast<Eigen::Index>(row)];
    if (!std::isnan(v)) known.push_back(v);
  }
  std::sort(known.begin(), known.end());
  const double low = known.front(), high = known.back();
  const auto to_unit = [&](double v) { return high > low ? 2 * (v - low) / (high - low) - 1 : 0.0; };
  const bool crowded = std::abs(to_unit(known[known.size() / 2])) > kCrowded;
  Eigen::VectorXd u = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(rows.size()));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double v = column.value[static_cast<Eigen::Index>(rows[i])];
    if (std::isnan(v)) continue;
    double at = to_unit(v);
    if (crowded && may_rank) {
      const auto range = std::equal_range(known.begin(), known.end(), v);
      at = static_cast<double>((range.first - known.begin()) + (range.second - known.begin())) /
               static_cast<double>(known.size()) -
           1;
    }
    u[static_cast<Eigen::Index>(i)] = at;
  }
  return u;
}

std::size_t level_count(const RecordedColumn& column, const std::vector<std::size_t>& rows) {
  std::set<double> levels;
  for (const std::size_t row : rows) {
    const double v = column.value[static_cast<Eigen::Index>(row)];
    if (!std::isnan(v)) levels.insert(v);
    if (levels.size() > kMostLevels) break;
  }
  return levels.size();
}

class Builder {
 public:
  Builder(const std::vector<RecordedColumn>& columns, const std::vector<std::size_t>& rows)
      : columns_(columns), rows_(rows), main_(columns.size()), simple_(columns.size()) {
    add(Eigen::VectorXd::Ones(static_cast<Eigen::Index>(rows.size())));
    terms_.push_back({Shape::kConstant, kNoColumn, {}, 0, {0}, {}});
  }

  void add_column(std::size_t at) {
    const RecordedColumn& column = columns_[at];
    // One of several files may lack the column. Readings of a kind that only that file has do not
    // contain it.
    if (!is_recorded(column, rows_)) return;
    if (column.kind == ColumnKind::kRun) return add_runs(at);
    if (column.kind == ColumnKind::kDirection) return add_direction(at);
    add_curves(at, scaled(column, rows_, false), scaled(column, rows_, true));
    if (column.turns) add_harmonics(at);
    if (column.kind != ColumnKind::kVisit && column.kind != ColumnKind::kTime) add_square(at);
  }

  void add_pair(std::size_t a, std::size_t b) {
    if (simple_[a].empty() || simple_[b].empty()) return;
    BasisTerm term{Shape::kProduct, a, b, 1, {}, main_[a]};
    term.adjust.insert(term.adjust.end(), main_[b].begin(), main_[b].end());
    for (const Eigen::Index i : simple_[a])
      for (const Eigen::Index k : simple_[b]) {
        const Eigen::VectorXd product = centred(functions_[static_cast<std::size_t>(i)])
                                            .cwiseProduct(centred(functions_[static_cast<std::size_t>(k)]));
        if (product.squaredNorm() > kZeroSquare) term.subject.push_back(add(product));
      }
    if (!term.subject.empty()) terms_.push_back(term);
  }

  Basis finish() {
    Basis basis;
    basis.matrix.resize(static_cast<Eigen::Index>(rows_.size()),
                        static_cast<Eigen::Index>(functions_.size()));
    for (std::size_t i = 0; i < functions_.size(); ++i)
      basis.matrix.col(static_cast<Eigen::Index>(i)) = functions_[i];
    basis.terms = std::move(terms_);
    return basis;
  }

 private:
  static Eigen::VectorXd centred(const Eigen::VectorXd& f) { return (f.array() - f.mean()).matrix(); }

  Eigen::Index add(Eigen::VectorXd f) {
    const double norm = f.norm();
    if (norm > 0) f /= norm;
    functions_.push_back(std::move(f));
    return static_cast<Eigen::Index>(functions_.size()) - 1;
  }

  /// line: the values themselves; u: argument of the curves.
  void add_curves(std::size_t at, const Eigen::VectorXd& line, const Eigen::VectorXd& u) {
    const auto levels =
        static_cast<int>(std::min<std::size_t>(level_count(columns_[at], rows_), kMostLevels));
    const int degree = std::min(kMostDegree, levels - 1);
    std::vector<Eigen::Index> sofar{add(line)};
    terms_.push_back({Shape::kLinear, at, {}, 1, sofar, {}});
    if (!columns_[at].turns) simple_[at] = sofar;
    if ((line - u).squaredNorm() > 0 && degree > 1) sofar.push_back(add(u));
    main_[at] = sofar;
    Eigen::VectorXd before = Eigen::VectorXd::Ones(u.size()), now = u;
    for (int n = 2; n <= degree; ++n) {
      const Eigen::VectorXd next = ((2 * n - 1) * u.cwiseProduct(now) - (n - 1) * before) / n;
      before = now;
      now = next;
      sofar.push_back(add(now));
      if (n == 2) main_[at].push_back(sofar.back());
      if (n == 2 || n == kMiddleDegree || n == degree)
        terms_.push_back({Shape::kCurve, at, {}, n, sofar, {}});
    }
  }

  void add_harmonics(std::size_t at) {
    for (int n = 1; n <= 2; ++n) {
      BasisTerm term{Shape::kPeriodic, at, {}, n, {}, {}};
      for (const bool sine : {true, false}) {
        Eigen::VectorXd f(static_cast<Eigen::Index>(rows_.size()));
        for (std::size_t i = 0; i < rows_.size(); ++i) {
          const double angle =
              n * columns_[at].value[static_cast<Eigen::Index>(rows_[i])] * maths::kRadPerDeg;
          f[static_cast<Eigen::Index>(i)] = sine ? std::sin(angle) : std::cos(angle);
        }
        term.subject.push_back(add(f));
        if (n == 1) {
          simple_[at].push_back(term.subject.back());
          main_[at].push_back(term.subject.back());
        }
      }
      terms_.push_back(term);
    }
  }

  void add_square(std::size_t at) {
    if (level_count(columns_[at], rows_) < 3) return;
    Eigen::VectorXd f(static_cast<Eigen::Index>(rows_.size()));
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const double v = columns_[at].value[static_cast<Eigen::Index>(rows_[i])];
      f[static_cast<Eigen::Index>(i)] = std::isnan(v) ? 0 : v * v;
    }
    if (f.squaredNorm() > 0) terms_.push_back({Shape::kSquare, at, {}, 2, {add(f)}, {}});
  }

  void add_direction(std::size_t at) {
    Eigen::VectorXd odd(static_cast<Eigen::Index>(rows_.size()));
    for (std::size_t i = 0; i < rows_.size(); ++i)
      odd[static_cast<Eigen::Index>(i)] = columns_[at].value[static_cast<Eigen::Index>(rows_[i])];
    const Eigen::VectorXd even = odd.cwiseAbs();
    const bool senses = odd.minCoeff() < 0 && odd.maxCoeff() > 0;
    const Eigen::Index first = add(odd);
    main_[at] = {first};
    simple_[at] = {first};
    terms_.push_back({senses ? Shape::kReverses : Shape::kLinear, at, {}, 1, {first}, {}});
    if (!senses || even.minCoeff() == even.maxCoeff()) return;
    main_[at].push_back(add(even));
    terms_.push_back({Shape::kCurve, at, {}, 2, main_[at], {}});
  }

  void add_runs(std::size_t at) {
    std::set<double> labels;
    for (const std::size_t row : rows_) labels.insert(columns_[at].value[static_cast<Eigen::Index>(row)]);
    if (labels.size() < 2 || labels.size() > std::min(kMostRuns, rows_.size() / kRowsPerRun)) return;
    BasisTerm term{Shape::kJumps, at, {}, 1, {}, {}};
    for (auto label = std::next(labels.begin()); label != labels.end(); ++label) {
      Eigen::VectorXd f(static_cast<Eigen::Index>(rows_.size()));
      for (std::size_t i = 0; i < rows_.size(); ++i)
        f[static_cast<Eigen::Index>(i)] =
            columns_[at].value[static_cast<Eigen::Index>(rows_[i])] == *label ? 1 : 0;
      term.subject.push_back(add(f));
    }
    main_[at] = term.subject;
    if (labels.size() <= kMostRunsOfProducts) simple_[at] = term.subject;
    terms_.push_back(term);
  }

  const std::vector<RecordedColumn>& columns_;
  const std::vector<std::size_t>& rows_;
  std::vector<Eigen::VectorXd> functions_;
  std::vector<std::vector<Eigen::Index>> main_, simple_;  // per column: first and second order; for products
  std::vector<BasisTerm> terms_;
};

/// Order in which pairs are tested: positions with one another, then with direction and inputs.
int pair_rank(const RecordedColumn& a, const RecordedColumn& b) {
  const auto rank = [](const RecordedColumn& c) {
    switch (c.kind) {
      case ColumnKind::kAxis:
        return 0;
      case ColumnKind::kDirection:
      case ColumnKind::kInput:
        return 1;
      case ColumnKind::kTime:
        return 3;
      case ColumnKind::kNormal:
        return 2;
      case ColumnKind::kMotion:
        return c.name.starts_with(format::entry_of(AxisQuantity::kAcceleration).prefix) ||
                       c.name.starts_with(format::entry_of(AxisQuantity::kSince).prefix)
                   ? 5
                   : 2;
      case ColumnKind::kVisit:
        return 5;
      case ColumnKind::kRun:
        break;
    }
    return 100;
  };
  return rank(a) + rank(b);
}

}  // namespace

std::vector<RecordedColumn> recorded_columns(const model::Machine& machine, const model::Measurement& m,
                                             const std::vector<std::size_t>& rows) {
  std::vector<RecordedColumn> list;
  Recorder recorder(rows, list);
  const model::States& s = m.states;
  const std::vector<model::Column> touched = model::touched_positions(machine, m);
  for (std::size_t i = 0; i < machine.axes.size(); ++i)
    recorder.add(machine.axes[i].name, machine.axes[i].rotary ? "deg" : "mm", ColumnKind::kAxis,
                 model::commanded(m, i) + touched[i] - s.axis[i], machine.axes[i].rotary);
  add_motion(recorder, machine, m);
  if (m.has_recorded(columns::kTime))
    recorder.add(columns::kTime, format::column_unit(columns::kTime), ColumnKind::kTime, s.time);
  recorder.add(columns::kVisit, "", ColumnKind::kVisit, s.visit);
  model::Column run(static_cast<Eigen::Index>(m.rows()));
  for (std::size_t row = 0; row < m.rows(); ++row)
    run[static_cast<Eigen::Index>(row)] = static_cast<double>(s.run[row]);
  recorder.add(columns::kRun, "", ColumnKind::kRun, run);
  for (std::size_t i = 0; i < machine.inputs.size(); ++i)
    recorder.add(machine.inputs[i].name, machine.inputs[i].unit, ColumnKind::kInput, s.input[i]);
  for (const model::CandidateInput& candidate : m.candidates)
    recorder.add(candidate.name, candidate.unit, ColumnKind::kInput, candidate.value);
  for (std::size_t k = 0; k < 3; ++k)
    recorder.add(std::string("n") + "xyz"[k], "", ColumnKind::kNormal, s.normal[k]);
  return list;
}

Basis make_basis(const std::vector<RecordedColumn>& columns, const std::vector<std::size_t>& rows) {
  Builder builder(columns, rows);
  for (std::size_t i = 0; i < columns.size(); ++i) builder.add_column(i);
  struct Pair {
    int rank;
    std::size_t a, b;
  };
  std::vector<Pair> pairs;
  for (std::size_t a = 0; a < columns.size(); ++a)
    for (std::size_t b = a + 1; b < columns.size(); ++b)
      pairs.push_back({pair_rank(columns[a], columns[b]), a, b});
  std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& p, const Pair& q) { return p.rank < q.rank; });
  if (pairs.size() > kMostPairs) pairs.resize(kMostPairs);
  for (const Pair& pair : pairs) builder.add_pair(pair.a, pair.b);
  return builder.finish();
}

}  // namespace vernier::residual
