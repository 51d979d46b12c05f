// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/diagnose/sentences.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "tools/effects/spoken.h"

namespace vernier::diagnose {

const char* verdict_name(Verdict verdict) {
  switch (verdict) {
    case Verdict::kMissingEffect:
      return "missing-effect";
    case Verdict::kAmbiguous:
      return "ambiguous";
    case Verdict::kUnexplained:
      return "unexplained";
    case Verdict::kInstrument:
      return "instrument";
    case Verdict::kConsistent:
      break;
  }
  return "consistent";
}

std::string said_of(const CandidateFinding& finding) {
  std::vector<effects::SpokenValue> values;
  for (const fit::ParameterEstimate& one : finding.parameters)
    values.push_back({one.name, one.value, one.std});
  return effects::spoken_with_size(finding.candidate, values);
}

std::string where_left(const residual::FailurePicture& left) {
  std::string text;
  constexpr std::size_t kSentences = 3;  // number of sentences that a reader can follow
  for (std::size_t i = 0; i < std::min(kSentences, left.findings.size()); ++i)
    text += " " + left.findings[i].sentence + ".";
  return text;
}

namespace {

/// The figures that decide if an rms in um increases: it consists mostly of the least accurate instrument.
std::string of_files(const LadderStep& first, const LadderStep& last) {
  if (first.check_files.size() != last.check_files.size()) return {};
  std::string list;
  for (std::size_t i = 0; i < first.check_files.size(); ++i)
    list += fmt::format("{}{} {:.3g} to {:.3g}", list.empty() ? "" : ", ", first.check_files[i].file,
                        first.check_files[i].rms, last.check_files[i].rms);
  if (list.empty()) return {};
  return ". The decision weights each check row by 1/u^2: rms of residual / u in each file: " + list;
}

}  // namespace

std::string check_rows_in_words(const std::vector<LadderStep>& steps, std::size_t accepted) {
  std::string way, worse;
  const bool lengths = steps[0].check_rms_um.has_value();
  const auto left = [&](const LadderStep& step) { return lengths ? step.check_rms_um : step.check_rms_urad; };
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (!left(steps[i])) return {};
    way += fmt::format("{}{:.4g}", i == 0 ? "" : " to ", *left(steps[i]));
    if (i > 0 && *left(steps[i]) > *left(steps[i - 1])) worse += (worse.empty() ? "" : ", ") + steps[i].said;
  }
  std::string text =
      fmt::format(" With {} effect{} the rms of the check rows (held-out rows) changes from {} {}", accepted,
                  accepted == 1 ? "" : "s", way, lengths ? "um" : "urad");
  if (!worse.empty()) text += "; the rms increases with " + worse + of_files(steps.front(), steps.back());
  return text + ".";
}

std::string all_check_rows_in_words(const ExcludedRows& left_out) {
  const bool lengths = left_out.check_rms_um.has_value();
  const std::optional<double>& rms = lengths ? left_out.check_rms_um : left_out.check_rms_urad;
  if (left_out.check_rows == 0 || !rms) return {};
  return fmt::format(" {} check row{} left out; with {} the residual of the check rows is {:.4g} {}.",
                     left_out.check_rows, left_out.check_rows == 1 ? " is" : "s are",
                     left_out.check_rows == 1 ? "this row" : "these rows", *rms, lengths ? "um" : "urad");
}

std::string cause_in_words(const CandidateFinding& cause, const std::string& next_best, double distance,
                           const std::vector<LadderStep>& steps, std::size_t accepted) {
  std::string text = said_of(cause) + ".";
  if (!next_best.empty())
    text += fmt::format(" The BIC of the next best cause, {}, is higher by {:.0f}.", next_best, distance);
  std::vector<std::string> beside;  // the stepwise model starts with the given model
  for (std::size_t i = 1; i < steps.size(); ++i)
    if (steps[i].certain && steps[i].said != cause.candidate.spoken) beside.push_back(steps[i].said);
  if (!cause.candidate.choice.runs.empty())
    text += " An instrument that was set up anew between the runs explains these rows as well.";
  if (!beside.empty()) text += fmt::format(" Beside it: {}.", fmt::join(beside, "; "));
  return text + check_rows_in_words(steps, accepted);
}

