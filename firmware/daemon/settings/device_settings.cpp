// SPDX-License-Identifier: Apache-2.0
#include "firmware/daemon/settings/device_settings.h"

#include <cmath>

#include "firmware/daemon/settings/units.h"

namespace vernier {
namespace {

constexpr double kMostSpan = 1e4;  // mm or deg; beyond any correction, and within AnalogueScale

}  // namespace

bool is_inverted(const SignalSource& source) {
  const std::string polarity = source.text("polarity", "normal");
  if (polarity != "normal" && polarity != "inverted")
    source.fail("polarity: '" + polarity + "' is neither normal nor inverted");
  return polarity == "inverted";
}

AnalogueScale analogue_scale(const SignalSource& source, bool rotary, std::int64_t codes,
                             const char* suffix) {
  const std::string after(suffix);
  AnalogueScale scale;
  if (source.texts.contains("calibration") && !source.numbers.contains("span"))
    source.fail(source.text("calibration") + " does not exist; make it with vernierd --calibrate");
  const double span = source.number("span");
  if (!(span > 0 && span <= kMostSpan)) source.fail("span must be above 0 and at most 10000");
  scale.span = std::llround(span * (rotary ? kCountsPerDeg : kNmPerMm));
  scale.codes = codes;
  scale.low = source.whole("low" + after, 0, 0, codes);
  scale.high = source.whole("high" + after, codes, 0, codes);
  scale.zero = source.whole("zero" + after, codes / 2, 0, codes);
  scale.inverted = is_inverted(source);
  if (scale.span < 1) source.fail("span is less than one count of the axis");
  if (!scale.valid())
    source.fail("low" + after + ", zero" + after + ", high" + after + " must be in this order");
  return scale;
}

AnalogueScale number_scale(const SignalSource& source, bool rotary) {
  constexpr std::int64_t kZero = 1 << 30, kCodes = 1'000'000;
  const double unit = rotary ? kCountsPerDeg : kNmPerMm;
  const double resolution = source.number("resolution"), range = source.number("range");
  AnalogueScale scale;
  if (!(resolution > 0 && resolution <= 1)) source.fail("resolution must be above 0, and at most 1");
  if (!(range >= resolution && range / resolution < static_cast<double>(kZero)))
    source.fail("range must be at least resolution, and below 2^30 times resolution");
  scale.codes = kCodes;
  scale.span = std::llround(resolution * unit * static_cast<double>(kCodes));
  scale.zero = kZero;
  const auto most = static_cast<std::int64_t>(range / resolution * (1 + 1e-12));
  scale.low = kZero - most, scale.high = kZero + most;
  scale.inverted = is_inverted(source);
  if (!scale.valid()) source.fail("resolution is too small");
  return scale;
}

PositionScale position_scale(const SignalSource& source, bool rotary) {
  constexpr std::int64_t kCounts = 1'000'000;
  constexpr double kMostScale_um = 1000, kMostOffset = 1e6;
  const double unit = rotary ? kCountsPerDeg : kNmPerMm;
  const double scale_um = source.number("scale"), offset = source.number("offset", 0);
  PositionScale scale;
  scale.counts = kCounts;
  scale.inverted = scale_um < 0;
  if (!(std::abs(scale_um) <= kMostScale_um))
    source.fail_at("scale", "scale must be between -1000 and 1000 um per count");
  scale.span = std::llround(std::abs(scale_um) * kMmPerUm * unit * static_cast<double>(kCounts));
  if (scale.span < 1) source.fail_at("scale", "scale must not be zero");
  if (!(std::abs(offset) <= kMostOffset)) source.fail_at("offset", "offset must be between -1e6 and 1e6");
  scale.offset = std::llround(offset * unit);
  return scale;
}

}  // namespace vernier
