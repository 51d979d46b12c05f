// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/model/file_set_ups.h"

#include <fmt/format.h>

#include <algorithm>
#include <pugixml.hpp>
#include <set>

#include "tools/model/parameters.h"
#include "tools/text/numbers.h"
#include "tools/text/xml_text.h"

namespace vernier::model {
namespace {

/// What decides whether a file has a set-up of its own.
struct FileUse {
  bool needs_set_up = false;    // a fit row has a reading that depends on the set-up
  bool on_plain = true;         // no row has a BaseShift of its own
  bool stated = false;          // a column `setup` says which set-up
  std::set<std::string> words;  // labels of its set-ups
};

std::vector<FileUse> uses_of(const Machine& machine, const Measurement& rows) {
  std::vector<FileUse> uses(rows.files.size());
  for (const Observation& o : rows.observations)
    if (rows.check[o.row] == 0 && !is_free_of_set_up(rows, o)) uses[rows.file[o.row]].needs_set_up = true;
  const Labels& setup = rows.states.setup;
  for (std::size_t row = 0; row < rows.rows(); ++row) {
    FileUse& use = uses[rows.file[row]];
    const std::string& word = rows.states.names(setup)[rows.states.of(setup, row)];
    const auto shift = base_shift_of(machine, word);
    if (shift && machine.base_shifts[*shift].run) use.on_plain = false;
    if (word.empty()) continue;
    use.words.insert(word);
    use.stated = use.stated || word != rows.states.run_names[rows.states.run[row]];
  }
  return uses;
}

bool share_a_word(const FileUse& a, const FileUse& b) {
  return std::any_of(a.words.begin(), a.words.end(),
                     [&](const auto& word) { return b.words.contains(word); });
}

/// Numbers of the files that keep the plain BaseShift: a file and all that share words with it. Only the
/// plain BaseShift can serve several files. The first such group has it, or the first file if no words are
/// shared.
std::set<std::size_t> files_on_plain(const std::vector<FileUse>& uses) {
  std::set<std::size_t> of_first;
  for (std::size_t start = 0; start < uses.size(); ++start) {
    if (!uses[start].needs_set_up || !uses[start].on_plain) continue;
    std::set<std::size_t> group{start};
    for (std::size_t size = 0; size != group.size();) {
      size = group.size();
      for (std::size_t file = 0; file < uses.size(); ++file)
        if (uses[file].needs_set_up && uses[file].on_plain &&
            std::any_of(group.begin(), group.end(),
                        [&](std::size_t other) { return share_a_word(uses[file], uses[other]); }))
          group.insert(file);
    }
    if (group.size() > 1) return group;
    if (of_first.empty()) of_first = group;
  }
  return of_first;
}

/// The element of the plain BaseShift.
pugi::xml_node plain_element(const pugi::xml_node& document) {
  return document.find_node([](const pugi::xml_node& node) {
    if (!text::equal_no_case(node.name(), "BaseShift")) return false;
    const auto attributes = node.attributes();
    return std::none_of(attributes.begin(), attributes.end(), [](const pugi::xml_attribute& item) {
      return text::equal_no_case(item.name(), "run") || text::equal_no_case(item.name(), "setup");
    });
  });
}

std::string element_of(const std::string& name, const BaseShift& start) {
  std::string element = fmt::format("<BaseShift setup=\"{}\"", text::escape_attribute(name));
  for (std::size_t i = 0; i < start.value.size(); ++i)
    element += fmt::format(" {}=\"{}\"", kSixDofNames[i], text::number_text(start.value[i]));
  return element + "/>";
}

}  // namespace

CompletedText with_set_ups_of_files(const std::string& text, const Machine& machine,
                                    const Measurement& rows) {
  CompletedText result{text, {}};
  const auto plain = std::find_if(machine.base_shifts.begin(), machine.base_shifts.end(),
                                  [](const auto& s) { return !s.run; });
  if (rows.files.size() < 2 || plain == machine.base_shifts.end() || plain->hidden) return result;
  const std::vector<FileUse> uses = uses_of(machine, rows);
  const std::set<std::size_t> plain_files = files_on_plain(uses);
  std::set<std::string> names;
  std::string elements;
  for (std::size_t file = 0; file < uses.size(); ++file) {
    const FileUse& use = uses[file];
    if (!use.needs_set_up || !use.on_plain) continue;
    std::string name = set_up_of_file(rows.files[file]);
    if (names.contains(name)) name = set_up_of_file(rows.files[file], true);
    if (plain_files.contains(file)) {
      names.insert(name);
      continue;
    }
    const std::size_t first = *plain_files.begin();
    if (use.stated) {
      // Words without a BaseShift mean other positions only beside the words of an earlier file.
      if (!uses[first].stated) continue;
      for (const std::string& word : use.words) {
        if (!names.insert(word).second) continue;
        elements += element_of(word, *plain) + "\n      ";
        result.notes.push_back(
            fmt::format("the set-up \"{}\" of {} has its own BaseShift[{}]", word, rows.files[file], word));
      }
      continue;
    }
    if (!names.insert(name).second) continue;
    elements += element_of(name, *plain) + "\n      ";
    result.notes.push_back(
        fmt::format("{} has its own set-up BaseShift[{}]; if the instrument had the same position as for {}, "
                    "give the rows of both files one word in a column \"setup\"",
                    rows.files[file], name, rows.files[first]));
  }
  if (elements.empty()) return result;
  pugi::xml_document document;
  document.load_buffer(text.data(), text.size(), pugi::parse_default, pugi::encoding_utf8);
  const pugi::xml_node element = plain_element(document);
  if (!element) return {text, {}};
  result.text =
      text::apply_edits(text, {{static_cast<std::size_t>(element.offset_debug()) - 1, 0, elements}});
  return result;
}

namespace {

/// Set-ups of the rows with readings of a board and without a ToolShift, and of the rows with other readings.
struct BoardUse {
  std::set<std::string> of_board, of_others;
};

BoardUse board_use(const Machine& machine, const Measurement& rows) {
  BoardUse use;
  for (const Observation& o : rows.observations) {
    if (is_free_of_set_up(rows, o)) continue;
    const std::string& name = rows.states.names(rows.states.setup)[rows.states.of(rows.states.setup, o.row)];
    if (!format::is_of_board(o.kind))
      use.of_others.insert(name);
    else if (!tool_shift_of(machine, name))
      use.of_board.insert(name);
  }
  return use;
}

}  // namespace

CompletedText with_camera_mountings(const std::string& text, const Machine& machine,
                                    const Measurement& rows) {
  CompletedText result{text, {}};
  const auto [of_board, of_others] = board_use(machine, rows);
  if (of_board.empty()) return result;
  constexpr const char* kZero = R"(X="0" Y="0" Z="0" rX="0" rY="0" rZ="0"/>)";
  std::string elements;
  for (const std::string& name : of_others.empty() ? std::set<std::string>{""} : of_board) {
    if (!of_others.empty() && (name.empty() || of_others.contains(name)))
      throw text::InputError(
          {machine.file, 0}, name.empty() ? format::columns::kBoard.front() : name,
          "the readings of the camera and of another instrument have one set-up: give their "
          "rows different words in a column \"setup\"");
    const std::string setup =
        of_others.empty() ? "" : fmt::format("setup=\"{}\" ", text::escape_attribute(name));
    elements += fmt::format("<ToolShift {}{}\n      ", setup, kZero);
    result.notes.push_back(fmt::format("the mounting of the camera on the tool is unknown: {} is fitted",
                                       setup.empty() ? "ToolShift" : "ToolShift[" + name + "]"));
  }
  if (machine.base_shifts.empty()) {
    elements += fmt::format("<BaseShift {}\n      ", kZero);
    result.notes.emplace_back("the position of the board is unknown: BaseShift is fitted");
  }
  pugi::xml_document document;
  document.load_buffer(text.data(), text.size(), pugi::parse_default, pugi::encoding_utf8);
  const pugi::xml_node list = document.find_node(
      [](const pugi::xml_node& node) { return text::equal_no_case(node.name(), "static"); });
  const pugi::xml_node first =
      list.find_child([](const pugi::xml_node& node) { return node.type() == pugi::node_element; });
  if (!first)
    throw text::InputError({machine.file, 0}, "static",
                           "the machine file has no element for the mounting of the camera: write "
                           "<static><ToolShift/><BaseShift/></static> under <variables>");
  result.text = text::apply_edits(text, {{static_cast<std::size_t>(first.offset_debug()) - 1, 0, elements}});
  return result;
}

}  // namespace vernier::model
