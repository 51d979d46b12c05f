// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <string>

#include "tools/upload/client.h"

namespace vernier::fleet {

/// State of a board, read within a few milliseconds.
struct BoardLook {
  upload::BoardTick tick;
  upload::BoardState state;
  SlotsReply slots;
  std::uint64_t faults = 0;  // number of faults since the start of the board
};

/// Reads the state of a board. Throws the exceptions of upload::Client.
BoardLook look_at(upload::Client& board);

/// Returns a sentence with the reason why the board does not use the image with this fingerprint. If the
/// board uses the image, the returned sentence is empty. An image is in use if it runs, the board is active,
/// no fault is latched, no correction is held, and the whole correction of every axis is applied.
std::string not_in_effect(const BoardLook& look, const upload::BoardInfo& info, std::uint64_t fingerprint);

/// Returns the reason why the board cannot start to use an image until a user changes its state. If the
/// board can start to use an image, the returned text is empty. Possible reasons are a latched fault, held
/// corrections, or an axis with a weight below 1.
std::string blocked(const BoardLook& look, const upload::BoardInfo& info);

}  // namespace vernier::fleet
