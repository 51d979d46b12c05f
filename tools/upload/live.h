// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "tools/upload/client.h"

namespace vernier::upload {

/// Returns the present state of a board as JSON: mode, fault, axes, inputs, counters, latency, image slots.
nlohmann::ordered_json live_json(const BoardInfo& info, const BoardTick& tick, const HealthRecord& health,
                                 const SlotsReply& slots, const std::vector<BoardShare>& shares,
                                 const BoardState& state);
/// Returns true if a board has a confirmed correction image: in its store, or given when the board was
/// started (vernier-hal --image).
bool has_confirmed(const SlotsReply& slots);
/// Returns a text about the confirmed correction image: "0123456789abcdef is confirmed" with the state of the
/// image in the store, or that no image is confirmed.
std::string confirmed_text(const SlotsReply& slots);
/// Returns the fingerprint of the confirmed correction image (16 hexadecimal digits); null if no image is
/// confirmed.
nlohmann::ordered_json confirmed_json(const SlotsReply& slots);
/// Returns the present state of a board as a text of several lines for the user.
std::string live_text(const BoardInfo& info, const BoardTick& tick, const HealthRecord& health,
                      const SlotsReply& slots, const std::vector<BoardShare>& shares,
                      const BoardState& state);

}  // namespace vernier::upload
