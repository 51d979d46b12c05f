// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/safety/safety_sheet.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <set>

#include "tools/fit/coverage/reach.h"
#include "tools/fit/fit.h"
#include "tools/kinematics/correction.h"
#include "tools/kinematics/jacobian.h"
#include "tools/maths/decompositions.h"
#include "tools/maths/factors.h"
#include "tools/model/chain/chain.h"
#include "tools/model/chain/travel.h"
#include "tools/model/chain/work_poses.h"
#include "tools/model/fit_record.h"
#include "tools/model/parameters.h"
#include "tools/safety/sources.h"
#include "tools/text/assurance.h"

namespace vernier::safety {
namespace {

struct RuleText {
  const char *name, *unit, *reason;
  double limit;
  const char* remedy = "";  // what the user can do instead of accepting the rule, whatever the culprit is
};

/// Limits, each with its reason. Ratios have no unit.
const RuleText& text_of(SafetyRule rule) {
  static const std::array<RuleText, kSafetyRuleCount> kTexts = {{
      {"correction", "of the working volume",
       "errors above 1 % of the volume show that the file describes another machine, or a tool point that "
       "was not known",
       0.01},
      {"max-correction", "of maxcorrection", "the board limits a larger correction to maxcorrection", 1},
      {"cancellation", "times the correction",
       "terms ten times larger than their sum are valid only where they were measured together", 10},
      {"uncertainty", "of the correction",
       "a correction whose standard uncertainty exceeds half of its value may increase the error", 0.5,
       "measure more poses, or fit fewer parameters: fit --hold NAME, such as --hold \"table.*\"; a "
       "correction that is nearly zero fails this rule too, and can be accepted"},
      {"measured-range", "of the measured range",
       "outside the measured range the last value of a table is used and terms are extrapolated", 0.25,
       "measure the whole travel, or reduce the travel of the machine file to the measured range "
       "(vernier set --measured-travel)"},
      {"input-range", "of the measured range", "a term in an input is valid only within its measured range",
       1, "measure at the temperatures at which the machine runs"},
      {"set-up", "um",
       "a shift that is the same at every pose is the position of the instrument, not an error of the "
       "machine",
       2},
      {"converged", "", "the fit has not converged: its parameters are not a result", 1},
      {"residual", "of the measured box",
       "readings with such a large residual are not readings of this machine", 0.02},
      {"outlier", "times the residual's spread", "one reading is an outlier that distorts the fit", 20},
      {"check-rows", "times the nominal machine's",
       "the correction must reduce the error of the held-out rows, compared with no correction (95 %)", 1,
       "fit fewer parameters, or add what diagnose names"},
      {"disturbed", "of the errors that the machine shows",
       "an effect that is not in the model, as large as the errors of the machine, has distorted the fit",
       0.75, "run diagnose, or measure again in one set-up"},
      {"bound", "of the correction", "the error bound of a compiled image must not exceed its correction", 1},
  }};
  return kTexts[static_cast<std::size_t>(rule)];
}

/// True if the fit changed the value of a parameter visibly beside its standard uncertainty.
bool was_changed(const model::Machine& machine, std::size_t i) {
  constexpr double kOfStd = 0.01;  // a smaller change is not visible beside two digits of the uncertainty
  const model::FitRecord& record = *machine.fitted;
  const auto at = static_cast<Eigen::Index>(i);
  if (at >= record.values.size() || at >= record.factor.rows()) return true;
  const auto known = machine.find_static(record.parameters[i]);
  const double nominal = known ? machine.statics[*known].nominal.value_or(0) : 0;
  return std::abs(record.values[at] - nominal) > kOfStd * record.factor.row(at).norm();
}

class Judge {
 public:
  Judge(const model::Machine& machine, const std::vector<SafetyRule>& accepted)
      : machine_(machine),
        accepted_(accepted),
        poses_(model::work_poses(machine)),
        deviation_(model::deviation(machine, poses_.states)) {}

  SafetySheet run() {
    judge_correction();
    judge_cancellation();
    judge_uncertainty();
    judge_ranges();
    judge_set_up();
    judge_fit();
    std::sort(sheet_.findings.begin(), sheet_.findings.end(),
              [](const auto& a, const auto& b) { return a.rule < b.rule; });
    return std::move(sheet_);
  }

