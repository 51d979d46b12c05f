// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <compare>
#include <cstdint>

namespace vernier {

/// An integer with a unit. The unit of a quantity is part of its C++ type. The conversion of a quantity from
/// or to an integer is always explicit. The sum or difference of two quantities has the unit of the
/// quantities. The operators of Quantity do not saturate and do not check for overflow: the caller must
/// respect the ranges. Real-time safe.
template <class Unit, class Integer>
struct Quantity {
  using Count = Integer;
  Count count = 0;

  constexpr Quantity() = default;
  constexpr explicit Quantity(Count value) : count(value) {}
  constexpr auto operator<=>(const Quantity&) const = default;
  constexpr Quantity operator-() const { return Quantity(static_cast<Count>(-count)); }
  constexpr Quantity operator+(Quantity other) const {
    return Quantity(static_cast<Count>(count + other.count));
  }
  constexpr Quantity operator-(Quantity other) const {
    return Quantity(static_cast<Count>(count - other.count));
  }
};

namespace unit {
struct Nanometre;
struct Nanoradian;
struct NanometrePosition;
struct TurnFraction;
struct Millikelvin;
struct Microsecond;
struct InstantNanosecond;
struct AxisPositionCount;
struct AxisTravelCount;
struct AxisSpeedCount;
struct AxisAccelerationCount;
struct FeedNanometrePerMinute;
struct CurvatureNanoPerMillimetre;
struct InputMicro;
struct Visit;
struct WeightQ16;
}  // namespace unit

/// A length, ±2.1 m with a resolution of 1 nm.
using LengthNm = Quantity<unit::Nanometre, std::int32_t>;
/// An angle, ±2.1 rad with a resolution of 1 nrad.
using AngleNrad = Quantity<unit::Nanoradian, std::int32_t>;
/// Position of a linear axis. A position has 64 bits, because 20 m with a resolution of 1 nm do not fit 32
/// bits.
using PositionNm = Quantity<unit::NanometrePosition, std::int64_t>;
/// Position of a rotary axis in 2^-32 turn. Whole turns are in the bits above bit 31, so that a mask removes
/// them.
using TurnsQ32 = Quantity<unit::TurnFraction, std::int64_t>;
/// A temperature above absolute zero, or a temperature difference, in mK.
using TempMilliK = Quantity<unit::Millikelvin, std::int32_t>;
/// A time or a duration in us.
using TimeUs = Quantity<unit::Microsecond, std::int64_t>;
/// A time of a monotonic clock, or a duration, in ns. InstantNs has a finer resolution than TimeUs, because a
/// tick computes for about one microsecond and the edge of a probe has a time in nanoseconds.
using InstantNs = Quantity<unit::InstantNanosecond, std::int64_t>;

/// Motion of an axis in counts of the axis: 1 nm (linear) or 2^-32 turn (rotary); speeds per s, accelerations
/// per s^2.
using AxisPosition = Quantity<unit::AxisPositionCount, std::int64_t>;
using AxisTravel = Quantity<unit::AxisTravelCount, std::int64_t>;
using AxisSpeed = Quantity<unit::AxisSpeedCount, std::int64_t>;
using AxisAcceleration = Quantity<unit::AxisAccelerationCount, std::int64_t>;

/// Feed along the path, 1 nm/min.
using FeedNmPerMin = Quantity<unit::FeedNanometrePerMinute, std::int64_t>;
/// Curvature of the path, 1e-9 per mm.
using CurvatureNanoPerMm = Quantity<unit::CurvatureNanoPerMillimetre, std::int64_t>;
/// A measured input in 1e-6 of the unit that the machine file declares for the input (degC, V, N ...).
using InputMicro = Quantity<unit::InputMicro, std::int64_t>;
/// Number of rows (stops) since the start of the run.
using VisitCount = Quantity<unit::Visit, std::int64_t>;
/// A weight from 0 to 1, stored as 0 to 65536.
using WeightQ16 = Quantity<unit::WeightQ16, std::int32_t>;

constexpr WeightQ16 kFullWeight{65536};
/// Number of position counts in one turn of a rotary axis: one count is 2^-32 turn. The counts of an encoder
/// are a different unit.
constexpr std::int64_t kTurnCounts = std::int64_t{1} << 32;

/// Converts a temperature reading to the value of an input that is declared in degC. `absolute`: temperature
/// above absolute zero, mK.
constexpr InputMicro input_degC(TempMilliK absolute) {
  return InputMicro((std::int64_t{absolute.count} - 273150) * 1000);
}

}  // namespace vernier
