// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/commands/manners.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>

#include "tools/lint/machine_lint.h"
#include "tools/lint/measurement_lint.h"
#include "tools/sheet/encoding.h"
#include "tools/text/error.h"
#include "tools/text/numbers.h"
#include "tools/text/similar.h"
#include "tools/text/words.h"

namespace vernier::commands {
namespace {

/// Size of the part of a file that is read for a hint: any machine file, and more than the headings of a
/// table.
constexpr std::size_t kMostRead = 1u << 22;

std::vector<std::string> names_of_commands(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  return names;
}

const CLI::App* command_named(const CLI::App& app, const std::string& name) {
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    if (command->get_name() == name) return command;
  return nullptr;
}

/// The commands that were asked for, outermost first.
std::vector<const CLI::App*> parsed_commands(const CLI::App& app) {
  std::vector<const CLI::App*> list = {&app};
  while (!list.back()->get_subcommands().empty()) list.push_back(list.back()->get_subcommands().front());
  return list;
}

/// The beginning of an ordinary file; empty for other files (a device may never end) or if it cannot be
/// opened.
std::string head_of(const std::string& path, std::size_t most = 4096) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return {};
  std::ifstream file(path, std::ios::binary);
  std::string head(most, '\0');
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(std::max<std::streamsize>(file.gcount(), 0)));
  return head;
}

bool is_xml(const std::string& head) {
  const std::string bare = text::trimmed(head.starts_with("\xEF\xBB\xBF") ? head.substr(3) : head);
  return bare.starts_with('<');
}

/// A table by its looks: text, and its first line that is no remark has a separator and no angle bracket.
bool is_table(const std::string& head) {
  if (head.empty() || is_xml(head) || head.find('\0') != std::string::npos) return false;
  for (const std::string& line : text::parts_of(head, '\n'))
    if (!line.empty() && line.front() != '#') return line.find_first_of(",;\t") != std::string::npos;
  return false;
}

std::vector<std::string> values_of(const CLI::App& command, const char* name) {
  for (const CLI::Option* option : command.get_options())
    if (option->get_name(true) == name || option->get_name() == name) return option->results();
  return {};
}

}  // namespace

std::vector<std::string> without_help_command(std::vector<std::string> arguments) {
  if (arguments.empty() || arguments.front() != "help") return arguments;
  arguments.erase(arguments.begin());
  arguments.emplace_back("--help");
  return arguments;
}

void require_known_commands(const CLI::App& vernier, const std::vector<std::string>& arguments) {
  const CLI::App* app = &vernier;
  for (const std::string& word : arguments) {
    if (names_of_commands(*app).empty() || word.starts_with('-')) return;
    const CLI::App* next = command_named(*app, word);
    if (next == nullptr) {
      const auto meant = text::word_meant(word, names_of_commands(*app));
      const std::string group = app == &vernier ? "" : " " + app->get_name();
      throw text::InputError(fmt::format(
          "\"{}\" is not a command of vernier{}{}", word, group,
          meant ? "; did you mean vernier" + group + " " + *meant + "?" : "; vernier help lists them"));
    }
    app = next;
  }
}

std::string option_meant(const CLI::App& vernier, const CLI::ParseError& error) {
  const std::string message = error.what();
  const auto at = message.find("--");
  if (dynamic_cast<const CLI::ExtrasError*>(&error) == nullptr || at == std::string::npos) return "";
  const std::string word = message.substr(at, message.find_first_of(" =\n", at) - at);
  std::vector<std::string> names;
  for (const CLI::App* command : parsed_commands(vernier))
    for (const CLI::Option* option : command->get_options())
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  const auto meant = text::word_meant(word, names);
  return meant ? fmt::format("\"{}\": no option of this command; did you mean {}?", word, *meant) : "";
}

std::string plain_range(const std::string& message) {
  const auto begin = message.find(" not in range ");
  const auto end = message.find('\n', begin);
  const std::string largest = fmt::format(" to {:f}", std::numeric_limits<double>::max());
  if (begin == std::string::npos || message.substr(begin, end - begin).find(largest) == std::string::npos)
    return message;
  return message.substr(0, begin) + " is not a positive number" +
         (end == std::string::npos ? "" : message.substr(end));
}

