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
  /// Opens all devices; missing ones are listed in findings(). file: outlives the devices. seed: of the
  /// motion of simulated axes. Throws BoardError if a setting is wrong. setup.
  Devices(const BoardFile& file, unsigned long seed);
  ~Devices();
  Devices(const Devices&) = delete;
  Devices& operator=(const Devices&) = delete;

  /// Call only if no device is missing. setup.
  Board board() noexcept;
  Clock& clock() noexcept;
  std::vector<OpenLink>& links() noexcept;
  /// Waits until a request comes over one of the links or wake() is called, at most `wait`. setup.
  void wait_for_request(TimeUs wait, WakeUp& wake_up) noexcept;
  /// One of each device and each file, in the order of the board file. setup.
  std::vector<DeviceFinding>& findings() noexcept;
  /// Items that opening and trying all devices does not test, one sentence each. setup.
  std::vector<std::string> not_looked_at() const;

  /// A correction that a killed daemon left in a drive, or the value that a converter wakes up with, is taken
  /// out before the first tick: within the limits of the axis, and over a second at least. stop: ends it
  /// early. setup.
  void take_left_overs_out(const std::atomic<bool>& stop) noexcept;
  /// Opens the hardware watchdog if the board file names one. Returns the error, or empty; then the caller
  /// must feed it, and disarm it at an orderly end. setup.
  std::string start_watchdog();
  void feed_watchdog() noexcept;
  void disarm_watchdog() noexcept;

  /// Simulated axes begin to move. setup.
  void release() noexcept;
  /// The next tick of simulated axes begins. realtime.
  void advance() noexcept;
  /// Takes a sample of each sensor, which waits for its driver. Not in the tick. setup.
  void sample() noexcept;
  bool has_sensors() const noexcept;
  /// Contribution of each output to the error: its step and range, and its delay if the file gives one.
  /// setup.
  std::vector<std::string> output_budget() const;
  /// Reports on standard error which outputs were limited to the end of their range.
  void say_held() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace vernier
