// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "comp/quantity.h"
#include "hal/fault.h"

namespace vernier {

/// State of one axis as its controller gives it. The units are counts of the axis (1 nm, or 2^-32 turn),
/// counts per s, and counts per s^2.
struct AxisReading {
  AxisPosition position;
  AxisSpeed velocity;
  AxisAcceleration acceleration;
  AxisTravel since{INT64_MAX};  // travel since the last reversal; a very large value if it is unknown
  std::int8_t sense = 0;        // direction of the last motion: -1, 0, +1
  bool referenced = true;       // true: the controller knows the reference position of the axis
  bool restarted = false;  // true: the counts refer to another zero than in the previous reading, so that the
                           // difference is no travel
};

/// State of the path (feed, curvature) as its controller gives it.
struct PathReading {
  FeedNmPerMin feed;
  bool tells_feed = false;  // false: the firmware computes the feed from the speeds of the linear axes
  CurvatureNanoPerMm curvature;
  VisitCount visit;
};

/// Reads the positions of the machine's axes, in the order of the axes in the correction image.
class AxisReader {
 public:
  virtual ~AxisReader() = default;
  /// Begins a tick of the firmware. Readings that came before this call are the readings of the tick. The
  /// readings of a tick do not change until the next call of the function. The function begin_tick() never
  /// waits. Real-time safe.
  virtual void begin_tick() noexcept {}
  /// Returns the newest reading of an axis. The function read_axis() returns kNoReading if there is no
  /// reading since the last tick. Real-time safe.
  virtual HalFault read_axis(std::uint32_t axis, AxisReading& reading) noexcept = 0;
  /// Reads feed and curvature of the path, if the controller knows them. Real-time safe.
  virtual HalFault read_path(PathReading& reading) noexcept = 0;
  /// True if the controller itself gives velocity, acceleration, direction, and travel since the reversal
  /// (`since`). If gives_motion() is false, only the position is set, and the firmware computes the other
  /// values. Not real-time safe.
  virtual bool gives_motion() const noexcept = 0;
};

/// A device that gives only positions of axes. The firmware computes the motion from the positions.
class PositionReader : public AxisReader {
 public:
  /// Sets feed and curvature to zero, because the device does not measure them. Real-time safe.
  HalFault read_path(PathReading& reading) noexcept override { return reading = {}, HalFault::kNone; }
  bool gives_motion() const noexcept override { return false; }
};

}  // namespace vernier
