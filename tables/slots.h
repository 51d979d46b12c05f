// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>

#include "tables/stored_place.h"

namespace vernier {

/// Value for "no slot": there is no confirmed image, or no image on trial.
constexpr std::uint8_t kNoSlot = 0xff;
constexpr std::uint32_t kSlotCount = 2;
/// Number of copies of the record in the store. A change overwrites the older copy of the slot
/// record first, and then the other copy.
constexpr std::uint32_t kSlotRecordCount = 2;

/// Record of the two image slots of a board: the confirmed slot and the slot on trial. The record is
/// little-endian and has 48 bytes.
struct SlotRecord {
  std::uint32_t magic;     // kSlotMagic
  std::uint32_t sequence;  // number of the change that wrote the record, from 1; the valid record with the
                           // higher number is used
  std::uint64_t issued;    // signing time of the confirmed image (upload_format.h); 0: there is no confirmed
                           // image
  std::uint64_t trial_issued;
  std::uint64_t newest_issued;  // latest signing time of all images that were ever on trial; an image that is
                                // not newer is refused
  std::uint32_t security;       // highest security number of all images that were ever on trial
  std::uint8_t confirmed;       // index of the confirmed slot, or kNoSlot
  std::uint8_t trial;           // index of the slot on trial, or kNoSlot
  std::uint16_t reserved;       // 0
  std::uint32_t reserved2;      // 0
  std::uint32_t checksum;       // CRC-32C of all previous bytes
};
static_assert(sizeof(SlotRecord) == 48);
static_assert(offsetof(SlotRecord, magic) == 0 && offsetof(SlotRecord, sequence) == 4 &&
              offsetof(SlotRecord, issued) == 8 && offsetof(SlotRecord, trial_issued) == 16 &&
              offsetof(SlotRecord, newest_issued) == 24 && offsetof(SlotRecord, security) == 32 &&
              offsetof(SlotRecord, confirmed) == 36 && offsetof(SlotRecord, trial) == 37 &&
              offsetof(SlotRecord, reserved) == 38 && offsetof(SlotRecord, reserved2) == 40 &&
              offsetof(SlotRecord, checksum) == 44);
/// Version of this record layout. The version is not stored. A new layout requires a new kSlotMagic and a new
/// number here.
constexpr std::uint32_t kSlotRecordVersion = 2;
constexpr std::uint32_t kSlotMagic = 0x324f4c53;  // "SLO2"

/// Record of version 1, which an old store can contain.
struct SlotRecordV1 {
  std::uint32_t magic;  // kSlotMagicV1
  std::uint32_t sequence;
  std::uint64_t issued, trial_issued;
  std::uint8_t confirmed, trial;
  std::uint16_t reserved;
  std::uint32_t checksum;
};
static_assert(sizeof(SlotRecordV1) == 32);
static_assert(offsetof(SlotRecordV1, magic) == 0 && offsetof(SlotRecordV1, sequence) == 4 &&
              offsetof(SlotRecordV1, issued) == 8 && offsetof(SlotRecordV1, trial_issued) == 16 &&
              offsetof(SlotRecordV1, confirmed) == 24 && offsetof(SlotRecordV1, trial) == 25 &&
              offsetof(SlotRecordV1, reserved) == 26 && offsetof(SlotRecordV1, checksum) == 28);
constexpr std::uint32_t kSlotMagicV1 = 0x544f4c53;  // "SLOT"

using SlotPlace = StoredPlace<SlotRecord>;

/// A slot record, and the number of the place (0 or 1) in the slot store to which the record must
/// be written.
struct SlotChange {
  std::uint32_t place;
  SlotRecord record;
};

/// State machine of the two slots, without access to the medium. The class Slots returns the record
/// that must be stored for a change of the slots. The class Slots applies a change of the slots
/// only after the record of the change is stored. The stored records are intact if both are valid
/// and differ by one change, or if there is only the first record. After a power failure at any
/// byte of any write, the state is the state before or after the change. If the pair of records is
/// damaged, it is the state before the change.
///
///   confirmed A ── (image written to B) ── try ──► confirmed A, trial B ── confirm ──► confirmed B
///                                                          └──── revert, or a reset ──► confirmed A
class Slots {
 public:
  /// Loads the newer of the two valid records. If there is no valid record, there is no confirmed image. A
  /// damaged pair of records has no trial, because a reset of the board ends the trial. Not real-time safe.
  static Slots load(const SlotPlace& first, const SlotPlace& second) noexcept;
  /// Returns the state of the places after load() and the changes that were stored since. A damaged pair of
  /// records is intact again after at most two changes.
  StoredPair places() const noexcept { return places_; }
  /// True if load() found the state in only one of the two records.
  bool once() const noexcept { return once_; }

  std::uint8_t confirmed() const noexcept { return now_.confirmed; }
  std::uint8_t trial() const noexcept { return now_.trial; }
  /// Returns the signing time of the confirmed image; 0 if there is no confirmed image.
  std::uint64_t issued() const noexcept { return now_.issued; }
  std::uint64_t trial_issued() const noexcept { return now_.trial_issued; }
  /// Limits for a new upload: its signing time must be later than newest_issued(), and its security number
  /// must be at least security(). Both limits are the highest values of all images that the board has run on
  /// trial.
  std::uint64_t newest_issued() const noexcept { return now_.newest_issued; }
  std::uint32_t security() const noexcept { return now_.security; }
  /// Returns the slot that may be overwritten, which is neither confirmed nor on trial; kNoSlot while an
  /// image is on trial.
  std::uint8_t free_slot() const noexcept;

  /// Returns the change that starts the trial of the image in free_slot(). Call start_trial() only if no
  /// image is on trial. Not real-time safe.
  SlotChange start_trial(std::uint64_t issued, std::uint32_t security) const noexcept;
  /// Returns the change that confirms the image on trial. Call confirm() only while an image is on trial. Not
  /// real-time safe.
  SlotChange confirm() const noexcept;
  /// Returns the record that must be written to revert the image on trial. Not real-time safe.
  SlotChange revert() const noexcept;
  /// Returns the record that writes the present state of the slots once more, to the other place of
  /// the store. Not real-time safe.
  SlotChange again() const noexcept { return change_to(now_); }
  /// Informs the object that a changed slot record is now on the medium. Not real-time safe.
  void stored(const SlotChange& change) noexcept;

 private:
  SlotChange change_to(SlotRecord next) const noexcept;

  SlotRecord now_{kSlotMagic, 0, 0, 0, 0, 0, kNoSlot, kNoSlot, 0, 0, 0};
  std::uint32_t next_place_ = 0;
  StoredPair places_ = StoredPair::kNothing;
  bool once_ = false;
};

/// Converts a valid record of version 1 to the present version. For an invalid record, the result contains no
/// record. Not real-time safe.
SlotRecord upgraded(const SlotRecordV1& record) noexcept;
/// True if a board may use the record: magic and checksum are valid, and the slots exist and are different.
/// Not real-time safe.
bool is_valid(const SlotRecord& record) noexcept;

}  // namespace vernier
