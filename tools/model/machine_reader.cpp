// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/model/machine_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <pugixml.hpp>
#include <set>
#include <sstream>

#include "tools/format/columns.h"
#include "tools/format/readings.h"
#include "tools/format/units.h"
#include "tools/model/fit_record.h"
#include "tools/model/machine.h"
#include "tools/text/files.h"
#include "tools/text/numbers.h"
#include "tools/text/words.h"
#include "tools/text/xml_text.h"

namespace vernier::model {
namespace {

using Words = std::initializer_list<const char*>;

/// Finds an element deeper than any of the format. Functions that edit the text descend its
/// elements recursively.
struct TooDeep : pugi::xml_tree_walker {
  static constexpr int kMostDepth = 16;  // of elements; the format has five
  bool for_each(pugi::xml_node& node) override {
    if (depth() < kMostDepth) return true;
    found = node;
    return false;
  }
  pugi::xml_node found;
};

/// Walks the elements of one machine file. Every element and attribute is either read, ignored with a note,
/// or an error.
class Reader {
 public:
  Reader(const std::string& text, const std::string& file) : text_(text) {
    machine_.file = file;
    line_starts_.push_back(0);
    for (std::size_t i = 0; i < text.size(); ++i)
      if (text[i] == '\n') line_starts_.push_back(i + 1);
  }

  Machine read() {
    require_utf8();
    const pugi::xml_parse_result result = document_.load_buffer(
        text_.data(), text_.size(), pugi::parse_default | pugi::parse_doctype, pugi::encoding_utf8);
    if (!result) {
      const auto at = static_cast<std::size_t>(std::max<std::ptrdiff_t>(result.offset, 0));
      throw text::InputError({machine_.file, line_at(at)}, word_at(at), result.description());
    }
    TooDeep too_deep;
    if (!document_.traverse(too_deep))
      fail(too_deep.found, too_deep.found.name(), "the elements of the file are nested too deeply");
    pugi::xml_node root;
    for (const pugi::xml_node node : document_.children()) {
      if (node.type() == pugi::node_doctype)
        fail(node, "DOCTYPE", "a document type is not part of a machine file");
      if (node.type() != pugi::node_element)
        fail(node, node.value(), "the file has text outside the element <machine>");
      if (root) fail(node, node.name(), "the file has a second root element");
      root = node;
    }
    if (!root) throw text::InputError({machine_.file, 1}, "", "the file has no element <machine>");
    read_root(root);
    check_names();
    resolve_all();
    return std::move(machine_);
  }

 private:
  /// Other encodings would become wrong names in results, and invalid JSON.
  void require_utf8() const {
    constexpr std::size_t kStart = 64;  // bytes; every second byte of a start in UTF-16 is zero
    if (text_.starts_with("\xFF\xFE") || text_.starts_with("\xFE\xFF") ||
        std::string_view(text_).substr(0, kStart).find('\0') != std::string_view::npos)
      throw text::InputError({machine_.file, 1}, "",
                             "the file is UTF-16 or UTF-32, not UTF-8: save it as UTF-8");
    const std::string valid = text::utf8_only(text_);
    const auto [bad, other] = std::mismatch(text_.begin(), text_.end(), valid.begin(), valid.end());
    if (bad == text_.end()) return;
    const auto at = static_cast<std::size_t>(bad - text_.begin());
    throw text::InputError(
        {machine_.file, line_at(at)}, word_at(at),
        fmt::format("this letter is not UTF-8: save the file as UTF-8, or convert it: iconv -f {} -t UTF-8",
                    declared_encoding()));
  }
  /// The encoding that the first line states; without one that of Western computers.
  std::string declared_encoding() const {
    constexpr std::string_view kMark = "encoding=\"";
    const std::string first = text_.substr(0, text_.find('\n'));
    const auto at = first.find(kMark), end = first.find('"', at + kMark.size());
    const std::string name = at == std::string::npos || end == std::string::npos
                                 ? ""
                                 : first.substr(at + kMark.size(), end - at - kMark.size());
    const bool plain = std::all_of(name.begin(), name.end(), [](char c) {
      return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_';
    });
    const bool utf8 = text::in_small_letters(name) == "utf-8" || text::in_small_letters(name) == "utf8";
    return name.empty() || utf8 || !plain ? "WINDOWS-1252" : name;
  }
  void read_root(const pugi::xml_node& root) {
    if (!is(root, "machine") && !is(root, "EITransform"))
      fail(root, root.name(), "the root must be <machine> or <EITransform>");
    check_attributes(root, {"name", "gravity", "note"});
    machine_.name = attribute(root, "name").value_or("");
    if (const auto gravity = attribute(root, "gravity")) read_gravity(root, *gravity);
    std::set<std::string> branches;
    bool variables = false;
    for (const pugi::xml_node node : children(root)) {
      if (is(node, "variables")) {
        once(node, variables);
        read_variables(node);
      } else if (is(node, "transforms")) {
        read_transforms(node, branches);
      } else if (is(node, "fitted")) {
        if (machine_.fitted) fail(node, node.name(), "this element occurs twice");
        read_fitted(node);
      } else {
        unknown(node);
      }
    }
    if (machine_.tool.empty() && machine_.workpiece.empty())
      fail(root, root.name(), "the file has no element <transforms> with a transform");
  }

