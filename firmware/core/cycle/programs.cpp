// SPDX-License-Identifier: Apache-2.0
#include "firmware/core/cycle/programs.h"

#include <algorithm>
#include <memory>

namespace vernier {

void LoadedProgram::start_anew() noexcept {
  std::uint32_t inputs[kMaxInputs];
  std::copy_n(bound.input, kMaxInputs, inputs);
  const bool empty = bound.empty();
  std::destroy_at(&bound);
  if (empty)
    std::construct_at(&bound);
  else
    std::construct_at(&bound, view, dense.memory());
  std::copy_n(axis, kMaxAxes, bound.axis);
  std::copy_n(inputs, kMaxInputs, bound.input);
}

Programs::Programs(Exchange& exchange, std::uint32_t places, std::uint32_t image_bytes,
                   std::uint32_t dense_cells)
    : exchange_(exchange),
      places_(places),
      image_bytes_(image_bytes),
      programs_(new LoadedProgram[places]),
      owned_(new bool[places]()) {
  for (std::uint32_t i = 0; i < places_; ++i) {
    programs_[i].words.reset(new std::uint64_t[(image_bytes + 7) / 8]);
    programs_[i].dense = DenseStore(dense_cells);
  }
}

ProgramRef Programs::take() noexcept {
  for (std::uint32_t i = 0; i < places_; ++i)
    if (!programs_[i].taken.exchange(true, std::memory_order_acquire)) return ProgramRef(&programs_[i]);
  return nullptr;
}

void Programs::run_confirmed(ProgramRef program) noexcept { confirmed_in_.store(program.release()); }

void Programs::run_trial(ProgramRef program, TimeUs trial_time) noexcept {
  program->trial_time = trial_time;
  to_give_up_.store(false);
  trial_in_.store(program.release());
  trial_.store(Trial::kRunning);
}

bool Programs::give_up() noexcept {
  if (trial_.load() != Trial::kRunning) return false;
  to_give_up_.store(true);
  return true;
}

// The previous program of the tick is free when the tick runs the offered one.
void Programs::collect() noexcept {
  if (exchange_.retired.load(std::memory_order_acquire) == nullptr) return;
  running_ = offered_;
  offered_ = nullptr;
  running_->number.store(++taken_over_);
  seen_.store(running_);
  exchange_.retired.store(nullptr, std::memory_order_release);
}

// The one that was confirmed may have run an hour ago; its lags begin where its inputs are now.
void Programs::go_back() noexcept {
  tried_ = nullptr;
  until_us_.store(0);
  wanted_ = kept_ != nullptr ? kept_ : other_empty();
  if (wanted_ != running_ && wanted_ != offered_) wanted_->start_anew();
}

void Programs::end_trial(TimeUs now) noexcept {
  if (tried_ == nullptr) return;
  const bool over = to_give_up_.load() || now.count >= static_cast<std::int64_t>(until_us_.load());
  if (over && change(Trial::kRunning, Trial::kOver)) {
    go_back();
  } else if (trial_.load() == Trial::kKept) {
    kept_ = tried_;
    tried_ = nullptr;
    until_us_.store(0);
    trial_.store(Trial::kNone);
  }
}

void Programs::offer() noexcept {
  if (wanted_ == nullptr || wanted_ == offered_) return;
  // A program that the tick has not taken yet is withdrawn.
  if (offered_ != nullptr) {
    if (exchange_.offered.exchange(nullptr, std::memory_order_acq_rel) == nullptr) return;
    offered_ = nullptr;
  }
  if (wanted_ == running_) return;
  offered_ = wanted_;
  exchange_.offered.store(&offered_->bound, std::memory_order_release);
}

void Programs::free_unused() noexcept {
  const LoadedProgram* const looked_at = looked_at_.load();
  for (std::uint32_t i = 0; i < places_; ++i) {
    LoadedProgram* const program = &programs_[i];
    if (!owned_[i]) continue;
    const bool used = program == running_ || program == offered_ || program == wanted_ || program == kept_ ||
                      program == tried_ || program == looked_at;
    if (used) continue;
    owned_[i] = false;
    program->taken.store(false, std::memory_order_release);
  }
}

void Programs::own(LoadedProgram* program) noexcept {
  wanted_ = program;
  owned_[static_cast<std::size_t>(program - programs_.get())] = true;
}

void Programs::guard(TimeUs now) noexcept {
  collect();
  if (LoadedProgram* const confirmed = confirmed_in_.exchange(nullptr); confirmed != nullptr) {
    own(confirmed);
    kept_ = confirmed;
  }
  if (LoadedProgram* const tried = trial_in_.exchange(nullptr); tried != nullptr) {
    own(tried);
    tried_ = tried;
    until_us_.store(static_cast<std::uint64_t>((now + tried->trial_time).count));
  }
  end_trial(now);
  offer();
  free_unused();
}

TimeUs Programs::trial_left(TimeUs now, TimeUs whole) const noexcept {
  const std::uint64_t until_us = until_us_.load();
  if (until_us == 0) return whole;
  return std::max(TimeUs(static_cast<std::int64_t>(until_us)) - now, TimeUs{});
}

const LoadedProgram* Programs::look() noexcept {
  // The guardian frees no program that is marked here; a program that was freed before the mark was set is
  // not read.
  const LoadedProgram* const program = seen_.load();
  looked_at_.store(program);
  if (program == nullptr || seen_.load() != program) return looked_at_.store(nullptr), nullptr;
  return program;
}

}  // namespace vernier
