// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/commands/other_readings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "tools/fit/least_squares/statistics.h"
#include "tools/fit/set_up.h"
#include "tools/format/readings.h"
#include "tools/text/words.h"

namespace vernier::commands {
namespace {

constexpr double kQuarter_deg = 90;
constexpr double kFarBetter = 0.2;  // of the residual with the readings as they are

/// The measurement whose readings moved by `by` rows; readings without such a row in the same file and set-up
/// are dropped. No value: a reading has geometry of its own row (a centre, a normal, a touched object).
std::optional<model::Measurement> moved_readings(const model::Measurement& m, int by) {
  model::Measurement moved = m;
  moved.observations.clear();
  const std::vector<std::size_t>& setup = m.states.setup.of;
  for (model::Observation one : m.observations) {
    const bool point = one.kind == model::ObservationKind::kX || one.kind == model::ObservationKind::kY ||
                       one.kind == model::ObservationKind::kZ;
    if (m.thing_of(one.row) != model::kNoThing || (!point && !model::is_rotation(one.kind)))
      return std::nullopt;
    const std::size_t from = one.row;
    if ((by < 0 && from == 0) || (by > 0 && from + 1 == m.rows())) continue;
    one.row = by < 0 ? from - 1 : from + 1;
    if (m.file[one.row] != m.file[from] || (!setup.empty() && setup[one.row] != setup[from])) continue;
    moved.observations.push_back(one);
  }
  return moved;
}

/// Rms of the fit rows with the given machine and a fitted set-up, um; no value without lengths.
std::optional<double> rms_of_nominal_um(const model::Machine& machine, const model::Measurement& m) {
  const model::Machine posed = fit::set_up(machine, m);
  return fit::role_statistics(m, fit::residuals(posed, m), false).rms_um;
}

/// Angle of a static from its nominal value, rounded to quarter turns; 0: a usual value or no angle.
int quarters_of(const model::Static& one) {
  constexpr double kNear_deg = 10;  // no zero error of a robot that moves; calibrated ones have below 2
  if (one.unit != "deg" || !one.nominal || one.hidden) return 0;
  const double angle = std::remainder(one.value - *one.nominal, 360);
  const double quarters = std::round(angle / kQuarter_deg);
  return std::abs(angle - quarters * kQuarter_deg) < kNear_deg ? std::abs(static_cast<int>(quarters)) : 0;
}

struct Change {
  double factor = 1, add_deg = 0;
  std::string words(const std::string& axis) const {
    return factor < 0 ? fmt::format("the other sign of {}", axis)
                      : fmt::format("{} {} {:g} deg", axis, add_deg < 0 ? "-" : "+", std::abs(add_deg));
  }
};

model::Measurement changed(model::Measurement m, std::size_t axis, const Change& change) {
  m.states.axis[axis] = change.factor * m.states.axis[axis] + change.add_deg;
  for (std::vector<model::Column>* of : {&m.states.velocity, &m.states.acceleration, &m.states.direction})
    if (axis < of->size()) (*of)[axis] *= change.factor;
  return m;
}

bool within_travel(const model::Axis& axis, const model::Column& positions) {
  return (!axis.min || positions.minCoeff() >= *axis.min) && (!axis.max || positions.maxCoeff() <= *axis.max);
}

/// A sentence about the changes of a joint that bring the readings far nearer to the given machine with a
/// fitted set-up; empty: no change does.
std::string joints_that_differ(const model::Machine& machine, const model::Measurement& m) {
  constexpr double kAsGood = 1.2;  // times the smallest residual: two changes can be equivalent
  const std::optional<double> own = rms_of_nominal_um(machine, m);
  if (!own) return {};
  std::vector<std::pair<double, std::string>> found;
  for (std::size_t i = 0; i < machine.axes.size(); ++i) {
    if (!machine.axes[i].rotary) continue;
    for (const Change& change : {Change{-1, 0}, Change{1, kQuarter_deg}, Change{1, -kQuarter_deg},
                                 Change{1, 2 * kQuarter_deg}, Change{1, -2 * kQuarter_deg}}) {
      const model::Measurement other = changed(m, i, change);
      if (!within_travel(machine.axes[i], other.states.axis[i])) continue;
      const std::optional<double> rms = rms_of_nominal_um(machine, other);
      if (rms && *rms < kFarBetter * *own) found.emplace_back(*rms, change.words(machine.axes[i].name));
    }
  }
  if (found.empty()) return {};
  const double least = std::ranges::min_element(found)->first;
  std::string words;
  for (const auto& [rms, change] : found)
    if (rms <= kAsGood * least) words += (words.empty() ? "" : ", or with ") + change;
  return fmt::format(
      "with {} in the readings the residual of the given machine falls from {:.3g} um to {:.3g} um", words,
      *own, least);
}

}  // namespace

std::string readings_of_other_rows(const model::Machine& machine, const model::Measurement& m) {
  constexpr std::size_t kFewestRows = 6;
  if (m.rows() < kFewestRows) return {};
  const std::optional<double> own = rms_of_nominal_um(machine, m);
  for (const int by : {-1, 1}) {
    const auto moved = moved_readings(m, by);
    if (!own || !moved || moved->observations.empty()) return {};
    const std::optional<double> rms = rms_of_nominal_um(machine, *moved);
    if (rms && *rms < kFarBetter * *own)
      return fmt::format(
          "the readings probably belong to other rows: if each reading moves to the row {} its own, the "
          "residual of the given machine with a fitted set-up falls from {:.3g} um to {:.3g} um. Correct the "
          "table: move the columns of the readings by one row",
          by < 0 ? "before" : "after", *own, *rms);
  }
  return {};
}

std::string other_zero_of_joint(const model::Machine& machine, const model::Measurement& m,
                                const fit::FitResult& result) {
  std::string names;
  int most = 0;
  for (const model::Static& one : result.machine.statics)
    if (const int quarters = quarters_of(one); quarters != 0) {
      most = std::max(most, quarters);
      names += fmt::format("{}{} = {:.2f} deg{}", names.empty() ? "" : ", ", one.name, one.value,
                           *one.nominal != 0 ? fmt::format(" (nominal {:g})", *one.nominal) : "");
    }
  if (names.empty()) return {};
  const std::string joint = joints_that_differ(machine, m);
  return fmt::format(
      "{}: an angle so near to {:g} deg is no error of the machine. The readings and the machine file count "
      "a "
      "joint from another zero or in another direction{}. Correct the column of the joint in the readings, "
      "or the joint in the machine file, and fit again: an export of this fit describes another machine",
      names, most * kQuarter_deg, joint.empty() ? "" : ": " + joint);
}

std::string readings_of_one_weight(const model::Measurement& m) {
  std::vector<std::set<format::ReadingForm>> forms(m.files.size());
  for (const model::Observation& one : m.observations) {
    if (model::uncertainty_of(m, one) > 0) return {};
    const format::ReadingForm form = format::form_of(one.kind);
    // A rotation beside a point is a reading of the same instrument.
    forms[m.file[one.row]].insert(form == format::ReadingForm::kRotation ? format::ReadingForm::kPoint
                                                                         : form);
  }
  if (std::all_of(forms.begin(), forms.end(), [&](const auto& one) { return one == forms.front(); }))
    return {};
  return fmt::format(
      "the readings of {} have no standard uncertainty (u), and so all of them have the same weight: state "
      "u of each file, such as 0.02 mm of a caliper (import table: --set \"u[mm]=0.02\"), so that the less "
      "exact instrument does not hide what the other one measured",
      text::joined(m.files, ", "));
}

}  // namespace vernier::commands
