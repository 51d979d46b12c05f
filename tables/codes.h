// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

/// Codes for the state of a board, which are used in link messages and records, and their texts for people.
namespace vernier {

/// Mode of the firmware: a state of the state machine below. The correction is zero in the modes Boot,
/// Checking and Faulted, and in Ready until an operator activates the correction.
///
///   Boot -> Checking -> Ready -> Active -> RampOut -> Ready
///                ^        |         |          |
///                |        +--fault--+--------> RampOut -> Faulted
///                +---------------- clear ------------------+
enum class Mode : std::uint8_t {
  kBoot = 0,      // no device has been read yet
  kChecking = 1,  // the board waits until all devices have answered without a fault for some time
  kReady = 2,     // the correction may be activated; the mode stays Ready while the correction increases
  kActive = 3,    // the whole correction is applied
  kRampOut = 4,   // the correction decreases to zero
  kFaulted = 5,   // the correction is zero, and the fault is latched
};

/// Returns the name of a mode for people, for example "ramp-out".
const char* name_of(Mode mode) noexcept;

/// Reason why the correction was removed. Each cause has one enumerator. The first fault is latched.
enum class Fault : std::uint8_t {
  kNone = 0,
  kPositionMissing = 1,   // an axis gave no reading for longer than permitted
  kPositionFrozen = 2,    // an axis reports a speed but its position does not change
  kPositionJump = 3,      // an axis moved further in one tick than is possible
  kInputMissing = 4,      // a sensor gave no reading for longer than permitted
  kWriteFailed = 5,       // the controller refused a correction
  kOverrun = 6,           // too many successive ticks ended after the next tick was due
  kClock = 7,             // the timer failed, or the time jumped
  kReferenceLost = 8,     // an axis lost its reference position
  kInputImplausible = 9,  // a reading of a sensor is beyond its plausible range, or jumps
  kImageLost = 10,        // the confirmed image cannot be loaded, so that there is no correction
};

/// Returns the name of a fault for people, for example "position-missing".
const char* name_of(Fault fault) noexcept;
constexpr std::uint8_t kFaultCount = static_cast<std::uint8_t>(Fault::kImageLost) + 1;

/// A request of an operator to the firmware. A command that is not possible in the present mode is refused
/// and counted.
enum class Command : std::uint8_t {
  kNone = 0,
  kActivate = 1,
  kDeactivate = 2,
  kClearFault = 3,
  kHold = 4,     // only in the mode Active: every correction keeps its value
  kRelease = 5,  // ends the command kHold
};
constexpr std::uint8_t kCommandCount = static_cast<std::uint8_t>(Command::kRelease) + 1;

/// Reason why the board refuses an upload, or a step of an upload.
enum class UploadFault : std::uint8_t {
  kNone = 0,
  kNoUpload = 1,         // data or the end of an upload came without its beginning
  kTrialRuns = 2,        // an image is on trial; it must be confirmed or reverted first
  kTooLarge = 3,         // the upload is larger than a slot
  kOutOfOrder = 4,       // a part of the upload does not follow the previous part
  kIncomplete = 5,       // the upload has fewer bytes than announced
  kStore = 6,            // the medium (storage) is full or defective
  kNotAnUpload = 7,      // there is no upload header, or its sizes are inconsistent
  kNoKey = 8,            // the board has no public key, so that no signature can be verified
  kForeignKey = 9,       // the image is signed with a key that the board does not trust
  kSignature = 10,       // the signature does not belong to these bytes
  kImage = 11,           // the image is not valid
  kFingerprint = 12,     // the header contains the fingerprint of another equation
  kForeignMachine = 13,  // the image does not match the wiring of the board
  kOlder = 14,           // the image is not newer than all images that were ever on trial
  kNoTrial = 15,         // no image is on trial
  kTooMuchWork = 16,     // the image needs more work than the board can do in its share of a tick
  kOtherBoard = 17,      // the image is signed for another board or class
  kSecurity = 18,        // the security number of the image is below that of the board
  kAbsurdTime = 19,      // the signing time of the image is impossible
  kOldForm = 20,         // the upload has an old format version, which contains no board name
  kKeyMayNot = 21,       // the image is signed with a key that may not (or no longer) upload
};
constexpr std::uint8_t kUploadFaultCount = static_cast<std::uint8_t>(UploadFault::kKeyMayNot) + 1;
const char* describe(UploadFault fault) noexcept;

/// Reason why an image does not match the wiring of a board.
enum class BindFault : std::uint8_t {
  kNone = 0,
  kTick = 1,          // the image is compiled for another cycle time
  kUnknownAxis = 2,   // the board has no axis with the name in the image
  kAxisKind = 3,      // the axis is rotary in the image and linear on the board (or the reverse), or only one
                      // of both has rollover
  kUnknownInput = 4,  // the board has no sensor with the name in the image
};
const char* describe(BindFault fault) noexcept;

}  // namespace vernier
