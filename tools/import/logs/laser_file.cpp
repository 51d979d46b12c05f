// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/logs/laser_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <vector>

#include "tools/format/columns.h"
#include "tools/import/words/sheet_words.h"
#include "tools/text/error.h"
#include "tools/text/numbers.h"
#include "tools/text/words.h"

namespace vernier::importer {
namespace {

struct LaserReading {
  std::size_t target = 0, line = 0;
  double deviation_um = 0;
};

/// The unchanged contents of the file.
struct LaserText {
  std::map<std::string, std::string> said;  // key in small letters: value
  std::vector<double> targets_mm;
  std::map<std::size_t, std::vector<LaserReading>> runs;
  std::optional<std::size_t> target_count, run_count;
  std::optional<bool> one_sense;  // the second flag
  text::Place targets_at, runs_at, axis_at;
};

class LaserReader {
 public:
  LaserReader(const std::string& text, const std::string& file) : text_(text), file_(file) {}

  LaserText read() {
    std::size_t number = 0;
    for (const std::string& raw : text::parts_of(text_, '\n')) {
      place_ = {file_, ++number};
      const std::string line = text::trimmed(raw);
      if (line.empty()) continue;
      if (line.ends_with("::"))
        begin(text::in_small_letters(line.substr(0, line.size() - 2)));
      else
        take(line);
    }
    for (const char* section : {"header", "target data", "deviations"})
      if (!sections_.contains(section))
        throw text::InputError({file_, 0}, section,
                               "this section is missing: the file is not a file of linear laser runs (.rtl); "
                               "read a table with vernier import table");
    return std::move(read_);
  }

 private:
  void begin(const std::string& section) {
    section_ = section;
    collects_ = false;
    if (!sections_.insert(section).second)
      throw text::InputError(place_, section, "this section occurs twice");
  }

  void take(const std::string& line) {
    const auto colon = line.find(':');
    if (colon == std::string::npos) {
      if (section_ == "target data" && collects_) return targets(line);
      if (section_ == "deviations" && collects_) return reading(line);
      return;  // free text
    }
    const std::string key = text::in_small_letters(text::trimmed(line.substr(0, colon)));
    const std::string value = text::trimmed(line.substr(colon + 1));
    collects_ = (section_ == "target data" && key == "targets") ||
                (section_ == "deviations" && key == "run target data");
    if (collects_ && section_ == "target data") {
      read_.targets_at = place_;
      if (!value.empty()) targets(value);
    } else if (key == "target-count") {
      read_.target_count = count(value);
    } else if (key == "run-count") {
      read_.run_count = count(value);
      read_.runs_at = place_;
    } else if (key == "flags" && section_ == "target data") {
      const auto flags = text::words_in(value, " \t");
      if (flags.size() > 1) read_.one_sense = flags[1] == "1";
    } else {
      if (key == "axis") read_.axis_at = place_;
      read_.said.emplace(key, value);
    }
  }

  std::size_t count(const std::string& word) const {
    if (const auto number = text::parse_count(word)) return *number;
    throw text::InputError(place_, word, "not a count");
  }

  double number(const std::string& word) const {
    const auto value = text::parse_number(word);
    if (!value || !std::isfinite(*value)) throw text::InputError(place_, word, "not a number");
    return *value;
  }

  void targets(const std::string& line) {
    for (const std::string& word : text::words_in(line, " \t")) read_.targets_mm.push_back(number(word));
  }

  void reading(const std::string& line) {
    const std::vector<std::string> words = text::words_in(line, " \t");
    if (words.size() != 3)
      throw text::InputError(place_, line.substr(0, 30), "the line must contain run, target and deviation");
    const std::size_t run = count(words[0]), target = count(words[1]);
    if (target < 1 || target > read_.targets_mm.size())
      throw text::InputError(
          place_, words[1],
          fmt::format("this target does not exist: the file has {} targets", read_.targets_mm.size()));
    read_.runs[run].push_back({target, place_.line, number(words[2])});
  }

