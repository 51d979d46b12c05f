// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/logs/printer_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include "tools/format/columns.h"
#include "tools/sheet/encoding.h"
#include "tools/text/error.h"
#include "tools/text/numbers.h"
#include "tools/text/words.h"

namespace vernier::importer {
namespace {

using Point = std::array<double, 3>;
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

struct Touch {
  Point axes = {};
  double t = kUnknown;
  std::map<std::string, double> temperature;  // by the name of the heater or sensor
  std::size_t line = 0;
  bool of_probe = false;  // the place that the probe touched, not the position of the axes
};

double number_in(const text::Place& place, std::string_view word) {
  const auto value = text::parse_number(text::trimmed(word));
  if (!value) throw text::InputError(place, std::string(word), "not a number");
  return *value;
}

std::size_t count_in(const text::Place& place, std::string_view word) {
  constexpr std::size_t kMost = 1000;  // of a row or column of a mesh
  const auto value = text::parse_count(text::trimmed(word));
  if (!value || *value < 1 || *value > kMost)
    throw text::InputError(place, std::string(word), "the number of points must be from 1 to 1000");
  return *value;
}

/// Positions from `low` to `high`, `count` of them.
double station(double low, double high, std::size_t count, std::size_t i) {
  return count < 2 ? low : low + (high - low) * static_cast<double>(i) / static_cast<double>(count - 1);
}

std::vector<double> numbers_in(const text::Place& place, const std::string& line) {
  std::vector<double> numbers;
  for (const std::string& word : text::words_in(line, ", \t\r")) numbers.push_back(number_in(place, word));
  return numbers;
}

// ---- Klipper: saved meshes

struct Setting {
  std::string value;
  std::vector<std::pair<std::string, std::size_t>> more;  // lines of a value of several lines
  std::size_t line = 0;
};
using Section = std::map<std::string, Setting>;

/// Sections of a configuration; those that the printer saved begin each line with "#*#".
std::map<std::string, Section> sections_of(const std::string& text) {
  std::map<std::string, Section> sections;
  Section* section = nullptr;
  Setting* setting = nullptr;
  std::size_t number = 0;
  for (std::string raw : text::parts_of(text, '\n')) {
    ++number;
    if (raw.starts_with("#*#")) raw.erase(0, std::string_view("#*# ").size());
    for (const char* const comment : {" #", " ;", "\t#", "\t;"}) raw = raw.substr(0, raw.find(comment));
    const std::string line = text::trimmed(raw);
    if (line.empty() || line.front() == '#' || line.front() == ';') continue;
    const bool indented = raw.front() == ' ' || raw.front() == '\t';
    const auto sign = line.find_first_of("=:");
    if (line.front() == '[' && line.find(']') != std::string::npos) {
      section = &sections[line.substr(1, line.find(']') - 1)];
      setting = nullptr;
    } else if (section != nullptr && !indented && sign != std::string::npos) {
      setting = &(*section)[text::in_small_letters(text::trimmed(line.substr(0, sign)))];
      *setting = {text::trimmed(line.substr(sign + 1)), {}, number};
    } else if (setting != nullptr && (indented || sign == std::string::npos)) {  // parts_of() trims
      setting->more.emplace_back(line, number);
    }
  }
  return sections;
}

constexpr std::string_view kMesh = "bed_mesh ";

std::vector<std::string> names_of_meshes(const std::map<std::string, Section>& sections) {
  std::vector<std::string> names;
  for (const auto& [name, section] : sections)
    if (name.starts_with(kMesh) && section.contains("points")) names.push_back(name.substr(kMesh.size()));
  return names;
}

/// The mesh that the user names, the only one, or "default".
std::string mesh_name(const std::map<std::string, Section>& sections, const std::string& file,
                      const std::string& profile) {
  const std::vector<std::string> names = names_of_meshes(sections);
  const auto has = [&](const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  if (!profile.empty() && has(profile)) return profile;
  if (profile.empty() && names.size() == 1) return names.front();
  if (profile.empty() && has("default")) return "default";
  throw text::InputError({file, 0}, profile.empty() ? "--profile" : profile,
                         names.empty() ? "the file has no saved mesh (section [bed_mesh NAME] with points)"
                                       : "the file has these meshes: " + text::joined(names, ", ") +
                                             "; name one with --profile");
}

/// A range from a larger to a smaller position would mirror the mesh.
void expect_rising(const text::Place& place, const std::string& axis, double low, double high) {
  if (low > high)
    throw text::InputError(
        place, axis,
        fmt::format("the smallest position {:g} is larger than the largest position {:g}", low, high));
}

class Mesh {
 public:
  Mesh(const std::map<std::string, Section>& sections, const std::string& file, const std::string& name)
      : section_(sections.at(std::string(kMesh) + name)), file_(file) {}

  std::vector<Touch> touches(const std::array<double, 2>& offset) const {
    const std::size_t columns = count("x_count"), rows = count("y_count");
    const Setting& points = setting("points");
    if (points.more.size() != rows)
      throw text::InputError(
          {file_, points.line}, "points",
          fmt::format("the mesh has {} rows, but y_count states {}", points.more.size(), rows));
    for (const auto& [low, high] : {std::pair("min_x", "max_x"), std::pair("min_y", "max_y")})
      expect_rising({file_, setting(low).line}, low, at(low), at(high));
    std::vector<Touch> touches;
    for (std::size_t j = 0; j < rows; ++j) {
      const auto& [line, number] = points.more[j];
      const std::vector<double> heights = numbers_in({file_, number}, line);
      if (heights.size() != columns)
        throw text::InputError(
            {file_, number}, line.substr(0, 30),
            fmt::format("this line has {} numbers, but x_count states {}", heights.size(), columns));
      for (std::size_t i = 0; i < columns; ++i) {
        Touch touch;
        touch.axes = {station(at("min_x"), at("max_x"), columns, i) - offset[0],
                      station(at("min_y"), at("max_y"), rows, j) - offset[1], heights[i]};
        touch.line = number;
        touches.push_back(std::move(touch));
      }
    }
    return touches;
  }

 private:
  const Setting& setting(const std::string& name) const {
    const auto found = section_.find(name);
    if (found == section_.end())
      throw text::InputError({file_, 0}, name, "the saved mesh lacks this setting");
    return found->second;
  }
  double at(const std::string& name) const {
    const Setting& found = setting(name);
    return number_in({file_, found.line}, found.value);
  }
  std::size_t count(const std::string& name) const {
    const Setting& found = setting(name);
    return count_in({file_, found.line}, found.value);
  }

  const Section& section_;
  const std::string& file_;
};

/// The file states the points that a probe touched, and not the offset of the probe.
[[noreturn]] void refuse_without_offset(const std::string& file) {
  throw text::InputError(
      {file, 0}, "--offset",
      "the file states the points that the probe touched, but not the offset of the probe from the nozzle: "
      "give --offset=X,Y in mm (Klipper: x_offset and y_offset of the configuration; Marlin: M851; "
      "RepRapFirmware: G31), or --offset=0,0 if the nozzle itself touches");
}

/// True if the file has the configuration of a probe: without x_offset and y_offset its offset is then 0.
bool configures_probe(const std::map<std::string, Section>& sections) {
  return std::any_of(sections.begin(), sections.end(), [](const auto& one) {
    return !one.first.starts_with(kMesh) &&
           (one.second.contains("x_offset") || one.second.contains("y_offset") ||
            one.second.contains("z_offset"));
  });
}

/// Offset of the probe in the configuration, if it has one. Throws InputError if two sections give different
/// offsets: nothing in the file says with which probe the mesh was measured.
std::array<double, 2> offset_in(const std::map<std::string, Section>& sections, const std::string& file) {
  std::array<double, 2> offset = {};
  std::string of;  // the section that gives the offset
  for (const auto& [name, section] : sections) {
    if (name.starts_with(kMesh)) continue;
    std::array<double, 2> own = {};
    std::size_t line = 0;
    for (std::size_t k = 0; k < 2; ++k)
      if (const auto found = section.find(k == 0 ? "x_offset" : "y_offset"); found != section.end()) {
        line = found->second.line;
        own[k] = number_in({file, line}, found->second.value);
      }
    if (line == 0) continue;
    if (!of.empty() && own != offset)
      throw text::InputError({file, line}, name,
                             fmt::format("the sections [{}] and [{}] give different offsets of a probe; give "
                                         "the offset of the probe that measured the mesh with --offset=X,Y",
                                         of, name));
    offset = own;
    of = name;
  }
  if (of.empty())
    for (const auto& [name, section] : sections)
      if (name.starts_with("include "))
        throw text::InputError(
            {file, 0}, name,
            "the offset of the probe may be in this other file: state it with --offset=X,Y "
            "(0,0 if the nozzle itself touches)");
  return offset;
}

// ---- Klipper: the zero of the heights

/// z_offset of a probe in a configuration: the height of the nozzle at which the probe triggers on the bed.
struct ZOffset {
  std::string section;
  std::string shown;  // the number as the configuration has it
  double mm = 0;
};

/// Throws InputError if two sections give different values: nothing says which probe touched. `before`: lines
/// of the file before the configuration.
std::optional<ZOffset> z_offset_in(const std::string& text, const std::string& file, std::size_t before) {
  std::optional<ZOffset> result;
  for (const auto& [name, section] : sections_of(text)) {
    const auto found = section.find("z_offset");
    if (name.starts_with(kMesh) || found == section.end()) continue;
    const text::Place place{file, before + found->second.line};
    const ZOffset own{name, found->second.value, number_in(place, found->second.value)};
    if (result && result->mm != own.mm)
      throw text::InputError(
          place, name,
          fmt::format("the sections [{}] and [{}] give different z_offset of a probe; give the offset of the "
                      "probe that touched with --offset=X,Y,Z",
                      result->section, name));
    result = own;
  }
  return result;
}

/// The z_offset of each configuration in a log, by the number of lines before the configuration. A restart of
/// the printer writes the configuration again.
std::map<std::size_t, ZOffset> z_offsets_in(const std::string& text, const std::string& file) {
  std::map<std::size_t, ZOffset> result;
  std::string block;
  std::size_t number = 0, begin = 0;
  const auto end_block = [&] {
    if (const auto found = z_offset_in(block, file, begin)) result.emplace(begin, *found);
    block.clear();
    begin = number;
  };
  for (const std::string& line : text::parts_of(text, '\n')) {
    if (line.find("= Config file =") != std::string::npos) end_block();
    block += line + '\n';
    ++number;
  }
  end_block();
  return result;
}

// ---- Klipper: compensation of the axis twist

/// Heights that klippy/extras/axis_twist_compensation.py adds to the touches of the probe, over X.
class AxisTwist {
 public:
  AxisTwist(const std::map<std::string, Section>& sections, const std::string& file) {
    const auto section = sections.find("axis_twist_compensation");
    if (section == sections.end()) return;
    const auto values = section->second.find("z_compensations");
    if (values == section->second.end()) return;
    // Older versions have the range under the names of the calibration.
    const auto range = [&](std::initializer_list<const char*> names) {
      for (const char* const name : names)
        if (const auto found = section->second.find(name); found != section->second.end())
          return number_in({file, found->second.line}, found->second.value);
      throw text::InputError({file, values->second.line}, *names.begin(),
                             "the section [axis_twist_compensation] with z_compensations lacks this setting");
    };
    add_ = numbers_in({file, values->second.line}, values->second.value);
    low_ = range({"compensation_start_x", "calibrate_start_x", "start_x"});
    high_ = range({"compensation_end_x", "calibrate_end_x", "end_x"});
    if (add_.size() < 2 || !(high_ > low_))
      throw text::InputError({file, values->second.line}, "z_compensations",
                             "the compensation needs two values or more, and a range of X that rises");
  }
  explicit operator bool() const { return !add_.empty(); }
  /// The first and the last interval continue beyond their ends, as in Klipper.
  double at(double x) const {
    const double share = (x - low_) / (high_ - low_) * static_cast<double>(add_.size() - 1);
    const double first = std::clamp(std::floor(share), 0.0, static_cast<double>(add_.size() - 2));
    const auto i = static_cast<std::size_t>(first);
    return add_[i] + (share - first) * (add_[i + 1] - add_[i]);
  }

 private:
  std::vector<double> add_;
  double low_ = 0, high_ = 0;
};

// ---- RepRapFirmware: height map

constexpr std::string_view kHeightMap = "RepRapFirmware height map file v2";

/// Columns of the second line: in the present version with the names of the axes before them.
struct HeightMapGrid {
  double low[2], high[2], spacing[2];
  std::size_t count[2];

  /// Position of a point: the last one can be before the maximum.
  double at(std::size_t axis, std::size_t i) const {
    return low[axis] + spacing[axis] * static_cast<double>(i);
  }
};

HeightMapGrid grid_of(const text::Place& place, const std::string& labels, const std::string& values) {
  const auto names = text::parts_of(labels, ','), words = text::parts_of(values, ',');
  if (names.size() != words.size())
    throw text::InputError(place, values.substr(0, 30),
                           "the line has another number of values than the labels");
  const auto value = [&](std::string_view a, std::string_view b) -> std::string {
    for (std::size_t i = 0; i < names.size(); ++i) {
      const std::string name = text::trimmed(names[i]);
      if (name == a || name == b) return words[i];
    }
    throw text::InputError(place, std::string(a), "the height map lacks this value");
  };
  for (std::size_t i = 0; i < names.size(); ++i)
    for (const auto& [label, axis] : {std::pair("axis0", "X"), std::pair("axis1", "Y")})
      if (text::trimmed(names[i]) == label && text::trimmed(words[i]) != axis)
        throw text::InputError(place, words[i], "only height maps over X and Y are read");
  HeightMapGrid grid{};
  grid.low[0] = number_in(place, value("min0", "xmin")),
  grid.high[0] = number_in(place, value("max0", "xmax"));
  grid.low[1] = number_in(place, value("min1", "ymin")),
  grid.high[1] = number_in(place, value("max1", "ymax"));
  grid.spacing[0] = number_in(place, value("spacing0", "xspacing"));
  grid.spacing[1] = number_in(place, value("spacing1", "yspacing"));
  for (std::size_t k = 0; k < 2; ++k)
    expect_rising(place, k == 0 ? "min0" : "min1", grid.low[k], grid.high[k]);
  grid.count[0] = count_in(place, value("num0", "xnum")),
  grid.count[1] = count_in(place, value("num1", "ynum"));
  for (std::size_t k = 0; k < 2; ++k) {
    const double beyond = grid.at(k, grid.count[k] - 1) - grid.high[k];
    if (!(grid.spacing[k] > 0) || beyond > grid.spacing[k] / 2)
      throw text::InputError(place, k == 0 ? "num0" : "num1",
                             "spacing and number of points reach beyond the maximum of this axis");
  }
  return grid;
}

/// Spacing as the file states it: the last point can lie before the maximum.
void add_height_map(const std::string& text, const std::string& file, const std::array<double, 2>& offset,
                    PrinterFile& result, std::vector<Touch>& touches) {
  const std::vector<std::string> lines = text::parts_of(text, '\n');
  if (lines.size() < 3)
    throw text::InputError({file, 1}, "height map", "the file ends after the title line of the height map");
  const HeightMapGrid grid = grid_of({file, 3}, lines[1], lines[2]);
  if (lines.size() < 3 + grid.count[1])
    throw text::InputError(
        {file, lines.size()}, "height map",
        fmt::format("the height map has fewer than the {} rows that its header states", grid.count[1]));
  for (std::size_t j = 0; j < grid.count[1]; ++j) {
    const text::Place place{file, 4 + j};
    const std::vector<std::string> cells = text::parts_of(lines[3 + j], ',');
    if (cells.size() != grid.count[0])
      throw text::InputError(place, lines[3 + j].substr(0, 30),
                             fmt::format("this line has {} numbers, but the height map has {} columns",
                                         cells.size(), grid.count[0]));
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const std::string cell = text::trimmed(cells[i]);
      if (cell == "0") {  // a reading has decimals
        ++result.not_probed;
        continue;
      }
      Touch touch;
      touch.axes = {grid.at(0, i) - offset[0], grid.at(1, j) - offset[1], number_in(place, cell)};
      touch.line = place.line;
      touches.push_back(std::move(touch));
    }
  }
}

// ---- logs

/// Number that begins at `at`; moves `at` behind it.
std::optional<double> number_at(const std::string& line, std::size_t& at) {
  while (at < line.size() && line[at] == ' ') ++at;
  const std::size_t end = std::min(line.find_first_not_of("+-.0123456789eE", at), line.size());
  const auto value = text::parse_number(std::string_view(line).substr(at, end - at));
  at = end;
  return value;
}

/// Three numbers, each directly behind its text.
using Form = std::array<std::string_view, 3>;

/// The numbers of a line of this form. nullopt: the line has another form. Throws InputError if the first
/// number is there and the line is not understood to its end: a decimal comma would be read as two numbers.
std::optional<Point> point_in(const std::string& line, const Form& form, const text::Place& place) {
  std::size_t at = line.find(form[0]);
  if (at == std::string::npos) return std::nullopt;
  Point point{};
  for (std::size_t k = 0; k < form.size(); ++k) {
    while (k > 0 && at < line.size() && line[at] == ' ') ++at;
    const std::string_view text = form[k][0] == ' ' ? form[k].substr(1) : form[k];
    const bool there = k == 0 || line.compare(at, text.size(), text) == 0;
    at += k == 0 ? form[0].size() : text.size();
    const auto number = there ? number_at(line, at) : std::nullopt;
    const bool cut = number && k + 1 == form.size() && at < line.size() && line[at] == ',';
    if (number && !cut) {
      point[k] = *number;
      continue;
    }
    if (k == 0 || line.find(form[2]) == std::string::npos) return std::nullopt;
    throw text::InputError(place, text::trimmed(line).substr(0, 60),
                           "this line of a touch is not understood; numbers need a decimal point");
  }
  return point;
}

/// A touch of a log: the position of the axes, or the place that the probe touched.
struct LoggedTouch {
  Point point;
  bool of_probe = false;
};

std::optional<LoggedTouch> touch_in(const std::string& line, const text::Place& place) {
  // Klipper's older line has the position of the nozzle; its newer one and Marlin's G30 have the place of the
  // probe.
  static constexpr std::pair<Form, bool> kForms[] = {{{"probe at ", ",", " is z="}, false},
                                                     {{"probe: at ", ",", " bed will contact at z="}, true},
                                                     {{"Bed X:", "Y:", "Z:"}, true}};
  for (const auto& [form, of_probe] : kForms)
    if (const auto point = point_in(line, form, place)) return LoggedTouch{*point, of_probe};
  return std::nullopt;
}

/// Time of a line "Stats 1000.5: …".
std::optional<double> time_of_state(const std::string& line) {
  constexpr std::string_view kStats = "Stats ";
  if (!line.starts_with(kStats)) return std::nullopt;
  std::size_t at = kStats.size();
  return number_at(line, at);
}

class ProbeLog {
 public:
  ProbeLog(PrinterFile& result, const std::string& file, const PrinterOptions& options)
      : result_(result), file_(file), options_(options) {}

