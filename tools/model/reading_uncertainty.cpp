// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/model/reading_uncertainty.h"

#include <fmt/format.h>

#include <cctype>

#include "tools/format/units.h"
#include "tools/maths/factors.h"
#include "tools/text/error.h"
#include "tools/text/numbers.h"
#include "tools/text/words.h"

namespace vernier::model {
namespace {

constexpr double kMmPerMetre = 1e3;

std::string without_spaces(const std::string& text) {
  std::string kept;
  for (const char c : text)
    if (std::isspace(static_cast<unsigned char>(c)) == 0) kept += c;
  return kept;
}

[[noreturn]] void refuse(const std::string& term) {
  throw text::InputError(
      fmt::format("\"{}\": an uncertainty of readings is written as \"15um + 6um/m\" or, in um with L in mm, "
                  "as \"2.5 + L/300\"",
                  term));
}

/// Adds "6um/m" and the like. A bare number is um, as in "2.5 + L/300".
void add_length(const std::string& term, ReadingUncertainty& sum) {
  const std::string suffix = "/m";
  const bool per_metre = term.size() > suffix.size() && term.ends_with(suffix);
  const std::string length = per_metre ? term.substr(0, term.size() - suffix.size()) : term;
  const std::size_t unit_at = length.find_first_not_of("0123456789.");
  const auto number = text::parse_number(length.substr(0, unit_at));
  const std::string name = unit_at == std::string::npos ? "um" : length.substr(unit_at);
  const auto unit = format::find_unit(name);
  if (!number || !unit || unit->dimension != format::Dimension::kLength) refuse(term);
  const double mm = *number * unit->factor;
  if (per_metre)
    sum.per_mm += mm / kMmPerMetre;
  else
    sum.constant_mm += mm;
}

}  // namespace

ReadingUncertainty parse_reading_uncertainty(const std::string& text) {
  ReadingUncertainty sum;
  for (const std::string& term : text::parts_of(without_spaces(text), '+')) {
    if (term.starts_with("L/")) {
      const auto divisor = text::parse_number(term.substr(2));
      if (!divisor || *divisor <= 0) refuse(term);
      sum.per_mm += 1 / (*divisor * maths::kUmPerMm);
    } else {
      add_length(term, sum);
    }
  }
  if (sum.constant_mm <= 0 && sum.per_mm <= 0) refuse(text);
  return sum;
}

}  // namespace vernier::model
