// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/commands/report_header.h"

#include <algorithm>

#include "tools/commands/command.h"
#include "tools/text/error.h"
#include "tools/text/files.h"
#include "tools/text/words.h"

namespace vernier::commands {
namespace {

using Entries = std::vector<std::pair<std::string, std::string>>;

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
      throw text::InputError("--header " + words + ": of the form \"serial number=4711\"");
  return entries;
}

nlohmann::ordered_json ReportHeader::on(nlohmann::ordered_json page) const {
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
}

}  // namespace vernier::commands
