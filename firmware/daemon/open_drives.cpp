// SPDX-License-Identifier: Apache-2.0
// Part of the composition root: opens the CANopen drives that a board file names.
#include "firmware/daemon/open_drives.h"

#include <algorithm>
#include <charconv>
#include <cmath>
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
constexpr std::uint32_t kSync = 0x80, kEmergency = 0x80, kHeartbeat = 0x700, kTpdo3 = 0x380;
constexpr std::int64_t kLastId = 0x7ff, kLastNode = 127, kNsPerMs = 1'000'000;

struct Identifiers {
  std::uint32_t first, last;
  const char* use;
};
constexpr Identifiers kEmergencies = {0x081, 0x0ff, "emergency messages"};
constexpr Identifiers kTime = {0x100, 0x100, "TIME"};
constexpr std::uint32_t kNmt = 0x000, kNodeMask = 0x7f, kStandardIds = 0x7ff;
/// Default identifiers of the further RPDOs of CiA 402. The second and the third have a controlword.
constexpr Identifiers kRpdo2 = {0x301, 0x37f, "RPDO 2 of the drives"};
constexpr Identifiers kRpdo3 = {0x401, 0x47f, "RPDO 3 of the drives"};
constexpr Identifiers kRpdo4 = {0x501, 0x57f, "RPDO 4 of the drives"};
/// CiA 301, restricted CAN identifiers: no PDO and no SYNC may have one of them.
constexpr Identifiers kRestricted[] = {{0x001, 0x07f, "a restricted use"}, {0x101, 0x180, "a restricted use"},
                                       {0x581, 0x5ff, "SDO answers"},      {0x601, 0x67f, "SDO requests"},
                                       {0x6e0, 0x6ff, "a restricted use"}, {0x701, 0x77f, "heartbeats"},
                                       {0x780, 0x7ff, "a restricted use"}};
constexpr Identifiers kControlword = {0x201, 0x27f, "RPDO 1, the controller's controlword"};
/// No drive sends its statusword and position with one of them.
constexpr Identifiers kNoTpdo[] = {kEmergencies, kTime, kControlword};
/// The default identifiers of CiA 301 and CiA 402 that the drives or the controller send.
constexpr Identifiers kOfOthers[] = {kEmergencies,
                                     kTime,
                                     {0x181, 0x1ff, "TPDO 1 of the drives"},
                                     {0x281, 0x2ff, "TPDO 2 of the drives"},
                                     {0x381, 0x3ff, "TPDO 3 of the drives"},
                                     {0x481, 0x4ff, "TPDO 4 of the drives"},
                                     kControlword};

bool is_among(const Identifiers& use, std::uint32_t id) { return id >= use.first && id <= use.last; }

template <std::size_t kCount>
void refuse_use(const SignalSource& source, const char* name, std::uint32_t id,
                const Identifiers (&uses)[kCount]) {
  for (const Identifiers& one : uses)
    if (is_among(one, id)) {
      char text[128];
      std::snprintf(text, sizeof text, "%s: 0x%03X belongs to %s (0x%03X to 0x%03X)", name, id, one.use,
                    one.first, one.last);
      source.fail_at(name, text);
    }
}

/// The further RPDOs of this drive may have the offset, if the drive's mapping says so; those of another
/// drive never.
void refuse_further_rpdos(const SignalSource& source, std::uint32_t rpdo, std::uint32_t node) {
  for (const Identifiers& use : {kRpdo2, kRpdo3, kRpdo4}) {
    if (!is_among(use, rpdo)) continue;
    if ((rpdo & kNodeMask) != node)
      source.fail_at("rpdo", std::string("rpdo: the identifier belongs to ") + use.use + ", node " +
                                 std::to_string(rpdo & kNodeMask));
    if (use.first != kRpdo4.first && source.text("pdo_test", "sdo") == "none")
      source.fail_at("rpdo", std::string("rpdo: with pdo_test = \"none\" the board does not read the mapping "
                                         "of this RPDO: use pdo_test = \"sdo\", or RPDO 4 (by default ") +
                                 use.use + " have a controlword)");
  }
}

