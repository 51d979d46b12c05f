// SPDX-License-Identifier: GPL-3.0-or-later
// What the search believes of a term against what the term does: columns of Evidence, by the chain rule,
// against differences of predictions of the machine file that `add` writes.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "tests/unit/effects/candidates.h"
#include "tools/diagnose/propose/by_rows.h"
#include "tools/diagnose/propose/evidence.h"
#include "tools/diagnose/propose/families.h"
#include "tools/diagnose/propose/projected.h"
#include "tools/effects/add.h"
#include "tools/model/chain/prediction.h"
#include "tools/model/machine_reader.h"
#include "tools/model/rebind.h"

namespace vernier::columns_test {

using namespace vernier::diagnose;
using namespace vernier::effects;
using namespace vernier::model;
using namespace vernier::text;
namespace {

constexpr std::uint64_t kSeed = 7;

class Columns : public testing::TestWithParam<std::string> {
 protected:
  Columns()
      : text_(read_file(diagnose_test::machine_path(GetParam()))),
        machine_(disturbed(with_base_row(parse_machine(text_, GetParam())))),
        rows_(diagnose_test::random_rows(machine_, 12, random_)) {}

  /// Errors of ordinary size, so that nothing is tried at a point where everything is 0.
  Machine disturbed(Machine machine) {
    std::uniform_real_distribution<double> error(-0.01, 0.01);
    for (Table& table : machine.tables)
      for (Station& station : table.stations)
        for (double& value : station.value) value += error(random_);
    for (Table& table : machine.tables)
      if (table.periodic) table.stations.back().value = table.stations.front().value;
    return machine;
  }

  /// Weighted readings per unit of the unknown: a central difference with a step that moves the term by 1 um
  /// or 1e-3 deg at most; its error is of third order.
  Eigen::VectorXd difference(const Machine& added, const Measurement& rows, const std::string& unknown,
                             double step) const {
    Machine plus = added, minus = added;
    plus.statics[*added.find_static(unknown)].value += step;
    minus.statics[*added.find_static(unknown)].value -= step;
    return (predict(plus, rows) - predict(minus, rows)) / (2 * step);
  }

  void expect_same(const Evidence& evidence, const Candidate& candidate) {
    Machine added = parse_machine(add_to_machine_text(text_, machine_, candidate), "added.xml");
    added.tables = machine_.tables;
    const Measurement rows = rebind(rows_, machine_, added);
    std::vector<double> scanned;
    for (const CandidateUnknown& unknown : scanned_unknowns(candidate)) scanned.push_back(unknown.start);
    const Eigen::MatrixXd columns = evidence.columns(candidate, scanned);
    Eigen::Index at = 0;
    for (const CandidateUnknown& unknown : linear_unknowns(candidate)) {
      const Eigen::VectorXd column = columns.col(at++);
      // A weight is at least 1/(3 um) here: the column's largest entry is what a unit moves, times that.
      const double moves = column.cwiseAbs().maxCoeff() * 3e-3;
      // Where nothing moves, a step of 1 would still turn a tool about itself millions of times.
      const double step = moves > 1e-6 ? std::min(1.0, 1e-3 / moves) : 1e-9;
      const Eigen::VectorXd expected =
          difference(added, rows, unknown.name, step).cwiseProduct(evidence.weights());
      // Readings of up to 20 m are rounded to 4e-12 mm, and weighed with 1000/mm.
      const double rounding = 1e3 * 4e-12 * std::sqrt(static_cast<double>(column.size())) / step;
      EXPECT_LT((column - expected).norm(), 2e-6 * column.norm() + rounding) << unknown.name;
      seen_ += column.norm() > 0 ? 1 : 0;
      ++all_;
    }
  }

