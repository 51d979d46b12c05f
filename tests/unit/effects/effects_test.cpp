// SPDX-License-Identifier: GPL-3.0-or-later
// The catalogue: what is in it, users' own entries, and damaged files.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <set>

#include "tools/effects/candidate.h"
#include "tools/effects/catalogue.h"
#include "tools/text/error.h"
#include "tools/text/files.h"

namespace vernier::effects_test {

using namespace vernier::effects;
using namespace vernier::model;
using namespace vernier::text;
namespace {

constexpr const char* kSound =
    "effect nap\ntitle A nap\nsignature It sleeps\nform plain own k*{q}\nunknown k {dof}/{q} linear 5\n";

TEST(Effects, CatalogueHoldsEveryIdOfTheFormats) {
  std::set<std::string> known;
  for (const Effect& effect : built_in_effects()) known.insert(effect.id);
  for (const char* id : {"scale-error",      "squareness",    "axis-tilt",       "offset",
                         "backlash",         "lateral-play",  "reversal-spike",  "cyclic-error",
                         "straightness",     "angular-error", "thermal-scale",   "thermal-offset",
                         "thermal-bend",     "warmup-drift",  "gravity-sag",     "load-deflection",
                         "joint-compliance", "servo-lag",     "servo-mismatch",  "inertial-deflection",
                         "centrifugal",      "trigger-delay", "probe-pretravel", "tool-radius",
                         "time-sync",        "base-drift",    "creep",           "time-base",
                         "vibration",        "hysteresis"})
    EXPECT_TRUE(known.contains(id)) << id;
}

TEST(Effects, EveryEntryTellsWhatAUserMustKnow) {
  std::set<std::string> known;
  for (const Effect& effect : built_in_effects()) known.insert(effect.id);
  for (const Effect& effect : built_in_effects()) {
    EXPECT_FALSE(effect.formula.empty()) << effect.id;
    EXPECT_FALSE(effect.exposed_by.empty()) << effect.id;
    EXPECT_FALSE(effect.impostors.empty()) << effect.id;
    for (const std::string& impostor : effect.impostors) {
      EXPECT_TRUE(known.contains(impostor)) << effect.id << ": " << impostor;
      EXPECT_NE(impostor, effect.id);
    }
  }
}

TEST(Effects, AUsersFileAddsAndReplaces) {
  const std::string path = testing::TempDir() + "effects_" + std::to_string(getpid()) + ".txt";
  write_file(
      path,
      std::string(kSound) +
          "\r\n# a comment\neffect backlash\n  title Mine\nsignature s\nform a own k*dir{q}\nunknown k mm "
          "linear\n");
  const std::vector<Effect> all = effect_catalogue({path});
  std::filesystem::remove(path);
  ASSERT_EQ(all.size(), built_in_effects().size() + 1);
  EXPECT_EQ(all.back().id, "nap");
  EXPECT_EQ(all.back().forms[0].place, PlaceRule::kOwn);
  EXPECT_EQ(all.back().forms[0].term, "k*{q}");
  EXPECT_EQ(all.back().unknowns[0].limit, 5);
  EXPECT_TRUE(all.back().unknowns[0].plausible.contains(1e9));
  std::size_t found = 0;
  for (const Effect& effect : all)
    if (effect.id == "backlash") {
      ++found;
      EXPECT_EQ(effect.title, "Mine");
      EXPECT_EQ(effect.forms.size(), 1u);
    }
  EXPECT_EQ(found, 1u);
}

TEST(Effects, AUsersEntrySaysWhatIsSeldomAndWhatCauseItHas) {
  const std::vector<Effect> one = parse_effects(
      "effect nap\ntitle A nap\nsignature It sleeps\ncause sleep\nform plain own k*{q}\nform square own "
      "k*{q}^2\nseldom square\nunknown k mm linear 5\n",
      "mine.txt");
  ASSERT_EQ(one.size(), 1U);
  EXPECT_EQ(one[0].cause, "sleep");
  EXPECT_FALSE(one[0].rare);
  EXPECT_FALSE(one[0].forms[0].rare);
  EXPECT_TRUE(one[0].forms[1].rare);
}

TEST(Effects, AUsersEntryMayStateThePlausibleValuesOfAnUnknown) {
  const std::vector<Effect> one = parse_effects(
      "effect nap\ntitle A nap\nsignature s\nform plain own k*{q}\nunknown k mm linear 5 -0.5 2\n",
      "mine.txt");
  const PlausibleRange& range = one.at(0).unknowns.at(0).plausible;
  EXPECT_TRUE(range.contains(-0.5) && range.contains(2));
  EXPECT_FALSE(range.contains(-0.51) || range.contains(2.01));
}

TEST(Effects, TermsOfASearchMayHaveAnyCoefficient) {
  const UnknownRule& k = custom_effect().unknowns.at(0);
  EXPECT_EQ(k.name, "k");
  EXPECT_EQ(k.limit, 0);
  EXPECT_TRUE(k.plausible.contains(-1e9) && k.plausible.contains(1e9));
}

TEST(Effects, AUsersEntryMayBeTheInstrumentsAndMayNeedTouches) {
  const std::vector<Effect> two =
      parse_effects(std::string(kSound) +
                        "effect bump\ntitle A bump\nsignature It is touched\ntouches it is felt\n"
                        "instrument The probe: its tip is worn.\nform plain own k\nunknown k mm linear\n",
                    "mine.txt");
  ASSERT_EQ(two.size(), 2U);
  EXPECT_FALSE(two[0].needs_touches);
  EXPECT_TRUE(two[0].of_instrument.empty());
  EXPECT_TRUE(two[1].needs_touches);
  EXPECT_EQ(two[1].of_instrument, "The probe: its tip is worn.");
}

TEST(Effects, ATermIsReadIntoItsTreesAndPlaceholders) {
  EffectForm pair;
  pair.term = "k*v{q} | -k*v{q}";
  read_term(pair);
  ASSERT_EQ(pair.trees.size(), 2U);
  EXPECT_EQ(to_text(*pair.trees[1]), "-k*v{q}");
  EXPECT_EQ(pair.marks, std::set<std::string>{"q"});
  EffectForm table;
  table.term = "dir{q}*({hats 5})";
  read_term(table);
  EXPECT_EQ(table.hats, 5U);
  EXPECT_EQ(table.marks, (std::set<std::string>{"hats", "q"}));
}

TEST(Effects, AMissingFileIsAnError) { EXPECT_THROW(effect_catalogue({"/nowhere/effects.txt"}), InputError); }

struct Damage {
  const char* name;
  std::string text;
  std::size_t line;
  const char* word;
};

void PrintTo(const Damage& damage, std::ostream* out) { *out << damage.name; }

class DamagedEffects : public testing::TestWithParam<Damage> {};

TEST_P(DamagedEffects, NameFileLineAndWord) {
  const Damage& damage = GetParam();
  try {
    parse_effects(damage.text, "mine.txt");
    FAIL() << "no error for " << damage.text;
  } catch (const InputError& error) {
    const std::string what = error.what();
    EXPECT_EQ(what.rfind("mine.txt:" + std::to_string(damage.line) + ":", 0), 0u) << what;
    EXPECT_NE(what.find(std::string("\"") + damage.word + "\""), std::string::npos) << what;
  }
}

std::string unknown_rule(const std::string& kind) {
  return "effect nap\ntitle A nap\nsignature s\nform plain own k*{q}\nunknown k mm " + kind + "\n";
}
std::string with(const std::string& lines) { return kSound + lines; }
std::string form_of(const std::string& form) {
  return "effect nap\ntitle A nap\nsignature It sleeps\n" + form + "\nunknown k mm linear 5\n";
}

INSTANTIATE_TEST_SUITE_P(
    Lines, DamagedEffects,
    testing::Values(Damage{"NoEffectYet", "title x\n", 1, "title"}, Damage{"BadId", "effect a,b\n", 1, "a,b"},
                    Damage{"Twice", with(kSound), 6, "nap"}, Damage{"Key", with("colour red\n"), 6, "colour"},
                    Damage{"Place", form_of("form plain anywhere k*{q}"), 4, "anywhere"},
                    Damage{"NoTerm", form_of("form plain own"), 4, "plain"},
                    Damage{"FormTwice", with("form plain cross k*{q}\n"), 6, "plain"},
                    Damage{"Syntax", form_of("form plain own k*({q}"), 4, "k*({q}"},
                    Damage{"Placeholder", form_of("form plain own k*{axis}"), 4, "{axis}"},
                    Damage{"OpenBrace", form_of("form plain own k*{q"), 4, "{q"},
                    Damage{"Hats", form_of("form plain own {hats 1}"), 4, "{hats 1}"},
                    Damage{"HatsWithoutH", form_of("form plain own {hats 5}"), 4, "{hats 5}"},
                    Damage{"NoUnknownInTerm", form_of("form plain own 3*{q}"), 4, "3*{q}"},
                    Damage{"PairWithoutBar", form_of("form plain pair k*{q}"), 4, "k*{q}"},
                    Damage{"BarWithoutPair", form_of("form plain own k*{q}|k"), 4, "k*{q}|k"},
                    Damage{"RangeTurned", unknown_rule("linear 5 2 -0.5"), 5, "k"},
                    Damage{"HalfARange", unknown_rule("linear 5 2 x"), 5, "x"},
                    Damage{"UnknownTwice", with("unknown k mm linear\n"), 6, "k"},
                    Damage{"UnknownNotUsed", with("unknown w mm linear\n"), 1, "w"},
                    Damage{"UnknownIsReserved", with("unknown feed mm linear\n"), 6, "feed"},
                    Damage{"Kind", with("unknown w mm square\n"), 6, "square"},
                    Damage{"Number", with("unknown w mm linear five\n"), 6, "five"},
                    Damage{"MoreThanAsked", with("unknown w mm time 5\n"), 6, "5"},
                    Damage{"Grid", with("unknown w mm grid 5 2 7\n"), 6, "w"},
                    Damage{"NoForm", "effect a\ntitle t\nsignature s\nunknown k mm linear\n", 1, "a"},
                    Damage{"NoUnknown", "effect a\ntitle t\nsignature s\nform plain own k\n", 1, "a"},
                    Damage{"SeldomWhat", with("seldom plain other\n"), 6, "other"},
                    Damage{"NoTitle",
                           "effect a\nsignature s\nform plain own k\nunknown k mm linear\n" +
                               std::string(kSound),
                           1, "a"}),
    [](const auto& one) { return std::string(one.param.name); });

}  // namespace
}  // namespace vernier::effects_test