  FitRecord::Noise read_noise(const pugi::xml_node& node) {
    FitRecord::Noise noise;
    for (const auto& [name, value] : {std::pair{"own", &noise.own},
                                      {"pose", &noise.pose},
                                      {"run", &noise.run},
                                      {"drift", &noise.drift},
                                      {"time", &noise.time_constant},
                                      {"step", &noise.step}}) {
      *value = number(node, name, *value);
      if (*value < 0) fail_attribute(node, name, name, "the number must not be negative");
    }
    const std::string clock = attribute(node, "clock").value_or("row"),
                      unit = attribute(node, "unit").value_or("u");
    if (clock != "s" && clock != "row") fail_attribute(node, "clock", clock, "expected s or row");
    if (unit != "u" && unit != "mm") fail_attribute(node, "unit", unit, "expected u or mm");
    noise.in_time = clock == "s", noise.of_u = unit == "u";
    for (const std::string& name : text::words_in(attribute(node, "drifts").value_or(""), " ")) {
      const auto kind = format::kind_named(name);
      if (!kind) fail_attribute(node, "drifts", name, "no kind of reading has this name");
      noise.drifts |= 1U << static_cast<unsigned>(*kind);
    }
    if (!(noise.own > 0))
      fail_attribute(node, "own", "own", "the independent noise of a reading must be above 0");
    if (noise.drift > 0 && !(noise.time_constant > 0))
      fail_attribute(node, "time", "time", "a drift needs its time constant");
    return noise;
  }

  FitRecord::Alternative read_alternative(const pugi::xml_node& node) {
    FitRecord::Alternative one;
    one.workpiece = attribute(node, "branch").value_or("tool") == "workpiece";
    one.transform = static_cast<int>(number(node, "transform", 0));
    const std::string dof = attribute(node, "dof").value_or("");
    while (one.dof < 6 && dof != kSixDofNames[one.dof]) ++one.dof;
    if (one.dof == 6) fail_attribute(node, "dof", dof, "the location must be X, Y, Z, rX, rY or rZ");
    one.axis = attribute(node, "axis").value_or("");
    one.period = number(node, "period", 0);
    if (!one.axis.empty() && !(one.period > 0))
      fail_attribute(node, "period", "period", "a cyclic error must have a period");
    one.size = {number(node, "a", 0), number(node, "b", 0), number(node, "c", 0)};
    return one;
  }

  void read_fitted(const pugi::xml_node& fitted) {
    auto record = std::make_shared<FitRecord>();
    record->line = line(fitted);
    record->converged = boolean(fitted, "converged", true);
    record->rms_mm = number(fitted, "rms", 0);
    record->reach_mm = number(fitted, "reach", 0);
    record->worst = number(fitted, "worst", 0);
    record->worst_reading = attribute(fitted, "reading").value_or("");
    record->culprit = attribute(fitted, "culprit").value_or("");
    record->check_ratio = number(fitted, "check", 0);
    record->check_count = static_cast<std::size_t>(std::max(0.0, number(fitted, "check-count", 0)));
    record->worst_check = attribute(fitted, "check-reading").value_or("");
    record->disturbed = number(fitted, "disturbed", 0);
    record->disturbance = attribute(fitted, "disturbance").value_or("");
    for (const pugi::xml_node node : children(fitted)) {
      if (is(node, "measured")) {
        for (const pugi::xml_node range : children(node)) {
          no_children(range);
          record->measured.push_back({range.name(), number(range, "min", 0), number(range, "max", 0)});
        }
      } else if (is(node, "finding")) {
        no_children(node);
        record->findings.push_back({attribute(node, "code").value_or(""), number(node, "value", 0),
                                    attribute(node, "text").value_or("")});
      } else if (is(node, "discrepancy")) {
        no_children(node);
        record->discrepancy_mm = {number(node, "x", 0), number(node, "y", 0), number(node, "z", 0)};
      } else if (is(node, "unvaried")) {
        no_children(node);
        record->unvaried.push_back({attribute(node, "coefficient").value_or(""),
                                    attribute(node, "variable").value_or(""), number(node, "at", 0),
                                    attribute(node, "follows").value_or(""), number(node, "slope", 0),
                                    number(node, "about", 0)});
      } else if (is(node, "alternative")) {
        no_children(node);
        record->alternatives.push_back(read_alternative(node));
      } else if (is(node, "plane")) {
        no_children(node);
        FitRecord::Plane plane;
        plane.name = attribute(node, "name").value_or("");
        for (std::size_t i = 0; i < plane.normal.size(); ++i) {
          plane.place_mm[i] = number(node, format::columns::kPoint[i], 0);
          plane.normal[i] = number(node, format::columns::kNormal[i], plane.normal[i]);
        }
        record->planes.push_back(plane);
      } else if (is(node, "noise")) {
        no_children(node);
        record->noise = read_noise(node);
      } else if (is(node, "covariance")) {
        no_children(node);
        std::istringstream words(attribute(node, "parameters").value_or(""));
        for (std::string name; std::getline(words, name, '|');) record->parameters.push_back(name);
        std::istringstream origins(attribute(node, "from").value_or(""));
        for (std::string word; std::getline(origins, word, '|');) record->origins.push_back(word);
        if (!record->origins.empty() && record->origins.size() != record->parameters.size())
          fail_attribute(node, "from", "from",
                         "this attribute must have one word for each of the parameters");
        if (!read_fit_numbers(attribute(node, "numbers").value_or(""), record->parameters.size(), *record))
          fail_attribute(node, "numbers", "numbers",
                         "this attribute must have one number for each named parameter");
      } else if (is(node, "open")) {
        no_children(node);
        if (!read_open_numbers(attribute(node, "numbers").value_or(""), record->parameters.size(), *record))
          fail_attribute(node, "numbers", "numbers",
                         "this attribute must have one number for each parameter of the covariance");
      } else {
        unknown(node);
      }
    }
    machine_.fitted = std::move(record);
  }

