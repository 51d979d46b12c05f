// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware/linuxcnc/joints.h"

#include <algorithm>
#include <cmath>

namespace vernier {
namespace {

constexpr double kCountsPerMm = 1e6, kCountsPerDeg = static_cast<double>(kTurnCounts) / 360;
// Far beyond every machine, and within what converts to counts.
constexpr double kMostCounts = 1e15;
// A reversal smaller than a count is ignored: inverse kinematics rounds.
constexpr double kTurnsAt = 1;

// Largest outward share of the way to a limit, where the slew limit would let more.
constexpr double kShareOfWay = 1.0 / 128;

// True if the pin is not connected: HAL gives such a pin a separate address.
bool is_loose(const hal_float_t* pin, const hal_float_t* loose) noexcept { return pin == loose; }

// Part of a jump by which it may miss the feedback that it goes to.
constexpr double kOfAJump = 1.0 / 8;

std::int64_t whole(double counts) noexcept {
  return std::llround(std::clamp(counts, -kMostCounts, kMostCounts));
}

}  // namespace

Joints::Joints(const Pins& pins, const Wiring& wiring, double mm_per_unit) noexcept
    : pins_(pins), count_(static_cast<std::uint32_t>(wiring.axes.size())), mm_per_unit_(mm_per_unit) {
  for (std::uint32_t i = 0; i < count_; ++i) {
    joints_[i].pins = &pins.joint[i];
    joints_[i].counts = wiring.axes[i].rotary ? kCountsPerDeg : kCountsPerMm * mm_per_unit;
    const CycleLimits limits;
    const AxisLimits& axis = wiring.axes[i].rotary ? limits.rotary : limits.linear;
    joints_[i].jump = static_cast<double>(axis.step);
  }
}

// Another zero than before: how it got there is no motion.
void Joints::start(Joint& joint, double position) noexcept {
  joint.position = position;
  joint.velocity = joint.acceleration = joint.back = joint.since = 0;
  joint.sense = 0;
  joint.reading = {};
  joint.reading.restarted = true;
}

double Joints::greatest_speed(const Joint& joint) noexcept {
  const double told = *joint.pins->max_velocity;
  return std::max(std::isfinite(told) ? told : 0.0, joint.fastest);
}

// LinuxCNC sets a joint that it does not enable to its feedback. After a following error the position jumps
// in one step by that error. That is no motion of the axis, and its direction does not change. A commanded
// motion differs from the feedback. Backlash on its way makes the two differ a little.
bool Joints::laid_on_feedback(const Joint& joint, double position, double seconds) noexcept {
  const double jump = std::abs(position - joint.position);
  const double off = std::abs(*joint.pins->cmd_in - *joint.pins->fb_out);
  return jump > greatest_speed(joint) * seconds && off < kOfAJump * jump;
}

void Joints::lay(Joint& joint, double position) noexcept {
  joint.position = position;
  joint.velocity = joint.acceleration = 0;
  joint.reading.restarted = true;
}

void Joints::turn(Joint& joint, double travel) noexcept {
  if (joint.sense == 0) {
    joint.sense = travel > 0 ? 1 : travel < 0 ? -1 : 0;
    return;
  }
  joint.back = std::max(0.0, joint.back - travel * joint.sense);
  joint.since += std::abs(travel);
  if (joint.back * joint.counts <= kTurnsAt) return;
  joint.sense = -joint.sense;
  joint.since = joint.back;
  joint.back = 0;
  joint.reading.since = {};
}

void Joints::move(Joint& joint, double position, double per_second) noexcept {
  const double travel = position - joint.position;
  const double velocity = travel * per_second;
  joint.acceleration = (velocity - joint.velocity) * per_second;
  joint.velocity = velocity;
  joint.position = position;
  // A faulty change is no speed of the joint.
  if (std::abs(travel) * joint.counts <= joint.jump)
    joint.fastest = std::max(joint.fastest, std::abs(velocity));
  turn(joint, travel);
  AxisReading& reading = joint.reading;
  reading.restarted = false;
  // Before the first reversal the way since the last one is not known.
  const bool turned = reading.since.count != INT64_MAX;
  if (turned) reading.since = AxisTravel(whole(joint.since * joint.counts));
  reading.sense = static_cast<std::int8_t>(joint.sense);
}

void Joints::read(double seconds) noexcept {
  seconds_ = seconds;
  all_homed_ = true;
  for (std::uint32_t i = 0; i < count_; ++i) {
    Joint& joint = joints_[i];
    const double given = *joint.pins->pos_in, commanded = *joint.pins->cmd_in, feedback = *joint.pins->fb_in;
    const double position =
        std::isnan(given) && is_loose(joint.pins->pos_in, joint.pins->pos_loose) ? commanded : given;
    const bool homed = *joint.pins->homed;
    const bool answers = std::isfinite(feedback) || is_loose(joint.pins->fb_in, joint.pins->fb_loose);
    joint.given = std::isfinite(commanded) && std::isfinite(position) && answers &&
                  std::abs(position) * joint.counts < kMostCounts;
    all_homed_ = all_homed_ && homed;
    ++joint.ticks;
    if (!joint.given) continue;
    // Since the reading before: one that was missing made the way no faster.
    const double elapsed = joint.ticks * seconds;
    joint.ticks = 0;
    if (!joint.known || (homed && !joint.homed))
      start(joint, position);
    else if (homed && laid_on_feedback(joint, position, elapsed))
      lay(joint, position);
    else
      move(joint, homed ? position : joint.position, 1 / elapsed);
    joint.known = true;
    joint.homed = homed;
    joint.reading.position = AxisPosition(whole(joint.position * joint.counts));
    joint.reading.velocity = AxisSpeed(whole(joint.velocity * joint.counts));
    joint.reading.acceleration = AxisAcceleration(whole(joint.acceleration * joint.counts));
  }
}

HalFault Joints::read_axis(std::uint32_t axis, AxisReading& reading) noexcept {
  if (axis >= count_) return HalFault::kNoDevice;
  if (!joints_[axis].given) return HalFault::kNoReading;
  reading = joints_[axis].reading;
  return HalFault::kNone;
}

HalFault Joints::read_path(PathReading& reading) noexcept {
  const double mm_per_min = *pins_.current_vel * mm_per_unit_ * 60;
  if (!std::isfinite(mm_per_min)) return HalFault::kNoReading;
  reading.feed = FeedNmPerMin(whole(mm_per_min * kCountsPerMm));
  reading.tells_feed = true;
  return HalFault::kNone;
}

HalFault Joints::write_correction(std::uint32_t axis, AxisTravel correction) noexcept {
  if (axis >= count_) return HalFault::kNoDevice;
  joints_[axis].correction = correction;
  return HalFault::kNone;
}

// A command that is beyond a limit already is the controller's: the correction then takes it no further.
// Counts.
double Joints::room_below(const Joint& joint) noexcept {
  return std::min(0.0, (*joint.pins->min_limit - joint.position) * joint.counts);
}
double Joints::room_above(const Joint& joint) noexcept {
  return std::max(0.0, (*joint.pins->max_limit - joint.position) * joint.counts);
}

// At the joint's greatest speed V the way to a limit shrinks by V a tick, so that the share S / V of it
// shrinks by the slew limit S; a count less, since it is rounded to whole ones.
double Joints::share_of_way(const Joint& joint) const noexcept {
  const double fastest = greatest_speed(joint) * joint.counts * seconds_;
  const auto slew = static_cast<double>(joint.slew);
  const double fades = std::max(slew - 1, slew / 2);
  return fades < kShareOfWay * fastest ? fades / fastest : kShareOfWay;
}

AxisTravel Joints::within_range(std::uint32_t axis, AxisTravel correction) const noexcept {
  if (axis >= count_) return AxisTravel{};
  const Joint& joint = joints_[axis];
  const double share = share_of_way(joint);
  const double low = std::ceil(share * room_below(joint)), high = std::floor(share * room_above(joint));
  return AxisTravel(whole(std::clamp(static_cast<double>(correction.count), low, high)));
}

// The slew limit has priority over the joint, its limits and the share of the distance. A joint that is
// faster than ever before, or a limit that is set below a correction, may therefore have the correction
// beyond the limit for a while.
void Joints::hold(Joint& joint, std::uint32_t i) noexcept {
  const AxisTravel target = within_range(i, joint.correction);
  joint.given_out.count += std::clamp(target.count - joint.given_out.count, -joint.slew, joint.slew);
  const auto full = static_cast<double>(joint.correction.count);
  joint.at_limit = full < room_below(joint) || full > room_above(joint);
}

// The feedback answers the command of the previous tick, which had the correction of that tick. If it is the
// command's signal, it has just become that of this tick. A value that is not a number keeps its previous
// value: the drive does not move, and a constant feedback is a following error to the controller as soon as
// the joint moves.
void Joints::write() noexcept {
  for (std::uint32_t i = 0; i < count_; ++i) {
    Joint& joint = joints_[i];
    hold(joint, i);
    const double added = static_cast<double>(joint.given_out.count) / joint.counts;
    joint.commanded = std::isfinite(*joint.pins->cmd_in) ? *joint.pins->cmd_in : joint.commanded;
    const double sent = joint.commanded + added;
    *joint.pins->cmd_out = sent;
    const double feedback = *joint.pins->fb_in;
    const bool is_the_command =
        feedback == sent || (std::isnan(feedback) && is_loose(joint.pins->fb_in, joint.pins->fb_loose));
    if (is_the_command)
      *joint.pins->fb_out = joint.commanded;
    else if (std::isfinite(feedback))
      *joint.pins->fb_out = feedback - joint.added;
    *joint.pins->correction = added;
    *joint.pins->at_limit = joint.at_limit;
    joint.added = added;
  }
}

bool Joints::any_at_limit() const noexcept {
  for (std::uint32_t i = 0; i < count_; ++i)
    if (joints_[i].at_limit) return true;
  return false;
}

HalFault Joints::stands(std::uint32_t joint, AxisPosition& position) const noexcept {
  if (joint >= count_ || !joints_[joint].given) return HalFault::kNoReading;
  const Joint& now = joints_[joint];
  const double feedback = *now.pins->fb_in;
  // From the motor's count to the joint's, which homing shifts.
  const double shift = now.position - *now.pins->cmd_in;
  if (!std::isfinite(feedback)) return HalFault::kNoReading;
  position = AxisPosition(whole((feedback - now.added + shift) * now.counts));
  return HalFault::kNone;
}

}  // namespace vernier
