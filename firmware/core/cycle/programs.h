// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <atomic>
#include <cstdint>
#include <memory>

#include "firmware/core/cycle/exchange.h"
#include "tables/image_view.h"
#include "tables/upload_format.h"

namespace vernier {

/// Memory for one upload: header, image, and bound program. The bytes are in memory that is allocated at the
/// construction of the board.
struct LoadedProgram {
  UploadHeader header{};
  std::unique_ptr<std::uint64_t[]> words;
  ImageView view;
  BoundProgram bound;                    // the tick's, and the guardian's before and after
  std::uint32_t axis[kMaxAxes] = {};     // board's axis for each of the image
  std::atomic<std::uint32_t> number{0};  // of the take-over by the tick; 0: never
  TimeUs trial_time;                     // of a trial
  std::atomic<bool> taken{false};

  std::uint8_t* image() noexcept { return reinterpret_cast<std::uint8_t*>(words.get()); }
  /// Binds the program again from its image; all state of its execution is new. Not real-time safe.
  void start_anew() noexcept;
};
struct GiveBack {
  void operator()(LoadedProgram* program) const noexcept {
    program->taken.store(false, std::memory_order_release);
  }
};
/// A LoadedProgram in use; its memory becomes free when this object is destroyed.
using ProgramRef = std::unique_ptr<LoadedProgram, GiveBack>;

/// State of the trial of an image. The comment of each state names the part of the firmware that may end the
/// state.
enum class Trial : std::uint8_t {
  kNone,        // the store, by run_trial()
  kRunning,     // the guardian when its time is over; the store when it is to be kept
  kConfirming,  // the store: it is being written down that the image is kept, however long that takes
  kKept,        // the guardian: it now goes back to this one
  kOver,        // the store, when the record says that the image was reverted
};

/// The programs of a board: the running program, and the program to which the board returns. Three parts of
/// the firmware use Programs; none of them waits for another:
///   the store checks images and starts them or their trial;
///   the guardian hands programs to the tick and ends trials on time, from memory alone;
///   the links read the running program.
class Programs {
 public:
  /// Three places: the running program, the program to which the board returns, and a program that is being
  /// received.
  static constexpr std::uint32_t kFewest = 3;

  /// exchange: outlives this object; image_bytes: size of the largest image. Takes memory for all places.
  /// Not real-time safe.
  Programs(Exchange& exchange, std::uint32_t places, std::uint32_t image_bytes);

  // ---- the store
  /// Null if every place is in use.
  ProgramRef take() noexcept;
  std::uint32_t image_bytes() const noexcept { return image_bytes_; }
  /// Passes the confirmed image to the tick when the board starts.
  void run_confirmed(ProgramRef program) noexcept;
  /// Starts the trial of an image. The trial ends at the time trial_time after the guardian passes the
  /// program to the tick. Call run_trial() only in Trial::kNone.
  void run_trial(ProgramRef program, TimeUs trial_time) noexcept;
  /// Begins to confirm the image on trial: the trial time stops. False if no image is on trial any more.
  bool begin_to_keep() noexcept { return change(Trial::kRunning, Trial::kConfirming); }
  /// Ends a confirmation. written: true if the medium has the record that the correction image is confirmed,
  /// false if the record could not be written. Call kept() only after begin_to_keep().
  void kept(bool written) noexcept { trial_.store(written ? Trial::kKept : Trial::kRunning); }
  /// The image on trial is reverted with the guardian's next round.
  bool give_up() noexcept;
  /// True if give_up() was called and is not executed yet.
  bool giving_up() const noexcept { return to_give_up_.load() && trial_.load() == Trial::kRunning; }
  /// The revert of the last trial is recorded. Only in Trial::kOver.
  void given_up() noexcept { trial_.store(Trial::kNone); }

  // ---- the guardian
  /// Hands the next program to the tick and ends a trial whose time is over. now: time of the clock of
  /// run_trial(). guard() never waits.
  void guard(TimeUs now) noexcept;

  // ---- the links
  /// Returns the running program, null before the first program. The program is not removed until
  /// look_away(). Only one caller at a time may use look().
  const LoadedProgram* look() noexcept;
  void look_away() noexcept { looked_at_.store(nullptr); }

  Trial trial() const noexcept { return trial_.load(); }
  /// Returns the remaining time of the trial; `whole` if the trial has not begun.
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
  std::unique_ptr<bool[]> owned_;  // by the guardian
  std::atomic<Trial> trial_{Trial::kNone};
  std::atomic<bool> to_give_up_{false};
  std::atomic<LoadedProgram*> confirmed_in_{nullptr}, trial_in_{nullptr};
  std::atomic<const LoadedProgram*> seen_{nullptr}, looked_at_{nullptr};
  std::uint32_t taken_over_ = 0;
  SharedCount until_us_;  // of the trial; 0: no trial. Used by the guardian
  // Pointers that the guardian uses. Several of these pointers can point to the same program.
  LoadedProgram *running_ = nullptr, *offered_ = nullptr, *wanted_ = nullptr, *kept_ = nullptr,
                *tried_ = nullptr;
  LoadedProgram empty_[2];  // removes all corrections if no image can be restored
};

}  // namespace vernier
