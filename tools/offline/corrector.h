// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/states.h"

namespace vernier::offline {

struct CorrectorOptions {
  bool with_rotary =
      false;  // all axes put point and tool direction right, not the linear ones the point alone
  /// If true, the positions of the machine with its errors are given, and the commands of an ideal machine at
  /// the same tool point are computed.
  bool back = false;
};

/// Changes of the positions of a list or program.
struct CorrectionSummary {
  std::size_t positions = 0;      // of a list; of a program those that were looked at
  std::size_t not_converged = 0;  // of these
  std::vector<double> largest;    // by axis, mm or deg
  double left_mm = 0;             // largest distance between the corrected tool point and the ideal one

  /// Returns the largest correction of the linear axes together, um.
  double largest_um(const model::Machine& machine) const;
  /// Returns the largest correction of any rotary axis, deg.
  double largest_deg(const model::Machine& machine) const;
};

/// Computes commands with the correction: axis positions that bring the tool of the machine with errors to
/// the tool point of its nominal chain.
class Corrector {
 public:
  explicit Corrector(const model::Machine& machine, CorrectorOptions options = {});

  const model::Machine& machine() const { return machine_; }
  /// Axis positions (axes x states) to command for states of an ideal machine; motion and inputs are used as
  /// given. Throws InputError if the chain is not finite.
  Eigen::MatrixXd commands(const model::States& states);
  /// Adds positions to the summary.
  void count(const model::States& states, const Eigen::MatrixXd& commands);
  const CorrectionSummary& summary() const { return summary_; }
  bool back() const { return options_.back; }

 private:
  const model::Machine& machine_;
  model::Machine nominal_;
  CorrectorOptions options_;
  CorrectionSummary summary_;
};

/// First words of the output, by which a file that was corrected before is recognised, and a file that was
/// converted back.
inline constexpr const char* kCorrectedMark = "corrected by vernier";
inline constexpr const char* kBackMark = "converted back by vernier";

/// Throws InputError with the line if a text states that the same was already done with it: corrected, or
/// with `back` converted back.
void refuse_done(const std::string& text, const std::string& file, bool back);

}  // namespace vernier::offline
