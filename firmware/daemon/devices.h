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

/// Result of the option `--check` for one device or one file.
struct DeviceFinding {
  std::string device;                    // name of the device: "axis.X.output  pwm"
  std::string missing;                   // description of the missing item; empty if the device is present
  std::function<std::string()> attempt;  // function that tests the device again and returns the missing item,
                                         // or an empty text
  bool is_file = false;                  // true: a file that is read; false: a device
};

struct OpenLink {
  std::unique_ptr<CommandLink> device;
  LinkRights rights;
};

/// The devices that a board file names. The devices exist as long as the board runs.
class Devices {
 public:
  /// Opens all devices. The function findings() lists the missing devices. `file`: must exist longer than the
  /// devices. `seed`: start value of the random motion of simulated axes. Throws BoardError if a setting in
  /// the board file is wrong. Not real-time safe.
  Devices(const BoardFile& file, unsigned long seed);
  ~Devices();
  Devices(const Devices&) = delete;
  Devices& operator=(const Devices&) = delete;

  /// Returns the ports of the board. Call board() only if no device is missing. Not real-time safe.
  Board board() noexcept;
  Clock& clock() noexcept;
  std::vector<OpenLink>& links() noexcept;
  /// Waits for a request over one of the links, or for a call of `wake_up`, for at most `wait`. Not real-time
  /// safe.
  void wait_for_request(TimeUs wait, WakeUp& wake_up) noexcept;
  /// Returns the results of `--check`: one finding for each device and each file, in the order of the board
  /// file. Not real-time safe.
  std::vector<DeviceFinding>& findings() noexcept;
  /// Lists what is not tested when all devices are opened and tested, one sentence each. Not real-time safe.
  std::vector<std::string> not_looked_at() const;

  /// Removes corrections that are in the drives before the start: the correction of a program that was
  /// killed, or the start value of a converter. The corrections are removed before the first tick, within the
  /// limits of the axis; this takes at least one second. All outputs are moved at the same time. Returns
  /// false if `stop` is set and a correction still remains ten seconds later. Not real-time safe.
  bool take_left_overs_out(const std::atomic<bool>& stop) noexcept;
  /// Opens the hardware watchdog if the board file names a watchdog. Returns an error text, or an empty text
  /// if there is no error. If there is no error, the caller must trigger the watchdog, and switch
  /// the watchdog off at an orderly end. Not real-time safe.
  std::string start_watchdog();
  void feed_watchdog() noexcept;
  void disarm_watchdog() noexcept;

  /// Starts the motion of simulated axes. Not real-time safe.
  void release() noexcept;
  /// Begins the next tick of simulated axes. Real-time safe.
  void advance() noexcept;
  /// Takes one sample of each sensor. For each sample the function waits for the driver of the sensor. Do not
  /// call sample() in the tick. Not real-time safe.
  void sample() noexcept;
  bool has_sensors() const noexcept;
  /// Returns the contribution of each output to the error of the correction: step, range, and the delay if
  /// the board file states it. Not real-time safe.
  std::vector<std::string> output_budget() const;
  /// Writes a message to standard error about the outputs that reached the end of their range.
  void say_held() const;
  /// Returns false while a drive has not used the newest correction of its axis. Real-time safe.
  bool corrections_have_arrived() const noexcept;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace vernier
