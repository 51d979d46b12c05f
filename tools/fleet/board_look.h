// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <string>

#include "tools/upload/client.h"

namespace vernier::fleet {

/// Reads the state of a board within a few milliseconds.
struct BoardLook {
  upload::BoardTick tick;
  upload::BoardState state;
  SlotsReply slots;
  std::uint64_t faults = 0;  // counted since the start of the board
};

/// Throws as upload::Client.
BoardLook look_at(upload::Client& board);

/// Returns a sentence with the reason why the board does not use the correction image with this fingerprint;
/// empty: the board uses the image. An image is in effect if it runs, the board is active, no fault is
/// latched, no correction is held, and the whole correction of every axis is applied.
std::string not_in_effect(const BoardLook& look, const upload::BoardInfo& info, std::uint64_t fingerprint);

/// Returns the reason why the board cannot start to use a correction image until a user changes the state of
/// the board; empty: the board can start to use an image. Reasons: a latched fault, held corrections, or an
/// axis with a weight below 1.
std::string blocked(const BoardLook& look, const upload::BoardInfo& info);

}  // namespace vernier::fleet
