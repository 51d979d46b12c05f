// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/effects/spoken.h"

#include <gtest/gtest.h>

#include "tests/unit/effects/candidates.h"
#include "tools/effects/add_string.h"
#include "tools/effects/reversal.h"
#include "tools/model/machine_reader.h"
#include "tools/text/files.h"

namespace vernier::spoken_test {

using namespace vernier::effects;
using namespace vernier::model;
using namespace vernier::text;
namespace {

struct Spoken {
  explicit Spoken(const std::string& machine)
      : model(with_base_row(parse_machine(read_file(diagnose_test::machine_path(machine)), machine))) {}
  Candidate of(const std::string& add) const {
    return make_candidate(model, parse_add_string(add, model, built_in_effects()));
  }
  std::string sized(const std::string& add, const std::vector<std::pair<double, double>>& values) const {
    const Candidate candidate = of(add);
    std::vector<SpokenValue> list;
    for (std::size_t i = 0; i < values.size(); ++i)
      list.push_back({candidate.unknowns.at(i).name, values[i].first, values[i].second});
    return spoken_with_size(candidate, list);
  }
  Machine model;
};

TEST(Spoken, NamesPartAndCauseAsAShopDoes) {
  const Spoken five("five_axis_bhead_ctable");
  EXPECT_EQ(five.of("servo-lag:axis=Z").spoken, "Z carriage: lag");
  EXPECT_EQ(five.of("backlash:axis=C").spoken, "C table: backlash");
  EXPECT_EQ(five.of("backlash:axis=B").spoken, "B head: backlash");
  const Spoken robot("ur10e");
  EXPECT_EQ(robot.of("backlash:axis=J3").spoken, "joint J3: backlash");
}

TEST(Spoken, SaysHowMuchInUnitsOfTheShop) {
  const Spoken five("five_axis_bhead_ctable");
  // A coefficient of -k*v is a lag of k; both to the digits that the uncertainty leaves.
  EXPECT_EQ(five.sized("servo-lag:axis=Z", {{-0.0001369, 6.6e-6}}), "Z carriage: lag 0.137 +- 0.007 ms");
  // The jump is twice the coefficient.
  EXPECT_EQ(five.sized("backlash:axis=X", {{-0.0118, 2e-4}}),
            "X carriage: backlash, reversal value B -23.6 +- 0.4 um");
  EXPECT_EQ(five.sized("backlash:axis=X,form=along", {{-0.00015, 1e-4}, {2.047e-5, 3.7e-7}}),
            "X carriage: backlash, reversal value B -0.3 +- 0.2 um at position 0, and 40.9 +- 0.7 um/m along "
            "the axis");
  EXPECT_EQ(five.sized("backlash:axis=C", {{0.001, 1.2e-4}}),
            "C table: backlash, reversal value B 7.2 +- 0.9 arcsec");
  EXPECT_EQ(five.sized("scale-error:axis=X", {{5.5e-5, 1.4e-6}}), "X carriage: scale error 55.0 +- 1.4 um/m");
  // A table that lags behind leaves the tool ahead: ISO 230-2 states the tool relative to the workpiece.
  EXPECT_EQ(five.sized("backlash:axis=Y", {{0.007, 1e-4}}),
            "Y table: backlash, reversal value B -14.0 +- 0.2 um");
  // An uncertainty that is not known is not invented.
  EXPECT_EQ(five.sized("backlash:axis=X", {{-0.0118, 0}}), "X carriage: backlash, reversal value B -23.6 um");
}

TEST(Reversal, IsTheFactorOfADirectionInASum) {
  const auto factor = [](const char* text) {
    const auto found = direction_coefficient(*model::parse_expression(text), "k");
    return found ? found->factor : 0;
  };
  EXPECT_EQ(factor("k*dirX"), 1);
  EXPECT_EQ(factor("dirX*k"), 1);
  EXPECT_EQ(factor("X-k*dirX"), -1);
  EXPECT_EQ(factor("X+2*(k*dirX)/4"), 0.5);
  EXPECT_EQ(factor("(k+s*X)*dirX"), 1);
  EXPECT_EQ(factor("(k-s)*(dirX+X)"), 1);
  EXPECT_EQ(factor("k*dirX*X"), 0);
  EXPECT_EQ(factor("k*X"), 0);
  EXPECT_EQ(factor("s*dirX"), 0);
  EXPECT_EQ(factor("k2*dirX"), 0);
  EXPECT_EQ(factor("sin(k*dirX)"), 0);
  EXPECT_EQ(factor("k*dirX+k*dirY"), 0) << "no single axis";
}

TEST(Spoken, EveryEntryOfTheCatalogueHasAName) {
  for (const Effect& effect : built_in_effects()) {
    EXPECT_FALSE(effect.short_name.empty()) << effect.id;
    EXPECT_EQ(effect.short_name.find("transform"), std::string::npos) << effect.id;
  }
}

}  // namespace
}  // namespace vernier::spoken_test
