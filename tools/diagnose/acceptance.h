// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <optional>
#include <vector>

#include "tools/diagnose/propose/evidence.h"

namespace vernier::diagnose {

/// Result of leaving out whole runs, for the columns that a model would gain.
struct HeldOut {
  double chi_square = 0;          // of all rows, each predicted from the other runs
  std::vector<double> agreement;  // per run left out: cosine between its columns' part and that of all runs
};

/// Predicts every run of the fit rows from the other runs, with the free parameters of the model and
/// `columns` (any columns, after projection on the orthogonal complement of the model's free parameters).
/// Parameters that only the held-out run determines are fitted to the held-out run. `within_runs`: leaves out
/// parts of runs instead (for effects that are a property of a run). `watched`: first and count of the
/// columns whose agreement is reported.
HeldOut leave_runs_out(const Evidence& evidence, const Eigen::MatrixXd& columns, Eigen::Index watched_first,
                       Eigen::Index watched_count, bool within_runs = false);

/// Predicts each block of the fit rows from the other blocks, like leave_runs_out. blocks: one index per fit
/// observation.
HeldOut leave_blocks_out(const Evidence& evidence, const Eigen::MatrixXd& columns, Eigen::Index watched_first,
                         Eigen::Index watched_count, const std::vector<int>& blocks);

/// Returns blocks of whole feeds, and of whole temperatures of each thermometer. A term that was learned on
/// features must be confirmed on such blocks, because features depend on feed and temperature. The result has
/// one list for each quantity with two levels or more.
std::vector<std::vector<int>> level_blocks(const Evidence& evidence);

/// Returns blocks of whole places: five stretches of an axis, its positions counted off by five, and the
/// corners of the measured volume (halves of the three axes with the most positions). Other rows at the same
/// position cannot contradict what a term does between the positions. The result has one list for each of
/// these divisions that has two blocks or more. axis: nullopt for the corners alone.
std::vector<std::vector<int>> place_blocks(const Evidence& evidence, std::optional<std::size_t> axis);

}  // namespace vernier::diagnose
