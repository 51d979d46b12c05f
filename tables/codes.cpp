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
      return "larger than a slot of the board";
    case UploadFault::kOutOfOrder:
      return "a piece out of order";
    case UploadFault::kIncomplete:
      return "bytes are missing";
    case UploadFault::kStore:
      return "the board's store is full or broken";
    case UploadFault::kNotAnUpload:
      return "not a signed upload";
    case UploadFault::kNoKey:
      return "the board has no public key";
    case UploadFault::kForeignKey:
      return "signed with a key that the board does not trust";
    case UploadFault::kSignature:
      return "the signature does not fit the bytes";
    case UploadFault::kImage:
      return "image refused";
    case UploadFault::kFingerprint:
      return "the header names another equation";
    case UploadFault::kForeignMachine:
      return "of another machine";
    case UploadFault::kOlder:
      return "not newer than the newest image that was ever tried";
    case UploadFault::kNoTrial:
      return "no image is on trial";
    case UploadFault::kTooMuchWork:
      return "more work than this board does in its share of a tick";
    case UploadFault::kOtherBoard:
      return "signed for another board";
    case UploadFault::kSecurity:
      return "below the board's security counter";
    case UploadFault::kAbsurdTime:
      return "signed at a time that cannot be";
    case UploadFault::kOldForm:
      return "signed in a form that names no board: sign it again";
    case UploadFault::kKeyMayNot:
      return "signed with a key that may not upload";
  }
  return "unknown";
}

const char* describe(BindFault fault) noexcept {
  switch (fault) {
    case BindFault::kNone:
      return "none";
    case BindFault::kTick:
      return "compiled for another cycle time";
    case BindFault::kUnknownAxis:
      return "the board has no such axis";
    case BindFault::kAxisKind:
      return "the board's axis of that name is of another kind (linear, rotary, rollover)";
    case BindFault::kUnknownInput:
      return "the board has no such sensor";
  }
  return "unknown";
}

}  // namespace vernier
