// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace vernier::model {

struct Machine;

/// Result of the last fit, kept in the machine file (`<fitted>`): uncertainties, findings and the measured
/// region. The values in the machine file alone do not state their uncertainty.
struct FitRecord {
  struct Range {
    std::string name;  // of an axis or input
    double min = 0, max = 0;
  };
  /// A finding of the fit that every later command repeats (FORMATS 7). Codes:
  /// tools/fit/findings.h.
  struct Finding {
    std::string code;
    double value = 0;
    std::string text;  // one sentence
  };
  std::vector<Finding> findings;
  /// Discrepancy: standard deviation of the tool point's deviation that the model does not contain, as the
  /// readings show it. The discrepancy excludes the noise. Along x, y, z of workpiece coordinates, mm
  /// (Kennedy and O'Hagan 2001). 0: not found.
  std::array<double, 3> discrepancy_mm{};
  /// A coefficient whose dependence on a variable the readings do not show. First case: all rows of the
  /// coefficient had nearly one value of an axis or input on which its effect depends. Second case: that
  /// variable followed another variable along a line.
  struct Unvaried {
    std::string coefficient, variable;  // `k_heat` or `table.X.rY`; an axis or an input
    double at = 0;                      // value of the variable, in its unit
    std::string follows;                // the variable that it followed; empty: no such variable
    double slope = 0, about = 0;        // variable = at + slope * (follows - about), in their units
  };
  std::vector<Unvaried> unvaried;
  /// Another term that explains the readings as well as a term of the model. The other term is in the same
  /// degree of freedom. If a shift replaces a rotation, the shift is in the three lengths of the same
  /// transform.
  struct Alternative {
    bool workpiece = false;
    int transform = 0;    // its number n
    std::size_t dof = 0;  // of the model's term, 0..5 = X Y Z rX rY rZ
    std::string axis;     // axis of a cyclic error; empty: a shift
    double period = 0;    // of the cyclic error, axis unit
    /// Size of a cyclic error: sine and cosine, mm or deg. Size of a shift: mm in X, Y, Z for one unit of the
    /// model's term.
    std::array<double, 3> size{};
  };
  std::vector<Alternative> alternatives;
  /// A plane of unknown place that the tool point touched (the bed of a printer), as the fit estimated it, in
  /// workpiece coordinates.
  struct Plane {
    std::string name;                                   // of the artefact
    std::array<double, 3> place_mm{}, normal{0, 0, 1};  // a point of the plane; a unit vector
  };
  std::vector<Plane> planes;
  /// Noise model of the readings (fit::NoiseModel). The components are in units of u, or in mm if no u was
  /// given. The record contains a noise model only if the errors were correlated or larger than u.
  struct Noise {
    double own = 1, pose = 0, run = 0, drift = 0;
    double time_constant = 0, step = 0;  // of the drift, and median of the intervals between rows: s or rows
    bool in_time = false, of_u = true;
    std::uint32_t drifts = 0;  // kinds of reading that drift: bit n is kind n of ObservationKind; 0: all
  };
  std::optional<Noise> noise;
  std::vector<std::string> parameters;  // names as in the JSON of `fit`
  Eigen::VectorXd values;  // as fitted: the covariance does not cover a value that was changed later
  /// Source of each value: data, convention, prior, as in the JSON of `fit`. `origins` is empty in files of
  /// older versions.
  std::vector<std::string> origins;
  /// Lower triangle L, n x n; covariance = L L^T in the units of the parameters. The data determine the
  /// factor; for parameters that the data do not determine, the scales determine the factor.
  Eigen::MatrixXd factor;
  /// Matrix O, n x m. O O^T is the part of the covariance that no reading determines: the spread of the
  /// scales that are used there. m = 0: the readings determine everything.
  Eigen::MatrixXd open;
  bool open_known = false;      // false: the file is older than this entry
  std::vector<Range> measured;  // of the fit rows
  bool converged = true;
  double rms_mm = 0, reach_mm = 0;  // rms of the residuals; half the diagonal of the measured box
  double worst = 0;                 // largest residual divided by the standard deviation of all
  std::string worst_reading;        // "survey.csv:57 z"
  std::string culprit;  // the reason why the readings may not belong to this machine; empty: no reason found
  /// Residual of this machine on the check rows, divided by the residual of the nominal machine in
  /// the same set-up. 0: not enough check rows.
  double check_ratio = 0;
  std::size_t check_count = 0;  // number of check readings; 0 in files of older versions
  std::string worst_check;      // the check reading with the largest residual
  /// Effect of the instrument alone (a step, a drift), or a residual far above its noise, divided
  /// by the residual of the nominal machine. 0: not found.
  double disturbed = 0;
  std::string disturbance;
  std::size_t line = 0;
};

/// Returns the factor L of a covariance (the lower triangle is read), rounded as the machine file stores L.
Eigen::MatrixXd covariance_factor(const Eigen::MatrixXd& covariance);

/// Returns the element `<fitted>` as text, indented by two, with its line end.
std::string fit_record_xml(const FitRecord& record);

/// Returns the factor O of a part of a covariance. O has m columns: the directions (pivoted Cholesky) that
/// are larger than 1e-3 of the variances (the diagonal of the covariance). O is rounded as the machine file
/// stores it.
Eigen::MatrixXd open_factor(const Eigen::MatrixXd& part, const Eigen::MatrixXd& covariance);

/// Reads the numbers of an `open` element: n x columns. Returns false if the text has another
/// format.
bool read_open_numbers(std::string_view text, std::size_t n, FitRecord& record);

/// Reads the numbers of a covariance element: n `values` and n (n + 1) / 2 numbers of L. Returns
/// false if the text has another format.
bool read_fit_numbers(std::string_view text, std::size_t n, FitRecord& record);

/// Returns the machine text with its `<fitted>` replaced, or inserted before the end of the root.
std::string with_fit_record(const std::string& text, const FitRecord& record);

}  // namespace vernier::model
