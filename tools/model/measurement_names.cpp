// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/model/measurement_names.h"

#include <algorithm>
#include <array>

namespace vernier::model {
namespace {

constexpr bool kReading = true, kLabel = true, kSince = true;

constexpr std::array kColumns = {
    KnownColumn{"x", "mm", kReading},
    KnownColumn{"y", "mm", kReading},
    KnownColumn{"z", "mm", kReading},
    KnownColumn{"rx", "deg", kReading},
    KnownColumn{"ry", "deg", kReading},
    KnownColumn{"rz", "deg", kReading},
    KnownColumn{"length", "mm", kReading},
    KnownColumn{"d", "mm", kReading},
    KnownColumn{"ax", "", kReading, false, kSince},
    KnownColumn{"ay", "", kReading, false, kSince},
    KnownColumn{"az", "", kReading, false, kSince},
    KnownColumn{"distance", "mm", kReading, false, kSince},
    KnownColumn{"ix", "deg", kReading, false, kSince},
    KnownColumn{"iy", "deg", kReading, false, kSince},
    KnownColumn{"cx", "mm"},
    KnownColumn{"cy", "mm"},
    KnownColumn{"cz", "mm"},
    KnownColumn{"px", "mm"},
    KnownColumn{"py", "mm"},
    KnownColumn{"pz", "mm"},
    KnownColumn{"nx", ""},
    KnownColumn{"ny", ""},
    KnownColumn{"nz", ""},
    KnownColumn{"u", "mm"},  // or an angle
    KnownColumn{"ua", "deg", false, false, kSince},
    KnownColumn{"t", "s"},
    KnownColumn{"feed", "mm/s"},
    KnownColumn{"curv", "1/mm"},
    KnownColumn{"visit", ""},
    KnownColumn{"run", "", false, kLabel},
    KnownColumn{"role", "", false, kLabel},
    KnownColumn{"corrected", "", false, kLabel},
    KnownColumn{"setup", "", false, kLabel, kSince},
    KnownColumn{"clock", "", false, kLabel, kSince},
    KnownColumn{"block", "", false, kLabel, kSince},
    KnownColumn{"from", "", false, kLabel, kSince},
};

bool is_correction(const Machine& machine, std::string_view name) {
  return name.starts_with(kCorrectionColumn) &&
         machine.find_axis(std::string(name.substr(kCorrectionColumn.size()))).has_value();
}

}  // namespace

std::span<const KnownColumn> known_columns() { return kColumns; }

const KnownColumn* find_known_column(std::string_view name) {
  const auto found = std::find_if(kColumns.begin(), kColumns.end(),
                                  [&](const KnownColumn& one) { return name == one.name; });
  return found == kColumns.end() ? nullptr : &*found;
}

std::string reading_names() {
  std::string names;
  for (const KnownColumn& column : kColumns)
    if (column.reading) names += (names.empty() ? "" : " ") + std::string(column.name);
  return names;
}

bool is_no_axis_name(const Machine& machine, std::string_view name) {
  return find_known_column(name) != nullptr || is_correction(machine, name);
}

bool is_no_input_name(const Machine& machine, std::string_view name) {
  const KnownColumn* const known = find_known_column(name);
  return (known != nullptr && !known->since) || is_correction(machine, name);
}

}  // namespace vernier::model
