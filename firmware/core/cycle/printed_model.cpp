// SPDX-License-Identifier: Apache-2.0
#include "firmware/core/cycle/printed_model.h"

#if defined(VERNIER_MODEL)
#include VERNIER_MODEL
#endif

namespace vernier {

PrintedModel printed_model() noexcept {
#if defined(VERNIER_MODEL)
  return {generated::kFingerprint, &generated::equation};
#else
  return {};
#endif
}

}  // namespace vernier
