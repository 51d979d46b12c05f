// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/workbench/image_diff.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <set>
#include <string>

#include "comp/compensator.h"
#include "tables/image_view.h"
#include "tools/text/error.h"
#include "tools/text/numbers.h"

namespace vernier::workbench {
namespace {

using Json = nlohmann::ordered_json;
constexpr std::uint32_t kPoses = 4096;

struct OpenImage {
  explicit OpenImage(const std::vector<std::uint8_t>& bytes, const char* which)
      : words(bytes.size() / 8 + 1) {
    std::memcpy(words.data(), bytes.data(), bytes.size());
    const ImageFault fault = view.open(reinterpret_cast<const std::uint8_t*>(words.data()),
                                       static_cast<std::uint32_t>(bytes.size()), workspace);
    if (fault != ImageFault::kNone) throw text::InputError(std::string(which) + ": " + describe(fault));
  }
  std::vector<std::uint64_t> words;
  ImageView view;
  ImageWorkspace workspace;
};

std::set<std::string> effects_of(const ImageView& image) {
  std::set<std::string> names;
  for (std::uint32_t i = 0; i < image.share_names().size; ++i) names.insert(image.share_names()[i].text);
  return names;
}

Json summary(const ImageView& image) {
  Json axes = Json::array(), inputs = Json::array();
  for (std::uint32_t i = 0; i < image.axes().size; ++i) axes.push_back(image.axes()[i].name);
  for (std::uint32_t i = 0; i < image.inputs().size; ++i) inputs.push_back(image.inputs()[i].name);
  const Equation& equation = image.program().equation;
  return {{"name", image.name()},
          {"fingerprint", text::fingerprint_text(image.header().fingerprint)},
          {"bytes", image.header().image_bytes},
          {"operations", equation.instructions.size},
          {"tables", equation.tables.size},
          {"lags", equation.lag_count},
          {"axes", axes},
          {"inputs", inputs},
          {"effects", effects_of(image)}};
}

/// Reason why the two cannot be run side by side; empty if they can.
std::string why_not(const ImageView& a, const ImageView& b) {
  if (a.axes().size != b.axes().size || a.inputs().size != b.inputs().size)
    return "the images are for machines with other axes or inputs";
  for (std::uint32_t i = 0; i < a.axes().size; ++i)
    if (std::strcmp(a.axes()[i].name, b.axes()[i].name) != 0 || a.axes()[i].flags != b.axes()[i].flags)
      return fmt::format(
          "axis {} of the first image differs from this axis of the second image in name or kind",
          a.axes()[i].name);
  for (std::uint32_t i = 0; i < a.inputs().size; ++i)
    if (std::strcmp(a.inputs()[i].name, b.inputs()[i].name) != 0)
      return fmt::format("input {} of the first image has another name in the second image",
                         a.inputs()[i].name);
  return {};
}

/// Point k of the additive recurrence with a different irrational for each dimension (Roberts 2018, R_d).
double spread(std::uint32_t k, std::uint32_t dimension) {
  static const double root = [] {
    double x = 2;
    for (int i = 0; i < 40; ++i) x = std::pow(1 + x, 1.0 / 15);  // of x^15 = x + 1
    return x;
  }();
  const double x = 0.5 + k * std::pow(root, -1.0 - dimension);
  return x - std::floor(x);
}

std::int64_t between(std::int64_t low, std::int64_t high, double share) {
  return low + static_cast<std::int64_t>(share * (static_cast<double>(high) - static_cast<double>(low)));
}

CycleInput pose(const ImageView& image, std::uint32_t k) {
  CycleInput input;
  const std::uint32_t axes = image.axes().size;
  for (std::uint32_t i = 0; i < axes; ++i) {
    const AxisRecord& axis = image.axes()[i];
    input.axis[i].position = AxisPosition(between(axis.low, axis.high, spread(k, i)));
    input.axis[i].sense = (k >> i & 1) != 0 ? 1 : -1;
  }
  for (std::uint32_t i = 0; i < image.inputs().size; ++i) {
    const InputRecord& record = image.inputs()[i];
    input.input[i] = InputMicro(between(record.low, record.high, spread(k, axes + i)));
  }
  return input;
}

/// Deviation of each axis at a pose, before limits, axis counts; lags have reached their final value.
std::vector<double> deviation(const ImageView& image, Compensator& compensator, const CycleInput& input) {
  compensator.reset();
  compensator.step(input);
  std::vector<double> list(image.axes().size, 0.0);
  const View<Output> outputs = image.program().outputs;
  for (std::uint32_t i = 0; i < outputs.size; ++i)
    list[outputs[i].axis] =
        std::ldexp(static_cast<double>(compensator.register_value(outputs[i].source)) * outputs[i].multiplier,
                   -static_cast<int>(outputs[i].shift));
  return list;
}

struct AxisDifference {
  double squares = 0, largest = 0;
  std::uint32_t at = 0;
};

Json corrections(const ImageView& a, const ImageView& b) {
  const auto run_a = std::make_unique<Compensator>(a.program()),
             run_b = std::make_unique<Compensator>(b.program());
  std::vector<AxisDifference> found(a.axes().size);
  for (std::uint32_t k = 0; k < kPoses; ++k) {
    const CycleInput input = pose(a, k);
    const auto of_a = deviation(a, *run_a, input), of_b = deviation(b, *run_b, input);
    for (std::size_t i = 0; i < found.size(); ++i) {
      const double difference = std::abs(of_a[i] - of_b[i]);
      found[i].squares += difference * difference;
      if (difference > found[i].largest) found[i] = {found[i].squares, difference, k};
    }
  }
  Json list = Json::array();
  for (std::uint32_t i = 0; i < a.axes().size; ++i) {
    const bool rotary = (a.axes()[i].flags & kRotary) != 0;
    const auto scale = [](bool turns) { return turns ? 360e3 / 4294967296.0 : 1e-3; };  // mdeg; um of nm
    Json at = Json::object();
    const CycleInput input = pose(a, found[i].at);
    for (std::uint32_t j = 0; j < a.axes().size; ++j)
      at[a.axes()[j].name] = static_cast<double>(input.axis[j].position.count) *
                             scale((a.axes()[j].flags & kRotary) != 0) * 1e-3;
    list.push_back({{"axis", a.axes()[i].name},
                    {"unit", rotary ? "mdeg" : "um"},
                    {"rms", scale(rotary) * std::sqrt(found[i].squares / kPoses)},
                    {"max", scale(rotary) * found[i].largest},
                    {"at", at}});
  }
  return list;
}

Json left_out(const std::set<std::string>& from, const std::set<std::string>& other) {
  Json list = Json::array();
  for (const std::string& name : from)
    if (!other.contains(name)) list.push_back(name);
  return list;
}

}  // namespace

Json image_diff(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b) {
  const auto open_a = std::make_unique<OpenImage>(a, "the first image"),
             open_b = std::make_unique<OpenImage>(b, "the second image");
  const ImageView &view_a = open_a->view, &view_b = open_b->view;
  Json json = {{"same", view_a.header().fingerprint == view_b.header().fingerprint},
               {"a", summary(view_a)},
               {"b", summary(view_b)},
               {"only_a", left_out(effects_of(view_a), effects_of(view_b))},
               {"only_b", left_out(effects_of(view_b), effects_of(view_a))},
               {"poses", kPoses}};
  const std::string why = why_not(view_a, view_b);
  if (why.empty())
    json["corrections"] = corrections(view_a, view_b);
  else
    json["why_not"] = why;
  return json;
}

}  // namespace vernier::workbench