  void read_gravity(const pugi::xml_node& root, const std::string& value) {
    std::istringstream words(value);
    std::string word;
    std::size_t count = 0;
    while (words >> word) {
      const auto number = text::parse_number(word);
      if (!number || count >= 3)
        fail_attribute(root, "gravity", word, "gravity must be three numbers, a unit vector");
      machine_.gravity[count++] = *number;
    }
    const auto& g = machine_.gravity;
    if (count != 3 || std::abs(std::hypot(g[0], g[1], g[2]) - 1) > 1e-3)
      fail_attribute(root, "gravity", value, "gravity must be three numbers, a unit vector");
  }

  void read_variables(const pugi::xml_node& variables) {
    check_attributes(variables, {"note"});
    bool statics = false, axes = false, inputs = false, tables = false;
    bool tools = false, volume = false, instrument = false;
    pugi::xml_node table_node, volume_node;
    for (const pugi::xml_node node : children(variables)) {
      if (is(node, "static")) {
        once(node, statics);
        read_statics(node);
      } else if (is(node, "machineaxes")) {
        once(node, axes);
        read_axes(node);
      } else if (is(node, "inputs")) {
        once(node, inputs);
        read_inputs(node);
      } else if (is(node, "comptables")) {
        once(node, tables);
        table_node = node;
      } else if (is(node, "tools")) {
        once(node, tools);
        read_tools(node);
      } else if (is(node, "volume")) {
        once(node, volume);
        volume_node = node;
      } else if (is(node, "instrument")) {
        once(node, instrument);
        read_instrument(node);
      } else if (is(node, "artefact")) {
        read_artefact(node);
      } else {
        unknown(node);
      }
    }
    if (table_node) read_tables(table_node);
    if (volume_node) read_volume(volume_node);
    check_tips();
  }

  std::optional<double> length(const pugi::xml_node& node, const char* name) {
    const auto word = attribute(node, name);
    if (!word) return std::nullopt;
    const auto value = length_in_mm(*word);
    if (!value)
      fail_attribute(node, name, *word,
                     fmt::format("{} is a length, for example 12.5mm or 0.5um", std::string(name)));
    return value;
  }

  /// Reads three attributes that are given together or not at all; nullopt: none is given.
  std::optional<std::array<double, 3>> three(const pugi::xml_node& node,
                                             const std::array<const char*, 3>& names) {
    std::array<double, 3> value{};
    std::size_t given = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto one = length(node, names[i]);
      given += one ? 1 : 0;
      value[i] = one.value_or(0);
    }
    if (given == 0) return std::nullopt;
    if (given != 3)
      fail(node, node.name(),
           std::string("give ") + names[0] + ", " + names[1] + " and " + names[2] +
               " together, or none of them");
    return value;
  }

  void read_artefact(const pugi::xml_node& node) {
    no_children(node);
    namespace columns = format::columns;
    check_attributes(node,
                     {"name", "type", "radius", "uradius", columns::kPoint[0], columns::kPoint[1],
                      columns::kPoint[2], columns::kUncertainty, columns::kNormal[0], columns::kNormal[1],
                      columns::kNormal[2], columns::kSetup, "tip", "side", "note"});
    Artefact item;
    item.line = line(node);
    item.name = attribute(node, "name").value_or("");
    if (item.name.empty())
      fail(node, node.name(), "the artefact has no name: give the word of the column on");
    const std::string type = attribute(node, "type").value_or("");
    const auto known = artefact_type_named(type);
    if (!known)
      fail_attribute(node, "type", type,
                     "the type of an artefact must be point, line, plane, sphere or cylinder");
    item.type = *known;
    item.setup = attribute(node, columns::kSetup);
    for (const Artefact& other : machine_.artefacts)
      if (other.name == item.name && (other.setup == item.setup || !other.setup || !item.setup))
        fail(node, item.name, "two artefacts have this name in one set-up");
    read_size(node, item);
    item.place = three(node, format::columns::kPoint);
    item.direction = three(node, format::columns::kNormal);
    const std::string u = attribute(node, columns::kUncertainty).value_or("");
    item.u_place = length(node, columns::kUncertainty).value_or(0);
    if (item.u_place < 0) fail_attribute(node, columns::kUncertainty, u, "u must not be negative");
    if (item.u_place > 0 && !item.place)
      fail_attribute(node, columns::kUncertainty, u,
                     "u is the uncertainty of a known position: give x, y and z");
    check_direction(node, item);
    machine_.artefacts.push_back(std::move(item));
  }

