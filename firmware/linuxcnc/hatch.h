// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>

#include "firmware/core/link/gate.h"

namespace vernier {

/// A request from one process to another in shared memory, one at a time. The client writes the request,
/// makes the turn number odd and waits for the next even number. If a process ends during a request, only the
/// request in the shared memory has changed.
struct Call {
  static constexpr std::uint32_t kMostBytes = 4096;
  std::atomic<std::uint32_t> turn{0};
  std::uint32_t op = 0, place = 0, offset = 0, size = 0;
  std::int32_t result = 0;
  std::uint64_t connection = 0;
  std::uint8_t bytes[kMostBytes] = {};
};

/// True if the process exists and is not a zombie (a process that only waits for its parent).
/// Not real-time safe.
bool process_lives(std::int32_t pid) noexcept;
/// Waits at most `wait` for a request. Not real-time safe.
bool wait_for_call(Call& call, TimeUs wait) noexcept;
inline bool is_asked(const Call& call) noexcept {
  return (call.turn.load(std::memory_order_acquire) & 1) != 0;
}
/// The request is answered: result, size and bytes are in the call. Not real-time safe.
void answer_call(Call& call) noexcept;
/// Waits until the call is answered. Returns false, and withdraws the call, if `peer` has ended or `stop` is
/// set. Not real-time safe.
bool make_call(Call& call, std::int32_t peer, const std::atomic<bool>& stop) noexcept;

/// Requests of the component to its store, which the process vernier-hal manages (hal/slot_store.h).
enum class StoreOp : std::uint32_t {
  kReadRecord,
  kWriteRecord,
  kReadImage,
  kWriteImage,
  kFinishImage,
  kReadGiven
};
/// Requests of vernier-hal's links to the component (hal/command_link.h). place: the link's access.
enum class LinkCall : std::uint32_t { kAnswer, kLater, kRegisters, kCommand, kEnds };

/// Data that vernier-hal sends about itself when it connects.
struct Introduction {
  std::int32_t pid = 0;
  std::uint32_t capacity = 0;     // of a slot
  std::uint32_t given_bytes = 0;  // of an image to start with; 0: the image of the store
  std::uint32_t keys = 0;
  PublicKey key[BoardIdentity::kMostKeys] = {};
  Name board, board_class;
  Nonce nonce{};
  ChallengeSeed seed{};
  char store[512] = {};
};
static_assert(sizeof(Introduction) <= Call::kMostBytes);

/// Result of the component.
enum class Attached : std::int32_t {
  kStarted = 0,       // the image runs
  kResumed = 1,       // it continues with its running image
  kImageRefused = 2,  // bytes: why
  kOtherStore = 3,    // it has been started with another store or other keys, and keeps them
  kEmpty = 4,         // the store has no image, and no image was given
};

/// The memory that component and vernier-hal share. The component never waits for vernier-hal in a tick: all
/// data of the tick are in private memory.
struct Hatch {
  static constexpr int kKey = 0x5645524e;              // "VERN", as HAL's keys are: one component a machine
  static constexpr std::uint32_t kMagic = 0x32544148;  // "HAT2", written when the rest is there
  std::atomic<std::uint32_t> magic{0};
  std::int32_t component = 0;  // process
  std::atomic<std::int32_t> helper{0};
  Call attach;  // vernier-hal to component: an Introduction
  Call link;    // vernier-hal to component: LinkCall
  Call store;   // component to vernier-hal: StoreOp
};

}  // namespace vernier
