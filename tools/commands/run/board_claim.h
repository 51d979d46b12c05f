// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <CLI/CLI.hpp>
#include <string>

#include "tools/text/assurance.h"
#include "tools/upload/client.h"

namespace vernier::commands {

/// The values of the options `--board` and `--board-key`. A value is empty if its option was not given.
struct ClaimWords {
  std::string board, board_key;
};

/// Adds the options `--board` and `--board-key` to a command that changes a board.
void add_board_claim(CLI::App& command, ClaimWords& words);
/// Converts the options to a claim, which states the required identity of the board. Throws InputError if the
/// text of the key is not valid.
upload::BoardClaim claim_of(const ClaimWords& words);
/// Compares the identity of the board with the claim, before data are signed or sent. If the board is another
/// board, throws LimitNotMet with the words "nothing was sent".
void require_claim(upload::Client& client, const ClaimWords& words);
/// Records in the assurance which parts of the board's identity were compared and which were not.
void vouch_for_board(text::Assurance& assurance, const ClaimWords& words, const std::string& board);

}  // namespace vernier::commands
