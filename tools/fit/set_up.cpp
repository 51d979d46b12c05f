// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fit/set_up.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "tools/fit/coverage/pose_readings.h"
#include "tools/fit/coverage/unseen_turns.h"
#include "tools/fit/least_squares/levenberg.h"
#include "tools/fit/least_squares/problem.h"
#include "tools/fit/least_squares/statistics.h"
#include "tools/fit/selection.h"
#include "tools/maths/alignment.h"
#include "tools/maths/factors.h"
#include "tools/maths/hand_eye.h"
#include "tools/model/chain/chain_rows.h"
#include "tools/model/chain/prediction.h"

namespace vernier::fit {
namespace {

/// Reach if nothing moves, mm.
constexpr double kLeastReach_mm = 10;
/// Of chi^2: a smaller decrease is rounding and does not replace a set-up.
constexpr double kSetUpGain = 1e-3;

struct SetUp {
  model::Machine machine;
  double cost = 0;
};

SetUp fitted_set_up(const model::Machine& machine, const model::ParameterSet& shifts,
                    const FitProblem& problem, const Eigen::VectorXd& start) {
  LevenbergOptions options;
  options.negligible = [](double cost) { return 1e-10 * cost; };
  options.slope = [&](const Eigen::VectorXd& x) { return problem.slope(x); };
  SetUp result{machine, 0};
  const LevenbergResult end = minimise(
      start, [&](const Eigen::VectorXd& x) { return problem.equations(x); },
      [&](const Eigen::VectorXd& x) { return problem.cost(x); }, options);
  shifts.set(result.machine, end.point);
  result.cost = end.cost;
  return result;
}

/// The free BaseShifts and ToolShifts of a machine as a problem of their own.
struct SetUpProblem {
  model::Machine rigid, at_zero;
  model::ParameterSet shifts;
  Eigen::VectorXd none;

