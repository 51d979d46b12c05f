// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/ballbar/b5r_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <pugixml.hpp>
#include <sstream>
#include <string_view>

#include "tools/import/ballbar/ballbar_file.h"
#include "tools/text/error.h"
#include "tools/text/files.h"
#include "tools/text/numbers.h"
#include "tools/text/words.h"
#include "tools/text/xml_text.h"

namespace vernier::importer {
namespace {

// Line ends are not changed: offsets count in the text as it is on disk.
constexpr unsigned kParseFlags = pugi::parse_default & ~static_cast<unsigned>(pugi::parse_eol);

class B5rReader {
 public:
  B5rReader(const std::string& path, std::string text) : path_(path), text_(std::move(text)) {
    const auto result = document_.load_buffer(text_.data(), text_.size(), kParseFlags, pugi::encoding_utf8);
    if (!result) {
      const auto at = static_cast<std::size_t>(std::max<std::ptrdiff_t>(result.offset, 0));
      throw text::InputError({path_, text::line_of(text_, at)}, word_at(at), result.description());
    }
    root_ = document_.child("TEST_DOCUMENT");
    if (!root_)
      throw text::InputError({path_, 1}, document_.first_child().name(),
                             "this file is not a ball-bar file: it must begin with TEST_DOCUMENT");
  }

  BallbarFile read() const {
    BallbarFile file;
    file.path = path_;
    file.machine = root_.child("MACHINE_TESTED").attribute("NAME").value();
    file.instrument = root_.child("EQUIPMENT").child("BALLBAR").child("MODEL").text().get();
    const pugi::xml_node bar = need(need(need(root_, "TEST_SPEC"), "INSTRUMENT"), "DYNAMIC_BALLBAR");
    read_spec(bar, file);
    const pugi::xml_node results = need(root_, "RUN_RESULTS");
    for (const auto run : results.children("BALLBAR_RUN")) file.runs.push_back(read_run(bar, run));
    if (file.runs.empty()) fail(results, "RUN_RESULTS", "the file contains no BALLBAR_RUN");
    for (const auto analysis : root_.children("ANALYSIS")) read_analysis(analysis, file);
    return file;
  }

 private:
  [[noreturn]] void fail(const pugi::xml_node& node, const std::string& word, const std::string& what) const {
    const auto offset = node.offset_debug();
    throw text::InputError({path_, offset < 0 ? 0 : text::line_of(text_, static_cast<std::size_t>(offset))},
                           word, what);
  }

  std::string word_at(std::size_t at) const {
    const auto begin = text_.find_last_of(" \t\r\n>", at == 0 ? 0 : at - 1);
    return text_.substr(begin == std::string::npos ? 0 : begin + 1, 24);
  }

  pugi::xml_node need(const pugi::xml_node& parent, const char* name) const {
    const pugi::xml_node found = parent.child(name);
    if (!found) fail(parent, name, std::string("missing in ") + parent.name());
    if (found.next_sibling(name)) fail(found.next_sibling(name), name, "given twice");
    return found;
  }

  double number(const pugi::xml_node& node) const {
    const std::string text = text::trimmed(node.text().get());
    const auto value = text::parse_number(text);
    if (!value) fail(node, text, std::string(node.name()) + " must be a number");
    return *value;
  }

  double positive(const pugi::xml_node& node) const {
    const double value = number(node);
    if (!(value > 0))
      fail(node, text::trimmed(node.text().get()), std::string(node.name()) + " must be above zero");
    return value;
  }

  std::size_t index(const pugi::xml_node& node, std::size_t count) const {
    const double value = number(node);
    if (value < 0 || value != std::floor(value) || value >= static_cast<double>(count)) {
      fail(node, text::trimmed(node.text().get()),
           fmt::format("{} is not an index of the {} readings", std::string(node.name()),
                       std::to_string(count)));
    }
    return static_cast<std::size_t>(value);
  }

  std::vector<double> numbers(const pugi::xml_node& node) const {
    const pugi::xml_node content = node.first_child();
    const std::string_view text = content.value();
    const std::ptrdiff_t offset = content.offset_debug();
    std::vector<double> values;
    for (std::size_t at = text.find_first_not_of(" \t\r\n"); at < text.size();) {
      const std::size_t end = std::min(text.find_first_of(" \t\r\n", at), text.size());
      const std::string word(text.substr(at, end - at));
      const auto value = text::parse_number(word);
      if (!value) {
        const std::size_t line = offset < 0 ? 0 : text::line_of(text_, static_cast<std::size_t>(offset) + at);
        throw text::InputError({path_, line}, word, std::string(node.name()) + " must hold numbers");
      }
      values.push_back(*value);
      at = text.find_first_not_of(" \t\r\n", end);
    }
    if (values.empty()) fail(node, node.name(), "holds no numbers");
    return values;
  }

