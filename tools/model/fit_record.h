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

/// Record of the last fit in the machine file (`<fitted>`): uncertainties, findings and the measured region.
/// The record is necessary because the values in the machine file do not state their uncertainty.
struct FitRecord {
  struct Range {
    std::string name;  // name of an axis or input
    double min = 0, max = 0;
  };
  /// A finding of the fit, which every later command reports again (FORMATS 7). The codes of the findings are
  /// in tools/fit/findings.h.
  struct Finding {
    std::string code;
    double value = 0;
    std::string text;  // one sentence for the report
  };
  std::vector<Finding> findings;
  /// Discrepancy along x, y, z of workpiece coordinates, mm (Kennedy and O'Hagan 2001). The discrepancy is
  /// the standard deviation of the tool point's deviation that the model does not contain, as the readings
  /// show it. The discrepancy does not include the noise of the readings. A discrepancy of 0 means that none
  /// was found.
  std::array<double, 3> discrepancy_mm{};
  /// A coefficient whose dependence on a variable the readings do not show. First case: in all rows of the
  /// coefficient, an axis or input on which its effect depends had nearly the same value. Second case: an
  /// axis or input on which its effect depends changed only along a line with another variable.
  struct Unvaried {
    std::string coefficient, variable;  // coefficient: for example `k_heat` or `table.X.rY`; variable: an
                                        // axis or an input
    double at = 0;                      // value of the variable, in its unit
    std::string follows;                // name of the other variable in the second case; empty in the first
                                        // case
    double slope = 0, about = 0;        // variable = at + slope * (follows - about), in their units
  };
  std::vector<Unvaried> unvaried;
  /// Another term that explains the readings as well as a term of the model. The alternative term is in the
  /// same degree of freedom as the term of the model. If a shift is the alternative to a rotation, the shift
  /// is in the three lengths of the same transform.
  struct Alternative {
    bool workpiece = false;
    int transform = 0;    // number n of the transform
    std::size_t dof = 0;  // degree of freedom of the model's term, 0..5 = X Y Z rX rY rZ
    std::string axis;     // axis of a cyclic error; empty: a shift
    double period = 0;    // period of the cyclic error, in the unit of the axis
    /// For a cyclic error, the amplitudes of sine and cosine, mm or deg. For a shift, the shift in X, Y, Z
    /// for one unit of the model's term, mm.
    std::array<double, 3> size{};
  };
  std::vector<Alternative> alternatives;
  /// A plane of unknown position that the tool point touched (for example the bed of a printer), as the fit
  /// estimated it, in workpiece coordinates.
  struct Plane {
    std::string name;                                   // name of the artefact
    std::array<double, 3> place_mm{}, normal{0, 0, 1};  // a point of the plane; a unit vector
  };
  std::vector<Plane> planes;
  /// Noise model of the readings (fit::NoiseModel). The components of the noise are in units of u, or in mm
  /// if no u was given. The record contains a noise model only if the errors of the readings were correlated
  /// or larger than u.
  struct Noise {
    double own = 1, pose = 0, run = 0, drift = 0;
    double time_constant = 0, step = 0;  // time constant of the drift, and median interval between rows: s or
                                         // rows
    bool in_time = false, of_u = true;
    std::uint32_t drifts = 0;  // kinds of reading that drift: bit n is kind n of ObservationKind; 0: all
                               // kinds
  };
  std::optional<Noise> noise;
  std::vector<std::string> parameters;  // names of the parameters, as in the JSON result of `fit`
  Eigen::VectorXd values;  // fitted values; the covariance does not cover a value that was changed later
  /// Source of each parameter's value (data, convention, prior), as in the JSON result of `fit`. `origins` is
  /// empty in files of older versions.
  std::vector<std::string> origins;
  /// Factor of the covariance: lower triangle L, n x n. The covariance is L L^T in the units of the
  /// parameters. The data determine the covariance of a parameter; for a parameter that the data do not
  /// determine, its scale does.
  Eigen::MatrixXd factor;
  /// Factor of the undetermined part of the covariance: matrix O, n x m. O O^T is the part of the covariance
  /// that no reading determines: the variance of the scales that are used instead. If the factor O
  /// has no columns (m = 0), the readings determine all parameters.
  Eigen::MatrixXd open;
  bool open_known = false;      // false: the file is older than this entry
  std::vector<Range> measured;  // measured ranges of the fit rows
  bool converged = true;
  double rms_mm = 0, reach_mm = 0;  // rms of the residuals; half the diagonal of the measured box
  double worst = 0;                 // largest residual divided by the standard deviation of all residuals
  std::string worst_reading;        // name of the reading with the largest residual: "survey.csv:57 z"
  std::string culprit;  // reason why the readings may not belong to this machine; empty if no reason was
                        // found
  /// Residual of this machine on the check rows, divided by the residual of the nominal machine in the same
  /// set-up. A ratio of 0 means that there were not enough check rows.
  double check_ratio = 0;
  std::size_t check_count = 0;  // number of check readings; 0 in files of older versions
  std::string worst_check;      // name of the check reading with the largest residual
  /// Size of a disturbance of the survey, divided by the residual of the nominal machine. A disturbance is an
  /// effect of the instrument alone (a step, a drift), or a residual far above its noise. A value of 0 means
  /// that no disturbance was found.
  double disturbed = 0;
  std::string disturbance;
  std::size_t line = 0;
};

/// Returns the factor L of a covariance, rounded as the machine file stores L. Only the lower triangle of the
/// covariance is read.
Eigen::MatrixXd covariance_factor(const Eigen::MatrixXd& covariance);

/// Returns the element `<fitted>` as text, indented by two blanks, with a line end.
std::string fit_record_xml(const FitRecord& record);

/// Returns the factor O of `part`, which is a part of a covariance. The columns of O are the m directions of
/// `part` that are larger than 1e-3 of the variances (diagonal of `covariance`), by pivoted Cholesky. The
/// numbers of O are rounded as the machine file stores them.
Eigen::MatrixXd open_factor(const Eigen::MatrixXd& part, const Eigen::MatrixXd& covariance);

/// Reads the numbers of an `open` element: a matrix with n rows. Returns false if the text of the `open`
/// element has another format.
bool read_open_numbers(std::string_view text, std::size_t n, FitRecord& record);

/// Reads the numbers of the covariance element: n `values`, and n (n + 1) / 2 numbers of L. Returns false if
/// the text of the covariance element has another format.
bool read_fit_numbers(std::string_view text, std::size_t n, FitRecord& record);

/// Returns the machine text with the element `<fitted>` replaced. If the text has no element `<fitted>`, it
/// is inserted before the end of the root element.
std::string with_fit_record(const std::string& text, const FitRecord& record);

/// Returns the machine text without the element `<fitted>`.
std::string without_fit_record(const std::string& text);

}  // namespace vernier::model