  std::vector<Touch> read(const std::string& text) {
    std::size_t number = 0;
    for (const std::string& line : text::parts_of(text, '\n')) {
      ++number;
      if (const auto time = time_of_state(line))
        state(line, *time);
      else if (const auto one = touch_in(line, {file_, number}))
        touch(*one, line, number);
      else
        remark(text::in_small_letters(line));
    }
    cut_off_ = touches_.size() > begin_of(series_.size());
    end_series();
    take_offset(text);
    // One clock for all surveys of a log: the second survey of the bed does not begin at 0 s.
    const double begin = touches_.empty() ? 0 : touches_.front().t;
    for (Touch& one : touches_) one.t -= begin;
    // Without a line that ends a survey, the temperature alone tells the surveys.
    if (series_.size() < 2)
      if (const auto ends = ends_by_temperature(); ends.size() > 1) series_ = ends;
    configured_ = configured_points(text);
    note_begun_again();
    note_incomplete();
    std::vector<Touch> touches = chosen();
    take_zero(touches, text);
    return touches;
  }

 private:
  /// Number of points of a survey by the configuration in the log; 0: the log has none.
  std::size_t configured_points(const std::string& text) const {
    const auto sections = sections_of(text);
    const auto mesh = sections.find("bed_mesh");
    if (mesh == sections.end()) return 0;
    const auto setting = mesh->second.find("probe_count");
    if (setting == mesh->second.end()) return 0;
    std::size_t points = 1, numbers = 0;
    for (const std::string& word : text::words_in(setting->second.value, ", \t")) {
      const auto count = text::parse_count(word);
      if (!count) return 0;
      points *= *count;
      ++numbers;
    }
    return numbers == 1 ? points * points : numbers == 2 ? points : 0;
  }

