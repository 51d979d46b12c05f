// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <utility>

namespace vernier::commands {

/// Formats the help text with 80 columns: names on the left, wrapped descriptions on the right, paragraphs
/// below.
class HelpText : public CLI::Formatter {
 public:
  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override;
  /// Returns two texts for an option: its names with its value, and its description with choices and default.
  std::pair<std::string, std::string> option_words(const CLI::Option* option, bool is_positional) const;
  std::string make_option(const CLI::Option* option, bool is_positional) const override;
  std::string make_subcommand(const CLI::App* command) const override;
  std::string make_footer(const CLI::App* app) const override;
  std::string make_description(const CLI::App* app) const override;
  std::string make_usage(const CLI::App* app, std::string name) const override;
};

}  // namespace vernier::commands
