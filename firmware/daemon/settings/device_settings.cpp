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

}  // namespace vernier
