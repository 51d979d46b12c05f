// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/format/readings.h"

#include <algorithm>

namespace vernier::format {
namespace {

constexpr bool kinds_are_in_order() {
  for (std::size_t k = 0; k < kReadingKindCount; ++k)
    if (kReadingKinds[k].kind != static_cast<ReadingKind>(k)) return false;
  return true;
}
constexpr bool forms_are_in_order() {
  for (std::size_t k = 0; k < kReadingForms.size(); ++k)
    if (kReadingForms[k].form != static_cast<ReadingForm>(k)) return false;
  return true;
}
static_assert(kinds_are_in_order() && forms_are_in_order(),
              "the rows of kReadingKinds and kReadingForms must be in the order of their enumerators");

}  // namespace

std::optional<ReadingKind> kind_named(std::string_view name) {
  for (const ReadingKindEntry& entry : kReadingKinds)
    if (name == entry.name) return entry.kind;
  return std::nullopt;
}

std::vector<std::string> names_of_kinds(std::uint32_t kinds) {
  std::vector<std::string> names;
  for (std::size_t kind = 0; kind < kReadingKindCount; ++kind)
    if ((kinds >> kind & 1U) != 0) names.emplace_back(kReadingKinds[kind].name);
  return names;
}

const char* report_unit_of(std::string_view name) {
  return report_unit_of(kind_named(name).value_or(ReadingKind::kX));
}

std::string subject_of(ReadingKind kind) {
  std::string subject = entry_of(form_of(kind)).subject;
  if (const auto at = subject.find('%'); at != std::string::npos)
    subject.replace(at, 1, 1, "XYZ"[component_of(kind)]);
  return subject;
}

const SurveyReading* survey_reading(std::string_view word) {
  const auto* const found = std::find_if(kSurveyReadings.begin(), kSurveyReadings.end(),
                                         [&](const SurveyReading& one) { return word == one.word; });
  return found == kSurveyReadings.end() ? nullptr : found;
}

std::string survey_words(const std::string& last) {
  std::string words;
  for (std::size_t i = 0; i < kSurveyReadings.size(); ++i) {
    if (i > 0) words += i + 1 == kSurveyReadings.size() ? " " + last + " " : ", ";
    words += kSurveyReadings[i].word;
  }
  return words;
}

}  // namespace vernier::format
