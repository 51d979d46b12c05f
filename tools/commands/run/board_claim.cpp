// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/commands/run/board_claim.h"

#include <fmt/format.h>

#include "tools/text/error.h"

namespace vernier::commands {

void add_board_claim(CLI::App& command, ClaimWords& words) {
  command.add_option("--board", words.board,
                     "expected name of the board; the command sends nothing to a board with another name");
  command.add_option("--board-key", words.board_key,
                     "public key of the board (64 hexadecimal digits, or the file identity.pub); the command "
                     "sends nothing until the board proves that it has this key");
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
    assurance.not_covered("The key of the board was not checked, because --board-key was not given");
}

}  // namespace vernier::commands
