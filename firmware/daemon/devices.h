// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "firmware/daemon/settings/board_file.h"
#include "hal/board.h"
#include "hal/command_link.h"

namespace vernier {

class WakeUp;

/// Result of `--check` for a device or a file.
struct DeviceFinding {
  std::string device;                    // "axis.X.output  pwm"
  std::string missing;                   // empty: it is there
  std::function<std::string()> attempt;  // tries it once more; the missing item, or empty
  bool is_file = false;                  // a file that is read; else a device
};

struct OpenLink {
  std::unique_ptr<CommandLink> device;
  LinkRights rights;
};

/// The devices that a board file names, alive as long as the board runs.
class Devices {
 public:
  /// Opens all devices; findings() lists the missing devices. file: outlives the devices. seed: of the motion
  /// of simulated axes. Throws BoardError if a setting is wrong. Not real-time safe.
  Devices(const BoardFile& file, unsigned long seed);
  ~Devices();
  Devices(const Devices&) = delete;
  Devices& operator=(const Devices&) = delete;

  /// Call only if no device is missing. Not real-time safe.
  Board board() noexcept;
  Clock& clock() noexcept;
  std::vector<OpenLink>& links() noexcept;
  /// Waits at most `wait` for a request over one of the links, or for a call of wake(). Not real-time safe.
  void wait_for_request(TimeUs wait, WakeUp& wake_up) noexcept;
  /// Returns one finding of each device and each file, in the order of the board file. Not real-time safe.
  std::vector<DeviceFinding>& findings() noexcept;
  /// Lists what opening and trying all devices does not test, one sentence each. Not real-time safe.
  std::vector<std::string> not_looked_at() const;

  /// Removes from the drives a correction that a killed daemon left, or the value with which a converter
  /// starts. The removal is before the first tick, within the limits of the axis, and takes at least a
  /// second. All outputs move together. Returns false if `stop` came and ten seconds later a value is still
  /// left. Not real-time safe.
  bool take_left_overs_out(const std::atomic<bool>& stop) noexcept;
  /// Opens the hardware watchdog if the board file names one. Returns the error text, or an empty text: then
  /// the caller must feed the watchdog, and disarm it at an orderly end. Not real-time safe.
  std::string start_watchdog();
  void feed_watchdog() noexcept;
  void disarm_watchdog() noexcept;

  /// Simulated axes begin to move. Not real-time safe.
  void release() noexcept;
  /// The next tick of simulated axes begins. Real-time safe.
  void advance() noexcept;
  /// Takes a sample of each sensor; each sample waits for its driver. Never call sample() in the tick.
  /// Not real-time safe.
  void sample() noexcept;
  bool has_sensors() const noexcept;
  /// Returns the contribution of each output to the error: step, range, and the delay if the board file gives
  /// a delay. Not real-time safe.
  std::vector<std::string> output_budget() const;
  /// Reports on standard error which outputs reached the end of their range.
  void say_held() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace vernier
