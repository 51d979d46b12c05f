// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/words/sheet_words.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <set>

#include "tools/format/columns.h"
#include "tools/text/words.h"

namespace vernier::importer {
namespace {

using WordSet = std::set<std::string, std::less<>>;

const WordSet kTargetWords = {
    "pi",  // P_i of ISO 230-2
    "soll",        "sollwert",    "sollw",         "sollw.",       "target",
    "nominal",     "cmd",         "command",       "commanded",    "position",
    "pos",         "set",         "ziel",          "achse",        "axis",
    "machine",     "maschine",    "nom",           "sollposition", "zielposition",
    "nennmaß",     "nennmass",    "nennwert",      "nennposition", "sollmaß",
    "sollmass",    "kommandiert", "befohlen",      "programmiert", "programmed",
    "demand",      "setpoint",    "vorgabe",       "vorgabewert",  "weg",
    "cote",        "consigne",    "cible",         "posizione",    "quota",
    "nominale",    "comandata",   "posici\u00f3n", "posicion",     "posi\u00e7\u00e3o",
    "poloha",      "pozycja",     "positie",       "l\u00e4ge",    "posisjon",
    "\u4f4d\u7f6e"};
const WordSet kMeasuredWords = {
    "ist",          "istwert",  "istw",        "istw.",    "istposition", "istmaß",    "istmass",
    "measured",     "actual",   "act",         "meas",     "mess",        "messwert",  "gemessen",
    "reading",      "tracker",  "laser",       "read",     "mes",         "messpunkt", "messpunkte",
    "messposition", "istpunkt", "antastpunkt", "misurata", "misurato",    "effettiva"};
/// The position that the control shows.
const WordSet kDisplayWords = {"anzeige",   "angezeigt", "angezeigte",     "anzeigewert", "display",
                               "displayed", "dro",       "digitalanzeige", "indicated",   "readout"};
const WordSet kDeviationWords = {"abweichung", "abweichungen", "deviation", "deviations", "dev", "error",
                                 "errors", "fehler", "err", "delta", "diff", "abw", "differenz", "difference",
                                 "ecart", "\u00e9cart", "\u00e9carts", "scostamento", "scostamenti",
                                 "deviazione", "errore", "errori",
                                 // Greek letters, and the sign of the increment.
                                 "\u0394", "\u03b4", "\u2206"};
const WordSet kCorrectionWords = {"korr", "corr", "comp", "komp"};
constexpr std::array<std::string_view, 4> kCorrectionStarts = {"korrektur", "correction", "kompensation",
                                                               "compensation"};
const WordSet kStateOfCorrectionWords = {
    "nach",           "vor",     "ohne", "mit", "unkorrigiert", "korrigiert", "after",  "before",   "without",
    "with",           "on",      "off",  "ein", "aus",          "aktiv",      "active", "inactive", "w/o",
    "actual-nominal", "ist-soll"};
const WordSet kStraightnessWords = {"straightness", "geradheit", "geradheitsabweichung"};
const WordSet kTiltWords = {"pitch",      "yaw",        "roll",   "nicken", "nickwinkel", "gieren",
                            "gierwinkel", "rollwinkel", "rollen", "wanken", "kippen",     "kippwinkel"};
/// Headings of a column that counts or names its rows.
const WordSet kCountingWords = {"nr",        "no",   "num",   "nummer", "number", "index",  "idx",
                                "id",        "lfd",  "punkt", "punkte", "point",  "points", "pt",
                                "messpunkt", "row",  "zeile", "#",      "n",      "pos.nr", "posnr",
                                "sample",    "pose", "step",  "schritt"};
const WordSet kStatisticWords = {
    "mittel", "mittelwert", "mittelwerte", "mittlere", "mittl", "mean", "average", "avg", "mw",
    "durchschnitt", "stdev", "stdabw", "stabw", "spannweite", "standardabweichung", "means", "averages",
    "moyenne", "écart-type", "mittelwerts", "umkehrspanne", "umkehrspannen", "umkehrfehler", "umkehrspiel",
    // Signs of a mean and of a standard deviation; Ø has no small letter here.
    "x\u0304", "x\u0305", "ø", "Ø", "⌀", "∅", "σ", "2σ", "3σ"};
const WordSet kForthWords = {
    "1",        "+1",           "+",          "forward",   "fwd",       "forth",      "up",
    "pos",      "positive",     "positiv",    "vor",       "vorwärts",  "hin",        "auf",
    "plus",     "cw",           "aller",      "\u2191",    "\u2192",    "hinfahrt",   "hinweg",
    "andata",   "vorlauf",      "ida",        "heen",      "tam",       "prz\u00f3d", "fram",
    "frem",     "\u6b63\u5411", "aufwärts",   "aufwaerts", "upward",    "upwards",    "avanti",
    "steigend", "aufsteigend",  "ansteigend", "ascending", "increasing"};
const WordSet kBackWords = {"-1",
                            "-",
                            "backward",
                            "backwards",
                            "bwd",
                            "back",
                            "reverse",
                            "rev",
                            "down",
                            "neg",
                            "negative",
                            "negativ",
                            "zurück",
                            "zur",
                            "zurueck",
                            "rück",
                            "rueck",
                            "rückwärts",
                            "rückfahrt",
                            "rueckfahrt",
                            "rückweg",
                            "her",
                            "ab",
                            "abwärts",
                            "abwaerts",
                            "downward",
                            "downwards",
                            "retour",
                            "ritorno",
                            "r\u00fccklauf",
                            "ruecklauf",
                            "dn",
                            "vuelta",
                            "volta",
                            "terug",
                            "zp\u011bt",
                            "ty\u0142",
                            "powr\u00f3t",
                            "tillbaka",
                            "tilbake",
                            "tilbage",
                            "indietro",
                            "\u53cd\u5411",
                            "minus",
                            "fallend",
                            "absteigend",
                            "abfallend",
                            "descending",
                            "decreasing",
                            "ccw",
                            "\u2212",
                            "\u2212"
                            "1",
                            "\u2193",
                            "\u2190"};
/// Words of a run, in headings, titles and remarks.
const WordSet kRunWords = {"lauf",  "run",     "messlauf", "messreihe", "messung",     "durchgang",
                           "pass",  "passage", "zyklus",   "cycle",     "measurement", "fahrt",
                           "serie", "series",  "reihe",    "corsa",     "ciclo"};
const WordSet kWayWords = {
    "hin",       "her",        "zurück",       "zur",          "zurueck",    "vor",      "rück",
    "rueck",     "forward",    "fwd",          "forth",        "back",       "backward", "backwards",
    "bwd",       "hinfahrt",   "hinweg",       "rückfahrt",    "rueckfahrt", "rückweg",  "vorwärts",
    "rückwärts", "aller",      "retour",       "andata",       "ritorno",    "vorlauf",  "r\u00fccklauf",
    "ruecklauf", "ida",        "vuelta",       "volta",        "heen",       "terug",    "tam",
    "zp\u011bt", "prz\u00f3d", "ty\u0142",     "powr\u00f3t",  "fram",       "tillbaka", "tilbake",
    "frem",      "tilbage",    "\u6b63\u5411", "\u53cd\u5411", "avanti",     "indietro"};
/// Words of an axis beside its letter.
const WordSet kAxisWords = {"axis", "achse", "axe", "asse", "eje", "eixo", "osa", "o\u015b", "axel", "akse"};

}  // namespace

std::vector<std::string> heading_words(const std::string& name) {
  return text::words_in(name, " \t_-./:;,()[]#+");
}

std::vector<std::string> plain_words(std::string_view text) {
  return text::words_in(text::in_small_letters(text), " \t_-./:;,()[]!?=");
}

std::vector<std::string> words_with_signs(std::string_view text) {
  return text::words_in(text, " \t_./:;,()[]#");
}

bool says_target(const std::string& word) { return kTargetWords.contains(word); }
bool says_measured(const std::string& word) { return kMeasuredWords.contains(word); }
bool says_display(const std::string& word) { return kDisplayWords.contains(word); }
bool says_statistic(const std::string& word) { return kStatisticWords.contains(word); }
bool says_standard_deviation(std::string_view text) {
  // "Écart-type", also without its accent.
  const std::string small = text::in_small_letters(text);
  return small.find("cart-type") != std::string::npos || small.find("cart type") != std::string::npos;
}
/// True for a letter with a bar above it (U+0304, U+0305), the sign of a mean: "x\u0304".
bool has_mean_bar(std::string_view heading) {
  return heading.find("\u0304") != std::string_view::npos || heading.find("\u0305") != std::string_view::npos;
}
bool names_statistic(const sheet::Heading& heading) {
  if (says_standard_deviation(heading.name) || has_mean_bar(heading.text)) return true;
  const std::vector<std::string> words = heading_words(text::in_small_letters(heading.name));
  // "Reversal error" is the difference of the means of both directions (ISO 230-2:2014, 2.11).
  static const WordSet kOfReversal = {"reversal", "error", "value", "span", "b"};
  const bool reversal =
      std::all_of(words.begin(), words.end(), [](const auto& word) { return kOfReversal.contains(word); });
  if (reversal && std::find(words.begin(), words.end(), "reversal") != words.end()) return true;
  return std::any_of(words.begin(), words.end(), says_statistic);
}
bool says_run(const std::string& word) { return kRunWords.contains(word); }
bool is_run_number(std::string_view word) {
  constexpr std::size_t kMostDigits = 3;  // more are a date or a number of a machine
  return !word.empty() && word.size() <= kMostDigits &&
         word.find_first_not_of("0123456789") == std::string_view::npos;
}
bool says_way(const std::string& word) { return kWayWords.contains(word); }
bool says_correction(const std::string& word) {
  return kCorrectionWords.contains(word) ||
         std::any_of(kCorrectionStarts.begin(), kCorrectionStarts.end(),
                     [&](std::string_view start) { return word.starts_with(start); });
}
bool says_state_of_correction(const std::string& word) { return kStateOfCorrectionWords.contains(word); }
bool says_magnitude(std::string_view heading) {
  static const WordSet kWords = {
      "betrag",      "betrags",           "beträge",    "betraege", "absolutbetrag",
      "absolutwert", "absolutabweichung", "absolut",    "absolute", "absoluter",
      "abs",         "magnitude",         "magnitudes", "unsigned", "vorzeichenlos"};
  const std::size_t bar = heading.find('|');
  if (bar != std::string_view::npos && heading.find('|', bar + 1) != std::string_view::npos) return true;
  const std::vector<std::string> words = heading_words(text::in_small_letters(heading));
  return std::any_of(words.begin(), words.end(), [](const auto& word) { return kWords.contains(word); });
}
bool says_magnitude_of_deviation(std::string_view title) {
  const std::vector<std::string> words = heading_words(text::in_small_letters(title));
  return says_magnitude(title) && std::any_of(words.begin(), words.end(), [](const std::string& word) {
           return says_deviation(word) || word.ends_with("abweichungen") || word.ends_with("abweichung");
         });
}
bool says_straightness(const std::string& word) { return kStraightnessWords.contains(word); }
bool says_tilt(const std::string& word) { return kTiltWords.contains(word); }
bool says_counting(const std::string& word) { return kCountingWords.contains(word); }
bool heads_counting(const std::string& heading) {
  const std::vector<std::string> words = heading_words(text::in_small_letters(heading));
  return !words.empty() && std::all_of(words.begin(), words.end(), says_counting);
}
bool says_deviation(const std::string& word) { return kDeviationWords.contains(word); }

bool is_failed_formula(const std::string& cell) {
  static const WordSet kErrors = {"#bezug!",  "#ref!",    "#div/0!", "#wert!",     "#value!",
                                  "#name?",   "#zahl!",   "#num!",   "#null!",     "#leer!",
                                  "#valeur!", "#nombre!", "#spill!", "#überlauf!", "#calc!"};
  return kErrors.contains(text::in_small_letters(cell));
}

bool is_missing(const std::string& cell) {
  static const WordSet kMarks = {"", "-", "--", "---", "n/a", "na", "#nv", "#n/a", "nan"};
  return kMarks.contains(text::in_small_letters(cell)) || is_failed_formula(cell);
}

bool is_axis_direction(std::string_view word) {
  return word.size() == 2 && std::string_view("xyzabcuvwXYZABCUVW").find(word[0]) != std::string_view::npos &&
         (word[1] == '+' || word[1] == '-');
}

int sense_said(std::string_view word) {
  std::string small = text::in_small_letters(word);
  if (is_axis_direction(small)) small.erase(0, 1);
  return kForthWords.contains(small) ? 1 : kBackWords.contains(small) ? -1 : 0;
}

std::string role_said(std::string_view word) {
  static const WordSet kCheck = {format::kCheckRole, "prüfung",    "pruefung",      "prüfen",
                                 "pruefen",          "kontrolle",  "kontrollpunkt", "prüfpunkt",
                                 "validierung",      "validation", "verification",  "verifikation"};
  static const WordSet kFit = {format::kFitRole, "anpassung",    "anpassen",    "ausgleich",
                               "ausgleichung",   "kalibrierung", "calibration", "fitting"};
  const std::string small = text::in_small_letters(word);
  return kCheck.contains(small) ? format::kCheckRole : kFit.contains(small) ? format::kFitRole : "";
}

std::vector<std::string> title_cells(const sheet::Sheet& sheet, const sheet::SheetTable& table) {
  std::vector<std::string> cells;
  const std::size_t end = table.upper_row ? *table.upper_row : table.heading_row;
  for (std::size_t row = 0; table.has_headings && row < end; ++row)
    for (const std::string& cell : sheet.rows[row])
      if (!cell.empty()) cells.push_back(cell);
  return cells;
}

std::string axis_of_sheet_name(const sheet::Sheet& sheet) {
  if (!sheet.workbook) return "";
  std::string axis;
  std::size_t linear = 0, rotary = 0;
  bool axis_word = false;
  for (const std::string& word : heading_words(sheet.sheet)) {
    const std::string small = text::in_small_letters(word);
    axis_word |= small == "axis" || small == "achse" || small == "axe";
    if (small.size() != 1 || std::string_view("xyzuvwabc").find(small) == std::string_view::npos) continue;
    ++(std::string_view("abc").find(small) == std::string_view::npos ? linear : rotary);
    axis = std::string(1, static_cast<char>(std::toupper(static_cast<unsigned char>(small[0]))));
  }
  return linear + rotary == 1 && (linear == 1 || axis_word) ? axis : "";
}

namespace {

std::set<std::string> axes_of_title_cells(const sheet::Sheet& sheet, const sheet::SheetTable& table) {
  std::vector<std::string> words;
  for (const std::string& cell : title_cells(sheet, table)) {
    for (std::string& word : heading_words(cell)) words.push_back(std::move(word));
    words.emplace_back();
  }
  std::set<std::string> found;
  const auto letter = [](const std::string& word) {
    return word.size() == 1 && std::string_view("XYZABCUVW").find(word) != std::string_view::npos;
  };
  for (std::size_t k = 0; k < words.size(); ++k) {
    const std::string small = text::in_small_letters(words[k]);
    if (!kAxisWords.contains(small)) continue;
    // "Achse" and "X" may be in separate cells.
    const std::size_t next = k + 1 < words.size() && words[k + 1].empty() ? k + 2 : k + 1;
    if (k > 0 && letter(words[k - 1]))
      found.insert(words[k - 1]);
    else if (next < words.size() && letter(words[next]))
      found.insert(words[next]);
  }
  return found;
}

std::string only_one_of(const std::set<std::string>& axes) { return axes.size() == 1 ? *axes.begin() : ""; }

}  // namespace

std::string axis_of_title_cells(const sheet::Sheet& sheet, const sheet::SheetTable& table) {
  return only_one_of(axes_of_title_cells(sheet, table));
}

std::string axis_of_titles(const sheet::Sheet& sheet, const sheet::SheetTable& table) {
  const std::set<std::string> titled = axes_of_title_cells(sheet, table);
  return titled.empty() ? axis_of_sheet_name(sheet) : only_one_of(titled);
}

std::string axis_to_try(const sheet::Sheet& sheet, const sheet::SheetTable& table) {
  const std::string axis = axis_of_titles(sheet, table);
  return axis.empty() ? "X" : axis;
}

}  // namespace vernier::importer