  /// Numbers of the different points of each survey.
  std::size_t points_of(std::size_t first, std::size_t end) const {
    std::set<std::pair<double, double>> points;
    for (std::size_t i = first; i < end; ++i) points.emplace(touches_[i].axes[0], touches_[i].axes[1]);
    return points.size();
  }

  /// Notes a survey whose first point is touched again after other points, at the same temperature: the
  /// touches before are those of a survey that was stopped.
  void note_begun_again() {
    std::size_t first = 0;
    for (std::size_t k = 0; k < series_.size(); ++k) {
      std::size_t begin = first;
      for (std::size_t i = first + 1; i < series_[k]; ++i) {
        const bool again =
            touches_[i].axes[0] == touches_[begin].axes[0] && touches_[i].axes[1] == touches_[begin].axes[1];
        const bool moved =
            touches_[i - 1].axes[0] != touches_[i].axes[0] || touches_[i - 1].axes[1] != touches_[i].axes[1];
        if (!again || !moved || i - begin < kFewestTouches) continue;
        result_.notes.push_back(fmt::format(
            "line {}: the survey that began in line {} begins again at its first point: the {} touches "
            "before may "
            "be of a survey that was stopped, and are read too; to read the complete survey alone, delete "
            "the "
            "lines {} to {} of the log",
            touches_[i].line, touches_[begin].line, i - begin, touches_[begin].line, touches_[i - 1].line));
        begin = i;
      }
      first = series_[k];
    }
  }

