// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>

#include "hal/correction_writer.h"
#include "hal/support/analogue_scale.h"

namespace vernier {

/// An output device that works with codes: a D/A converter, a pulse width, or registers of a controller.
/// `axis`: number of an axis in the device, from 0. Opening an output device moves no axis.
class OutputDevice : public CorrectionWriter {
 public:
  /// Reserves the device for exclusive use. Returns false if another process or another output uses the
  /// device. Not real-time safe.
  virtual bool lock() noexcept = 0;
  /// Reads the correction that the device has at present and that the daemon must remove. The function
  /// read_back() returns kNoReading if the device does not report its value. Not real-time safe.
  virtual HalFault read_back(std::uint32_t axis, AxisTravel& correction) noexcept = 0;
  /// Tests the device without a motion of the axis. Returns the error, or an empty text. Not real-time safe.
  virtual std::string attempt(std::uint32_t axis) = 0;
  /// Returns a text that describes what open() and attempt() did to the device: "only the value that it has
  /// was written again".
  virtual std::string trial() const = 0;
  /// Returns the number of writes whose correction was beyond the range of the device.
  virtual std::uint64_t held_at_end(std::uint32_t axis) const noexcept = 0;
  /// Returns false while the newest correction is on its way to a drive that has not used it yet. Real-time
  /// safe.
  virtual bool has_arrived(std::uint32_t axis) const noexcept {
    (void)axis;
    return true;
  }
  virtual const AnalogueScale& scale(std::uint32_t axis) const noexcept = 0;
  /// Returns a line of statistics, which the daemon prints for the device at its end; an empty text: no line
  /// is printed. Not real-time safe.
  virtual std::string account() const { return {}; }
};

}  // namespace vernier
