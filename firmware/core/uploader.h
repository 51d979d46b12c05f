// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <optional>

#include "firmware/core/bound_program.h"
#include "firmware/core/signature.h"
#include "hal/slot_store.h"
#include "tables/codes.h"
#include "tables/image_view.h"
#include "tables/slots.h"

namespace vernier {

/// A refusal with what is known about it; `fault` is kNone where it went well.
struct UploadResult {
  UploadFault fault = UploadFault::kNone;
  ImageFault image = ImageFault::kNone;
  BindFault bind = BindFault::kNone;
  Name offender;  // the name that does not fit
};
/// A line of text in place; what is longer is cut.
struct Line {
  char text[160] = {};
  const char* c_str() const noexcept { return text; }
  operator const char*() const noexcept { return text; }
};
/// One line for people: "of another machine: the board has no such axis: W".
Line describe(const UploadResult& result) noexcept;

/// A place for one image, with what it is bound to and what its header says. The bytes are in memory that was
/// taken when the board was made.
struct LoadedProgram {
  std::unique_ptr<std::uint64_t[]> words;
  ImageView view;
  BoundProgram bound;
  std::uint64_t issued = 0, fingerprint = 0;
  bool taken = false;
};
struct GiveBack {
  void operator()(LoadedProgram* program) const noexcept { program->taken = false; }
};
/// A program in use; its place is free again when this ends.
using ProgramRef = std::unique_ptr<LoadedProgram, GiveBack>;

/// The places for images that a board has. Memory is taken here and never again.
class ProgramPool {
 public:
  /// One runs, one waits to be taken over by the tick, one is being checked; where uploads come quicker than
  /// ticks, two more wait. An upload that finds no place is refused.
  static constexpr std::uint32_t kFewest = 3, kUsual = 5;

  /// image_bytes: the largest image. setup.
  ProgramPool(std::uint32_t places, std::uint32_t image_bytes);
  /// Null where every place is in use. setup.
  ProgramRef take() noexcept;
  std::uint32_t image_bytes() const noexcept { return image_bytes_; }

 private:
  std::uint32_t places_, image_bytes_;
  std::unique_ptr<LoadedProgram[]> programs_;
};

/// Takes images in, checks, tries, keeps or gives them up. Runs outside the tick; what the tick is to run
/// next is collected with take_next(). Whenever the power fails, the next boot() finds the image that was
/// confirmed before or, once confirm() has returned, the new one.
class Uploader {
 public:
  struct Options {
    TimeUs tick{1000};
    std::optional<PublicKey> key;
    TimeUs trial_time{60'000'000};  // an image on trial is given up after that
    std::uint32_t places = ProgramPool::kUsual;
  };
  /// store, wiring: outlive the uploader. setup.
  Uploader(SlotStore& store, const Wiring& wiring, const Options& options);

  /// After power-on: gives up an image that was on trial, checks the confirmed one, and offers it. The result
  /// says why there is none, kNone also where none was ever confirmed. setup.
  UploadResult boot();

  /// A new upload of `bytes` bytes begins; an unfinished one is dropped. setup.
  UploadResult begin(std::uint32_t bytes);
  /// The next piece. offset: bytes before it. A repeated last piece is accepted. setup.
  UploadResult add(std::uint32_t offset, const std::uint8_t* bytes, std::uint32_t size);
  /// Checks what is on the medium and offers it for trial. now: any clock that poll() uses too. setup.
  UploadResult finish(TimeUs now);
  /// Keeps the image on trial. setup.
  UploadResult confirm();
  /// Gives the image on trial up and offers the confirmed one. setup.
  UploadResult revert();
  /// Reverts when the trial time is over; true when it did. setup.
  bool poll(TimeUs now);

  /// The program to be run next, if there is one; an empty one takes all corrections out. setup.
  ProgramRef take_next() noexcept { return std::move(next_); }

  const Slots& slots() const noexcept { return slots_; }
  /// Left of the trial; 0 where none runs.
  TimeUs trial_left(TimeUs now) const noexcept;
  /// Fingerprint of the confirmed image and of the one on trial; 0: none.
  std::uint64_t confirmed_fingerprint() const noexcept { return confirmed_fingerprint_; }
  std::uint64_t trial_fingerprint() const noexcept { return trial_fingerprint_; }
  std::uint32_t capacity() const noexcept { return store_.capacity(); }
  /// Bytes of the confirmed upload (header and image), from the medium. kNoReading beyond it. setup.
  HalFault read_confirmed(std::uint32_t offset, std::uint8_t* bytes, std::uint32_t size) noexcept;

 private:
  UploadResult load(std::uint8_t slot, LoadedProgram& loaded, UploadHeader& header);
  UploadResult check(const UploadHeader& header, LoadedProgram& loaded);
  bool may_replace(const UploadHeader& header) const noexcept;
  bool store(const SlotChange& change);
  void offer_confirmed();

  SlotStore& store_;
  const Wiring& wiring_;
  Options options_;
  Slots slots_;
  ProgramPool pool_;
  std::unique_ptr<ImageWorkspace> workspace_;
  ProgramRef next_;
  bool receiving_ = false, given_up_ = false;
  bool owed_ = false;  // the confirmed image is to be offered as soon as there is a place for it
  std::uint32_t expected_ = 0, received_ = 0, last_offset_ = 0;
  TimeUs trial_began_;
  std::uint64_t confirmed_fingerprint_ = 0, trial_fingerprint_ = 0;
};

}  // namespace vernier
