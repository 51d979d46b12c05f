// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

namespace vernier::create {

/// One joint of a robot arm as a row of Denavit and Hartenberg: Tz(d)·Rz(theta)·Tx(a)·Rx(alpha). If the next
/// joint axis is nearly parallel, a rotation Ry(beta) is added (Hayati 1983). The position of the joint is
/// added to theta. The position of a prismatic joint is added to d.
struct DhRow {
  double theta = 0, d = 0, a = 0, alpha = 0;  // deg, mm, mm, deg
  bool prismatic = false;
  double beta = 0;  // deg
  /// True if the axis of the next joint is parallel, or nearly parallel, to the axis of this joint.
  bool parallel() const;
  bool operator==(const DhRow&) const = default;
};

/// Returns the default arm: six joints with the published lengths of the UR10e.
const std::vector<DhRow>& default_arm();

/// Reads a table of Denavit-Hartenberg rows. The header has `theta[deg] d[mm] a[mm] alpha[deg]` in any order
/// (optional `type` of R or P); then there is one row per joint. If the table has no column theta, theta is
/// 0. If the table is not valid, throws InputError with file, line and word.
std::vector<DhRow> parse_dh_table(const std::string& text, const std::string& file);

/// Reads one joint from a text of the form "theta,d,a,alpha" or "P,theta,d,a,alpha". Throws InputError with
/// the wrong word.
DhRow parse_dh_row(const std::string& words);

}  // namespace vernier::create
