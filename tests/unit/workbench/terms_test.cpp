// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/workbench/files/terms.h"

#include "tests/unit/workbench/rig.h"
#include "tools/model/machine_reader.h"
#include "tools/workbench/files/dimensions.h"

namespace vernier::terms_test {

using namespace vernier::model;
using namespace vernier::workbench;
namespace {

nlohmann::ordered_json check(const std::string& text, const std::string& unit = "mm") {
  return check_term(parse_machine(test::kSmallMachine, "m.xml"), text, unit);
}

TEST(TermCheck, TellsTheUnitThatTheCoefficientMustHave) {
  const std::vector<std::array<const char*, 3>> cases = {{"k*X", "mm", "1"},
                                                         {"k*(T-20)*X", "mm", "1/degC"},
                                                         {"k*vX", "mm", "s"},
                                                         {"k*feed^2*curv", "mm", "s^2"},
                                                         {"k*dirX", "deg", "deg"},
                                                         {"k*X", "deg", "deg/mm"},
                                                         {"k*aX*X", "deg", "deg*s^2/mm^2"},
                                                         {"k*sqrt(X*Y)", "mm", "1"},
                                                         {"k*lag(T, 600)", "mm", "mm/degC"},
                                                         {"k*exp(-t/3)", "mm", "mm"}};
  for (const auto& [text, unit, wanted] : cases)
    EXPECT_EQ(check(text, unit)["k_unit"], wanted) << text << ": " << check(text, unit);
}

TEST(TermCheck, WarnsOfUnitsThatDoNotGoTogether) {
  EXPECT_TRUE(check("k*(X+Y)")["warnings"].empty());
  for (const char* text : {"k*(X+T)", "k*max(X, T)", "k*2^X", "k*sin(T)", "k*lag(T, X)", "k*log(T)"})
    EXPECT_EQ(check(text)["warnings"].size(), 1u) << text << ": " << check(text);
  EXPECT_EQ(check("3*X")["warnings"].size(), 1u);  // nothing unknown in it
}

TEST(TermCheck, NamesTheWordThatIsWrong) {
  const auto unknown = check("k*(Tt-20)");
  EXPECT_EQ(unknown["ok"], false);
  EXPECT_EQ(unknown["word"], "Tt");
  EXPECT_EQ(check("k*(X")["ok"], false);
  EXPECT_EQ(check("")["ok"], false);
}

TEST(TermNames, EveryNameThatIsOfferedCanBeUsed) {
  const Machine machine = parse_machine(test::kSmallMachine, "m.xml");
  for (const auto& name : expression_names(machine)) {
    const auto text = name["name"].get<std::string>();
    if (text == "run(" || text.back() == '(') continue;
    EXPECT_TRUE(check_term(machine, "k*" + text, "mm")["ok"].get<bool>()) << text;
  }
}

TEST(Units, PowersAreWrittenAsAUnit) {
  EXPECT_EQ(unit_text({}), "1");
  EXPECT_EQ(unit_text({1, 0, -1}), "mm/degC");
  EXPECT_EQ(unit_text({-2, 0, 0, -1}), "1/(mm^2*s)");
  EXPECT_EQ(unit_powers("mm/min"), unit_powers("mm/s"));
  EXPECT_FALSE(unit_powers("furlong"));
}

}  // namespace
}  // namespace vernier::terms_test
