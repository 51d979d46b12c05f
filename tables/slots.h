// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>

namespace vernier {

/// No slot: nothing confirmed yet, or no trial.
constexpr std::uint8_t kNoSlot = 0xff;
constexpr std::uint32_t kSlotCount = 2;
/// The store keeps the record twice; a change overwrites the older one.
constexpr std::uint32_t kSlotRecordCount = 2;

/// Which slot of a board's image store counts. Little-endian, 32 bytes, as stored.
struct SlotRecord {
  std::uint32_t magic;     // kSlotMagic
  std::uint32_t sequence;  // of the change that wrote it, from 1; the higher of two valid records counts
  std::uint64_t issued;    // when the confirmed image was signed (upload_format.h); 0: none confirmed
  std::uint64_t trial_issued;
  std::uint8_t confirmed;  // slot, or kNoSlot
  std::uint8_t trial;      // slot that is on trial, or kNoSlot
  std::uint16_t reserved;  // 0
  std::uint32_t checksum;  // CRC-32C of the bytes before it
};
static_assert(sizeof(SlotRecord) == 32);
static_assert(offsetof(SlotRecord, magic) == 0 && offsetof(SlotRecord, sequence) == 4 &&
              offsetof(SlotRecord, issued) == 8 && offsetof(SlotRecord, trial_issued) == 16 &&
              offsetof(SlotRecord, confirmed) == 24 && offsetof(SlotRecord, trial) == 25 &&
              offsetof(SlotRecord, reserved) == 26 && offsetof(SlotRecord, checksum) == 28);
/// Not stored: another layout takes another kSlotMagic and another number here.
constexpr std::uint32_t kSlotRecordVersion = 1;
constexpr std::uint32_t kSlotMagic = 0x544f4c53;  // "SLOT"

/// A record and the place, 0 or 1, where it is to be stored.
struct SlotChange {
  std::uint32_t place;
  SlotRecord record;
};

/// What the two slots hold, as a pure state machine: it names the record to be stored for a change and takes
/// the change over only when told that it is stored. A power cut at any byte of any write therefore leaves
/// the state before the change or the one after it.
///
///   confirmed A ── (image written to B) ── try ──► confirmed A, trial B ── confirm ──► confirmed B
///                                                          └──── revert, or a reset ──► confirmed A
class Slots {
 public:
  /// The newer valid one of two records; nothing confirmed where neither is valid. setup.
  static Slots load(const SlotRecord& first, const SlotRecord& second) noexcept;

  std::uint8_t confirmed() const noexcept { return now_.confirmed; }
  std::uint8_t trial() const noexcept { return now_.trial; }
  /// Signing time of the confirmed image; 0 where there is none.
  std::uint64_t issued() const noexcept { return now_.issued; }
  std::uint64_t trial_issued() const noexcept { return now_.trial_issued; }
  /// The slot that may be overwritten: neither confirmed nor on trial; kNoSlot while a trial runs.
  std::uint8_t free_slot() const noexcept;

  /// The image in free_slot() is to be tried. Only while no trial runs. setup.
  SlotChange start_trial(std::uint64_t issued) const noexcept;
  /// The image on trial is kept. Only while one is on trial. setup.
  SlotChange confirm() const noexcept;
  /// The image on trial is given up. setup.
  SlotChange revert() const noexcept;
  /// The change is on the medium. setup.
  void stored(const SlotChange& change) noexcept;

 private:
  SlotChange change_to(SlotRecord next) const noexcept;

  SlotRecord now_{kSlotMagic, 0, 0, 0, kNoSlot, kNoSlot, 0, 0};
  std::uint32_t next_place_ = 0;
};

/// Is it a record that a board may follow: magic, checksum, slots that exist and differ. setup.
bool is_valid(const SlotRecord& record) noexcept;

}  // namespace vernier
