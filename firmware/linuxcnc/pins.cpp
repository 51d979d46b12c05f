// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware/linuxcnc/pins.h"

#include <limits>

namespace vernier {
namespace {

// Sums the refusals up: one that fails makes the others vain.
class Exporter {
 public:
  explicit Exporter(int component) noexcept : component_(component) {}
  bool good() const noexcept { return good_; }

  void pin(hal_float_t** at, hal_pin_dir_t direction, double value, const char* name) noexcept {
    if (take(hal_pin_float_newf(direction, at, component_, "vernier.0.%s", name))) **at = value;
  }
  void pin(hal_bit_t** at, hal_pin_dir_t direction, bool value, const char* name) noexcept {
    if (take(hal_pin_bit_newf(direction, at, component_, "vernier.0.%s", name))) **at = value;
  }
  void pin(hal_s32_t** at, hal_pin_dir_t direction, const char* name) noexcept {
    if (take(hal_pin_s32_newf(direction, at, component_, "vernier.0.%s", name))) **at = 0;
  }
  void pin(hal_u32_t** at, hal_pin_dir_t direction, const char* name) noexcept {
    if (take(hal_pin_u32_newf(direction, at, component_, "vernier.0.%s", name))) **at = 0;
  }
  void joint(hal_float_t** at, hal_pin_dir_t direction, double value, unsigned n, const char* name) noexcept {
    if (take(hal_pin_float_newf(direction, at, component_, "vernier.0.joint.%u.%s", n, name))) **at = value;
  }
  void joint(hal_bit_t** at, hal_pin_dir_t direction, bool value, unsigned n, const char* name) noexcept {
    if (take(hal_pin_bit_newf(direction, at, component_, "vernier.0.joint.%u.%s", n, name))) **at = value;
  }
  void input(hal_float_t** at, const char* name) noexcept {
    if (take(hal_pin_float_newf(HAL_IN, at, component_, "vernier.0.input.%s", name)))
      **at = std::numeric_limits<double>::quiet_NaN();
  }

 private:
  bool take(int result) noexcept {
    good_ = good_ && result == 0;
    return result == 0;
  }
  int component_;
  bool good_ = true;
};

void make_joint(Exporter& pins, JointPins& joint, unsigned n) noexcept {
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  constexpr double kNoLimit = 1e99;  // as LinuxCNC's own
  pins.joint(&joint.cmd_in, HAL_IN, 0, n, "cmd-in");
  pins.joint(&joint.cmd_out, HAL_OUT, 0, n, "cmd-out");
  pins.joint(&joint.fb_in, HAL_IN, kUnknown, n, "fb-in");
  pins.joint(&joint.fb_out, HAL_OUT, 0, n, "fb-out");
  pins.joint(&joint.correction, HAL_OUT, 0, n, "correction");
  pins.joint(&joint.pos_in, HAL_IN, kUnknown, n, "pos-in");
  joint.fb_loose = joint.fb_in, joint.pos_loose = joint.pos_in;
  pins.joint(&joint.min_limit, HAL_IN, -kNoLimit, n, "min-limit");
  pins.joint(&joint.max_limit, HAL_IN, kNoLimit, n, "max-limit");
  pins.joint(&joint.max_velocity, HAL_IN, 0, n, "max-velocity");
  pins.joint(&joint.homed, HAL_IN, true, n, "homed");
  pins.joint(&joint.at_limit, HAL_OUT, false, n, "at-limit");
  pins.joint(&joint.saturated, HAL_OUT, false, n, "saturated");
}

}  // namespace

Pins* make_pins(int component, const Wiring& wiring) noexcept {
  auto* const pins = static_cast<Pins*>(hal_malloc(sizeof(Pins)));
  if (pins == nullptr) return nullptr;
  Exporter exporter(component);
  for (unsigned n = 0; n < wiring.axes.size(); ++n) make_joint(exporter, pins->joint[n], n);
  for (unsigned i = 0; i < wiring.inputs.size(); ++i)
    exporter.input(&pins->input[i], wiring.inputs[i].c_str());
  exporter.pin(&pins->enable, HAL_IN, false, "enable");
  exporter.pin(&pins->hold, HAL_IN, false, "hold");
  exporter.pin(&pins->clear, HAL_IN, false, "clear");
  exporter.pin(&pins->probe_in, HAL_IN, false, "probe-in");
  exporter.pin(&pins->weight, HAL_IN, 1, "weight");
  exporter.pin(&pins->current_vel, HAL_IN, 0, "current-vel");
  exporter.pin(&pins->probe_delay, HAL_IN, 0, "probe-delay");
  exporter.pin(&pins->limit_mode, HAL_IN, "limit-mode");
  exporter.pin(&pins->active, HAL_OUT, false, "active");
  exporter.pin(&pins->fault, HAL_OUT, false, "fault");
  exporter.pin(&pins->saturated, HAL_OUT, false, "saturated");
  exporter.pin(&pins->at_limit, HAL_OUT, false, "at-limit");
  exporter.pin(&pins->abort, HAL_OUT, false, "abort");
  exporter.pin(&pins->mode, HAL_OUT, "mode");
  exporter.pin(&pins->fault_code, HAL_OUT, "fault-code");
  exporter.pin(&pins->execution, HAL_OUT, "execution");
  exporter.pin(&pins->execution_max, HAL_OUT, "execution-max");
  return exporter.good() ? pins : nullptr;
}

}  // namespace vernier
