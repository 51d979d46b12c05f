// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/commands/help_text.h"

#include <algorithm>

#include "tools/commands/description.h"
#include "tools/text/words.h"

namespace vernier::commands {
namespace {

constexpr std::size_t kWidth = 80, kBeside = 26;

/// Columns that a text takes: letters of UTF-8, not their bytes.
std::size_t columns(std::string_view text) {
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0u) != 0x80u; }));
}

/// Words in lines of kWidth, all but the first indented; `used` columns of the first are taken.
std::string wrapped(const std::string& text, std::size_t indent, std::size_t used) {
  std::string result;
  std::size_t at = used;
  for (const std::string& word : text::words_in(text, " \n")) {
    const std::size_t size = columns(word);
    const bool begins = at <= std::max(indent, used);
    if (!begins && at + 1 + size > kWidth) {
      result += "\n" + std::string(indent, ' ');
      at = indent;
    } else if (!begins) {
      result += " ";
      ++at;
    }
    result += word;
    at += size;
  }
  return result + "\n";
}

std::string beside(std::string left, const std::string& right) {
  left = "  " + left;
  if (right.empty()) return left + "\n";
  if (columns(left) + 2 > kBeside)
    return left + "\n" + std::string(kBeside, ' ') + wrapped(right, kBeside, kBeside);
  return left + std::string(kBeside - columns(left), ' ') + wrapped(right, kBeside, kBeside);
}

/// Lines that begin with a blank are not changed, the others are wrapped.
std::string paragraphs(const std::string& text) {
  std::string result, flowing;
  const auto end = [&] {
    if (!flowing.empty()) result += wrapped(flowing, 0, 0);
    flowing.clear();
  };
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t stop = std::min(text.find('\n', at), text.size());
    const std::string line = text.substr(at, stop - at);
    at = stop + 1;
    if (line.empty() || line.front() == ' ') {
      end();
      result += line + "\n";
    } else {
      flowing += " " + line;
    }
  }
  end();
  return result;
}

}  // namespace

std::string HelpText::make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const {
  std::string text = CLI::Formatter::make_help(app, std::move(name), mode);
  while (text.find("\n\n\n") != std::string::npos) text.erase(text.find("\n\n\n"), 1);
  return text.ends_with("\n\n") ? text.substr(0, text.size() - 1) : text;
}

std::pair<std::string, std::string> HelpText::option_words(const CLI::Option* option,
                                                           bool is_positional) const {
  std::string left = make_option_name(option, is_positional), right = make_option_desc(option);
  // The value of an option without the library's words for it; of the words of a set only those that the
  // description lacks.
  const std::string type = option->get_type_name();
  const std::string kind = option->get_items_expected_max() == 0 ? "" : type.substr(0, type.find(':'));
  if (!is_positional && !kind.empty())
    left += kind == "TEXT"                    ? " …"
            : kind == "FLOAT"                 ? " NUMBER"
            : kind == "UINT" || kind == "INT" ? " N"
                                              : " " + kind;
  if (std::vector<std::string> words = allowed_words(*option); !words.empty()) {
    const std::string all = text::joined(words, " ");
    std::erase_if(words, [&](const std::string& word) { return right.find(word) != std::string::npos; });
    if (!words.empty()) right += ": " + all;
  }
  if (!option->get_default_str().empty()) right += " (default " + option->get_default_str() + ")";
  if (option->get_required() && !is_positional) right += " (required)";
  return {left, right};
}

std::string HelpText::make_option(const CLI::Option* option, bool is_positional) const {
  const auto [left, right] = option_words(option, is_positional);
  return beside(left, right);
}

std::string HelpText::make_subcommand(const CLI::App* command) const {
  return beside(command->get_name(), command->get_description());
}

std::string HelpText::make_footer(const CLI::App* app) const {
  const std::string footer = app->get_footer();
  return footer.empty() ? "" : "\n" + paragraphs(footer);
}

std::string HelpText::make_description(const CLI::App* app) const {
  return paragraphs(app->get_description());
}

std::string HelpText::make_usage(const CLI::App* app, std::string name) const {
  return wrapped(text::trimmed(CLI::Formatter::make_usage(app, std::move(name))), 4, 0) + "\n";
}

}  // namespace vernier::commands
