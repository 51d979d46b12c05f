// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/commands/manual.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <memory>

#include "tools/commands/command.h"
#include "tools/commands/help_text.h"
#include "tools/text/files.h"

namespace vernier::commands {
namespace {

std::vector<const CLI::App*> commands_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

/// Text for troff: no line of it is a request, a hyphen is the character that is typed.
std::string escaped(const std::string& text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool begins = i == 0 || text[i - 1] == '\n';
    if (begins && (text[i] == '.' || text[i] == '\'')) result += "\\&";
    if (text[i] == '\\')
      result += "\\e";
    else if (text[i] == '-')
      result += "\\-";
    else
      result += text[i];
  }
  return result;
}

std::string hyphened(std::string names) {
  std::replace(names.begin(), names.end(), ' ', '-');
  return names;
}

/// Lines that begin with a blank are not changed, the others are wrapped.
std::string notes_of(const std::string& text) {
  std::string result;
  bool kept = false;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string line = text.substr(at, end - at);
    at = end + 1;
    const bool keep = line.starts_with(' ');
    if (keep != kept) result += keep ? ".nf\n" : ".fi\n";
    kept = keep;
    result += line.empty() ? ".PP\n" : escaped(line) + "\n";
  }
  return result + (kept ? ".fi\n" : "");
}

std::string items(const CLI::App& command, bool positional) {
  const HelpText help;
  std::string text;
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_positional() != positional || option->get_group().empty()) continue;
    const auto [left, right] = help.option_words(option, positional);
    text += ".TP\n\\fB" + escaped(left) + "\\fR\n" + escaped(right.empty() ? "\\&" : right) + "\n";
  }
  return text;
}

void write_pages(const CLI::App& command, const std::string& names, const std::string& directory,
                 const std::string& version, std::size_t& count) {
  text::write_file(directory + "/" + hyphened(names) + ".1", manual_page(command, names, version));
  ++count;
  for (const CLI::App* one : commands_of(command))
    if (one->get_name() != "help")
      write_pages(*one, names + " " + one->get_name(), directory, version, count);
}

}  // namespace

std::string manual_page(const CLI::App& command, const std::string& names, const std::string& version) {
  std::string title = hyphened(names);
  std::transform(title.begin(), title.end(), title.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  const std::string what = command.get_description();
  std::string text = fmt::format(".TH {} 1 \"\" \"{}\" \"Vernier\"\n.SH NAME\n{} \\- {}\n", title, version,
                                 escaped(hyphened(names)), escaped(what.substr(0, what.find('\n'))));
  text += ".SH SYNOPSIS\n\\fB" + escaped(names) + "\\fR";
  const auto below = commands_of(command);
  const std::string positionals = items(command, true);
  if (!items(command, false).empty()) text += " [\\fIOPTIONS\\fR]";
  for (const CLI::Option* option : command.get_options())
    if (option->get_positional()) {
      const std::string word = "\\fI" + escaped(option->get_name(true, false)) +
                               (option->get_items_expected_max() > 1 ? "\\fR..." : "\\fR");
      text += option->get_required() ? " " + word : " [" + word + "]";
    }
  if (!below.empty()) text += " \\fICOMMAND\\fR";
  text += "\n";
  if (!positionals.empty()) text += ".SH ARGUMENTS\n" + positionals;
  text += ".SH OPTIONS\n" + items(command, false);
  if (!below.empty()) {
    text += ".SH COMMANDS\n";
    for (const CLI::App* one : below)
      text += ".TP\n\\fB" + escaped(one->get_name()) + "\\fR\n" + escaped(one->get_description()) + "\n";
  }
  if (!command.get_footer().empty()) text += ".SH NOTES\n" + notes_of(command.get_footer());
  text += ".SH SEE ALSO\n";
  text += names == "vernier" ? "Each command has a separate page: \\fBvernier\\-fit\\fR(1) and so on.\n"
                             : "\\fBvernier\\fR(1)\n";
  return text;
}

namespace manual_cli {

void register_manual(CLI::App& vernier) {
  const auto directory = std::make_shared<std::string>();
  CLI::App* command = vernier.add_subcommand("manual", "Write the manual pages of all commands (troff)");
  command->add_option("-o,--output", *directory, "folder for vernier.1, vernier-fit.1 …")
      ->type_name(kWritesFolder)
      ->required();
  command->footer("  vernier manual -o build/man && man build/man/vernier-fit.1");
  command->callback([directory, &vernier] {
    text::make_folder(*directory);
    std::size_t count = 0;
    const std::string version = vernier.version();  // "vernier 1.2.0 (commit)"
    write_pages(vernier, "vernier", *directory, version.substr(0, version.find(" (")), count);
    fmt::print("{}: {} pages\n", *directory, count);
  });
}

}  // namespace manual_cli
}  // namespace vernier::commands
