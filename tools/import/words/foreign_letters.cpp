// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/words/foreign_letters.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>

#include "tools/sheet/encoding.h"

namespace vernier::importer {
namespace {

bool has_foreign_letters(const std::string& text) {
  constexpr std::size_t kInARow = 3;  // "über" has one, "naïveté" two that are apart
  if (text.find("\uFFFD") != std::string::npos) return true;
  std::size_t row = 0;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    constexpr unsigned char kAscii = 0x80, kFirstOfLetter = 0xC0;
    if (byte < kAscii)
      row = 0;
    else if (byte >= kFirstOfLetter && ++row >= kInARow)
      return true;
  }
  return false;
}

}  // namespace

void note_foreign_letters(sheet::Sheet& sheet, const sheet::SheetTable& table) {
  if (sheet.workbook || sheet.encoding != sheet::Encoding::kWindows1252) return;
  const auto found = std::find_if(table.headings.begin(), table.headings.end(),
                                  [](const auto& one) { return has_foreign_letters(one.text); });
  if (found == table.headings.end()) return;
  sheet.notes.push_back(fmt::format(
      "the file is read in the encoding Windows-1252, and the heading \"{}\" is no word in it: save "
      "the table as UTF-8 or as .xlsx, so that its headings can be read",
      found->text));
}

}  // namespace vernier::importer
