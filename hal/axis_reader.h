// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "comp/quantity.h"
#include "hal/fault.h"

namespace vernier {

/// State of one axis as its controller gives it: counts of the axis (1 nm, or 2^-32 turn), counts per s,
/// counts per s^2.
struct AxisReading {
  AxisPosition position;
  AxisSpeed velocity;
  AxisAcceleration acceleration;
  AxisTravel since{INT64_MAX};  // travel since the last reversal; a long way where unknown
  std::int8_t sense = 0;        // -1, 0, +1: direction of the last motion
  bool referenced = true;       // the controller knows where its zero is
  bool restarted = false;  // counts from another zero than the reading before: the difference is no travel
};

/// State of the path as its controller gives it.
struct PathReading {
  FeedNmPerMin feed;
  bool tells_feed = false;  // else the firmware takes the speed of the linear axes together
  CurvatureNanoPerMm curvature;
  VisitCount visit;
};

/// Positions of the machine's axes, in the order of the axes in the correction image.
class AxisReader {
 public:
  virtual ~AxisReader() = default;
  /// Begins a tick of the firmware. Readings that came in until now are the readings of this tick and do not
  /// change until the next call. begin_tick() never waits. Real-time safe.
  virtual void begin_tick() noexcept {}
  /// Newest reading of an axis. kNoReading: no reading since the last tick. Real-time safe.
  virtual HalFault read_axis(std::uint32_t axis, AxisReading& reading) noexcept = 0;
  /// Reads feed and curvature of the path, as far as the controller knows them. Real-time safe.
  virtual HalFault read_path(PathReading& reading) noexcept = 0;
  /// True if the controller itself gives velocity, acceleration, direction and since. If false, only the
  /// position is filled and the firmware derives the other values. Not real-time safe.
  virtual bool gives_motion() const noexcept = 0;
};

/// A device that gives positions only: the firmware derives the motion.
class PositionReader : public AxisReader {
 public:
  /// Sets feed and curvature to zero, because the device does not measure them. Real-time safe.
  HalFault read_path(PathReading& reading) noexcept override { return reading = {}, HalFault::kNone; }
  bool gives_motion() const noexcept override { return false; }
};

}  // namespace vernier
