// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "tools/effects/types.h"

namespace vernier::effects {

/// A sum of products. The factors are sines and cosines of sums of axis positions, and positions
/// of linear axes.
class Wave {
 public:
  /// A factor: sine or cosine of a sum of positions, or the position of an axis itself.
  struct Factor {
    enum class Kind : std::uint8_t { kSine, kCosine, kPosition } kind = Kind::kSine;
    std::vector<double> by;  // factor of each axis in the sum
    auto operator<=>(const Factor&) const = default;
  };

  static Wave constant(double value);
  void add(const Wave& other, double scale);
  Wave times(const Factor& factor) const;
  Wave times(const Wave& other) const;

  /// Returns the sum without rounding errors: terms below 1e-6 of `scale` are removed.
  Wave cleaned(double scale) const;
  /// True if the sum has the same value at all positions of all axes.
  bool is_constant() const;
  /// Returns the sums of positions on which the sum depends. If there are two such sums of positions, no
  /// single axis drives the sum.
  std::set<std::vector<double>> phases() const;
  std::size_t terms() const { return terms_.size(); }
  /// Returns the sum as an expression with the names of the machine's axes. Numbers of the expression have
  /// six digits.
  model::ExprPtr expression(const model::Machine& machine) const;

 private:
  std::map<std::vector<Factor>, double> terms_;
};

/// Gravity along the nominal chain: its direction in every frame, and the moment of a mass about a joint. The
/// chain is a product of turns about fixed directions (Brockett's product of exponentials). Successive turns
/// about one direction are combined into one turn by the sum of their angles. Both branches of the chain
/// start at the same base. A transform whose degrees of freedom are not sums of axis positions makes all
/// later frames unknown.
class GravityChain {
 public:
  explicit GravityChain(const model::Machine& machine);

  /// Returns the direction of gravity in the frame in which a degree of freedom acts. For an angle, the frame
  /// is the frame after the rotation by the angle.
  std::optional<std::array<Wave, 3>> direction(const DofPlace& place) const;
  /// Returns the moment of gravity on a bar about an angle, per length and weight: (toward x gravity) . axis.
  /// The bar points along local axis `toward` (0 to 2, not the axis of the angle).
  std::optional<Wave> across(const DofPlace& angle, std::size_t toward) const;
  /// True if gravity may have a moment about the angle. False if gravity points along the axis of the angle
  /// at every pose.
  bool may_turn(const DofPlace& angle) const;
  /// True if the transform has no turn by an axis or a constant. The angles of such a transform share one
  /// frame.
  bool is_rigid(const DofPlace& transform) const;
  /// Component of gravity along a length.
  std::optional<Wave> along(const DofPlace& length) const;
  /// Returns the moment about a joint of a mass at the end of a transform of the same branch, behind the
  /// joint. The value 1 is the moment of that mass if the links between are level and at full length.
  std::optional<Wave> moment(const DofPlace& joint, std::size_t transform) const;

 private:
  /// Rotation by a sum of axis positions, about a direction that is given in the base frame with all axes at
  /// zero.
  struct Turn {
    Eigen::Vector3d axis;
    std::vector<double> by;
  };
  /// A degree of freedom, in the order of action.
  struct Motion {
    DofPlace place;
    Eigen::Vector3d local;  // unit vector along or about which it acts
    bool is_angle = false;
    double constant = 0;      // its value with all axes at zero
    std::vector<double> by;   // its change per unit of each axis
    std::vector<Turn> turns;  // up to and including this motion
    Eigen::Matrix3d home;     // its frame with all axes at zero
    bool known = true;        // this motion and all before it are sums of positions
  };

  void build(const model::Machine& nominal, bool workpiece);
  const Motion* find(const DofPlace& place) const;
  static std::array<Wave, 3> turned_back(std::array<Wave, 3> vector, const std::vector<Turn>& turns,
                                         std::size_t from);

  Eigen::Vector3d gravity_;
  std::vector<std::array<double, 2>> range_;  // of each axis
  std::vector<Motion> motions_;
};

/// Returns the local axis of a degree of freedom: 0 to 2 for x to z.
std::size_t local_axis(const model::Machine& machine, const DofPlace& place);

}  // namespace vernier::effects