  SetUpProblem(const model::Machine& machine, const model::Measurement& rows) : rigid(machine) {
    for (model::Freedom& one : model::freedoms_of(rigid))
      if (!model::is_set_up(one.kind())) one.set_free(false);
    shifts = model::ParameterSet(rigid, setups_of_fit_rows(rows));
    none = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(shifts.size()));
    at_zero = rigid;
    shifts.set(at_zero, none);
  }
};

/// Angles of Rx(a) Ry(b) Rz(c), deg.
Eigen::Vector3d angles_of(const Eigen::Matrix3d& r) {
  return maths::kDegPerRad * Eigen::Vector3d(std::atan2(-r(1, 2), r(2, 2)),
                                             std::asin(std::clamp(r(0, 2), -1.0, 1.0)),
                                             std::atan2(-r(0, 1), r(0, 0)));
}

/// Points of one BaseShift as the machine has them without it, and as they were read. Only rows
/// with x, y and z.
struct PointPairs {
  std::vector<Eigen::Vector3d> from, to;
};

/// Adds the points and centres of known place: as the machine finds them without the set-up, and as known.
void add_known_places(const SetUpProblem& problem, const model::Measurement& rows,
                      std::map<std::size_t, PointPairs>& pairs) {
  if (std::none_of(rows.things.begin(), rows.things.end(),
                   [](const model::Thing& one) { return one.in_measuring_frame(); }))
    return;
  const auto shift_of = [&](std::size_t row) {
    return model::base_shift_of(problem.rigid,
                                rows.states.names(rows.states.setup)[rows.states.of(rows.states.setup, row)]);
  };
  // Without its known place an object is in workpiece coordinates, elsewhere in each set-up.
  model::Measurement unknown = rows;
  unknown.things.clear();
  std::map<std::pair<std::size_t, std::optional<std::size_t>>, std::size_t> number;
  std::vector<std::pair<std::size_t, std::optional<std::size_t>>> source;
  for (std::size_t row = 0; row < rows.rows(); ++row) {
    if (rows.thing[row] == model::kNoThing) continue;
    const std::pair key(rows.thing[row], shift_of(row));
    const auto [at, fresh] = number.try_emplace(key, unknown.things.size());
    unknown.thing[row] = at->second;
    if (!fresh) continue;
    unknown.things.push_back(rows.things[key.first]);
    unknown.things.back().artefact.place.reset();
    source.push_back(key);
  }
  for (const model::EstimatedThing& one : model::estimate_things(problem.at_zero, unknown, {})) {
    const auto& [thing_number, shift] = source[one.thing];
    const model::Thing& thing = rows.things[thing_number];
    if (!shift || !thing.in_measuring_frame() || thing.artefact.has_direction()) continue;
    const std::array<double, 3>& place = *thing.artefact.place;
    pairs[*shift].from.push_back(one.shape.point);
    pairs[*shift].to.emplace_back(place[0], place[1], place[2]);
  }
}

std::map<std::size_t, PointPairs> points_of(const SetUpProblem& problem, const model::Measurement& rows) {
  std::map<std::size_t, PointPairs> pairs;
  add_known_places(problem, rows, pairs);
  const Eigen::VectorXd predicted = model::predict(problem.at_zero, rows);
  for (std::size_t i = 0; i + 2 < rows.observations.size(); ++i) {
    const auto* three = &rows.observations[i];
    if (three[0].kind != model::ObservationKind::kX || three[1].kind != model::ObservationKind::kY ||
        three[2].kind != model::ObservationKind::kZ || three[2].row != three[0].row)
      continue;
    const std::string& name =
        rows.states.names(rows.states.setup)[rows.states.of(rows.states.setup, three[0].row)];
    const auto shift = model::base_shift_of(problem.rigid, name);
    if (!shift) continue;
    pairs[*shift].from.push_back(predicted.segment<3>(static_cast<Eigen::Index>(i)));
    pairs[*shift].to.emplace_back(three[0].value, three[1].value, three[2].value);
  }
  return pairs;
}

/// Returns each set-up as computed from the points (Umeyama 1991); 0 for a set-up with fewer than
/// three points.
Eigen::VectorXd aligned_start(const SetUpProblem& problem, const model::Measurement& rows) {
  Eigen::VectorXd start = problem.none;
  for (const auto& [shift, pairs] : points_of(problem, rows)) {
    Eigen::Matrix3Xd from(3, pairs.from.size()), to(3, pairs.to.size());
    for (std::size_t k = 0; k < pairs.from.size(); ++k) {
      from.col(static_cast<Eigen::Index>(k)) = pairs.from[k];
      to.col(static_cast<Eigen::Index>(k)) = pairs.to[k];
    }
    // Known places alone start from what they give: one a shift, two the smallest turn.
    if (rows.things.empty() && !maths::fixes_motion(from)) continue;
    const maths::RigidMotion motion = maths::align(from, to);
    Eigen::Matrix<double, 6, 1> six;
    six << motion.translation, angles_of(motion.rotation);
    for (std::size_t i = 0; i < problem.shifts.size(); ++i)
      if (problem.shifts[i].kind == model::ParameterKind::kBaseShift && problem.shifts[i].item == shift)
        start[static_cast<Eigen::Index>(i)] = six[static_cast<Eigen::Index>(problem.shifts[i].column)];
  }
  return start;
}

/// Stands for the index of a shift that the machine file does not have.
constexpr std::size_t kNoShift = static_cast<std::size_t>(-1);
/// Complete poses of the fit rows, by the ToolShift of their set-up; their group is the BaseShift.
using PosesOfToolShift = std::map<std::size_t, std::vector<maths::SeenPose>>;

PosesOfToolShift seen_poses(const SetUpProblem& problem, const model::Measurement& rows) {
  PosesOfToolShift poses;
  const model::ChainRows chain(problem.rigid, rows.states);
  for (const SixReadings& readings : complete_poses(rows)) {
    const std::size_t row = rows.observations[readings.point].row;
    if (rows.check[row] != 0) continue;
    const maths::RigidMotion seen = motion_read(rows, readings);
    const std::string& name = rows.states.names(rows.states.setup)[rows.states.of(rows.states.setup, row)];
    const model::Frame pose = chain.pose(row);
    poses[model::tool_shift_of(problem.rigid, name).value_or(kNoShift)].push_back(
        {{pose.rotation, pose.origin},
         // The pose of a board in the frame of the camera is the inverse of that of the camera.
         readings.of_board ? maths::inverse_of(seen) : seen,
         model::base_shift_of(problem.rigid, name).value_or(kNoShift)});
  }
  return poses;
}

/// Returns the set-ups from complete poses in closed form: first each mounting (ToolShift), then each place
/// (BaseShift). nullopt: no mounting is unknown and no camera is on the tool, so that no such start is
/// needed.
std::optional<Eigen::VectorXd> posed_start(const SetUpProblem& problem, const model::Measurement& rows) {
  const bool camera = std::any_of(rows.observations.begin(), rows.observations.end(),
                                  [](const auto& o) { return format::is_of_board(o.kind); });
  const bool unknown = std::any_of(problem.shifts.begin(), problem.shifts.end(),
                                   [](const auto& p) { return p.kind == model::ParameterKind::kToolShift; });
  if (!camera && !unknown) return std::nullopt;
  Eigen::VectorXd start = problem.shifts.get(problem.rigid);
  const auto set = [&](model::ParameterKind kind, std::size_t item, const maths::RigidMotion& motion) {
    Eigen::Matrix<double, 6, 1> six;
    six << motion.translation, angles_of(motion.rotation);
    for (std::size_t i = 0; i < problem.shifts.size(); ++i)
      if (problem.shifts[i].kind == kind && problem.shifts[i].item == item)
        start[static_cast<Eigen::Index>(i)] = six[static_cast<Eigen::Index>(problem.shifts[i].column)];
  };
  std::map<std::size_t, std::vector<maths::SeenPose>> by_place;
  for (const auto& [tool, poses] : seen_poses(problem, rows)) {
    maths::RigidMotion mounting;
    if (tool != kNoShift) {
      const model::BaseShift& given = problem.rigid.tool_shifts[tool];
      const model::Frame frame = model::sixdof_frame(given.value);
      mounting = {frame.rotation, frame.origin};
      if (!given.hidden) mounting = maths::mounting_of(poses).value_or(mounting);
      set(model::ParameterKind::kToolShift, tool, mounting);
    }
    for (const maths::SeenPose& one : poses)
      by_place[one.group].push_back({one.pose * mounting, one.seen, one.group});
  }
  for (const auto& [place, poses] : by_place)
    if (place != kNoShift) set(model::ParameterKind::kBaseShift, place, maths::place_of(poses, {}));
  return start;
}

/// Returns all set-ups rotated by the same quarter turns about two axes: the 24 orientations of an
/// instrument's axes relative to the machine's.
std::vector<Eigen::VectorXd> quarter_turns(const SetUpProblem& problem) {
  std::vector<Eigen::VectorXd> starts;
  const auto add = [&](const Eigen::Vector3d& angles) {
    Eigen::VectorXd start = problem.none;
    for (std::size_t i = 0; i < problem.shifts.size(); ++i)
      if (problem.shifts[i].kind == model::ParameterKind::kBaseShift && problem.shifts[i].column >= 3)
        start[static_cast<Eigen::Index>(i)] = angles[static_cast<Eigen::Index>(problem.shifts[i].column) - 3];
    starts.push_back(start);
  };
  constexpr double kQuarter_deg = 90;  // of a turn
  for (int c = 0; c < 4; ++c) {
    for (int a = 0; a < 4; ++a) add({kQuarter_deg * a, 0, kQuarter_deg * c});
    for (const int b : {1, 3}) add({0, kQuarter_deg * b, kQuarter_deg * c});
  }
  return starts;
}

}  // namespace

