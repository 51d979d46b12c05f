// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/hidden_survey.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "tests/support/hidden_survey_alternatives.h"
#include "tests/support/hidden_survey_columns.h"
#include "tests/support/hidden_survey_csv.h"
#include "tests/support/hidden_survey_inputs.h"
#include "tests/support/hidden_survey_key.h"
#include "tests/support/hidden_survey_noise.h"
#include "tests/support/hidden_survey_outside.h"
#include "tools/model/chain/prediction.h"
#include "tools/model/machine_reader.h"
#include "tools/model/machine_writer.h"

namespace vernier::support {

using namespace vernier::model;
using namespace vernier::text;
namespace {

constexpr double kLeastRemaining = 0.12;  // below this the effect must be absurdly large to be seen
constexpr double kTells = 20;  // chi^2 between the truth and its best alternative, issue's definition
constexpr int kDraws = 80;

bool is_of_a_name(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

/// The text with hidE_1 in the place of the name k1, so too k2 and k3; E counts the effects from 1.
std::string with_coefficients_of(std::size_t effect, const std::string& text) {
  std::string replaced;
  for (std::size_t begin = 0, end = 0; begin < text.size(); begin = end) {
    end = begin + 1;
    while (end < text.size() && is_of_a_name(text[begin]) && is_of_a_name(text[end])) ++end;
    const std::string part = text.substr(begin, end - begin);
    const bool coefficient = part == "k1" || part == "k2" || part == "k3";
    replaced += coefficient ? fmt::format("hid{}_{}", effect + 1, part[1]) : part;
  }
  return replaced;
}

/// One attempt at a survey: everything drawn, nothing measured yet.
class Attempt {
 public:
  Attempt(const SurveySpec& spec, std::uint64_t seed)
      : spec_(spec), draw_(seed), noise_draw_(~seed), g_(geometry_of(spec.family, spec.seed)) {}

  /// Nothing where this draw shows the effect too badly, or tells what it must not tell.
  std::optional<HiddenSurvey> survey();

 private:
  bool choose();
  bool choose_effect(const std::string& effect);
  bool design_confusable();
  void choose_motion();
  void choose_model();
  bool scale_effects();
  bool far_apart() const;
  Eigen::VectorXd shift_of(std::size_t effect) const;
  std::vector<TermStatic> statics_of(std::size_t effect) const;
  std::vector<Place> places_of(std::size_t effect) const;
  std::vector<TermInput> inputs() const;
  std::string truth_text() const;
  void measure(HiddenSurvey& survey);
  void judge(HiddenSurvey& survey);
  HiddenEffect key_of(std::size_t effect) const;
  SurveyTable table(bool with_u = true) const {
    return {g_, options_, rows_, columns_, u_, with_u, growing_u_};
  }

  SurveySpec spec_;
  Draw draw_, noise_draw_;  // the second: of all noise that is not white
  Geometry g_;
  MotionOptions options_;
  ModelOptions model_options_;
  std::vector<MotionRow> rows_;
  std::vector<LoggedColumn> columns_;
  std::vector<std::string> effects_;
  std::vector<Form> forms_;
  std::vector<double> scale_, ratio_, remaining_;
  double u_ = 0;
  std::vector<double> growing_u_;  // of each row over u_; empty: 1
  std::string model_, base_;       // the user's file; the same with true values
  Machine base_machine_;           // base_ with every logged column as an input
  Measurement measurement_;
  std::optional<Complement> complement_;
};

bool suits(const std::string& effect, const Form& form, const std::vector<LoggedColumn>& columns) {
  using Sort = LoggedColumn::Sort;
  for (const LoggedColumn& c : columns)
    if (std::find(form.inputs.begin(), form.inputs.end(), c.name) != form.inputs.end() &&
        effect == "load-deflection" && c.sort != Sort::kLoad)
      return false;
  return true;
}

bool Attempt::choose_effect(const std::string& effect) {
  const Share share = [this] { return draw_.uniform(); };
  std::vector<Form> forms = forms_of(effect, g_, columns_, model_options_.runs, share, draw_);
  std::erase_if(forms, [&](const Form& f) { return !suits(effect, f, columns_); });
  // Along z alone a move across is seen through the set-up's tilt: absurdly large where it shows.
  if (options_.reading == Reading::kZ)
    std::erase_if(forms, [](const Form& f) {
      const std::string& dof = f.places.front().dof;
      return dof != "Z" && dof != "rX" && dof != "rY";
    });
  if (forms.empty()) return false;
  forms_.push_back(draw_.pick(forms));
  return true;
}

/// One thermometer shape in proportion to time, or one feed and one axis at a time.
bool Attempt::design_confusable() {
  if (draw_.chance(0.5)) {
    options_.one_thermal = true;
    options_.locked = draw_.chance(0.5);
    static const std::vector<std::string> thermal = {"thermal-offset", "thermal-scale", "thermal-bend",
                                                     "base-drift"};
    effects_ = {draw_.pick(thermal)};
  } else {
    options_.one_axis = true;
    options_.feeds = 1;
    options_.manner = Manner::kMoving;
    static const std::vector<std::string> lag = {"servo-lag", "backlash"};
    effects_ = {draw_.pick(lag)};
  }
  if (!spec_.effect.empty()) effects_ = {spec_.effect};
  return true;
}

void Attempt::choose_motion() {
  options_.rows = spec_.rows;
  options_.runs = spec_.runs;
  options_.feeds = spec_.feeds;
  bool moving = draw_.chance(0.3), probing = false;
  for (const std::string& effect : effects_) {
    moving = moving || demands_of(effect).moving;
    probing = probing || demands_of(effect).probing;
  }
  if (g_.family == Family::kBallBar) moving = true;
  options_.manner = probing ? Manner::kProbing : moving ? Manner::kMoving : Manner::kAtRest;
  options_.reading = Reading::kPoint;
  if (probing) options_.reading = Reading::kD;
  if (g_.family == Family::kSingleAxis) options_.reading = Reading::kX;
  if (is_by_direction(g_.family)) options_.reading = Reading::kDirection;
  if (g_.family == Family::kTurntable || g_.family == Family::kGearTrain) options_.reading = Reading::kTurn;
  if (g_.family == Family::kBed) options_.reading = Reading::kZ;
  if (g_.family == Family::kBallBar || (g_.family == Family::kRobot && draw_.chance(0.25)))
    options_.reading = Reading::kLength;
}

void Attempt::choose_model() {
  const bool has_tables = g_.text.find("fit=\"") != std::string::npos;
  model_options_.kind = has_tables && draw_.chance(0.6) ? ModelKind::kTables : ModelKind::kStatics;
  model_options_.shift_per_run = draw_.chance(0.7) && spec_.noise != NoiseLaw::kSetUps;
  model_options_.hold_shift = options_.reading == Reading::kD;
  for (std::size_t i = 0; i < effects_.size(); ++i) {
    const Demands demands = demands_of(effects_[i]);
    if (demands.bare) model_options_.kind = ModelKind::kBare;
    if (!demands.shift_per_run) model_options_.shift_per_run = false;
    if (demands.without_own) {
      model_options_.axis_without = forms_[i].cause.axis;
      model_options_.column_without = forms_[i].places.front().dof;
    }
  }
}

/// Draws effect, motion, inputs, form and model. False: this draw cannot be.
bool Attempt::choose() {
  if (spec_.kind == SurveyClass::kSingle || spec_.kind == SurveyClass::kTwo) {
    const std::vector<std::string> all = effects_of(spec_.family);
    effects_ = {spec_.effect.empty() ? draw_.pick(all) : spec_.effect};
    if (spec_.kind == SurveyClass::kTwo) effects_.push_back(draw_.pick(all));
  } else if (spec_.kind == SurveyClass::kConfusable) {
    design_confusable();
  }
  const bool probing =
      std::any_of(effects_.begin(), effects_.end(), [](auto& e) { return demands_of(e).probing; });
  const bool moving =
      std::any_of(effects_.begin(), effects_.end(), [](auto& e) { return demands_of(e).moving; });
  if ((probing && moving) || (effects_.size() == 2 && effects_[0] == effects_[1])) return false;
  if (spec_.kind == SurveyClass::kConfusable) {
    const MotionOptions designed = options_;
    choose_motion();
    options_.manner = designed.one_axis ? Manner::kMoving : options_.manner;
    options_.one_axis = designed.one_axis;
    options_.one_thermal = designed.one_thermal;
    options_.locked = designed.locked;
    if (designed.one_axis) options_.feeds = 1;
  } else {
    choose_motion();
  }
  rows_ = move(g_, options_, draw_);
  if (spec_.noise == NoiseLaw::kPoses) repeat_poses(rows_, noise_draw_);
  columns_ = log_inputs(rows_, options_, draw_);
  for (std::size_t r = 0; r < spec_.runs; ++r) model_options_.runs.push_back(run_label(r));
  for (const std::string& effect : effects_)
    if (!choose_effect(effect)) return false;
  if (spec_.kind == SurveyClass::kOutside) {
    forms_ = {outside_form(g_, columns_, draw_)};
    effects_ = {forms_.front().cause.effect};
  }
  choose_model();
  u_ = spec_.u_mm > 0 ? spec_.u_mm : g_.u_mm;
  if (spec_.noise == NoiseLaw::kGrowing) growing_u_ = growing_u(nominal_points(table()));
  return true;
}

std::vector<TermStatic> Attempt::statics_of(std::size_t effect) const {
  std::vector<TermStatic> statics;
  for (std::size_t k = 0; k < forms_[effect].coefficients.size(); ++k)
    statics.push_back(
        {fmt::format("hid{}_{}", effect + 1, k + 1), scale_[effect] * forms_[effect].coefficients[k]});
  return statics;
}

std::vector<Place> Attempt::places_of(std::size_t effect) const {
  std::vector<Place> places = forms_[effect].places;
  for (Place& place : places) place.text = with_coefficients_of(effect, place.text);
  return places;
}

std::vector<TermInput> Attempt::inputs() const {
  std::vector<TermInput> list;
  for (const LoggedColumn& c : columns_)
    for (const Form& form : forms_)
      if (std::find(form.inputs.begin(), form.inputs.end(), c.name) != form.inputs.end() &&
          std::none_of(list.begin(), list.end(), [&](const TermInput& t) { return t.name == c.name; }))
        list.push_back({c.name, c.unit, c.reference});
  return list;
}

std::string Attempt::truth_text() const {
  std::string text = with_terms(base_, {}, {}, inputs());
  for (std::size_t e = 0; e < forms_.size(); ++e) text = with_terms(text, places_of(e), statics_of(e), {});
  return text;
}

/// What an effect at its scale does to the readings, exactly.
Eigen::VectorXd Attempt::shift_of(std::size_t effect) const {
  std::vector<TermInput> all;
  for (const LoggedColumn& c : columns_) all.push_back({c.name, c.unit, c.reference});
  const Machine with = parse_machine(
      with_terms(with_terms(base_, {}, {}, all), places_of(effect), statics_of(effect), {}), "truth.xml");
  return predict(with, measurement_) - predict(base_machine_, measurement_);
}

bool Attempt::scale_effects() {
  const auto rms = [](const Eigen::VectorXd& v) {
    return std::sqrt(v.squaredNorm() / static_cast<double>(v.size()));
  };
  scale_.assign(forms_.size(), 0);
  ratio_ = remaining_ = scale_;
  const FormColumns columns(base_machine_, measurement_, *complement_);
  const double asked = spec_.ratio * whole_noise(spec_.noise);
  for (std::size_t e = 0; e < forms_.size(); ++e) {
    Eigen::VectorXd sizes(static_cast<Eigen::Index>(forms_[e].coefficients.size()));
    for (Eigen::Index k = 0; k < sizes.size(); ++k)
      sizes[k] = forms_[e].coefficients[static_cast<std::size_t>(k)];
    const double linear = rms(columns(forms_[e], false) * sizes);
    if (!(linear > 1e-9)) return false;
    scale_[e] = asked / linear;
    // Once more with the exact shift: an angle of some size is not quite linear.
    for (int again = 0; again < 2; ++again) {
      const Eigen::VectorXd shift = complement_->weighted(shift_of(e));
      ratio_[e] = rms(complement_->project(shift));
      remaining_[e] = ratio_[e] / rms(shift);
      if (remaining_[e] < kLeastRemaining || !std::isfinite(ratio_[e])) return false;
      if (again == 0) scale_[e] *= asked / ratio_[e];
    }
    if (std::abs(ratio_[e] / asked - 1) > 0.03) return false;
  }
  return forms_.size() < 2 || far_apart();
}

/// Two effects of which each still shows beside the other.
bool Attempt::far_apart() const {
  const Eigen::VectorXd a = complement_->project(complement_->weighted(shift_of(0)));
  const Eigen::VectorXd b = complement_->project(complement_->weighted(shift_of(1)));
  return std::abs(a.dot(b)) < 0.5 * a.norm() * b.norm();
}

void Attempt::measure(HiddenSurvey& survey) {
  survey.truth = truth_text();
  const Machine truth = parse_machine(survey.truth, "truth.xml");
  Eigen::VectorXd readings = predict(truth, parse_measurement(survey.csv, "survey.csv", truth));
  survey.u = is_angular(options_.reading) ? angle_deg(u_) : u_;
  Eigen::VectorXd noise(readings.size());
  for (double& one : noise) one = draw_.normal();
  noise = noise_of(spec_.noise, measurement_, std::move(noise), noise_draw_, survey.wild);
  for (Eigen::Index i = 0; i < readings.size(); ++i) {
    const std::size_t row = measurement_.observations[static_cast<std::size_t>(i)].row;
    readings[i] += survey.u * (growing_u_.empty() ? 1 : growing_u_[row]) * noise[i];
    const double step = kQuantum * survey.u;
    if (spec_.noise == NoiseLaw::kQuantised) readings[i] = step * std::round(readings[i] / step);
  }
  const bool without_u = spec_.noise == NoiseLaw::kNoU || spec_.noise == NoiseLaw::kWalkNoU;
  survey.csv = survey_csv(table(!without_u), readings);
  for (std::size_t i = 0; i < measurement_.observations.size(); ++i)
    measurement_.observations[i].value = readings[static_cast<Eigen::Index>(i)];
}

HiddenEffect Attempt::key_of(std::size_t e) const {
  const Form& form = forms_[e];
  const std::vector<Place> places = places_of(e);
  HiddenEffect key;
  key.cause = form.cause;
  key.inputs = form.inputs;
  key.branch = places.front().workpiece ? "workpiece" : "tool";
  key.transform = places.front().n;
  key.dof = places.front().dof;
  key.term = places.front().text;
  key.ratio = ratio_[e];
  key.remaining = remaining_[e];
  for (const TermStatic& item : statics_of(e)) key.statics.push_back(item.name);
  // FORMATS gives these pairs one line or one formula.
  static const std::vector<std::pair<std::string, std::string>> names = {
      {"squareness", "axis-tilt"}, {"servo-lag", "servo-mismatch"}, {"gravity-sag", "joint-compliance"}};
  key.accept = {form.cause};
  for (const auto& [one, other] : names)
    if (form.cause.effect == one || form.cause.effect == other)
      key.accept.push_back({form.cause.effect == one ? other : one, form.cause.axis, form.cause.input});
  // Read along z alone, a carriage that tilts by heat and a beam that does are one and the same column.
  if (options_.reading == Reading::kZ && form.cause.effect == "thermal-bend")
    key.accept.push_back({"thermal-squareness", "", form.cause.input});
  return key;
}

void Attempt::judge(HiddenSurvey& survey) {
  const FormColumns columns(base_machine_, measurement_, *complement_);
  Eigen::VectorXd difference(static_cast<Eigen::Index>(measurement_.observations.size()));
  const Eigen::VectorXd expected = predict(base_machine_, measurement_);
  for (Eigen::Index i = 0; i < difference.size(); ++i)
    difference[i] = measurement_.observations[static_cast<std::size_t>(i)].value - expected[i];
  survey.can_tell = true;
  const double tells = kTells * std::pow(whole_noise(spec_.noise), 2);
  for (std::size_t e = 0; e < forms_.size(); ++e) {
    Complement beside = *complement_;  // what the other effects explain is not for this one
    for (std::size_t other = 0; other < forms_.size(); ++other)
      if (other != e) beside.extend(columns(forms_[other], true));
    const FormColumns mine(base_machine_, measurement_, beside);
    const Eigen::MatrixXd true_columns = mine(forms_[e], true);
    AlternativeTest court{g_,
                          columns_,
                          model_options_.runs,
                          mine,
                          beside.project(beside.weighted(difference)),
                          beside.project(beside.weighted(shift_of(e))),
                          0,
                          orthonormal(true_columns).cols() + forms_[e].free_numbers,
                          forms_[e].inputs,
                          is_by_speed(forms_[e])};
    court.truth_chi_square = chi_square_with(true_columns, court.residual);
    std::vector<Alternative> alternatives = find_alternatives(court, survey.effects[e].accept, draw_);
    survey.can_tell = survey.can_tell && (alternatives.empty() || alternatives.front().excess >= tells);
    survey.alternatives.insert(
        survey.alternatives.end(), alternatives.begin(),
        alternatives.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(5, alternatives.size())));
  }
}

std::optional<HiddenSurvey> Attempt::survey() {
  if (!choose()) return {};
  HiddenSurvey result;
  result.spec = spec_;
  result.model = model_ = model_text(g_, model_options_, draw_);
  const Machine at = true_values(model_, g_, 5 * u_, draw_);
  base_ = update_machine_text(model_, at, false);
  result.csv = survey_csv(table(), {});
  std::vector<TermInput> all;
  for (const LoggedColumn& c : columns_) all.push_back({c.name, c.unit, c.reference});
  base_machine_ = parse_machine(with_terms(base_, {}, {}, all), "base.xml");
  measurement_ = parse_measurement(result.csv, "survey.csv", base_machine_);
  complement_.emplace(base_machine_, measurement_);
  if (!scale_effects()) return {};
  measure(result);
  result.observations = measurement_.observations.size();
  result.parameters = complement_->parameters();
  for (std::size_t e = 0; e < forms_.size(); ++e) result.effects.push_back(key_of(e));
  judge(result);
  if (spec_.kind == SurveyClass::kConfusable &&
      (result.alternatives.empty() || result.alternatives.front().excess > 2))
    return {};
  return result;
}

}  // namespace

HiddenSurvey make_survey(const SurveySpec& spec) {
  if (spec.ratio <= 0 || spec.rows < 20 || spec.runs < 1 || (spec.feeds != 1 && spec.feeds != 3))
    throw std::invalid_argument("survey: ratio > 0, at least 20 rows, a run, 1 or 3 feeds");
  Draw seeds(spec.seed * 0x9E3779B97F4A7C15ULL + static_cast<std::uint64_t>(spec.family) * 1000003 +
             static_cast<std::uint64_t>(spec.kind));
  for (int k = 0; k < kDraws; ++k)
    if (std::optional<HiddenSurvey> survey = Attempt(spec, seeds.seed()).survey()) return *std::move(survey);
  throw std::runtime_error(
      fmt::format("{} shows nothing of {} in {} draws (seed {})", family_name(spec.family),
                  spec.effect.empty() ? class_name(spec.kind) : spec.effect, kDraws, spec.seed));
}

}  // namespace vernier::support
