// SPDX-License-Identifier: GPL-3.0-or-later
// The term-discovery benchmark: how often the selection core of diagnose names c * (T - 20) * x and nothing
// else among all products of twelve inputs (two of them confounded with T) and positions, how well c comes
// out, and how long it takes. `term_discovery [SEEDS]`.

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <cstdlib>

#include "tests/support/term_discovery.h"
#include "tools/diagnose/propose/scan.h"
#include "tools/diagnose/propose/selection.h"

namespace {

using namespace vernier;
using namespace vernier::diagnose;
using namespace vernier::maths;

/// Columns of the library and what each is: input, position (0: none, 1..3: x y z) or second input.
struct Library {
  Eigen::MatrixXd columns;
  std::vector<std::string> names;
};

Library make_library(const support::TermDiscovery& data) {
  const Eigen::Index rows = data.position.cols(), inputs = data.inputs.cols();
  static constexpr std::array<const char*, 4> kPositions = {"1", "x", "y", "z"};
  Library library;
  library.columns.resize(rows, inputs * 4 + inputs * (inputs + 1) / 2);
  Eigen::Index next = 0;
  Eigen::MatrixXd centred = data.inputs.rowwise() - data.inputs.colwise().mean();
  for (Eigen::Index i = 0; i < inputs; ++i) {
    const std::string& name = data.input_names[static_cast<std::size_t>(i)];
    for (Eigen::Index p = 0; p < 4; ++p) {
      library.columns.col(next++) =
          p == 0 ? Eigen::VectorXd(centred.col(i))
                 : Eigen::VectorXd(centred.col(i).cwiseProduct(data.position.row(p - 1).transpose()));
      library.names.push_back(name + "*" + kPositions[static_cast<std::size_t>(p)]);
    }
    for (Eigen::Index k = i; k < inputs; ++k) {
      library.columns.col(next++) = centred.col(i).cwiseProduct(centred.col(k));
      library.names.push_back(name + "*" + data.input_names[static_cast<std::size_t>(k)]);
    }
  }
  return library;
}

struct Outcome {
  bool clean = false;
  double error = 0, seconds = 0;  // error of c in units of its bound
};

Outcome discover(const support::TermDiscovery& data) {
  const auto start = std::chrono::steady_clock::now();
  const Library library = make_library(data);
  const Eigen::Index rows = data.reading_um.size();
  Eigen::MatrixXd model(rows, data.geometry_basis.cols() + 1);
  model << data.geometry_basis, Eigen::VectorXd::Ones(rows);
  const Eigen::MatrixXd absorbed = orthonormal(model, 1e-8, nullptr);
  Eigen::MatrixXd own = library.columns - absorbed * (absorbed.transpose() * library.columns);
  const Eigen::VectorXd residual = data.reading_um - absorbed * (absorbed.transpose() * data.reading_um);
  const Eigen::VectorXd norms = own.colwise().norm();
  own = own * norms.cwiseInverse().asDiagonal();
  SelectionProblem problem;
  problem.gram = own.transpose() * own;
  problem.moment = own.transpose() * residual;
  problem.chi_square = residual.squaredNorm();
  problem.observations = static_cast<double>(rows);
  problem.freedom = static_cast<double>(rows - absorbed.cols());
  for (Eigen::Index j = 0; j < own.cols(); ++j)
    problem.entries.push_back(
        {j, 1, 2 * std::log(static_cast<double>(own.cols())), 0, static_cast<std::size_t>(j)});
  constexpr std::size_t kMostTerms = 4;
  const Selection found = select(problem, kMostTerms);
  Outcome outcome;
  outcome.clean = found.chosen.size() == 1 && library.names[found.chosen[0]] == data.input_names[0] + "*x";
  if (outcome.clean) {
    const auto at = static_cast<Eigen::Index>(found.chosen[0]);
    outcome.error =
        std::abs(coefficients(problem, found.chosen)[0] / norms[at] - data.coefficient) / data.bound;
  }
  outcome.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return outcome;
}

}  // namespace

int main(int argc, char** argv) {
  const std::uint64_t seeds = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 20;
  fmt::print("{:>8} {:>12} {:>26} {:>18}\n", "sigmas", "clean finds", "rms error of c / bound", "longest, s");
  for (const double sigmas : {33.0, 12.0, 5.0}) {
    std::uint64_t clean = 0;
    double square = 0, longest = 0;
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
      const Outcome outcome = discover(support::make_term_discovery(seed, sigmas));
      clean += outcome.clean ? 1 : 0;
      square += outcome.error * outcome.error;
      longest = std::max(longest, outcome.seconds);
    }
    fmt::print("{:>8} {:>9}/{} {:>26.3f} {:>18.3f}\n", sigmas, clean, seeds,
               std::sqrt(square / static_cast<double>(std::max<std::uint64_t>(1, clean))), longest);
  }
  return 0;
}
