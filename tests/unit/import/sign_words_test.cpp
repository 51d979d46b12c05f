// SPDX-License-Identifier: GPL-3.0-or-later
// The sign of deviations, as titles and headings state it: a sign that is read wrongly doubles an error.
#include "tools/import/words/sign_words.h"

#include <gtest/gtest.h>

#include <string>

#include "tools/import/reading/sheet_import.h"
#include "tools/sheet/workbook_writer.h"
#include "tools/text/error.h"

namespace vernier::sign_words_test {

using namespace vernier::importer;
namespace {

constexpr SignSaid kNothing = SignSaid::kNothing, kActual = SignSaid::kActualLessNominal,
                   kNominal = SignSaid::kNominalLessActual, kUnclear = SignSaid::kUnclear;
constexpr SignPlace kHeading = SignPlace::kHeading, kTitle = SignPlace::kTitle;

struct Case {
  const char* text;
  SignPlace place;
  SignSaid said;
};
void PrintTo(const Case& one, std::ostream* out) { *out << one.text; }

const Case kCases[] = {
    // Definitions in a title.
    {"Abweichung = Soll - Ist", kTitle, kNominal},
    {"Abweichung = Sollwert minus Istwert", kTitle, kNominal},
    {"Abweichung = Soll minus Ist", kTitle, kNominal},
    {"Soll ./. Ist X [um]", kHeading, kNominal},
    {"Abw. X (Sollwert abzgl. Istwert) [um]", kHeading, kNominal},
    {"Abweichung: Soll-Ist in um", kTitle, kNominal},
    {"Abweichungen in µm (Soll-Ist)", kTitle, kNominal},
    {"Abweichung X [um] = Soll X - Ist X", kTitle, kNominal},
    {"Abweichung = X-Soll - X-Ist", kTitle, kNominal},
    {"Abweichung ist Sollposition minus Istposition", kTitle, kNominal},
    {"ABWEICHUNG = SOLL - IST", kTitle, kNominal},
    {"Vorzeichen: Soll - Ist", kTitle, kNominal},
    {"Vorzeichen Sollposition \u2212 Istposition", kTitle, kNominal},
    {"Deviation = nominal minus measured", kTitle, kNominal},
    {"Error = commanded position minus measured position", kTitle, kNominal},
    {"Deviation = target-actual", kTitle, kNominal},
    {"Sign: nominal \u2013 actual", kTitle, kNominal},
    {"Deviation (Nominal \u2014 Actual), um", kTitle, kNominal},
    {"dX = X_soll - X_ist", kTitle, kNominal},
    {"Fehler = Sollwert abz\u00fcglich Istwert", kTitle, kNominal},
    {"Soll minus Ist", kTitle, kNominal},
    {"Abweichung = Ist - Soll; Korrektur = Soll - Ist", kTitle, kActual},
    {"Abweichung = Ist minus Soll", kTitle, kActual},
    {"Vorzeichen: Ist - Soll", kTitle, kActual},
    {"Deviation = measured minus commanded", kTitle, kActual},
    {"Abweichung = Maschine - Laser", kTitle, kNominal},
    {"Fehler = Anzeige Steuerung - Laser", kTitle, kNominal},
    {"Error = CNC - laser", kTitle, kNominal},
    {"Abweichung = Laser - Maschine", kTitle, kActual},
    // Headings are about their column.
    {"Abweichung (Soll-Ist) 1+ [um]", kHeading, kNominal},
    {"Position error (cmd-act)", kHeading, kNominal},
    {"Soll-Ist X [um]", kHeading, kNominal},
    {"Soll-Ist", kHeading, kNominal},
    {"Abweichung X Soll\u2013Ist [um]", kHeading, kNominal},
    {"Abweichung X = Soll minus Ist [um]", kHeading, kNominal},
    {"Abw. X (Soll \u2212 Ist) [\u00b5m]", kHeading, kNominal},
    {"Target - Actual Y (mm)", kHeading, kNominal},
    {"nominal \u2013 actual [um]", kHeading, kNominal},
    {"Korrektur X (Soll-Ist) [um]", kHeading, kNominal},
    {"Ist-Soll X [um]", kHeading, kActual},
    {"Ist minus Soll X [um]", kHeading, kActual},
    {"Actual-Nominal", kHeading, kActual},
    {"Ist-Soll-Abweichung X [um]", kHeading, kNothing},
    // No sign.
    {"Soll-Ist-Vergleich", kTitle, kNothing},
    {"Soll-Ist Vergleich X-Achse", kTitle, kNothing},
    {"Vergleich: Soll - Ist", kTitle, kNothing},
    {"nominal-actual comparison", kTitle, kNothing},
    {"Korrektur = Soll - Ist", kTitle, kNothing},
    {"Messung Soll/Ist", kTitle, kNothing},
    {"Maschine: DMU 50 - Laser: XL-80", kTitle, kNothing},
    {"Soll X [mm]", kHeading, kNothing},
    {"X-Ist [mm]", kHeading, kNothing},
    {"Abweichung X [um]", kHeading, kNothing},
    {"1- [um]", kHeading, kNothing},
    {"Abw. - [\u00b5m]", kHeading, kNothing},
    {"Soll-Ist Soll X [mm]", kHeading, kNothing},
    {"Abweichungen Portal 4 - Laser XL-80", kTitle, kNothing},
    {"Abweichung X-Achse - Laser", kTitle, kNothing},
    // The sign by the length that the machine travels.
    {"positiv, wenn zu kurz", kTitle, kNominal},
    {"positive when short", kTitle, kNominal},
    {"Bemerkung: + = zu lang", kTitle, kActual},
    {"zu kurz = +, zu lang = -", kTitle, kNominal},
    {"negativ, wenn zu kurz; positiv, wenn zu lang", kTitle, kActual},
    {"Abweichung positiv = Achse fährt zu weit", kTitle, kActual},
    {"Abw. X (positiv = zu kurz) [um]", kHeading, kNominal},
    {"positiv, wenn zu kurz; negativ, wenn zu kurz", kTitle, kUnclear},
    {"kurze Messung, Ergebnis positiv", kTitle, kNothing},
    {"Taster kurz, Ergebnis positiv", kTitle, kUnclear},
    // A comparison of both.
    {"Abweichung positiv, wenn Ist kleiner als Soll", kTitle, kNominal},
    {"+ = Istma\u00df kleiner als Sollma\u00df", kTitle, kNominal},
    {"Ist gr\u00f6\u00dfer als Soll = negativ", kTitle, kNominal},
    {"Vorzeichen: plus, wenn Ist unter Soll liegt", kTitle, kNominal},
    {"Error is positive when the actual position is less than the target", kTitle, kNominal},
    {"positiv: Soll < Ist", kTitle, kActual},
    {"Vorzeichen: + bedeutet Istweg zu klein", kTitle, kNominal},
    {"Minuszeichen: Ma\u00df zu gro\u00df", kTitle, kNominal},
    {"+ = Istma\u00df zu gro\u00df", kTitle, kActual},
    // A sign that cannot be decided.
    {"Abweichungen Maschine - Laser", kTitle, kUnclear},
    {"Soll-Ist-Abweichung X [um]", kHeading, kUnclear},
    {"Soll-Ist-Differenz", kTitle, kUnclear},
    {"Soll-Ist-Vergleich X [um]", kHeading, kUnclear},
    {"Messprotokoll Soll - Ist", kTitle, kUnclear},
    {"Abweichung Soll zu Ist", kTitle, kUnclear},
    {"Abw. Soll/Ist X [um]", kHeading, kUnclear},
    {"Abweichung = Referenz - Messwert", kTitle, kUnclear},
    {"Abweichung = Soll - Pr\u00fcfling", kTitle, kUnclear},
    {"Abweichung = -(Ist - Soll)", kTitle, kUnclear},
    // A text about the sign that no rule reads.
    {"Vorzeichen umgekehrt (Korrekturwerte)", kTitle, kUnclear},
    {"Korrekturwerte", kTitle, kUnclear},
    {"Abweichung X (Korrektursinn) [um]", kHeading, kUnclear},
    {"Error X (compensation sign) [um]", kHeading, kUnclear},
    {"positiv, wenn Ist das Soll \u00fcberschreitet", kTitle, kUnclear},
    {"positiv, wenn Ist gr\u00f6\u00dfer und negativ, wenn Ist kleiner als Soll", kTitle, kUnclear},
    {"Korrektur positiv, wenn Ist kleiner als Soll", kTitle, kUnclear},
    {"positiv, wenn Ist nicht kleiner als Soll", kTitle, kUnclear},
    {"Temperatur zu gro\u00df, Ergebnis positiv", kTitle, kUnclear},
    // Not about the sign of deviations.
    {"Messung nach Eingabe der Korrekturwerte", kTitle, kNothing},
    {"Korrekturwerte gel\u00f6scht", kTitle, kNothing},
    {"Verfahrweg gro\u00df, Anfahrt in positiver Richtung", kTitle, kNothing},
    {"Messung an Maschine 4 positiv verlaufen", kTitle, kNothing},
    {"Vorzeichen", kHeading, kNothing},
    {"Abweichung = Soll - Ist, Fehler = Ist - Soll", kTitle, kUnclear},
};

class SignWords : public testing::TestWithParam<Case> {};

TEST_P(SignWords, StateTheSignOrItsDoubt) {
  EXPECT_EQ(static_cast<int>(sign_said(GetParam().text, GetParam().place)),
            static_cast<int>(GetParam().said));
}
INSTANTIATE_TEST_SUITE_P(Texts, SignWords, testing::ValuesIn(kCases));

/// The measured position at X = 100 mm with a deviation of 1.5 um, or the refusal.
std::string read(const std::string& bytes, const std::string& sign = "", SheetWords words = {}) {
  words.sign = sign;
  try {
    const SheetReading reading = read_as_sheet(bytes, "s.csv", words);
    const ImportTable table = table_of_sheet(reading.sheet, reading.table, reading.columns, reading.wishes);
    return table.find("x")->cells.front();
  } catch (const text::InputError& error) {
    return error.what();
  }
}

TEST(SheetSign, TheTitleReversesTheDeviation) {
  EXPECT_EQ(read("Abweichung = Sollwert minus Istwert\nSoll X [mm];Abweichung X [um]\n100;1,5\n"), "99.9985");
  EXPECT_EQ(read("Vorzeichen: Ist - Soll\nSoll X [mm];Abweichung X [um]\n100;1,5\n"), "100.0015");
}

TEST(SheetSign, TheHeadingReversesTheDeviation) {
  EXPECT_EQ(read("Soll X [mm];Soll-Ist X [um]\n100;1,5\n"), "99.9985");
  EXPECT_EQ(read("Soll X [mm];Ist-Soll X [um]\n100;1,5\n"), "100.0015");
}

TEST(SheetSign, RemarksAndCellsOfWordsStateTheSignToo) {
  EXPECT_EQ(read("# Abweichung = Soll - Ist\nSoll X [mm];Abweichung X [um]\n100;1,5\n"), "99.9985");
  EXPECT_EQ(read("Soll X [mm];Abweichung X [um];Bemerkung\n100;1,5;Abweichung = Soll - Ist\n200;1;\n"),
            "99.9985");
}

TEST(SheetSign, SkippedLinesAndTheTitleOfTheFileStateTheSignToo) {
  const std::string table = "Soll X [mm];Abw. X [um]\n100;1,5\n200;1\n";
  SheetWords skip, second;
  skip.skip = 1;
  second.table = 2;
  EXPECT_EQ(read("Abweichung = Soll - Ist\n" + table, "", skip), "99.9985");
  EXPECT_EQ(read("Abweichung = Soll - Ist;\n" + table + "Lauf 2\n" + table, "", second), "99.9985");
}

TEST(SheetSign, AnUnclearSignIsRefusedWithTheOptionThatStatesIt) {
  const std::string table = "Soll X [mm];Soll-Ist-Abweichung X [um]\n100;1,5\n";
  const std::string refused = read(table);
  EXPECT_NE(refused.find("s.csv:1: \"Soll-Ist-Abweichung X [um]\": this text does not state clearly"),
            std::string::npos)
      << refused;
  EXPECT_NE(refused.find("--sign actual-nominal or --sign nominal-actual"), std::string::npos) << refused;
  EXPECT_EQ(read(table, "nominal-actual"), "99.9985");
  EXPECT_EQ(read(table, "actual-nominal"), "100.0015");
}

TEST(SheetSign, ATitleAgainstTheHeadingIsUnclear) {
  EXPECT_NE(read("Abweichung = Soll - Ist\nSoll X [mm];Abw. X (Ist-Soll) [um]\n100;1,5\n").find("--sign"),
            std::string::npos);
}

TEST(SheetSign, TooShortOnNegativePositionsMeansAnActualValueAboveTheNominalOne) {
  const std::string title = "Abweichung positiv, wenn zu kurz\nSoll Z [mm];Abweichung Z [um]\n";
  const auto z = [&](const std::string& rows, const std::string& sign = "") {
    SheetWords words;
    words.sign = sign;
    try {
      const SheetReading reading = read_as_sheet(title + rows, "s.csv", words);
      return table_of_sheet(reading.sheet, reading.table, reading.columns, reading.wishes)
          .find("z")
          ->cells.back();
    } catch (const text::InputError& error) {
      return std::string(error.what());
    }
  };
  EXPECT_EQ(z("0;0,5\n-100;1,5\n"), "-99.9985");
  EXPECT_EQ(z("0;0,5\n100;1,5\n"), "99.9985");
  // Positions on both sides of zero: the side of "short" is not known.
  EXPECT_NE(z("-100;0,5\n100;1,5\n").find("give --sign"), std::string::npos);
  EXPECT_EQ(z("-100;0,5\n100;1,5\n", "actual-nominal"), "100.0015");
}

TEST(SheetSign, TooShortInTheHeadingsOfRunsFollowsTheSideOfThePositionsToo) {
  const auto z = [](const std::string& position) {
    const SheetReading reading = read_as_sheet(
        "Soll Z [mm];1+ (positiv = zu kurz) [um];1- (positiv = zu kurz) [um]\n" + position + ";1,5;1,5\n",
        "s.csv", SheetWords{});
    return table_of_sheet(reading.sheet, reading.table, reading.columns, reading.wishes)
        .find("z")
        ->cells.at(0);
  };
  EXPECT_EQ(z("-100"), "-99.9985");
  EXPECT_EQ(z("100"), "99.9985");
}

TEST(SheetSign, ATextAboutTheSignThatIsNotReadAsksForTheSign) {
  const std::string table = "Soll X [mm];Abweichung X [um]\n100;1,5\n";
  for (const char* title : {"Vorzeichen umgekehrt (Korrekturwerte)\n", "Vorzeichen;umgekehrt\n",
                            "# Korrekturwerte in um\n", "Abweichung im Korrektursinn;;\n"}) {
    const std::string refused = read(title + table);
    EXPECT_NE(refused.find("this text does not state clearly"), std::string::npos) << refused;
    EXPECT_EQ(read(title + table, "nominal-actual"), "99.9985") << title;
  }
  EXPECT_EQ(read("Vorzeichen;Abweichung = Ist - Soll\n" + table), "100.0015");
  EXPECT_EQ(read("Vorzeichen;Ist - Soll\n" + table), "100.0015");
}

TEST(SheetSign, ATextThatIsRefusedHasNoNoteOfASign) {
  const SheetReading reading =
      read_as_sheet("Vorzeichen umgekehrt\nSoll X [mm];Abweichung X [um]\n100;1,5\n", "s.csv", SheetWords{});
  EXPECT_TRUE(reading.sheet.notes.empty());
}

TEST(SheetSign, ALabelOnACoverSheetIsAboutTheNextCell) {
  for (const auto& [text, sign] : {std::pair("+ = zu kurz", kNominal), std::pair("umgekehrt", kUnclear)}) {
    const std::string book = sheet::workbook_of(
        {{"Deckblatt", {{"Vorzeichen", text}}},
         {"X", {{"Soll X [mm]", "Abweichung X [um]"}, {"100", "1.5"}, {"200", "1.5"}, {"300", "1.5"}}}});
    const SheetReading reading = read_as_sheet(book, "b.xlsx", SheetWords{});
    EXPECT_EQ(reading.columns.at(1).turned, sign == kNominal) << text;
    EXPECT_EQ(!reading.columns.at(1).sign_text.empty(), sign == kUnclear) << text;
  }
}

TEST(SheetSign, AMagnitudeHasNoSign) {
  for (const char* heading :
       {"Betrag der Abweichung X [um]", "Absolute error X [um]", "Abweichung X (Betrag) [um]"}) {
    const std::string table = "Soll X [mm];" + std::string(heading) + "\n100;1,5\n";
    EXPECT_NE(read(table).find("a magnitude has no sign"), std::string::npos) << heading;
    EXPECT_NE(read(table, "actual-nominal").find("a magnitude has no sign"), std::string::npos) << heading;
    EXPECT_EQ(read(table + "200;-1\n"), "100.0015") << heading;  // these values have signs
  }
  const std::string table = "Soll X [mm];Abweichung X [um]\n100;1,5\n";
  EXPECT_NE(read("Betr\u00e4ge der Abweichungen\n" + table).find("a magnitude has no sign"),
            std::string::npos);
  EXPECT_EQ(read("Absolutes Messsystem\n" + table), "100.0015");
  SheetWords words;
  words.deviations = {"X=|Abweichung X| [um]"};
  EXPECT_NE(read("Soll X [mm];|Abweichung X| [um]\n100;1,5\n", "", words).find("a magnitude has no sign"),
            std::string::npos);
}

TEST(SheetSign, WithoutDeviationsATitleNeedsNoSign) {
  EXPECT_EQ(read("Messprotokoll Soll - Ist\nSoll X [mm];Ist X [mm]\n100;100,5\n"), "100.5");
}

TEST(SheetSign, AProfileKeepsTheStatedSign) {
  SheetWishes wishes;
  read_sheet_profile(wishes, "sign = nominal-actual\n", "p");
  ASSERT_TRUE(wishes.turned.has_value());
  EXPECT_TRUE(*wishes.turned);
  EXPECT_THROW(read_sheet_profile(wishes, "sign = minus\n", "p"), text::InputError);
}

}  // namespace
}  // namespace vernier::sign_words_test