void require_known_dashes(const CLI::App& vernier, const std::vector<std::string>& arguments) {
  const CLI::App* command = &vernier;
  std::size_t at = 0;
  for (; at < arguments.size(); ++at) {
    const CLI::App* const next = command_named(*command, arguments[at]);
    if (next == nullptr) break;
    command = next;
  }
  const CLI::Option* before = nullptr;  // takes the next word as its value
  for (; at < arguments.size() && arguments[at] != "--"; ++at) {
    const std::string& word = arguments[at];
    const bool value = before != nullptr && before->get_items_expected_max() > 0;
    before = word.starts_with('-') ? command->get_option_no_throw(word) : nullptr;
    if (value || before != nullptr || word.size() < 3 || word[0] != '-' ||
        std::isalpha(static_cast<unsigned char>(word[1])) == 0)
      continue;
    const std::string name = word.substr(1, word.find('=') - 1);
    std::vector<std::string> names;
    for (const CLI::Option* option : command->get_options())
      for (const std::string& known : option->get_lnames()) names.push_back(known);
    const auto begun = std::find_if(names.begin(), names.end(),
                                    [&](const std::string& known) { return known.starts_with(name); });
    const auto meant = begun != names.end() ? std::optional(*begun) : text::word_meant(name, names);
    const bool glued = command->get_option_no_throw(word.substr(0, 2)) != nullptr;  // -oFILE
    if (!meant && glued) continue;
    throw text::InputError("\"" + word + "\": " +
                           (meant
                                ? "did you mean --" + *meant + "? An option of several letters has two dashes"
                                : "this command has no such option; --help lists the options"));
  }
}

void take_plain_numbers(CLI::App& vernier) {
  const CLI::Validator number(
      [](const std::string& word) {
        return text::parse_number(word) ? std::string() : "\"" + word + "\" is no decimal number";
      },
      "");
  const CLI::Validator count(
      [](const std::string& word) {
        return text::parse_count(word) ? std::string()
                                       : fmt::format("\"{}\" is no count (0, 1, 2, ...)", word);
      },
      "");
  for (CLI::Option* option : vernier.get_options()) {
    const std::string type = option->get_type_name();
    if (type.rfind("FLOAT", 0) == 0) option->check(number);
    if (type.rfind("UINT", 0) == 0) option->check(count);
  }
  for (CLI::App* command : vernier.get_subcommands([](const CLI::App*) { return true; }))
    take_plain_numbers(*command);
}

void require_files_in_their_places(const CLI::App& vernier, const std::vector<std::string>& arguments) {
  const CLI::App& command = *parsed_commands(vernier).back();
  const std::vector<std::string> machines = values_of(command, "MACHINE"),
                                 measurements = values_of(command, "MEAS");
  std::string table, xml;
  for (const std::string& path : machines)
    if (is_table(head_of(path))) table = path;
  for (const std::string& path : measurements)
    if (is_xml(head_of(path))) xml = path;
  if (table.empty() && xml.empty()) return;
  std::string meant;
  if (!table.empty() && !xml.empty()) {
    meant = "; did you mean vernier";
    for (const std::string& word : arguments)
      meant += " " + (word == table ? xml : word == xml ? table : word);
    meant += "?";
  }
  if (!table.empty())
    throw text::InputError({table, 0}, "",
                           "this is a measurement file, but the machine file (XML) is expected here" + meant);
  throw text::InputError(
      {xml, 0}, "",
      "this is a machine file, but a measurement file (CSV) is expected here; give the machine file first");
}

void warn_of_machine(const CLI::App& vernier) {
  static const std::vector<std::string> kCommands = {"fit",     "compare", "diagnose",
                                                     "improve", "plan",    "compile"};
  const CLI::App& command = *parsed_commands(vernier).back();
  if (std::find(kCommands.begin(), kCommands.end(), command.get_name()) == kCommands.end()) return;
  std::vector<std::string> paths = values_of(command, "MACHINE");
  if (paths.empty()) paths = values_of(command, "machine");
  for (const std::string& path : paths) {
    const std::string text = head_of(path, kMostRead);
    // The command reports files that cannot be read.
    const lint::MachineLint lint = lint::lint_machine(text, path);
    if (!lint.machine) continue;
    for (const lint::LintFinding& finding : lint.findings)
      if (finding.weight == lint::LintWeight::kWarning)
        std::fprintf(stderr, "vernier: %s\n", lint::in_one_line(finding).c_str());
  }
}

std::string import_hint(const std::string& message, const std::vector<std::string>& arguments) {
  // A command that reads it needs no hint; tables of touches are read in any form.
  static const std::set<std::string> kAnyForm = {"import", "probe-cal", "fit-feature"};
  if (!arguments.empty() && kAnyForm.contains(arguments.front())) return "";
  if (message.find("machine file (XML) is expected") != std::string::npos) return "";
  for (const std::string& path : arguments) {
    if (path.empty() || !(message.starts_with(path + ":"))) continue;
    const std::string bytes = head_of(path, kMostRead);
    if (bytes.empty() || is_xml(sheet::utf8_text(bytes))) continue;
    const std::string command = lint::import_command_for(bytes, path);
    if (!command.empty())
      return fmt::format("{} is not a measurement file; this command reads it: {}", path, command);
  }
  return "";
}

}  // namespace vernier::commands
