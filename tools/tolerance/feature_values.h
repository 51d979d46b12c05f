// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "tools/tolerance/placed_part.h"

namespace vernier::tolerance {

/// Reference to which the deviations of a part's points are related.
enum class PartFrame : std::uint8_t {
  kPart,     // least-squares location of the features that are marked as datums, or of all features
  kMachine,  // machine coordinates
};

/// Computes a characteristic from numbers that are linear in the deviations of the part's points.
struct CharacteristicValue {
  std::size_t feature = 0;
  PartCharacteristic what = PartCharacteristic::kPosition;
  std::optional<std::array<double, 2>> limits_mm;  // limits of the characteristic, from its tolerance
  Eigen::Index first = 0, count = 0;               // first row of the map, and number of rows
  Eigen::Index group = 1;                          // number of rows that are the components of one vector

  /// Returns the characteristic in mm from the rows of the map: position is twice the length of the longest
  /// vector, size is the row itself, form is the range.
  double of(const Eigen::Ref<const Eigen::VectorXd>& rows) const;
};

/// All characteristics of a part as functions of the deviations of its points.
struct PartValues {
  std::vector<CharacteristicValue> values;
  Eigen::MatrixXd map;  // rows x 3 N: factors of the deviations of the tool point in workpiece coordinates,
                        // mm
};

/// Throws InputError if the reference frame removes all deviations that a position tolerance needs.
PartValues part_values(const PlacedPart& part, PartFrame frame, const std::string& file);

}  // namespace vernier::tolerance
