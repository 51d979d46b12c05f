// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/hidden_survey_forms.h"
#include "tests/support/hidden_survey_inputs.h"
#include "tests/support/likeness_machines.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace vernier::support {

using namespace vernier::text;
namespace {

/// Builds the forms of one effect.
class Builder {
 public:
  Builder(std::string effect, const Geometry& geometry, const std::vector<LoggedColumn>& columns,
          const std::vector<std::string>& runs, const Share& share, Draw& draw)
      : effect_(std::move(effect)),
        g_(geometry),
        columns_(columns),
        runs_(runs),
        share_(share),
        draw_(draw) {}

  std::vector<Form> build();

 private:
  using Make = void (Builder::*)();

  Form& add(const std::string& axis, std::vector<Place> places, std::vector<double> coefficients) {
    forms_.push_back(
        {{effect_, axis, ""}, {}, std::move(places), std::move(coefficients), free_numbers(), ""});
    return forms_.back();
  }
  /// At the axis' own motion. Coefficients are of the axis' reading: a table that moves against it turns the
  /// sign.
  Form& own(const AxisPlace& a, const std::string& text, std::vector<double> coefficients) {
    for (double& c : coefficients) c *= a.sense;
    return add(a.name, {{a.workpiece, a.n, a.dof, text}}, std::move(coefficients));
  }
  int free_numbers() const {
    const auto is = [&](const char* effect) { return effect_ == effect; };
    return is("reversal-spike") || is("cyclic-error") || is("warmup-drift") || is("thermal-offset") ? 1 : 0;
  }
  /// Every degree of freedom of one sort, at every transform.
  template <class Visit>
  void each_dof(bool angle, const Visit& visit) const {
    for (const TransformPlace& t : g_.transforms)
      for (const std::string& dof : t.dofs)
        if (is_angle(dof) == angle) visit(t, dof);
  }
  /// Degrees of freedom at the axis' own transform except its motion.
  template <class Visit>
  void across(const AxisPlace& a, bool angle, const Visit& visit) const {
    each_dof(angle, [&](const TransformPlace& t, const std::string& dof) {
      if (t.workpiece == a.workpiece && t.n == a.n && dof != a.dof) visit(dof);
    });
  }
  double between(double low, double high) { return low * std::pow(high / low, share_()); }
  double span(const AxisPlace& a) const { return a.high - a.low; }
  double some() { return draw_.sign() * draw_.uniform(0.4, 1); }
  std::vector<LoggedColumn> thermometers() const {
    std::vector<LoggedColumn> result;
    for (const LoggedColumn& c : columns_)
      if (c.sort == LoggedColumn::Sort::kTemperature) result.push_back(c);
    return result;
  }
  std::string smooth(const AxisPlace& a) const;
  void each_own(const std::string& text, double coefficient, bool linear_only = false);
  void everywhere(bool angle, const std::string& text);
  void with_input(const LoggedColumn& c, Form& form, const std::string& factor);

  void scale();
  void squareness();
  void offset() { everywhere(false, "k1"); }
  void backlash() { each_own("k1*dir{a}", -1); }
  void lateral_play();
  void spike();
  void cyclic();
  void gear_train();
  void straightness();
  void angular();
  void positioning() {
    for (const AxisPlace& a : g_.axes) own(a, smooth(a), {some(), some(), 0.6 * some()});
  }
  void thermal_scale();
  void thermal_offset();
  void thermal_bend();
  void warmup();
  bool in_likeness();
  void sag();
  void compliance();
  void load();
  void servo_lag() { each_own("k1*v{a}", -1); }
  void servo_mismatch() { each_own("k1*v{a}", draw_.sign()); }
  void inertial();
  void centrifugal();
  void along_normal(const std::string& text);
  void trigger() { along_normal("k1*feed*{n}"); }
  void pretravel();
  void tool_radius() { along_normal("k1*{n}"); }
  void all_axes(const std::string& text);
  void time_sync() { all_axes("k1*v{a}"); }
  void time_base() { all_axes("k1*t*v{a}"); }
  void base_drift();
  void creep() { each_own("k1*visit*dir{a}", draw_.sign()); }
  void vibration();
  static const std::map<std::string, Make>& table();

