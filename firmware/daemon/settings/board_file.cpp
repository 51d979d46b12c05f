// SPDX-License-Identifier: Apache-2.0
#include "firmware/daemon/settings/board_file.h"

#include <sodium.h>

// The library assumes text that it has not checked yet ("[`a]" for the name of a table). An assertion would
// end the daemon, an assumption would be undefined behaviour. Without both it reports its parse error.
#undef NDEBUG
#define TOML_ASSERT(expr) static_assert(true)
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include "firmware/daemon/settings/short_names.h"
#include "firmware/daemon/settings/toml_text.h"
#include "firmware/daemon/settings/units.h"

namespace vernier {
namespace {

constexpr double kMostCounts = 1e15;
constexpr double kMostDelayUs = 40'000;  // of a probe: memory of the latch at 1 kHz, minus its settling time
constexpr double kTicksToLargest = 200;  // of a default max_step without a known travel: 0.2 s at 1 kHz
// Of a default max_step: a correction that goes from one end of its range to the other in a tenth of the
// travel.
constexpr double kSteepness = 10;

const std::set<std::string_view> kSections = {"board", "axis",    "output", "input",
                                              "probe", "digital", "link",   "key"};

using Words = std::set<std::string, std::less<>>;
/// Settings of an [[axis]] and an [[output]] that do not belong to the device.
const Words kOfAxis = {"name",           "rotary",           "rollover",     "low",
                       "high",           "max_speed",        "max_step",     "max_acceleration",
                       "max_correction", "correction_share", "missing_ticks"};
const Words kOfOutput = {"axis"};

toml::table read_toml(const std::string& path) {
  try {
    std::ifstream file(path, std::ios::binary);
    if (!file || std::filesystem::is_directory(path)) return toml::parse_file(path);  // it reports the reason
    const std::string text((std::istreambuf_iterator<char>(file)), {});
    refuse_letters_outside_strings(text, path);
    return toml::parse(text, path);
  } catch (const toml::parse_error& error) {
    throw BoardError{path + ":" + std::to_string(error.source().begin.line) + ": " +
                     std::string(error.description())};
  }
}

std::string number_text(double value) {
  std::string text = std::to_string(value);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

/// Reads the settings of one table and records which of them were not read.
class Table {
 public:
  Table(const toml::table& table, std::string file, std::string where)
      : table_(table), file_(std::move(file)), where_(std::move(where)) {}

  [[noreturn]] void fail(const std::string& what, const toml::node* at = nullptr) const {
    const auto line = (at != nullptr ? at->source() : table_.source()).begin.line;
    throw BoardError{file_ + ":" + std::to_string(line) + ": " + where_ + ": " + what};
  }
  template <class T>
  T get(const std::string& name, const T& otherwise, const char* kind) {
    asked_.insert(name);
    const toml::node* const node = table_.get(name);
    if (node == nullptr) return otherwise;
    const auto value = node->value_exact<T>();
    if (!value) fail(name + " must be " + kind, node);
    return *value;
  }
  std::string text(const std::string& name, const std::string& otherwise) {
    return get<std::string>(name, otherwise, "a text");
  }
  bool flag(const std::string& name, bool otherwise) { return get<bool>(name, otherwise, "true or false"); }
  double number(const std::string& name, double otherwise, double low, double high) {
    asked_.insert(name);
    const toml::node* const node = table_.get(name);
    // A default may be outside the range: it means "not given".
    if (node == nullptr) return otherwise;
    const double value = finite_number(*node, name, false);
    if (!(value >= low && value <= high))
      fail(name + " must be between " + number_text(low) + " and " + number_text(high), node);
    return value;
  }
  std::int64_t whole(const std::string& name, std::int64_t otherwise, std::int64_t low, std::int64_t high) {
    if (const toml::node* const node = table_.get(name)) finite_number(*node, name, true);
    return static_cast<std::int64_t>(
        number(name, static_cast<double>(otherwise), static_cast<double>(low), static_cast<double>(high)));
  }
  /// A number that is neither infinite nor "not a number", which TOML can write too.
  double finite_number(const toml::node& node, const std::string& name, bool whole) const {
    const auto value = node.is_number() ? node.value<double>() : std::nullopt;
    if (!node.is_number()) fail(name + " must be a number", &node);
    if (!value || !std::isfinite(*value)) fail(name + " must be a finite number of at most 15 digits", &node);
    if (whole && *value != std::trunc(*value)) fail(name + " must be a whole number", &node);
    return *value;
  }
  bool has(const std::string& name) const { return table_.get(name) != nullptr; }
  const toml::table* table(const std::string& name) {
    asked_.insert(name);
    const toml::node* const node = table_.get(name);
    if (node == nullptr) return nullptr;
    if (!node->is_table()) fail(name + " must be a table", node);
    return node->as_table();
  }
  void nothing_else() const {
    for (const auto& [key, node] : table_)
      if (!asked_.contains(std::string(key.str()))) fail("unknown setting " + std::string(key.str()), &node);
  }

 private:
  const toml::table& table_;
  std::string file_, where_;
  std::set<std::string> asked_;
};

std::string beside(const std::string& board_path, const std::string& path) {
  const std::filesystem::path given(path);
  if (given.is_absolute()) return path;
  return (std::filesystem::path(board_path).parent_path() / given).string();
}

/// A setting that may be a path: a file or directory of a device. Without a `/` it is a name.
bool is_path(const std::string& setting, const std::string& value) {
  static const std::set<std::string> kPaths = {"root", "device", "devices", "path", "interface", "chip"};
  return kPaths.contains(setting) && value.find('/') != std::string::npos;
}

/// others: settings of the table that do not belong to the device.
SignalSource source_of(const toml::table* table, const std::string& file, const std::string& where,
                       const Words& others = {}) {
  SignalSource source;
  if (table == nullptr) return source;
  Table settings(*table, file, where);
  const auto place = [&](const toml::node& node) {
    return file + ":" + std::to_string(node.source().begin.line) + ": " + where;
  };
  source.where = place(*table);
  source.kind = settings.text("kind", "");
  if (source.kind.empty()) settings.fail("kind is missing");
  for (const auto& [key, node] : *table) {
    if (others.contains(key.str())) continue;
    const std::string name(key.str());
    source.places[name] = place(node);
    const SettingType type = type_of_setting(source.kind, name);
    if (const auto text = node.value_exact<std::string>();
        text && type != SettingType::kNumber && type != SettingType::kWholeNumber)
      source.texts[name] = is_path(name, *text) ? beside(file, *text) : *text;
    else if (type == SettingType::kText)
      settings.fail(name + " must be a text", &node);
    else
      source.numbers[name] = settings.finite_number(node, name, type == SettingType::kWholeNumber);
  }
  return source;
}

std::int64_t counts(double value) { return std::llround(std::clamp(value, -kMostCounts, kMostCounts)); }

AxisSetting setting_of(Table& settings, bool rotary, TimeUs tick) {
  const double scale = rotary ? kCountsPerDeg : kNmPerMm;
  const double tick_s = static_cast<double>(tick.count) * 1e-6;
  AxisSetting setting;
  setting.own = true;
  setting.limits = rotary ? CycleLimits{}.rotary : CycleLimits{}.linear;
  const double speed = settings.number("max_speed", 0, 1e-6, 1e6);
  const double acceleration = settings.number("max_acceleration", 0, 1e-6, 1e9);
  const double share = settings.number("correction_share", 0.1, 1e-6, 1);
  // A limit is a whole number of counts, never above its setting.
  const auto limit = [&](const char* name, double value, double whole) {
    const double most = std::floor(value * (1 + 1e-12));
    if (most >= 1) return static_cast<std::int64_t>(std::min<double>(most, INT32_MAX));
    char text[200];
    std::snprintf(text, sizeof text,
                  "%s is too small: the smallest limit of a correction is 1 count (%s) in a tick; %s must be "
                  "at least %.3g",
                  name, rotary ? "0.084 udeg" : "1 nm", name, whole / value);
    settings.fail(text);
  };
  if (speed > 0) {
    setting.limits.step = std::max<std::int64_t>(counts(speed * tick_s * scale), 1);
    setting.motion.slew = limit("max_speed", share * speed * tick_s * scale, speed);
  }
  const double step = settings.number("max_step", 0, 1e-9, 1e3);
  if (step > 0) setting.motion.slew = std::min(setting.motion.slew, limit("max_step", step * scale, step));
  if (acceleration > 0)
    setting.motion.acceleration =
        limit("max_acceleration", share * acceleration * tick_s * tick_s * scale, acceleration);
  const double largest = settings.number("max_correction", 0, 1e-6, 1e3);
  if (largest > 0) setting.largest = std::clamp<std::int64_t>(counts(largest * scale), 1, INT32_MAX);
  setting.limits.missing_ticks =
      static_cast<std::uint32_t>(settings.whole("missing_ticks", setting.limits.missing_ticks, 0, 10000));
  return setting;
}

/// The results of a calibration override the settings of the board file. A missing calibration file is
/// reported by Devices: without it the output would be driven with other numbers than the measured ones.
void apply_calibration(const std::string& board_path, SignalSource& output) {
  const std::string path = output.text("calibration", "");
  if (path.empty()) return;
  output.texts["calibration"] = beside(board_path, path);
  if (!std::filesystem::exists(output.texts["calibration"])) return;
  const toml::table table = read_toml(output.texts["calibration"]);
  Table settings(table, output.texts["calibration"], "calibration");
  if (!settings.has("zero")) settings.fail("zero is missing; make the file with vernierd --calibrate");
  output.numbers["span"] = settings.number("span", 0, 1e-9, 1e4);
  output.numbers[output.kind == "pwm" ? "zero_ns" : "zero"] = settings.number("zero", 0, 0, 1e9);
  output.texts["polarity"] = settings.text("polarity", "");
  settings.nothing_else();
}

/// Default of max_step, mm or deg: the change of a steep correction in one tick at max_speed. Without a known
/// travel, a share of max_correction.
double default_step(Table& settings, const AxisEntry& axis, TimeUs tick) {
  const double largest = settings.number("max_correction", 0, 1e-6, 1e3);
  const double speed = settings.number("max_speed", 0, 1e-6, 1e6);
  const double travel = axis.wiring.rotary && axis.wiring.rollover ? 360 : axis.high - axis.low;
  const double in_a_tick = speed * static_cast<double>(tick.count) * 1e-6;
  const double step = travel > 0 ? kSteepness * 2 * largest / travel * in_a_tick : largest / kTicksToLargest;
  return std::max(step, 1e-6);
}

/// The limits of a real output are set by the board, outside of every image: an image without a slew limit
/// moves it no faster.
void require_limits(Table& settings, AxisEntry& axis, TimeUs tick) {
  const SignalSource& output = axis.output;
  if (output.kind.empty() || output.kind == "sim") return;
  const std::string unit = axis.wiring.rotary ? "deg" : "mm";
  const auto require = [&](const char* name, const std::string& mend) {
    if (!settings.has(name))
      settings.fail(std::string(name) + " is missing: an output of kind " + output.kind + " needs it; add " +
                    mend);
  };
  require("max_correction",
          "max_correction = 0.1  # " + unit + ", the largest correction that the board adds to the command");
  require(
      "max_speed",
      "max_speed = 500  # " + unit +
          "/s, the largest speed of the axis; a correction may use the part correction_share of this speed");
  if (settings.has("max_step")) return;
  const std::string step = number_text(default_step(settings, axis, tick));
  axis.default_step = "max_step = " + step + "  # " + unit + " in one tick";
  if (settings.has("max_acceleration")) return;
  settings.fail("max_step or max_acceleration is missing: an output of kind " + output.kind +
                " needs one of them; add max_step = " + step + "  # " + unit +
                ", the largest change of a correction in one tick");
}

/// `name`, motion and limits of an axis. device: its table has the settings of the position's device too.
AxisEntry read_axis_settings(BoardFile& board, const std::string& name, Table& settings, bool device) {
  if (board.axes.size() == kMaxAxes) settings.fail("the file has more axes than the firmware supports");
  if (name.size() >= kImageNameBytes) settings.fail("the name is too long");
  AxisEntry axis;
  axis.wiring.name = Name(std::string_view(name));
  if (device) {
    axis.wiring.rotary = settings.flag("rotary", false);
  } else {
    const std::string kind = settings.text("kind", "linear");
    if (kind != "linear" && kind != "rotary")
      settings.fail("kind: '" + kind + "' is neither linear nor rotary");
    axis.wiring.rotary = kind == "rotary";
  }
  axis.wiring.rollover = settings.flag("rollover", false);
  axis.low = settings.number("low", 0, -1e6, 1e6);
  axis.high = settings.number("high", 0, -1e6, 1e6);
  if (axis.low > axis.high) settings.fail("low must not be above high");
  board.service.limits.axis[board.axes.size()] =
      setting_of(settings, axis.wiring.rotary, board.service.upload.tick);
  return axis;
}

void add_axis(BoardFile& board, Table& settings, AxisEntry axis) {
  require_limits(settings, axis, board.service.upload.tick);
  use_short_names(axis.output, settings.number("max_correction", 0, 1e-6, 1e3));
  apply_calibration(board.path, axis.output);
  board.service.wiring.axes.push_back(axis.wiring);
  board.axes.push_back(std::move(axis));
}

/// [axis.NAME] with `position` and `output`.
void read_axis(BoardFile& board, const std::string& name, const toml::table& table,
               const toml::table* output) {
  Table settings(table, board.path, "axis." + name);
  AxisEntry axis = read_axis_settings(board, name, settings, false);
  axis.position = source_of(settings.table("position"), board.path, "axis." + name + ".position");
  axis.output = source_of(settings.table("output"), board.path, "axis." + name + ".output");
  if (axis.position.kind.empty()) settings.fail("position is missing");
  if (output != nullptr) {
    if (!axis.output.kind.empty()) settings.fail("the axis has an [[output]] too");
    axis.output = source_of(output, board.path, "output of " + name, kOfOutput);
  }
  settings.nothing_else();
  add_axis(board, settings, std::move(axis));
}

/// [[axis]]: `kind` is that of the device which gives the position, and the device's settings are beside it.
void read_flat_axis(BoardFile& board, const std::string& name, const toml::table& table,
                    const toml::table* output) {
  Table settings(table, board.path, "axis " + name);
  AxisEntry axis = read_axis_settings(board, name, settings, true);
  axis.position = source_of(&table, board.path, "axis " + name, kOfAxis);
  axis.output = source_of(output, board.path, "output of " + name, kOfOutput);
  add_axis(board, settings, std::move(axis));
}

void read_input(BoardFile& board, const std::string& name, const toml::table& table) {
  Table settings(table, board.path, "input." + name);
  if (board.inputs.size() == kMaxInputs) settings.fail("the file has more inputs than the firmware supports");
  if (name.size() >= kImageNameBytes) settings.fail("the name is too long");
  InputEntry input;
  input.name = name;
  input.unit = settings.text("unit", "");
  InputLimits& limits = board.service.limits.input[board.inputs.size()];
  if (settings.has("low")) limits.low = counts(kMicro * settings.number("low", 0, -1e9, 1e9));
  if (settings.has("high")) limits.high = counts(kMicro * settings.number("high", 0, -1e9, 1e9));
  if (settings.has("max_step")) limits.step = counts(kMicro * settings.number("max_step", 0, 0, 1e9));
  if (limits.low > limits.high) settings.fail("low must not be above high");
  input.reference = settings.number("reference", 0, -1e9, 1e9);
  input.source = source_of(settings.table("source"), board.path, "input." + name + ".source");
  if (input.source.kind.empty()) settings.fail("source is missing");
  settings.number("low", 0, -1e9, 1e9), settings.number("high", 0, -1e9, 1e9);
  settings.number("max_step", 0, 0, 1e9);
  settings.nothing_else();
  board.service.wiring.inputs.push_back(std::string_view(name));
  board.inputs.push_back(input);
}

void read_probe(BoardFile& board, const toml::table& table) {
  Table settings(table, board.path, "probe");
  board.probe = source_of(settings.table("line"), board.path, "probe.line");
  if (board.probe.kind.empty()) settings.fail("line is missing");
  const auto instant = [&](const char* name, double otherwise) {
    return InstantNs(std::llround(1000 * settings.number(name, otherwise, 0, kMostDelayUs)));
  };
  ProbeSettings& probe = board.service.probe;
  probe.delay = instant("delay_us", 0);
  probe.delay_spread = instant("delay_spread_us", 0);
  probe.position_age = instant("position_age_us", 0);
  probe.age_spread = instant("position_age_spread_us", 0);
  probe.settle = instant("settle_us", 1000);
  settings.nothing_else();
}

void read_digital(BoardFile& board, const toml::table& table) {
  Table settings(table, board.path, "digital");
  board.enable = source_of(settings.table("enable"), board.path, "digital.enable");
  board.healthy = source_of(settings.table("healthy"), board.path, "digital.healthy");
  const double tick_ms = static_cast<double>(board.service.upload.tick.count) * 1e-3;
  const std::int64_t toggle_ms = board.healthy.whole("toggle_ms", 0, 0, 1000);
  if (toggle_ms > 0)
    board.service.healthy_toggle =
        static_cast<std::uint32_t>(std::max(1.0, std::round(static_cast<double>(toggle_ms) / tick_ms)));
  settings.nothing_else();
}

Name board_name(Table& settings, const char* setting) {
  const std::string name = settings.text(setting, "");
  if (name.size() >= kBoardNameBytes)
    settings.fail(std::string(setting) + " must be shorter than " + std::to_string(kBoardNameBytes) +
                  " characters");
  return std::string_view(name);
}

/// The key of a file, or the error with the line of the board file that names it.
PublicKey public_key(const Table& settings, const toml::node* at, const std::string& path) {
  try {
    return read_public_key(path);
  } catch (const BoardError& error) {
    settings.fail(error.what, at);
  }
}

void read_key(BoardFile& board, const toml::table& table) {
  Table settings(table, board.path, "key");
  TrustedKey key;
  const std::string name = settings.text("name", ""), role = settings.text("role", "all");
  const std::string file = settings.text("file", "");
  if (name.empty()) settings.fail("name is missing: give the name of the owner of the key");
  if (file.empty()) settings.fail("file is missing: the public key of `vernier keys`");
  if (role != "all" && role != "command" && role != "upload" && role != "retired")
    settings.fail("role: '" + role + "' is not one of all, command, upload, retired");
  key.name = std::string_view(name);
  board.key_files.push_back(beside(board.path, file));
  key.key = public_key(settings, table.get("file"), board.key_files.back());
  key.command = role != "upload", key.upload = role != "command";
  key.retired = role == "retired";
  settings.nothing_else();
  BoardIdentity& identity = board.service.upload.identity;
  if (identity.find(key.key.data(), kPublicKeyBytes) != nullptr)
    settings.fail(name + ": the board file has this key twice");
  if (identity.keys.size() == BoardIdentity::kMostKeys)
    settings.fail("the board file has more keys than the board can store");
  identity.keys.push_back(key);
}

/// An image is signed for a board: one that trusts a key has to have a name.
void require_name(const BoardFile& board, const Table& general) {
  const BoardIdentity& identity = board.service.upload.identity;
  if (!identity.keys.empty() && identity.board.empty())
    general.fail(
        "name is missing: images are signed for a board; add name = \"mill-1\" (and class, where several "
        "boards take the same images)");
}

void read_board(BoardFile& board, const toml::table& table) {
  Table settings(table, board.path, "board");
  board.service.upload.tick = TimeUs(settings.whole("tick_us", 1000, 100, 100000));
  board.store = beside(board.path, settings.text("store", "store"));
  board.slot_bytes = static_cast<std::uint32_t>(settings.whole("slot_bytes", 1 << 20, 4096, kMaxImageBytes));
  board.service.upload.trial_time = TimeUs(counts(1e6 * settings.number("trial_s", 60, 0.1, 86400)));
  board.service.activate = settings.flag("activate", false);
  board.priority = static_cast<int>(settings.whole("priority", 80, 1, 99));
  board.service.overruns.lost_share_q16 =
      static_cast<std::uint32_t>(65536 * settings.number("max_lost_ticks", 0.05, 0, 0.99));
  board.watchdog = settings.text("watchdog", "");
  if (!board.watchdog.empty()) board.watchdog = beside(board.path, board.watchdog);
  const toml::table* const sync = settings.table("sync");
  board.sync = source_of(sync, board.path, "board.sync");
  if (sync != nullptr)
    board.service.sync_patience = TimeUs(1000 * board.sync.whole("timeout_ms", 20, 1, 1000));
  BoardIdentity& identity = board.service.upload.identity;
  identity.board = board_name(settings, "name");
  identity.board_class = board_name(settings, "class");
  const std::string key = settings.text("public_key", "");
  if (!key.empty()) {
    board.key_files.push_back(beside(board.path, key));
    identity.keys.push_back(
        {public_key(settings, table.get("public_key"), board.key_files.back()), "public_key"});
  }
  settings.nothing_else();
}

// The library sorts tables by name; the board's order is that of the file.
template <class Use>
void in_order_of_file(const toml::table& table, const std::string& file, const std::string& where, Use use) {
  std::vector<std::pair<std::string, const toml::table*>> entries;
  for (const auto& [key, node] : table) {
    if (!node.is_table()) Table(table, file, where).fail(std::string(key.str()) + " must be a table", &node);
    entries.emplace_back(std::string(key.str()), node.as_table());
  }
  std::sort(entries.begin(), entries.end(), [](const auto& a, const auto& b) {
    return a.second->source().begin.line < b.second->source().begin.line;
  });
  for (const auto& [name, entry] : entries) use(name, *entry);
}

/// [[link]] and [[key]]: a table each.
template <class Use>
void each_table(const BoardFile& board, const char* section, const toml::node& node, Use use) {
  const auto fail = [&](const toml::node& at, const char* what) {
    throw BoardError{board.path + ":" + std::to_string(at.source().begin.line) + ": " + section + what};
  };
  const toml::array* const tables = node.as_array();
  if (tables == nullptr) return fail(node, " must be a [[table]] each");
  for (const toml::node& entry : *tables) {
    if (!entry.is_table()) fail(entry, " must be a table");
    use(*entry.as_table());
  }
}

/// The [[output]] of each axis, by name.
std::map<std::string, const toml::table*> outputs_of(const BoardFile& board, const toml::table& file) {
  std::map<std::string, const toml::table*> outputs;
  if (const toml::node* const node = file.get("output"))
    each_table(board, "output", *node, [&](const toml::table& table) {
      Table settings(table, board.path, "output");
      const std::string axis = settings.text("axis", "");
      if (axis.empty()) settings.fail("axis is missing: the name of the axis that the output corrects");
      if (!outputs.emplace(axis, &table).second)
        settings.fail("axis: '" + axis + "' has an output already", table.get("axis"));
    });
  return outputs;
}

/// [axis.NAME], or [[axis]] in the order of the file.
void read_axes(BoardFile& board, Table& settings, const toml::table& file) {
  const auto outputs = outputs_of(board, file);
  const auto output_of = [&](const std::string& name) {
    const auto found = outputs.find(name);
    return found == outputs.end() ? nullptr : found->second;
  };
  const auto known = [&](const std::string& name) {
    return std::any_of(board.axes.begin(), board.axes.end(),
                       [&](const AxisEntry& axis) { return axis.wiring.name.c_str() == name; });
  };
  const toml::node* const axes = file.get("axis");
  if (axes != nullptr && axes->is_array()) {
    each_table(board, "axis", *axes, [&](const toml::table& table) {
      Table entry(table, board.path, "axis");
      const std::string name = entry.text("name", "");
      if (name.empty()) entry.fail("name is missing: the name of the axis in the machine file");
      if (known(name)) entry.fail("name: '" + name + "' occurs twice", table.get("name"));
      read_flat_axis(board, name, table, output_of(name));
    });
  } else if (const toml::table* const tables = settings.table("axis")) {
    in_order_of_file(*tables, board.path, "axis", [&](const auto& name, const auto& table) {
      read_axis(board, name, table, output_of(name));
    });
  }
  for (const auto& [name, table] : outputs)
    if (!known(name))
      Table(*table, board.path, "output")
          .fail("axis: the board file has no axis '" + name + "'", table->get("axis"));
}

/// Rights of a link. A link to another computer shows only the state unless the file allows more.
LinkRights rights_of(SignalSource& link) {
  LinkRights rights;
  const bool loopback = link.kind == "modbus-tcp" && link.text("address", "127.0.0.1").starts_with("127.");
  const std::string access = link.text("access", loopback ? "upload" : "read");
  if (access != "read" && access != "command" && access != "upload")
    link.fail("access: '" + access + "' is not one of read, command, upload");
  rights.access = access == "read"      ? LinkAccess::kRead
                  : access == "command" ? LinkAccess::kCommand
                                        : LinkAccess::kUpload;
  const std::string plain = link.text("plain_commands", "refused");
  if (plain != "refused" && plain != "allowed")
    link.fail("plain_commands: '" + plain + "' is neither refused nor allowed");
  rights.plain_commands = plain == "allowed";
  link.texts.erase("access"), link.texts.erase("plain_commands");
  return rights;
}

void read_link(BoardFile& board, const toml::table& table) {
  LinkEntry link;
  link.source = source_of(&table, board.path, "link");
  link.rights = rights_of(link.source);
  board.links.push_back(link);
}

/// One device, one use: what two settings name would be driven by both in turns.
void refuse_duplicates(const BoardFile& board) {
  std::vector<const SignalSource*> used;
  const auto claim = [&](const SignalSource& source, std::initializer_list<const char*> place) {
    if (source.kind.empty() || source.kind == "sim") return;
    const auto same = [&](const SignalSource* other) {
      if (other->kind != source.kind) return false;
      for (const char* const name : place) {
        const auto text = [&](const SignalSource& s) {
          return s.texts.contains(name) ? s.texts.at(name) : "";
        };
        const auto number = [&](const SignalSource& s) {
          return s.numbers.contains(name) ? s.numbers.at(name) : 0;
        };
        if (text(*other) != text(source) || number(*other) != number(source)) return false;
      }
      return true;
    };
    const auto found = std::find_if(used.begin(), used.end(), same);
    if (found != used.end())
      source.fail("this device is already used by " + (*found)->where + "; one device can have only one use");
    used.push_back(&source);
  };
  for (const AxisEntry& axis : board.axes)
    claim(axis.output, {"path", "device", "root", "channel", "address", "port", "unit", "register", "place",
                        "interface", "node", "object"});
  for (const SignalSource* const line : {&board.probe, &board.enable, &board.healthy})
    claim(*line, {"chip", "line"});
  for (const LinkEntry& link : board.links)
    claim(link.source, {"address", "port", "device", "interface", "receive", "transmit"});
}

}  // namespace

BoardFile read_board_file(const std::string& path) {
  BoardFile board;
  board.path = path;
  board.service.store_beside = true;
  const toml::table file = read_toml(path);
  Table settings(file, path, "board file");
  const toml::table* const general = settings.table("board");
  if (general == nullptr) settings.fail("[board] is missing");
  read_board(board, *general);
  read_axes(board, settings, file);
  if (const toml::table* const inputs = settings.table("input"))
    in_order_of_file(*inputs, path, "input",
                     [&](const auto& name, const auto& t) { read_input(board, name, t); });
  if (board.axes.empty()) settings.fail("no [[axis]] and no [axis.NAME]");
  if (const toml::table* const probe = settings.table("probe")) read_probe(board, *probe);
  if (const toml::table* const digital = settings.table("digital")) read_digital(board, *digital);
  if (settings.has("link"))
    each_table(board, "link", *file.get("link"), [&](const toml::table& t) { read_link(board, t); });
  if (settings.has("key"))
    each_table(board, "key", *file.get("key"), [&](const toml::table& t) { read_key(board, t); });
  require_name(board, Table(*general, path, "board"));
  for (const auto& [key, node] : file)
    if (!kSections.contains(key.str())) settings.fail("unknown section " + std::string(key.str()), &node);
  refuse_duplicates(board);
  return board;
}

}  // namespace vernier