  /// Notes a survey with fewer points than the configuration states, or than another survey of the log.
  void note_incomplete() {
    std::size_t most = configured_, first = 0;
    for (const std::size_t end : series_) {
      most = std::max(most, points_of(first, end));
      first = end;
    }
    first = 0;
    for (std::size_t k = 0; k < series_.size(); ++k) {
      const std::size_t points = points_of(first, series_[k]);
      if (points < most)
        result_.notes.push_back(fmt::format(
            "survey {} (from line {}) has {} of {} points{}; the other points of the bed are not in the file",
            k + 1, touches_[first].line, points, most,
            cut_off_ && series_[k] == touches_.size() ? ": the log may end before the survey" : ""));
      first = series_[k];
    }
  }

  /// "heater_bed: target=60 temp=59.9 pwm=0.3" names a temperature.
  void state(const std::string& line, double t) {
    now_.t = t;
    std::string name;
    for (const std::string& word : text::words_in(line, " \t\r")) {
      if (word.ends_with(':')) name = word.substr(0, word.size() - 1);
      if (!word.starts_with("temp=") || !text::is_name(name)) continue;
      if (const auto value = text::parse_number(std::string_view(word).substr(5)))
        now_.temperature[name] = *value;
    }
  }

  void touch(const LoggedTouch& logged, const std::string& line, std::size_t number) {
    const Point& point = logged.point;
    const std::string words = text::in_small_letters(line);
    if (words.find("discarded") != std::string::npos || words.find("skipped") != std::string::npos) {
      ++result_.left_out;
      return;
    }
    Touch one = now_;
    one.axes = point;
    one.line = number;
    const bool elsewhere =
        touches_.empty() || touches_.back().axes[0] != point[0] || touches_.back().axes[1] != point[1];
    if (elsewhere) first_of_point_ = touches_.size();
    one.of_probe = logged.of_probe;
    touches_.push_back(std::move(one));
  }

