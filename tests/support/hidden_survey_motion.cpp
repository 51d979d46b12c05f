// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/hidden_survey_motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/model/chain/chain.h"
#include "tools/model/machine_reader.h"

namespace vernier::support {

using namespace vernier::model;
namespace {

/// The machine on its way: what it must remember for sense and travel since the reversal.
class Walker {
 public:
  Walker(const Geometry& geometry, const MotionOptions& options, Draw& draw)
      : geometry_(geometry), options_(options), draw_(draw), count_(geometry.axes.size()) {
    for (const AxisPlace& axis : geometry.axes) at_.push_back(to_step((axis.low + axis.high) / 2, kGrid));
    direction_.assign(count_, 0);
    since_.assign(count_, 0);
    for (int i = 0; i < options.feeds; ++i) feeds_.push_back(geometry.feed * std::pow(0.35, i));
    // The machine has moved before the survey begins: no axis is without a sense.
    std::vector<double> corner;
    for (const AxisPlace& axis : geometry.axes) corner.push_back(axis.low);
    travel_to(corner);
    travel_to(random_pose());
  }

  std::vector<MotionRow> walk() {
    std::vector<std::size_t> per_run(options_.runs, options_.rows / options_.runs);
    per_run.back() += options_.rows % options_.runs;
    for (run_ = 0; run_ < options_.runs; ++run_) {
      begin_run();
      end_ = rows_.size() + per_run[run_];
      const std::size_t from = rows_.size();
      while (rows_.size() < end_)
        step(static_cast<double>(rows_.size() - from) / static_cast<double>(per_run[run_]));
    }
    return std::move(rows_);
  }

 private:
  static constexpr double kGrid = 1e-3;  // mm, deg: commands are written with three decimals

  void begin_run() { t_ += run_ == 0 ? 60 : draw_.uniform(1800, 14400); }

  void step(double part) {
    if (geometry_.axes.size() == 1 && geometry_.family != Family::kGearTrain) return cycle_point();
    if (options_.manner == Manner::kProbing) return probe();
    if (options_.manner == Manner::kAtRest) return rest(next_pose(part));
    const bool plane = linear_axes().size() >= 2;
    if (geometry_.family == Family::kBallBar || (plane && !options_.one_axis && draw_.chance(0.35)))
      return arc();
    line(next_pose(part));
  }

  double random_place(std::size_t i) {
    return to_step(draw_.uniform(geometry_.axes[i].low, geometry_.axes[i].high), kGrid);
  }
  std::vector<double> random_pose() {
    std::vector<double> pose;
    for (std::size_t i = 0; i < count_; ++i) pose.push_back(random_place(i));
    return pose;
  }
  /// Anywhere, or one axis on from here; `part` of the run is over.
  std::vector<double> next_pose(double part) {
    std::vector<double> pose = at_;
    if (options_.one_axis || draw_.chance(0.4)) {
      const std::size_t i = draw_.index(count_);
      pose[i] = random_place(i);
    } else {
      pose = random_pose();
    }
    if (options_.locked) {
      const AxisPlace& first = geometry_.axes.front();
      pose[0] = to_step(first.low + (first.high - first.low) * part, kGrid);
    }
    return pose;
  }
  std::vector<std::size_t> linear_axes() const {
    std::vector<std::size_t> linear;
    for (std::size_t i = 0; i < count_; ++i)
      if (!geometry_.axes[i].rotary) linear.push_back(i);
    return linear;
  }

  void travel_to(const std::vector<double>& pose) {
    for (std::size_t i = 0; i < count_; ++i) {
      const double by = pose[i] - at_[i];
      if (std::abs(by) < 1e-9) continue;
      const double sense = by > 0 ? 1 : -1;
      since_[i] = (sense == direction_[i] ? since_[i] : 0) + std::abs(by);
      direction_[i] = sense;
    }
    at_ = pose;
  }

  /// Seconds that a straight move takes at full speed.
  double duration(const std::vector<double>& pose, double feed) const {
    double square = 0, seconds = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      const double by = std::abs(pose[i] - at_[i]);
      if (geometry_.axes[i].rotary)
        seconds = std::max(seconds, by / (60 * feed / geometry_.feed));
      else
        square += by * by;
    }
    return std::max(seconds, std::sqrt(square) / (feed / 60));
  }

  MotionRow& record() {
    MotionRow row;
    row.q = at_;
    row.v.assign(count_, 0);
    row.a.assign(count_, 0);
    row.direction = direction_;
    row.since = since_;
    row.t = t_;
    row.run = run_;
    rows_.push_back(std::move(row));
    return rows_.back();
  }