std::string aliases_in_words(const effects::Candidate& candidate, double period,
                             const std::vector<double>& aliases, const model::Axis& axis) {
  std::string text = fmt::format(
      "{}: {}, with one of {} possible periods, because the positions of {} do not distinguish these "
      "periods. {:.5g}",
      candidate.choice.effect->title, candidate.spoken, aliases.size() + 1, axis.name, period);
  constexpr std::size_t kListed = 20;  // largest number of periods in a sentence
  for (std::size_t i = 0; i < std::min(kListed, aliases.size()); ++i)
    text += fmt::format(", {:.5g}", aliases[i]);
  return text + fmt::format(" {}{}. Measure {} at targets with unequal intervals.",
                            axis.rotary ? "deg" : "mm", aliases.size() > kListed ? " and shorter ones" : "",
                            axis.name);
}

std::string difference_in_words(const std::string& own, const std::vector<std::string>& others) {
  return fmt::format(
      " Only the difference of the axes is measured here: {}, and {} with the opposite sign, give the same "
      "readings. A straight line along each axis at two feeds separates them.",
      own, fmt::join(others, "; "));
}

std::string one_step_in_words() {
  return " One change of the machine or of its set-up, such as a collision, at the time when this input "
         "changed too, is a further possible cause.";
}

std::string go_back_in_words() {
  return " To distinguish the two, measure again at the first value of the input.";
}

std::string drift_of_instrument_in_words() {
  return " An instrument or its stand that drifts gives the same readings: measure again on another day "
         "before "
         "the machine is corrected by it.";
}

std::string fit_reduces_in_words(const fit::FitResult& base) {
  constexpr double kMuch = 1.5;  // what a fit of a machine that is already fitted does not reach by chance
  const fit::RoleStatistics& given = base.only_set_up ? *base.only_set_up : base.before;
  if (!given.rms_um || !base.after.rms_um || *given.rms_um < kMuch * *base.after.rms_um) return {};
  return fmt::format(
      " Without a fit of the machine file the residual is {:.3g} um; after a fit of its parameters (vernier "
      "fit) the residual is {:.3g} um.",
      *given.rms_um, *base.after.rms_um);
}

std::string most_remains_in_words(double before_um, double after_um) {
  return fmt::format(
      " Most of the residual remains ({:.3g} of {:.3g} um), and the readings have neither u nor repeats: the "
      "diagnosis cannot tell whether the rest is the noise of the instrument or another error.",
      after_um, before_um);
}

std::string reflector_in_words(const std::string& machine_file) {
  return fmt::format(
      " If the readings are those of a reflector at an unknown place on the tool, this offset is no error of "
      "the machine: vernier set {} --reflector -o NEW.xml declares it.",
      machine_file);
}

std::string pieces_in_words(const std::vector<std::string>& names) {
  return fmt::format(
      "{} effects together reduce the residual to the noise, but they are probably parts of one function of "
      "the position that is not in the catalogue: {}.",
      names.size(), fmt::join(names, "; "));
}

std::string unrecorded_heat_in_words(const std::vector<std::string>& names) {
  return fmt::format(
      "{} effects together reduce the residual to the noise, but they are probably parts of one response to "
      "a source of heat that no thermometer records: {}. Record a temperature at the motors and bearings.",
      names.size(), fmt::join(names, "; "));
}

std::string open_steps_in_words(const std::vector<LadderStep>& steps) {
  std::string text;
  for (const LadderStep& step : steps) {
    std::vector<std::string> names;
    for (const Cause& cause : step.causes) names.push_back(cause.description);
    if (!names.empty())
      text += fmt::format(
          " Another part of the error has {} possible causes that these data do not distinguish: {}.",
          names.size(), fmt::join(names, "; "));
  }
  return text;
}

std::string not_confirmed_in_words(const std::vector<std::string>& names) {
  return names.empty() ? "" : fmt::format("The check rows do not confirm {}.", fmt::join(names, ", "));
}

}  // namespace vernier::diagnose
