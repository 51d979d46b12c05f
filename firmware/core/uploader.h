// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "firmware/core/bound_program.h"
#include "firmware/core/image_file.h"
#include "firmware/core/signature.h"
#include "hal/slot_store.h"
#include "tables/codes.h"
#include "tables/slots.h"

namespace vernier {

/// A refusal with what is known about it; `fault` is kNone where it went well.
struct UploadResult {
  UploadFault fault = UploadFault::kNone;
  ImageFault image = ImageFault::kNone;
  BindFault bind = BindFault::kNone;
  std::string offender;  // the name that does not fit
};
/// One line for people: "foreign machine: the board has no such axis: W".
std::string describe(const UploadResult& result);

/// An image, what it is bound to, and what its header says.
struct LoadedProgram {
  ImageFile image;
  std::unique_ptr<BoundProgram> bound;
  std::uint64_t issued = 0, fingerprint = 0;
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
  std::unique_ptr<LoadedProgram> take_next() { return std::move(next_); }

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
  UploadResult load(std::uint8_t slot, LoadedProgram& loaded);
  UploadResult check(const std::vector<std::uint8_t>& upload, LoadedProgram& loaded) const;
  bool may_replace(const UploadHeader& header) const noexcept;
  bool store(const SlotChange& change);
  void offer_confirmed();

  SlotStore& store_;
  const Wiring& wiring_;
  Options options_;
  Slots slots_;
  std::unique_ptr<LoadedProgram> next_;
  bool receiving_ = false, given_up_ = false;
  std::uint32_t expected_ = 0, received_ = 0, last_offset_ = 0;
  TimeUs trial_began_;
  std::uint64_t confirmed_fingerprint_ = 0, trial_fingerprint_ = 0;
};

}  // namespace vernier
