// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fleet/gateway_file.h"

#include <toml++/toml.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <set>

#include "tools/fleet/sparkplug.h"
#include "tools/registry/machine_name.h"
#include "tools/text/error.h"
#include "tools/upload/url.h"

namespace vernier::fleet {
namespace {

/// A table of the file whose keys are read one by one. A key that was not read is an error.
class Section {
 public:
  Section(const toml::table& table, std::string path) : table_(table), path_(std::move(path)) {}
  std::string word(const char* key, const std::string& otherwise, bool needed = false) {
    const toml::node* const node = asked(key);
    if (node == nullptr) {
      if (needed) throw text::InputError(place(table_), key, "this setting is missing");
      return otherwise;
    }
    const auto value = node->value_exact<std::string>();
    if (!value) throw text::InputError(place(*node), key, "the value must be a text in quotes");
    return *value;
  }
  /// A name that is used in topics.
  std::string name(const char* key, const std::string& otherwise, bool needed = false) {
    std::string name = word(key, otherwise, needed);
    if (!fits_a_topic(name)) wrong(key, "the value must be one line without + / #, of 1 to 200 bytes");
    return name;
  }
  double number(const char* key, double otherwise, double low, double high) {
    const toml::node* const node = asked(key);
    if (node == nullptr) return otherwise;
    const auto value = node->value<double>();
    if (!value || !(*value >= low && *value <= high))
      throw text::InputError(place(*node), key,
                             "a number between " + std::to_string(low) + " and " + std::to_string(high));
    return *value;
  }
  [[noreturn]] void wrong(const char* key, const std::string& what) const {
    const toml::node* const node = table_.get(key);
    throw text::InputError(place(node == nullptr ? table_ : *node), key, what);
  }
  /// An error that `judge` throws for a value is reported with the line of the value.
  void require(const char* key, const std::function<void()>& judge) const {
    try {
      judge();
    } catch (const text::InputError& error) {
      wrong(key, error.what());
    }
  }
  void end() const {
    for (const auto& [key, node] : table_)
      if (!asked_.contains(std::string(key.str())))
        throw text::InputError(place(node), std::string(key.str()), "an unknown key");
  }

 private:
  const toml::node* asked(const char* key) {
    asked_.insert(key);
    return table_.get(key);
  }
  text::Place place(const toml::node& node) const { return {path_, node.source().begin.line}; }

  const toml::table& table_;
  std::string path_;
  std::set<std::string> asked_;
};

/// Letters beyond ASCII outside strings are undefined in the library that parses.
void refuse_other_letters(const std::string& text, const std::string& path) {
  std::size_t line = 1;
  for (const char c : text) {
    line += c == '\n' ? 1 : 0;
    if (static_cast<unsigned char>(c) >= 0x80)
      throw text::InputError({path, line}, "", "the text must contain only ASCII letters");
  }
}

std::string beside(const std::string& file, const std::string& path) {
  if (path.empty()) return path;
  return (std::filesystem::path(file).parent_path() / path).string();
}

GatewayBoard board_of(const toml::table& table, const std::string& path) {
  Section section(table, path);
  GatewayBoard board;
  board.machine = section.word("machine", "", true);
  section.require("machine", [&] { registry::require_machine_name(board.machine); });
  board.url = section.word("url", "", true);
  board.board = section.word("board", "");
  board.check = beside(path, section.word("check", ""));
  section.end();
  section.require("url", [&] { upload::parse_url(board.url); });
  return board;
}

const toml::table& table_of(const toml::node* node, const std::string& path, const char* key) {
  if (node == nullptr || !node->is_table())
    throw text::InputError({path, node == nullptr ? 0U : node->source().begin.line}, key,
                           "the value must be a table");
  return *node->as_table();
}

}  // namespace

GatewayFile parse_gateway_file(const std::string& text, const std::string& path) {
  refuse_other_letters(text, path);
  toml::table root;
  try {
    root = toml::parse(text, path);
  } catch (const toml::parse_error& error) {
    throw text::InputError({path, error.source().begin.line}, "", std::string(error.description()));
  }
  for (const auto& [key, node] : root)
    if (key.str() != "gateway" && key.str() != "board")
      throw text::InputError({path, node.source().begin.line}, std::string(key.str()), "an unknown key");
  GatewayFile file;
  Section section(table_of(root.get("gateway"), path, "gateway"), path);
  file.name = section.name("name", "", true);
  file.group = section.name("group", file.group);
  file.host = section.name("host", file.host);
  file.store = beside(path, section.word("store", "", true));
  file.broker.address = section.word("broker", file.broker.address);
  section.require("broker", [&] { require_broker_address(file.broker.address); });
  file.broker.user = section.word("user", "");
  file.broker.authority = beside(path, section.word("authority", ""));
  file.period_s = section.number("period_s", file.period_s, 0.05, 3600);
  file.most_records = static_cast<std::uint64_t>(
      section.number("most_records", static_cast<double>(file.most_records), 1, 1e9));
  section.end();
  const toml::array* const boards = root.get_as<toml::array>("board");
  if (boards == nullptr || boards->empty())
    throw text::InputError({path, 0}, "board", "the file has no [[board]]");
  for (const toml::node& node : *boards) {
    file.boards.push_back(board_of(table_of(&node, path, "board"), path));
    const std::string& name = file.boards.back().machine;
    if (std::count_if(file.boards.begin(), file.boards.end(),
                      [&](const GatewayBoard& one) { return one.machine == name; }) > 1)
      throw text::InputError({path, node.source().begin.line}, name, "this machine occurs twice");
  }
  return file;
}

}  // namespace vernier::fleet
