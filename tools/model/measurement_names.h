// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <span>
#include <string>
#include <string_view>

#include "tools/model/machine.h"

namespace vernier::model {

/// A column of a measurement file whose name means something whatever the machine. The list is the only one:
/// the reader, `lint` and `new` use it.
struct KnownColumn {
  const char* name;
  const char* unit;      // base unit that it needs; "": a pure number or a word
  bool reading = false;  // measured: with the columns beside it that it needs
  bool label = false;    // words
  /// Of a later version of the format: a machine file may use the name for an input of its own, and a column
  /// with another unit is somebody's own.
  bool since = false;
};
std::span<const KnownColumn> known_columns();

/// Nothing (nullptr) where the formats do not know the name.
const KnownColumn* find_known_column(std::string_view name);

/// "x y z rx …": all readings, for messages.
std::string reading_names();

/// The column that says what a board had added to an axis: "correctionX".
inline constexpr std::string_view kCorrectionColumn = "correction";

/// May no axis be called so, because a measured column has this name? `machine`: its axes have columns
/// "correctionX" and so on.
bool is_no_axis_name(const Machine& machine, std::string_view name);
/// The same of an input.
bool is_no_input_name(const Machine& machine, std::string_view name);
/// What the reader says of such a name.
inline constexpr const char* kMeasuredName = "measurement files use this name for a measured column";

}  // namespace vernier::model
