// SPDX-License-Identifier: Apache-2.0
#include "tables/codes.h"

namespace vernier {

const char* name_of(Mode mode) noexcept {
  switch (mode) {
    case Mode::kBoot:
      return "boot";
    case Mode::kChecking:
      return "checking";
    case Mode::kReady:
      return "ready";
    case Mode::kActive:
      return "active";
    case Mode::kRampOut:
      return "ramp-out";
    case Mode::kFaulted:
      return "faulted";
  }
  return "unknown";
}

const char* name_of(Fault fault) noexcept {
  switch (fault) {
    case Fault::kNone:
      return "none";
    case Fault::kPositionMissing:
      return "position-missing";
    case Fault::kPositionFrozen:
      return "position-frozen";
    case Fault::kPositionJump:
      return "position-jump";
    case Fault::kInputMissing:
      return "input-missing";
    case Fault::kWriteFailed:
      return "write-failed";
    case Fault::kOverrun:
      return "overrun";
    case Fault::kClock:
      return "clock";
    case Fault::kReferenceLost:
      return "reference-lost";
    case Fault::kInputImplausible:
      return "input-implausible";
    case Fault::kImageLost:
      return "image-lost";
  }
  return "unknown";
}

const char* describe(UploadFault fault) noexcept {
  switch (fault) {
    case UploadFault::kNone:
      return "none";
    case UploadFault::kNoUpload:
      return "no upload has begun";
    case UploadFault::kTrialRuns:
      return "an image is on trial: confirm or revert it first";
    case UploadFault::kTooLarge:
      return "the image is larger than a slot of the board";
    case UploadFault::kOutOfOrder:
      return "a piece of the image arrived out of order";
    case UploadFault::kIncomplete:
      return "bytes of the image are missing";
    case UploadFault::kStore:
      return "the board's store is full or broken";
    case UploadFault::kNotAnUpload:
      return "the data are not a signed upload";
    case UploadFault::kNoKey:
      return "the board has no public key";
    case UploadFault::kForeignKey:
      return "the image is signed with a key that the board does not trust";
    case UploadFault::kSignature:
      return "the signature does not match the bytes of the image";
    case UploadFault::kImage:
      return "the image is not valid";
    case UploadFault::kFingerprint:
      return "the header contains the fingerprint of another equation";
    case UploadFault::kForeignMachine:
      return "the image does not match this board";
    case UploadFault::kOlder:
      return "the image is not newer than the newest image that was ever on trial";
    case UploadFault::kNoTrial:
      return "no image is on trial";
    case UploadFault::kTooMuchWork:
      return "the image needs more operations in each tick than this board can execute";
    case UploadFault::kOtherBoard:
      return "the image is signed for another board or class";
    case UploadFault::kSecurity:
      return "the security counter of the image is below that of the board";
    case UploadFault::kAbsurdTime:
      return "the signing time of the image is impossible";
    case UploadFault::kOldForm:
      return "the image is signed in an old form that names no board: sign it again";
    case UploadFault::kKeyMayNot:
      return "the image is signed with a key that may not upload";
  }
  return "unknown";
}

const char* describe(BindFault fault) noexcept {
  switch (fault) {
    case BindFault::kNone:
      return "none";
    case BindFault::kTick:
      return "the image is compiled for another cycle time";
    case BindFault::kUnknownAxis:
      return "the board has no axis of this name";
    case BindFault::kAxisKind:
      return "the board's axis of this name is of another kind (linear, rotary, rollover)";
    case BindFault::kUnknownInput:
      return "the board has no sensor of this name";
  }
  return "unknown";
}

}  // namespace vernier
