// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>

#include "hal/correction_writer.h"
#include "hal/support/analogue_scale.h"

namespace vernier {

/// An output with codes: a converter, a pulse width, or registers of a controller. `axis` is the device's own
/// number of an axis, from 0. Setting up moves no axis.
class OutputDevice : public CorrectionWriter {
 public:
  /// Takes the device for exclusive use; false if another process, or another output, uses it.
  /// Not real-time safe.
  virtual bool lock() noexcept = 0;
  /// Reads the correction that the device has now, and that the daemon must remove. kNoReading: the device
  /// does not report it. Not real-time safe.
  virtual HalFault read_back(std::uint32_t axis, AxisTravel& correction) noexcept = 0;
  /// Tests the device without a motion; returns the error, or an empty text. Not real-time safe.
  virtual std::string attempt(std::uint32_t axis) = 0;
  /// Returns what open() and attempt() did to the device: "only the value that it has was written again".
  virtual std::string trial() const = 0;
  /// Returns the number of writes whose correction was beyond the range.
  virtual std::uint64_t held_at_end(std::uint32_t axis) const noexcept = 0;
  virtual const AnalogueScale& scale(std::uint32_t axis) const noexcept = 0;
  /// Returns the line of statistics that the daemon prints for the device at its end; an empty text: no line.
  /// Not real-time safe.
  virtual std::string account() const { return {}; }
};

}  // namespace vernier
