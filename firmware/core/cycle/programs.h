// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <atomic>
#include <cstdint>
#include <memory>

#include "firmware/core/cycle/exchange.h"
#include "tables/image_view.h"
#include "tables/upload_format.h"

namespace vernier {

/// Memory for one uploaded image: its header, the image, and the bound program with its dense form. The
/// memory for the bytes and for the dense form is allocated when the board is constructed.
struct LoadedProgram {
  UploadHeader header{};
  std::unique_ptr<std::uint64_t[]> words;
  ImageView view;
  DenseStore dense;
  BoundProgram bound;                 // used by the tick while the program runs, and by the guardian
                                      // before and after
  std::uint32_t axis[kMaxAxes] = {};  // for each axis of the image: index of the board's axis
  /// Number that the program received when the tick started it; 0: the tick never used it
  std::atomic<std::uint32_t> number{0};
  TimeUs trial_time;  // duration of a trial
  std::atomic<bool> taken{false};

  std::uint8_t* image() noexcept { return reinterpret_cast<std::uint8_t*>(words.get()); }
  /// Binds the program again from its image. The execution of the program that is bound again
  /// starts from its initial state. Not real-time safe.
  void start_anew() noexcept;
};
struct GiveBack {
  void operator()(LoadedProgram* program) const noexcept {
    program->taken.store(false, std::memory_order_release);
  }
};
/// A LoadedProgram in use; its memory becomes free when this object is destroyed.
using ProgramRef = std::unique_ptr<LoadedProgram, GiveBack>;

/// State of the trial of an image on the board. The comment of each state names the part of the firmware that
/// may end this state.
enum class Trial : std::uint8_t {
  kNone,        // ended by the store, with run_trial()
  kRunning,     // ended by the guardian when the trial time is over; by the store when the image is confirmed
  kConfirming,  // ended by the store, after the record of the confirmation is written; there is no time limit
  kKept,        // ended by the guardian, for which this image becomes the image to return to
  kOver,        // ended by the store, when the record of the revert is written
};

/// The programs of a board: the running program, and the program to which the board returns after a failed
/// trial. Three parts of the firmware use Programs, and none of them waits for another part:
///   the store checks images and starts an image or its trial;
///   the guardian gives programs to the tick and ends trials on time, without access to the medium;
///   the links read the running program.
class Programs {
 public:
  /// Smallest number of program memories: for the running program, for the program to which the board
  /// returns, and for a program that is being received.
  static constexpr std::uint32_t kFewest = 3;

  /// `exchange`: must exist longer than this object; `image_bytes`: size of the largest image;
  /// `dense_cells`: size of the largest dense form, 0: every program is interpreted. The
  /// constructor allocates the memory of all programs. Not real-time safe.
  Programs(Exchange& exchange, std::uint32_t places, std::uint32_t image_bytes, std::uint32_t dense_cells);

  // ---- functions for the store
  /// Returns a free program memory; null if every memory is in use.
  ProgramRef take() noexcept;
  std::uint32_t image_bytes() const noexcept { return image_bytes_; }
  /// Gives the confirmed image to the tick when the board starts.
  void run_confirmed(ProgramRef program) noexcept;
  /// Starts the trial of an image. The trial ends when `trial_time` has passed since the guardian gave the
  /// program to the tick. Call run_trial() only in the state Trial::kNone.
  void run_trial(ProgramRef program, TimeUs trial_time) noexcept;
  /// Begins the confirmation of the image on trial and stops the trial time. The function begin_to_keep()
  /// returns true if it began the confirmation. If no image is on trial any more, begin_to_keep() changes
  /// nothing and returns false.
  bool begin_to_keep() noexcept { return change(Trial::kRunning, Trial::kConfirming); }
  /// Ends the confirmation of an image. `written`: true if the medium contains the record that the correction
  /// image is confirmed; false if the record could not be written. Call kept() only after begin_to_keep().
  void kept(bool written) noexcept { trial_.store(written ? Trial::kKept : Trial::kRunning); }
  /// Requests that the guardian reverts the image on trial in its next call.
  bool give_up() noexcept;
  /// True if give_up() was called and the guardian has not yet executed it.
  bool giving_up() const noexcept { return to_give_up_.load() && trial_.load() == Trial::kRunning; }
  /// States that the revert of the last trial is recorded on the medium. Call given_up() only in the state
  /// Trial::kOver.
  void given_up() noexcept { trial_.store(Trial::kNone); }

  // ---- functions for the guardian
  /// Gives the next program to the tick, and ends a trial whose time is over. `now`: time of the clock that
  /// run_trial() uses. The function guard() never waits.
  void guard(TimeUs now) noexcept;

  // ---- functions for the links
  /// Returns the running program; null before the first program. The program is not freed until look_away()
  /// is called. Only one thread at a time may call look().
  const LoadedProgram* look() noexcept;
  void look_away() noexcept { looked_at_.store(nullptr); }

  Trial trial() const noexcept { return trial_.load(); }
  /// Returns the remaining time of the trial; the time `whole` if the trial has not begun.
  TimeUs trial_left(TimeUs now, TimeUs whole) const noexcept;

 private:
  bool change(Trial from, Trial to) noexcept { return trial_.compare_exchange_strong(from, to); }
  void own(LoadedProgram* program) noexcept;
  void collect() noexcept;
  void end_trial(TimeUs now) noexcept;
  void go_back() noexcept;
  void offer() noexcept;
  void free_unused() noexcept;
  LoadedProgram* other_empty() noexcept { return running_ == &empty_[0] ? &empty_[1] : &empty_[0]; }

  Exchange& exchange_;
  std::uint32_t places_, image_bytes_;
  std::unique_ptr<LoadedProgram[]> programs_;
  std::unique_ptr<bool[]> owned_;  // flags of the programs that the guardian owns
  std::atomic<Trial> trial_{Trial::kNone};
  std::atomic<bool> to_give_up_{false};
  std::atomic<LoadedProgram*> confirmed_in_{nullptr}, trial_in_{nullptr};
  std::atomic<const LoadedProgram*> seen_{nullptr}, looked_at_{nullptr};
  std::uint32_t taken_over_ = 0;
  SharedCount until_us_;  // end of the trial; 0: no trial. Used by the guardian
  // Pointers to programs that only the guardian uses. Several of these pointers can point to the same
  // program.
  LoadedProgram *running_ = nullptr, *offered_ = nullptr, *wanted_ = nullptr, *kept_ = nullptr,
                *tried_ = nullptr;
  LoadedProgram empty_[2];  // program that removes all corrections if no image can be restored
};

}  // namespace vernier
