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

/// A sum of products of sines, cosines and positions. The factors are sines and cosines of sums of axis
/// positions, and positions of linear axes.
class Wave {
 public:
  /// A factor of a product: the sine or cosine of a sum of axis positions, or the position of one axis.
  struct Factor {
    enum class Kind : std::uint8_t { kSine, kCosine, kPosition } kind = Kind::kSine;
    std::vector<double> by;  // coefficient of each axis in the sum of positions
    auto operator<=>(const Factor&) const = default;
  };

  static Wave constant(double value);
  void add(const Wave& other, double scale);
  Wave times(const Factor& factor) const;
  Wave times(const Wave& other) const;

  /// Returns the sum without rounding errors: products below 1e-6 of `scale` are removed.
  Wave cleaned(double scale) const;
  /// True if the sum has the same value at all positions of all axes.
  bool is_constant() const;
  /// Returns the different sums of axis positions in the sines and cosines of the value. If the sines and
  /// cosines contain two or more different sums of positions, no single axis drives the value.
  std::set<std::vector<double>> phases() const;
  std::size_t terms() const { return terms_.size(); }
  /// Returns the trigonometric sum as an expression with the names of the machine's axes. Numbers in the
  /// expression have six digits.
  model::ExprPtr expression(const model::Machine& machine) const;

 private:
  std::map<std::vector<Factor>, double> terms_;
};

/// Gravity along the nominal chain: the direction of gravity in every frame, and the moment of a mass about a
/// joint. The nominal chain is a product of rotations about fixed directions (Brockett's product of
/// exponentials). Successive rotations about one direction are combined into one rotation by the sum of their
/// angles. The tool branch and the workpiece branch of the chain start at the same base. If the degrees of
/// freedom of a transform are not sums of axis positions, gravity is unknown in all later frames.
class GravityChain {
 public:
  explicit GravityChain(const model::Machine& machine);

  /// Returns the direction of gravity in the frame in which a degree of freedom acts. For an angle, the frame
  /// is that after the rotation by this angle.
  std::optional<std::array<Wave, 3>> direction(const DofPlace& place) const;
  /// Returns the moment of gravity on a bar about an angle, per length and weight: (toward x gravity) . axis.
  /// The bar points along the local axis `toward` (0 to 2), which is not the axis of the angle.
  std::optional<Wave> across(const DofPlace& angle, std::size_t toward) const;
  /// True if gravity can have a moment about the axis of the angle. False if gravity is parallel to the axis
  /// of the angle at every pose.
  bool may_turn(const DofPlace& angle) const;
  /// True if the transform contains no rotation by an axis and no constant rotation. The three angles of a
  /// transform without rotations have one common frame.
  bool is_rigid(const DofPlace& transform) const;
  /// Returns the component of gravity along the direction of a length.
  std::optional<Wave> along(const DofPlace& length) const;
  /// Returns the moment of a mass about a joint. The mass that loads the joint is at the end of a later
  /// transform in the same branch of the chain. The value 1 is the moment of this mass if the links between
  /// joint and mass are horizontal and fully extended.
  std::optional<Wave> moment(const DofPlace& joint, std::size_t transform) const;

 private:
  /// Rotation by a sum of axis positions about a direction. The direction is given in the base frame with all
  /// axes at zero.
  struct Turn {
    Eigen::Vector3d axis;
    std::vector<double> by;
  };
  /// A degree of freedom of the chain, in the order in which the degrees of freedom act.
  struct Motion {
    DofPlace place;
    Eigen::Vector3d local;  // unit vector along which (or about which) the degree of freedom acts
    bool is_angle = false;
    double constant = 0;      // value of the degree of freedom with all axes at zero
    std::vector<double> by;   // change of the degree of freedom per unit of each axis
    std::vector<Turn> turns;  // rotations up to and including this degree of freedom
    Eigen::Matrix3d home;     // frame of the degree of freedom with all axes at zero
    bool known = true;        // true: this degree of freedom and all earlier ones are sums of axis positions
  };

  void build(const model::Machine& nominal, bool workpiece);
  const Motion* find(const DofPlace& place) const;
  static std::array<Wave, 3> turned_back(std::array<Wave, 3> vector, const std::vector<Turn>& turns,
                                         std::size_t from);

  Eigen::Vector3d gravity_;
  std::vector<std::array<double, 2>> range_;  // range of each axis
  std::vector<Motion> motions_;
};

/// Returns the local axis of a degree of freedom: 0, 1, 2 for x, y, z.
std::size_t local_axis(const model::Machine& machine, const DofPlace& place);

}  // namespace vernier::effects
