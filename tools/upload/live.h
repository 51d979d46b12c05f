// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "tools/upload/client.h"

namespace vernier {

/// What a board does just now, for programs: mode, fault, axes, inputs, counters, latency, slots. tool.
nlohmann::ordered_json live_json(const BoardInfo& info, const BoardTick& tick, const HealthRecord& health,
                                 const SlotsReply& slots, const std::vector<BoardShare>& shares,
                                 const BoardState& state);
/// The same for people, several lines, each ended. tool.
std::string live_text(const BoardInfo& info, const BoardTick& tick, const HealthRecord& health,
                      const SlotsReply& slots, const std::vector<BoardShare>& shares,
                      const BoardState& state);

}  // namespace vernier
