// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/bench/fit/ceres_bridge.h"

#include <ceres/ceres.h>
#include <time.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "tools/model/chain/chain_rows.h"

namespace vernier::bench {

using namespace vernier::model;
namespace {

constexpr double kRad = std::numbers::pi / 180;
constexpr std::size_t kTableAxes[3] = {1, 0, 2};  // in the order of the chain: Y, X, Z

template <class T>
using Vec3 = Eigen::Matrix<T, 3, 1>;
template <class T>
using Mat3 = Eigen::Matrix<T, 3, 3>;

template <class T>
Mat3<T> rotation(const T* deg) {
  using std::cos;
  using std::sin;
  const T a = deg[0] * kRad, b = deg[1] * kRad, c = deg[2] * kRad;
  const T sa = sin(a), ca = cos(a), sb = sin(b), cb = cos(b), sc = sin(c), cc = cos(c);
  Mat3<T> r;
  r << cb * cc, -cb * sc, sb, ca * sc + sa * sb * cc, ca * cc - sa * sb * sc, -sa * cb,
      sa * sc - ca * sb * cc, sa * cc + ca * sb * sc, ca * cb;
  return r;
}

/// One point: where it is, which stations it lies between, what was read.
struct Point {
  double position[3];  // of the axes in the order of the chain
  double weight[3];    // of the upper station
  double offset[3];    // of the reflector against the tool, mm
  double reading[3];   // mm
};

struct PointCost {
  explicit PointCost(const Point& point) : p(point) {}

  /// blocks: low and high station of each axis in the order of the chain, BaseShift, tool.
  template <class T>
  bool operator()(const T* y0, const T* y1, const T* x0, const T* x1, const T* z0, const T* z1, const T* base,
                  const T* tool, T* residual) const {
    const T* low[3] = {y0, x0, z0};
    const T* high[3] = {y1, x1, z1};
    constexpr int kMoves[3] = {1, 0, 2};
    Vec3<T> at(tool[0] + p.offset[0], tool[1] + p.offset[1], tool[2] + p.offset[2]);
    for (std::size_t k = 3; k-- > 0;) {
      T v[6];
      for (std::size_t c = 0; c < 6; ++c) v[c] = (1 - p.weight[k]) * low[k][c] + p.weight[k] * high[k][c];
      at = (rotation(v + 3) * at).eval();
      for (int c = 0; c < 3; ++c) at[c] += v[c];
      at[kMoves[k]] += T(p.position[k]);
    }
    at = (rotation(base + 3) * at).eval();
    for (int c = 0; c < 3; ++c) residual[c] = (at[c] + base[c] - p.reading[c]) / kUncertainty_mm;
    return true;
  }

  Point p;
};

/// The same with its derivatives written by hand.
class AnalyticCost : public ceres::SizedCostFunction<3, 6, 6, 6, 6, 6, 6, 6, 3> {
 public:
  explicit AnalyticCost(const Point& point) : p_(point) {}

  bool Evaluate(double const* const* blocks, double* residual, double** jacobians) const override {
    constexpr int kMoves[3] = {1, 0, 2};
    std::array<double, 6> v[3];
    Frame below[5];  // below each of: base, Y, X, Z; then the tool's
    std::array<double, 6> base;
    std::copy_n(blocks[6], 6, base.begin());
    const Frame base_frame = sixdof_frame(base);
    below[1] = base_frame;
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t c = 0; c < 6; ++c)
        v[k][c] = (1 - p_.weight[k]) * blocks[2 * k][c] + p_.weight[k] * blocks[2 * k + 1][c];
      v[k][static_cast<std::size_t>(kMoves[k])] += p_.position[k];
      const Frame link = sixdof_frame(v[k]);
      below[k + 2] = {below[k + 1].rotation * link.rotation,
                      below[k + 1].rotation * link.origin + below[k + 1].origin};
    }
    const Eigen::Vector3d tool =
        Eigen::Map<const Eigen::Vector3d>(blocks[7]) + Eigen::Map<const Eigen::Vector3d>(p_.offset);
    const Eigen::Vector3d tip = below[4].rotation * tool + below[4].origin;
    for (int c = 0; c < 3; ++c) residual[c] = (tip[c] - p_.reading[c]) / kUncertainty_mm;
    if (jacobians == nullptr) return true;
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Matrix<double, 3, 6> by = derivative(v[k], below[k + 1], tip);
      put(jacobians[2 * k], (1 - p_.weight[k]) * by);
      put(jacobians[2 * k + 1], p_.weight[k] * by);
    }
    put(jacobians[6], derivative(base, below[0], tip));
    put(jacobians[7], below[4].rotation / kUncertainty_mm);
    return true;
  }

 private:
  template <class Block>
  static void put(double* to, const Block& block) {
    constexpr int kColumns = Block::ColsAtCompileTime;
    if (to != nullptr) Eigen::Map<Eigen::Matrix<double, 3, kColumns, Eigen::RowMajor>>{to} = block;
  }

  static Eigen::Matrix<double, 3, 6> derivative(const std::array<double, 6>& v, const Frame& from,
                                                const Eigen::Vector3d& tip) {
    const Eigen::Vector3d local = from.rotation.transpose() * (tip - from.origin);
    const std::array<Twist, 6> twists = sixdof_twists(v, local);
    Eigen::Matrix<double, 3, 6> by;
    for (int c = 0; c < 6; ++c) by.col(c) = twists[static_cast<std::size_t>(c)].point;
    return from.rotation * by / kUncertainty_mm;
  }

  Point p_;
};

