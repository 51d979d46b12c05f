// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace vernier::commands {

/// `vernier help fit` as `vernier fit --help`, `vernier help` as `vernier --help`.
std::vector<std::string> without_help_command(std::vector<std::string> arguments);

/// Throws InputError if the first word is not the name of a command or of a kind of a command; the error
/// suggests the most similar name.
void require_known_commands(const CLI::App& vernier, const std::vector<std::string>& arguments);

/// Returns a suggestion for an unknown option in a parser's message: "did you mean --json?"; else an empty
/// text.
std::string option_meant(const CLI::App& vernier, const CLI::ParseError& error);

/// Throws InputError at a word of several letters behind one dash ("-out z.xml") that begins or resembles the
/// name of an option; the parser reads -out as -o with the value "ut".
void require_known_dashes(const CLI::App& vernier, const std::vector<std::string>& arguments);

/// Makes every option of a number accept finite decimals only, and every count only values that are not
/// negative. The parser accepts "nan", "0x1f" and -1, and no range excludes nan.
void take_plain_numbers(CLI::App& vernier);

/// Throws InputError if a measurement is given instead of a machine file, or the reverse, with the corrected
/// command.
void require_files_in_their_places(const CLI::App& vernier, const std::vector<std::string>& arguments);

/// Prints the warnings of lint on the machine file, if the command fits, evaluates or compiles the machine.
/// The function prints each line once, to standard error.
void warn_of_machine(const CLI::App& vernier);

/// The command that reads the spreadsheet of an error message; empty for other messages.
std::string import_hint(const std::string& message, const std::vector<std::string>& arguments);

}  // namespace vernier::commands