  std::mt19937_64 random_{kSeed};
  std::string text_;
  Machine machine_;
  Measurement rows_;
  std::size_t seen_ = 0, all_ = 0;
};

TEST_P(Columns, AreTheDerivativesOfThePrediction) {
  constexpr std::size_t kMostPlaces = 3;
  const Evidence evidence(machine_, rows_);
  ASSERT_EQ(evidence.weights().size(), static_cast<Eigen::Index>(rows_.observations.size()));
  for (Choice& choice : diagnose_test::all_choices(machine_, kMostPlaces)) {
    const Candidate candidate = make_candidate(evidence.machine(), choice);
    SCOPED_TRACE(candidate.label + ", form " + choice.form->label);
    expect_same(evidence, candidate);
    if (HasFailure()) break;
  }
  // Most places move the tool point: the comparison is not of zeros.
  EXPECT_GT(seen_ * 10, all_ * 6);
}

TEST_P(Columns, HaveTheSameScalarProductsByRows) {
  constexpr std::size_t kMostPlaces = 2, kRows = 60;
  const Evidence evidence(machine_, diagnose_test::random_rows(machine_, kRows, random_));
  ASSERT_TRUE(evidence.observations_are_independent());
  std::vector<ScannedCandidate> list;
  for (const Choice& choice : diagnose_test::all_choices(machine_, kMostPlaces)) {
    ScannedCandidate item;
    item.candidate = make_candidate(evidence.machine(), choice);
    for (const CandidateUnknown& unknown : scanned_unknowns(item.candidate))
      item.grid.push_back({unknown.start, 1.3 * unknown.start});
    list.push_back(std::move(item));
  }
  Families families(list);
  families.extend();
  EXPECT_LT(families.size(), list.size());
  // Directions beside the free parameters of the model, as those of a search are.
  Eigen::MatrixXd known = Eigen::MatrixXd::Random(evidence.residual().size(), 3);
  known -= evidence.absorbed() * (evidence.absorbed().transpose() * known);
  std::vector<std::size_t> places(evidence.places().size());
  std::iota(places.begin(), places.end(), std::size_t{0});
  ByRows by_rows(evidence);
  by_rows.prepare(places, known, list.size());
  ColumnMaker maker(evidence);
  std::size_t compared = 0;
  for (std::size_t family = 0; family < families.size(); ++family)
    for (const std::size_t candidate : families.members(family)) {
      SCOPED_TRACE(list[candidate].candidate.label + ", form " +
                   list[candidate].candidate.choice.form->label);
      EXPECT_FALSE(by_rows.is_complete(candidate));
      by_rows.complete(candidate, list[candidate].candidate, *families.functions(family, maker));
      EXPECT_TRUE(by_rows.is_complete(candidate));
      const ProjectedBatch& batch = by_rows.batch(candidate);
      const Eigen::MatrixXd products = by_rows.products(candidate);
      ASSERT_EQ(batch.points.size(), grid_points(list[candidate].grid).size());
      for (std::size_t i = 0; i < batch.points.size(); ++i) {
        const GridPoint& point = batch.points[i];
        const Eigen::MatrixXd columns = evidence.columns(list[candidate].candidate, point.scanned);
        ASSERT_EQ(columns.cols(), point.count);
        const ProjectedBatch expected =
            project(evidence, {{candidate, point.scanned, 0, point.count}}, columns);
        const double longest = expected.norms.maxCoeff();
        EXPECT_LE((batch.norms.segment(point.first, point.count) - expected.norms).norm(), 1e-9 * longest);
        EXPECT_LE((batch.grams[i] - expected.grams[0]).norm(), 1e-9 * longest * longest);
        EXPECT_LE((products.middleCols(point.first, point.count) - known.transpose() * columns).norm(),
                  1e-9 * longest * known.norm());
        compared += longest > 0 && expected.grams[0].trace() > 1e-6 * longest * longest ? 1 : 0;
      }
      if (HasFailure()) return;
    }
  EXPECT_GT(compared, list.size() / 4);
}

INSTANTIATE_TEST_SUITE_P(Machines, Columns,
                         testing::Values("moving_bridge", "column_moving_table", "five_axis_bhead_ctable",
                                         "ur10e", "fibre_placement_dh"),
                         [](const auto& one) { return one.param; });

}  // namespace
}  // namespace vernier::columns_test
