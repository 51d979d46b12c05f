// SPDX-License-Identifier: GPL-3.0-or-later
// What the search believes of a term against what the term does: columns of Evidence, by the chain rule,
// against differences of predictions of the machine file that `add` writes.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/effects/candidates.h"
#include "tools/diagnose/propose/evidence.h"
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

INSTANTIATE_TEST_SUITE_P(Machines, Columns,
                         testing::Values("moving_bridge", "column_moving_table", "five_axis_bhead_ctable",
                                         "ur10e", "fibre_placement_dh"),
                         [](const auto& one) { return one.param; });

}  // namespace
}  // namespace vernier::columns_test