  const std::string& text_;
  const std::string& file_;
  text::Place place_;
  std::string section_;
  std::set<std::string> sections_;
  bool collects_ = false;
  LaserText read_;
};

/// 1 or -1 by the order of the targets in their lines, 0 for any other order.
int listed_sense(const std::vector<LaserReading>& run, const std::vector<double>& targets_mm) {
  bool up = true, down = true;
  for (std::size_t i = 1; i < run.size(); ++i) {
    const double step = targets_mm[run[i].target - 1] - targets_mm[run[i - 1].target - 1];
    up &= step > 0;
    down &= step < 0;
  }
  return run.size() < 2 || up == down ? 0 : up ? 1 : -1;
}

void check_counts(const LaserText& read, const std::string& file) {
  if (read.target_count && *read.target_count != read.targets_mm.size())
    throw text::InputError(read.targets_at, "Targets",
                           fmt::format("the section has {} targets, but the file states {}",
                                       read.targets_mm.size(), *read.target_count));
  if (read.run_count && *read.run_count != read.runs.size())
    throw text::InputError(
        read.runs_at, "Run-count",
        fmt::format("the section has {} runs, but the file states {}", read.runs.size(), *read.run_count));
  if (read.runs.empty()) throw text::InputError({file, 0}, "DEVIATIONS", "no readings");
  for (const auto& [number, run] : read.runs) {
    std::set<std::size_t> seen;
    for (const LaserReading& one : run)
      if (!seen.insert(one.target).second)
        throw text::InputError({file, one.line}, std::to_string(one.target),
                               fmt::format("this target occurs twice in run {}", number));
  }
}

/// The axis given by the user, else the axis of the file: "X", "X-AXIS", "Axis X".
std::string axis_of(const LaserText& read, const std::string& said, const std::string& file) {
  std::string found = said;
  const auto own = read.said.find("axis");
  if (found.empty() && own != read.said.end())
    for (const std::string& word : heading_words(own->second))
      if (word.size() == 1 && found.empty()) found = word;
  const std::string place_word = own == read.said.end() ? "Axis" : own->second;
  const text::Place place = own == read.said.end() ? text::Place{file, 0} : read.axis_at;
  if (found.empty())
    throw text::InputError(place, place_word,
                           "the file does not state the measured axis; give the axis with --axis X");
  if (found.size() == 1 && found[0] >= 'a' && found[0] <= 'z') found[0] = static_cast<char>(found[0] - 32);
  if (found != "X" && found != "Y" && found != "Z")
    throw text::InputError(said.empty() ? place : text::Place{}, found,
                           "only positioning along X, Y or Z can be imported; for a rotary axis these files "
                           "do not state the unit of the deviations");
  return found;
}

bool is_filler(const LaserText& read, std::size_t number, const std::vector<LaserReading>& run) {
  return read.one_sense.value_or(false) && number % 2 == 0 &&
         std::all_of(run.begin(), run.end(), [](const LaserReading& one) { return one.deviation_um == 0; });
}

}  // namespace

LaserFile read_laser_file(const std::string& text, const std::string& file, const std::string& axis,
                          RunSenses senses) {
  if (text.find('\0') != std::string::npos)
    throw text::InputError({file, 0}, "",
                           "the file has bytes of value 0: a file of dynamic capture, or not a text file");
  const LaserText read = LaserReader(text, file).read();
  check_counts(read, file);
  const auto said = [&](const char* key) {
    const auto found = read.said.find(key);
    return found == read.said.end() ? std::string() : found->second;
  };
  if (const std::string owner = said("owner"); !owner.empty() && text::in_small_letters(owner) != "linear")
    throw text::InputError(
        {file, 0}, owner,
        "this value is not of the linear measurement: the file does not state the unit of the value");
  LaserFile result{axis_of(read, axis, file),
                   said("filetype"),
                   said("machine"),
                   said("date"),
                   read.targets_mm.size(),
                   0,
                   0,
                   {file, {}, {}}};
  bool back = false;
  for (const auto& [number, run] : read.runs) back |= listed_sense(run, read.targets_mm) < 0;
  const bool both = read.one_sense && !*read.one_sense;
  if (senses == RunSenses::kAsListed && both && !back && read.runs.size() > 1)
    throw text::InputError(
        {file, read.runs.begin()->second.front().line}, "Run Target Data",
        "the flags of the file state both approach directions, but no run has decreasing targets: give "
        "--senses alternate (odd runs forward, even runs back) or --senses forward");
  const std::string small = text::in_small_letters(result.axis);
  std::vector<ImportTable::Column> columns = {
      {result.axis, "mm", {}},
      {format::axis_column(format::AxisQuantity::kSense, result.axis), "", {}},
      {format::columns::kRun, "", {}},
      {small, "mm", {}}};
  std::map<int, std::size_t> passes;
  for (const auto& [number, run] : read.runs) {
    if (is_filler(read, number, run)) {
      ++result.left_out;
      continue;
    }
    int sense = senses == RunSenses::kForward || number % 2 == 1 ? 1 : -1;
    if (senses == RunSenses::kAsListed) sense = listed_sense(run, read.targets_mm);
    if (sense == 0)
      throw text::InputError(
          {file, run.front().line}, fmt::format("run {}", number),
          "the targets of a run neither increase nor decrease: give --senses alternate or forward");
    const std::string pass = std::to_string(++passes[sense]);
    for (const LaserReading& one : run) {
      const double target = read.targets_mm[one.target - 1];
      columns[0].cells.push_back(text::number_text(target));
      columns[1].cells.push_back(std::to_string(sense));
      columns[2].cells.push_back(pass);
      // Nine decimals of a mm are below every interferometer.
      columns[3].cells.push_back(
          text::number_text(std::round((target + one.deviation_um * 1e-3) * 1e9) / 1e9));
      result.table.line.push_back(one.line);
    }
    ++result.runs;
  }
  if (result.runs == 0) throw text::InputError({file, 0}, "DEVIATIONS", "all runs are zeros");
  result.table.columns = std::move(columns);
  return result;
}

}  // namespace vernier::importer