  void rest(const std::vector<double>& pose) {
    const double feed = draw_.pick(feeds_);
    t_ += duration(pose, feed) + draw_.uniform(4, 12);
    travel_to(pose);
    record().feed = feed;
  }

  /// Cycles of ISO 230-2: up and down over the same targets, with an overrun at both ends.
  void cycle_point() {
    const AxisPlace& axis = geometry_.axes.front();
    if (targets_.empty()) {
      const std::size_t count = 11 + draw_.index(10);
      for (std::size_t i = 0; i < count; ++i)
        targets_.push_back(
            to_step(axis.low + (axis.high - axis.low) *
                                   (0.02 + 0.96 * (static_cast<double>(i) + draw_.uniform(-0.3, 0.3)) /
                                               static_cast<double>(count)),
                    kGrid));
      std::sort(targets_.begin(), targets_.end());
    }
    const std::size_t n = targets_.size(), k = cycle_++ % (2 * n);
    const bool up = k < n;
    if (k == 0) travel_to({axis.low});
    if (k == n) travel_to({axis.high});
    const double target = targets_[up ? k : 2 * n - 1 - k];
    if (options_.manner == Manner::kMoving) return line({target});
    rest({target});
  }

  /// Touches a face or a sphere: approaches 5 mm along the normal at one of the feeds.
  void probe() {
    const double feed = draw_.pick(feeds_) / 20;
    std::array<double, 3> n{};
    if (draw_.chance(0.5)) {
      n[draw_.index(3)] = draw_.sign();
    } else {
      for (double& c : n) c = draw_.normal();
      const double length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
      for (double& c : n) c = to_step(c / length, 1e-9);
    }
    const std::vector<double> touch = random_pose();
    std::vector<double> before = touch;
    const char* const names[] = {"X", "Y", "Z"};
    for (std::size_t i = 0; i < count_; ++i)
      for (std::size_t c = 0; c < 3; ++c)
        if (geometry_.axes[i].name == names[c]) before[i] += 5 * n[c] * geometry_.axes[i].tool_sense();
    t_ += duration(before, geometry_.feed) + draw_.uniform(1, 3);
    travel_to(before);
    t_ += 5 / (feed / 60);
    travel_to(touch);
    MotionRow& row = record();
    row.feed = feed;
    row.normal = n;
    for (std::size_t i = 0; i < count_; ++i) row.v[i] = (touch[i] - before[i]) / 5 * feed / 60;
  }

  /// A straight move with constant acceleration, speed, deceleration; read a few times on the way.
  void line(const std::vector<double>& pose) {
    const double feed = draw_.pick(feeds_), ramp = options_.one_axis ? 0.05 : draw_.uniform(0.1, 0.45);
    const double cruise = duration(pose, feed);
    if (cruise <= 0) return;
    const double total = cruise / (1 - ramp), speed = 1 / cruise;  // of the share of the way, 1/s
    const std::vector<double> from = at_;
    const double start = t_;
    const std::size_t reads = 2 + draw_.index(3);
    for (std::size_t k = 0; k < reads && rows_.size() < end_; ++k) {
      const double s = (static_cast<double>(k) + draw_.uniform(0.1, 0.9)) / static_cast<double>(reads);
      const double tau = total * (options_.one_axis ? 0.06 + 0.88 * s : s);
      t_ = start + tau;
      read_on_line(from, pose, tau, ramp, total, speed);
    }
    travel_to(pose);
    t_ = start + total + draw_.uniform(0.5, 3);
  }
  /// tau: s since the start of a move that takes `total`, the first and the last `ramp` of it accelerating.
  void read_on_line(const std::vector<double>& from, const std::vector<double>& to, double tau, double ramp,
                    double total, double speed) {
    const double accel = speed / (ramp * total);
    double way = 0, v = speed, a = 0;
    if (tau < ramp * total) {
      way = accel * tau * tau / 2;
      v = accel * tau;
      a = accel;
    } else if (tau > (1 - ramp) * total) {
      const double left = total - tau;
      way = 1 - accel * left * left / 2;
      v = accel * left;
      a = -accel;
    } else {
      way = speed * (tau - ramp * total / 2);
    }
    std::vector<double> here(count_);
    for (std::size_t i = 0; i < count_; ++i) here[i] = from[i] + (to[i] - from[i]) * way;
    travel_to(here);
    MotionRow& row = record();
    for (std::size_t i = 0; i < count_; ++i) {
      row.v[i] = (to[i] - from[i]) * v;
      row.a[i] = (to[i] - from[i]) * a;
    }
  }

