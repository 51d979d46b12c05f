// SPDX-License-Identifier: Apache-2.0
// Part of the composition root: opens the CANopen drives that a board file names.
#include "firmware/daemon/open_drives.h"

#include <algorithm>
#include <charconv>
#include <string>

#include "firmware/daemon/settings/device_settings.h"
#include "firmware/daemon/settings/units.h"
#include "hal/linux/can/canopen_axes.h"
#include "hal/linux/can/canopen_output.h"

namespace vernier {
namespace {

// Predefined connection set of CiA 301, and the default use of PDOs in CiA 402: the third TPDO has statusword
// and position actual value; the fourth RPDO has no default use in the position modes.
constexpr std::uint32_t kSync = 0x80, kEmergency = 0x80, kHeartbeat = 0x700, kTpdo3 = 0x380, kRpdo4 = 0x500;
constexpr std::int64_t kLastId = 0x7ff, kLastNode = 127, kNsPerMs = 1'000'000;

CanopenSettings settings_of(const SignalSource& source) {
  const auto node = static_cast<std::uint32_t>(source.whole("node", 1, kLastNode));
  const auto id = [&](const char* name, std::uint32_t otherwise) {
    return static_cast<std::uint32_t>(source.whole(name, otherwise, 1, kLastId));
  };
  CanopenSettings settings;
  settings.sync = id("sync", kSync);
  settings.emergency = kEmergency + node;
  settings.heartbeat = kHeartbeat + node;
  settings.tpdo = id("tpdo", kTpdo3 + node);
  settings.rpdo = id("rpdo", kRpdo4 + node);
  settings.sync_timeout = InstantNs(kNsPerMs * source.whole("timeout_ms", 20, 2, 1000));
  settings.heartbeat_time = InstantNs(kNsPerMs * source.whole("heartbeat_ms", 200, 10, 10'000));
  const std::uint32_t all[] = {settings.sync, settings.emergency, settings.heartbeat, settings.tpdo,
                               settings.rpdo};
  for (const std::uint32_t* a = std::begin(all); a != std::end(all); ++a)
    if (std::find(a + 1, std::end(all), *a) != std::end(all))
      source.fail("two frames of the drive have one identifier");
  return settings;
}

/// "0x60B0" or "0x60B0:00".
CanopenObject object_of(const SignalSource& source) {
  const std::string text = source.text("object", "0x60B0");
  CanopenObject object;
  const auto read = [](std::string_view digits, auto& value) {
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value, 16);
    return error == std::errc{} && end == digits.data() + digits.size();
  };
  const auto colon = text.find(':');
  const bool whole =
      text.starts_with("0x") && read(std::string_view(text).substr(2, colon - 2), object.index) &&
      (colon == std::string::npos || read(std::string_view(text).substr(colon + 1), object.subindex));
  if (!whole || object.index < 0x1000)
    source.fail_at("object", "object: '" + text + "' is no object, for example \"0x60B0\" or \"0x2010:03\"");
  return object;
}

bool test_pdos(const SignalSource& source) {
  const std::string word = source.text("pdo_test", "sdo");
  if (word != "sdo" && word != "none")
    source.fail_at("pdo_test", "pdo_test: '" + word + "' is neither sdo nor none");
  return word == "sdo";
}

}  // namespace

std::unique_ptr<CanopenAxes> open_canopen_axes(const std::vector<PositionAxis>& axes, std::string& error) {
  std::vector<CanopenAxes::Axis> drives;
  for (const PositionAxis& axis : axes) {
    axis.source->only({"interface", "node", "tpdo", "scale", "offset"});
    drives.push_back({settings_of(*axis.source), position_scale(*axis.source, axis.rotary)});
    for (std::size_t k = 0; k + 1 < drives.size(); ++k)
      if (drives[k].settings.tpdo == drives.back().settings.tpdo)
        axis.source->fail("another axis has the TPDO of this drive");
  }
  return CanopenAxes::open(axes.front().source->text("interface"), drives, error);
}

std::unique_ptr<OutputDevice> open_canopen_output(const std::vector<OutputAxis>& axes, std::string& error) {
  const OutputAxis& axis = axes.front();
  SignalSource numbers = *axis.source;
  const double scale_um = numbers.number("scale");
  if (!(scale_um > 0 && scale_um <= 1e3))
    numbers.fail_at("scale", "scale must be above 0 and at most 1000 um of a count; see polarity");
  numbers.numbers["resolution"] = scale_um * kMmPerUm;
  const AnalogueScale scale = number_scale(numbers, axis.rotary);
  CanopenSettings settings = settings_of(*axis.source);
  // One more, because both ends of a change are rounded.
  const std::int64_t most = std::min<std::int64_t>(axis.most_per_tick, INT32_MAX);
  settings.most_per_sync = RoundedRatio(scale.codes, scale.span).of(most) + 1;
  const CanopenPlace place{axis.source->text("interface"),
                           static_cast<std::uint32_t>(axis.source->whole("node", 1, kLastNode)),
                           object_of(*axis.source), test_pdos(*axis.source)};
  return CanopenOutput::open(place, settings, scale, error);
}

void require_sync_of_drives(const BoardFile& board) {
  struct Used {
    const SignalSource* source;
    std::uint32_t rpdo;
  };
  std::vector<Used> used;
  for (const AxisEntry& axis : board.axes) {
    const SignalSource& source = axis.output;
    if (source.kind != "canopen") continue;
    const CanopenSettings settings = settings_of(source);
    const std::string& interface = source.text("interface");
    const std::int64_t tick_us = board.service.upload.tick.count;
    if (source.whole("sync_us", 100, 100'000) != tick_us)
      source.fail_at("sync_us", "sync_us must be tick_us (" + std::to_string(tick_us) +
                                    "): the drive takes one offset with each SYNC");
    if (board.sync.kind != "can" || board.sync.text("interface") != interface ||
        board.sync.whole("id", kSync, 0, (1 << 29) - 1) != settings.sync)
      source.fail("the ticks do not follow SYNC; add sync = { kind = \"can\", interface = \"" + interface +
                  "\" } to [board]");
    for (const Used& other : used)
      if (other.rpdo == settings.rpdo && other.source->text("interface") == interface)
        source.fail("rpdo: the identifier is that of " + other.source->where + " too");
    used.push_back({&source, settings.rpdo});
  }
}

}  // namespace vernier
