// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/commands/report_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string_view>

#include "tools/commands/command.h"
#include "tools/report/assets.h"
#include "tools/text/error.h"
#include "tools/text/files.h"
#include "tools/text/words.h"

namespace vernier::commands {
namespace {

using Entries = std::vector<std::pair<std::string, std::string>>;

std::string signs_of(const std::string& text) {
  std::string signs;
  std::copy_if(text.begin(), text.end(), std::back_inserter(signs),
               [](char c) { return c == '#' || c == '*'; });
  return signs;
}

/// Reads the texts of a language for the pages: {"language": "de", "decimal": ",", "texts": {English:
/// translation}}. In a text # is a number and * any words, in the translation the same signs in the same
/// order.
nlohmann::ordered_json parse_catalogue(std::string_view json, const std::string& file) {
  constexpr std::size_t kDeepest = 8;
  const auto fail = [&](const std::string& word, const std::string& what) {
    throw text::InputError({file, 0}, word, what);
  };
  if (text::nests_deeper_than(json, kDeepest)) fail("catalogue", "the JSON is nested too deeply");
  nlohmann::ordered_json catalogue = nlohmann::ordered_json::parse(json, nullptr, false);
  if (!catalogue.is_object() || !catalogue.contains("texts") || !catalogue["texts"].is_object())
    fail("catalogue",
         "a catalogue of texts is JSON: {\"language\": \"fr\", \"decimal\": \",\", \"texts\": {\"Summary\": "
         "…}}");
  for (const char* const name : {"language", "decimal"})
    if (catalogue.contains(name) && !catalogue[name].is_string()) fail(name, "must be a text");
  for (const auto& [text, translation] : catalogue["texts"].items()) {
    if (!translation.is_string()) fail(text, "the translation must be a text");
    if (signs_of(text) != signs_of(translation.get<std::string>()))
      fail(text,
           "the translation must contain the same placeholders # (a number) and * (words) as the English "
           "text, in the same order");
  }
  return catalogue;
}

bool take(Entries& entries, const std::string& words) {
  const auto at = words.find('=');
  if (at == std::string::npos) return false;
  const std::string key = text::trimmed(words.substr(0, at)), value = text::trimmed(words.substr(at + 1));
  if (key.empty() || value.empty()) return false;
  const auto known =
      std::find_if(entries.begin(), entries.end(), [&](const auto& one) { return one.first == key; });
  if (known == entries.end())
    entries.emplace_back(key, value);
  else
    known->second = value;
  return true;
}

}  // namespace

Entries ReportHeader::entries() const {
  Entries entries;
  std::size_t number = 0;
  for (const std::string& line :
       file.empty() ? std::vector<std::string>{} : text::parts_of(text::read_file(file), '\n')) {
    ++number;
    const std::string words = text::trimmed(line);
    if (words.empty() || words.front() == '#') continue;
    if (!take(entries, words))
      throw text::InputError({file, number}, words, "a letterhead has lines like \"company = Muster GmbH\"");
  }
  for (const std::string& words : given)
    if (!take(entries, words))
      throw text::InputError(fmt::format("--header {}: of the form \"serial number=4711\"", words));
  return entries;
}

nlohmann::ordered_json ReportHeader::on(nlohmann::ordered_json page) const {
  if (!translation.empty())
    page["catalogue"] = parse_catalogue(text::read_file(translation), translation);
  else if (!language.empty())
    page["catalogue"] = parse_catalogue(report::report_german(), "de");
  const Entries list = entries();
  if (list.empty()) return page;
  page["header"] = nlohmann::ordered_json::array();
  for (const auto& [key, value] : list) page["header"].push_back({key, value});
  return page;
}

void add_report_header(CLI::App& command, ReportHeader& header) {
  command
      .add_option("--header", header.given,
                  "entry at the head of the report: \"serial number=4711\", company, operator, instrument, "
                  "date, temperature …; repeat the option for each entry")
      ->allow_extra_args(false);
  command
      .add_option("--letterhead", header.file,
                  "file with entries for the head of every report, one entry per line")
      ->type_name(kReads);
  CLI::Option* const language =
      command
          .add_option("--language", header.language, "language of the report's texts: de (default: English)")
          ->check(CLI::IsMember({"de"}));
  command
      .add_option("--translation", header.translation,
                  "a file (JSON) with the texts of another language; tools/docs/languages.md has its form")
      ->type_name(kReads)
      ->excludes(language);
}

}  // namespace vernier::commands
