// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "tools/effects/candidate.h"
#include "tools/effects/gravity.h"
#include "tools/model/measurement.h"
#include "tools/text/files.h"

// Every form of every effect at the places of a machine, and rows to try them on.
namespace vernier::diagnose_test {

using namespace vernier::effects;
using namespace vernier::model;

inline std::string machine_path(const std::string& name) {
  return VERNIER_SOURCE_DIR "/tables/machines/" + name + ".xml";
}

inline std::vector<std::string> reference_machines() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(VERNIER_SOURCE_DIR "/tables/machines"))
    if (entry.path().extension() == ".xml") names.push_back(entry.path().stem());
  std::sort(names.begin(), names.end());
  return names;
}

/// Where a rule lets a form act; the rules' geometry (gravity, equal columns) is left out: more places, not
/// fewer.
inline std::vector<DofPlace> places_for(const Machine& machine, const EffectForm& form,
                                        std::optional<std::size_t> axis) {
  const bool driven = axis.has_value();
  const DofPlace own = driven ? AxisPlaces(machine).own(*axis).value() : DofPlace{};
  std::vector<DofPlace> places;
  for (const DofPlace& place : all_places(machine)) {
    const bool angle = is_angle(machine, place);
    const bool beside =
        driven && own.workpiece == place.workpiece && own.transform == place.transform && !(place == own);
    bool admitted = false;
    switch (form.place) {
      case PlaceRule::kOwn:
        admitted = driven && place == own;
        break;
      case PlaceRule::kJoint:
        admitted = driven && place == own && angle && GravityChain(machine).may_turn(place);
        break;
      case PlaceRule::kCross:
        admitted = beside && !angle;
        break;
      case PlaceRule::kTurn:
        admitted = beside && angle;
        break;
      case PlaceRule::kLength:
      case PlaceRule::kBase:
        admitted = !angle;
        break;
      case PlaceRule::kAngle:
      case PlaceRule::kBaseTurn:
        admitted = angle;
        break;
      case PlaceRule::kLink:
        admitted = form.asks_for("along") != angle;
        break;
      case PlaceRule::kBend:
        admitted = transform_at(machine, place).kind == TransformKind::kSixDof && place.dof == 4;
        break;
      case PlaceRule::kPoint:
        admitted = transform_at(machine, place).kind == TransformKind::kSixDof && place.dof == 0;
        break;
      default:
        admitted = true;
    }
    if (admitted) places.push_back(place);
  }
  return places;
}

/// What a form asks of gravity said for a place, as diagnose would: a bar across, a mass at the end of the
/// branch. False where the chain to there is no product of turns, or the form wants an angle.
inline bool set_gravity(const Machine& machine, Choice& choice) {
  const EffectForm& form = *choice.form;
  const bool across = form.asks_for("across") || form.asks_for("across1"), moment = form.asks_for("moment");
  if (!across && !moment && !form.asks_for("along")) return true;
  const DofPlace& place = *choice.place;
  const GravityChain gravity(machine);
  if ((across || moment) != is_angle(machine, place) || !gravity.direction(place)) return false;
  const std::size_t end = (place.workpiece ? machine.workpiece : machine.tool).size() - 1;
  const auto is_told = [](const std::optional<Wave>& wave) { return wave && !wave->is_constant(); };
  if (moment && !is_told(gravity.moment(place, end))) return false;
  if (form.asks_for("along") && !is_told(gravity.along(place))) return false;
  for (const std::size_t next : {1U, 2U}) {
    const bool asked = (across && next == 1) || form.asks_for("across2");
    if (asked && !is_told(gravity.across(place, (local_axis(machine, place) + next) % 3))) return false;
  }
  if (form.asks_for("across"))
    choice.toward = form.place == PlaceRule::kBend ? 0 : (local_axis(machine, place) + 1) % 3;
  if (moment) choice.mass = end;
  return true;
}

/// A form of found terms: two terms, three unknowns, at each of some transforms.
inline std::vector<Choice> found_choices(const Machine& machine, Choice base, std::size_t most) {
  std::vector<Choice> list;
  const std::vector<DofPlace> all = all_places(machine);
  base.axis = 0;
  for (std::size_t i = 0; i + 1 < all.size() && list.size() < most; i += 1 + all.size() / most) {
    const std::size_t at = i - all[i].dof;  // its first degree of freedom
    Choice one = base;
    one.place = all[at];
    const std::string& input = one.inputs.front();
    one.term =
        fmt::format("{0}:k1*{2}*(lag({3},300)-20)+k2*({3}-20)|{1}:k3*({3}-20)", dof_name(machine, all[at]),
                    dof_name(machine, all[at + 1]), machine.axes[0].name, input);
    list.push_back(std::move(one));
  }
  return list;
}

