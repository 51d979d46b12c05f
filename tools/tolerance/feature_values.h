// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "tools/tolerance/placed_part.h"

namespace vernier::tolerance {

/// Reference of the deviations of a part's points.
enum class PartFrame : std::uint8_t {
  kPart,     // the features themselves: all of them, or those marked as datums, by least squares
  kMachine,  // the machine's own coordinates
};

/// Computes a characteristic from numbers that are linear in the deviations of the part's points.
struct CharacteristicValue {
  std::size_t feature = 0;
  PartCharacteristic what = PartCharacteristic::kPosition;
  std::optional<std::array<double, 2>> limits_mm;  // of its tolerance
  Eigen::Index first = 0, count = 0;               // rows of the map
  Eigen::Index group = 1;                          // rows that are components of one vector

  /// mm, from the rows of the map: position twice the longest vector, size the row itself, form the range.
  double of(const Eigen::Ref<const Eigen::VectorXd>& rows) const;
};

/// All characteristics of a part as functions of the deviations of its points.
struct PartValues {
  std::vector<CharacteristicValue> values;
  Eigen::MatrixXd map;  // rows x 3 N: of deviations of the tool point, workpiece coordinates, mm
};

/// Throws InputError if the frame absorbs all directions that a position tolerance needs.
PartValues part_values(const PlacedPart& part, PartFrame frame, const std::string& file);

}  // namespace vernier::tolerance
