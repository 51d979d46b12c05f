// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/states.h"

namespace vernier::offline {

struct CorrectorOptions {
  bool with_rotary = false;  // true: all axes correct the tool point and the tool direction; false: the
                             // linear axes correct the tool point
  /// If `back` is true, the input contains positions of the machine with its errors. The output of a
  /// conversion back contains the commands of an ideal machine with the same tool point.
  bool back = false;
};

/// A position whose correction exceeds the maxcorrection of an axis.
struct BeyondLimit {
  std::size_t axis = 0;  // the axis of this position that exceeds its limit most
  double size = 0;       // its correction, mm or deg
  std::size_t line = 0;  // of the list; 0: a position of a program
  /// Condition number of the scaled Jacobian of the axes: large near a singular pose. 0: not known
  double condition = 0;
};

/// Statistics of the changes to the positions of a list or a program.
struct CorrectionSummary {
  std::size_t positions = 0;        // number of positions in a list; for a program, number of evaluated
                                    // positions
  std::size_t not_converged = 0;    // number of these positions at which the solution did not converge
  std::vector<double> largest;      // largest correction of each axis, mm or deg
  double left_mm = 0;               // largest distance between the corrected and the ideal tool point
  std::vector<BeyondLimit> beyond;  // positions that exceed a maxcorrection, in their order
  double usual_condition = 0;       // median condition number of the positions of the last commands()

  /// Returns the largest correction of the linear axes together, um.
  double largest_um(const model::Machine& machine) const;
  /// Returns the largest correction of any rotary axis, deg.
  double largest_deg(const model::Machine& machine) const;
};

/// Computes corrected commands: axis positions at which the tool point of the machine with errors is the tool
/// point of its nominal chain.
class Corrector {
 public:
  explicit Corrector(const model::Machine& machine, CorrectorOptions options = {});

  const model::Machine& machine() const { return machine_; }
  /// Returns the axis positions (axes x states) to command, for states of an ideal machine. The motion and
  /// the inputs of the states are used without change. Throws InputError if the value of the chain is not
  /// finite.
  Eigen::MatrixXd commands(const model::States& states);
  /// Adds positions to the statistics of summary(), after commands() of the same positions. `lines`: their
  /// lines in a list; empty: a program.
  void count(const model::States& states, const Eigen::MatrixXd& commands,
             const std::vector<std::size_t>& lines = {});
  const CorrectionSummary& summary() const { return summary_; }
  bool back() const { return options_.back; }

 private:
  const model::Machine& machine_;
  model::Machine nominal_;
  CorrectorOptions options_;
  void count_beyond(const model::States& states, const Eigen::MatrixXd& commands,
                    const std::vector<std::size_t>& lines);

  CorrectionSummary summary_;
  std::vector<double> conditions_;  // of the last commands()
};

/// First words of an output file. The first words identify a file that was corrected before, and a file that
/// was converted back before.
inline constexpr const char* kCorrectedMark = "corrected by vernier";
inline constexpr const char* kBackMark = "converted back by vernier";

/// Throws InputError with the line if a text states that the same conversion was already done: correction, or
/// conversion back if `back` is true.
void refuse_done(const std::string& text, const std::string& file, bool back);

}  // namespace vernier::offline