  void check_direction(const pugi::xml_node& node, const Artefact& item) {
    if (!item.direction) return;
    const char* const first = format::columns::kNormal.front();
    const std::string word = attribute(node, first).value_or("");
    if (!item.has_direction())
      fail_attribute(node, first, word, "an artefact of type point or sphere has no direction");
    const auto& n = *item.direction;
    constexpr double kUnit = 1e-3;  // tolerance of the length of a unit vector that was written with digits
    if (std::abs(std::hypot(n[0], n[1], n[2]) - 1) > kUnit)
      fail_attribute(node, first, word, "the direction must be a unit vector");
  }

  /// Reads the radius of an artefact, and the tip that touches it.
  void read_size(const pugi::xml_node& node, Artefact& item) {
    item.radius = length(node, "radius");
    item.u_radius = length(node, "uradius").value_or(0);
    for (const char* name : {"radius", "uradius"})
      if (attribute(node, name) && !item.has_radius())
        fail_attribute(node, name, *attribute(node, name), "only a sphere or a cylinder has a radius");
    if (item.radius && *item.radius <= 0)
      fail_attribute(node, "radius", *attribute(node, "radius"), "a radius must be greater than 0");
    if (item.u_radius < 0)
      fail_attribute(node, "uradius", *attribute(node, "uradius"), "uradius must not be negative");
    if (item.u_radius > 0 && !item.radius)
      fail_attribute(node, "uradius", *attribute(node, "uradius"), "uradius needs the radius");
    item.tip = attribute(node, "tip").value_or("");
    if (!item.tip.empty() && !item.has_radius() && item.type != ArtefactType::kPlane)
      fail_attribute(node, "tip", item.tip, "a tip can touch only a plane, a sphere or a cylinder");
    const std::string side = attribute(node, "side").value_or("outside");
    if (side != "outside" && side != "inside")
      fail_attribute(node, "side", side, "side is outside or inside");
    if (side == "inside" && !item.has_radius())
      fail_attribute(node, "side", side,
                     "only an artefact of type sphere or cylinder can be touched from inside");
    item.inside = side == "inside";
  }

  /// The tip of an artefact is a static that is a length.
  void check_tips() const {
    for (const Artefact& item : machine_.artefacts) {
      if (item.tip.empty()) continue;
      const auto found = machine_.find_static(item.tip);
      if (!found)
        throw text::InputError(
            {machine_.file, item.line}, item.tip,
            "no constant (static) has this name; tip is the name of the constant with the radius of the tip");
      if (machine_.statics[*found].unit != "mm")
        throw text::InputError(
            {machine_.file, item.line}, item.tip,
            "the constant (static) of a tip is its radius in mm: give the constant unit=\"mm\"");
    }
  }

  void read_tools(const pugi::xml_node& list) {
    check_attributes(list, {"note"});
    for (const pugi::xml_node node : children(list)) {
      no_children(node);
      check_attributes(node, {"X", "Y", "Z", "note"});
      Tool tool{node.name(), {}, line(node)};
      for (const Tool& other : machine_.tools)
        if (other.name == tool.name) fail(node, tool.name, "two tools have this name");
      for (std::size_t i = 0; i < 3; ++i) tool.point[i] = number(node, kSixDofNames[i], 0);
      machine_.tools.push_back(std::move(tool));
    }
  }

  void read_instrument(const pugi::xml_node& node) {
    no_children(node);
    check_attributes(node, {"u", "X", "Y", "Z", "note"});
    const auto stated = attribute(node, "u");
    if (!stated)
      fail(node, node.name(), "the uncertainty of the instrument is missing, for example u=\"15um + 6um/m\"");
    try {
      machine_.instrument = parse_reading_uncertainty(*stated);
    } catch (const text::InputError& wrong) {
      fail_attribute(node, "u", *stated, wrong.what());
    }
    for (std::size_t i = 0; i < 3; ++i) machine_.instrument->at[i] = number(node, kSixDofNames[i], 0);
  }

