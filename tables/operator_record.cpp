// SPDX-License-Identifier: Apache-2.0
#include "tables/operator_record.h"

#include "tables/checksum.h"

namespace vernier {
namespace {

std::uint32_t sum_of(const OperatorRecord& record) noexcept {
  return crc32c(reinterpret_cast<const std::uint8_t*>(&record), offsetof(OperatorRecord, checksum));
}

}  // namespace

std::uint32_t operator_axis(const char* name, std::uint32_t size) noexcept {
  const std::uint32_t sum = crc32c(reinterpret_cast<const std::uint8_t*>(name), size);
  return sum != 0 ? sum : 1;
}

bool is_valid(const OperatorRecord& record) noexcept {
  return record.magic == kOperatorMagic && record.sequence != 0 && record.checksum == sum_of(record);
}

OperatorRecords OperatorRecords::load(const OperatorRecord& first, const OperatorRecord& second) noexcept {
  OperatorRecords records;
  const bool one = is_valid(first), two = is_valid(second);
  if (!one && !two) return records;
  // The sequences of one store differ by one; the unsigned distance stays correct when they wrap.
  const bool second_counts = two && (!one || second.sequence - first.sequence < UINT32_MAX / 2);
  records.now_ = second_counts ? second : first;
  records.next_place_ = second_counts ? kOperatorPlace : kOperatorPlace + 1;
  return records;
}

OperatorChange OperatorRecords::change_to(const OperatorState& state) const noexcept {
  OperatorRecord next{kOperatorMagic, now_.sequence + 1, state, 0};
  if (next.sequence == 0) next.sequence = 1;  // 0 means: no record
  next.checksum = sum_of(next);
  return {next_place_, next};
}

void OperatorRecords::stored(const OperatorChange& change) noexcept {
  now_ = change.record;
  next_place_ = 2 * kOperatorPlace + 1 - change.place;
}

}  // namespace vernier
