// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/commands/run/board_claim.h"

#include <fmt/format.h>

#include "tools/text/error.h"

namespace vernier::commands {

void add_board_claim(CLI::App& command, ClaimWords& words) {
  command.add_option("--board", words.board,
                     "the name that the board must have; nothing is sent to a board of another name");
  command.add_option("--board-key", words.board_key,
                     "the board's own key (64 hexadecimal digits, or its file identity.pub); the board must "
                     "prove that it has this key before anything is sent");
}

upload::BoardClaim claim_of(const ClaimWords& words) {
  upload::BoardClaim claim{words.board, std::nullopt};
  if (!words.board_key.empty()) claim.key = upload::parse_board_key(words.board_key);
  return claim;
}

void require_claim(upload::Client& client, const ClaimWords& words) {
  const upload::BoardClaim claim = claim_of(words);
  try {
    client.require_board(claim);
  } catch (const text::LimitNotMet& error) {
    throw text::LimitNotMet(std::string(error.what()) + "; nothing was sent");
  }
}

void vouch_for_board(text::Assurance& assurance, const ClaimWords& words, const std::string& board) {
  const std::string name = board.empty() ? "without a name" : board;
  if (!words.board.empty())
    assurance.require("board-name", board == words.board, fmt::format("the board is {}", name));
  else
    assurance.not_covered(fmt::format("whether {} is the intended board: no --board was given", name));
  if (!words.board_key.empty())
    assurance.require("board-key", true, "the board proved that it has the expected key");
  else
    assurance.not_covered("whether the board has the key that is expected: no --board-key was given");
}

}  // namespace vernier::commands
