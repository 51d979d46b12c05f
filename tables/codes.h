// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

/// Numbers of the state of a board: the codes of link messages and records, and their texts for people.
namespace vernier {

/// Mode of the firmware: a step of the state machine below. The correction is zero in Boot, Checking and
/// Faulted, and in Ready until an operator activates the correction.
///
///   Boot -> Checking -> Ready -> Active -> RampOut -> Ready
///                ^        |         |          |
///                |        +--fault--+--------> RampOut -> Faulted
///                +---------------- clear ------------------+
enum class Mode : std::uint8_t {
  kBoot = 0,      // no device has been read
  kChecking = 1,  // waits until all devices have answered without fault for a while
  kReady = 2,     // may be activated; while it brings the correction in it is still Ready
  kActive = 3,    // the whole correction is in
  kRampOut = 4,   // takes the correction out
  kFaulted = 5,   // correction is out, the fault is latched
};

/// Returns the name of the mode for people: "ramp-out".
const char* name_of(Mode mode) noexcept;

/// Reason why the correction was removed. Each cause has one enumerator; the first fault latches.
enum class Fault : std::uint8_t {
  kNone = 0,
  kPositionMissing = 1,   // an axis gave no reading for longer than tolerated
  kPositionFrozen = 2,    // an axis claims speed and does not move
  kPositionJump = 3,      // an axis moved further in a tick than it can
  kInputMissing = 4,      // a sensor gave no reading for longer than tolerated
  kWriteFailed = 5,       // the controller refused a correction
  kOverrun = 6,           // too many ticks in a row ended after the next was due
  kClock = 7,             // the timer failed, or time jumped
  kReferenceLost = 8,     // an axis does not know its zero any more
  kInputImplausible = 9,  // a sensor reads beyond its plausible range or jumps
  kImageLost = 10,        // the confirmed image cannot be loaded: no correction
};

/// Returns the name of the fault for people: "position-missing".
const char* name_of(Fault fault) noexcept;
constexpr std::uint8_t kFaultCount = static_cast<std::uint8_t>(Fault::kImageLost) + 1;

/// A request of an operator to the firmware. A command that does not fit the mode is refused and counted.
enum class Command : std::uint8_t {
  kNone = 0,
  kActivate = 1,
  kDeactivate = 2,
  kClearFault = 3,
  kHold = 4,     // Active only: every correction keeps its value
  kRelease = 5,  // ends a hold
};
constexpr std::uint8_t kCommandCount = static_cast<std::uint8_t>(Command::kRelease) + 1;

/// Reason why the board refuses an upload, or a step of an upload.
enum class UploadFault : std::uint8_t {
  kNone = 0,
  kNoUpload = 1,         // data or an end without a beginning
  kTrialRuns = 2,        // the image on trial must be confirmed or reverted first
  kTooLarge = 3,         // larger than a slot
  kOutOfOrder = 4,       // a piece that does not follow the last one
  kIncomplete = 5,       // fewer bytes than announced
  kStore = 6,            // the medium is full or broken
  kNotAnUpload = 7,      // no upload header, or its sizes do not fit
  kNoKey = 8,            // the board has no public key: no signature can be verified
  kForeignKey = 9,       // signed with another key
  kSignature = 10,       // the signature does not fit the bytes
  kImage = 11,           // the image is refused
  kFingerprint = 12,     // the header names another equation
  kForeignMachine = 13,  // the image does not fit the board's wiring
  kOlder = 14,           // not newer than all that were ever tried
  kNoTrial = 15,         // no image is on trial
  kTooMuchWork = 16,     // more work than the board does in its share of a tick
  kOtherBoard = 17,      // signed for another board or class
  kSecurity = 18,        // below the security counter
  kAbsurdTime = 19,      // signed at a time that cannot be
  kOldForm = 20,         // of a version that names no board
  kKeyMayNot = 21,       // signed with a key that may not upload, or not any more
};
constexpr std::uint8_t kUploadFaultCount = static_cast<std::uint8_t>(UploadFault::kKeyMayNot) + 1;
const char* describe(UploadFault fault) noexcept;

/// Why an image does not fit a board.
enum class BindFault : std::uint8_t {
  kNone = 0,
  kTick = 1,          // compiled for another cycle time
  kUnknownAxis = 2,   // the board has no axis of that name
  kAxisKind = 3,      // rotary on one side and linear on the other, or only one of them rolls over
  kUnknownInput = 4,  // the board has no sensor of that name
};
const char* describe(BindFault fault) noexcept;

}  // namespace vernier