  void read_volume(const pugi::xml_node& list) {
    check_attributes(list, {"note"});
    for (const pugi::xml_node node : children(list)) {
      no_children(node);
      check_attributes(node, {"min", "max", "note"});
      const auto axis = machine_.find_axis(node.name());
      if (!axis) fail(node, node.name(), "the machine has no axis of this name");
      for (const WorkRange& other : machine_.volume)
        if (other.axis == *axis) fail(node, node.name(), "this axis occurs twice");
      for (const char* end : {"min", "max"})
        if (!attribute(node, end)) fail(node, node.name(), std::string("the volume needs a ") + end);
      const WorkRange range{*axis, number(node, "min", 0), number(node, "max", 0)};
      if (range.min >= range.max)
        fail_attribute(node, "max", *attribute(node, "max"), "max must be greater than min");
      machine_.volume.push_back(range);
    }
  }

  std::optional<double> positive(const pugi::xml_node& node, const char* name) {
    const auto value = optional_number(node, name);
    if (value && *value <= 0)
      fail_attribute(node, name, *attribute(node, name),
                     std::string("a ") + name + " must be greater than 0");
    return value;
  }

  void read_statics(const pugi::xml_node& list) {
    check_attributes(list, {"note"});
    for (const pugi::xml_node node : children(list)) {
      no_children(node);
      if (is(node, "BaseShift")) {
        read_shift(node, machine_.base_shifts, true);
        continue;
      }
      if (is(node, "ToolShift")) {
        read_shift(node, machine_.tool_shifts, false);
        continue;
      }
      check_attributes(node, {"value", "nominal", "unit", "note", "Hide", "scale"});
      Static item;
      item.name = new_name(node);
      item.line = line(node);
      const auto value = attribute(node, "value");
      if (!value) fail(node, node.name(), "a static needs a value");
      if (text::equal_no_case(*value, "true") || text::equal_no_case(*value, "false")) {
        item.value = text::equal_no_case(*value, "true") ? 1 : 0;
        item.hidden = true;
      } else {
        item.value = number(node, "value", 0);
      }
      if (attribute(node, "nominal")) item.nominal = number(node, "nominal", 0);
      item.scale = positive(node, "scale");
      item.unit = format::canonical_unit(attribute(node, "unit").value_or(""));
      item.note = attribute(node, "note").value_or("");
      item.hidden = boolean(node, "Hide", item.hidden);
      machine_.statics.push_back(item);
    }
  }

  /// A BaseShift, or a ToolShift, which has no attribute `run`.
  void read_shift(const pugi::xml_node& node, std::vector<BaseShift>& shifts, bool with_run) {
    const std::string kind = with_run ? "BaseShift" : "ToolShift";
    if (with_run)
      check_attributes(node, {"X", "Y", "Z", "rX", "rY", "rZ", "run", "setup", "Hide", "note"});
    else
      check_attributes(node, {"X", "Y", "Z", "rX", "rY", "rZ", "setup", "Hide", "note"});
    BaseShift shift;
    shift.line = line(node);
    if (with_run) shift.run = attribute(node, "run");
    if (const auto setup = attribute(node, "setup")) {
      if (shift.run) fail(node, "setup", "a BaseShift is of a run or of a set-up, not of both");
      shift.run = setup;
      shift.of_setup = true;
    }
    for (std::size_t i = 0; i < 6; ++i) shift.value[i] = number(node, kSixDofNames[i], 0);
    shift.hidden = boolean(node, "Hide", false);
    for (const BaseShift& other : shifts)
      if (other.run == shift.run)
        fail(node, shift.run.value_or(kind),
             "a second " + kind + " of the same " + (shift.of_setup || !with_run ? "set-up" : "run"));
    shifts.push_back(shift);
  }

  void read_correct(const pugi::xml_node& list) {
    std::istringstream words(attribute(list, "correct").value_or("position"));
    std::string word;
    bool position = false;
    while (words >> word) {
      if (!text::equal_no_case(word, "position") && !text::equal_no_case(word, "orientation"))
        fail_attribute(list, "correct", word, "correct must be \"position\" or \"position orientation\"");
      (text::equal_no_case(word, "position") ? position : machine_.correct_orientation) = true;
    }
    if (!position)
      fail_attribute(list, "correct", *attribute(list, "correct"),
                     "correct must be \"position\" or \"position orientation\"");
  }

  void read_axes(const pugi::xml_node& list) {
    check_attributes(list, {"note", "correct"});
    read_correct(list);
    for (const pugi::xml_node node : children(list)) {
      no_children(node);
      check_attributes(node, {"rotary", "joint", "min", "max", "maxcorrection", "maxslew", "rollover",
                              "scalefactor", "Hide", "unit", "reference", "note"});
      Axis axis;
      axis.name = new_name(node);
      axis.line = line(node);
      axis.rotary = boolean(node, "rotary", false);
      axis.rollover = boolean(node, "rollover", false);
      axis.scale_factor = number(node, "scalefactor", 0);
      axis.min = optional_number(node, "min");
      axis.max = optional_number(node, "max");
      if (axis.min && axis.max && *axis.min >= *axis.max)
        fail_attribute(node, "max", attribute(node, "max").value_or(""), "max must be greater than min");
      axis.max_correction = optional_number(node, "maxcorrection");
      axis.max_slew = optional_number(node, "maxslew");
      for (const char* limit : {"maxcorrection", "maxslew"})
        if (optional_number(node, limit).value_or(1) <= 0)
          fail_attribute(node, limit, attribute(node, limit).value_or(""), "a limit must be greater than 0");
      if (boolean(node, "Hide", false)) {
        machine_.inputs.push_back({axis.name, format::canonical_unit(attribute(node, "unit").value_or("")),
                                   number(node, "reference", 0), axis.min, axis.max, true, axis.line,
                                   InputRole::kGuessed});
      } else {
        machine_.axes.push_back(axis);
      }
    }
  }

