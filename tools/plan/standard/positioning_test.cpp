// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/plan/standard/positioning_test.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <random>

#include "tools/format/columns.h"
#include "tools/kinematics/at.h"
#include "tools/kinematics/rotations.h"
#include "tools/maths/rounding.h"
#include "tools/model/chain/chain.h"
#include "tools/model/chain/work_poses.h"
#include "tools/plan/offered_poses.h"
#include "tools/text/error.h"
#include "tools/text/numbers.h"
#include "tools/text/words.h"

namespace vernier::plan {
namespace {

// ISO 230-2:2014, 4.3.2 to 4.3.4.
constexpr double kLongAxis_mm = 2000, kLongInterval_mm = 250, kShortInterval_mm = 200;
constexpr std::size_t kFewest = 5, kRuns = 5, kLongRuns = 1;
constexpr double kQuarter_deg = 90, kHalf_deg = 180;
constexpr std::size_t kOfQuarter = 3, kOfHalf = 5, kOfTurn = 8;
constexpr double kShareOfInterval = 0.3;  // largest random part without a known period

constexpr double kOverrunShare = 0.01;  // of the range
constexpr std::uint32_t kSeed = 230;    // of the random parts: equal requests give equal targets
constexpr double kDigit = 0.01;         // targets are rounded to this, mm or deg
constexpr std::size_t kMostTargets = 500, kMostRuns = 50;
constexpr double kSecondsPerMinute = 60;

std::size_t required_targets(double span, bool rotary) {
  if (rotary) return span <= kQuarter_deg ? kOfQuarter : span <= kHalf_deg ? kOfHalf : kOfTurn;
  const double interval = span > kLongAxis_mm ? kLongInterval_mm : kShortInterval_mm;
  return std::max(kFewest, static_cast<std::size_t>(std::ceil(span / interval - 1e-9)) + 1);
}

std::size_t axis_named(const model::Machine& machine, const std::string& name) {
  for (std::size_t i = 0; i < machine.axes.size(); ++i)
    if (machine.axes[i].name == name) return i;
  throw text::InputError({}, name, "--positioning: the machine has no axis of this name");
}

std::array<double, 2> range_of(const model::Machine& machine, std::size_t axis) {
  constexpr double kTurn_deg = 360;  // range of an axis with rollover
  const auto range = model::work_range(machine, axis);
  if (!range && machine.axes[axis].rollover) return {0, kTurn_deg};
  if (!range)
    throw text::InputError({machine.file, machine.axes[axis].line}, machine.axes[axis].name,
                           "the test needs min and max of this axis in the machine file, or --from and --to");
  return *range;
}

/// The ends of the axis, if the machine file has them.
void require_in_range(const model::Machine& machine, std::size_t axis, double low, double high) {
  const model::Axis& of = machine.axes[axis];
  constexpr double kRounding = 1e-9;  // mm or deg, of sums of the request
  if (of.rollover || ((!of.min || low >= *of.min - kRounding) && (!of.max || high <= *of.max + kRounding)))
    return;
  throw text::InputError(
      {}, of.name,
      fmt::format("the test moves the axis from {:g} to {:g}, which is outside its range; give --from, --to "
                  "or --overrun",
                  low, high));
}

/// Ascending targets from `from` to `to`: the ends exactly, the others with a random part.
std::vector<double> targets_of(double from, double to, std::size_t count, std::optional<double> period) {
  std::mt19937 random(kSeed);
  const double interval = (to - from) / static_cast<double>(count - 1);
  const double most = std::min(period.value_or(kShareOfInterval * interval), kShareOfInterval * interval);
  std::vector<double> targets;
  for (std::size_t i = 0; i < count; ++i) {
    const bool end = i == 0 || i + 1 == count;
    const double share = 2 * static_cast<double>(random()) / static_cast<double>(std::mt19937::max()) - 1;
    const double at = from + static_cast<double>(i) * interval + (end ? 0 : share * most);
    targets.push_back(end ? at : maths::rounded_to(at, kDigit));
  }
  return targets;
}

std::vector<double> rest_of(const model::Machine& machine, std::size_t tested, const std::string& at) {
  const model::States given = kinematics::state_at(machine, at);
  std::vector<double> rest;
  for (std::size_t i = 0; i < machine.axes.size(); ++i) {
    const auto words = text::parts_of(at, ',');
    const bool named = std::any_of(words.begin(), words.end(), [&](const std::string& word) {
      return text::trimmed(word).starts_with(machine.axes[i].name + "=");
    });
    const auto range = model::work_range(machine, i);
    if (named)
      rest.push_back(given.axis[i][0]);
    else
      rest.push_back(i != tested && range ? maths::rounded_to(((*range)[0] + (*range)[1]) / 2, kDigit) : 0);
  }
  return rest;
}

/// The coordinate that changes most when the axis moves: x, y, z, or rx, ry, rz.
std::string reading_of(const model::Machine& machine, const PositioningTest& test) {
  model::States states = model::make_states(2, machine);
  for (std::size_t i = 0; i < machine.axes.size(); ++i)
    for (Eigen::Index end = 0; end < 2; ++end) states.axis[i][end] = test.rest[i];
  states.axis[test.axis][0] = test.targets[0];
  states.axis[test.axis][1] = test.targets[1];
  const model::Poses poses = model::forward(model::nominal_machine(machine), states);
  const Eigen::Vector3d change =
      test.rotary ? kinematics::rotation_vector(poses.rotation[1] * poses.rotation[0].transpose())
                  : Eigen::Vector3d(poses.position.col(1) - poses.position.col(0));
  Eigen::Index most = 0;
  change.cwiseAbs().maxCoeff(&most);
  const auto& names = test.rotary ? format::columns::kRotation : format::columns::kPoint;
  return names[static_cast<std::size_t>(most)];
}

double minutes_of(const PositioningTest& test) {
  const double run = test.targets.back() - test.targets.front() + 2 * test.overrun;
  const double readings = 2 * static_cast<double>(test.targets.size());
  return static_cast<double>(test.runs) * (2 * run / test.feed + readings * test.dwell_s / kSecondsPerMinute);
}

/// Calls `visit(run, target, direction)` for each reading in the order of the test cycle.
void each_reading(const PositioningTest& test,
                  const std::function<void(std::size_t, std::size_t, int)>& visit) {
  for (std::size_t run = 1; run <= test.runs; ++run) {
    for (std::size_t i = 0; i < test.targets.size(); ++i) visit(run, i, 1);
    for (std::size_t i = test.targets.size(); i-- > 0;) visit(run, i, -1);
  }
}

std::string rest_text(const model::Machine& machine, const PositioningTest& test, const char* form,
                      const char* between) {
  std::string text;
  for (std::size_t i = 0; i < machine.axes.size(); ++i)
    if (i != test.axis)
      text += (text.empty() ? "" : between) +
              fmt::format(fmt::runtime(form), machine.axes[i].name, text::fixed_text(test.rest[i], 4));
  return text;
}

}  // namespace

PositioningTest positioning_test(const model::Machine& machine, const PositioningTestOptions& options) {
  PositioningTest test;
  test.axis = axis_named(machine, options.axis);
  test.rotary = machine.axes[test.axis].rotary;
  test.feed = options.feed, test.dwell_s = options.dwell_s;
  const bool ends = options.from && options.to;
  const std::array<double, 2> range =
      ends ? std::array{*options.from, *options.to} : range_of(machine, test.axis);
  test.overrun = options.overrun.value_or(
      std::max(kDigit, maths::rounded_to(kOverrunShare * std::abs(range[1] - range[0]), kDigit)));
  const double inside = machine.axes[test.axis].rollover ? 0 : test.overrun;
  const double from = options.from.value_or(range[0] + inside), to = options.to.value_or(range[1] - inside);
  if (!(to - from > 10 * kDigit))
    throw text::InputError(
        {}, options.axis, fmt::format("the range from {:g} to {:g} leaves no travel for the test", from, to));
  require_in_range(machine, test.axis, from - test.overrun, to + test.overrun);
  const std::size_t count = options.targets > 0 ? options.targets : required_targets(to - from, test.rotary);
  if (count < 2 || count > kMostTargets)
    throw text::InputError({}, std::to_string(count), "the test needs 2 to 500 targets");
  test.interval = (to - from) / static_cast<double>(count - 1);
  if (test.interval < 10 * kDigit)
    throw text::InputError({}, std::to_string(count),
                           "with so many targets the interval is below 0.1 mm (deg)");
  test.targets = targets_of(from, to, count, options.period);
  const bool is_long = !test.rotary && to - from > kLongAxis_mm;
  test.runs = options.runs > 0 ? options.runs : is_long ? kLongRuns : kRuns;
  if (test.runs > kMostRuns)
    throw text::InputError({}, std::to_string(test.runs), "the test can have at most 50 runs");
  test.rest = rest_of(machine, test.axis, options.at);
  for (std::size_t i = 0; i < machine.axes.size(); ++i)
    if (i != test.axis) require_in_range(machine, i, test.rest[i], test.rest[i]);
  test.reading = reading_of(machine, test);
  test.minutes = minutes_of(test);
  return test;
}

std::string positioning_test_text(const model::Machine& machine, const PositioningTest& test) {
  const model::Axis& axis = machine.axes[test.axis];
  const char* const unit = test.rotary ? "deg" : "mm";
  const std::string rest = rest_text(machine, test, "{} = {}", ", ");
  std::string text = fmt::format(
      "{}: {} targets from {:g} to {:g} {}, mean interval {:.4g} {}, {} run{} in both directions: {} "
      "readings",
      axis.name, test.targets.size(), test.targets.front(), test.targets.back(), unit, test.interval, unit,
      test.runs, test.runs == 1 ? "" : "s", 2 * test.runs * test.targets.size());
  text += test.dwell_s > 0 ? fmt::format(", about {:.0f} minutes\n", std::max(1.0, test.minutes)) : "\n";
  if (!rest.empty()) text += fmt::format("The other axes are at {}.\n", rest);
  text += fmt::format("The axis moves {:g} {} beyond the first and the last target.\n", test.overrun, unit);
  if (test.runs < 2)
    text += "One run gives no repeatability. ISO 230-2 requires five runs (--runs 5) on an axis up to 2 m.\n";
  text += fmt::format("After the test: vernier evaluate iso230-2 FILE --axis {}{}\n", axis.name,
                      test.reading == text::in_small_letters(axis.name) ? "" : " --reading " + test.reading);
  return text;
}

std::string positioning_test_csv(const model::Machine& machine, const PositioningTest& test) {
  using format::AxisQuantity;
  const model::Axis& tested = machine.axes[test.axis];
  std::string text = fmt::format(
      "# Positioning of {}, ISO 230-2:2014. Fill in {}: the position that the instrument shows (target + "
      "deviation).\n",
      tested.name, test.reading);
  for (const model::Axis& axis : machine.axes)
    text += format::axis_heading(AxisQuantity::kPosition, axis.name, axis.rotary) + ",";
  text +=
      format::axis_heading(AxisQuantity::kSense, tested.name, tested.rotary) + "," + input_headings(machine);
  text += format::heading(test.reading) + "," + format::columns::kRun + "\n";
  each_reading(test, [&](std::size_t run, std::size_t target, int direction) {
    for (std::size_t i = 0; i < machine.axes.size(); ++i)
      text += text::fixed_text(i == test.axis ? test.targets[target] : test.rest[i], 4) + ",";
    text += fmt::format("{},{},{}\n", direction, input_references(machine), run);
  });
  return text;
}

std::string positioning_test_gcode(const model::Machine& machine, const PositioningTest& test) {
  const std::string& name = machine.axes[test.axis].name;
  const std::string feed = text::fixed_text(test.feed, 3);
  const auto move = [&](double to, const std::string& remark) {
    return fmt::format("G1 {}{:.4f} F{}{}\n", name, to, feed, remark.empty() ? "" : " ; " + remark);
  };
  std::string text = fmt::format(
      "; positioning of {}, ISO 230-2:2014: {} targets, {} runs, both directions\n"
      "; check clearances before running; warm the machine up as for its work\n",
      name, test.targets.size(), test.runs);
  if (test.dwell_s > 0) text += "; G4 P is in seconds (on a control with milliseconds write G4 X)\n";
  text += "G21 G90 G94\n";
  if (const std::string rest = rest_text(machine, test, "{}{}", " "); !rest.empty())
    text += fmt::format("G1 {} F{} ; the axes at rest\n", rest, feed);
  each_reading(test, [&](std::size_t run, std::size_t target, int direction) {
    const bool forward = direction > 0;
    const bool first = forward ? target == 0 : target + 1 == test.targets.size();
    if (first) {
      const double end = forward ? test.targets.front() - test.overrun : test.targets.back() + test.overrun;
      text += fmt::format("; run {}, {}\n", run, forward ? "forward" : "backward");
      text += move(end, "overrun");
    }
    text += move(test.targets[target], {});
    const std::string remark =
        fmt::format("read: run {}, target {}, {}", run, target + 1, forward ? "forward" : "backward");
    text += test.dwell_s > 0 ? fmt::format("G4 P{} ; {}\n", text::fixed_text(test.dwell_s, 3), remark)
                             : fmt::format("M0 ; {}\n", remark);
  });
  return text + "M30\n";
}

}  // namespace vernier::plan
