// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "firmware/core/cycle/programs.h"
#include "firmware/core/cycle/work_budget.h"
#include "firmware/core/link/identity.h"
#include "hal/slot_store.h"
#include "tables/codes.h"
#include "tables/image_view.h"
#include "tables/slots.h"

namespace vernier {

/// Result of a step of an upload: the reason and details of a refusal; `fault` is kNone if there was no
/// error.
struct UploadResult {
  UploadFault fault = UploadFault::kNone;
  ImageFault image = ImageFault::kNone;
  BindFault bind = BindFault::kNone;
  Name offender;  // the name that does not fit
};
/// A line of text without heap memory; longer text is truncated.
struct Line {
  char text[160] = {};
  const char* c_str() const noexcept { return text; }
  operator const char*() const noexcept { return text; }
};
/// Returns one line of text for people: "of another machine: the board has no such axis: W".
Line describe(const UploadResult& result) noexcept;

/// State of the images in the store, for the links.
struct SlotsRecord {
  std::uint64_t confirmed_fingerprint = 0, trial_fingerprint = 0;  // 0: no image
  std::uint64_t issued = 0, newest_issued = 0;  // of the confirmed image, and of all that were ever tried
  std::uint8_t confirmed = kNoSlot, trial = kNoSlot, reserved[2] = {};
  std::uint32_t security = 0;
};
static_assert(sizeof(SlotsRecord) % 8 == 0);

/// Receives, checks, tries, confirms and reverts images. Functions that access the medium may take time and
/// run in a separate context; the next program is passed to Programs. After a power failure at any time, the
/// next boot() finds the correction image that was confirmed before or, if confirm() had returned, the new
/// image.
class Uploader {
 public:
  struct Options {
    TimeUs tick{1000};
    BoardIdentity identity;
    TimeUs trial_time{60'000'000};  // an image on trial is reverted after that
    std::uint32_t places = Programs::kFewest;
    WorkBudget budget{};  // measured_work_budget()
  };
  /// store, wiring, exchange: outlive the uploader. Not real-time safe.
  Uploader(SlotStore& store, const Wiring& wiring, Exchange& exchange, const Options& options);

  // ---- the store
  /// Call boot() once after power-on. boot() reverts a correction image that was on trial, checks the
  /// confirmed image, and starts the confirmed image. The result gives the reason if no image runs. kNone:
  /// also if no image was ever confirmed, and if damaged(); kStore: no record of the store can be read, so
  /// the state is not known. Not real-time safe.
  UploadResult boot();
  /// Starts like boot(), but runs a correction image that the operator gives at the start of the board. This
  /// image is not signed, and the function does not change the medium. Not real-time safe.
  UploadResult boot_with(std::span<const std::uint8_t> image);
  /// Ends an upload: writes the received data to the medium, checks the image and starts its trial.
  /// Not real-time safe.
  UploadResult finish();
  /// Keeps the image on trial. Not real-time safe.
  UploadResult confirm();
  /// Ends the trial of an image; the guardian stops the image in its next round. Not real-time safe.
  UploadResult revert();
  /// Records that a trial is over; true if the record is written. If the record cannot be written, the next
  /// call tries again. Until then a reset gives the same result as the present medium. Not real-time safe.
  bool look_after_store();
  /// Writes the records of the store again after a damage; true if they are written. Call it when an operator
  /// has activated the image that runs. Not real-time safe.
  bool repair();
  /// Reads bytes of the confirmed upload (header and image) from the medium. kNoReading: the offset is beyond
  /// the upload. Not real-time safe.
  HalFault read_confirmed(std::uint32_t offset, std::uint8_t* bytes, std::uint32_t size) noexcept;

  // ---- the links, while the store is not at work for one of them
  /// Begins a new upload of `bytes` bytes; an unfinished upload is dropped. Not real-time safe.
  UploadResult begin(std::uint32_t bytes);
  /// Adds the next piece of the upload. offset: number of bytes before the piece. A repeated last piece is
  /// accepted. Not real-time safe.
  UploadResult add(std::uint32_t offset, const std::uint8_t* bytes, std::uint32_t size);

  // ---- anybody
  /// The store's contents; a trial that is over is not listed, even if the medium does not record the end
  /// yet.
  SlotsRecord record() const noexcept;
  /// True if a confirmed image could not be loaded and no other runs instead.
  bool image_lost() const noexcept { return image_lost_.load(); }
  /// True if boot() found a record that is damaged or missing, until the next record is written: the image
  /// may be one that was replaced.
  bool damaged() const noexcept { return damaged_.load(); }
  /// Returns the remaining time of the trial; 0 without a trial.
  TimeUs trial_left(TimeUs now) const noexcept;
  std::uint32_t capacity() const noexcept { return store_.capacity(); }
  /// Access to the running program and to the trial.
  Programs& programs() noexcept { return programs_; }
  const Programs& programs() const noexcept { return programs_; }
  /// The state of the medium; for the store, and for tests.
  const Slots& slots() const noexcept { return slots_; }

 private:
  /// Origin of an upload. A stored upload has passed the checks of its history when it was confirmed.
  enum class Origin : std::uint8_t { kStored, kNew };
  UploadResult load(std::uint8_t slot, LoadedProgram& loaded, Origin origin);
  UploadResult load_v1(std::uint8_t slot, LoadedProgram& loaded);
  void read_slots();
  UploadResult check_signature(const LoadedProgram& loaded, Origin origin) const;
  UploadResult check_image(LoadedProgram& loaded);
  bool within_budget(const ImageView& view) const noexcept;
  UploadResult write_slot(std::uint8_t slot);
  UploadFault judge_history(const UploadHeader& header) const noexcept;
  bool write(const SlotChange& change);
  bool store(const SlotChange& change);
  void publish() noexcept;

  SlotStore& store_;
  const Wiring& wiring_;
  Options options_;
  Slots slots_;
  Programs programs_;
  std::unique_ptr<ImageWorkspace> workspace_;
  Published<SlotsRecord> published_;
  SlotsRecord record_;
  std::atomic<bool> image_lost_{false}, damaged_{false};
  bool records_lost_ = false;
  // The links', until finish().
  ProgramRef coming_;
  bool receiving_ = false;
  std::uint32_t expected_ = 0, received_ = 0, last_offset_ = 0;
};

}  // namespace vernier