  /// A circle in the plane of two linear axes at constant feed, either way round.
  void arc() {
    const bool bar = geometry_.family == Family::kBallBar;
    const std::vector<std::size_t> linear = linear_axes();
    const std::size_t i = bar ? 0 : draw_.index(linear.size());
    const std::size_t j = bar ? 1 : (i + 1 + draw_.index(linear.size() - 1)) % linear.size();
    const std::size_t x = linear[i], y = linear[j];
    const AxisPlace &ax = geometry_.axes[x], &ay = geometry_.axes[y];
    const double room = std::min(ax.high - ax.low, ay.high - ay.low) / 2;
    const std::vector<double> radii = {0.34 * room, 0.67 * room, 0.98 * room};
    const double r = bar ? draw_.pick(radii) : to_step(room * draw_.uniform(0.1, 0.9), kGrid);
    const double cx = bar ? 0 : draw_.uniform(ax.low + r, ax.high - r);
    const double cy = bar ? 0 : draw_.uniform(ay.low + r, ay.high - r);
    const double feed = draw_.pick(feeds_), omega = draw_.sign() * feed / 60 / r;
    const double begin = draw_.uniform(0, 2 * std::numbers::pi);
    const std::size_t reads = bar ? 40 : 6;
    const auto point = [&](double angle) {
      std::vector<double> pose = at_;
      pose[x] = cx + r * std::cos(angle);
      pose[y] = cy + r * std::sin(angle);
      return pose;
    };
    travel_to(point(begin));
    t_ += 5;
    constexpr std::size_t kSteps = 24;  // between readings, so that no reversal is jumped over
    double angle = begin;
    for (std::size_t k = 0; k < reads && rows_.size() < end_; ++k) {
      const double by =
          (omega > 0 ? 1 : -1) * 2 * std::numbers::pi / static_cast<double>(reads) * draw_.uniform(0.8, 1.2);
      for (std::size_t f = 0; f < kSteps; ++f) travel_to(point(angle += by / kSteps));
      t_ += by / omega;
      MotionRow& row = record();
      row.curvature = 1 / r;
      row.v[x] = -r * omega * std::sin(angle);
      row.v[y] = r * omega * std::cos(angle);
      row.a[x] = -r * omega * omega * std::cos(angle);
      row.a[y] = -r * omega * omega * std::sin(angle);
    }
    t_ += 2;
  }

  const Geometry& geometry_;
  const MotionOptions& options_;
  Draw& draw_;
  std::size_t count_, run_ = 0, end_ = 0, cycle_ = 0;
  double t_ = 0;
  std::vector<double> at_, direction_, since_, feeds_, targets_;
  std::vector<MotionRow> rows_;
};

/// Speed of the nominal tool point, mm/min, where the row moves and has no feed yet.
void set_path_feed(const Geometry& geometry, std::vector<MotionRow>& rows) {
  const Machine machine = nominal_machine(parse_machine(geometry.text, "family.xml"));
  std::vector<double> references;
  for (const Input& input : machine.inputs) references.push_back(input.hidden_axis ? 10 : input.reference);
  constexpr double kStep = 1e-4;  // s
  States ahead = make_states(rows.size(), machine.axes.size(), references);
  States behind = ahead;
  for (std::size_t r = 0; r < rows.size(); ++r)
    for (std::size_t i = 0; i < machine.axes.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(r);
      ahead.axis[i][at] = rows[r].q[i] + kStep * rows[r].v[i];
      behind.axis[i][at] = rows[r].q[i] - kStep * rows[r].v[i];
    }
  const Eigen::Matrix3Xd way = forward(machine, ahead).position - forward(machine, behind).position;
  for (std::size_t r = 0; r < rows.size(); ++r)
    if (rows[r].feed == 0)
      rows[r].feed = to_step(60 * way.col(static_cast<Eigen::Index>(r)).norm() / (2 * kStep), 1e-3);
}

}  // namespace

double to_step(double value, double step) { return std::round(value / step) * step; }

std::string run_label(std::size_t run) { return "s" + std::to_string(run + 1); }

std::vector<MotionRow> move(const Geometry& geometry, const MotionOptions& options, Draw& draw) {
  std::vector<MotionRow> rows = Walker(geometry, options, draw).walk();
  for (MotionRow& row : rows) {
    for (std::size_t i = 0; i < row.q.size(); ++i) {
      row.q[i] = to_step(row.q[i], 1e-4);
      row.v[i] = to_step(row.v[i], 1e-5);
      row.a[i] = to_step(row.a[i], 1e-4);
      row.since[i] = to_step(row.since[i], 1e-4);
    }
    row.t = to_step(row.t, 1e-3);
    row.curvature = to_step(row.curvature, 1e-9);
    row.check = draw.chance(0.2);
  }
  if (options.manner == Manner::kMoving) set_path_feed(geometry, rows);
  return rows;
}

}  // namespace vernier::support