  void read_inputs(const pugi::xml_node& list) {
    check_attributes(list, {"note"});
    for (const pugi::xml_node node : children(list)) {
      no_children(node);
      check_attributes(node, {"unit", "reference", "min", "max", "role", "note"});
      Input input;
      input.name = new_name(node);
      input.line = line(node);
      input.unit = format::canonical_unit(attribute(node, "unit").value_or(""));
      input.reference = number(node, "reference", 0);
      input.min = optional_number(node, "min");
      input.max = optional_number(node, "max");
      if (const auto word = attribute(node, "role")) {
        const auto role = input_role_named(*word);
        if (!role)
          fail_attribute(node, "role", *word,
                         "the role must be temperature, load, vibration, set-point or other");
        input.role = *role;
      }
      machine_.inputs.push_back(input);
    }
  }

  void read_tables(const pugi::xml_node& list) {
    check_attributes(list, {"note"});
    for (const pugi::xml_node node : children(list)) {
      if (!is(node, "table")) unknown(node);
      check_attributes(node, {"axis", "interpolation", "fit", "scale", "note"});
      Table table;
      table.line = line(node);
      const std::string axis_name = attribute(node, "axis").value_or("");
      const auto axis = machine_.find_axis(axis_name);
      if (!axis) fail_attribute(node, "axis", axis_name, "the machine has no axis of this name");
      if (machine_.table_of(*axis) != nullptr)
        fail_attribute(node, "axis", axis_name, "this axis already has a table");
      table.axis = *axis;
      table.periodic = machine_.axes[*axis].rollover;
      const std::string interpolation = attribute(node, "interpolation").value_or("linear");
      if (interpolation != "linear" && interpolation != "cubic")
        fail_attribute(node, "interpolation", interpolation, "interpolation is linear or cubic");
      table.interpolation = interpolation == "cubic" ? Interpolation::kCubic : Interpolation::kLinear;
      read_free_columns(node, table);
      read_scales(node, table);
      for (const pugi::xml_node station : children(node)) read_station(station, table);
      check_table(node, table);
      machine_.tables.push_back(std::move(table));
    }
  }

  void read_free_columns(const pugi::xml_node& node, Table& table) {
    std::istringstream words(attribute(node, "fit").value_or(""));
    std::string word;
    while (words >> word) {
      const auto* const found = std::find(kSixDofNames.begin(), kSixDofNames.end(), word);
      if (found == kSixDofNames.end())
        fail_attribute(node, "fit", word, "the columns of fit must be among X Y Z rX rY rZ");
      table.free[static_cast<std::size_t>(found - kSixDofNames.begin())] = true;
    }
  }

  /// scale: one number for each column that `fit` names, in that order, or one number for all
  /// (each in its unit).
  void read_scales(const pugi::xml_node& node, Table& table) {
    std::vector<std::size_t> columns;
    std::istringstream names(attribute(node, "fit").value_or(""));
    for (std::string word; names >> word;)
      columns.push_back(static_cast<std::size_t>(std::find(kSixDofNames.begin(), kSixDofNames.end(), word) -
                                                 kSixDofNames.begin()));
    std::vector<double> scales;
    std::istringstream words(attribute(node, "scale").value_or(""));
    for (std::string word; words >> word;) {
      const auto value = text::parse_number(word);
      if (!value || *value <= 0) fail_attribute(node, "scale", word, "a scale must be greater than 0");
      scales.push_back(*value);
    }
    if (scales.empty()) return;
    if (scales.size() != 1 && scales.size() != columns.size())
      fail_attribute(node, "scale", *attribute(node, "scale"),
                     "scale must be one number, or one number for each column of fit");
    for (std::size_t i = 0; i < columns.size(); ++i)
      table.scale[columns[i]] = scales[scales.size() == 1 ? 0 : i];
  }

  void read_station(const pugi::xml_node& node, Table& table) {
    if (!is(node, "station")) unknown(node);
    no_children(node);
    check_attributes(node, {"loc", "X", "Y", "Z", "rX", "rY", "rZ", "note"});
    Station station;
    const auto loc = attribute(node, "loc");
    if (!loc) fail(node, node.name(), "a station needs a position (loc)");
    station.loc_text = *loc;
    station.loc = number(node, "loc", 0);
    for (std::size_t i = 0; i < 6; ++i) station.value[i] = number(node, kSixDofNames[i], 0);
    if (!table.stations.empty() && station.loc <= table.stations.back().loc)
      fail_attribute(node, "loc", *loc, "stations must increase");
    table.stations.push_back(std::move(station));
  }

