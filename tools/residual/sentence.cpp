// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/residual/sentence.h"

#include <fmt/format.h>

#include <cmath>

#include "tools/format/columns.h"

namespace vernier::residual {
namespace {

std::string unit_of(const Finding& f) { return format::report_unit_of(f.observation); }

/// "Y error", "rotation error about X", "length error", "deviation d".
std::string subject(const Finding& f) {
  const auto kind = format::kind_named(f.observation);
  return kind ? format::subject_of(*kind) : f.observation;
}

std::string with_unit(double value, const std::string& unit) {
  return fmt::format("{:.4g}{}{}", value, unit.empty() ? "" : " ", unit);
}

/// Returns "3.1 um per 100 mm": over a round part of the range, so that the number is readable.
std::string slope(const Finding& f, const SentenceFacts& facts) {
  const double range = facts.high - facts.low;
  const double per = std::pow(10, std::floor(std::log10(range)));
  return fmt::format("{:.3g} {} per {}", std::abs(facts.at_high_um - facts.at_low_um) * per / range,
                     unit_of(f), with_unit(per, facts.unit.empty() ? f.column : facts.unit));
}

std::string spanning(const Finding& f, const SentenceFacts& facts) {
  return fmt::format("{:.3g} {} in all over {} to {}", f.high_um - f.low_um, unit_of(f),
                     fmt::format("{:.4g}", facts.low), with_unit(facts.high, facts.unit));
}

std::string grows(const SentenceFacts& facts) {
  return facts.at_high_um > facts.at_low_um ? "grows" : "falls";
}

std::string reverses(const Finding& f) {
  return fmt::format("{} reverses with {}: {:.3g} {} between the two approach directions", subject(f),
                     f.column, f.high_um - f.low_um, unit_of(f));
}

std::string along_column(const Finding& f, const SentenceFacts& facts) {
  const std::string change = facts.time ? (facts.monotone ? "drifts" : "drifts and returns") : grows(facts);
  switch (f.shape) {
    case Shape::kLinear:
      return fmt::format("{} {} with {}, in proportion ({})", subject(f), change, f.column, slope(f, facts));
    case Shape::kSquare:
      return fmt::format("{} {} with {}, in proportion to its square ({})", subject(f),
                         std::abs(facts.high) >= std::abs(facts.low) ? grows(facts)
                         : facts.at_low_um > facts.at_high_um        ? "grows"
                                                                     : "falls",
                         f.column, spanning(f, facts));
    default:
      break;
  }
  // The curve has three places: the two directions, and the rows whose direction is not known.
  if (facts.direction && facts.monotone) return reverses(f);
  if (facts.monotone)
    return fmt::format("{} {} with {}, on a curve ({})", subject(f), change, f.column, spanning(f, facts));
  return fmt::format("{} bends with {}: highest near {}, lowest near {} ({})", subject(f), f.column,
                     with_unit(facts.highest_at, facts.unit), with_unit(facts.lowest_at, facts.unit),
                     spanning(f, facts));
}

/// Further periods of the same pattern, and periods that the positions do not distinguish from it.
std::string other_periods(const Finding& f, const SentenceFacts& facts) {
  const auto list = [&](const std::vector<double>& periods) {
    std::string text;
    for (std::size_t i = 0; i < periods.size(); ++i)
      text += fmt::format("{}{:.4g}", i == 0 ? "" : i + 1 == periods.size() ? " and " : ", ", periods[i]);
    return text + (facts.unit.empty() ? "" : " " + facts.unit);
  };
  std::string text;
  if (!f.parts.empty())
    text += fmt::format("; the period{} {} {} to this pattern", f.parts.size() > 1 ? "s" : "", list(f.parts),
                        f.parts.size() > 1 ? "belong" : "belongs");
  if (!f.aliases.empty())
    text += fmt::format("; at positions {} apart, the periods {} give the same readings",
                        with_unit(facts.step, facts.unit), list(f.aliases));
  return text;
}

std::string statement(const Finding& f, const SentenceFacts& facts) {
  const double half = (f.high_um - f.low_um) / 2;
  switch (f.shape) {
    case Shape::kConstant:
      return fmt::format("{} is {:.3g} {} on average", subject(f), (f.high_um + f.low_um) / 2, unit_of(f));
    case Shape::kReverses:
      return reverses(f);
    case Shape::kJumps:
      return fmt::format("{} jumps between runs: {:.3g} {} from run {} to run {}", subject(f),
                         f.high_um - f.low_um, unit_of(f), facts.lowest_run, facts.highest_run);
    case Shape::kPeriodic:
      return fmt::format("{} repeats every {} of {} with an amplitude of {:.3g} {}", subject(f),
                         with_unit(f.period.value_or(0), facts.unit), f.column, half, unit_of(f)) +
             other_periods(f, facts);
    case Shape::kProduct:
      if (f.column == format::columns::kRun || f.second_column == format::columns::kRun)
        return fmt::format("{} depends on {} differently from run to run ({:.3g} {} in all)", subject(f),
                           f.column == format::columns::kRun ? f.second_column : f.column,
                           f.high_um - f.low_um, unit_of(f));
      return fmt::format(
          "{} depends on {} times {}: the dependence on one of the two changes with the other ({:.3g} {} in "
          "all)",
          subject(f), f.column, f.second_column, f.high_um - f.low_um, unit_of(f));
    case Shape::kWanders:
      if (facts.in_space)
        return fmt::format(
            "{} is nearly the same in successive rows (correlation {:.2f}), and successive rows are "
            "neighbours "
            "in position: the error depends on the position in a way that no single column shows, or it "
            "drifts",
            subject(f), facts.at_low_um);
      return fmt::format(
          "{} drifts slowly: successive rows agree (correlation {:.2f}), and no recorded column explains "
          "this",
          subject(f), facts.at_low_um);
    default:
      return along_column(f, facts);
  }
}

std::string runs_clause(const Finding& f, const SentenceFacts& facts) {
  if (f.in_all_runs) return ", in all runs";
  if (f.runs < 2) return "";
  if (f.runs_agreeing == 0) return fmt::format(", but none of {} runs shows it alone", f.runs);
  std::string names;
  constexpr std::size_t kMostNamed = 3;  // in a sentence
  for (std::size_t i = 0; i < facts.disagreeing.size() && i < kMostNamed; ++i)
    names += (i > 0 ? ", " : "") +
             (facts.disagreeing[i].empty() ? std::string("the rows without a run") : facts.disagreeing[i]);
  if (facts.disagreeing.size() > kMostNamed) names += " ...";
  return fmt::format(", in {} of {} runs (not in {})", f.runs_agreeing, f.runs, names);
}

}  // namespace

std::string sentence_of(const Finding& f, const SentenceFacts& facts) {
  std::string text = statement(f, facts) + runs_clause(f, facts);
  if (f.alike.empty()) return text;
  std::string names;
  constexpr std::size_t kMostNamed = 4;  // in a sentence
  for (std::size_t i = 0; i < f.alike.size() && i < kMostNamed; ++i)
    names += (i > 0 ? ", " : "") + f.alike[i];
  return text + "; " + names +
         (f.alike.size() > kMostNamed ? " and others move"
          : f.alike.size() > 1        ? " move"
                                      : " moves") +
         " along with it and would explain as much";
}

}  // namespace vernier::residual
