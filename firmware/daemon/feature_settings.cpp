// SPDX-License-Identifier: Apache-2.0
#include "firmware/daemon/feature_settings.h"

#include <cmath>

namespace vernier {
namespace {

constexpr double kMicro = 1e6, kMostResolution = 1000, kResolution = 1e-5;
constexpr std::int64_t kWindow = 1500, kMostEvery = 100'000, kBridged = 3;

std::uint32_t input_of(const BoardFile& file, const SignalSource& source, const char* setting) {
  const std::string& name = source.text(setting);
  for (std::uint32_t i = 0; i < file.inputs.size(); ++i) {
    if (file.inputs[i].name != name) continue;
    if (file.inputs[i].source.kind == "feature") source.fail(name + " is a feature itself");
    return i;
  }
  source.fail(std::string(setting) + ": the board has no input " + name);
}

FeatureRequest request_of(const BoardFile& file, std::uint32_t input) {
  const SignalSource& source = file.inputs[input].source;
  source.only({"of", "minus", "feature", "window", "resolution", "every", "missing_samples"});
  FeatureRequest request;
  request.input = input;
  request.of = input_of(file, source, "of");
  if (source.texts.contains("minus") || source.numbers.contains("minus"))
    request.minus = input_of(file, source, "minus");
  if (!feature_of(source.text("feature"), request.feature))
    source.fail("no feature " + source.text("feature"));
  request.window = static_cast<std::uint32_t>(source.whole("window", kWindow, 6, kMaxWindow));
  if (request.window % 2 != 0) source.fail("window must be even");
  request.every = static_cast<std::uint32_t>(source.whole("every", 1, 1, kMostEvery));
  request.bridged = static_cast<std::uint32_t>(source.whole("missing_samples", kBridged, 0, kMaxWindow));
  const double lsb = kMicro * source.number("resolution", kResolution);
  // Resolutions are decimal fractions, which a double only nearly holds.
  if (!(lsb >= 0.5 && lsb <= kMicro * kMostResolution) || std::abs(lsb - std::round(lsb)) > 1e-6)
    source.fail("resolution must be a whole number of millionths, 1e-6 to 1000");
  request.lsb = InputMicro(std::llround(lsb));
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
