// SPDX-License-Identifier: GPL-3.0-or-later
// Writing an effect into a machine file changes what a fit may find, and nothing that the machine says today.
#include <gtest/gtest.h>

#include <set>

#include "tests/unit/effects/candidates.h"
#include "tools/effects/add.h"
#include "tools/effects/add_string.h"
#include "tools/fit/coverage/domain.h"
#include "tools/model/chain/prediction.h"
#include "tools/model/machine_reader.h"
#include "tools/model/rebind.h"
#include "tools/text/error.h"

namespace vernier::add_test {

using namespace vernier::effects;
using namespace vernier::fit;
using namespace vernier::model;
using namespace vernier::text;
namespace {

using diagnose_test::all_choices;
using diagnose_test::machine_path;

constexpr std::uint64_t kSeed = 20240611;

std::vector<std::string> terms_of(const Machine& machine, const Candidate& candidate) {
  std::vector<std::string> list;
  for (const CandidateTerm& term : candidate.terms)
    list.push_back(fmt::format("{} {} {}: {}", term.place.workpiece, transform_at(machine, term.place).n,
                               dof_name(machine, term.place), term.text));
  for (const CandidateUnknown& unknown : candidate.unknowns)
    list.push_back(fmt::format("{} [{}] {}", unknown.name, unknown.unit, unknown.start));
  return list;
}

class AddAnywhere : public testing::TestWithParam<std::string> {
 protected:
  AddAnywhere()
      : text_(read_file(machine_path(GetParam()))),
        machine_(with_base_row(parse_machine(text_, GetParam()))),
        random_(kSeed),
        rows_(diagnose_test::random_rows(machine_, 6, random_)),
        before_(predict(machine_, rows_)),
        nominal_(predict(nominal_machine(machine_), rows_)) {}

  void expect_unchanged(const Candidate& candidate) {
    const Machine added = parse_machine(add_to_machine_text(text_, machine_, candidate), "added.xml");
    const Measurement rows = rebind(rows_, machine_, added);
    // The term is 0 times something finite: not even a rounding may differ.
    EXPECT_EQ((predict(added, rows) - before_).cwiseAbs().maxCoeff(), 0);
    EXPECT_EQ((predict(nominal_machine(added), rows) - nominal_).cwiseAbs().maxCoeff(), 0);
    // Low, high and fade of each range of a learned term's domain, beside what the effect brings.
    const std::size_t of_domains = 3 * (domain_ranges(added).size() - domain_ranges(machine_).size());
    ASSERT_EQ(added.statics.size(), machine_.statics.size() + candidate.unknowns.size() + of_domains);
    EXPECT_EQ(of_domains > 0, candidate.choice.effect->id == "vibration");
    for (const CandidateUnknown& unknown : candidate.unknowns) {
      const Static& item = added.statics[*added.find_static(unknown.name)];
      EXPECT_FALSE(item.hidden);
      EXPECT_EQ(item.value, unknown.start);
      EXPECT_EQ(*item.nominal, unknown.start);  // 0 of a coefficient, the start of a period
      EXPECT_EQ(unknown.start == 0, unknown.kind == UnknownKind::kLinear);
      EXPECT_EQ(item.unit.find_first_of("{}"), std::string::npos) << item.unit;
    }
  }

  void expect_round_trip(const Candidate& candidate) {
    const std::string text = add_string(machine_, candidate.choice);
    EXPECT_EQ(text.find_first_of(" \"'"), std::string::npos) << text;  // one word of a shell
    const Candidate again = make_candidate(machine_, parse_add_string(text, machine_, built_in_effects()));
    EXPECT_EQ(terms_of(machine_, again), terms_of(machine_, candidate));
    EXPECT_EQ(add_string(machine_, again.choice), text);
  }

  std::string text_;
  Machine machine_;
  std::mt19937_64 random_;
  Measurement rows_;
  Eigen::VectorXd before_, nominal_;
};

/// Each form at places of every rule; of the rules that admit all places a sample for each axis.
TEST_P(AddAnywhere, ChangesNothingAndReadsBack) {
  constexpr std::size_t kMostPlaces = 6;
  const std::vector<Choice> choices = all_choices(machine_, kMostPlaces);
  EXPECT_GT(choices.size(), 100u);
  for (const Choice& choice : choices) {
    const Candidate candidate = make_candidate(machine_, choice);
    SCOPED_TRACE(candidate.label + ", form " + choice.form->label);
    expect_unchanged(candidate);
    expect_round_trip(candidate);
    if (HasFailure()) break;
  }
}

/// Two of a kind, and everything else on top: no name is used twice, for the file would not be read.
TEST_P(AddAnywhere, NamesNeverClash) {
  std::string text = text_;
  std::set<std::string> names;
  std::size_t count = 0;
  const std::vector<Choice> choices = all_choices(machine_, 1);
  for (std::size_t i = 0; i < choices.size(); i += 1 + choices.size() / 12)
    for (int twice = 0; twice < 2; ++twice) {
      const Machine machine = with_base_row(parse_machine(text, "grown.xml"));
      const Candidate candidate = make_candidate(machine, choices[i]);
      for (const CandidateUnknown& unknown : candidate.unknowns) {
        names.insert(unknown.name);
        ++count;
      }
      text = add_to_machine_text(text, machine, candidate);
    }
  EXPECT_EQ(names.size(), count);
  // Terms learned on vibration bring the ends of their domain along.
  std::size_t ends = 0;
  const Machine grown = parse_machine(text, "grown.xml");
  for (const Static& one : grown.statics) ends += one.name.starts_with("domain") ? 1 : 0;
  EXPECT_EQ(grown.statics.size(), machine_.statics.size() + count + ends);
}

INSTANTIATE_TEST_SUITE_P(Machines, AddAnywhere, testing::ValuesIn(diagnose_test::reference_machines()),
                         [](const auto& one) { return one.param; });

}  // namespace
}  // namespace vernier::add_test
