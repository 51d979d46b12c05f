// SPDX-License-Identifier: Apache-2.0
#include "comp/probing/touch_filter.h"

namespace vernier {

// A change of the contact is complete when the settling time has passed since its first edge. The level then
// decides the kind of the change.
bool TouchFilter::conclude(InstantNs until, Touch& touch) noexcept {
  if ((state_ != State::kClosing && state_ != State::kOpening) || until - since_ < settle_) return false;
  const bool was_closing = state_ == State::kClosing;
  state_ = made_ ? State::kClosed : State::kOpen;
  if (!was_closing) return false;
  if (!made_) {
    ++counts_.spikes;
    return false;
  }
  ++counts_.touches;
  touch = pending_;
  return true;
}

bool TouchFilter::wait(InstantNs now, Touch& touch) noexcept { return conclude(now, touch); }

bool TouchFilter::edge(InstantNs at, bool made, Touch& touch) noexcept {
  bool concluded = conclude(at, touch);
  const bool settling = state_ == State::kClosing || state_ == State::kOpening;
  if (settling) {
    ++counts_.bounces;
    if (state_ == State::kClosing && made && pending_.bounces < UINT8_MAX) ++pending_.bounces;
  } else if (made) {
    pending_ = {at, state_ == State::kClosed ? TouchKind::kReleaseMissing : TouchKind::kTouch, 0};
    if (state_ == State::kClosed) ++counts_.missing;
    state_ = State::kClosing, since_ = at;
  } else if (state_ == State::kClosed) {
    state_ = State::kOpening, since_ = at;
  } else {
    // The contact opened and had not closed. A contact that settled before this edge cannot be concluded in
    // the same call, because the line was closed afterwards.
    ++counts_.missing;
    touch = {at, TouchKind::kMissed, 0};
    concluded = true;
    state_ = State::kOpening, since_ = at;
  }
  made_ = made;
  return concluded;
}

}  // namespace vernier
