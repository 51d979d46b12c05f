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

/// A sum of products of sines and cosines of sums of axis positions, and of positions of linear axes.
class Wave {
 public:
  /// A factor: sine or cosine of a sum of positions, or the position of an axis itself.
  struct Factor {
    enum class Kind : std::uint8_t { kSine, kCosine, kPosition } kind = Kind::kSine;
    std::vector<double> by;  // how much each axis counts in it
    auto operator<=>(const Factor&) const = default;
  };

  static Wave constant(double value);
  void add(const Wave& other, double scale);
  Wave times(const Factor& factor) const;
  Wave times(const Wave& other) const;

  /// Without what rounding left: terms below 1e-6 of `scale`.
  Wave cleaned(double scale) const;
  /// Does no axis change it?
  bool is_constant() const;
  /// The sums of positions that it depends on; two of them make it a function that no single axis drives.
  std::set<std::vector<double>> phases() const;
  std::size_t terms() const { return terms_.size(); }
  /// As an expression with the names of the machine's axes, six digits a number. tool.
  model::ExprPtr expression(const model::Machine& machine) const;

 private:
  std::map<std::vector<Factor>, double> terms_;
};

/// What gravity does along the nominal chain: its direction in every frame, and the moment of a mass about a
/// joint. The chain is a product of turns about fixed directions (Brockett's product of exponentials); turns
/// about one direction that follow one another are one turn by the sum of their angles. Both branches stand
/// on the same base. Transforms whose degrees of freedom are no sums of axis positions end what is known.
/// tool.
class GravityChain {
 public:
  explicit GravityChain(const model::Machine& machine);

  /// Direction of gravity in the frame in which a degree of freedom acts, an angle's own turn done.
  std::optional<std::array<Wave, 3>> direction(const DofPlace& place) const;
  /// Moment about an angle of a bar that points along local axis `toward` (0 to 2, not the angle's own), per
  /// length and weight: (toward x gravity) . axis.
  std::optional<Wave> across(const DofPlace& angle, std::size_t toward) const;
  /// May gravity have a moment about an angle? Not where it points along it at every pose.
  bool may_turn(const DofPlace& angle) const;
  /// Does no axis and no constant turn anything within this transform? Its angles then share one frame.
  bool is_rigid(const DofPlace& transform) const;
  /// Gravity along a length.
  std::optional<Wave> along(const DofPlace& length) const;
  /// Moment about a joint of a mass where a transform of its branch ends, behind it; 1 is that mass at the
  /// full length of the links between, level.
  std::optional<Wave> moment(const DofPlace& joint, std::size_t transform) const;

 private:
  /// One turn by the sum of positions, about a direction of the base at the position zero of all axes.
  struct Turn {
    Eigen::Vector3d axis;
    std::vector<double> by;
  };
  /// A degree of freedom, in the order in which they act.
  struct Motion {
    DofPlace place;
    Eigen::Vector3d local;  // unit vector along or about which it acts
    bool is_angle = false;
    double constant = 0;      // its value with all axes at zero
    std::vector<double> by;   // and per unit of each axis
    std::vector<Turn> turns;  // up to and with it
    Eigen::Matrix3d home;     // its frame with all axes at zero
    bool known = true;        // it and all before it are sums of positions
  };

  void build(const model::Machine& nominal, bool workpiece);
  const Motion* find(const DofPlace& place) const;
  static std::array<Wave, 3> turned_back(std::array<Wave, 3> vector, const std::vector<Turn>& turns,
                                         std::size_t from);

  Eigen::Vector3d gravity_;
  std::vector<std::array<double, 2>> range_;  // of each axis
  std::vector<Motion> motions_;
};

/// Local axis of a degree of freedom: 0 to 2 for x to z. tool.
std::size_t local_axis(const model::Machine& machine, const DofPlace& place);

}  // namespace vernier::effects
