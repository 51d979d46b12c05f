// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>

#include "comp/equation.h"
#include "tables/stored_place.h"

namespace vernier {

/// The last settings of an operator, and the latched fault of a board: a start restores them.
struct OperatorState {
  std::uint8_t out = 0;      // 1: the correction was deactivated
  std::uint8_t holding = 0;  // 1: the corrections were held
  std::uint8_t fault = 0;    // Fault that is latched
  std::uint8_t reserved = 0;
  std::uint32_t axis[kMaxAxes] = {};   // operator_axis() of the name of each axis of the board; 0: no axis
  std::int32_t weight[kMaxAxes] = {};  // of that axis, Q16

  friend bool operator==(const OperatorState&, const OperatorState&) = default;
};
static_assert(sizeof(OperatorState) == 68);

/// Record of the operator's state. Little-endian, 80 bytes, as stored.
struct OperatorRecord {
  std::uint32_t magic;     // kOperatorMagic
  std::uint32_t sequence;  // of the change that wrote it, from 1; the higher of two valid records counts
  OperatorState state;
  std::uint32_t checksum;  // CRC-32C of the bytes before it
};
static_assert(sizeof(OperatorRecord) == 80);
static_assert(offsetof(OperatorRecord, magic) == 0 && offsetof(OperatorRecord, sequence) == 4 &&
              offsetof(OperatorRecord, state) == 8 && offsetof(OperatorState, out) == 0 &&
              offsetof(OperatorState, holding) == 1 && offsetof(OperatorState, fault) == 2 &&
              offsetof(OperatorState, axis) == 4 && offsetof(OperatorState, weight) == 36 &&
              offsetof(OperatorRecord, checksum) == 76);
/// Version of the record; the version is not stored. A new layout requires a new kOperatorMagic and a new
/// number here.
constexpr std::uint32_t kOperatorRecordVersion = 1;
constexpr std::uint32_t kOperatorMagic = 0x3152504f;  // "OPR1"
/// Indices of the two records in the store; the indices 0 and 1 are the slot records.
constexpr std::uint32_t kOperatorPlace = 2, kOperatorRecordCount = 2;

/// Number of an axis in a record, made from the name, so that a board file with another order of axes keeps
/// the weight of each axis. Not 0. Not real-time safe.
std::uint32_t operator_axis(const char* name, std::uint32_t size) noexcept;

/// A record and the place where it must be stored.
struct OperatorChange {
  std::uint32_t place;
  OperatorRecord record;
};

using OperatorPlace = StoredPlace<OperatorRecord>;

/// The two records of the operator's state, without access to the medium. A change overwrites the older
/// record, and the board writes each setting to both places: intact are two valid records, one change apart.
/// After a power failure at any byte of a write the pair is intact with the state before or after the change,
/// or damaged.
class OperatorRecords {
 public:
  /// Loads the newer valid record of the two places. Not real-time safe.
  static OperatorRecords load(const OperatorPlace& first, const OperatorPlace& second) noexcept;
  /// State of the places since load() and the changes stored since. A damaged pair is intact after at
  /// most two changes.
  StoredPair places() const noexcept { return places_; }
  /// True if a record is stored. Otherwise state() is the default state (no setting of an operator).
  bool known() const noexcept { return now_.sequence != 0; }
  const OperatorState& state() const noexcept { return now_.state; }
  /// True if load() found the state in one place only: the second write did not come, or the first one is not
  /// on the medium yet.
  bool once() const noexcept { return once_; }
  /// Returns the change that stores another state. Not real-time safe.
  OperatorChange change_to(const OperatorState& state) const noexcept;
  /// Reports to the object that the change is on the medium. Not real-time safe.
  void stored(const OperatorChange& change) noexcept;

 private:
  OperatorRecord now_{kOperatorMagic, 0, {}, 0};
  std::uint32_t next_place_ = kOperatorPlace;
  StoredPair places_ = StoredPair::kNothing;
  bool once_ = false;
};

/// True for a record that a board may use: magic, checksum, sequence. Not real-time safe.
bool is_valid(const OperatorRecord& record) noexcept;

}  // namespace vernier
