// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/unit/house/includes.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <vector>

namespace vernier::house {
namespace {

bool starts_with(std::string_view text, std::string_view prefix) {
  return text.substr(0, prefix.size()) == prefix;
}

std::string_view head(std::string_view path) { return path.substr(0, path.find('/')); }

// C++20's freestanding headers, and those that C++23 and C++26 add and that need neither heap nor operating
// system.
bool is_freestanding(std::string_view header) {
  static const std::set<std::string_view> kHeaders = {
      "algorithm", "array",       "atomic",  "bit",     "cfloat",  "climits",         "compare",
      "concepts",  "cstddef",     "cstdint", "cstring", "limits",  "optional",        "ratio",
      "span",      "type_traits", "tuple",   "utility", "version", "initializer_list"};
  return kHeaders.contains(header);
}

// Which rooms of tools a room may use, floor by floor: no arrow runs up, none is missing.
struct Room {
  std::string_view name;
  std::set<std::string_view> uses;
};
const std::vector<Room>& rooms_of_tools() {
  static const std::vector<Room> kRooms = {
      {"maths", {}},
      {"text", {}},
      {"format", {"maths", "text"}},
      {"provenance", {"text"}},
      {"report", {}},
      {"http", {}},
      {"sheet", {"format", "text"}},
      {"model", {"format", "maths", "text"}},
      {"fit", {"format", "maths", "model", "text"}},
      {"kinematics", {"format", "maths", "model", "text"}},
      {"vibration", {"format", "maths", "model", "text"}},
      {"probe", {"format", "maths", "model", "text"}},
      {"timebase", {"format", "maths", "model", "text"}},
      {"create", {"format", "model", "sheet", "text"}},
      {"evaluate", {"format", "maths", "model", "text"}},
      {"import", {"format", "maths", "model", "sheet", "text", "timebase"}},
      {"exchange", {"format", "kinematics", "maths", "model", "text"}},
      {"lint", {"fit", "format", "import", "model", "sheet", "text"}},
      {"part", {"fit", "format", "maths", "model", "text"}},
      {"safety", {"fit", "kinematics", "maths", "model", "text"}},
      {"compile", {"format", "maths", "model", "text"}},
      {"effects", {"fit", "format", "maths", "model", "text", "vibration"}},
      {"residual", {"fit", "format", "maths", "model", "text"}},
      {"derive", {"compile", "maths", "model", "text"}},
      {"diagnose",
       {"effects", "fit", "format", "maths", "model", "residual", "text", "timebase", "vibration"}},
      {"simulate", {"compile", "fit", "format", "kinematics", "maths", "model", "text"}},
      {"upload", {"maths", "text"}},
      {"map", {"format", "import", "kinematics", "maths", "model", "text"}},
      {"check", {"effects", "fit", "format", "maths", "model", "text"}},
      {"registry", {"maths", "text"}},
      {"fleet", {"check", "http", "registry", "text", "upload"}},
      {"offline", {"format", "kinematics", "maths", "model", "text"}},
      {"tolerance", {"effects", "fit", "format", "kinematics", "maths", "model", "offline", "text"}},
      {"plan",
       {"check", "diagnose", "effects", "fit", "format", "kinematics", "maths", "model", "text",
        "tolerance"}},
      {"results",
       {"diagnose", "effects", "fit", "format", "import", "kinematics", "map", "maths", "model", "residual",
        "safety", "simulate", "text"}},
      {"python", {"diagnose", "effects", "fit", "format", "model", "plan", "residual", "results", "text"}},
      {"workbench",
       {"diagnose", "effects", "fit", "format", "http", "import", "lint", "maths", "model", "results",
        "safety", "simulate", "text", "upload"}},
  };
  return kRooms;
}

bool is_hal_port(std::string_view path) {
  return starts_with(path, "hal/") && path.substr(4).find('/') == std::string_view::npos;
}

// What daemon and tools share.
bool is_hal_support(std::string_view path) { return starts_with(path, "hal/support/"); }

std::string_view second_folder(std::string_view path) {
  const auto slash = path.find('/');
  return slash == std::string_view::npos ? std::string_view{} : head(path.substr(slash + 1));
}

std::string tool_may_include(std::string_view path, std::string_view target) {
  const std::string_view folder = second_folder(path);
  const std::string_view top = head(target);
  if (top == "comp" || top == "tables" || is_hal_support(target)) return {};
  if (starts_with(target, "firmware/daemon/")) return "the daemon is no library";
  if (top == "firmware" || top == "hal") {
    const bool runs_firmware = folder == "simulate" || folder == "upload" || folder == "commands";
    return runs_firmware ? "" : "only simulate, upload and their commands may use firmware and hal";
  }
  const std::string_view other = second_folder(target);
  if (other == folder) return {};
  if (other == "commands") return "nobody below knows a command line";
  if (folder == "commands") return {};
  for (const Room& room : rooms_of_tools()) {
    if (room.name != folder) continue;
    return room.uses.contains(other) ? "" : "a room of tools that this one may not use";
  }
  return "a folder of tools that has no floor";
}

std::string comp_may_include(std::string_view path, std::string_view target) {
  if (head(target) != "comp") return "comp stands alone";
  const auto room = [](std::string_view file) { return file.substr(0, file.rfind('/')); };
  const std::string_view from = room(path), to = room(target);
  return to == "comp" || to == from || to == "comp/generated"
             ? ""
             : "comp knows neither comp/probing nor comp/vibration";
}

std::string hal_may_include(std::string_view path, std::string_view target) {
  if (target == "comp/quantity.h" || is_hal_port(target)) return {};
  if (is_hal_port(path)) return "a hal port may include only ports and comp/quantity.h";
  if (is_hal_support(target)) return {};
  if (is_hal_support(path))
    return head(target) == "comp" ? "" : "hal/support may include ports, comp and system libraries";
  const bool sim = starts_with(path, "hal/sim/");
  if (sim && (head(target) == "comp" || starts_with(target, "hal/sim/"))) return {};
  if (!sim && starts_with(target, "hal/linux/")) return {};
  return sim ? "hal/sim may include ports, support and comp"
             : "hal/linux may include ports, support and system libraries";
}

std::string firmware_may_include(std::string_view path, std::string_view target) {
  const std::string_view top = head(target);
  if (top == "comp" || top == "tables" || is_hal_port(target) || starts_with(target, "firmware/core/"))
    return {};
  if (starts_with(path, "firmware/core/")) return "firmware/core may include comp, tables and hal ports";
  if (starts_with(path, "firmware/linuxcnc/")) {
    static const std::set<std::string_view> kComposes = {"firmware/linuxcnc/component.h",
                                                         "firmware/linuxcnc/vernier_hal.cpp"};
    if (starts_with(target, "firmware/") || (kComposes.contains(path) && top == "hal")) return {};
    return "firmware/linuxcnc may include firmware, comp, tables and hal ports; only its composition roots "
           "(component, vernier_hal) name a backend";
  }
  if (!starts_with(path, "firmware/daemon/")) return "a folder of firmware that has no place";
  if (starts_with(target, "firmware/daemon/") || is_hal_support(target)) return {};
  static const std::set<std::string_view> kRoot = {
      "firmware/daemon/main.cpp",           "firmware/daemon/devices.cpp",
      "firmware/daemon/open_devices.cpp",   "firmware/daemon/open_drives.cpp",
      "firmware/daemon/open_positions.cpp", "firmware/daemon/device_trials.cpp",
      "firmware/daemon/duties.h",           "firmware/daemon/duties.cpp"};
  if (kRoot.contains(path) && top == "hal") return {};
  return "firmware/daemon may include firmware, comp, tables, hal ports and hal/support; only the "
         "composition "
         "root (main, devices, open_*, device_trials, duties) names a backend";
}

// Empty: allowed; else the reason.
std::string may_include(std::string_view path, std::string_view target) {
  static const std::set<std::string_view> kFolders = {"comp", "tables", "hal", "firmware", "tools", "tests"};
  const std::string_view from = head(path), to = head(target);
  if (!kFolders.contains(to)) return "not written from the repository root";
  if (from == "tests") return {};
  if (to == "tests") return "nobody includes tests";
  if (from == "tools") return tool_may_include(path, target);
  if (to == "tools") return "nobody includes tools";
  if (from == "comp") return comp_may_include(path, target);
  if (from == "tables") return to == "tables" || to == "comp" ? "" : "tables may include comp only";
  if (from == "hal") return hal_may_include(path, target);
  return firmware_may_include(path, target);
}

struct Include {
  std::string target;
  bool system = false;
};

// The include on this line, or an empty target.
Include parse_include(std::string_view line) {
  const auto skip_blanks = [&line] {
    line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
  };
  skip_blanks();
  if (!starts_with(line, "#")) return {};
  line.remove_prefix(1);
  skip_blanks();
  if (!starts_with(line, "include")) return {};
  line.remove_prefix(7);
  skip_blanks();
  if (line.empty() || (line.front() != '"' && line.front() != '<')) return {};
  const bool system = line.front() == '<';
  line.remove_prefix(1);
  return {std::string(line.substr(0, line.find(system ? '>' : '"'))), system};
}

}  // namespace

std::vector<std::string> wrong_includes(const std::string& path, std::string_view text) {
  std::vector<std::string> wrong;
  const bool core = starts_with(path, "comp/") || starts_with(path, "tables/");
  for (std::size_t line = 1; !text.empty(); ++line) {
    const auto end = std::min(text.find('\n'), text.size());
    const Include include = parse_include(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    if (include.target.empty()) continue;
    std::string why;
    if (!include.system) why = may_include(path, include.target);
    if (include.system && core && !is_freestanding(include.target))
      why = "comp and tables take freestanding headers only";
    if (!why.empty())
      wrong.push_back(path + ":" + std::to_string(line) + ": \"" + include.target + "\": " + why);
  }
  return wrong;
}

std::vector<std::string> rooms_that_run_up() {
  std::set<std::string_view> below;
  std::vector<std::string> wrong;
  for (const Room& room : rooms_of_tools()) {
    for (const std::string_view used : room.uses)
      if (!below.contains(used))
        wrong.push_back(std::string(room.name) + " uses " + std::string(used) + ", which stands above it");
    below.insert(room.name);
  }
  return wrong;
}

std::vector<std::string> declared_types(std::string_view text) {
  std::vector<std::string> names;
  for (; !text.empty();) {
    const auto end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    const bool is_enum = starts_with(line, "enum class ");
    if (is_enum)
      line.remove_prefix(11);
    else if (starts_with(line, "struct "))
      line.remove_prefix(7);
    else if (starts_with(line, "class "))
      line.remove_prefix(6);
    else
      continue;
    const auto word = line.substr(0, line.find_first_of(" :{;"));
    const bool defined = line.find(';') == std::string_view::npos || line.find('{') != std::string_view::npos;
    if (defined && !word.empty()) names.emplace_back(word);
  }
  return names;
}

}  // namespace vernier::house
