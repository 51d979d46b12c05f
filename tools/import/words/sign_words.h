// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string_view>

namespace vernier::importer {

/// Sign of the deviations of a table, as a text states the sign.
enum class SignSaid {
  kNothing,            // the text states no sign: a deviation is then actual - nominal
  kActualLessNominal,  // "Ist - Soll", "actual minus nominal"
  kNominalLessActual,  // "Soll - Ist", "commanded minus measured"
  kUnclear             // the text names a difference, but its sign cannot be decided: "Soll-Ist-Abweichung"
};

/// Place of a text. The heading of a column is about the values of this column. A title is about the whole
/// table, and may also describe other quantities ("Korrektur = Soll - Ist").
enum class SignPlace { kHeading, kTitle };

/// Side of zero on which the axis of the deviations has its positions. "Too short" means a smaller distance
/// from zero: on the negative side the actual value is then above the nominal one.
enum class Travel { kPositive, kNegative, kBothSides };

/// Returns the sign that a text states for deviations. Dashes of every kind and the words "minus", "less",
/// "weniger" and "abzüglich" are the sign of a difference. "Soll-Ist-Vergleich" (a comparison) states no
/// sign. In a title a difference states the sign only if the title also has a word for deviation or sign, or
/// if the difference follows "=", or has the word "minus" or the sign U+2212; other differences of nominal
/// and actual in a title are kUnclear. A text about the length of the motion ("positiv, wenn zu kurz")
/// depends on `travel`: its sign is kUnclear for positions on both sides of zero.
/// An instrument that counts against the axis ("Messuhr läuft entgegen der Achse") is kNominalLessActual.
/// A comparison ("positiv, wenn Ist kleiner als Soll") is read if it has one sign, and kUnclear otherwise. A
/// text about the sign that no rule reads ("Vorzeichen umgekehrt", "Korrektursinn") is kUnclear.
SignSaid sign_said(std::string_view text, SignPlace place, Travel travel = Travel::kPositive);

/// Returns the sign that two texts about the same deviations state together: kUnclear if they contradict each
/// other.
SignSaid both_signs(SignSaid one, SignSaid other);

/// True for a text that mentions the sign, but states that it is the usual one, or that of another report:
/// "Vorzeichen geprüft und in Ordnung", "No sign change was necessary", "Vorzeichenregel nach ISO 230-1".
bool says_sign_is_usual(std::string_view text);

}  // namespace vernier::importer