  /// "Probe samples exceed tolerance. Retrying...": the printer drops its touches of this point and begins
  /// again. "Result is z=…" ends a point.
  void remark(const std::string& words) {
    const auto has = [&](const char* part) { return words.find(part) != std::string::npos; };
    if (has("result is z")) first_of_point_ = touches_.size();
    if (has("retrying")) leave_out_from(first_of_point_);
    // Levelling of the gantry or the bed, and repeats at one place: no survey of the bed.
    if (has("gantry-relative") || has("making the following z") || has("probe accuracy results") ||
        has("z-tilt") || has("retries:"))
      leave_out_from(begin_of(series_.size()));
    if (has("mesh bed leveling complete") || has("mesh has been saved") || has("bed mesh generated"))
      end_series();
  }

  void leave_out_from(std::size_t first) {
    result_.left_out += touches_.size() - first;
    touches_.resize(first);
    first_of_point_ = first;
  }

  /// Index of the first touch of a survey of the bed; after the last survey, of the touches of none.
  std::size_t begin_of(std::size_t k) const { return k == 0 ? 0 : series_[k - 1]; }

  /// Ends a survey of the bed: later touches may be of another state of the bed.
  void end_series() {
    if (touches_.size() > begin_of(series_.size())) series_.push_back(touches_.size());
    first_of_point_ = touches_.size();
  }

