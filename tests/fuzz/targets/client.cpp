// SPDX-License-Identifier: GPL-3.0-or-later
// What a tool does with a board that answers anything.
#include "tools/upload/client.h"

#include "tests/fuzz/target.h"
#include "tools/text/error.h"
#include "tools/upload/live.h"

namespace vernier::fuzz {

using namespace vernier::text;
using namespace vernier::upload;
namespace {

/// Answers are the pieces of the input, with op and sequence of the request where the piece has room.
class Liar : public Transport {
 public:
  explicit Liar(Pieces& pieces) : pieces_(pieces) {}
  std::vector<std::uint8_t> ask(const std::vector<std::uint8_t>& request) override {
    Bytes piece;
    if (!pieces_.next(piece)) throw InputError("no reply");
    std::vector<std::uint8_t> reply(piece.begin(), piece.end());
    for (std::size_t i = 0; i < 2 && i < reply.size() && i < request.size(); ++i) reply[i] = request[i];
    return reply;
  }
  void pause(std::chrono::milliseconds) override {}

 private:
  Pieces& pieces_;
};

void take(Bytes bytes) {
  Pieces pieces(bytes);
  const std::uint8_t what = pieces.byte();
  try {
    Client client(std::make_unique<Liar>(pieces));
    const auto silent = [](double) {};
    switch (what % 5) {
      case 0:
        live_text(client.info(), client.newest(), client.health(), client.slots(), client.shares(),
                  client.state());
        break;
      case 1:
        client.history(0, 1);
        client.touches(0);
        break;
      case 2:
        client.confirmed(silent);
        break;
      case 3:
        client.upload(std::vector<std::uint8_t>(500), silent);
        client.confirm();
        break;
      default:
        live_json(client.info(), client.newest(), client.health(), client.slots(), client.shares(),
                  client.state())
            .dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
    }
  } catch (const InputError&) {
  } catch (const LimitNotMet&) {
  }
}

const Registered kTarget("client", take);

}  // namespace
}  // namespace vernier::fuzz
