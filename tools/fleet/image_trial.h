// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <atomic>
#include <cstdint>
#include <string>

#include "tools/fleet/board_look.h"
#include "tools/fleet/rollout_book.h"
#include "tools/upload/client.h"

namespace vernier::fleet {

struct RolloutOptions {
  std::string name;
  upload::SigningKey key;
  double watch_s = 10;   // on trial and in effect without a break, before the image is judged
  double settle_s = 10;  // until an image must be in effect
  double lease_s = 60;   // of the lock of a machine; a killed caller's lock ends after it
  std::string judge;     // a shell's command: 0 not worse, anything else worse or not known; empty: only the
                         // board is watched
  bool go_on = false;    // machines that were taken back are tried again
  bool take_over_trial = false;  // a trial of another caller is reverted
};

/// Result of the rollout for one machine.
struct TrialEnd {
  enum class Kind : std::uint8_t { kKept, kTakenBack, kRefused, kNotInEffect, kAway, kInterrupted } kind;
  std::string why;
};
/// "kept", "taken-back", ...: the state in the registry.
const char* name_of(TrialEnd::Kind kind);

/// Steps of a rollout for one machine: start the trial of the correction image, check that the board uses the
/// image, evaluate the machine, then confirm or revert the image. No data are signed or sent before the board
/// has proved that it is the board of the machine. The board repeats this proof before each check, and before
/// the correction image is confirmed or reverted.
class ImageTrial {
 public:
  /// Opens the board. Throws InputError if the board does not answer, LimitNotMet if it is another board. All
  /// arguments outlive the trial.
  ImageTrial(const RolloutMachine& machine, const RolloutOptions& options, RolloutBook& book,
             registry::MachineLocks& locks, const std::atomic<bool>& stop);
  /// Runs the trial. own_issued: RolloutState::issued; it distinguishes a trial of this rollout from a trial
  /// of another caller. Throws LockLost if the lock was lost; the board is not changed after that.
  TrialEnd run(std::uint64_t own_issued);

 private:
  struct Interrupted {};
  bool is_kept(const SlotsReply& slots) const;
  TrialEnd of_kept();
  std::string clear_trial(const SlotsReply& slots, std::uint64_t own_issued);
  TrialEnd try_image();
  void send(const SlotsReply& slots);
  void breathe();
  std::string broken(const BoardLook& look) const;
  std::string why_not();
  std::string settle();
  std::string watch();
  std::string judge();
  TrialEnd keep();
  TrialEnd take_back(TrialEnd end);

  const RolloutMachine& machine_;
  const RolloutOptions& options_;
  RolloutBook& book_;
  registry::MachineLocks& locks_;
  const std::atomic<bool>& stop_;
  upload::Client board_;
  std::uint64_t fingerprint_, issued_ = 0, faults_before_ = 0;
};

/// Result of a check of a machine with a confirmed image. The check is repeated until it passes or
/// options.settle_s are over. To pass, the board must prove its identity, must have confirmed the correction
/// image, and must use this image.
struct KeptLook {
  std::string why;  // why not; empty: it is
  bool away = false;
};
/// Throws LockLost.
KeptLook look_at_kept(const RolloutMachine& machine, const RolloutOptions& options,
                      registry::MachineLocks& locks, const std::atomic<bool>& stop);

}  // namespace vernier::fleet