/// Choices of one form: each axis at each place; of more than `most` places every k-th, a different one for
/// each axis.
inline std::vector<Choice> choices_of(const Machine& machine, const Effect& effect, const EffectForm& form,
                                      std::size_t most) {
  const auto asks = [&](const char* mark) { return form.term.find(mark) != std::string::npos; };
  Choice base;
  base.effect = &effect;
  base.form = &form;
  for (const auto& [mark, name, unit] : {std::tuple{"{T}", "T_probe", "degC"},
                                         {"{L}", "push", "N"},
                                         {"{F}", "shake", "g"},
                                         {"{V}", "tilt", "deg"},
                                         {"{S}", "T_other", "degC"}})
    if (asks(mark)) {
      base.inputs.push_back(name);
      base.units.push_back(unit);
    }
  if (asks("{runs}")) base.runs = {"a", "the second, |odd| one"};
  for (const UnknownRule& rule : effect.unknowns)
    if (rule.kind != UnknownKind::kLinear) base.start[rule.name] = 37.5;
  if (form.place == PlaceRule::kSeveral) return found_choices(machine, base, most);
  const bool together = form.place == PlaceRule::kEachAxis || form.place == PlaceRule::kNormal;
  if (together) {
    if (form.place == PlaceRule::kNormal && base_places(machine).empty()) return {};
    return {base};
  }
  const bool driven = asks("{q}") || asks("{hats") || asks("{sum}") || form.place == PlaceRule::kOwn ||
                      form.place == PlaceRule::kJoint || form.place == PlaceRule::kCross ||
                      form.place == PlaceRule::kTurn;
  std::vector<Choice> list;
  for (std::size_t axis = 0; axis < (driven ? machine.axes.size() : 1); ++axis) {
    Choice one = base;
    if (driven) {
      if (!AxisPlaces(machine).own(axis)) continue;
      one.axis = axis;
      one.from = machine.axes[axis].min.value_or(-100);
      one.to = machine.axes[axis].max.value_or(400);
      one.sum = machine.axes[axis].name;
    }
    if (form.place == PlaceRule::kPair) {
      if (axis + 1 == machine.axes.size()) continue;
      one.axis2 = axis + 1;
      list.push_back(one);
      continue;
    }
    const std::vector<DofPlace> places = places_for(machine, form, one.axis);
    const std::size_t step = 1 + (places.empty() ? 0 : (places.size() - 1) / most);
    for (std::size_t i = axis % step; i < places.size(); i += step) {
      one.place = places[i];
      if (set_gravity(machine, one)) list.push_back(one);
    }
  }
  return list;
}

inline std::vector<Choice> all_choices(const Machine& machine, std::size_t most) {
  std::vector<Choice> list;
  for (const Effect& effect : built_in_effects())
    for (const EffectForm& form : effect.forms)
      for (Choice& choice : choices_of(machine, effect, form, most)) list.push_back(std::move(choice));
  return list;
}

/// Random poses and motions with every quantity that a term may use, in two runs; readings x y z and d.
inline Measurement random_rows(const Machine& machine, std::size_t rows, std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  std::string header;
  for (const Axis& axis : machine.axes) {
    const std::string u = axis.rotary ? "deg" : "mm";
    header += fmt::format("{0}[{1}],dir{0},since{0}[{1}],v{0}[{1}/s],a{0}[{1}/s^2],", axis.name, u);
  }
  for (const Input& input : machine.inputs)
    header += input.unit.empty() ? input.name + "," : fmt::format("{}[{}],", input.name, input.unit);
  header += "T_probe[degC],push[N],shake[g],T_other[degC],tilt[deg],feed[mm/min],curv[1/mm],t[s],nx,ny,nz,";
  header += "px[mm],py[mm],pz[mm],d[mm],x[mm],y[mm],z[mm],u[um],run\n";
  std::string text = header;
  for (std::size_t i = 0; i < rows; ++i) {
    for (const Axis& axis : machine.axes) {
      const double low = axis.min.value_or(-100), high = axis.max.value_or(400);
      text += fmt::format("{},{},{},{},{},", 0.5 * (low + high) + 0.5 * (high - low) * unit(random),
                          unit(random) < 0 ? -1 : 1, 10 + 10 * unit(random), 30 * unit(random),
                          200 * unit(random));
    }
    for (const Input& input : machine.inputs) text += fmt::format("{},", input.reference + unit(random));
    text += fmt::format("{},{},{},{},{},{},{},{},0.6,0,0.8,", 20 + 5 * unit(random), 50 * unit(random),
                        unit(random), 20 + 5 * unit(random), 3 * unit(random), 1000 + 500 * unit(random),
                        0.01 * unit(random), static_cast<double>(i) * 10);
    text += fmt::format("1,2,3,0,0,0,0,{},{}\n", 1 + i % 3, i < rows / 2 ? "a" : "\"the second, |odd| one\"");
  }
  return parse_measurement(text, "rows.csv", machine);
}

}  // namespace vernier::diagnose_test