  /// The axes stood at the place of the probe less its offset.
  void take_offset(const std::string& text) {
    const bool of_probe =
        std::any_of(touches_.begin(), touches_.end(), [](const Touch& one) { return one.of_probe; });
    result_.offset_mm = {};
    if (options_.offset_mm) {
      result_.offset_mm = *options_.offset_mm;
    } else {
      const auto sections = sections_of(text);
      const bool known = configures_probe(sections);
      if (of_probe || known) result_.offset_mm = offset_in(sections, file_);
      if (of_probe && !known) refuse_without_offset(file_);
      result_.offset_known = known;
    }
    for (Touch& one : touches_)
      for (std::size_t k = 0; one.of_probe && k < 2; ++k) one.axes[k] -= result_.offset_mm[k];
  }

  /// Klipper's older line has the height of the nozzle at which the probe triggered. The bed is lower by the
  /// z_offset of the probe: the firmware subtracts it when it makes a mesh of these touches.
  void take_zero(std::vector<Touch>& touches, const std::string& text) {
    const auto stated = options_.z_offset_mm ? std::map<std::size_t, ZOffset>{} : z_offsets_in(text, file_);
    std::string used;  // the last configuration that was named
    double sum = 0;
    std::size_t unknown = 0;
    for (Touch& one : touches) {
      if (one.of_probe) continue;
      if (options_.z_offset_mm) {
        one.axes[2] -= *options_.z_offset_mm;
        result_.zero = fmt::format("the z_offset {:g} of --offset is subtracted from the heights",
                                   *options_.z_offset_mm);
        continue;
      }
      auto valid = stated.lower_bound(one.line);  // the first configuration behind the touch
      if (valid != stated.begin()) --valid;
      if (valid == stated.end()) {
        sum += one.axes[2];
        ++unknown;
        continue;
      }
      one.axes[2] -= valid->second.mm;
      const std::string name = fmt::format("z_offset {} of [{}]", valid->second.shown, valid->second.section);
      if (name == used) continue;
      result_.zero += result_.zero.empty()
                          ? name + " is subtracted from the heights"
                          : fmt::format("; from line {} on, {} is subtracted", one.line, name);
      used = name;
    }
    if (unknown == 0) return;
    result_.zero_known = false;
    result_.zero = fmt::format(
        "the zero of the heights is not known: the lines \"probe at X,Y is z=Z\" state the height at which "
        "the "
        "probe triggered (mean {:.3f} mm), and the file has no z_offset of the probe. If the configuration "
        "of "
        "the printer has a z_offset, give it with --offset=X,Y,Z",
        sum / static_cast<double>(unknown));
  }

  /// The largest difference of a temperature between two touches, degC.
  static double heated(const Touch& one, const Touch& other) {
    double most = 0;
    for (const auto& [name, value] : one.temperature)
      if (const auto found = other.temperature.find(name); found != other.temperature.end())
        most = std::max(most, std::abs(value - found->second));
    return most;
  }

  /// True if two surveys begin at the same point, at different temperatures.
  static bool at_other_temperature(const Touch& begin, const Touch& other) {
    constexpr double kSamePoint = 0.01;  // mm
    constexpr double kHeated = 3;        // degC, above the control of a heater
    return std::abs(other.axes[0] - begin.axes[0]) <= kSamePoint &&
           std::abs(other.axes[1] - begin.axes[1]) <= kSamePoint && heated(begin, other) >= kHeated;
  }