  void check_table(const pugi::xml_node& node, const Table& table) {
    const std::string& axis = machine_.axes[table.axis].name;
    if (table.stations.empty()) fail(node, axis, "the table has no station");
    if (!table.periodic) return;
    if (table.stations.size() < 2) fail(node, axis, "a periodic table needs at least two stations");
    for (std::size_t i = 0; i < 6; ++i)
      if (std::abs(table.stations.front().value[i] - table.stations.back().value[i]) > 1e-9)
        fail(node, axis, "a periodic table must have equal values at its first and last station");
  }

  void read_transforms(const pugi::xml_node& list, std::set<std::string>& branches) {
    check_attributes(list, {"branch", "link", "frame", "note"});
    const std::string branch = attribute(list, "branch").value_or("tool");
    if (branch != "tool" && branch != "workpiece")
      fail_attribute(list, "branch", branch, "branch is tool or workpiece");
    const std::string frame = attribute(list, "frame").value_or("0 0 0 0 0 0");
    const std::vector<std::string> numbers = text::words_in(frame, " ");
    if (numbers.size() != 6 || !std::ranges::all_of(numbers, [](const std::string& one) {
          return text::parse_number(one).has_value();
        }))
      fail_attribute(list, "frame", frame, "expected the six numbers X Y Z rX rY rZ of the link");
    if (!branches.insert(branch).second)
      fail(list, branch, "the file has a second <transforms> of this branch");
    std::vector<Transform>& transforms = branch == "tool" ? machine_.tool : machine_.workpiece;
    for (const pugi::xml_node node : children(list))
      transforms.push_back(read_transform(node, transforms, branch == "tool"));
  }

  Transform read_transform(const pugi::xml_node& node, const std::vector<Transform>& before, bool tool) {
    Transform transform;
    transform.line = line(node);
    no_children(node);
    if (is(node, "sixdof")) {
      check_attributes(node, {"n", "X", "Y", "Z", "rX", "rY", "rZ", "note"});
    } else if (is(node, "DH")) {
      transform.kind = TransformKind::kDh;
      check_attributes(node, {"n", "theta", "d", "a", "alpha", "note"});
    } else {
      unknown(node);
    }
    const int expected = before.empty() ? 1 : before.back().n + 1;
    const double n = number(node, "n", expected);
    if (n != std::floor(n) || std::abs(n) > 1e6 || (!before.empty() && n <= before.back().n))
      fail_attribute(node, "n", attribute(node, "n").value_or(""),
                     "the numbers n of the transforms must be integers in increasing order");
    transform.n = static_cast<int>(n);
    for (std::size_t i = 0; i < transform.dof_count(); ++i) {
      transform.text[i] = attribute(node, transform.dof_name(i)).value_or("0");
      try {
        transform.dof[i] = parse_expression(transform.text[i]);
      } catch (const ExpressionError& error) {
        fail_expression(node, transform, i, error);
      }
    }
    pending_.push_back({node, tool, before.size()});
    return transform;
  }

  void resolve_all() {
    for (const Pending& pending : pending_) {
      Transform& transform = (pending.tool ? machine_.tool : machine_.workpiece)[pending.index];
      for (std::size_t i = 0; i < transform.dof_count(); ++i) {
        try {
          transform.dof[i] = parse_expression_for(machine_, transform.text[i]);
        } catch (const ExpressionError& error) {
          fail_expression(pending.node, transform, i, error);
        }
      }
    }
  }
  [[noreturn]] void fail_expression(const pugi::xml_node& node, const Transform& transform, std::size_t dof,
                                    const ExpressionError& error) {
    const std::string name = transform.dof_name(dof);
    fail_attribute(node, name, error.word,
                   std::string(error.what()) + ", in " + name + "=\"" + transform.text[dof] + "\"");
  }

  /// No name may also be a quantity that the axes define (vX, lXx ...).
  void check_names() {
    Machine only_axes;
    only_axes.axes = machine_.axes;
    const auto check = [&](const std::string& name, std::size_t at_line) {
      only_axes.statics.clear();
      const Symbol symbol = resolve_name(only_axes, name);
      if (symbol.kind != SymbolKind::kUnresolved && symbol.kind != SymbolKind::kAxis)
        throw text::InputError({machine_.file, at_line}, name, "this name is already a quantity of the axes");
    };
    for (const Static& item : machine_.statics) check(item.name, item.line);
    for (const Input& input : machine_.inputs) check(input.name, input.line);
    for (const Axis& axis : machine_.axes) {
      only_axes.axes = machine_.axes;
      std::erase_if(only_axes.axes, [&](const Axis& other) { return other.name == axis.name; });
      check(axis.name, axis.line);
    }
  }

  std::string new_name(const pugi::xml_node& node) {
    const std::string name = node.name();
    if (!text::is_name(name))
      fail(node, name, "names are letters, digits and _, and begin with a letter or _");
    if (is_reserved_word(name)) fail(node, name, "this name is reserved");
    if (!names_.insert(name).second) fail(node, name, "this name occurs twice");
    return name;
  }

