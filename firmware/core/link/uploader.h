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

/// Result of a step of an upload, with the reason and the details of a refusal. `fault` is kNone if there was
/// no error.
struct UploadResult {
  UploadFault fault = UploadFault::kNone;
  ImageFault image = ImageFault::kNone;
  BindFault bind = BindFault::kNone;
  Name offender;  // name of an axis or input that the board does not have
};
/// A line of text without heap memory. Longer text is truncated.
struct Line {
  char text[160] = {};
  const char* c_str() const noexcept { return text; }
  operator const char*() const noexcept { return text; }
};
/// Returns the result of an upload as one line of text for people, for example "the image does not match this
/// board: the board has no axis of this name: W".
Line describe(const UploadResult& result) noexcept;

/// State of the images in the store, for replies to links.
struct SlotsRecord {
  std::uint64_t confirmed_fingerprint = 0, trial_fingerprint = 0;  // a value of 0 means that there is no
                                                                   // image
  std::uint64_t issued = 0, newest_issued = 0;  // issue number of the confirmed image, and the largest issue
                                                // number of all images that were on trial
  std::uint8_t confirmed = kNoSlot, trial = kNoSlot, reserved[2] = {};
  std::uint32_t security = 0;
};
static_assert(sizeof(SlotsRecord) % 8 == 0);

/// Receives, checks, tests, confirms and reverts images. Functions that access the medium (storage) may take
/// time and run in a separate thread. The next program is given to Programs. A power failure may occur at any
/// time. The next boot() then finds the previously confirmed image, or the new image if confirm() had
/// returned.
class Uploader {
 public:
  struct Options {
    TimeUs tick{1000};
    BoardIdentity identity;
    TimeUs trial_time{60'000'000};  // duration of a trial, after which the image is reverted
    std::uint32_t places = Programs::kFewest;
    std::uint32_t dense_cells = 4096;  // memory for the dense form of each program; a program with a larger
                                       // dense form is interpreted; 0: every program is interpreted
    WorkBudget budget{};               // work budget from measured_work_budget()
  };
  /// `store`, `wiring`, `exchange`: must exist longer than the uploader. Not real-time safe.
  Uploader(SlotStore& store, const Wiring& wiring, Exchange& exchange, const Options& options);

  // ---- functions for the store
  /// Starts the board's image: boot() reverts an image that was on trial, checks the confirmed image and
  /// starts the confirmed image. Call boot() once after power-on. If no image runs, the result contains the
  /// reason. The function boot() returns kNone also if no image was ever confirmed, or if damaged() is true.
  /// The function boot() returns kStore if no record of the store can be read, so that the state is unknown.
  /// Not real-time safe.
  UploadResult boot();
  /// Starts the board like boot(), but runs a correction image that the operator gives at the start. An image
  /// that is given at the start is not signed, and the function does not change the medium. Not real-time
  /// safe.
  UploadResult boot_with(std::span<const std::uint8_t> image);
  /// Ends an upload: writes the received data to the medium, checks the image and starts its trial.
  /// Not real-time safe.
  UploadResult finish();
  /// Confirms the image on trial. Not real-time safe.
  UploadResult confirm();
  /// Ends the trial of an image. The guardian stops the image in its next call. Not real-time safe.
  UploadResult revert();
  /// Records on the medium that a trial is over. Returns true if the record is written. If the
  /// record that the trial is over cannot be written, the next call tries again. Until the record
  /// is written, a reset of the board gives the same result as the present content of the medium.
  /// Not real-time safe.
  bool look_after_store();
  /// Writes the records of the store again after damage. Returns true if the records of the store
  /// are written. Call repair() when an operator has activated the running image. Not real-time
  /// safe.
  bool repair();
  /// Reads bytes of the confirmed upload (its header and image) from the medium. The function
  /// read_confirmed() returns kNoReading if the offset is beyond the end of the upload. Not real-time safe.
  HalFault read_confirmed(std::uint32_t offset, std::uint8_t* bytes, std::uint32_t size) noexcept;

  // ---- functions for the links, while the store executes no request of a link
  /// Begins a new upload of `bytes` bytes. An unfinished upload is removed. Not real-time safe.
  UploadResult begin(std::uint32_t bytes);
  /// Adds the next part of an upload. `offset`: number of bytes of the upload before the part that is added.
  /// If the last part of an upload is sent again, it is accepted. Not real-time safe.
  UploadResult add(std::uint32_t offset, const std::uint8_t* bytes, std::uint32_t size);

  // ---- functions for all threads
  /// Returns the content of the store. A trial that is over is not listed, even if its end is not yet
  /// recorded on the medium.
  SlotsRecord record() const noexcept;
  /// True if a confirmed image could not be loaded and no other image runs instead.
  bool image_lost() const noexcept { return image_lost_.load(); }
  /// True if boot() found a damaged or missing record. If the store has a damaged record, the running image
  /// may be an older image. The flag is cleared when the next record is written.
  bool damaged() const noexcept { return damaged_.load(); }
  /// Returns the remaining time of the trial; 0 if no image is on trial.
  TimeUs trial_left(TimeUs now) const noexcept;
  std::uint32_t capacity() const noexcept { return store_.capacity(); }
  /// Returns the object with the running program and the trial.
  Programs& programs() noexcept { return programs_; }
  const Programs& programs() const noexcept { return programs_; }
  /// Returns the state of the medium, for the store and for tests.
  const Slots& slots() const noexcept { return slots_; }

 private:
  /// Origin of an uploaded image. A stored image passed the checks of its history when it was confirmed. The
  /// checks of an image's history, which were made when the image was confirmed, are not repeated.
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
  // Members that the links use until finish() is called.
  ProgramRef coming_;
  bool receiving_ = false;
  std::uint32_t expected_ = 0, received_ = 0, last_offset_ = 0;
};

}  // namespace vernier