  std::string effect_;
  const Geometry& g_;
  const std::vector<LoggedColumn>& columns_;
  const std::vector<std::string>& runs_;
  const Share& share_;
  Draw& draw_;
  std::vector<Form> forms_;
};

const std::map<std::string, Builder::Make>& Builder::table() {
  static const std::map<std::string, Make> makes = {{"scale-error", &Builder::scale},
                                                    {"squareness", &Builder::squareness},
                                                    {"offset", &Builder::offset},
                                                    {"backlash", &Builder::backlash},
                                                    {"lateral-play", &Builder::lateral_play},
                                                    {"reversal-spike", &Builder::spike},
                                                    {"cyclic-error", &Builder::cyclic},
                                                    {"straightness", &Builder::straightness},
                                                    {"angular-error", &Builder::angular},
                                                    {"positioning-error", &Builder::positioning},
                                                    {"thermal-scale", &Builder::thermal_scale},
                                                    {"thermal-offset", &Builder::thermal_offset},
                                                    {"thermal-bend", &Builder::thermal_bend},
                                                    {"warmup-drift", &Builder::warmup},
                                                    {"gravity-sag", &Builder::sag},
                                                    {"joint-compliance", &Builder::compliance},
                                                    {"load-deflection", &Builder::load},
                                                    {"servo-lag", &Builder::servo_lag},
                                                    {"servo-mismatch", &Builder::servo_mismatch},
                                                    {"inertial-deflection", &Builder::inertial},
                                                    {"centrifugal", &Builder::centrifugal},
                                                    {"trigger-delay", &Builder::trigger},
                                                    {"probe-pretravel", &Builder::pretravel},
                                                    {"tool-radius", &Builder::tool_radius},
                                                    {"time-sync", &Builder::time_sync},
                                                    {"time-base", &Builder::time_base},
                                                    {"base-drift", &Builder::base_drift},
                                                    {"creep", &Builder::creep},
                                                    {"vibration", &Builder::vibration}};
  return makes;
}

std::vector<Form> Builder::build() {
  const auto found = table().find(effect_);
  if (found == table().end()) return {};
  (this->*found->second)();
  return std::move(forms_);
}

void Builder::each_own(const std::string& text, double coefficient, bool linear_only) {
  for (const AxisPlace& a : g_.axes)
    if (!linear_only || !a.rotary)
      own(a, fmt::format(fmt::runtime(text), fmt::arg("a", a.name)), {coefficient});
}

void Builder::everywhere(bool angle, const std::string& text) {
  each_dof(angle, [&](const TransformPlace& t, const std::string& dof) {
    add("", {{t.workpiece, t.n, dof, text}}, {some()});
  });
}

void Builder::with_input(const LoggedColumn& c, Form& form, const std::string& factor) {
  form.cause.input = c.name;
  form.inputs = {c.name};
  form.reference_factor = factor;
}

void Builder::scale() { each_own("k1*{a}", some()); }

void Builder::squareness() {
  for (const AxisPlace& a : g_.axes)
    if (!a.rotary)
      across(a, false, [&](const std::string& dof) {
        add("", {{a.workpiece, a.n, dof, "k1*" + a.name}}, {some()});
      });
  everywhere(true, "k1");
}

void Builder::lateral_play() {
  for (const AxisPlace& a : g_.axes)
    across(a, false, [&](const std::string& dof) {
      add(a.name, {{a.workpiece, a.n, dof, "k1*dir" + a.name}}, {some()});
    });
}

void Builder::spike() {
  for (const AxisPlace& a : g_.axes)
    own(a, fmt::format("k1*dir{0}*exp(-since{0}/{1:.4g})", a.name, between(0.01, 0.08) * span(a)), {-1});
}

/// A worm, its wheel and a wave of one turn, all in one axis.
void Builder::gear_train() {
  const AxisPlace& a = g_.axes.front();
  const double teeth = std::round(between(60, 120));
  own(a,
      fmt::format("(k1*sin({0}+{1:.0f})+k2*sin(2*{0}+{2:.0f})+k3*sin(360*{0}/{3:.6g}+{4:.0f}))", a.name,
                  draw_.uniform(0, 360), draw_.uniform(0, 360), 360 / teeth, draw_.uniform(0, 360)),
      {1, 0.7, 0.8});
}

void Builder::cyclic() {
  if (g_.family == Family::kGearTrain) return gear_train();
  for (const AxisPlace& a : g_.axes) {
    const double period = between(0.03, 0.3) * span(a), phase = draw_.uniform(0, 6.283);
    const std::string text = fmt::format("(k1*sin(360*{0}/{1:.5g})+k2*cos(360*{0}/{1:.5g}))", a.name, period);
    own(a, text, {std::cos(phase), std::sin(phase)});
    across(a, false, [&](const std::string& dof) {
      add(a.name, {{a.workpiece, a.n, dof, text}}, {std::cos(phase), std::sin(phase)});
    });
  }
}

std::string Builder::smooth(const AxisPlace& a) const {
  const std::string part = fmt::format("({}-({:g}))/{:g}", a.name, a.low, span(a));
  return fmt::format("(k1*cos(180*{0})+k2*cos(360*{0})+k3*cos(540*{0}))", part);
}

void Builder::straightness() {
  for (const AxisPlace& a : g_.axes)
    across(a, false, [&](const std::string& dof) {
      add(a.name, {{a.workpiece, a.n, dof, smooth(a)}}, {some(), some(), 0.6 * some()});
    });
}

void Builder::angular() {
  for (const AxisPlace& a : g_.axes)
    across(a, true, [&](const std::string& dof) {
      add(a.name, {{a.workpiece, a.n, dof, smooth(a)}}, {some(), some(), 0.6 * some()});
    });
}

void Builder::thermal_scale() {
  for (const LoggedColumn& c : thermometers())
    for (const AxisPlace& a : g_.axes)
      if (!a.rotary)
        with_input(c, own(a, fmt::format("k1*{}*({}-{:g})", a.name, c.name, c.reference), {1}), a.name);
}

void Builder::thermal_offset() {
  for (const LoggedColumn& c : thermometers()) {
    const bool lagged = draw_.chance(0.5);
    const std::string of = lagged ? fmt::format("lag({},{:.0f})", c.name, between(600, 5400)) : c.name;
    each_dof(false, [&](const TransformPlace& t, const std::string& dof) {
      with_input(
          c, add("", {{t.workpiece, t.n, dof, fmt::format("k1*({}-{:g})", of, c.reference)}}, {some()}), "1");
    });
  }
}

void Builder::thermal_bend() {
  each_dof(true, [&](const TransformPlace& t, const std::string& dof) {
    for (const LoggedColumn& c : thermometers()) {
      with_input(
          c, add("", {{t.workpiece, t.n, dof, fmt::format("k1*({}-{:g})", c.name, c.reference)}}, {some()}),
          "1");
      for (const LoggedColumn& other : thermometers()) {
        if (other.name <= c.name) continue;
        Form& form =
            add("", {{t.workpiece, t.n, dof, fmt::format("k1*({}-{})", c.name, other.name)}}, {some()});
        form.inputs = {c.name, other.name};
        form.reference_factor = "1";
      }
    }
  });
}

void Builder::warmup() {
  const std::string text = fmt::format("k1*(1-exp(-t/{:.0f}))", between(900, 14400));
  everywhere(false, text);
}

/// What gravity does on a machine in the likeness of a real one.
bool Builder::in_likeness() {
  if (effects_in_likeness(g_.family).empty()) return false;
  for (const LikenessTerm& term : gravity_terms(family_name(g_.family), effect_, g_.text)) {
    std::vector<Place> places;
    for (const LikenessTerm::At& at : term.at) places.push_back({false, at.n, at.dof, at.text});
    add(term.axis, std::move(places), {draw_.sign()});
  }
  return true;
}

void Builder::sag() {
  if (in_likeness()) return;
  for (const auto& bend : g_.bends) {
    const std::string& name = bend.first;
    const AxisPlace& a = *g_.axis(name);
    if (a.rotary) {
      for (const char* shape : {"k1*sin({})", "k1*cos({})"}) {
        own(a, fmt::format(fmt::runtime(shape), name), {some()});
        across(a, false, [&](const std::string& dof) {
          add(name, {{a.workpiece, a.n, dof, fmt::format(fmt::runtime(shape), name)}}, {some()});
        });
      }
      continue;
    }
    // What the axis carries out bends everything nearer to the base.
    for (const TransformPlace& t : g_.transforms)
      if (t.workpiece == a.workpiece && t.order < a.order)
        add(name, {{t.workpiece, t.n, bend.second, "k1*" + name}}, {some()});
  }
}

/// Gravity torque about the robot's joints of an arm whose tool is the heavy part; for other machines the
/// tilt of the rotary axis.
void Builder::compliance() {
  if (in_likeness()) return;
  if (g_.family != Family::kRobot) {
    for (const auto& [name, dof] : g_.bends)
      if (dof.empty())
        for (const char* shape : {"k1*sin({})", "k1*cos({})"})
          own(*g_.axis(name), fmt::format(fmt::runtime(shape), name), {some()});
    return;
  }
  const AxisPlace &shoulder = *g_.axis("J2"), &elbow = *g_.axis("J3"), &wrist = *g_.axis("J4");
  own(shoulder, "k1*cos(J2)", {-1});
  own(shoulder, "k1*(0.61*cos(J2)+0.57*cos(J2+J3))", {-1});
  own(elbow, "k1*cos(J2+J3)", {-1});
  own(wrist, "k1*sin(J2+J3+J4)", {-1});
}

void Builder::load() {
  for (const LoggedColumn& c : columns_)
    for (const bool angle : {false, true}) {
      if (c.sort != LoggedColumn::Sort::kLoad && c.sort != LoggedColumn::Sort::kDecoy) continue;
      // What never changes is no cause of anything, only another name for a constant.
      if (std::all_of(c.value.begin(), c.value.end(), [&](double v) { return v == c.value.front(); }))
        continue;
      each_dof(angle, [&](const TransformPlace& t, const std::string& dof) {
        with_input(c, add("", {{t.workpiece, t.n, dof, "k1*" + c.name}}, {some()}), "1");
      });
    }
}

void Builder::inertial() {
  for (const AxisPlace& a : g_.axes) {
    own(a, "k1*a" + a.name, {-1});
    across(a, true, [&](const std::string& dof) {
      add(a.name, {{a.workpiece, a.n, dof, "k1*a" + a.name}}, {some()});
    });
  }
}

void Builder::centrifugal() {
  for (const AxisPlace& a : g_.axes)
    across(a, false, [&](const std::string& dof) {
      add(a.name, {{a.workpiece, a.n, dof, fmt::format("k1*v{0}^2", a.name)}}, {some()});
    });
  if (g_.family == Family::kBallBar) {
    const int n = g_.axes.front().n;
    add("",
        {{false, n, "X", "k1*feed^2*curv*X/sqrt(X^2+Y^2)"},
         {false, n, "Y", "k1*feed^2*curv*Y/sqrt(X^2+Y^2)"}},
        {-1});
  }
}

/// The same along the row's normal, in the frame of the tool point.
void Builder::along_normal(const std::string& text) {
  if (!g_.all_linear() || g_.axes.size() < 3) return;
  const TransformPlace& tip = g_.transforms.back();
  std::vector<Place> places;
  for (const auto& [dof, n] : {std::pair{"X", "nx"}, {"Y", "ny"}, {"Z", "nz"}})
    places.push_back({tip.workpiece, tip.n, dof, fmt::format(fmt::runtime(text), fmt::arg("n", n))});
  add("", std::move(places), {1});
}

void Builder::pretravel() {
  along_normal("k1*{n}");
  if (!g_.all_linear() || g_.axes.size() < 3) return;
  // A kinematic seat of three balls: the trip force, so the stylus' bending, has three lobes about its axis.
  along_normal("(k1*sin(3*atan2(ny,nx))+k2*cos(3*atan2(ny,nx)))*{n}");
  const double phase = draw_.uniform(0, 6.283);
  forms_.back().coefficients = {std::cos(phase), std::sin(phase)};
}

void Builder::all_axes(const std::string& text) {
  std::vector<Place> places;
  for (const AxisPlace& a : g_.axes)
    places.push_back({a.workpiece, a.n, a.dof,
                      (a.sense < 0 ? "-" : "") + fmt::format(fmt::runtime(text), fmt::arg("a", a.name))});
  // With one axis, time and the axis' lag are one and the same.
  add(g_.axes.size() == 1 ? g_.axes.front().name : "", std::move(places), {draw_.sign()});
}

void Builder::base_drift() {
  const TransformPlace& base = *std::find_if(g_.transforms.begin(), g_.transforms.end(),
                                             [](const TransformPlace& t) { return !t.workpiece; });
  for (const std::string& dof : base.dofs) {
    add("", {{false, base.n, dof, "k1*t/3600"}}, {some()});
    if (runs_.size() > 1 && !is_angle(dof))
      for (const std::string& run : runs_)
        add("", {{false, base.n, dof, fmt::format("k1*run(\"{}\")", run)}}, {some()});
  }
}

void Builder::vibration() {
  for (const LoggedColumn& c : columns_)
    if (c.sort == LoggedColumn::Sort::kVibration)
      each_dof(false, [&](const TransformPlace& t, const std::string& dof) {
        with_input(c, add("", {{t.workpiece, t.n, dof, "k1*" + c.name}}, {some()}), "1");
      });
}

}  // namespace

