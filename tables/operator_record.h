// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>

#include "comp/equation.h"
#include "tables/stored_place.h"

namespace vernier {

/// The last settings of an operator, and the latched fault of a board. A start of the board
/// restores the operator's settings and the latched fault.
struct OperatorState {
  std::uint8_t out = 0;      // 1: an operator deactivated the correction
  std::uint8_t holding = 0;  // 1: an operator held the corrections
  std::uint8_t fault = 0;    // latched fault
  std::uint8_t reserved = 0;
  /// Operator_axis() of the name of each axis of the board; 0: there is no axis
  std::uint32_t axis[kMaxAxes] = {};
  std::int32_t weight[kMaxAxes] = {};  // weight of the axis, Q16

  friend bool operator==(const OperatorState&, const OperatorState&) = default;
};
static_assert(sizeof(OperatorState) == 68);

/// Stored record of the operator's settings. The record is little-endian and has 80 bytes.
struct OperatorRecord {
  std::uint32_t magic;     // kOperatorMagic
  std::uint32_t sequence;  // number of the change that wrote the record, from 1; the valid record with the
                           // higher number is used
  OperatorState state;
  std::uint32_t checksum;  // CRC-32C of all previous bytes
};
static_assert(sizeof(OperatorRecord) == 80);
static_assert(offsetof(OperatorRecord, magic) == 0 && offsetof(OperatorRecord, sequence) == 4 &&
              offsetof(OperatorRecord, state) == 8 && offsetof(OperatorState, out) == 0 &&
              offsetof(OperatorState, holding) == 1 && offsetof(OperatorState, fault) == 2 &&
              offsetof(OperatorState, axis) == 4 && offsetof(OperatorState, weight) == 36 &&
              offsetof(OperatorRecord, checksum) == 76);
/// Version of this record layout. The version is not stored. A new layout requires a new kOperatorMagic and a
/// new number here.
constexpr std::uint32_t kOperatorRecordVersion = 1;
constexpr std::uint32_t kOperatorMagic = 0x3152504f;  // "OPR1"
/// Indices of the two records in the store; the indices 0 and 1 are the slot records.
constexpr std::uint32_t kOperatorPlace = 2, kOperatorRecordCount = 2;

/// Returns the number of an axis in a record, computed from its name. A board file with another order of axes
/// therefore keeps the weight of each axis. The number of an axis is never 0. Not real-time safe.
std::uint32_t operator_axis(const char* name, std::uint32_t size) noexcept;

/// A record of the operator's settings, and the number of the place in the slot store to which the
/// record must be written.
struct OperatorChange {
  std::uint32_t place;
  OperatorRecord record;
};

using OperatorPlace = StoredPlace<OperatorRecord>;

/// The two stored records of the operator's settings, without access to the medium. A change overwrites the
/// older record, and the board writes each setting to both places. The pair of records is intact if both are
/// valid and differ by at most one change. After a power failure at any byte of a write, the pair either is
/// intact with the state before or after the change, or is damaged.
class OperatorRecords {
 public:
  /// Loads the newer of the two valid records. Not real-time safe.
  static OperatorRecords load(const OperatorPlace& first, const OperatorPlace& second) noexcept;
  /// Returns the state of the places after load() and the changes that were stored since. A damaged pair of
  /// records is intact again after at most two changes.
  StoredPair places() const noexcept { return places_; }
  /// True if a record is stored. If no record is stored, state() returns the default state (no setting of an
  /// operator).
  bool known() const noexcept { return now_.sequence != 0; }
  const OperatorState& state() const noexcept { return now_.state; }
  /// True if load() found the state in only one of the two records. If only one record has the
  /// state, the second write was not done, or the first write is not yet on the medium.
  bool once() const noexcept { return once_; }
  /// Returns the record that must be written to store another state of the operator's settings. Not
  /// real-time safe.
  OperatorChange change_to(const OperatorState& state) const noexcept;
  /// Informs the object that a changed record is now on the medium. Not real-time safe.
  void stored(const OperatorChange& change) noexcept;

 private:
  OperatorRecord now_{kOperatorMagic, 0, {}, 0};
  std::uint32_t next_place_ = kOperatorPlace;
  StoredPair places_ = StoredPair::kNothing;
  bool once_ = false;
};

/// True if a board may use the record: magic, checksum and sequence are valid. Not real-time safe.
bool is_valid(const OperatorRecord& record) noexcept;

}  // namespace vernier