  /// True if the surveys are of one bed that is heated: each has another temperature than the one before it.
  bool differ_by_temperature() const {
    for (std::size_t k = 1; k < series_.size(); ++k)
      if (!at_other_temperature(touches_[begin_of(k - 1)], touches_[begin_of(k)])) return false;
    return true;
  }

  /// Ends of the surveys: a touch at the first point of a survey again, at another temperature.
  std::vector<std::size_t> ends_by_temperature() const {
    std::vector<std::size_t> ends;
    std::size_t first = 0;
    for (std::size_t i = 1; i < touches_.size(); ++i) {
      if (i - first < kFewestTouches || !at_other_temperature(touches_[first], touches_[i])) continue;
      ends.push_back(i);
      first = i;
    }
    if (!touches_.empty()) ends.push_back(touches_.size());
    return ends;
  }

  /// "1 (25 touches from line 3, heater_bed 60 degC)" for each survey.
  std::string list_of(const std::vector<std::size_t>& ends) const {
    std::string list;
    std::size_t first = 0;
    for (std::size_t k = 0; k < ends.size(); ++k) {
      const Touch& begin = touches_[first];
      const auto bed = begin.temperature.find("heater_bed");
      list += fmt::format(
          "{}{} ({} touches from line {}{})", k == 0 ? "" : ", ", k + 1, ends[k] - first, begin.line,
          bed == begin.temperature.end() ? "" : fmt::format(", bed at {:.0f} degC", bed->second));
      first = ends[k];
    }
    return list;
  }

  /// The touches of the survey that the user names; without a name those of all surveys, if there is one or
  /// if their temperatures tell them apart.
  std::vector<Touch> chosen() {
    using Survey = PrinterOptions::Survey;
    const std::string list = list_of(series_);
    if (const auto* const number = std::get_if<std::size_t>(&options_.series)) {
      if (*number < 1 || *number > series_.size())
        throw text::InputError(
            {file_, 0}, std::to_string(*number),
            fmt::format("the log has no survey of this number: the surveys of the bed are {}",
                        list.empty() ? "none" : list));
      return {touches_.begin() + static_cast<std::ptrdiff_t>(begin_of(*number - 1)),
              touches_.begin() + static_cast<std::ptrdiff_t>(series_[*number - 1])};
    }
    if (series_.size() < 2) return touches_;
    if (std::get<Survey>(options_.series) != Survey::kAll && !differ_by_temperature())
      throw text::InputError(
          {file_, touches_[series_[0]].line}, "touches",
          fmt::format("the log has several surveys of the bed, which may differ: {}; choose one with "
                      "--series, or state --series all if the bed was not levelled between them",
                      list));
    result_.surveys = list;
    return touches_;
  }

