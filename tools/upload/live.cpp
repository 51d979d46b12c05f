// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/upload/live.h"
#include "tools/text/numbers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace vernier::upload {
namespace {

struct Counter {
  const char* name;
  std::uint64_t HealthRecord::*value;
};

constexpr Counter kCounters[] = {{"ticks", &HealthRecord::ticks},
                                 {"active_ticks", &HealthRecord::active_ticks},
                                 {"overruns", &HealthRecord::overruns},
                                 {"skipped", &HealthRecord::skipped},
                                 {"missing_readings", &HealthRecord::missing_readings},
                                 {"missing_inputs", &HealthRecord::missing_inputs},
                                 {"frozen_readings", &HealthRecord::frozen_readings},
                                 {"jumps", &HealthRecord::jumps},
                                 {"unreferenced", &HealthRecord::unreferenced},
                                 {"implausible", &HealthRecord::implausible},
                                 {"failed_writes", &HealthRecord::failed_writes},
                                 {"saturated", &HealthRecord::saturated},
                                 {"slewing", &HealthRecord::slewing},
                                 {"beyond_range", &HealthRecord::beyond_range},
                                 {"faults", &HealthRecord::faults},
                                 {"refused_commands", &HealthRecord::refused_commands},
                                 {"programs", &HealthRecord::programs}};

nlohmann::ordered_json times_json(const std::int64_t (&ns)[4]) {
  const auto us = [&](int i) { return static_cast<double>(ns[i]) * 1e-3; };
  return {{"p50", us(0)}, {"p99", us(1)}, {"p999", us(2)}, {"max", us(3)}};
}

nlohmann::ordered_json image_json(std::uint8_t slot, std::uint64_t fingerprint) {
  if (slot == kNoSlot) return nullptr;
  return text::fingerprint_text(fingerprint);
}

// One that was given at the start is confirmed, and no slot holds it.
const char* whence(const SlotsReply& slots) {
  return slots.confirmed == kNoSlot ? " (given at the start, not in the store)" : "";
}

std::string times_text(const char* name, const std::int64_t (&ns)[4]) {
  const auto us = [&](int i) { return static_cast<double>(ns[i]) * 1e-3; };
  return fmt::format("{:<20} p50 {:8.2f}  p99 {:8.2f}  p99.9 {:8.2f}  max {:9.2f} us\n", name, us(0), us(1),
                     us(2), us(3));
}

// The largest first.
std::string shares_text(const BoardInfo& info, std::vector<BoardShare> shares) {
  constexpr std::size_t kMostLines = 12;  // of a screen
  std::erase_if(shares, [](const BoardShare& share) { return share.correction == 0; });
  std::stable_sort(shares.begin(), shares.end(), [](const BoardShare& a, const BoardShare& b) {
    return std::abs(a.correction) > std::abs(b.correction);
  });
  std::string text;
  for (std::size_t i = 0; i < shares.size() && i < kMostLines; ++i) {
    const BoardSignal& axis = info.axes[shares[i].axis];
    text += fmt::format("  {:<10} {:>12.3f} {:<5}{}\n", axis.name, 1e3 * shares[i].correction,
                        axis.rotary ? "mdeg" : "um", shares[i].name);
  }
  if (shares.size() > kMostLines) text += fmt::format("  and {} smaller ones\n", shares.size() - kMostLines);
  return text.empty() ? text : "contributions of the effects\n" + text;
}

// What runs, since when, and how much of it is in: no correction must not look like one.
std::string running_text(const BoardTick& tick, const BoardState& state) {
  if (state.image == ImageState::kLost) return "RUNS NOTHING: the confirmed image is lost\n";
  if (state.fingerprint == 0) return "runs nothing\n";
  return fmt::format("runs {:016x} ({}) for {:.1f} s, {:.0f} % of the correction is active\n",
                     state.fingerprint, name_of(state.image), tick.time_s - state.since_s,
                     100 * state.weight);
}

}  // namespace

bool has_confirmed(const SlotsReply& slots) {
  return slots.confirmed != kNoSlot || slots.confirmed_fingerprint != 0;
}

std::string confirmed_text(const SlotsReply& slots) {
  return has_confirmed(slots)
             ? fmt::format("{:016x} is confirmed{}", slots.confirmed_fingerprint, whence(slots))
             : "no image of the board was confirmed after a trial";
}

nlohmann::ordered_json confirmed_json(const SlotsReply& slots) {
  if (!has_confirmed(slots)) return nullptr;
  return text::fingerprint_text(slots.confirmed_fingerprint);
}

