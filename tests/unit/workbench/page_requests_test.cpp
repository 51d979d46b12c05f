// SPDX-License-Identifier: GPL-3.0-or-later
// Every request for a command in the scripts of the page has only options that the workbench accepts.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "tests/unit/workbench/rig.h"
#include "tools/text/words.h"
#include "tools/workbench/runs/commands.h"

namespace vernier::page_requests_test {

using namespace vernier::text;
using namespace vernier::workbench;
namespace {

constexpr std::string_view kIdentifier = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_$";

/// The end of what is opened at `at`: behind its closing bracket or quote.
std::size_t end_of(const std::string& text, std::size_t at) {
  const char open = text[at];
  if (open == '\'' || open == '"' || open == '`') {
    for (std::size_t i = at + 1; i < text.size(); ++i)
      if (text[i] == '\\')
        ++i;
      else if (text[i] == open)
        return i + 1;
    return text.size();
  }
  for (std::size_t i = at + 1; i < text.size();)
    if (std::string_view(")]}").find(text[i]) != std::string_view::npos)
      return i + 1;
    else
      i = std::string_view("([{'\"`").find(text[i]) != std::string_view::npos ? end_of(text, i) : i + 1;
  return text.size();
}

/// The members of an object literal, given without its braces.
std::vector<std::string> members(const std::string& body) {
  std::vector<std::string> list;
  std::size_t begin = 0;
  for (std::size_t i = 0; i <= body.size();)
    if (i == body.size() || body[i] == ',') {
      if (std::string one = trimmed(body.substr(begin, i - begin)); !one.empty())
        list.push_back(std::move(one));
      begin = ++i;
    } else {
      i = std::string_view("([{'\"`").find(body[i]) != std::string_view::npos ? end_of(body, i) : i + 1;
    }
  return list;
}

struct Scripts {
  Scripts() {
    for (const auto& one : std::filesystem::directory_iterator(VERNIER_SOURCE_DIR "/tools/workbench/web/src"))
      text[one.path().filename()] = read_file(one.path());
  }

  /// What a name stands for: its first definition in the script; of a function in any script. Empty: none.
  std::string definition(const std::string& file, const std::string& name, bool function) const {
    std::vector<const std::string*> order = {&text.at(file)};
    for (const auto& [other, words] : text)
      if (function) order.push_back(&words);
    for (const std::string* const words : order)
      if (const auto at = words->find("const " + name + " = "); at != std::string::npos) {
        std::string found = words->substr(at, words->find(";\n", at) - at);
        return found.find("=> {\n") == std::string::npos ? found : "";  // its literals are made step by step
      }
    return {};
  }

  /// The keys of an object literal; of what it spreads, the keys of the literals that can be found.
  std::set<std::string> keys(const std::string& file, const std::string& body) const {
    std::set<std::string> found;
    for (const std::string& member : members(body)) {
      if (!member.starts_with("...")) {
        const std::string key = trimmed(member.substr(0, member.find(':')));
        found.insert(key.starts_with("'") ? key.substr(1, key.size() - 2) : key);
        continue;
      }
      std::string spread = member.substr(3);
      const std::string name = spread.substr(0, spread.find_first_not_of(kIdentifier));
      if (name == spread || name + "()" == spread) spread = definition(file, name, name != spread);
      for (std::size_t at = spread.find('{'); at != std::string::npos; at = spread.find('{', at)) {
        const std::size_t end = end_of(spread, at);
        found.merge(keys(file, spread.substr(at + 1, end - at - 2)));
        at = end;
      }
    }
    return found;
  }

  std::map<std::string, std::string> text;
};

/// The literal around a place of a script, without its braces.
std::string literal_around(const std::string& text, std::size_t place) {
  for (std::size_t at = text.rfind('{', place);; at = text.rfind('{', at - 1))
    if (const std::size_t end = end_of(text, at); end > place) return text.substr(at + 1, end - at - 2);
}

TEST(PageRequest, HasOnlyOptionsThatTheWorkbenchAccepts) {
  const Scripts scripts;
  const CommandTable table{test::described()};
  const auto accepts = [&](const std::string& command, const std::string& option) {
    // `import ${kind}`: one of the commands that begin so.
    const auto open = command.find("${");
    bool accepted = false;
    for (const auto& one : table.allowed()) {
      const auto name = one["name"].get<std::string>();
      if (open == std::string::npos ? name != command : !name.starts_with(command.substr(0, open))) continue;
      for (const auto& known : one["options"]) accepted |= known["name"] == option;
    }
    return accepted;
  };
  std::size_t requests = 0, options = 0;
  for (const auto& [file, text] : scripts.text)
    for (std::size_t at = text.find("command: "); at != std::string::npos;
         at = text.find("command: ", at + 1)) {
      const std::size_t quote = at + std::string_view("command: ").size();
      if (text[quote] != '\'' && text[quote] != '`') continue;
      const std::string request = literal_around(text, at);
      if (request.find(" title: ") != std::string::npos) continue;  // describes a panel
      const std::string command = text.substr(quote + 1, end_of(text, quote) - quote - 2);
      ++requests;
      for (const std::string& key : scripts.keys(file, request)) {
        if (key == "command") continue;
        ++options;
        EXPECT_TRUE(accepts(command, key)) << fmt::format("{} gives {} to {}", file, key, command);
      }
    }
  EXPECT_GT(requests, 25u);
  EXPECT_GT(options, 70u);
}

}  // namespace
}  // namespace vernier::page_requests_test
