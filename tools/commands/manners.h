// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace vernier::commands {

/// Converts the arguments `help fit` to `fit --help`, and `help` to `--help`.
std::vector<std::string> without_help_command(std::vector<std::string> arguments);

/// Throws InputError if the first word is not the name of a command or of its kind. The error message
/// suggests the most similar name.
void require_known_commands(const CLI::App& vernier, const std::vector<std::string>& arguments);

/// Returns a suggestion if the parser reports an unknown option: "did you mean --json?". The suggestion is
/// empty for all other errors of the parser.
std::string option_meant(const CLI::App& vernier, const CLI::ParseError& error);

/// Returns the message of the parser with plain words for a range that has no end: the parser prints the
/// largest number that a program can store.
std::string plain_range(const std::string& message);

/// Throws InputError for a word of several letters after one hyphen ("-out z.xml") that is similar to the
/// name of an option. Reason: the parser reads -out as the option -o with the value "ut".
void require_known_dashes(const CLI::App& vernier, const std::vector<std::string>& arguments);

/// Changes all numeric options: a number must be a finite decimal number, and a count must not be negative.
/// The change of the numeric options is necessary because the parser accepts "nan", "0x1f" and -1, and no
/// range excludes nan.
void take_plain_numbers(CLI::App& vernier);

/// Throws InputError if a measurement file is given instead of a machine file, or the reverse. The message
/// contains the corrected command.
void require_files_in_their_places(const CLI::App& vernier, const std::vector<std::string>& arguments);

/// Prints the warnings of lint about the machine file if the command fits, evaluates or compiles the machine.
/// Each warning is printed once, to standard error.
void warn_of_machine(const CLI::App& vernier);

/// Returns the command that imports the spreadsheet to which an error message refers; empty for other
/// messages.
std::string import_hint(const std::string& message, const std::vector<std::string>& arguments);

}  // namespace vernier::commands
