#include "tools/diagnose/acceptance.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>

#include "tools/diagnose/scan.h"

namespace vernier {
namespace {

/// A direction of which the other runs hold less than this share of the information is theirs no more.
constexpr double kDetermined = 0.01;

/// Rows of a matrix or vector that belong to one block.
std::vector<Eigen::Index> rows_of(const std::vector<int>& blocks, int block) {
  std::vector<Eigen::Index> rows;
  for (std::size_t i = 0; i < blocks.size(); ++i)
    if (blocks[i] == block) rows.push_back(static_cast<Eigen::Index>(i));
  return rows;
}

/// How many directions the other runs do not determine. `information`: theirs of each direction, increasing.
Eigen::Index lost_directions(const Eigen::VectorXd& information) {
  Eigen::Index lost = 0;
  while (lost < information.size() && information[lost] < kDetermined) ++lost;
  return lost;
}

/// What of the model's free parameters only the rows left out determine (their own set-up), as orthonormal
/// columns over these rows: it is fitted to them. New columns are not, they must come from the other rows.
Eigen::MatrixXd fitted_to_block_alone(const Eigen::MatrixXd& model_rows) {
  const Eigen::MatrixXd normal =
      Eigen::MatrixXd::Identity(model_rows.cols(), model_rows.cols()) - model_rows.transpose() * model_rows;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(normal);
  return orthonormal(model_rows * eigen.eigenvectors().leftCols(lost_directions(eigen.eigenvalues())), 1e-6,
                     nullptr);
}

}  // namespace

HeldOut leave_runs_out(const Evidence& evidence, const Eigen::MatrixXd& columns, Eigen::Index watched_first,
                       Eigen::Index watched_count, bool within_runs) {
  HeldOut result;
  const Eigen::MatrixXd own = orthonormal(columns, 1e-6, nullptr);
  const Eigen::MatrixXd& q = evidence.absorbed();
  Eigen::MatrixXd basis(q.rows(), q.cols() + own.cols());
  basis << q, own;
  const Eigen::VectorXd& r = evidence.residual();
  const Eigen::VectorXd all = basis.transpose() * r;
  // Full set of columns in terms of `own`, to follow the watched ones.
  const Eigen::MatrixXd in_own = own.transpose() * columns;
  const auto watched_part = [&](const Eigen::VectorXd& theta) -> Eigen::VectorXd {
    if (watched_count == 0 || own.cols() < columns.cols()) return Eigen::VectorXd();
    const Eigen::VectorXd coefficient = in_own.colPivHouseholderQr().solve(theta.tail(own.cols()));
    return columns.middleCols(watched_first, watched_count) *
           coefficient.segment(watched_first, watched_count);
  };
  const Eigen::VectorXd whole = watched_part(all);
  const std::vector<int> blocks = within_runs ? evidence.parts_of_runs() : evidence.blocks();
  const int count = 1 + *std::max_element(blocks.begin(), blocks.end());
  for (int block = 0; block < count; ++block) {
    const std::vector<Eigen::Index> rows = rows_of(blocks, block);
    if (rows.empty()) continue;
    const Eigen::MatrixXd left_out = basis(rows, Eigen::all);
    const Eigen::VectorXd r_out = r(rows);
    const Eigen::MatrixXd normal =
        Eigen::MatrixXd::Identity(basis.cols(), basis.cols()) - left_out.transpose() * left_out;
    const Eigen::VectorXd moment = all - left_out.transpose() * r_out;
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(normal);
    const Eigen::Index lost = lost_directions(eigen.eigenvalues());
    const Eigen::Index seen = basis.cols() - lost;
    const Eigen::MatrixXd v = eigen.eigenvectors().rightCols(seen);
    const Eigen::VectorXd theta = v * (v.transpose() * moment).cwiseQuotient(eigen.eigenvalues().tail(seen));
    Eigen::VectorXd error = r_out - left_out * theta;
    const Eigen::MatrixXd own_of_block = fitted_to_block_alone(left_out.leftCols(q.cols()));
    error -= own_of_block * (own_of_block.transpose() * error);
    result.chi_square += error.squaredNorm();
    const Eigen::VectorXd part = watched_part(theta);
    if (part.size() > 0)
      result.agreement.push_back(part.dot(whole) / std::max(part.norm() * whole.norm(), 1e-300));
  }
  return result;
}

}  // namespace vernier
