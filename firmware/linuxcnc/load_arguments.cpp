// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware/linuxcnc/load_arguments.h"

#include <cstdio>
#include <cstring>
#include <string_view>

#include "tables/image_format.h"

namespace vernier {
namespace {

constexpr int kLongestShown = 40;
constexpr const char* kNone = "none";  // rotary=none: not even A, B and C

/// Makes the text of a refusal; the first one is kept.
class Refusal {
 public:
  explicit Refusal(std::span<char> text) : text_(text) { text_[0] = 0; }
  bool none() const { return text_[0] == 0; }
  void say(const char* argument, const char* name, const char* what) {
    if (none()) std::snprintf(text_.data(), text_.size(), "%s=%.*s: %s", argument, kLongestShown, name, what);
  }

 private:
  std::span<char> text_;
};

bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
}

bool is_good(const char* argument, const char* name, Refusal& refusal) {
  const std::string_view text(name);
  if (text.empty()) refusal.say(argument, name, "a name is empty");
  if (text.size() >= kImageNameBytes) refusal.say(argument, name, "longer than 23 characters");
  for (const char c : text)
    if (!is_letter(c)) refusal.say(argument, name, "a name may contain only letters, digits, _ and -");
  return refusal.none();
}

bool holds(std::span<char* const> list, std::string_view name) {
  for (const char* const one : list)
    if (one != nullptr && name == one) return true;
  return false;
}

bool is_axis(const Wiring& wiring, std::string_view name) {
  for (const Wiring::Axis& axis : wiring.axes)
    if (axis.name == name) return true;
  return false;
}

void read_axes(const LoadArguments& arguments, Wiring& wiring, Refusal& refusal) {
  const bool by_name = arguments.rotary.empty() || arguments.rotary[0] == nullptr;
  for (const char* const name : arguments.axes) {
    if (name == nullptr || !is_good("axes", name, refusal)) continue;
    const std::string_view text(name);
    if (is_axis(wiring, text)) refusal.say("axes", name, "there twice");
    const bool turns = by_name ? text == "A" || text == "B" || text == "C" : holds(arguments.rotary, text);
    // The controller never takes a whole turn back.
    wiring.axes.push_back({.name = text, .rotary = turns, .rollover = false, .continuous = turns});
  }
  if (wiring.axes.empty())
    refusal.say("axes", "", "axes is missing: give the axis names of the joints, axes=X,Y,...");
}

void check_rotary(const LoadArguments& arguments, const Wiring& wiring, Refusal& refusal) {
  const bool only_none = arguments.rotary.size() < 2 || arguments.rotary[1] == nullptr;
  for (const char* const name : arguments.rotary) {
    if (name == nullptr || is_axis(wiring, name)) continue;
    if (!only_none || std::strcmp(name, kNone) != 0) refusal.say("rotary", name, "this name is not in axes");
  }
}

void read_inputs(const LoadArguments& arguments, Wiring& wiring, Refusal& refusal) {
  for (const char* const name : arguments.inputs) {
    if (name == nullptr || !is_good("inputs", name, refusal)) continue;
    if (is_axis(wiring, name)) refusal.say("inputs", name, "the name of an axis");
    for (const Name& other : wiring.inputs)
      if (other == name) refusal.say("inputs", name, "there twice");
    wiring.inputs.push_back(name);
  }
}

// LinuxCNC's own words for [TRAJ]LINEAR_UNITS.
double read_units(const char* units, Refusal& refusal) {
  const std::string_view text(units == nullptr ? "mm" : units);
  if (text == "mm" || text == "metric") return 1;
  if (text == "inch" || text == "in" || text == "imperial") return 25.4;
  refusal.say("units", units, "mm or inch");
  return 1;
}

}  // namespace

bool read_load_arguments(const LoadArguments& arguments, LoadedWiring& loaded, std::span<char> why) {
  Refusal refusal(why);
  read_axes(arguments, loaded.wiring, refusal);
  check_rotary(arguments, loaded.wiring, refusal);
  read_inputs(arguments, loaded.wiring, refusal);
  loaded.mm_per_unit = read_units(arguments.units, refusal);
  return refusal.none();
}

}  // namespace vernier
