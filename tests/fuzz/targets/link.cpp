// SPDX-License-Identifier: GPL-3.0-or-later
// Requests as Modbus, ISO-TP and serial links hand them over, to a whole board of two axes: read, command,
// upload, signed or not.
#include <cstring>
#include <memory>

#include "firmware/core/service.h"
#include "hal/sim/plant.h"
#include "hal/sim/roaming.h"
#include "hal/sim/sim_clock.h"
#include "hal/sim/sim_slot_store.h"
#include "tests/fuzz/target.h"

namespace vernier {

// Every second signature fits, so that what stands behind it is reached.
bool signature_fits(std::span<const std::uint8_t>, std::span<const std::uint8_t>,
                    const std::uint8_t* signature, const PublicKey&) {
  return signature[0] % 2 == 0;
}

namespace fuzz {
namespace {

class Request : public CommandLink {
 public:
  HalFault serve(CommandHandler& handler, TimeUs) noexcept override {
    if (message.size() == 2) {  // too short for a request: a plain master's command
      handler.give(static_cast<std::uint16_t>(message[0] | message[1] << 8));
      std::uint16_t registers[kLiveRegisters];
      handler.fill_registers(registers);
    }
    size = handler.answer(message.data(), static_cast<std::uint32_t>(message.size()), reply);
    return HalFault::kNone;
  }
  Bytes message;
  std::uint8_t reply[kMaxReplyBytes] = {};
  std::uint32_t size = 0;
};

/// First byte: the link's access and whether the board has a key. Then requests, a tick after each; a signed
/// one gets the last challenge.
void take(Bytes bytes) {
  Pieces pieces(bytes);
  const std::uint8_t kind = pieces.byte();
  ServiceOptions options;
  options.wiring = {{{"X"}, {"Y"}}, {"T"}};
  if ((kind & 4) != 0) options.upload.identity = BoardIdentity(PublicKey{});
  options.ticks_kept = 16;
  options.touches_kept = 4;
  options.activate = true;
  SimClock clock;
  Roaming motion({{0, 600'000'000}, {0, 200'000'000}}, {InputMicro(21'000'000)}, TimeUs(1000), 0.1, 1);
  SimPlant plant(motion, 2, 1, {});
  SimSlotStore store(8192);
  const auto service = std::make_unique<Service>(
      options, Board{.clock = clock, .axes = plant, .inputs = plant, .corrections = plant}, store);
  service->boot();
  plant.release();
  Request link;
  LinkRights rights;
  rights.access = static_cast<LinkAccess>(kind % 3);
  ChallengeBytes challenge{};
  for (Bytes piece; pieces.next(piece);) {
    std::vector<std::uint8_t> message(piece.begin(), piece.end());
    constexpr std::size_t kAt = kRequestHeaderBytes + offsetof(SignedRequest, challenge);
    if (message.size() >= kAt + challenge.size() && message[0] == static_cast<std::uint8_t>(LinkOp::kSigned))
      std::memcpy(message.data() + kAt, challenge.data(), challenge.size());
    link.message = message;
    service->serve(link, TimeUs(0), rights);
    expect(link.size <= kMaxReplyBytes, "a reply longer than any");
    expect(message.size() < kRequestHeaderBytes || link.size >= kReplyHeaderBytes,
           "a request without a reply");
    if (message.size() >= 2 && message[0] == static_cast<std::uint8_t>(LinkOp::kChallenge) && link.size > 35)
      std::memcpy(challenge.data(), link.reply + kReplyHeaderBytes + offsetof(ChallengeReply, challenge),
                  challenge.size());
    service->look_after_programs();
    plant.advance();
    service->tick();
  }
}

const Registered kTarget("link", take);

}  // namespace
}  // namespace fuzz
}  // namespace vernier