 private:
  void add(SafetyRule rule, std::optional<double> value, std::string culprit, std::string remedy = {}) {
    sheet_.judge(rule, value, std::move(culprit), accepted_, std::move(remedy));
  }

  /// The source that moves the tool most, of those that the machine has.
  std::string largest_source() {
    const std::vector<Source>& sources = sources_of_machine();
    const auto largest = std::max_element(sources.begin(), sources.end(),
                                          [](const auto& a, const auto& b) { return a.rms_mm < b.rms_mm; });
    return largest == sources.end() ? "" : largest->name;
  }

  const std::vector<Source>& sources_of_machine() {
    if (!sources_) sources_ = error_sources(machine_, poses_.states);
    return *sources_;
  }

  /// Effect on each axis: the linear axes if there are any, else all (least squares, mm and deg).
  std::vector<model::Column> offsets() const {
    if (!kinematics::linear_axes(machine_).empty())
      return kinematics::first_order_offset(machine_, poses_.states);
    std::vector<std::size_t> all(machine_.axes.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    const auto count = static_cast<Eigen::Index>(poses_.states.count);
    std::vector<model::Column> result(all.size(), model::Column::Zero(count));
    const std::vector<Eigen::MatrixXd> jacobians = kinematics::axis_jacobian(
        model::nominal_machine(machine_), poses_.states, all, kinematics::Match::kPosition, poses_.extent_mm);
    for (Eigen::Index i = 0; i < count; ++i) {
      const Eigen::VectorXd move =
          maths::least_norm(jacobians[static_cast<std::size_t>(i)], deviation_.col(i));
      for (std::size_t a = 0; a < all.size(); ++a) result[a][i] = -move[static_cast<Eigen::Index>(a)];
    }
    return result;
  }

  void judge_correction() {
    const std::vector<model::Column> offset = offsets();
    double most = deviation_.colwise().norm().maxCoeff(), against_limit = 0;
    std::string of_limit;
    bool limited = false;
    for (std::size_t i = 0; i < machine_.axes.size(); ++i) {
      const double largest = offset[i].size() > 0 ? offset[i].abs().maxCoeff() : 0;
      if (!machine_.axes[i].rotary) most = std::max(most, largest);
      if (!machine_.axes[i].max_correction) continue;
      limited = true;
      if (const double share = largest / *machine_.axes[i].max_correction; share >= against_limit) {
        against_limit = share;
        of_limit = machine_.axes[i].name;
      }
    }
    add(SafetyRule::kCorrection, most / poses_.extent_mm, largest_source());
    const std::string source = largest_source();
    add(SafetyRule::kMaxCorrection, limited ? std::optional(against_limit) : std::nullopt,
        of_limit.empty() ? "" : "axis " + of_limit + (source.empty() ? "" : ", most by " + source));
  }

  /// Without its mean: a shift of the whole is no correction anybody would miss.
  double varying_rms_mm() const {
    const Eigen::Matrix3Xd off = deviation_.colwise() - deviation_.rowwise().mean();
    return std::sqrt(off.squaredNorm() / static_cast<double>(off.cols()));
  }

  void judge_cancellation() {
    double sum = 0;
    for (const Source& source : sources_of_machine()) sum += source.varying_rms_mm;
    // Not tested below the resolution of the finest instrument.
    constexpr double kNothing_mm = 1e-4;
    add(SafetyRule::kCancellation, sum / std::max(varying_rms_mm(), kNothing_mm), largest_source());
  }

  void judge_uncertainty() {
    const fit::Reach reach(machine_);
    if (!reach.known()) {
      add(SafetyRule::kUncertainty, std::nullopt, "");
      return;
    }
    double worst = 0;
    std::string of = "the tool of the file";
    const auto judge_at = [&](const model::Machine& machine, const fit::Reach& with,
                              const model::States& states, const std::string& name) {
      const double rms_um = std::sqrt(with.std_um(states).squaredNorm() / static_cast<double>(states.count));
      const double share = rms_um / std::max(maths::kUmPerMm * correction_rms_mm(machine, states), 0.1);
      if (share <= worst) return;
      worst = share;
      of = name;
    };
    const auto judge_tool = [&](const model::Machine& machine, const std::string& tool) {
      const fit::Reach with(machine);
      judge_at(machine, with, poses_.states, tool);
      for (const model::FitRecord::Range& measured : machine_.fitted->measured) {
        const auto input = machine_.find_input(measured.name);
        if (!input || machine_.inputs[*input].hidden_axis ||
            !acts(machine_, {model::SymbolKind::kInput, *input}))
          continue;
        for (const double value : {measured.min, measured.max}) {
          model::States states = poses_.states;
          states.input[*input].setConstant(value);
          judge_at(machine, with, states, fmt::format("{}, {} at {:.4g}", tool, measured.name, value));
        }
      }
    };
    judge_tool(machine_, of);
    for (const model::Tool& tool : machine_.tools)
      judge_tool(model::with_tool(machine_, tool.point), "tool " + tool.name);
    add(SafetyRule::kUncertainty, worst, of);
    sheet_.not_measured = safety::not_measured(machine_);
    sheet_.stale = reach.stale();
  }

  /// Size of the correction with this tool, and the share that the noise of a good fit may leave.
  static double correction_rms_mm(const model::Machine& machine, const model::States& states) {
    const Eigen::Matrix3Xd d = model::deviation(machine, states);
    const Eigen::Matrix3Xd off = d.colwise() - d.rowwise().mean();
    return std::sqrt(off.squaredNorm() / static_cast<double>(off.cols()));
  }

  /// True if the deviation of the tool point depends on the position of this axis.
  bool changes_along(std::size_t axis, const std::array<double, 2>& range) const {
    constexpr double kNothing = 1e-6;  // mm: a nanometre, below every instrument
    for (const double at : {range[0], (range[0] + range[1]) / 2, range[1]}) {
      model::States states = poses_.states;
      states.axis[axis].setConstant(at);
      if ((model::deviation(machine_, states) - deviation_).cwiseAbs().maxCoeff() > kNothing) return true;
    }
    return false;
  }

  void judge_ranges() {
    if (!machine_.fitted) {
      add(SafetyRule::kMeasuredRange, std::nullopt, "");
      add(SafetyRule::kInputRange, std::nullopt, "");
      return;
    }
    std::vector<Outside> axes, inputs;
    const auto overhang = [&](const model::FitRecord::Range& measured, double low, double high) {
      const double outside = std::max(0.0, measured.min - low) + std::max(0.0, high - measured.max);
      return outside / std::max(measured.max - measured.min, 1e-3 * (high - low));
    };
    const auto region = [](const char* kind, const model::FitRecord::Range& measured, double low,
                           double high) {
      return fmt::format("{} {}, measured from {:g} to {:g}, range {:g} to {:g}", kind, measured.name,
                         measured.min, measured.max, low, high);
    };
    for (const model::FitRecord::Range& measured : machine_.fitted->measured) {
      if (const auto axis = machine_.find_axis(measured.name)) {
        add_outside_travel(machine_.axes[*axis], measured, axes);
        const auto range = model::work_range(machine_, *axis);
        if (!range || !acts(machine_, {model::SymbolKind::kAxis, *axis})) continue;
        const bool stood = !(measured.max > measured.min);
        // Without a correction that depends on this axis no table and no term is used outside its range. The
        // fit reports the axis (finding stood-still).
        if (stood && !changes_along(*axis, *range)) continue;
        axes.push_back(
            {overhang(measured, (*range)[0], (*range)[1]),
             region("axis", measured, (*range)[0], (*range)[1]) +
                 (stood ? fmt::format(" (the correction depends on {0}, and {0} stood still: measure at "
                                      "other positions of {0}, or fit with --hold for the errors that "
                                      "depend on it)",
                                      measured.name)
                        : "")});
      } else if (const auto input = machine_.find_input(measured.name)) {
        const model::Input& item = machine_.inputs[*input];
        if (!item.min || !item.max || !acts(machine_, {model::SymbolKind::kInput, *input})) continue;
        inputs.push_back(
            {overhang(measured, *item.min, *item.max), region("input", measured, *item.min, *item.max)});
      }
    }
    add_outside_clocks(inputs);
    add_outside(SafetyRule::kMeasuredRange, std::move(axes));
    add_outside(SafetyRule::kInputRange, std::move(inputs));
  }

  /// An axis or an input that works outside the range in which it was measured.
  struct Outside {
    double share = 0;  // of the measured range
    std::string text;
    std::string remedy = {};  // empty: the remedy of the rule
  };

  /// A quantity that only counts on: the time, or the rows in their order.
  struct Clock {
    model::SymbolKind kind;
    const char *name, *unit;
    double on_a_board;  // a board counts from its start: so far in a day
    model::Column model::States::*column;
    const char* remedy;
  };

  /// A board counts the time and the visits from its start and runs for days. If the correction still changes
  /// at the end of the measured time or of the measured rows, as a drift of the base or of the instrument
  /// does and a warm-up that ended does not, its terms in this count are extrapolated.
  void add_outside_clocks(std::vector<Outside>& list) const {
    constexpr double kDay_s = 86400, kVisitsOfDay = 1e6;  // as the ranges of a compiled image
    add_outside_clock({model::SymbolKind::kTime, "time", " s", kDay_s, &model::States::time,
                       "a drift of the base or of the instrument is no error that a board can correct: set "
                       "its static to 0"},
                      list);
    add_outside_clock(
        {model::SymbolKind::kVisit, "order of the readings", "", kVisitsOfDay, &model::States::visit,
         "an error that follows the order of the readings, as a drift of the base or of the "
         "instrument does, is no error that a board can correct: set its static to 0"},
        list);
  }

  void add_outside_clock(const Clock& clock, std::vector<Outside>& list) const {
    constexpr double kStillChanges = 0.25;  // of the change within the measured range
    constexpr double kNothing_mm = 1e-4;    // as in judge_cancellation()
    const model::Symbol symbol{clock.kind, 0};
    if (!acts(machine_, symbol)) return;
    const std::string name = model::symbol_name(machine_, symbol);
    for (const model::FitRecord::Range& measured : machine_.fitted->measured) {
      if (measured.name != name) continue;
      const double length = measured.max - measured.min;
      const auto at = [&](double count) {
        model::States states = poses_.states;
        (states.*clock.column).setConstant(count);
        return model::deviation(machine_, states);
      };
      const auto apart_mm = [&](double from, double to) {
        return (at(to) - at(from)).colwise().norm().maxCoeff();
      };
      const double within = apart_mm(measured.min, measured.max),
                   after = apart_mm(measured.max, measured.max + length);
      if (after < kNothing_mm || after < kStillChanges * within) return;
      list.push_back(
          {(clock.on_a_board - measured.max) / length,
           fmt::format(
               "{} {}, measured from {:g} to {:g}{}: the correction changes by {:.3g} um in it and by "
               "{:.3g} um in the same range after it, and a board counts on for days",
               clock.name, name, measured.min, measured.max, clock.unit, maths::kUmPerMm * within,
               maths::kUmPerMm * after),
           clock.remedy});
    }
  }

  /// The part of the measured range of a linear axis that is outside its travel, as a share of the travel:
  /// readings of another machine, if it is longer than the travel itself. Min and max that are less may be
  /// the range of work of a machine that was measured further (the fit reports its rows, outside-travel). A
  /// rotary axis may have counted whole turns.
  static void add_outside_travel(const model::Axis& axis, const model::FitRecord::Range& measured,
                                 std::vector<Outside>& list) {
    if (axis.rotary || !axis.min || !axis.max || !(*axis.max > *axis.min)) return;
    const double beyond = std::max(0.0, *axis.min - measured.min) + std::max(0.0, measured.max - *axis.max);
    if (beyond <= *axis.max - *axis.min) return;
    list.push_back({beyond / (*axis.max - *axis.min),
                    fmt::format("axis {}, measured from {:g} to {:g}, outside its travel {:g} to {:g}: the "
                                "file describes another machine, or the positions have another zero or unit; "
                                "correct min and max of the axis, or take the file of this machine",
                                axis.name, measured.min, measured.max, *axis.min, *axis.max)});
  }

  /// The value of the rule is the largest share; its culprit names all that exceed the limit, largest first.
  /// The remedy is that of the largest.
  void add_outside(SafetyRule rule, std::vector<Outside> list) {
    std::stable_sort(list.begin(), list.end(),
                     [](const Outside& a, const Outside& b) { return a.share > b.share; });
    std::string culprit;
    for (const Outside& one : list) {
      const bool worst = &one == &list.front() && one.share > 0;
      if (worst || one.share > text_of(rule).limit) culprit += (culprit.empty() ? "" : "; ") + one.text;
    }
    if (list.empty()) return add(rule, 0, "");
    add(rule, list.front().share, std::move(culprit), list.front().remedy);
  }

  void judge_set_up() {
    // A source that moves the tool point the same way everywhere, by its mean.
    constexpr double kSameEverywhere = 0.01;
    double worst_um = 0;
    std::string of;
    for (const Source& source : sources_of_machine()) {
      const double mean_mm = source.mean_mm.norm();
      if (source.is_table || source.varying_rms_mm > kSameEverywhere * mean_mm) continue;
      if (maths::kUmPerMm * mean_mm <= worst_um) continue;
      worst_um = maths::kUmPerMm * mean_mm;
      of = source.name;
    }
    add(SafetyRule::kSetUp, worst_um, of);
  }

  /// Upper limit (95 %, one-sided) of the ratio of check-row residuals: this machine over the nominal
  /// machine. The relative uncertainty of a standard deviation of n readings is 1 / sqrt(2 n).
  static double upper_ratio(const model::FitRecord& record) {
    constexpr double kOneSided = 1.645;  // standard deviations
    if (record.check_count == 0) return record.check_ratio;
    return record.check_ratio * (1 + kOneSided / std::sqrt(2 * static_cast<double>(record.check_count)));
  }

  void judge_fit() {
    const model::FitRecord* record = machine_.fitted.get();
    const auto known = [&](double value) { return record ? std::optional(value) : std::nullopt; };
    add(SafetyRule::kConverged, known(record && !record->converged ? 2 : 0), "");
    add(SafetyRule::kResidual, known(record ? record->rms_mm / std::max(record->reach_mm, 1e-9) : 0),
        record ? record->culprit : "");
    add(SafetyRule::kOutlier, known(record ? record->worst : 0), record ? record->worst_reading : "");
    const bool checked = record != nullptr && record->check_ratio > 0;
    add(SafetyRule::kCheckRows, checked ? std::optional(upper_ratio(*record)) : std::nullopt,
        checked ? record->worst_check : "");
    add(SafetyRule::kDisturbed, known(record ? record->disturbed : 0), record ? record->disturbance : "");
  }

  const model::Machine& machine_;
  const std::vector<SafetyRule>& accepted_;
  const model::WorkPoses poses_;
  const Eigen::Matrix3Xd deviation_;
  std::optional<std::vector<Source>> sources_;
  SafetySheet sheet_;
};

}  // namespace

const char* rule_name(SafetyRule rule) { return text_of(rule).name; }

std::optional<SafetyRule> rule_named(const std::string& name) {
  for (std::size_t i = 0; i < kSafetyRuleCount; ++i)
    if (name == rule_name(static_cast<SafetyRule>(i))) return static_cast<SafetyRule>(i);
  return std::nullopt;
}

std::string rule_names(const std::string& separator) {
  std::string all;
  for (std::size_t i = 0; i < kSafetyRuleCount; ++i)
    all += (i > 0 ? separator : "") + rule_name(static_cast<SafetyRule>(i));
  return all;
}

std::vector<SafetyRule> rules_named(const std::vector<std::string>& names) {
  std::vector<SafetyRule> rules;
  for (const std::string& name : names) {
    const auto rule = rule_named(name);
    if (!rule)
      throw text::InputError(
          fmt::format("--accept \"{}\": the safety sheet has no rule of this name; its rules are {}", name,
                      rule_names(", ")));
    rules.push_back(*rule);
  }
  return rules;
}

void SafetySheet::judge(SafetyRule rule, std::optional<double> value, std::string culprit,
                        const std::vector<SafetyRule>& accepted, std::string remedy) {
  const RuleText& text = text_of(rule);
  if (remedy.empty()) remedy = text.remedy;
  SafetyFinding finding{
      rule, value, text.limit, text.unit, true, false, std::move(culprit), text.reason, std::move(remedy)};
  finding.ok = !value || text::decisive(*value, text.name) <= text.limit;
  if (!finding.ok) finding.accepted = std::find(accepted.begin(), accepted.end(), rule) != accepted.end();
  findings.push_back(std::move(finding));
}

bool SafetySheet::ok() const {
  return std::all_of(findings.begin(), findings.end(), [](const auto& f) { return f.ok || f.accepted; });
}

std::vector<std::string> SafetySheet::not_known() const {
  std::vector<std::string> names;
  for (const SafetyFinding& f : findings)
    if (!f.value) names.emplace_back(rule_name(f.rule));
  return names;
}

std::uint32_t SafetySheet::accepted_mask() const {
  std::uint32_t mask = 0;
  for (const SafetyFinding& finding : findings)
    if (finding.accepted) mask |= 1U << static_cast<unsigned>(finding.rule);
  return mask;
}

std::string SafetySheet::refusal() const {
  std::vector<const SafetyFinding*> failed;
  for (const SafetyFinding& finding : findings)
    if (!finding.ok && !finding.accepted) failed.push_back(&finding);
  if (failed.empty()) return {};
  const auto times = [](const SafetyFinding* finding) {
    return *finding->value / std::max(finding->limit, 1e-9);
  };
  std::stable_sort(failed.begin(), failed.end(),
                   [&](const auto* a, const auto* b) { return times(a) > times(b); });
  const auto figures = [](const SafetyFinding& finding) {
    return fmt::format("{} {:.3g} {}, limit {:g}", rule_name(finding.rule), *finding.value, finding.unit,
                       finding.limit);
  };
  const SafetyFinding& worst = *failed.front();
  std::string text = fmt::format("not safe to run: {}", figures(worst));
  if (!worst.culprit.empty()) text += ": " + worst.culprit;
  text += fmt::format(" ({})", worst.reason);
  const bool holds = !not_measured.empty() && std::any_of(failed.begin(), failed.end(), [](const auto* one) {
    return one->rule == SafetyRule::kUncertainty;
  });
  if (!worst.remedy.empty() && !(holds && worst.rule == SafetyRule::kUncertainty))
    text += "; " + worst.remedy;
  std::string accept;
  for (const SafetyFinding* finding : failed) {
    if (finding != &worst)
      text += fmt::format("; also not met: {}{}", figures(*finding),
                          finding->culprit.empty() ? "" : ": " + finding->culprit);
    accept += fmt::format(" --accept {}", rule_name(finding->rule));
  }
  if (holds)
    text += fmt::format(
        "; measure more poses, or fit the machine again without the parameters that no reading determines: "
        "fit --hold \"{}\"; a correction that is nearly zero fails this rule too, and can be accepted",
        not_measured);
  return text + fmt::format(";{} overrides", accept);
}

std::string not_measured(const model::Machine& machine) {
  if (!machine.fitted) return {};
  const model::FitRecord& record = *machine.fitted;
  struct Column {
    std::string name;
    std::size_t entries = 0, open = 0;
    bool by_data = false, changed = false;
  };
  std::vector<Column> columns;  // in the order of the fit
  for (std::size_t i = 0; i < std::min(record.parameters.size(), record.origins.size()); ++i) {
    const std::string name = model::without_station(record.parameters[i]);
    if (name.starts_with("BaseShift") || name.starts_with("ToolShift")) continue;
    const auto known = std::find_if(columns.begin(), columns.end(),
                                    [&](const Column& column) { return column.name == name; });
    Column& column = known != columns.end() ? *known : columns.emplace_back(Column{name});
    const bool open = record.origins[i] == fit::origin_name(fit::Origin::kPrior);
    ++column.entries;
    column.open += open ? 1 : 0;
    column.by_data = column.by_data || record.origins[i] == fit::origin_name(fit::Origin::kData);
    column.changed = column.changed || (open && was_changed(machine, i));
  }
  std::vector<std::string> names;
  for (const Column& column : columns) {
    const bool untouched = column.open == column.entries && !column.changed;
    const bool half = column.entries > 1 && 2 * column.open >= column.entries && !column.by_data;
    if (untouched || half) names.push_back(column.name);
  }
  return fmt::format("{}", fmt::join(names, ","));
}

SafetySheet safety_sheet(const model::Machine& machine, const std::vector<SafetyRule>& accepted) {
  return Judge(machine, accepted).run();
}

}  // namespace vernier::safety