  static constexpr std::size_t kFewestTouches = 4;  // of a survey of a bed
  PrinterFile& result_;
  const std::string& file_;
  const PrinterOptions& options_;
  std::size_t configured_ = 0;  // points of a survey
  bool cut_off_ = false;        // no line of the log ends the last survey
  Touch now_;                   // time and temperatures of the last state
  std::vector<Touch> touches_;
  std::size_t first_of_point_ = 0;   // index of the first touch of the present point
  std::vector<std::size_t> series_;  // ends of the surveys of the bed
};

// ---- the table

ImportTable table_of(const std::string& file, const std::vector<Touch>& touches,
                     const std::array<double, 2>& probe, const PrinterOptions& options) {
  ImportTable table;
  table.file = file;
  const auto add = [&](const std::string& name, const std::string& unit, const auto& value_of) {
    std::vector<double> values;
    for (const Touch& touch : touches) values.push_back(value_of(touch));
    table.add(name, unit, values);
  };
  for (const Touch& touch : touches) table.line.push_back(touch.line);
  const char* const names[] = {"X", "Y", "Z"};
  for (std::size_t k = 0; k < 3; ++k) add(names[k], "mm", [&](const Touch& touch) { return touch.axes[k]; });
  if (probe[0] != 0 || probe[1] != 0)
    for (std::size_t k = 0; k < 2; ++k)
      add(format::columns::kProbe[k], "mm", [&](const Touch&) { return probe[k]; });
  table.columns.push_back(
      {format::columns::kOn, "", std::vector<std::string>(touches.size(), options.artefact)});
  if (options.u_um) add(format::columns::kUncertainty, "um", [&](const Touch&) { return *options.u_um; });
  const auto all = [&](const auto& has) { return std::all_of(touches.begin(), touches.end(), has); };
  if (all([](const Touch& touch) { return !std::isnan(touch.t); }))
    add(format::columns::kTime, "s", [](const Touch& touch) { return touch.t; });
  for (const auto& [name, first] : touches.front().temperature)
    if (all([&, key = name](const Touch& touch) { return touch.temperature.contains(key); }))
      add("T_" + name, "degC", [&, key = name](const Touch& touch) { return touch.temperature.at(key); });
  return table;
}

/// A note with the rotation_distance of X, Y and Z, if the configuration has all three: export needs them.
std::string note_of_steps(const std::map<std::string, Section>& sections) {
  std::vector<std::string> values;
  for (const char* const stepper : {"stepper_x", "stepper_y", "stepper_z"}) {
    const auto section = sections.find(stepper);
    if (section == sections.end()) return {};
    const auto setting = section->second.find("rotation_distance");
    if (setting == section->second.end() || !text::parse_number(setting->second.value)) return {};
    values.push_back(setting->second.value);
  }
  return fmt::format(
      "the rotation_distance of the configuration is {0} (X,Y,Z, mm): with --steps {0}, export klipper also "
      "corrects measured scales of the axes",
      text::joined(values, ","));
}

/// Touches of the probe as touches of the nozzle at the touched points.
void take_as_nozzle(std::vector<Touch>& touches, const AxisTwist& twist, const PrinterOptions& options,
                    const std::array<double, 2>& offset) {
  for (Touch& touch : touches) {
    for (std::size_t k = 0; k < 2; ++k) touch.axes[k] += offset[k];
    if (options.twist == PrinterOptions::Twist::kAdd) touch.axes[2] += twist.at(touch.axes[0]);
  }
}

}  // namespace

bool is_printer_file(const std::string& bytes) {
  const std::string text = sheet::utf8_text(bytes);
  const auto has = [&](const std::string& mark) { return text.find(mark) != std::string::npos; };
  return text.starts_with(kHeightMap) || has('[' + std::string(kMesh)) || has("probe at ") ||
         has("probe: at ") || has("Bed X:");
}

PrinterFile read_printer_file(const std::string& text, const std::string& file,
                              const PrinterOptions& options) {
  PrinterFile result;
  std::vector<Touch> touches;
  result.offset_mm = options.offset_mm.value_or(std::array<double, 2>{});
  if (text.starts_with(kHeightMap)) {
    result.kind = PrinterFile::Kind::kHeightMap;
    if (!options.offset_mm) refuse_without_offset(file);
    add_height_map(text, file, result.offset_mm, result, touches);
  } else if (text.find("probe at ") == std::string::npos && text.find("probe: at ") == std::string::npos &&
             text.find('[' + std::string(kMesh)) != std::string::npos) {
    const auto sections = sections_of(text);
    result.kind = PrinterFile::Kind::kSavedMesh;
    result.name = mesh_name(sections, file, options.profile);
    if (const auto names = names_of_meshes(sections); options.profile.empty() && names.size() > 1)
      result.notes.push_back(fmt::format(
          "the file has {} saved meshes ({}), and \"{}\" is read; to read another one, give --profile NAME",
          names.size(), text::joined(names, ", "), result.name));
    if (!options.offset_mm) result.offset_mm = offset_in(sections, file);
    const bool alone = std::all_of(sections.begin(), sections.end(),
                                   [](const auto& one) { return one.first.starts_with(kMesh); });
    if (!options.offset_mm && alone) refuse_without_offset(file);
    touches = Mesh(sections, file, result.name).touches(result.offset_mm);
    if (std::string note = note_of_steps(sections); !note.empty()) result.notes.push_back(std::move(note));
  } else {
    touches = ProbeLog(result, file, options).read(text);
  }
  if (options.z_offset_mm && result.zero.empty())
    throw text::InputError({file, 0}, "--offset",
                           "the heights of this file have the zero of the nozzle already: a third number of "
                           "--offset is only for "
                           "a log with lines \"probe at X,Y is z=Z\"; give --offset=X,Y");
  if (touches.empty())
    throw text::InputError(
        {file, 0}, "touches",
        "the file has no touches: it is no configuration with a saved mesh (Klipper), no log with lines "
        "\"probe at X,Y is z=Z\" or \"Bed X: X Y: Y Z: Z\", and no heightmap.csv of RepRapFirmware");
  std::array<double, 2> probe = result.offset_mm;
  if (result.kind != PrinterFile::Kind::kHeightMap && options.twist != PrinterOptions::Twist::kIgnore) {
    const AxisTwist twist(sections_of(text), file);
    if (!twist && options.twist == PrinterOptions::Twist::kAdd)
      throw text::InputError({file, 0}, "--twist",
                             "the file has no z_compensations in a section [axis_twist_compensation]");
    if (twist && (probe[0] != 0 || probe[1] != 0)) {
      result.twist = true;
      take_as_nozzle(touches, twist, options, probe);
      probe = {};
    }
  }
  result.table = table_of(file, touches, probe, options);
  return result;
}

}  // namespace vernier::importer
