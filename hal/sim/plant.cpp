// SPDX-License-Identifier: Apache-2.0
#include "hal/sim/plant.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vernier {

SimPlant::SimPlant(Trajectory& trajectory, std::uint32_t axes, std::uint32_t inputs, PlantOptions options)
    : trajectory_(trajectory),
      axes_(axes),
      inputs_(inputs),
      options_(std::move(options)),
      random_(options_.seed) {}

const PlantFault* SimPlant::active_fault(PlantFaultKind kind, std::uint32_t index) const noexcept {
  for (const PlantFault& fault : options_.faults)
    if (fault.kind == kind && fault.index == index && tick_ >= fault.first &&
        tick_ < fault.first + fault.ticks)
      return &fault;
  return nullptr;
}

void SimPlant::advance() noexcept {
  ++tick_;
  if (moving_) ++path_tick_;
  moving_ = released_;
  trajectory_.at(std::max<std::int64_t>(0, path_tick_ - options_.delay_ticks), seen_);
  for (std::uint32_t axis = 0; axis < axes_; ++axis) spoil_axis(axis);
  if (!released_ && !options_.run_in) {  // standing: where, but not how fast
    for (AxisReading& reading : seen_.axis) reading.velocity = {}, reading.acceleration = {};
    seen_.path.feed = {}, seen_.path.curvature = {};
  }
  spoil_inputs();
}

void SimPlant::spoil_axis(std::uint32_t axis) noexcept {
  AxisPosition& position = seen_.axis[axis].position;
  if (options_.position_noise_counts > 0)
    position.count += std::llround(options_.position_noise_counts * normal_(random_));
  if (const PlantFault* jump = active_fault(PlantFaultKind::kJump, axis)) position.count += jump->counts;
  if (active_fault(PlantFaultKind::kFrozenAxis, axis) != nullptr)
    position = frozen_[axis];
  else
    frozen_[axis] = position;
  seen_.axis[axis].referenced = active_fault(PlantFaultKind::kReferenceLost, axis) == nullptr;
  const bool dropped =
      options_.dropout > 0 && std::uniform_real_distribution<double>()(random_) < options_.dropout;
  missing_[axis] = dropped || active_fault(PlantFaultKind::kMissingPosition, axis) != nullptr;
}

void SimPlant::spoil_inputs() noexcept {
  for (std::uint32_t input = 0; input < inputs_; ++input)
    if (const PlantFault* wild = active_fault(PlantFaultKind::kSensorWild, input))
      seen_.input[input].count += wild->counts;
  if (options_.input_noise_micro <= 0) return;
  for (std::uint32_t input = 0; input < inputs_; ++input)
    seen_.input[input].count += std::llround(options_.input_noise_micro * normal_(random_));
}

HalFault SimPlant::read_axis(std::uint32_t axis, AxisReading& reading) noexcept {
  if (axis >= axes_) return HalFault::kNoDevice;
  if (tick_ < 0 || missing_[axis]) return HalFault::kNoReading;
  AxisReading seen = seen_.axis[axis];
  if (!options_.gives_motion) {
    seen = AxisReading{};
    seen.position = seen_.axis[axis].position;
    seen.referenced = seen_.axis[axis].referenced;
  }
  reading = seen;
  return HalFault::kNone;
}

HalFault SimPlant::read_path(PathReading& reading) noexcept {
  if (tick_ < 0) return HalFault::kNoReading;
  reading = seen_.path;
  return HalFault::kNone;
}

HalFault SimPlant::read_input(std::uint32_t input, InputMicro& value) noexcept {
  if (input >= inputs_) return HalFault::kNoDevice;
  if (tick_ < 0 || active_fault(PlantFaultKind::kSensorLost, input) != nullptr) return HalFault::kNoReading;
  value = seen_.input[input];
  return HalFault::kNone;
}

HalFault SimPlant::write_correction(std::uint32_t axis, AxisTravel correction) noexcept {
  if (axis >= axes_) return HalFault::kNoDevice;
  if (active_fault(PlantFaultKind::kWriteFailure, axis) != nullptr) return HalFault::kRefused;
  written_[axis] = correction;
  return HalFault::kNone;
}

}  // namespace vernier