  int direction(const pugi::xml_node& node) const {
    const std::string word = text::trimmed(node.text().get());
    if (word == "CCW") return +1;
    if (word == "CW") return -1;
    fail(node, word, "the direction must be CCW or CW");
  }

  void read_spec(const pugi::xml_node& bar, BallbarFile& file) const {
    const pugi::xml_node plane = need(bar, "PLANE");
    const std::string view = plane.attribute("VIEW").value();
    // Seen from another side, counter-clockwise would not be from +A towards +B; no such file is decoded.
    if (view != "+A+B") fail(plane, view, "the command can read only ball-bar files with the view +A+B");
    file.axis_a = text::trimmed(need(plane, "A_AXIS_NAME").text().get());
    file.axis_b = text::trimmed(need(plane, "B_AXIS_NAME").text().get());
    const auto is_linear = [](const std::string& axis) { return axis == "X" || axis == "Y" || axis == "Z"; };
    if (!is_linear(file.axis_a))
      fail(plane.child("A_AXIS_NAME"), file.axis_a, "an axis of the plane must be X, Y or Z");
    if (!is_linear(file.axis_b) || file.axis_b == file.axis_a) {
      fail(plane.child("B_AXIS_NAME"), file.axis_b,
           "the two axes of the plane must be different axes of X, Y and Z");
    }
    file.nominal_length_mm = positive(need(bar, "NOMINAL_LENGTH"));
    file.radius_mm = positive(need(bar, "TEST_RADIUS"));
    file.programmed_feed_mm_min = positive(need(bar, "PROGRAMMED_FEEDRATE"));
    const double arc_deg = number(need(bar, "END_ANGLE")) - number(need(bar, "START_ANGLE"));
    if (!(arc_deg > 0) || arc_deg > 360)
      fail(bar.child("END_ANGLE"), text::trimmed(bar.child("END_ANGLE").text().get()),
           "the angle must be 0 to 360 deg beyond START_ANGLE");
    if (arc_deg < 360)
      file.notes.push_back(
          "partial arc: the import assumes that the samples from START to END cover the arc from START_ANGLE "
          "to END_ANGLE");
  }

  BallbarRun read_run(const pugi::xml_node& bar, const pugi::xml_node& node) const {
    BallbarRun run;
    run.label = text::trimmed(need(node, "RUN_DIRECTION").text().get());
    run.direction = direction(need(node, "RUN_DIRECTION"));
    run.sample_rate_hz = positive(need(node, "SAMPLE_RATE"));
    run.first_deg = number(need(bar, "START_ANGLE"));
    run.last_deg = number(need(bar, "END_ANGLE"));
    run.reading_mm = numbers(need(node, "READINGS"));
    run.start = index(need(node, "START_INDEX"), run.reading_mm.size());
    run.end = index(need(node, "END_INDEX"), run.reading_mm.size());
    if (run.end < run.start + 2)
      fail(node.child("END_INDEX"), text::trimmed(node.child("END_INDEX").text().get()),
           "END_INDEX must be above START_INDEX by two or more");
    run.features = read_features(node);
    return run;
  }

  std::vector<BallbarFeature> read_features(const pugi::xml_node& parent) const {
    std::vector<BallbarFeature> features;
    for (const auto node : parent.children("FEATURE")) {
      if (text::trimmed(node.text().get()).empty()) continue;  // printed only if it was computed
      features.push_back({node.attribute("NAME").value(), node.attribute("DT").value(), number(node)});
    }
    return features;
  }

  void read_analysis(const pugi::xml_node& node, BallbarFile& file) const {
    file.analyses.push_back(
        {node.attribute("NAME").value(), node.attribute("version").value(), read_features(node)});
    for (const auto series : node.children("SIMULATION")) {
      const std::string name = series.attribute("NAME").value();
      file.simulations.push_back({name.substr(name.find_last_of('_') + 1), numbers(series)});
    }
  }

  std::string path_, text_;
  pugi::xml_document document_;
  pugi::xml_node root_;
};

}  // namespace

BallbarFile read_b5r(const std::string& path) { return B5rReader(path, text::read_file(path)).read(); }

}  // namespace vernier::importer