void refuse_equal_identifiers(const SignalSource& source, const CanopenSettings& settings) {
  const std::pair<const char*, std::uint32_t> all[] = {{"sync", settings.sync},
                                                       {"the emergency message", settings.emergency},
                                                       {"the heartbeat", settings.heartbeat},
                                                       {"tpdo", settings.tpdo},
                                                       {"rpdo", settings.rpdo}};
  for (const auto* a = std::begin(all); a != std::end(all); ++a)
    for (const auto* b = a + 1; b != std::end(all); ++b)
      if (a->second == b->second)
        source.fail(std::string(a->first) + " and " + b->first +
                    ": two CAN frames have the same identifier; each frame must have its own");
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
  settings.rpdo = id("rpdo", kRpdo4.first + node - 1);
  settings.sync_timeout = InstantNs(kNsPerMs * source.whole("timeout_ms", 20, 2, 1000));
  settings.heartbeat_time = InstantNs(kNsPerMs * source.whole("heartbeat_ms", 200, 10, 10'000));
  refuse_equal_identifiers(source, settings);
  refuse_use(source, "sync", settings.sync, kRestricted);
  refuse_use(source, "sync", settings.sync, kOfOthers);
  refuse_use(source, "tpdo", settings.tpdo, kRestricted);
  refuse_use(source, "tpdo", settings.tpdo, kNoTpdo);
  refuse_use(source, "rpdo", settings.rpdo, kRestricted);
  refuse_use(source, "rpdo", settings.rpdo, kOfOthers);
  refuse_further_rpdos(source, settings.rpdo, node);
  return settings;
}

/// The position offset of an axis of the drive, which has no subindex, or an object of the manufacturer:
/// every other object of CiA 301 or CiA 402 has another meaning (0x607A is the target position, 0x6040 the
/// controlword).
bool takes_an_offset(const CanopenObject& object) {
  constexpr std::uint16_t kPositionOffset = 0x60b0, kPerAxis = 0x800, kAxes = 8;
  constexpr std::uint16_t kFirstOfMaker = 0x2000, kLastOfMaker = 0x5fff;
  const std::uint16_t index = object.index;
  if (index >= kFirstOfMaker && index <= kLastOfMaker) return true;
  return index >= kPositionOffset && (index - kPositionOffset) % kPerAxis == 0 &&
         (index - kPositionOffset) / kPerAxis < kAxes && object.subindex == 0;
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
  if (!takes_an_offset(object))
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

/// A link sends any bytes: it must have no identifier on which a node of CANopen acts.
void refuse_identifier_of_canopen(const std::vector<DriveUse>& drives, const SignalSource& link,
                                  const char* name) {
  const auto id = static_cast<std::uint32_t>(link.number(name, 0));
  if (id > kStandardIds) return;
  for (const DriveUse& drive : drives) {
    if (drive.source->text("interface") != link.text("interface")) continue;
    if (id == kNmt) link.fail_at(name, std::string(name) + ": 0x000 is NMT: it starts and stops the drives");
    refuse_use(link, name, id, kRestricted);
    const auto node = static_cast<std::uint32_t>(drive.source->whole("node", 1, kLastNode));
    if ((id & kNodeMask) == node)
      link.fail_at(name, std::string(name) + ": the identifier belongs to node " + std::to_string(node) +
                             ", the drive of " + drive.source->where);
  }
}

/// Position and offset of one drive count in one unit (0x6064 and 0x60B0), in one direction.
void require_one_unit(const SignalSource& position, const SignalSource& output) {
  for (const char* const name : {"interface", "node"}) {
    const bool same = position.texts.contains(name) ? position.text(name) == output.text(name)
                                                    : position.number(name) == output.number(name);
    if (!same)
      output.fail_at(
          name, std::string(name) + ": the position of this axis is from another drive (" + position.where +
                    "). To use the position of that drive, read its frame with a position of kind = \"can\"");
  }
  const double of_position = position.number("scale"), of_output = output.number("scale");
  constexpr double kSame = 1e-9;  // relative; the same decimal number
  // A scale that is not valid alone is refused with its own line.
  if (of_position == 0 || of_output <= 0) return;
  if (std::abs(std::abs(of_position) - of_output) > kSame * of_output)
    output.fail_at("scale", "scale: the position of this drive has a count of another size (" +
                                position.where +
                                "); position and offset of a drive have the same position unit");
  if ((of_position < 0) != is_inverted(output))
    output.fail_at(
        "polarity",
        (of_position < 0 ? "polarity must be inverted, because the scale of the position is below 0 in "
                         : "polarity must be normal, because the scale of the position is above 0 in ") +
            position.where);
}

/// Refuses an identifier of another use of the bus that is one of these drives.
void refuse_identifiers_of(const std::vector<DriveUse>& drives, const SignalSource& source, const char* name,
                           bool with_tpdo) {
  const auto id = static_cast<std::uint32_t>(source.number(name, 0));
  for (const DriveUse& drive : drives) {
    const CanopenSettings& of = drive.settings;
    if (drive.source->text("interface") != source.text("interface")) continue;
    if (id == of.rpdo || id == of.sync || id == of.emergency || id == of.heartbeat ||
        (with_tpdo && id == of.tpdo))
      source.fail_at(name, std::string(name) +
                               ": this identifier is already used by a frame of the drive of " +
                               drive.source->where);
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
      if (link.source.kind == "isotp") {
        refuse_identifiers_of(drives, link.source, name, true);
        refuse_identifier_of_canopen(drives, link.source, name);
      }
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
    numbers.fail_at(
        "scale", "scale must be above 0 and at most 1000 um per count; for the other direction use polarity");
  numbers.numbers["resolution"] = scale_um * kMmPerUm;
  if (numbers.number("range") < scale_um * kMmPerUm)
    numbers.fail_at("range", "range must be at least one count (scale)");
  const AnalogueScale scale = number_scale(numbers, axis.rotary);
  CanopenSettings settings = settings_of(*axis.source);
  const double counts = static_cast<double>(std::min<std::int64_t>(axis.most_per_tick, INT32_MAX)) *
                        static_cast<double>(scale.codes) / static_cast<double>(scale.span);
  settings.parts_per_sync =
      std::max<std::int64_t>(1, std::llround(counts * static_cast<double>(CanopenSettings::kPartsOfCount)));
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
    if (axis.position.kind == source.kind) require_one_unit(axis.position, source);
    const std::string& interface = source.text("interface");
    const std::int64_t tick_us = board.service.upload.tick.count;
    if (source.whole("sync_us", 100, 100'000) != tick_us)
      source.fail_at("sync_us", "sync_us must be tick_us (" + std::to_string(tick_us) +
                                    "): a drive accepts one offset with each SYNC frame");
    if (board.sync.kind != "can" || board.sync.text("interface") != interface ||
        board.sync.whole("id", kSync, 0, (1 << 29) - 1) != settings.sync)
      source.fail("the ticks do not follow SYNC; add sync = { kind = \"can\", interface = \"" + interface +
                  "\" } to [board]");
    for (const DriveUse& other : used)
      if (other.settings.rpdo == settings.rpdo && other.source->text("interface") == interface)
        source.fail("rpdo: this identifier is already used by the RPDO of " + other.source->where);
    used.push_back({&source, settings});
  }
  refuse_identifiers_of(used, board);
}

}  // namespace vernier
