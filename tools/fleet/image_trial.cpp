// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fleet/image_trial.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <future>
#include <thread>

#include "tools/registry/machine_name.h"
#include "tools/text/error.h"
#include "tools/text/numbers.h"
#include "tools/text/process.h"
#include "tools/text/wall_time.h"
#include "tools/upload/open_transport.h"

namespace vernier::fleet {
namespace {

using SteadyTime = std::chrono::steady_clock::time_point;
using Kind = TrialEnd::Kind;

constexpr std::chrono::milliseconds kLookEvery{200};
// So much of a trial's time stays for the answer to reach the board.
constexpr double kTrialMargin_s = 1;
// Time until a board reports that it has confirmed an image as requested.
constexpr double kConfirmedWithin_s = 3;

constexpr std::size_t kMostJudgeOutput = 1u << 26;  // bytes; a program in a loop ends there

/// Ends a process with its scope.
struct Ending {
  explicit Ending(text::RunningProcess& process) : running(process) {}
  ~Ending() { running.cancel(); }
  Ending(const Ending&) = delete;
  Ending& operator=(const Ending&) = delete;
  text::RunningProcess& running;
};

SteadyTime after(double seconds) {
  return std::chrono::steady_clock::now() + std::chrono::duration_cast<std::chrono::steady_clock::duration>(
                                                std::chrono::duration<double>(seconds));
}
bool is_over(SteadyTime end) { return std::chrono::steady_clock::now() >= end; }

double left_s(const SlotsReply& slots) { return slots.trial_left_ms * 1e-3 - kTrialMargin_s; }

}  // namespace

const char* name_of(TrialEnd::Kind kind) {
  switch (kind) {
    case Kind::kKept:
      return "kept";
    case Kind::kTakenBack:
      return "taken-back";
    case Kind::kRefused:
      return "refused";
    case Kind::kNotInEffect:
      return "not-in-effect";
    case Kind::kAway:
      return "away";
    case Kind::kInterrupted:
      return "waiting";  // an interrupted call has no result
  }
  return "unknown";
}

ImageTrial::ImageTrial(const RolloutMachine& machine, const RolloutOptions& options, RolloutBook& book,
                       registry::MachineLocks& locks, const std::atomic<bool>& stop)
    : machine_(machine),
      options_(options),
      book_(book),
      locks_(locks),
      stop_(stop),
      board_(upload::open_transport(upload::parse_url(machine.url))),
      fingerprint_(fingerprint_of(machine)) {
  board_.sign_with(options.key);
  board_.require_board(machine.claim);
}

bool ImageTrial::is_kept(const SlotsReply& slots) const {
  return slots.confirmed != kNoSlot && slots.trial == kNoSlot && slots.confirmed_fingerprint == fingerprint_;
}

TrialEnd ImageTrial::run(std::uint64_t own_issued) {
  locks_.require();
  const SlotsReply slots = board_.slots();
  if (is_kept(slots)) return of_kept();
  if (std::string why = clear_trial(slots, own_issued); !why.empty()) return {Kind::kRefused, why};
  const BoardLook before = look_at(board_);
  if (std::string why = blocked(before, board_.info()); !why.empty())
    return {Kind::kRefused, why + "; nothing was sent"};
  faults_before_ = before.faults;
  try {
    return try_image();
  } catch (const registry::LockLost&) {
    throw;
  } catch (const Interrupted&) {
    return take_back({Kind::kInterrupted, "interrupted"});
  } catch (const std::runtime_error& error) {
    return take_back({Kind::kTakenBack, error.what()});
  }
}

/// The board has confirmed the image already: an answer was lost, or another caller sent the image.
TrialEnd ImageTrial::of_kept() {
  const KeptLook look = look_at_kept(machine_, options_, locks_, stop_);
  if (look.why.empty()) return {Kind::kKept, ""};
  return {look.away ? Kind::kAway : Kind::kNotInEffect,
          fmt::format("the image is already permanent on the board, but: {}", look.why)};
}

/// Reverts a running trial of this rollout, left by a call that was interrupted. Returns the reason if it
/// cannot, else empty.
std::string ImageTrial::clear_trial(const SlotsReply& slots, std::uint64_t own_issued) {
  if (slots.trial == kNoSlot) return {};
  const bool own = own_issued != 0 && slots.newest_issued == own_issued;
  if (!own && !options_.take_over_trial)
    return fmt::format(
        "{} is on trial for {:.0f} s more, begun by another caller: confirm or revert it first (vernier "
        "upload "
        "--confirm, --revert), or call with --take-over-trial; nothing was sent",
        text::fingerprint_text(slots.trial_fingerprint), slots.trial_left_ms * 1e-3);
  board_.revert();
  return {};
}

void ImageTrial::send(const SlotsReply& slots) {
  issued_ = std::max<std::uint64_t>(static_cast<std::uint64_t>(text::now_us()), slots.newest_issued + 1);
  locks_.require();
  book_.begin_trial(machine_, issued_);
  board_.require_board(machine_.claim);
  board_.upload(
      upload::make_upload(machine_.image, options_.key, issued_, slots.security, board_.info().board),
      [this](double) { locks_.renew(); });
}

TrialEnd ImageTrial::try_image() {
  send(board_.slots());
  std::string wrong = settle();
  if (wrong.empty()) wrong = watch();
  if (wrong.empty() && !options_.judge.empty()) wrong = judge();
  if (wrong.empty()) wrong = why_not();
  return wrong.empty() ? keep() : take_back({Kind::kTakenBack, wrong});
}

void ImageTrial::breathe() {
  if (stop_) throw Interrupted{};
  locks_.renew();
  std::this_thread::sleep_for(kLookEvery);
}

/// The reason to end a trial immediately; empty: no reason.
std::string ImageTrial::broken(const BoardLook& look) const {
  if (look.tick.fault != Fault::kNone) return fmt::format("fault {}", name_of(look.tick.fault));
  if (look.faults > faults_before_) return "a fault occurred and was cleared";
  if (look.faults < faults_before_) return "the board was started again";
  if (look.slots.trial == kNoSlot)
    return "the trial has ended: the board or another caller reverted the image";
  if (look.slots.newest_issued != issued_) return "another caller began another trial";
  return {};
}

/// Why the image is not well on trial, now; empty: it is.
std::string ImageTrial::why_not() {
  board_.require_board(machine_.claim);
  const BoardLook look = look_at(board_);
  std::string why = broken(look);
  return why.empty() ? not_in_effect(look, board_.info(), fingerprint_) : why;
}

std::string ImageTrial::settle() {
  const SteadyTime end = after(options_.settle_s);
  for (;;) {
    board_.require_board(machine_.claim);
    const BoardLook look = look_at(board_);
    if (std::string why = broken(look); !why.empty()) return why;
    const std::string why = not_in_effect(look, board_.info(), fingerprint_);
    if (why.empty()) {
      if (left_s(look.slots) >= options_.watch_s) return {};
      return fmt::format(
          "the trial of the board lasts only {:.0f} s more, which is shorter than the time --watch",
          std::max(0.0, left_s(look.slots)));
    }
    if (is_over(end))
      return fmt::format("the board did not use the image within {:.4g} s: {}", options_.settle_s, why);
    breathe();
  }
}

std::string ImageTrial::watch() {
  const SteadyTime end = after(options_.watch_s);
  while (!is_over(end)) {
    breathe();
    if (std::string why = why_not(); !why.empty()) return "not in effect: " + why;
  }
  return {};
}

std::string ImageTrial::judge() {
  const SteadyTime end = after(left_s(board_.slots()));
  text::RunningProcess process;
  std::future<text::ProcessResult> judged = std::async(std::launch::async, [&] {
    return text::run_process(
        "/bin/sh", {"-c", registry::for_machine(options_.judge, machine_.name)}, ".", kMostJudgeOutput,
        [](std::string_view) {}, process);
  });
  // Before the future waits for its thread, and however this function ends.
  const Ending ending{process};
  while (judged.wait_for(std::chrono::milliseconds(1)) != std::future_status::ready) {
    breathe();
    if (is_over(end)) return "the --judge command gave no result within the board's trial time";
    if (std::string why = why_not(); !why.empty()) return "during the --judge command: " + why;
  }
  const text::ProcessResult result = judged.get();
  if (result.exit == 0) return {};
  return fmt::format("judged {}: {}",
                     result.exit == 2 ? "worse" : "with status " + std::to_string(result.exit),
                     text::last_line(result.out + result.err));
}

/// Requests the board to confirm the image. Success only if the board reports it afterwards.
TrialEnd ImageTrial::keep() {
  locks_.require();
  board_.require_board(machine_.claim);
  const SlotsReply slots = board_.slots();
  if (slots.trial == kNoSlot || slots.newest_issued != issued_)
    return take_back({Kind::kTakenBack, "the trial ended before the correction image was confirmed"});
  std::string why;
  try {
    board_.confirm();
    const SteadyTime end = after(kConfirmedWithin_s);
    do {
      board_.require_board(machine_.claim);
      const BoardLook look = look_at(board_);
      const bool kept = is_kept(look.slots) && look.slots.issued == issued_;
      why = kept ? not_in_effect(look, board_.info(), fingerprint_)
                 : "the board does not report that it keeps the correction image after the trial";
      if (why.empty()) return {Kind::kKept, ""};
      std::this_thread::sleep_for(kLookEvery);
    } while (!is_over(end));
  } catch (const text::InputError& error) {
    return {Kind::kAway, std::string("the program sent the command to confirm the correction image, and the "
                                     "board does not answer: ") +
                             error.what()};
  } catch (const text::LimitNotMet& error) {
    return {Kind::kNotInEffect,
            std::string("the board did not confirm the correction image: ") + error.what()};
  }
  return {Kind::kNotInEffect, fmt::format("the board did not confirm the correction image: {}", why)};
}

/// Gives the image up where the trial is this rollout's own.
TrialEnd ImageTrial::take_back(TrialEnd end) {
  try {
    board_.require_board(machine_.claim);
    const SlotsReply slots = board_.slots();
    if (slots.trial != kNoSlot && slots.newest_issued == issued_) board_.revert();
  } catch (const std::runtime_error& error) {
    end.why += fmt::format(
        " (the image could not be reverted, {}: the board reverts the image by itself when the trial ends)",
        error.what());
  }
  return end;
}

KeptLook look_at_kept(const RolloutMachine& machine, const RolloutOptions& options,
                      registry::MachineLocks& locks, const std::atomic<bool>& stop) {
  const SteadyTime end = after(options.settle_s);
  for (;;) {
    KeptLook found;
    try {
      upload::Client board(upload::open_transport(upload::parse_url(machine.url)));
      board.require_board(machine.claim);
      const BoardLook look = look_at(board);
      const bool confirmed =
          look.slots.confirmed != kNoSlot && look.slots.confirmed_fingerprint == fingerprint_of(machine);
      found.why = confirmed ? not_in_effect(look, board.info(), fingerprint_of(machine))
                            : "the board no longer has this correction image";
    } catch (const text::InputError& error) {
      found = {std::string("the board does not answer: ") + error.what(), true};
    } catch (const text::LimitNotMet& error) {
      return {error.what(), false};  // another board: waiting does not help
    }
    if (found.why.empty() || is_over(end) || stop) return found;
    locks.renew();
    std::this_thread::sleep_for(kLookEvery);
  }
}

}  // namespace vernier::fleet
