// SPDX-License-Identifier: Apache-2.0
#include "tables/slots.h"

#include <cstddef>

#include "comp/fixed.h"
#include "tables/checksum.h"

namespace vernier {
namespace {

std::uint32_t checksum_of(const SlotRecord& record) noexcept {
  return crc32c(reinterpret_cast<const std::uint8_t*>(&record), offsetof(SlotRecord, checksum));
}

bool is_slot(std::uint8_t slot) noexcept { return slot < kSlotCount || slot == kNoSlot; }

bool same_state(const SlotRecord& a, SlotRecord b) noexcept {
  b.sequence = a.sequence;
  return checksum_of(a) == checksum_of(b);
}

}  // namespace

SlotRecord upgraded(const SlotRecordV1& record) noexcept {
  const auto* const bytes = reinterpret_cast<const std::uint8_t*>(&record);
  if (record.magic != kSlotMagicV1 || record.checksum != crc32c(bytes, offsetof(SlotRecordV1, checksum)))
    return {};
  const std::uint64_t newest = higher(record.issued, record.trial_issued);
  SlotRecord now{kSlotMagic, record.sequence,  record.issued, record.trial_issued, newest,
                 0,          record.confirmed, record.trial,  record.reserved,     0,
                 0};
  now.checksum = checksum_of(now);
  return now;
}

bool is_valid(const SlotRecord& record) noexcept {
  return record.magic == kSlotMagic && record.reserved == 0 && record.reserved2 == 0 &&
         record.checksum == checksum_of(record) && is_slot(record.confirmed) && is_slot(record.trial) &&
         (record.trial == kNoSlot || record.trial != record.confirmed);
}

Slots Slots::load(const SlotPlace& first, const SlotPlace& second) noexcept {
  Slots slots;
  if (!first.written && !second.written) return slots;
  slots.places_ = StoredPair::kDamaged;
  const ByAge<SlotRecord> found = by_age(first, second);
  if (found.newest == nullptr) return slots;
  slots.now_ = found.newest->record;
  slots.next_place_ = found.second_counts ? 0 : 1;
  const SlotPlace& other = *found.other;
  const bool pair = found.both && slots.now_.sequence == other.record.sequence + 1;
  slots.once_ = !pair || !same_state(slots.now_, other.record);
  if (pair || (!other.written && slots.now_.sequence == 1))
    slots.places_ = StoredPair::kIntact;
  else
    slots.now_.trial = kNoSlot, slots.now_.trial_issued = 0;
  return slots;
}

std::uint8_t Slots::free_slot() const noexcept {
  if (now_.trial != kNoSlot) return kNoSlot;
  return now_.confirmed == 0 ? 1 : 0;
}

SlotChange Slots::change_to(SlotRecord next) const noexcept {
  next.sequence = now_.sequence + 1;
  next.checksum = checksum_of(next);
  return {next_place_, next};
}

SlotChange Slots::start_trial(std::uint64_t issued, std::uint32_t security) const noexcept {
  SlotRecord next = now_;
  next.trial = free_slot();
  next.trial_issued = issued;
  next.newest_issued = higher(issued, now_.newest_issued);
  next.security = higher(security, now_.security);
  return change_to(next);
}

SlotChange Slots::confirm() const noexcept {
  SlotRecord next = now_;
  if (now_.trial != kNoSlot) {
    next.confirmed = now_.trial;
    next.issued = now_.trial_issued;
  }
  next.trial = kNoSlot;
  next.trial_issued = 0;
  return change_to(next);
}

SlotChange Slots::revert() const noexcept {
  SlotRecord next = now_;
  next.trial = kNoSlot;
  next.trial_issued = 0;
  return change_to(next);
}

void Slots::stored(const SlotChange& change) noexcept {
  // The other place has the record before this change, if there was one.
  if (now_.sequence != 0 || places_ == StoredPair::kNothing) places_ = StoredPair::kIntact;
  now_ = change.record;
  next_place_ = 1 - change.place;
}

}  // namespace vernier
