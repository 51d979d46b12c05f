// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

namespace vernier::model {

struct Machine;

/// What a fit knew of the machine that it wrote, kept in the machine file (`<fitted>`): without it a file of
/// numbers cannot say how well it knows them, nor where it was measured.
struct FitRecord {
  struct Range {
    std::string name;  // of an axis or input
    double min = 0, max = 0;
  };
  /// Something that the fit found and that every later command repeats (FORMATS 7). Codes:
  /// tools/fit/findings.h.
  struct Finding {
    std::string code;
    double value = 0;
    std::string text;  // one sentence
  };
  std::vector<Finding> findings;
  /// What the model lacks, as far as the readings showed it: standard deviation of the tool point's deviation
  /// beyond the noise, along x, y, z of workpiece coordinates, mm (Kennedy and O'Hagan 2001). 0: none seen.
  std::array<double, 3> discrepancy_mm{};
  /// A coefficient whose rows all had nearly one value of an axis or input that its effect depends on, or one
  /// that followed another variable along a line: the readings do not show that dependence.
  struct Unvaried {
    std::string coefficient, variable;  // `k_heat` or `table.X.rY`; an axis or an input
    double at = 0;                      // value of the variable, in its unit
    std::string follows;                // the variable that it followed; empty: none
    double slope = 0, about = 0;        // variable = at + slope * (follows - about), in their units
  };
  std::vector<Unvaried> unvaried;
  /// Another term that explains the readings as well as one that the model has, in the same degree of freedom
  /// or, a shift in place of a turn, in the three lengths of the same transform.
  struct Alternative {
    bool workpiece = false;
    int transform = 0;    // its number n
    std::size_t dof = 0;  // of the model's term, 0..5 = X Y Z rX rY rZ
    std::string axis;     // a wave along it; empty: a shift
    double period = 0;    // of the wave, axis unit
    /// Of the wave sine and cosine, mm or deg; of the shift mm in X, Y, Z for one unit of the model's term.
    std::array<double, 3> size{};
  };
  std::vector<Alternative> alternatives;
  /// How the errors of its readings hung together (fit::NoiseModel), in units of u, of mm where none was
  /// given; kept where they did, or were larger than u.
  struct Noise {
    double own = 1, pose = 0, run = 0, drift = 0;
    double time_constant = 0, step = 0;  // of the drift, and median from row to row: s or rows
    bool in_time = false, of_u = true;
  };
  std::optional<Noise> noise;
  std::vector<std::string> parameters;  // names as in the JSON of `fit`
  Eigen::VectorXd values;               // as fitted: a value changed since then is not covered
  /// What each value rests on: data, convention, prior, as in the JSON of `fit`; empty in files that older
  /// versions wrote.
  std::vector<std::string> origins;
  /// n x n lower triangle L, covariance = L L^T in the parameters' units: of data and of what stands in where
  /// they say nothing.
  Eigen::MatrixXd factor;
  /// n x m, the part O O^T of the covariance that no reading bears on: the spread of the scales where they
  /// stand in. m = 0: the readings determine everything.
  Eigen::MatrixXd open;
  bool open_known = false;      // a file that was written before this was kept does not say
  std::vector<Range> measured;  // of the fit rows
  bool converged = true;
  double rms_mm = 0, reach_mm = 0;  // what was left of the readings; half the diagonal of the measured box
  double worst = 0;                 // largest residual over the spread of all
  std::string worst_reading;        // "survey.csv:57 z"
  std::string culprit;              // what makes the readings not those of this machine; empty: nothing found
  /// What check rows leave of this machine, over what they leave of the nominal one in the same set-up; 0:
  /// too few of them to tell.
  double check_ratio = 0;
  std::size_t check_count = 0;  // readings that it is from; 0 in files of older versions
  std::string worst_check;      // the check reading that is left furthest off
  /// What the instrument did by itself (a step, a drift), or what is left far above its noise, over what the
  /// nominal machine leaves of the readings; 0: nothing of the kind.
  double disturbed = 0;
  std::string disturbance;
  std::size_t line = 0;
};

/// L of a covariance (its lower triangle is read), rounded as the machine file keeps it.
Eigen::MatrixXd covariance_factor(const Eigen::MatrixXd& covariance);

/// The element, indented by two, with its line end.
std::string fit_record_xml(const FitRecord& record);

/// O of a part of a covariance, m columns for its m directions (pivoted Cholesky, those that are more than
/// 1e-3 of the covariance's own squares), rounded as the machine file keeps it. tool.
Eigen::MatrixXd open_factor(const Eigen::MatrixXd& part, const Eigen::MatrixXd& covariance);

/// Numbers of an `open` element: n x columns of them. False where the text is not that.
bool read_open_numbers(std::string_view text, std::size_t n, FitRecord& record);

/// Numbers of a covariance element: `values` and L, n and n (n + 1) / 2 of them. False where the text is not
/// that.
bool read_fit_numbers(std::string_view text, std::size_t n, FitRecord& record);

/// The text with its `<fitted>` replaced, or put before the end of the root. tool.
std::string with_fit_record(const std::string& text, const FitRecord& record);

}  // namespace vernier::model
