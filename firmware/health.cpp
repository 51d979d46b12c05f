// SPDX-License-Identifier: Apache-2.0
#include "firmware/health.h"

namespace vernier {

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
  }
  return "unknown";
}

}  // namespace vernier