/// Values of the survey's parameters, as blocks that Ceres writes to.
struct Blocks {
  std::vector<double> station[3];  // six a station, in the order of the chain
  double base[kSetUps][6] = {};
  double tool[3] = {20, -30, -120};
};

/// Lower station and weight of the upper one.
std::pair<std::size_t, double> between(const Table& table, double at) {
  std::size_t k = 0;
  while (k + 2 < table.stations.size() && at > table.stations[k + 1].loc) ++k;
  const double low = table.stations[k].loc, high = table.stations[k + 1].loc;
  return {k, (at - low) / (high - low)};
}

ceres::CostFunction* cost_of(const Point& point, Configuration configuration) {
  if (configuration == Configuration::kBest) return new AnalyticCost(point);
  return new ceres::AutoDiffCostFunction<PointCost, 3, 6, 6, 6, 6, 6, 6, 6, 3>(new PointCost(point));
}

void fill(const Survey& survey, Configuration configuration, Blocks& blocks, ceres::Problem& problem) {
  for (std::size_t k = 0; k < 3; ++k)
    blocks.station[k].assign(6 * survey.start.table_of(kTableAxes[k])->stations.size(), 0);
  for (std::size_t i = 0; i < kSetUps; ++i)
    std::copy_n(survey.start.base_shifts[i].value.begin(), 6, blocks.base[i]);
  const States& states = survey.readings.states;
  for (std::size_t row = 0; row < survey.readings.rows(); ++row) {
    Point point;
    std::vector<double*> used;
    for (std::size_t k = 0; k < 3; ++k) {
      point.position[k] = states.axis[kTableAxes[k]][static_cast<Eigen::Index>(row)];
      const auto [low, weight] = between(*survey.start.table_of(kTableAxes[k]), point.position[k]);
      point.weight[k] = weight;
      used.push_back(blocks.station[k].data() + 6 * low);
      used.push_back(blocks.station[k].data() + 6 * low + 6);
    }
    for (std::size_t c = 0; c < 3; ++c) point.reading[c] = survey.readings.observations[3 * row + c].value;
    const std::string& run = states.run_names[states.run[row]];
    const auto set_up = static_cast<std::size_t>(run.back() - '0');
    for (std::size_t c = 0; c < 3; ++c)
      point.offset[c] = survey.targets == Targets::kFiveTargets ? kOffset_mm[set_up][c] : 0;
    used.push_back(blocks.base[set_up]);
    used.push_back(blocks.tool);
    problem.AddResidualBlock(cost_of(point, configuration), nullptr, used);
  }
}

class Watch : public ceres::IterationCallback {
 public:
  Watch(Race& result, double from) : result_(result), from_(from) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& summary) override {
    result_.way.push_back({thread_seconds() - from_, 2 * summary.cost});
    return ceres::SOLVER_CONTINUE;
  }

 private:
  Race& result_;
  double from_;
};

}  // namespace

double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

Race race_ceres(const Survey& survey, Configuration configuration) {
  Race race;
  const double from = thread_seconds();
  Blocks blocks;
  ceres::Problem problem;
  fill(survey, configuration, blocks, problem);
  ceres::Solver::Options options;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.max_num_iterations = 100;
  if (configuration == Configuration::kBest) options.initial_trust_region_radius = 1e8;
  Watch watch(race, from);
  options.callbacks.push_back(&watch);
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  race.converged = summary.termination_type == ceres::CONVERGENCE;
  return race;
}

}  // namespace vernier::bench
