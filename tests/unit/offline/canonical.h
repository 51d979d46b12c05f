// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

namespace vernier::offline_test {

/// A move as the interpreter of LinuxCNC (rs274 of the package linuxcnc-uspace) understands a program: a line
/// or an arc or helix of X Y Z, mm, to 0.0001 mm, which is all that it prints.
struct CanonicalMove {
  bool traverse = false;
  Eigen::Vector3d from, to;
  std::optional<Eigen::Vector3d> centre;  // of an arc: in the plane's two coordinates
  int first = 0, second = 1;              // of the plane
  double turn = 0;                        // rad, signed from first to second
  double feed = 0;                        // mm/min

  Eigen::Vector3d at(double share) const;
  double length() const;
};

/// Is the interpreter on this machine?
bool has_interpreter();
/// Throws std::runtime_error with the interpreter's words where it refuses the program.
std::vector<CanonicalMove> interpreted(const std::string& program);

}  // namespace vernier::offline_test
