// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

namespace vernier::create {

/// One joint of an arm: Tz(d)·Rz(theta)·Tx(a)·Rx(alpha), the row of Denavit and Hartenberg. Ry(beta) follows
/// if the next axis is nearly parallel (Hayati 1983). The position of the joint is added to theta; for a
/// prismatic joint it is added to d.
struct DhRow {
  double theta = 0, d = 0, a = 0, alpha = 0;  // deg, mm, mm, deg
  bool prismatic = false;
  double beta = 0;  // deg
  /// True if the axis of the next joint is parallel, or nearly parallel, to the axis of this joint.
  bool parallel() const;
  bool operator==(const DhRow&) const = default;
};

/// The default arm: six joints, published lengths of the UR10e.
const std::vector<DhRow>& default_arm();

/// Reads a table of rows: a header of `theta[deg] d[mm] a[mm] alpha[deg]` in any order (optional `type` of R
/// or P), then one row per joint. Without a theta column, theta is 0. Throws InputError with file, line and
/// word.
std::vector<DhRow> parse_dh_table(const std::string& text, const std::string& file);

/// Reads one joint from "theta,d,a,alpha" or "P,theta,d,a,alpha". Throws InputError with the word.
DhRow parse_dh_row(const std::string& words);

}  // namespace vernier::create