nlohmann::ordered_json live_json(const BoardInfo& info, const BoardTick& tick, const HealthRecord& health,
                                 const SlotsReply& slots, const std::vector<BoardShare>& shares,
                                 const BoardState& state) {
  nlohmann::ordered_json result = {
      {"tick", tick.number},
      {"t", tick.time_s},
      {"mode", name_of(tick.mode)},
      {"fault", name_of(tick.fault)},
      {"holding", tick.holding},
      {"confirmed", confirmed_json(slots)},
      {"trial", image_json(slots.trial, slots.trial_fingerprint)},
      {"trial_left_s", slots.trial_left_ms * 1e-3},
      {"image", name_of(state.image)},
      {"running", state.fingerprint == 0 ? nlohmann::ordered_json(nullptr)
                                         : nlohmann::ordered_json(text::fingerprint_text(state.fingerprint))},
      {"running_since_t", state.since_s},
      {"weight", state.weight},
      {"settings_damaged", (state.settings & kSettingDamaged) != 0},
      {"image_record_damaged", (state.settings & kImageRecordDamaged) != 0},
      {"settings_refused", (state.settings & kSettingRefused) != 0}};
  for (std::size_t i = 0; i < info.axes.size(); ++i)
    result["axes"][info.axes[i].name] = {{"position", tick.position[i]},
                                         {"correction", tick.correction[i]},
                                         {"wanted", state.axes[i].wanted},
                                         {"achieved", state.axes[i].achieved},
                                         {"weight", state.axes[i].weight},
                                         {"saturated", bool(tick.saturated[i])},
                                         {"limits", limits_text(state.axes[i].limits)},
                                         {"sense", tick.sense[i]},
                                         {"unit", info.axes[i].rotary ? "deg" : "mm"}};
  result["inputs"] = nlohmann::ordered_json::object();
  for (std::size_t i = 0; i < info.inputs.size(); ++i) result["inputs"][info.inputs[i]] = tick.input[i];
  result["shares"] = nlohmann::ordered_json::array();
  for (const BoardShare& share : shares)
    result["shares"].push_back(
        {{"axis", info.axes[share.axis].name}, {"effect", share.name}, {"correction", share.correction}});
  for (const Counter& counter : kCounters) result["health"][counter.name] = health.*counter.value;
  result["latency_us"] = times_json(health.latency_ns);
  result["execution_us"] = times_json(health.execution_ns);
  return result;
}

std::string live_text(const BoardInfo& info, const BoardTick& tick, const HealthRecord& health,
                      const SlotsReply& slots, const std::vector<BoardShare>& shares,
                      const BoardState& state) {
  std::string text = fmt::format("t {:.3f} s  mode {}{}  fault {}\n", tick.time_s, name_of(tick.mode),
                                 tick.holding ? " (held)" : "", name_of(tick.fault));
  auto out = std::back_inserter(text);
  if (!has_confirmed(slots) && slots.trial == kNoSlot) fmt::format_to(out, "image none\n");
  if (has_confirmed(slots))
    fmt::format_to(out, "image {:016x} confirmed{}\n", slots.confirmed_fingerprint, whence(slots));
  if (slots.trial != kNoSlot)
    fmt::format_to(out, "image {:016x} on trial, {:.0f} s left\n", slots.trial_fingerprint,
                   slots.trial_left_ms * 1e-3);
  text += running_text(tick, state) + settings_text(state.settings);
  fmt::format_to(out, "{:<12} {:>16} {:>16} {:>13} {:>7}\n", "axis", "position", "achieved", "wanted",
                 "weight");
  for (std::size_t i = 0; i < info.axes.size(); ++i)
    fmt::format_to(out, "{:<12} {:>13.4f} {:<3}{:>12.3f} {:<4}{:>12.3f} {:>7.2f} {}\n", info.axes[i].name,
                   tick.position[i], info.axes[i].rotary ? "deg" : "mm", 1e3 * state.axes[i].achieved,
                   info.axes[i].rotary ? "mdeg" : "um", 1e3 * state.axes[i].wanted, state.axes[i].weight,
                   limits_text(state.axes[i].limits));
  for (std::size_t i = 0; i < info.inputs.size(); ++i)
    fmt::format_to(out, "{:<12} {:>13.4f}\n", info.inputs[i], tick.input[i]);
  text += shares_text(info, shares);
  text += times_text("wake-up latency", health.latency_ns) +
          times_text("execution of a tick", health.execution_ns);
  std::string counted;
  for (const Counter& counter : kCounters)
    if (health.*counter.value != 0)
      counted += fmt::format("{}{} {}", counted.empty() ? "" : ", ", counter.name, health.*counter.value);
  return text + counted + "\n";
}

}  // namespace vernier::upload
