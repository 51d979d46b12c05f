// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "tables/image_format.h"

/// Messages between a board and a tool, the same over Modbus and ISO-TP. A request is
/// op, sequence, payload; its reply is op, sequence, status, payload. Little-endian, sizes as declared; a
/// board answers every request with one reply and speaks only when asked. The sequence is the asker's; the
/// reply repeats it.
namespace vernier {

constexpr std::uint16_t kLinkVersion = 1;
constexpr std::uint32_t kMaxRequestBytes = 240;
constexpr std::uint32_t kMaxReplyBytes = 244;
constexpr std::uint32_t kRequestHeaderBytes = 2, kReplyHeaderBytes = 3;

enum class LinkOp : std::uint8_t {
  kHello = 1,  // -> HelloReply
  kName,       // u8 kind (0 axis, 1 input), u8 index -> char[24], u8 flags (AxisFlag)
  kTick,       // newest tick -> LinkTick, LinkAxis each, LinkInput each
  kHistory,    // u64 first, u16 every -> u64 next, u16 lost, then whole ticks as in kTick, as many as fit
  kHealth,     // u8 first counter -> u8 count of counters in all, u64 each, as many as fit
  kSlots,      // -> SlotsReply
  kBegin,      // u32 bytes -> nothing
  kData,       // u32 offset, bytes -> nothing
  kFinish,     // -> nothing
  kConfirm,    // -> nothing
  kRevert,     // -> nothing
  kRead,       // u32 offset, u8 bytes -> bytes of the confirmed upload
  kCommand,    // u8 Command -> nothing: it is taken by the next tick, and counted where it does not fit
  kWeight,     // u8 axis, u32 weight 0..65536 -> nothing
  kShares,     // u16 first -> u16 shares in all, u32 programs taken so far, LinkShare each, as many as fit
  kShareName,  // u16 share, u32 programs -> char[64]; kBadValue where another program runs by now
  kTouches,    // u64 first -> u64 next, u16 lost, then LinkTouch and LinkTouchAxis each, as many as fit
  kWorkpiece,  // WorkpieceFrame -> nothing; kBadValue where it is no turn
};
constexpr std::uint8_t kLinkOpCount = static_cast<std::uint8_t>(LinkOp::kWorkpiece) + 1;

enum class LinkStatus : std::uint8_t {
  kDone,
  kUnknownOp,
  kBadLength,  // shorter or longer than the op's request
  kBadValue,   // no such axis, command, counter ...
  kNotReady,   // nothing published yet, or the command before has not been taken
  kRefused,    // an upload step: payload is u8 UploadFault, u8 ImageFault, u8 BindFault, char[] the offending
               // name
};
constexpr std::uint8_t kLinkStatusCount = static_cast<std::uint8_t>(LinkStatus::kRefused) + 1;

struct SlotsReply {
  std::uint64_t confirmed_fingerprint, trial_fingerprint;
  std::uint64_t issued;           // of the confirmed image
  std::uint32_t trial_left_ms;    // 0 where none runs
  std::uint8_t confirmed, trial;  // slot, or 255
  std::uint8_t reserved[2];
};
static_assert(sizeof(SlotsReply) == 32);
#pragma pack(push, 1)
struct HelloReply {
  std::uint16_t link_version;
  std::uint16_t image_version;  // kImageFormatVersion
  std::uint32_t tick_us;
  std::uint32_t capacity;  // bytes of a slot
  std::uint8_t axes, inputs;
  std::uint8_t has_key;
  std::uint8_t key[24];  // first bytes of the public key
};
struct LinkTick {
  std::uint64_t number;  // ticks since power-on
  std::int64_t time_us;  // the machine file's t
  std::int64_t feed_nm_per_min;
  std::uint8_t mode, fault, holding, reserved;
};
struct LinkAxis {
  std::int64_t position;    // nm, or 2^-32 turn
  std::int32_t correction;  // as written, the same counts
  std::int8_t sense;
};
struct LinkInput {
  std::int32_t value;  // 1e-3 of its unit, so that a whole tick of the largest board fits a reply
};
struct LinkShare {
  std::uint8_t axis;        // board's
  std::int32_t correction;  // what the effect adds, counts of the axis, before limits and ramps
};
struct LinkTouch {
  std::uint64_t number;  // of the touch since power-on
  std::int64_t time_ns;  // of the contact, the machine file's t
  std::int64_t workpiece_nm[3];
  std::uint32_t lost_edges, lost_touches, spikes, missing;  // until then
  std::uint8_t kind, fault, flags, bounces;                 // TouchKind, LatchFault, TouchFlag
};
struct LinkTouchAxis {
  std::int64_t position, compensated;  // counts of the axis
  std::uint32_t uncertainty;           // standard, counts; the largest value: at least that
};
#pragma pack(pop)
static_assert(kReplyHeaderBytes + 10 + sizeof(LinkTouch) + kMaxAxes * sizeof(LinkTouchAxis) <=
              kMaxReplyBytes);
static_assert(kReplyHeaderBytes + 10 + sizeof(LinkTick) + kMaxAxes * sizeof(LinkAxis) +
                  kMaxInputs * sizeof(LinkInput) <=
              kMaxReplyBytes);

/// Register map of the Modbus server: big-endian registers of 16 bits, bytes packed high byte first.
/// Addresses count from zero.
///  - Mailbox: a request is written (function 16) to the holding registers from kMailbox: its length in
///  bytes, then
///    the bytes. The reply stands in the input registers from kMailbox, likewise.
///  - Live state for any Modbus master: input registers from 0, LiveRegister.
///  - Command: holding register 0 takes a Command (function 6).
constexpr int kMailboxRegister = 256;
constexpr int kMailboxRegisters = 123;  // what one write may carry
enum LiveRegister : int {
  kLiveLayout,   // kLinkVersion
  kLiveMode,     // Mode
  kLiveFault,    // Fault
  kLiveHolding,  // 0, 1
  kLiveTicks,    // 2 registers, high word first: ticks since power-on, low 32 bits
  kLiveOverruns = kLiveTicks + 2,
  kLiveLatency = kLiveOverruns + 2,  // p99 of the wake-up latency, us
  kLiveAxes = 16,  // per axis 4 registers: position in um (linear) or 1e-3 deg (rotary), 2 registers, signed;
                   // correction in 0.01 um or 1e-6 deg, 2 registers, signed
  kLiveRegistersPerAxis = 4,
  kLiveInputs = kLiveAxes + 4 * kMaxAxes,  // per input 2 registers: 0.001 of its unit, signed
  kLiveRegisters = kLiveInputs + 2 * kMaxInputs
};

}  // namespace vernier
