// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>

#include "tables/image_format.h"
#include "tables/upload_format.h"

/// Messages between a board and a tool. The messages of the link are identical over Modbus and ISO-TP. A
/// request contains op, sequence, payload. A reply contains op, sequence, status, payload. The numbers in
/// messages are little-endian and have the declared sizes. A board answers every request with one reply, and
/// sends no other messages. The client selects the sequence number of a request, and the reply repeats this
/// number.
namespace vernier {

constexpr std::uint16_t kLinkVersion = 3;
constexpr std::uint32_t kMaxRequestBytes = 240;
constexpr std::uint32_t kMaxReplyBytes = 244;
constexpr std::uint32_t kRequestHeaderBytes = 2, kReplyHeaderBytes = 3;

enum class LinkOp : std::uint8_t {
  kHello = 1,     // -> HelloReply
  kName = 2,      // u8 kind (0 axis, 1 input), u8 index -> char[24], u8 flags (AxisFlag)
  kTick = 3,      // newest tick -> LinkTick, LinkAxis each, LinkInput each
  kHistory = 4,   // u64 first, u16 every -> u64 next, u16 lost, then whole ticks as in kTick, as many as fit
  kHealth = 5,    // u8 first counter -> u8 count of counters in all, u64 each, as many as fit
  kSlots = 6,     // -> SlotsReply
  kBegin = 7,     // u32 bytes -> empty reply
  kData = 8,      // u32 offset, bytes -> empty reply
  kFinish = 9,    // -> empty reply
  kConfirm = 10,  // -> empty reply
  kRevert = 11,   // -> empty reply
  kRead = 12,     // u32 offset, u8 bytes -> bytes of the confirmed upload
  kCommand = 13,  // u8 Command -> empty reply after the effect of the command is stored. The next tick
                  // executes the command, or counts it if it is not possible
  kWeight = 14,   // u8 axis, u32 weight 0..65536 -> empty reply after the weight is stored
  kShares = 15,   // u16 first -> u16 shares in all, u32 programs taken so far, LinkShare each, as many as fit
  kShareName = 16,  // u16 share, u32 programs -> char[64]; kBadValue if another program runs now
  kTouches = 17,    // u64 first -> u64 next, u16 lost, then LinkTouch and LinkTouchAxis each, as many as fit
  kWorkpiece = 18,  // WorkpieceFrame -> empty reply; kBadValue if the values are not a rotation
  kChallenge = 20,  // -> ChallengeReply
  kSigned = 21,  // SignedRequest, then op and payload of the request; the reply is that of the request, with
                 // this op
  kState = 19,   // -> LinkState, then LinkAxisState for each axis: the running image, and the correction at
                 // the outputs
  kIdentify = 22,  // u8[32] nonce of the client -> IdentifyReply; kUnknownOp if the board has no key of its
                   // own
};
constexpr std::uint8_t kLinkOpCount = static_cast<std::uint8_t>(LinkOp::kIdentify) + 1;

enum class LinkStatus : std::uint8_t {
  kDone = 0,
  kUnknownOp = 1,
  kBadLength = 2,     // the request is shorter or longer than its op requires
  kBadValue = 3,      // the axis, command or counter does not exist
  kNotReady = 4,      // no data are published yet, or the previous command is not yet executed
  kRefused = 5,       // an upload step is refused: payload is u8 UploadFault, u8 ImageFault, u8 BindFault,
                      // char[] name of the wrong axis or input
  kNotAllowed = 6,    // the request is not permitted over this link
  kUnsigned = 7,      // the request is permitted only in signed form
  kBadSignature = 8,  // the signature is wrong, or its key has no right for this request
  kStale = 9,         // the challenge is not open on this connection (used or too old); the client must ask
                      // for a new challenge
  kNotStored = 10,    // the command or weight is active, but it is not stored on the medium (refused or too
                      // late); a start may restore an older setting
};
constexpr std::uint8_t kLinkStatusCount = static_cast<std::uint8_t>(LinkStatus::kNotStored) + 1;

/// Rights of a link of a board; each level includes the rights of the previous levels.
enum class LinkAccess : std::uint8_t {
  kRead = 0,     // reading of the state
  kCommand = 1,  // commands, weights, the workpiece frame, reverting an image
  kUpload = 2,   // images: upload, confirmation, reading back
};

struct SlotsReply {
  // The fingerprints also describe an image that was given at the start (vernier-hal --image) and is in no
  // slot.
  std::uint64_t confirmed_fingerprint, trial_fingerprint;
  std::uint64_t issued;           // issue number (signing time) of the confirmed image
  std::uint64_t newest_issued;    // highest issue number of all images that were ever on trial
  std::uint32_t security;         // highest security number of all images that were ever on trial
  std::uint32_t trial_left_ms;    // remaining time of the trial; 0 if no image is on trial
  std::uint8_t confirmed, trial;  // index of the slot, or 255
  std::uint8_t reserved[6];
};
static_assert(sizeof(SlotsReply) == 48);
static_assert(offsetof(SlotsReply, confirmed_fingerprint) == 0 &&
              offsetof(SlotsReply, trial_fingerprint) == 8 && offsetof(SlotsReply, issued) == 16 &&
              offsetof(SlotsReply, newest_issued) == 24 && offsetof(SlotsReply, security) == 32 &&
              offsetof(SlotsReply, trial_left_ms) == 36 && offsetof(SlotsReply, confirmed) == 40 &&
              offsetof(SlotsReply, trial) == 41 && offsetof(SlotsReply, reserved) == 42);
#pragma pack(push, 1)
struct HelloReply {
  std::uint16_t link_version;
  std::uint16_t image_version;  // kImageFormatVersion
  std::uint32_t tick_us;
  std::uint32_t capacity;  // number of bytes in a slot
  std::uint8_t axes, inputs;
  std::uint8_t has_key;
  std::uint8_t key[24];  // first bytes of the first public key that the board trusts
  char board[kBoardNameBytes], board_class[kBoardNameBytes];
};
struct ChallengeReply {
  std::uint8_t nonce[16];      // nonce of this start of the board
  std::uint8_t challenge[16];  // random number for one request over the same connection in the next ten
                               // seconds; zeros if no request over this link needs a signature
  std::uint8_t access;         // LinkAccess of the link over which the request came
  std::uint8_t keys;           // number of keys that the board trusts; 0: no request needs a signature
  std::uint8_t reserved[2];
};
/// Proved identity of a board. The signature is over IdentityHead, with the board name of HelloReply.
struct IdentifyReply {
  std::uint8_t start_nonce[16];  // nonce of this start of the board, as in ChallengeReply
  std::uint8_t key[32];          // public key of the board
  std::uint8_t signature[64];    // signature by Ed25519ph
};
struct SignedRequest {
  std::uint8_t key[8];         // first bytes of the public key of the client
  std::uint8_t challenge[16];  // challenge from the ChallengeReply
  std::uint8_t signature[64];
};
struct LinkTick {
  std::uint64_t number;  // number of ticks since power-on
  std::int64_t time_us;  // time t of the machine file
  std::int64_t feed_nm_per_min;
  std::uint8_t mode, fault, holding;
  std::uint8_t saturated;  // bit i: the correction of axis i is at a limit
};
struct LinkAxis {
  std::int64_t position;    // nm, or 2^-32 turn
  std::int32_t correction;  // correction that was written, in the same counts
  std::int8_t sense;
};
struct LinkInput {
  std::int32_t value;  // value in 1e-3 of its unit, so that a whole tick of the largest board fits a reply
};
struct LinkShare {
  std::uint8_t axis;        // index of the board's axis
  std::int32_t correction;  // contribution of the effect, counts of the axis, before limits and ramps
};
/// State of the running image.
enum class ImageState : std::uint8_t {
  kNone = 0,       // no image was ever confirmed, or no image runs yet
  kConfirmed = 1,  // the confirmed image runs
  kTrial = 2,      // the image on trial runs
  kLost = 3,       // the confirmed image cannot be loaded: Fault::kImageLost
};
/// Flags for the condition of the records in the store (operator_record.h, slots.h).
enum SettingFlag : std::uint8_t {
  kSettingDamaged = 1u << 0,  // a record was damaged at the start: the correction is deactivated until an
                              // operator activates it
  kSettingRefused = 1u << 1,  // the medium refuses the newest setting: a start may restore an older setting
  /// A record of the images was damaged at the start, so that the running image may be an older image. The
  /// correction is deactivated until an operator activates it.
  kImageRecordDamaged = 1u << 2,
};
struct LinkState {
  std::uint64_t fingerprint;  // fingerprint of the running image; 0: no image
  std::int64_t since_us;      // time t of the machine file when the tick started this image
  std::uint32_t weight;       // share of all corrections that is applied, 0..65536 (ramps and faults)
  std::uint8_t image;         // ImageState
  std::uint8_t settings;      // SettingFlag; 0 if the board does not have these flags
  std::uint8_t reserved[2];
};
struct LinkAxisState {
  std::int32_t wanted;    // required correction of the equation, at full weight and within its limit, counts
  std::int32_t achieved;  // value of the output after all limits, counts
  std::uint32_t weight;   // weight of the axis, 0..65536
  std::uint8_t limits;    // AxisLimitFlag
};
/// Flags for the limits that act on a correction at present.
enum AxisLimitFlag : std::uint8_t {
  kAtImageLimit = 1u << 0,   // the limit maxcorrection of the machine file acts
  kAtBoardLimit = 1u << 1,   // the limit max_correction of the board file acts
  kAtOutputLimit = 1u << 2,  // the correction is at the end of the converter's range
  kOnItsWay = 1u << 3,       // the slew limit or the acceleration limit acts
};
struct LinkTouch {
  std::uint64_t number;  // number of the touch since power-on
  std::int64_t time_ns;  // time of the contact, as t of the machine file
  std::int64_t workpiece_nm[3];
  std::uint32_t lost_edges, lost_touches, spikes, missing;  // numbers of losses and spikes up to this touch
  std::uint8_t kind, fault, flags, bounces;                 // TouchKind, LatchFault, TouchFlag
};
struct LinkTouchAxis {
  std::int64_t position, compensated;  // counts of the axis
  std::uint32_t uncertainty;           // standard uncertainty, counts; the largest number means this value or
                                       // more
};
#pragma pack(pop)
static_assert(sizeof(ChallengeReply) == 36);
static_assert(offsetof(ChallengeReply, nonce) == 0 && offsetof(ChallengeReply, challenge) == 16 &&
              offsetof(ChallengeReply, access) == 32 && offsetof(ChallengeReply, keys) == 33 &&
              offsetof(ChallengeReply, reserved) == 34);
static_assert(sizeof(IdentifyReply) == 112);
static_assert(offsetof(IdentifyReply, start_nonce) == 0 && offsetof(IdentifyReply, key) == 16 &&
              offsetof(IdentifyReply, signature) == 48);
static_assert(sizeof(SignedRequest) == 88);
static_assert(offsetof(SignedRequest, key) == 0 && offsetof(SignedRequest, challenge) == 8 &&
              offsetof(SignedRequest, signature) == 24);
static_assert(sizeof(HelloReply) == 87);
static_assert(offsetof(HelloReply, link_version) == 0 && offsetof(HelloReply, image_version) == 2 &&
              offsetof(HelloReply, tick_us) == 4 && offsetof(HelloReply, capacity) == 8 &&
              offsetof(HelloReply, axes) == 12 && offsetof(HelloReply, inputs) == 13 &&
              offsetof(HelloReply, has_key) == 14 && offsetof(HelloReply, key) == 15 &&
              offsetof(HelloReply, board) == 39 && offsetof(HelloReply, board_class) == 63);
static_assert(sizeof(LinkTick) == 28);
static_assert(offsetof(LinkTick, number) == 0 && offsetof(LinkTick, time_us) == 8 &&
              offsetof(LinkTick, feed_nm_per_min) == 16 && offsetof(LinkTick, mode) == 24 &&
              offsetof(LinkTick, fault) == 25 && offsetof(LinkTick, holding) == 26 &&
              offsetof(LinkTick, saturated) == 27);
static_assert(sizeof(LinkAxis) == 13);
static_assert(offsetof(LinkAxis, position) == 0 && offsetof(LinkAxis, correction) == 8 &&
              offsetof(LinkAxis, sense) == 12);
static_assert(sizeof(LinkInput) == 4);
static_assert(offsetof(LinkInput, value) == 0);
static_assert(sizeof(LinkShare) == 5);
static_assert(offsetof(LinkShare, axis) == 0 && offsetof(LinkShare, correction) == 1);
static_assert(sizeof(LinkState) == 24);
static_assert(offsetof(LinkState, fingerprint) == 0 && offsetof(LinkState, since_us) == 8 &&
              offsetof(LinkState, weight) == 16 && offsetof(LinkState, image) == 20 &&
              offsetof(LinkState, settings) == 21 && offsetof(LinkState, reserved) == 22);
static_assert(sizeof(LinkAxisState) == 13);
static_assert(offsetof(LinkAxisState, wanted) == 0 && offsetof(LinkAxisState, achieved) == 4 &&
              offsetof(LinkAxisState, weight) == 8 && offsetof(LinkAxisState, limits) == 12);
static_assert(sizeof(LinkTouch) == 60);
static_assert(offsetof(LinkTouch, number) == 0 && offsetof(LinkTouch, time_ns) == 8 &&
              offsetof(LinkTouch, workpiece_nm) == 16 && offsetof(LinkTouch, lost_edges) == 40 &&
              offsetof(LinkTouch, lost_touches) == 44 && offsetof(LinkTouch, spikes) == 48 &&
              offsetof(LinkTouch, missing) == 52 && offsetof(LinkTouch, kind) == 56 &&
              offsetof(LinkTouch, fault) == 57 && offsetof(LinkTouch, flags) == 58 &&
              offsetof(LinkTouch, bounces) == 59);
static_assert(sizeof(LinkTouchAxis) == 20);
static_assert(offsetof(LinkTouchAxis, position) == 0 && offsetof(LinkTouchAxis, compensated) == 8 &&
              offsetof(LinkTouchAxis, uncertainty) == 16);
static_assert(kReplyHeaderBytes + 10 + sizeof(LinkTouch) + kMaxAxes * sizeof(LinkTouchAxis) <=
              kMaxReplyBytes);
static_assert(kReplyHeaderBytes + 10 + sizeof(LinkTick) + kMaxAxes * sizeof(LinkAxis) +
                  kMaxInputs * sizeof(LinkInput) <=
              kMaxReplyBytes);

/// Register map of the Modbus server: big-endian registers of 16 bits, with two bytes per register, high byte
/// first. Register addresses begin at zero.
///  - Mailbox: the client writes a request (function 16) to the holding registers from kMailbox: the length
///    in bytes, then the bytes. The reply is in the input registers from kMailbox: the length in bytes, then
///    the bytes.
///  - Live state for any Modbus master: input registers from 0, LiveRegister.
///  - Command: holding register 0 takes a Command (function 6).
constexpr int kMailboxRegister = 256;
constexpr int kMailboxRegisters = 123;  // largest number of registers in one write
enum LiveRegister : int {
  kLiveLayout = 0,     // kLinkVersion
  kLiveMode = 1,       // Mode
  kLiveFault = 2,      // Fault
  kLiveHolding = 3,    // 0, 1
  kLiveTicks = 4,      // 2 registers, high word first: number of ticks since power-on, low 32 bits
  kLiveOverruns = 6,   // 2 registers
  kLiveLatency = 8,    // p99 of the wake-up latency, us
  kLiveImage = 9,      // ImageState
  kLiveWeight = 10,    // share of all corrections that is applied, 0.01 %
  kLiveLimits = 11,    // bit i: the correction of axis i is at a limit
  kLiveSince = 12,     // 2 registers: time since the tick started the image, s
  kLiveSettings = 14,  // SettingFlag
  kLiveAxes = 16,  // per axis 4 registers: position in um (linear) or 1e-3 deg (rotary), 2 registers, signed;
                   // correction in 0.01 um or 1e-6 deg, 2 registers, signed
  kLiveInputs = 48,        // per input 2 registers: 0.001 of its unit, signed
  kLiveFingerprint = 96,   // 4 registers, highest word first: fingerprint of the running image; 0: no image
  kLiveAxisWeights = 100,  // weight of each axis, 0.01 %
  kLiveRegisters = 108     // number of live registers
};
constexpr int kLiveRegistersPerAxis = 4;
static_assert(kLiveInputs == kLiveAxes + kLiveRegistersPerAxis * static_cast<int>(kMaxAxes));
static_assert(kLiveFingerprint == kLiveInputs + 2 * static_cast<int>(kMaxInputs));
static_assert(kLiveRegisters == kLiveAxisWeights + static_cast<int>(kMaxAxes));

}  // namespace vernier