bool is_angle(const std::string& dof) { return dof.front() == 'r' || dof == "theta" || dof == "alpha"; }

Demands demands_of(const std::string& effect) {
  Demands d;
  const auto is = [&](std::initializer_list<const char*> list) {
    return std::any_of(list.begin(), list.end(), [&](const char* e) { return effect == e; });
  };
  d.moving =
      is({"servo-lag", "servo-mismatch", "inertial-deflection", "centrifugal", "time-sync", "time-base"});
  d.probing = is({"trigger-delay", "probe-pretravel", "tool-radius"});
  d.bare = is({"squareness", "offset"});
  d.without_own = is({"scale-error", "straightness", "angular-error"});
  d.shift_per_run = effect != "base-drift";
  return d;
}

std::vector<Form> forms_of(const std::string& effect, const Geometry& geometry,
                           const std::vector<LoggedColumn>& columns, const std::vector<std::string>& runs,
                           const Share& share, Draw& draw) {
  return Builder(effect, geometry, columns, runs, share, draw).build();
}

const std::vector<EffectScan>& effect_scans() {
  static const std::vector<EffectScan> scans = {
      {"scale-error", 1},     {"squareness", 1},        {"offset", 1},          {"backlash", 1},
      {"lateral-play", 1},    {"reversal-spike", 6},    {"cyclic-error", 45},   {"straightness", 1},
      {"angular-error", 1},   {"positioning-error", 1}, {"thermal-scale", 1},   {"thermal-offset", 8},
      {"thermal-bend", 1},    {"warmup-drift", 8},      {"gravity-sag", 1},     {"joint-compliance", 1},
      {"load-deflection", 1}, {"servo-lag", 1},         {"servo-mismatch", 1},  {"inertial-deflection", 1},
      {"centrifugal", 1},     {"trigger-delay", 1},     {"probe-pretravel", 4}, {"tool-radius", 1},
      {"time-sync", 1},       {"time-base", 1},         {"base-drift", 1},      {"creep", 1},
      {"vibration", 1}};
  return scans;
}

}  // namespace vernier::support
