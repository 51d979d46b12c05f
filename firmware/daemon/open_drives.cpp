// SPDX-License-Identifier: Apache-2.0
// Part of the composition root: opens the CANopen drives that a board file names.
#include "firmware/daemon/open_drives.h"

#include <algorithm>
#include <charconv>
#include <cstdio>
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

struct Identifiers {
  std::uint32_t first, last;
  const char* use;
};
constexpr Identifiers kEmergencies = {0x081, 0x0ff, "emergency messages"};
/// CiA 301, restricted CAN identifiers: no PDO and no SYNC may have one of them.
constexpr Identifiers kRestricted[] = {{0x001, 0x07f, "a restricted use"}, {0x101, 0x180, "a restricted use"},
                                       {0x581, 0x5ff, "SDO answers"},      {0x601, 0x67f, "SDO requests"},
                                       {0x6e0, 0x6ff, "a restricted use"}, {0x701, 0x77f, "heartbeats"},
                                       {0x780, 0x7ff, "a restricted use"}};
/// The default identifiers of CiA 301 and CiA 402 that the drives or the controller send.
constexpr Identifiers kOfOthers[] = {kEmergencies,
                                     {0x181, 0x1ff, "TPDO 1 of the drives"},
                                     {0x281, 0x2ff, "TPDO 2 of the drives"},
                                     {0x381, 0x3ff, "TPDO 3 of the drives"},
                                     {0x481, 0x4ff, "TPDO 4 of the drives"},
                                     {0x201, 0x27f, "RPDO 1, the controller's controlword"}};

template <std::size_t kCount>
void refuse_use(const SignalSource& source, const char* name, std::uint32_t id,
                const Identifiers (&uses)[kCount]) {
  for (const Identifiers& one : uses)
    if (id >= one.first && id <= one.last) {
      char text[128];
      std::snprintf(text, sizeof text, "%s: 0x%03X belongs to %s (0x%03X to 0x%03X)", name, id, one.use,
                    one.first, one.last);
      source.fail_at(name, text);
    }
}

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
  refuse_use(source, "sync", settings.sync, kRestricted);
  refuse_use(source, "tpdo", settings.tpdo, kRestricted);
  refuse_use(source, "rpdo", settings.rpdo, kRestricted);
  refuse_use(source, "rpdo", settings.rpdo, kOfOthers);
  return settings;
}

/// The position offset of an axis of the drive, or an object of the manufacturer: every other object of
/// CiA 301 or CiA 402 has another meaning (0x607A is the target position, 0x6040 the controlword).
bool takes_an_offset(std::uint16_t index) {
  constexpr std::uint16_t kPositionOffset = 0x60b0, kPerAxis = 0x800, kAxes = 8;
  constexpr std::uint16_t kFirstOfMaker = 0x2000, kLastOfMaker = 0x5fff;
  if (index >= kFirstOfMaker && index <= kLastOfMaker) return true;
  return index >= kPositionOffset && (index - kPositionOffset) % kPerAxis == 0 &&
         (index - kPositionOffset) / kPerAxis < kAxes;
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
  if (!takes_an_offset(object.index))
    source.fail_at("object", "object: '" + text +
                                 "' is no position offset: give 0x60B0 (0x68B0 ... for a further axis of the "
                                 "drive), or an object of the drive's maker (0x2000 to 0x5FFF)");
  return object;
}

bool test_pdos(const SignalSource& source) {
  const std::string word = source.text("pdo_test", "sdo");
  if (word != "sdo" && word != "none")
    source.fail_at("pdo_test", "pdo_test: '" + word + "' is neither sdo nor none");
  return word == "sdo";
}

/// An output of kind "canopen", and the identifiers of its drive.
struct DriveUse {
  const SignalSource* source;
  CanopenSettings settings;
};

/// Refuses an identifier of another use of the bus that is one of these drives.
void refuse_identifiers_of(const std::vector<DriveUse>& drives, const SignalSource& source, const char* name,
                           bool with_tpdo) {
  const auto id = static_cast<std::uint32_t>(source.number(name, 0));
  for (const DriveUse& drive : drives) {
    const CanopenSettings& of = drive.settings;
    if (drive.source->text("interface") != source.text("interface")) continue;
    if (id == of.rpdo || id == of.sync || id == of.emergency || id == of.heartbeat ||
        (with_tpdo && id == of.tpdo))
      source.fail_at(name, std::string(name) + ": a frame of the drive of " + drive.source->where +
                               " has this identifier");
  }
}

void refuse_identifiers_of(const std::vector<DriveUse>& drives, const BoardFile& board) {
  for (const AxisEntry& axis : board.axes) {
    if (axis.position.kind == "can") refuse_identifiers_of(drives, axis.position, "id", true);
    if (axis.position.kind == "canopen" && axis.position.numbers.contains("tpdo"))
      refuse_identifiers_of(drives, axis.position, "tpdo", false);
  }
  for (const LinkEntry& link : board.links)
    for (const char* const name : {"receive", "transmit"})
      if (link.source.kind == "isotp") refuse_identifiers_of(drives, link.source, name, true);
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

OutputOpener canopen_output_of(const std::vector<OutputAxis>& axes) {
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
  return [place, settings, scale](std::string& error) {
    return CanopenOutput::open(place, settings, scale, error);
  };
}

void require_sync_of_drives(const BoardFile& board) {
  std::vector<DriveUse> used;
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
    for (const DriveUse& other : used)
      if (other.settings.rpdo == settings.rpdo && other.source->text("interface") == interface)
        source.fail("rpdo: the identifier is that of " + other.source->where + " too");
    used.push_back({&source, settings});
  }
  refuse_identifiers_of(used, board);
}

}  // namespace vernier
