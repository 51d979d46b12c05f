// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <map>
#include <memory>

#include "tools/commands/command.h"
#include "tools/commands/description.h"
#include "tools/text/error.h"
#include "tools/text/words.h"

namespace vernier::commands::completion_cli {
namespace {

/// Words behind a command: its kinds, or its options.
std::vector<std::string> words_of(const CLI::App& command) {
  std::vector<std::string> words;
  for (const CLI::App* kind : command.get_subcommands([](const CLI::App*) { return true; }))
    words.push_back(kind->get_name());
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames()) words.push_back("--" + name);
  return words;
}

/// Endings of the files that a positional argument reads; "": files of any ending.
std::string endings_of(const std::string& argument) {
  static const std::map<std::string, std::string> kEndings = {
      {"MACHINE", "xml"}, {"MEAS", "csv"}, {"PART", "csv ngc nc"}, {"PATH", "csv ngc nc"}};
  const auto found = kEndings.find(argument);
  return found == kEndings.end() ? "" : found->second;
}

/// Endings of the files that a command reads as arguments; "": of any ending.
std::string endings_of(const CLI::App& command) {
  std::string endings;
  for (const CLI::Option* option : command.get_options()) {
    if (!option->get_positional()) continue;
    const std::string known = endings_of(option->get_name(true));
    if (known.empty()) return "";
    endings += (endings.empty() ? "" : " ") + known;
  }
  return endings;
}

/// A place where words are asked for, by the commands before it: "", "fit", "import table".
struct WordPlace {
  std::string commands, endings;
  std::vector<std::string> words;
};

std::vector<WordPlace> places_of(const CLI::App& vernier) {
  std::vector<WordPlace> places = {{"", "", words_of(vernier)}};
  for (const CLI::App* command : vernier.get_subcommands([](const CLI::App*) { return true; })) {
    places.push_back({command->get_name(), endings_of(*command), words_of(*command)});
    for (const CLI::App* kind : command->get_subcommands([](const CLI::App*) { return true; }))
      places.push_back({command->get_name() + " " + kind->get_name(), endings_of(*kind), words_of(*kind)});
  }
  return places;
}

/// A function that looks up the words by the commands typed so far. Beside them it completes files: those
/// that the command reads; behind an option files of any kind. zsh reads it too.
std::string bash(const CLI::App& vernier) {
  std::string text =
      "# bash completion of vernier; source it, or put it into /etc/bash_completion.d\n"
      "_vernier() {\n  local current=\"${COMP_WORDS[COMP_CWORD]}\" place=\"\" word words kinds ending\n"
      "  for word in \"${COMP_WORDS[@]:1:COMP_CWORD-1}\"; do\n    case \"${place:+$place }$word\" in\n";
  std::string known;
  for (const auto& [place, endings, words] : places_of(vernier))
    if (!place.empty()) known += (known.empty() ? "" : "|") + std::string("'") + place + "'";
  text +=
      "      " + known + ") place=\"${place:+$place }$word\" ;;\n    esac\n  done\n  case \"$place\" in\n";
  for (const auto& [place, endings, words] : places_of(vernier))
    text += "    '" + place + "') words='" + text::joined(words, " ") + "' kinds='" + endings + "' ;;\n";
  return text +
         "  esac\n  COMPREPLY=($(compgen -W \"$words\" -- \"$current\"))\n"
         "  [[ \"$current\" == -* || -z \"$place\" ]] && return\n"
         "  if [[ -z \"$kinds\" || \"${COMP_WORDS[COMP_CWORD-1]}\" == -* ]]; then\n"
         "    COMPREPLY+=($(compgen -f -- \"$current\"))\n"
         "  else\n"
         "    for ending in $kinds; do COMPREPLY+=($(compgen -f -X \"!*.$ending\" -- \"$current\")); done\n"
         "    COMPREPLY+=($(compgen -d -- \"$current\"))\n"
         "  fi\n}\n"
         "complete -o filenames -F _vernier vernier\n";
}

std::string zsh(const CLI::App& vernier) {
  return "#compdef vernier\nautoload -U +X bashcompinit && bashcompinit\n" + bash(vernier);
}

std::string fish(const CLI::App& vernier) {
  std::string text = "# fish completion of vernier; put it into ~/.config/fish/completions/vernier.fish\n";
  for (const CLI::App* command : vernier.get_subcommands([](const CLI::App*) { return true; })) {
    std::string description = command->get_description();
    for (std::size_t at = 0; (at = description.find('\'', at)) != std::string::npos; at += 2)
      description.insert(at, "\\");
    text += fmt::format("complete -c vernier -n __fish_use_subcommand -f -a {} -d '{}'\n",
                        command->get_name(), description);
    for (const std::string& word : words_of(*command))
      text += word.starts_with("--")
                  ? fmt::format("complete -c vernier -n '__fish_seen_subcommand_from {}' -l {}\n",
                                command->get_name(), word.substr(2))
                  : fmt::format("complete -c vernier -n '__fish_seen_subcommand_from {}' -f -a {}\n",
                                command->get_name(), word);
  }
  return text;
}

}  // namespace

void register_completion(CLI::App& vernier) {
  const auto shell = std::make_shared<std::string>();
  CLI::App* command = vernier.add_subcommand(
      "completion", "Print completion words for a shell: bash, zsh, fish; or all options as JSON");
  command
      ->add_option("SHELL", *shell, "bash, zsh or fish; json: every command with its options, for programs")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh", "fish", "json"}));
  command->footer("  source <(vernier completion bash)");
  command->callback([shell, &vernier] {
    const std::string text = *shell == "bash"   ? bash(vernier)
                             : *shell == "zsh"  ? zsh(vernier)
                             : *shell == "fish" ? fish(vernier)
                                                : describe(vernier).dump(1) + "\n";
    std::fputs(text.c_str(), stdout);
  });
}

}  // namespace vernier::commands::completion_cli