  // -- attributes
  // ------------------------------------------------------------------------------------------------
  void check_attributes(const pugi::xml_node& node, Words known) {
    std::set<std::string> seen;
    for (const pugi::xml_attribute item : node.attributes()) {
      const std::string name = item.name();
      const std::string lower = text::in_small_letters(name);
      if (!seen.insert(lower).second) fail_attribute(node, item.name(), name, "this attribute occurs twice");
      if (lower.find("multiply") != std::string::npos) {
        machine_.notes.push_back(machine_.file + ":" + std::to_string(line(node)) + ": " + name +
                                 " is ignored");
        continue;
      }
      if (std::none_of(known.begin(), known.end(),
                       [&](const char* word) { return text::equal_no_case(name, word); }))
        fail_attribute(node, item.name(), name, std::string("unknown attribute of <") + node.name() + ">");
    }
  }

  static std::optional<std::string> attribute(const pugi::xml_node& node, std::string_view name) {
    for (const pugi::xml_attribute item : node.attributes())
      if (text::equal_no_case(item.name(), name)) return item.value();
    return std::nullopt;
  }

  double number(const pugi::xml_node& node, const char* name, double fallback) {
    return optional_number(node, name).value_or(fallback);
  }
  std::optional<double> optional_number(const pugi::xml_node& node, const char* name) {
    const auto text = attribute(node, name);
    if (!text) return std::nullopt;
    const auto value = text::parse_number(*text);
    if (!value) fail_attribute(node, name, *text, std::string(name) + " must be a number");
    return value;
  }
  bool boolean(const pugi::xml_node& node, const char* name, bool fallback) {
    const auto text = attribute(node, name);
    if (!text) return fallback;
    if (text::equal_no_case(*text, "true") || *text == "1") return true;
    if (text::equal_no_case(*text, "false") || *text == "0") return false;
    fail_attribute(node, name, *text, std::string(name) + " is true or false");
  }

  // -- elements
  // --------------------------------------------------------------------------------------------------
  static bool is(const pugi::xml_node& node, std::string_view name) {
    return text::equal_no_case(node.name(), name);
  }
  std::vector<pugi::xml_node> children(const pugi::xml_node& node) {
    std::vector<pugi::xml_node> list;
    for (const pugi::xml_node child : node.children()) {
      if (child.type() != pugi::node_element) fail(node, child.value(), "this element must not contain text");
      list.push_back(child);
    }
    return list;
  }
  void no_children(const pugi::xml_node& node) {
    for (const pugi::xml_node child : node.children())
      fail(node, child.type() == pugi::node_element ? child.name() : child.value(),
           "this element must be empty");
  }
  void once(const pugi::xml_node& node, bool& seen) {
    if (seen) fail(node, node.name(), "this element occurs twice");
    seen = true;
  }
  [[noreturn]] void unknown(const pugi::xml_node& node) { fail(node, node.name(), "unknown element"); }

  std::size_t line(const pugi::xml_node& node) const {
    return line_at(static_cast<std::size_t>(std::max<std::ptrdiff_t>(node.offset_debug(), 0)));
  }
  std::size_t line_at(std::size_t offset) const {
    const auto after = std::upper_bound(line_starts_.begin(), line_starts_.end(), offset);
    return static_cast<std::size_t>(after - line_starts_.begin());
  }
  std::string word_at(std::size_t offset) const {
    std::size_t end = offset;
    while (end < text_.size() && end < offset + 40 && !std::isspace(static_cast<unsigned char>(text_[end])))
      ++end;
    return text_.substr(std::min(offset, text_.size()), end - offset);
  }
  [[noreturn]] void fail(const pugi::xml_node& node, const std::string& word, const std::string& what) {
    throw text::InputError({machine_.file, line(node)}, word, what);
  }
  [[noreturn]] void fail_attribute(const pugi::xml_node& node, std::string_view name, const std::string& word,
                                   const std::string& what) {
    std::size_t at = line(node);
    const std::ptrdiff_t offset = node.offset_debug();
    if (offset >= 0)
      for (const text::AttributeSpan& span : text::attribute_spans(text_, static_cast<std::size_t>(offset)))
        if (text::equal_no_case(span.name, name)) at = line_at(span.name_at);
    throw text::InputError({machine_.file, at}, word, what);
  }

  const std::string& text_;
  pugi::xml_document document_;
  Machine machine_;
  std::set<std::string> names_;
  struct Pending {
    pugi::xml_node node;
    bool tool = true;
    std::size_t index = 0;
  };
  std::vector<Pending> pending_;  // transforms whose names are resolved after the axes and inputs are read
  std::vector<std::size_t> line_starts_;
};

}  // namespace

Machine parse_machine(const std::string& text, const std::string& file) { return Reader(text, file).read(); }

Machine read_machine(const std::string& path) { return parse_machine(text::read_file(path), path); }

}  // namespace vernier::model