double reach_of(const model::Machine& machine, const model::Measurement& rows) {
  const model::ChainRows chain(machine, rows.states);
  Eigen::Vector3d low = Eigen::Vector3d::Constant(1e300), high = -low;
  for (std::size_t row = 0; row < rows.rows(); ++row) {
    if (rows.check[row] != 0) continue;
    const Eigen::Vector3d point = chain.pose(row).origin;
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  return std::max(kLeastReach_mm, 0.5 * (high - low).norm());
}

model::Machine set_up(const model::Machine& machine, const model::Measurement& rows) {
  const SetUpProblem own(machine, rows);
  if (own.shifts.size() == 0) return machine;
  FitProblem problem(own.rigid, rows, own.shifts);
  const std::vector<bool> held = unseen_turns(own.at_zero, rows, own.shifts, reach_of(own.at_zero, rows));
  // Starts from the measuring frame itself. Components that no reading determines (the tilt of a
  // flat bar's circle) then are 0 for any file. Starts from the file's set-up if its result is
  // clearly lower (a frame rotated by more than a quarter turn).
  hold_at(problem, held, own.none);
  SetUp plain = fitted_set_up(machine, own.shifts, problem, own.none);
  const Eigen::VectorXd file = own.shifts.get(own.rigid);
  hold_at(problem, held, file);
  SetUp given = fitted_set_up(machine, own.shifts, problem, file);
  if (!rows.things.empty()) {
    const Eigen::VectorXd start = aligned_start(own, rows);
    model::Machine there = own.rigid;
    own.shifts.set(there, start);
    hold_at(problem, unseen_turns(there, rows, own.shifts, reach_of(there, rows)), start);
    SetUp aligned = fitted_set_up(machine, own.shifts, problem, start);
    if (aligned.cost < (1 - kSetUpGain) * plain.cost) plain = std::move(aligned);
  }
  if (const auto start = posed_start(own, rows)) {
    model::Machine there = own.rigid;
    own.shifts.set(there, *start);
    hold_at(problem, unseen_turns(there, rows, own.shifts, reach_of(there, rows)), *start);
    SetUp posed = fitted_set_up(machine, own.shifts, problem, *start);
    if (posed.cost < (1 - kSetUpGain) * plain.cost) plain = std::move(posed);
  }
  return given.cost < (1 - kSetUpGain) * plain.cost ? std::move(given.machine) : std::move(plain.machine);
}

model::Machine set_up_anywhere(const model::Machine& machine, const model::Measurement& measured) {
  model::Measurement rows = measured;
  rows.check.assign(rows.check.size(), 0);
  SetUp best{set_up(machine, rows), 0};
  const SetUpProblem own(machine, rows);
  if (own.shifts.size() == 0) return machine;
  FitProblem problem(own.rigid, rows, own.shifts);
  best.cost = problem.cost(own.shifts.get(best.machine));
  const auto attempt = [&](const Eigen::VectorXd& start) {
    model::Machine there = own.rigid;
    own.shifts.set(there, start);
    hold_at(problem, unseen_turns(there, rows, own.shifts, reach_of(there, rows)), start);
    const SetUp end = fitted_set_up(machine, own.shifts, problem, start);
    problem.clear_priors();
    const double cost = problem.cost(own.shifts.get(end.machine));
    if (cost < (1 - kSetUpGain) * best.cost) best = {end.machine, cost};
  };
  attempt(aligned_start(own, rows));
  // If the readings fit to ten times their uncertainty, the set-up is found.
  constexpr double kFound = 100;
  if (best.cost > kFound * static_cast<double>(rows.observations.size()))
    for (const Eigen::VectorXd& start : quarter_turns(own)) attempt(start);
  return best.machine;
}

std::string OtherSetUp::sentence() const {
  return fmt::format(
      "{}: the model does not contain the set-up of {} (residual {:.3g} um; with a separate set-up {:.3g} "
      "um){}",
      file, rows.empty() ? "this file" : rows, before_um, own_um,
      rows.empty()
          ? ""
          : "; if the instrument or its frame moved before these rows, give them a label of their own "
            "in the column setup, or write them into a file of their own");
}

namespace {

/// Rows that may have one set-up: their number in the measurement, and what they are.
struct RowGroup {
  std::size_t file = 0;
  std::string rows;  // empty: all rows of the file
  std::vector<std::size_t> keep;
};

/// Each file; and of a file with both roles its check rows, of a file with several runs each run.
std::vector<RowGroup> groups_of_rows(const model::Measurement& m) {
  constexpr std::size_t kMostRuns = 20;  // more runs are labels of the rows
  std::vector<RowGroup> groups;
  for (std::size_t file = 0; file < m.files.size(); ++file) {
    RowGroup all{file, "", {}}, check{file, "the check rows", {}};
    std::map<std::size_t, std::vector<std::size_t>> runs;
    for (std::size_t row = 0; row < m.rows(); ++row) {
      if (m.file[row] != file) continue;
      all.keep.push_back(row);
      if (m.check[row] != 0) check.keep.push_back(row);
      if (!m.states.run.empty()) runs[m.states.run[row]].push_back(row);
    }
    const bool both = !check.keep.empty() && check.keep.size() < all.keep.size();
    groups.push_back(std::move(all));
    if (both) groups.push_back(std::move(check));
    if (runs.size() < 2 || runs.size() > kMostRuns) continue;
    for (auto& [run, keep] : runs)
      groups.push_back({file, fmt::format("run {}", m.states.run_names[run]), std::move(keep)});
  }
  return groups;
}

}  // namespace

std::vector<OtherSetUp> files_set_up_elsewhere(const model::Machine& machine, const model::Measurement& m) {
  // Above the errors of a machine tool or robot; the decrease that only another set-up explains.
  constexpr double kFar_um = 500, kFalls = 20;
  constexpr std::size_t kLeast = 9;  // readings: a set-up has six numbers
  std::vector<OtherSetUp> list;
  std::set<std::size_t> named;  // files that a sentence names
  for (RowGroup& group : groups_of_rows(m)) {
    if (group.keep.empty() || named.contains(group.file)) continue;
    model::Measurement rows = model::select_rows(m, group.keep);
    rows.check.assign(rows.check.size(), 0);
    if (rows.observations.size() < kLeast) continue;
    const auto rms_um = [&](const model::Machine& one) {
      return role_statistics(rows, residuals(one, rows), false).rms_um.value_or(0);
    };
    OtherSetUp one{m.files[group.file], std::move(group.rows), rms_um(machine), 0};
    if (one.before_um < kFar_um) continue;
    one.own_um = rms_um(set_up_anywhere(machine, rows));
    if (kFalls * one.own_um >= one.before_um) continue;
    named.insert(group.file);
    list.push_back(std::move(one));
  }
  return list;
}

}  // namespace vernier::fit
