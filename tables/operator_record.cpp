// SPDX-License-Identifier: Apache-2.0
#include "tables/operator_record.h"

#include "tables/checksum.h"

namespace vernier {
namespace {

std::uint32_t sum_of(const OperatorRecord& record) noexcept {
  return crc32c(reinterpret_cast<const std::uint8_t*>(&record), offsetof(OperatorRecord, checksum));
}

// 0 means: no record.
std::uint32_t sequence_after(std::uint32_t sequence) noexcept {
  return sequence == UINT32_MAX ? 1 : sequence + 1;
}

}  // namespace

std::uint32_t operator_axis(const char* name, std::uint32_t size) noexcept {
  const std::uint32_t sum = crc32c(reinterpret_cast<const std::uint8_t*>(name), size);
  return sum != 0 ? sum : 1;
}

bool is_valid(const OperatorRecord& record) noexcept {
  return record.magic == kOperatorMagic && record.sequence != 0 && record.checksum == sum_of(record);
}

OperatorRecords OperatorRecords::load(const OperatorPlace& first, const OperatorPlace& second) noexcept {
  OperatorRecords records;
  if (!first.written && !second.written) return records;
  records.places_ = StoredPair::kDamaged;
  const ByAge<OperatorRecord> found = by_age(first, second);
  if (found.newest == nullptr) return records;
  records.now_ = found.newest->record;
  records.next_place_ = found.second_counts ? kOperatorPlace : kOperatorPlace + 1;
  const OperatorRecord& other = found.other->record;
  if (found.both && records.now_.sequence == sequence_after(other.sequence))
    records.places_ = StoredPair::kIntact;
  records.once_ = !(found.both && records.now_.state == other.state);
  return records;
}

OperatorChange OperatorRecords::change_to(const OperatorState& state) const noexcept {
  OperatorRecord next{kOperatorMagic, sequence_after(now_.sequence), state, 0};
  next.checksum = sum_of(next);
  return {next_place_, next};
}

void OperatorRecords::stored(const OperatorChange& change) noexcept {
  // The other place has the record before this change, if there was one.
  places_ = known() ? StoredPair::kIntact : StoredPair::kDamaged;
  now_ = change.record;
  next_place_ = 2 * kOperatorPlace + 1 - change.place;
}

}  // namespace vernier
