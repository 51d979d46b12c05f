// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/ballbar/repeating_error.h"

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "tools/import/ballbar/ballbar_motion.h"
#include "tools/maths/decompositions.h"
#include "tools/maths/median.h"

namespace vernier::importer {
namespace {

using Index = Eigen::Index;
using Sparse = Eigen::SparseMatrix<double, Eigen::ColMajor, Index>;

struct ErrorSamples {
  Eigen::VectorXd angle_deg, reading_um;
  Index count() const { return angle_deg.size(); }
};

using Wanted = std::function<bool(std::size_t)>;

ErrorSamples collect(const BallbarFile& file, const BallbarRun& run, const std::vector<char>& on_circle,
                     const Wanted& wanted) {
  std::vector<double> angle, reading;
  for (std::size_t i = 0; i < run.reading_mm.size(); ++i) {
    if (!wanted(i) || (!on_circle.empty() && !on_circle[i])) continue;
    angle.push_back(circle_point(file, run, i).angle_deg);
    reading.push_back(1000 * run.reading_mm[i]);
  }
  const auto n = static_cast<Index>(angle.size());
  return {Eigen::Map<Eigen::VectorXd>(angle.data(), n), Eigen::Map<Eigen::VectorXd>(reading.data(), n)};
}

// Every fifth group of three samples, or all the others: predicted by a table between them.
ErrorSamples part(const ErrorSamples& all, Index fold, bool held) {
  std::vector<Index> keep;
  for (Index i = 0; i < all.count(); ++i) {
    if ((((i / 3) % 5) == fold) == held) keep.push_back(i);
  }
  return {all.angle_deg(keep), all.reading_um(keep)};
}

// Centre and radius, and a table of their residuals.
class Model {
 public:
  Model(const ErrorSamples& samples, std::size_t stations) : table_(static_cast<Index>(stations)) {
    const Eigen::MatrixXd basis = circle(samples);
    circle_ = maths::solve_symmetric(basis.transpose() * basis, basis.transpose() * samples.reading_um);
    if (stations > 0) fit_table(samples, samples.reading_um - basis * circle_);
  }

  Eigen::VectorXd residual(const ErrorSamples& samples) const {
    Eigen::VectorXd left = samples.reading_um - circle(samples) * circle_;
    for (Index i = 0; i < samples.count() && table_.size() > 0; ++i) {
      const Place place = find(samples.angle_deg[i]);
      left[i] -= (1 - place.part) * table_[place.station] + place.part * table_[place.next];
    }
    return left;
  }

  double rms(const ErrorSamples& samples) const {
    return std::sqrt(residual(samples).squaredNorm() / static_cast<double>(samples.count()));
  }

 private:
  struct Place {
    Index station, next;
    double part;
  };

  static Eigen::MatrixXd circle(const ErrorSamples& samples) {
    Eigen::MatrixXd basis(samples.count(), 3);
    const Eigen::ArrayXd angle = samples.angle_deg.array() * (std::numbers::pi / 180);
    basis.col(0).setOnes();
    basis.col(1) = angle.cos();
    basis.col(2) = angle.sin();
    return basis;
  }

  Place find(double angle_deg) const {
    const double at = angle_deg / 360 * static_cast<double>(table_.size());
    const auto station = static_cast<Index>(at) % table_.size();
    return {station, (station + 1) % table_.size(), at - std::floor(at)};
  }

  // A weak pull towards its neighbours' mean keeps a station that no sample touches from being undefined.
  void fit_table(const ErrorSamples& samples, const Eigen::VectorXd& reading_um) {
    constexpr double kPull = 1e-3;  // of one reading's weight
    std::vector<Eigen::Triplet<double, Index>> entries;
    Eigen::VectorXd right = Eigen::VectorXd::Zero(table_.size());
    for (Index i = 0; i < samples.count(); ++i) {
      const Place p = find(samples.angle_deg[i]);
      const double a = 1 - p.part, b = p.part;
      entries.insert(entries.end(), {{p.station, p.station, a * a},
                                     {p.next, p.next, b * b},
                                     {p.station, p.next, a * b},
                                     {p.next, p.station, a * b}});
      right[p.station] += a * reading_um[i];
      right[p.next] += b * reading_um[i];
    }
    for (Index k = 0; k < table_.size(); ++k) {
      const Index next = (k + 1) % table_.size();
      entries.insert(entries.end(),
                     {{k, k, kPull}, {next, next, kPull}, {k, next, -kPull}, {next, k, -kPull}});
    }
    Sparse normal(table_.size(), table_.size());
    normal.setFromTriplets(entries.begin(), entries.end());
    table_ = Eigen::SimplicialLDLT<Sparse>(normal).solve(right);
  }

  Eigen::Vector3d circle_;
  Eigen::VectorXd table_;
};

double left_out_rms(const ErrorSamples& samples, std::size_t stations) {
  double squares = 0;
  for (Index fold = 0; fold < 5; ++fold) {
    const ErrorSamples held = part(samples, fold, true);
    squares += std::pow(Model(part(samples, fold, false), stations).rms(held), 2) *
               static_cast<double>(held.count());
  }
  return std::sqrt(squares / static_cast<double>(samples.count()));
}

std::optional<double> judged(const Model& model, const ErrorSamples& samples) {
  return samples.count() > 0 ? std::optional(model.rms(samples)) : std::nullopt;
}

// Standard deviation of a normal law with this median size.
std::optional<double> usual(const Model& model, const ErrorSamples& samples) {
  if (samples.count() == 0) return std::nullopt;
  const Eigen::VectorXd residual = model.residual(samples);
  return maths::robust_spread({residual.begin(), residual.end()});
}

ErrorSamples other_direction(const BallbarFile& file, const BallbarRun& run,
                             const std::vector<std::vector<char>>& on_circle) {
  const auto all = [](std::size_t) { return true; };
  for (std::size_t k = 0; k < file.runs.size(); ++k) {
    if (file.runs[k].direction != run.direction)
      return collect(file, file.runs[k], on_circle.empty() ? std::vector<char>{} : on_circle[k], all);
  }
  return {};
}

}  // namespace

RepeatingError repeating_error(const BallbarFile& file, std::size_t run,
                               const std::vector<std::vector<char>>& on_circle) {
  const BallbarRun& mine = file.runs[run];
  const std::vector<char> mask = on_circle.empty() ? std::vector<char>{} : on_circle[run];
  const auto analysed = [&](std::size_t i) { return i >= mine.start && i <= mine.end; };
  const ErrorSamples fit = collect(file, mine, mask, analysed);
  const ErrorSamples turn = collect(file, mine, mask, [&](std::size_t i) { return !analysed(i); });
  const ErrorSamples direction = other_direction(file, mine, on_circle);
  RepeatingError result;
  result.run = mine.label;
  result.fit_samples = static_cast<std::size_t>(fit.count());
  result.other_turn_samples = static_cast<std::size_t>(turn.count());
  result.other_direction_samples = static_cast<std::size_t>(direction.count());
  for (std::size_t stations = 0; 2 * stations <= result.fit_samples;
       stations = stations == 0 ? 6 : stations * 2) {
    const Model model(fit, stations);
    result.steps.push_back({stations, left_out_rms(fit, stations), model.rms(fit), judged(model, turn),
                            judged(model, direction), usual(model, turn)});
    if (result.steps.back().left_out_um < result.best().left_out_um) result.chosen = result.steps.size() - 1;
  }
  return result;
}

}  // namespace vernier::importer
