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
  double watch_s = 10;   // time for which the image must be on trial and in use without interruption before
                         // it is evaluated
  double settle_s = 10;  // longest time until an image must be in use
  double lease_s = 60;   // duration of the lease (lock) of a machine; the lock of a killed program ends after
                         // this time
  std::string judge;     // shell command that evaluates a machine: exit status 0 means not worse, any other
                         // status means worse or unknown; empty: only the board is monitored
  bool go_on = false;    // true: machines whose image was reverted are tried again
  bool take_over_trial = false;  // true: a trial that another caller started is reverted
};

/// Result of the rollout (distribution of an image in stages) for one machine.
struct TrialEnd {
  enum class Kind : std::uint8_t { kKept, kTakenBack, kRefused, kNotInEffect, kAway, kInterrupted } kind;
  std::string why;
};
/// Returns the name of a result: "kept", "taken-back", ... The name of a result is its state in the registry.
const char* name_of(TrialEnd::Kind kind);

/// Steps of a rollout for one machine: start the trial of the image, check that the board uses the image,
/// evaluate the machine, and then confirm or revert the image. Before data are signed or sent, the board must
/// prove that it is the board of the machine. The board proves its identity again before each check, and
/// before the image is confirmed or reverted.
class ImageTrial {
 public:
  /// Opens the connection to the board. Throws InputError if the board does not answer, and LimitNotMet if it
  /// is another board. All arguments must exist longer than the ImageTrial.
  ImageTrial(const RolloutMachine& machine, const RolloutOptions& options, RolloutBook& book,
             registry::MachineLocks& locks, const std::atomic<bool>& stop);
  /// Executes the trial of an image. `own_issued`: RolloutState::issued. The time own_issued distinguishes a
  /// trial of this rollout from a trial of another caller. Throws LockLost if the lock of the machine was
  /// lost. After the lock is lost, ImageTrial does not change the board.
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

/// Result of a check of a machine whose image was confirmed. The check is repeated until it passes, or until
/// options.settle_s have passed. The check passes if the board proves its identity, has confirmed the image,
/// and uses the image.
struct KeptLook {
  std::string why;  // reason why the check does not pass; empty: it passes
  bool away = false;
};
/// Checks a machine whose image was confirmed. Throws LockLost if the lock of the machine was lost.
KeptLook look_at_kept(const RolloutMachine& machine, const RolloutOptions& options,
                      registry::MachineLocks& locks, const std::atomic<bool>& stop);

}  // namespace vernier::fleet
