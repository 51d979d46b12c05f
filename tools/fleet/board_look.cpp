// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fleet/board_look.h"

#include <fmt/format.h>

#include "tools/text/numbers.h"

namespace vernier::fleet {

BoardLook look_at(upload::Client& board) {
  BoardLook look;
  look.tick = board.newest();
  look.state = board.state();
  look.slots = board.slots();
  look.faults = board.health().faults;
  return look;
}

std::string blocked(const BoardLook& look, const upload::BoardInfo& info) {
  if (look.tick.fault != Fault::kNone)
    return fmt::format("fault {} is latched (vernier board clear)", name_of(look.tick.fault));
  if (look.tick.holding) return "the corrections are held (vernier board release)";
  for (std::size_t i = 0; i < info.axes.size() && i < look.state.axes.size(); ++i)
    if (!(look.state.axes[i].weight >= 1))
      return fmt::format("axis {} has the weight {:.4g} (vernier board weight)", info.axes[i].name,
                         look.state.axes[i].weight);
  return {};
}

std::string not_in_effect(const BoardLook& look, const upload::BoardInfo& info, std::uint64_t fingerprint) {
  if (std::string why = blocked(look, info); !why.empty()) return why;
  if (look.state.fingerprint != fingerprint)
    return look.state.fingerprint == 0
               ? "the board runs no image"
               : "the board runs another image, " + text::fingerprint_text(look.state.fingerprint);
  if (look.tick.mode != Mode::kActive)
    return fmt::format("the board is in mode {}, not active", name_of(look.tick.mode));
  if (!(look.state.weight >= 1))
    return fmt::format("only {:.4g} % of the correction is active", 100 * look.state.weight);
  return {};
}

}  // namespace vernier::fleet
