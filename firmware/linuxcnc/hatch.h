// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>

#include "firmware/core/link/gate.h"

namespace vernier {

/// A request from one process to another process through shared memory. Only one request is open at a time.
/// The client writes the request, makes the number `turn` odd, and waits until it is even again. If a process
/// ends during a request, only the data of this request in the shared memory may be incomplete.
struct Call {
  static constexpr std::uint32_t kMostBytes = 4096;
  std::atomic<std::uint32_t> turn{0};
  std::uint32_t op = 0, place = 0, offset = 0, size = 0;
  std::int32_t result = 0;
  std::uint64_t connection = 0;
  std::uint8_t bytes[kMostBytes] = {};
};

/// True if the process exists and is not a zombie (a process that has ended but still has an entry for its
/// parent). Not real-time safe.
bool process_lives(std::int32_t pid) noexcept;
/// Waits for a request for at most `wait`. Not real-time safe.
bool wait_for_call(Call& call, TimeUs wait) noexcept;
inline bool is_asked(const Call& call) noexcept {
  return (call.turn.load(std::memory_order_acquire) & 1) != 0;
}
/// Marks a request as answered. Before answer_call(), the server must write the result, the size
/// and the bytes of the answer into `call`. Not real-time safe.
void answer_call(Call& call) noexcept;
/// Makes a request and waits until it is answered. Returns false and withdraws the request if the process
/// `peer` has ended or `stop` is set. Not real-time safe.
bool make_call(Call& call, std::int32_t peer, const std::atomic<bool>& stop) noexcept;

/// Requests of the component to its store. The process vernier-hal manages the store (hal/slot_store.h).
enum class StoreOp : std::uint32_t {
  kReadRecord,
  kWriteRecord,
  kReadImage,
  kWriteImage,
  kFinishImage,
  kReadGiven
};
/// Requests of the links of vernier-hal to the component (hal/command_link.h). The member `place` of such a
/// Call contains the access of the link.
enum class LinkCall : std::uint32_t { kAnswer, kLater, kRegisters, kCommand, kEnds };

/// Data that the process vernier-hal sends about itself when it connects to the component.
struct Introduction {
  std::int32_t pid = 0;
  std::uint32_t capacity = 0;     // size of a slot
  std::uint32_t given_bytes = 0;  // size of an image that is given at the start; 0: the image of the store is
                                  // used
  std::uint32_t keys = 0;
  PublicKey key[BoardIdentity::kMostKeys] = {};
  Name board, board_class;
  Nonce nonce{};
  ChallengeSeed seed{};
  char store[512] = {};
};
static_assert(sizeof(Introduction) <= Call::kMostBytes);

/// Result of a connection of vernier-hal to the component.
enum class Attached : std::int32_t {
  kStarted = 0,       // the image runs
  kResumed = 1,       // the running image continues
  kImageRefused = 2,  // the image is refused; the bytes contain the reason
  kOtherStore = 3,    // the component was started with another store or other keys, and continues with them
  kEmpty = 4,         // the store has no image, and no image was given
};

/// The memory that the component and the process vernier-hal share. The component never waits for vernier-hal
/// in a tick, because all data of the tick are in private memory.
struct Hatch {
  static constexpr int kKey = 0x5645524e;              // "VERN", in the form of HAL's keys; one component for
                                                       // each machine
  static constexpr std::uint32_t kMagic = 0x32544148;  // "HAT2"; written after all other members
  std::atomic<std::uint32_t> magic{0};
  std::int32_t component = 0;  // process id of the component
  std::atomic<std::int32_t> helper{0};
  Call attach;  // from vernier-hal to the component: an Introduction
  Call link;    // from vernier-hal to the component: a LinkCall
  Call store;   // from the component to vernier-hal: a StoreOp
};

}  // namespace vernier
