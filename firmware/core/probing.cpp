// SPDX-License-Identifier: Apache-2.0
#include "firmware/core/probing.h"

#include "comp/fixed.h"

namespace vernier {

InstantNs ProbeSettings::time_uncertainty(InstantNs resolution) const noexcept {
  constexpr std::int64_t kMost = 500'000'000;  // beyond every setting; twelve squares of it fit
  const auto square = [](InstantNs time) {
    const auto size = static_cast<std::uint64_t>(clamp<std::int64_t>(time.count, 0, kMost));
    return size * size;
  };
  // A stamp is anywhere in its resolution with the same probability: variance of a twelfth. Rounded up.
  const std::uint64_t twelve_times = square(resolution) + 12 * (square(delay_spread) + square(age_spread));
  std::uint64_t root = 0;
  for (std::uint64_t bit = std::uint64_t{1} << 30; bit != 0; bit >>= 1)
    if (12 * (root + bit) * (root + bit) <= twelve_times) root += bit;
  if (12 * root * root < twelve_times) ++root;
  return InstantNs(static_cast<std::int64_t>(root));
}

Probing::Probing(ProbeLine& line, const ProbeSettings& settings, AxisReader* actual) noexcept
    : line_(line),
      settings_(settings),
      actual_(actual),
      time_uncertainty_(settings.time_uncertainty(line.resolution())),
      filter_(settings.settle) {}

void Probing::sample(const Cycle& cycle, const TickReport& report, InstantNs woke) noexcept {
  LatchSample now;
  now.at = woke - settings_.position_age;
  for (std::uint32_t i = 0; i < settings_.axes; ++i) {
    AxisReading stands;
    const bool known = actual_ != nullptr && actual_->read_axis(i, stands) == HalFault::kNone;
    now.position[i] = known ? stands.position : cycle.axis_state(i).position;
  }
  const BoundProgram& program = cycle.program();
  for (const Output& out : program.program.outputs) {
    const std::uint32_t axis = program.axis[out.axis];
    const std::int64_t owed = report.output.wanted[out.axis].counts - cycle.written(axis).count;
    now.owed[axis] = Correction{narrow(clamp<std::int64_t>(owed, INT32_MIN, INT32_MAX))};
  }
  ring_.add(now);
  state_ = 0;
  if (program.empty()) state_ |= kTouchUncompensated;
  if (report.latched != Fault::kNone) state_ |= kTouchWhileFaulted;
}

void Probing::wait_for(const Touch& touch) noexcept {
  if (waiting_count_ == kMostWaiting) {
    ++lost_touches_;
    return;
  }
  waiting_[(first_ + waiting_count_++) % kMostWaiting] = touch;
}

void Probing::take_edges(InstantNs woke) noexcept {
  Touch touch;
  for (std::uint32_t i = 0; i < kMostEdges; ++i) {
    ProbeEdge edge;
    const HalFault fault = line_.read_edge(edge);
    if (fault == HalFault::kRefused) {
      ++lost_edges_;
      continue;
    }
    if (fault != HalFault::kNone) break;
    if (filter_.edge(edge.at, edge.made, touch)) wait_for(touch);
  }
  if (filter_.wait(woke, touch)) wait_for(touch);
}

// False where the touch has to wait for further samples.
bool Probing::publish(const Touch& touch, InstantNs zero, const WorkpieceFrame& frame,
                      Exchange& exchange) noexcept {
  TouchRecord record;
  record.time_ns = (touch.at - settings_.delay - zero).count;
  record.kind = static_cast<std::uint8_t>(touch.kind);
  record.bounces = touch.bounces;
  LatchFault fault =
      touch.kind == TouchKind::kMissed ? LatchFault::kNone : ring_.seek(touch.at - settings_.delay);
  if (fault == LatchFault::kNotYet) return false;
  record.flags = state_;
  PositionNm machine[3], workpiece[3];
  for (std::uint32_t i = 0;
       i < settings_.axes && fault == LatchFault::kNone && touch.kind != TouchKind::kMissed; ++i) {
    LatchedPosition latched;
    fault = ring_.position_of(i, settings_.rollover[i], time_uncertainty_, latched);
    record.position[i] = latched.position.count;
    // With the whole correction the axis would be at its commanded position: the error of the tool point is
    // the missing part.
    record.compensated[i] = latched.position.count - latched.owed.count;
    record.uncertainty[i] = latched.uncertainty.count;
  }
  record.fault = static_cast<std::uint8_t>(fault);
  bool has_xyz = fault == LatchFault::kNone && touch.kind != TouchKind::kMissed;
  for (std::uint32_t i = 0; i < 3; ++i) {
    has_xyz = has_xyz && settings_.xyz[i] < settings_.axes;
    if (has_xyz) machine[i] = PositionNm(record.compensated[settings_.xyz[i]]);
  }
  if (has_xyz) {
    frame.to_workpiece(machine, workpiece);
    for (int i = 0; i < 3; ++i) record.workpiece_nm[i] = workpiece[i].count;
    record.flags |= kTouchInWorkpiece;
  }
  record.lost_edges = lost_edges_, record.lost_touches = lost_touches_;
  record.spikes = filter_.counts().spikes, record.missing = filter_.counts().missing;
  exchange.touches.add(record);
  return true;
}

void Probing::after_tick(const Cycle& cycle, const TickReport& report, InstantNs woke, TimeUs time,
                         Exchange& exchange) noexcept {
  sample(cycle, report, woke);
  take_edges(woke);
  WorkpieceFrame frame;
  // A frame that is being written is taken a tick later: the touches wait.
  if (waiting_count_ == 0 || !exchange.workpiece.read(frame, 1)) return;
  const InstantNs zero = woke - instant_ns(time);
  while (waiting_count_ > 0 && publish(waiting_[first_], zero, frame, exchange)) {
    first_ = (first_ + 1) % kMostWaiting;
    --waiting_count_;
  }
}

}  // namespace vernier
