// SPDX-License-Identifier: Apache-2.0
#include "firmware/daemon/settings/feature_settings.h"

#include <cmath>

#include "firmware/daemon/settings/units.h"

namespace vernier {
namespace {

constexpr double kMostResolution = 1000, kResolution = 1e-5;
constexpr const char* kDisplacement = "DISPLACEMENT";
constexpr std::int64_t kWindow = 1500, kMostEvery = 100'000, kBridged = 3;

std::uint32_t input_of(const BoardFile& file, const SignalSource& source, const char* setting) {
  const std::string& name = source.text(setting);
  for (std::uint32_t i = 0; i < file.inputs.size(); ++i) {
    if (file.inputs[i].name != name) continue;
    if (file.inputs[i].source.kind == "feature") source.fail(name + " is a feature itself");
    return i;
  }
  source.fail(std::string(setting) + ": the board file has no input " + name);
}

/// Resolution of a sample, millionths of its signal's unit. Resolutions are decimal fractions, which a double
/// only nearly holds.
InputMicro resolution_of(const SignalSource& source) {
  const double lsb = kMicro * source.number("resolution", kResolution);
  if (!(lsb >= 0.5 && lsb <= kMicro * kMostResolution) || std::abs(lsb - std::round(lsb)) > 1e-6)
    source.fail("resolution must be a whole number of millionths, 1e-6 to 1000");
  return InputMicro(std::llround(lsb));
}

/// nm/s^2 in a millionth of the unit of an accelerometer.
double nm_s2_in_a_millionth(const InputEntry& input, const SignalSource& source) {
  if (input.unit == "g") return 9806.65;  // standard gravity, ISO 80000-3
  if (input.unit == "m/s^2") return 1000;
  if (input.unit == "mm/s^2") return 1;
  source.fail(input.name + " is in \"" + input.unit +
              "\": a displacement needs an acceleration in g, m/s^2 or mm/s^2");
}

/// The settings of feature = "DISPLACEMENT". What only the rate decides is refused where windows are.
void add_displacement(const BoardFile& file, const InputEntry& input, FeatureRequest& request) {
  const SignalSource& source = input.source;
  source.only({"of", "minus", "feature", "corner_Hz", "resolution", "every", "missing_samples"});
  if (input.unit != "um") source.fail("a displacement is in um: unit = \"um\"");
  const double millionth_nm_s2 = nm_s2_in_a_millionth(file.inputs[request.of], source);
  if (request.minus != kNoInput && file.inputs[request.minus].unit != file.inputs[request.of].unit)
    source.fail("the inputs `of` and `minus` must have the same unit");
  request.lsb_nm_s2 = std::llround(static_cast<double>(request.lsb.count) * millionth_nm_s2);
  const double corner_mHz = 1000 * source.number("corner_Hz", 0);
  if (!(corner_mHz >= 1 && corner_mHz <= 1e6)) source.fail("corner_Hz must be between 0.001 and 1000");
  request.corner_mHz = std::llround(corner_mHz);
}

FeatureRequest request_of(const BoardFile& file, std::uint32_t input) {
  const SignalSource& source = file.inputs[input].source;
  FeatureRequest request;
  request.input = input;
  request.of = input_of(file, source, "of");
  if (source.texts.contains("minus") || source.numbers.contains("minus"))
    request.minus = input_of(file, source, "minus");
  request.every = static_cast<std::uint32_t>(source.whole("every", 1, 1, kMostEvery));
  request.bridged = static_cast<std::uint32_t>(source.whole("missing_samples", kBridged, 0, kMaxWindow));
  request.lsb = resolution_of(source);
  if (source.text("feature") == kDisplacement) {
    add_displacement(file, file.inputs[input], request);
    return request;
  }
  source.only({"of", "minus", "feature", "window", "resolution", "every", "missing_samples"});
  if (!feature_of(source.text("feature"), request.feature))
    source.fail("no feature " + source.text("feature"));
  request.window = static_cast<std::uint32_t>(source.whole("window", kWindow, 6, kMaxWindow));
  if (request.window % 2 != 0) source.fail("window must be even");
  return request;
}

}  // namespace

std::vector<FeatureRequest> feature_requests(const BoardFile& file) {
  std::vector<FeatureRequest> requests;
  for (std::uint32_t i = 0; i < file.inputs.size(); ++i)
    if (file.inputs[i].source.kind == "feature") requests.push_back(request_of(file, i));
  return requests;
}

}  // namespace vernier
