// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/words/stated_directions.h"

#include <algorithm>
#include <cstddef>
#include <set>
#include <vector>

#include "tools/import/words/sheet_words.h"
#include "tools/text/numbers.h"
#include "tools/text/words.h"

namespace vernier::importer {
namespace {

using FactWords = std::set<std::string, std::less<>>;

/// Words of a sentence in small letters. A dash between two numbers is the word "bis", arrows are "nach".
std::vector<std::string> words_of_sentence(std::string_view text) {
  std::string spaced = text::in_small_letters(text);
  for (const std::string_view arrow : {std::string_view("->"), std::string_view("\u2192")})
    text::replace_all(spaced, arrow, " nach ");
  text::replace_all(spaced, "\u2013", "-");
  const auto digit = [&](std::size_t at) {
    return at < spaced.size() && std::isdigit(spaced[at] & 0x7f) != 0;
  };
  std::string joined;
  for (std::size_t at = 0; at < spaced.size(); ++at) {
    const bool range = spaced[at] == '-' && at > 0 && digit(at - 1) && digit(at + 1);
    const bool hyphen = spaced[at] == '-' && at > 0 && !digit(at - 1) && spaced[at - 1] != ' ';
    joined += range ? std::string(" bis ") : hyphen ? std::string(" ") : std::string(1, spaced[at]);
  }
  return text::words_in(joined, " \t_/:;,()[]#!\"'");
}

std::string without_point(std::string word) {
  while (word.ends_with('.')) word.pop_back();
  return word;
}

bool any_of(const std::vector<std::string>& words, const FactWords& list) {
  return std::any_of(words.begin(), words.end(),
                     [&](const std::string& word) { return list.contains(without_point(word)); });
}

bool starts(const std::vector<std::string>& words, std::initializer_list<std::string_view> beginnings) {
  return std::any_of(words.begin(), words.end(), [&](const std::string& word) {
    return std::any_of(beginnings.begin(), beginnings.end(),
                       [&](std::string_view one) { return word.starts_with(one); });
  });
}

/// Runs in the plural, and words for their columns or their motion.
bool says_runs(const std::string& word) {
  static const FactWords kRuns = {"läufe",    "laeufe",     "runs",      "messungen",  "messreihen",
                                  "reihen",   "durchgänge", "passes",    "fahrten",    "cycles",
                                  "zyklen",   "messläufe",  "spalten",   "columns",    "measurements",
                                  "serien",   "spalte",     "column",    "durchläufe", "passages",
                                  "richtung", "richtungen", "direction", "directions"};
  return kRuns.contains(word) || says_run(word);
}

/// Directions in sentences. "Ab", "auf", "vor", "plus" and others often mean something else there.
int sense_in_sentence(const std::string& word) {
  static const FactWords kNoDirection = {"1",     "-1",      "+1",      "ab",       "auf",     "up",  "down",
                                         "her",   "rev",     "-",       "pos",      "neg",     "dn",  "tam",
                                         "cw",    "ccw",     "zur",     "hin",      "+",       "vor", "plus",
                                         "minus", "positiv", "negativ", "positive", "negative"};
  static const FactWords kForthAlso = {"hinwärts", "forwards", "hinfahrten", "vorwärtsfahrt"},
                         kBackAlso = {"backwards", "return", "rückwärtsfahrt", "rückfahrten", "returning"};
  if (kForthAlso.contains(word)) return 1;
  if (kBackAlso.contains(word)) return -1;
  return kNoDirection.contains(word) ? 0 : sense_said(word);
}

/// The directions of a sentence in their order. "Hin", "her", "vor", signs and heights are directions only
/// beside their counterpart: "hin und her", "vor und zurück", "+ und -".
struct Sense {
  std::size_t at = 0;
  int sense = 0;
  bool way = false;
};

std::vector<Sense> senses_in(const std::vector<std::string>& words) {
  std::vector<Sense> found;
  const bool pair =
      any_of(words, {"hin", "vor"}) && any_of(words, {"her", "zurück", "zurueck", "rück", "rueck"});
  const bool heights = any_of(words, {"auf", "up"}) && any_of(words, {"ab", "down"});
  const bool signs = any_of(words, {"+"}) && any_of(words, {"-"});
  // "From below" and "von oben": only both together are directions.
  const auto side_at = [&](std::size_t k) {
    if (k == 0 || (words[k - 1] != "from" && words[k - 1] != "von")) return 0;
    const std::string word = without_point(words[k]);
    return word == "below" || word == "unten" ? 1 : word == "above" || word == "oben" ? -1 : 0;
  };
  bool below = false, above = false;
  for (std::size_t k = 0; k < words.size(); ++k) {
    below |= side_at(k) > 0;
    above |= side_at(k) < 0;
  }
  for (std::size_t k = 0; k < words.size(); ++k) {
    const std::string word = without_point(words[k]);
    const bool by_pair = (pair && (word == "hin" || word == "her" || word == "vor")) ||
                         (signs && (word == "+" || word == "-")) ||
                         (heights && (word == "auf" || word == "ab" || word == "up" || word == "down"));
    const int side = below && above ? side_at(k) : 0;
    const int sense = side != 0 ? side : by_pair ? sense_said(word) : sense_in_sentence(word);
    if (sense == 0) continue;
    const bool way = says_way(word) || sense_said(word) == 0;
    found.push_back({k, sense, way});
  }
  return found;
}

std::optional<int> whole_number(const std::string& written) {
  const std::string word = without_point(written);
  if (!is_run_number(word)) return std::nullopt;
  const auto number = text::parse_number(word);
  return number ? std::optional(static_cast<int>(*number)) : std::nullopt;
}

/// "Läufe 1 und 3 vorwärts, 2 und 4 rückwärts", "forward: 1 to 3, back: 4 to 6", "ungerade Läufe vor, gerade
/// zurück".
StatedDirections by_number(const std::vector<std::string>& words, const std::vector<Sense>& senses) {
  static const FactWords kOdd = {"odd", "ungerade", "ungeraden"}, kEven = {"even", "gerade", "geraden"},
                         kTo = {"bis", "to", "through"};
  if (senses.size() < 2 || std::none_of(words.begin(), words.end(), says_runs)) return {};
  StatedDirections stated;
  stated.kind = StatedDirections::Kind::kByNumber;
  std::vector<int> pending;
  int odd = 0, even = 0, sense = 0;  // sense: of a direction before its numbers
  std::size_t next = 0, last_number = words.size();
  const auto number_at = [&](std::size_t k) {
    return whole_number(words[k]).has_value() || kOdd.contains(words[k]) || kEven.contains(words[k]);
  };
  // "3 Läufe vorwärts" is a count.
  for (std::size_t k = 0; k + 1 < words.size(); ++k)
    if (whole_number(words[k]) && says_runs(words[k + 1])) {
      StatedDirections count;
      count.kind = StatedDirections::Kind::kUnclear;
      count.count = true;
      return count;
    }
  std::size_t first = 0;
  while (first < words.size() && !number_at(first)) ++first;
  if (first == words.size()) return {};
  const bool sense_first = senses.front().at < first;
  bool pending_odd = false, pending_even = false;
  const auto settle = [&](int of) {
    for (const int run : pending) stated.of_run.emplace_back(run, of);
    odd = pending_odd ? of : odd;
    even = pending_even ? of : even;
    pending.clear();
    pending_odd = pending_even = false;
  };
  for (std::size_t k = 0; k < words.size(); ++k) {
    if (next < senses.size() && senses[next].at == k) {
      stated.way |= senses[next].way;
      if (sense_first) settle(sense);
      sense = senses[next++].sense;
      if (!sense_first) settle(sense);
    } else if (kOdd.contains(words[k])) {
      pending_odd = true;
    } else if (kEven.contains(words[k])) {
      pending_even = true;
    } else if (const auto run = whole_number(words[k])) {
      const bool range = last_number + 2 == k && kTo.contains(words[k - 1]) && !pending.empty();
      for (int between = range ? pending.back() + 1 : *run; between < *run; ++between)
        pending.push_back(between);
      pending.push_back(*run);
      last_number = k;
    }
  }
  if (sense_first) settle(sense);
  if (odd != 0 && even == -odd) {
    stated.kind = StatedDirections::Kind::kAlternating;
    stated.first = odd;
    return stated;
  }
  constexpr std::size_t kFewest = 2;  // runs: one alone is a title of this run
  std::set<int> runs;                 // a run with two directions is no run
  for (const auto& [run, of] : stated.of_run) runs.insert(run);
  if (runs.size() < kFewest || runs.size() < stated.of_run.size()) return {};
  return stated;
}

/// A number in words, for "die ersten beiden".
int count_said(const std::string& word) {
  static const std::vector<FactWords> kCounts = {{"beiden", "zwei", "two", "both"},
                                                 {"drei", "three"},
                                                 {"vier", "four"},
                                                 {"fünf", "five"},
                                                 {"sechs", "six"}};
  for (std::size_t k = 0; k < kCounts.size(); ++k)
    if (kCounts[k].contains(word)) return static_cast<int>(k) + 2;
  const auto number = whole_number(word);
  return number ? *number : 0;
}

/// "Die ersten beiden Spalten vorwärts, die letzten beiden rückwärts", "first three runs up, last three
/// down".
StatedDirections first_and_last_runs(const std::vector<std::string>& words) {
  static const FactWords kFirst = {"ersten", "first", "vorderen", "linken"},
                         kLast = {"letzten", "last", "hinteren", "rechten", "übrigen", "remaining"};
  const std::vector<Sense> senses = senses_in(words);
  if (senses.size() != 2 || senses[0].sense == senses[1].sense ||
      std::none_of(words.begin(), words.end(), says_runs))
    return {};
  StatedDirections stated;
  std::size_t first = 0, last = 0;
  for (std::size_t k = 0; k + 1 < words.size(); ++k) {
    if (kFirst.contains(words[k]) && stated.first_runs == 0)
      stated.first_runs = count_said(words[k + 1]), first = k;
    if (kLast.contains(words[k]) && stated.last_runs == 0)
      stated.last_runs = count_said(words[k + 1]), last = k;
  }
  if (stated.first_runs == 0 || stated.last_runs == 0) return {};
  stated.kind = StatedDirections::Kind::kFirstRuns;
  stated.first = first < last ? senses[0].sense : senses[1].sense;
  stated.way = senses[0].way;
  return stated;
}

bool says_opposite(const std::vector<std::string>& words) {
  static const FactWords kOpposite = {"entgegengesetzter", "entgegengesetzte", "umgekehrter",
                                      "umgekehrte",        "anderer",          "opposite",
                                      "reverse",           "reversed",         "other"};
  for (std::size_t k = 0; k < words.size(); ++k) {
    const std::string word = without_point(words[k]);
    if (word == "gegenrichtung" || word == "rückhub") return true;
    const std::string next = k + 1 < words.size() ? without_point(words[k + 1]) : "";
    if (kOpposite.contains(word) && (next == "richtung" || next == "direction")) return true;
    if (word == "return" && (next == "stroke" || next == "strokes" || next == "runs" || next == "passes"))
      return true;
  }
  return false;
}

/// "Läufe 3 und 4 in Gegenrichtung": the other runs go forward.
StatedDirections runs_against_the_others(const std::vector<std::string>& words) {
  static const FactWords kTo = {"bis", "to", "through"}, kAnd = {"und", "and", "&", "lauf", "run"};
  if (!says_opposite(words) || !senses_in(words).empty()) {
    // "return strokes" has the direction in its word.
    const std::vector<Sense> senses = senses_in(words);
    if (!says_opposite(words) ||
        std::any_of(senses.begin(), senses.end(), [](const Sense& one) { return one.sense > 0; }))
      return {};
  }
  StatedDirections stated;
  std::size_t k = 0;
  while (k < words.size() && !(says_runs(words[k]) && k + 1 < words.size() && whole_number(words[k + 1])))
    ++k;
  bool range = false;
  for (++k; k < words.size(); ++k) {
    const auto run = whole_number(words[k]);
    if (!run && !kTo.contains(words[k]) && !kAnd.contains(words[k])) break;
    if (run && range && !stated.of_run.empty())
      for (int between = stated.of_run.back().first + 1; between < *run; ++between)
        stated.of_run.emplace_back(between, -1);
    if (run) stated.of_run.emplace_back(*run, -1);
    range = kTo.contains(words[k]);
  }
  if (stated.of_run.empty()) return {};
  stated.kind = StatedDirections::Kind::kByNumber;
  stated.others = 1;
  stated.assumed = stated.way = true;
  return stated;
}

/// "Jeder zweite Lauf in Gegenrichtung", "even-numbered runs are the return strokes", "nach jedem Lauf wurde
/// die Richtung gewechselt": the first run goes forward.
StatedDirections every_second_run(const std::vector<std::string>& words) {
  static const FactWords kEven = {"even", "gerade", "geraden", "geradzahlige", "geradzahligen"},
                         kOdd = {"odd", "ungerade", "ungeraden", "ungeradzahlige", "ungeradzahligen"},
                         kEach = {"jeder", "jede", "jeden", "every", "jedem", "each"},
                         kSecond = {"zweite", "zweiten", "second", "other", "zweiter"},
                         kBetween = {"nach", "after", "zwischen", "between"};
  if (any_of(words, {"nicht", "not", "nie", "never", "ohne", "without"}) ||
      std::none_of(words.begin(), words.end(), says_runs))
    return {};
  bool second = false, between = false;
  for (std::size_t k = 0; k + 1 < words.size(); ++k) {
    second |= kEach.contains(words[k]) && kSecond.contains(words[k + 1]);
    between |= kBetween.contains(words[k]) && kEach.contains(words[k + 1]) && k + 2 < words.size() &&
               says_run(without_point(words[k + 2]));
  }
  const bool even = any_of(words, kEven), odd = any_of(words, kOdd);
  const std::vector<Sense> senses = senses_in(words);
  const bool forth =
      std::any_of(senses.begin(), senses.end(), [](const Sense& one) { return one.sense > 0; });
  const bool back = std::any_of(senses.begin(), senses.end(), [](const Sense& one) { return one.sense < 0; });
  StatedDirections stated;
  stated.assumed = stated.way = true;
  const bool changed =
      between &&
      any_of(words, {"richtung", "fahrtrichtung", "direction", "verfahrrichtung", "anfahrrichtung"}) &&
      starts(words, {"gewechselt", "umgekehrt", "geändert", "umgeschaltet", "change", "revers", "altern",
                     "switch", "gedreht"});
  if ((second || even != odd) && !forth && (says_opposite(words) || (back && (even != odd || second)))) {
    stated.kind = StatedDirections::Kind::kAlternating;
    stated.first = odd ? -1 : 1;
  } else if (changed && senses.empty()) {
    stated.kind = StatedDirections::Kind::kAlternating;
    stated.first = 1;
  }
  return stated.kind == StatedDirections::Kind::kNothing ? StatedDirections{} : stated;
}

/// True for words of directions that alternate from run to run.
bool says_alternating(const std::vector<std::string>& words) {
  return starts(words,
                {"abwechseln", "wechselweise", "wechselnd", "alternier", "alternating", "alternately"}) ||
         any_of(words, {"wechsel", "alternate", "alternates"});
}

bool says_one_way(const std::vector<std::string>& words) {
  const bool one = any_of(words, {"einer", "one", "gleicher", "same", "single", "derselben"}) &&
                   any_of(words, {"richtung", "direction"});
  return one || starts(words, {"unidirek", "unidirec"});
}

/// "Spalte zurück von unten nach oben lesen", "return column is listed bottom to top", "Rückweg: der oberste
/// Wert gehört zur letzten Position".
bool reads_upwards(const std::vector<std::string>& words) {
  const bool negated = any_of(words, {"nicht", "not", "kein"});
  const bool read =
      any_of(words, {"lesen", "gelesen", "read", "listed", "notiert", "aufgeschrieben", "written",
                     "eingetragen", "entered", "zu", "spalte", "column", "werte", "values"});
  for (std::size_t k = 0; k + 2 < words.size(); ++k) {
    const bool turned =
        (words[k] == "unten" && words[k + 1] == "nach" && without_point(words[k + 2]) == "oben") ||
        (words[k] == "bottom" && words[k + 1] == "to" && without_point(words[k + 2]) == "top");
    if (turned && read && !negated) return true;
  }
  const bool top = any_of(words, {"oberste", "oberster", "erste", "erster", "top", "topmost", "first"}),
             belongs = any_of(words, {"gehört", "belongs", "ist", "is"}),
             last = any_of(words, {"letzten", "letzte", "last", "größten", "hintersten", "farthest"}),
             position = any_of(words, {"position", "ziel", "zielposition", "target", "sollposition"}),
             value = any_of(words, {"wert", "value", "reading", "ablesung", "zeile", "row"});
  return top && belongs && last && position && value && !negated;
}

/// True for "previous target", "vorigen Position", "Vorposition": the position before.
bool names_position_before(const std::vector<std::string>& words) {
  static const FactWords kPlaces = {"position", "target",  "point",        "station",      "step",
                                    "value",    "schritt", "zielpunkt",    "punkt",        "messpunkt",
                                    "stelle",   "reading", "sollposition", "zielposition", "wert"};
  for (std::size_t k = 0; k < words.size(); ++k) {
    if (starts({words[k]}, {"vorposition", "vorgängerposition", "vorpunkt"})) return true;
    const bool before = starts(
        {words[k]}, {"previous", "preceding", "vorig", "vorherig", "vorangehend", "vorhergehend", "letzten"});
    if (before && k + 1 < words.size() && kPlaces.contains(without_point(words[k + 1]))) return true;
  }
  return false;
}

}  // namespace

int StatedDirections::of(int run, int runs) const {
  switch (kind) {
    case Kind::kAlternating:
      return run % 2 != 0 ? first : -first;
    case Kind::kByNumber:
      for (const auto& [number, sense] : of_run)
        if (number == run) return sense;
      return others;
    case Kind::kFirstRuns:
      if (first_runs + last_runs != runs) return 0;
      return run <= first_runs ? first : -first;
    case Kind::kAll:
      return first;
    case Kind::kNothing:
    case Kind::kUnclear:
      break;
  }
  return 0;
}

StatedDirections directions_stated(std::string_view text) {
  const std::vector<std::string> words = words_of_sentence(text);
  for (auto* const rule : {first_and_last_runs, runs_against_the_others, every_second_run})
    if (StatedDirections stated = rule(words); stated.kind != StatedDirections::Kind::kNothing) return stated;
  const std::vector<Sense> senses = senses_in(words);
  std::set<int> different;
  bool way = false;
  for (const Sense& one : senses) {
    different.insert(one.sense);
    way |= one.way;
  }
  StatedDirections stated = by_number(words, senses);
  if (stated.kind != StatedDirections::Kind::kNothing) return stated;
  stated.way = way;
  if (says_alternating(words)) {
    if (different.size() == 2) {
      stated.kind = StatedDirections::Kind::kAlternating;
      stated.first = senses.front().sense;
      return stated;
    }
    const bool about = any_of(words, {"richtung", "richtungen", "direction", "directions", "anfahrrichtung",
                                      "anfahrt", "approach"});
    if (about || !senses.empty()) stated.kind = StatedDirections::Kind::kUnclear;
    return stated;
  }
  static const FactWords kAll = {"alle",  "all",  "nur",       "only",   "jeder",
                                 "every", "each", "sämtliche", "jeweils"};
  static const FactWords kMoved = {"gemessen",   "measured", "gefahren", "angefahren",
                                   "approached", "driven",   "traversed"};
  const bool runs = std::any_of(words.begin(), words.end(), says_runs) || any_of(words, kMoved);
  if (different.size() == 1 && runs && any_of(words, kAll)) {
    stated.kind = StatedDirections::Kind::kAll;
    stated.first = senses.front().sense;
    return stated;
  }
  if (different.size() < 2 && says_one_way(words)) {
    stated.one_way = true;
    stated.kind = StatedDirections::Kind::kUnclear;
    if (different.size() == 1) {
      stated.kind = StatedDirections::Kind::kAll;
      stated.first = senses.front().sense;
    }
    return stated;
  }
  return stated;
}

std::map<std::string, int> direction_codes_stated(std::string_view text) {
  std::string spaced = text::in_small_letters(text);
  for (const std::string_view minus : {"\u2212", "\u2013"}) text::replace_all(spaced, minus, "-");
  for (const char* sign : {"=", ":"}) text::replace_all(spaced, sign, std::string(" = "));
  const std::vector<std::string> words = text::words_in(spaced, " \t,;/()[]\"'");
  std::map<std::string, int> codes;
  constexpr std::size_t kLongest = 2;  // letters of a code: "-1", "a"
  const auto sense = [](const std::string& word) {
    return word.size() > 2 ? sense_said(without_point(word)) : 0;
  };
  for (std::size_t k = 1; k + 1 < words.size(); ++k) {
    if (words[k] != "=") continue;
    const std::string &left = words[k - 1], &right = words[k + 1];
    const bool forth = left.size() <= kLongest && sense(right) != 0;
    const bool back = right.size() <= kLongest && sense(left) != 0;
    if (!forth && !back) continue;
    if (!codes.emplace(forth ? left : right, forth ? sense(right) : sense(left)).second) return {};
  }
  if (codes.size() != 2 || codes.begin()->second == codes.rbegin()->second) return {};
  return codes;
}

BackOrder back_order_stated(std::string_view text, std::pair<double, double> span) {
  const std::vector<std::string> words = words_of_sentence(text);
  bool back = starts(words, {"rück", "rueck", "return"}) || any_of(words, {"zurück", "zurueck"}),
       forth = false;
  for (const Sense& one : senses_in(words)) (one.sense < 0 ? back : forth) = true;
  // "Von 300 nach 0": the positions of the first and of the last reading.
  static const FactWords kTo = {"nach", "bis", "to", "auf", "zu", "until", "down"};
  bool falls = false, rises = false;
  for (std::size_t k = 1; k + 1 < words.size(); ++k) {
    if (!kTo.contains(words[k])) continue;
    std::size_t next = k + 1;
    while (next + 1 < words.size() && kTo.contains(words[next])) ++next;
    const std::size_t before = words[k - 1] == "mm" && k > 1 ? k - 2 : k - 1;
    const auto from = text::parse_number(without_point(words[before])),
               to = text::parse_number(without_point(words[next]));
    if (!from || !to || std::min(*from, *to) != span.first || std::max(*from, *to) != span.second) continue;
    (*from > *to ? falls : rises) = true;
  }
  const bool compound = starts(words, {"messreihenfolge", "messfolge"});
  const bool order =
      compound || starts(words, {"reihenfolge", "abfolge"}) || any_of(words, {"order", "sequence"});
  const bool measured =
      compound || starts(words, {"messung", "gemessen", "measur", "aufnahme", "zeitlich", "chronolog"}) ||
      any_of(words, {"taken", "recorded", "time", "acquisition"});
  const bool turned = starts(words, {"umgekehrt", "revers", "rückwärts", "invert", "opposite"});
  const bool listed =
      any_of(words, {"werte", "values", "spalte", "column", "readings", "messwerte", "anzeigen"});
  if (rises && !falls) return BackOrder::kNothing;  // in the order of the positions
  if (back && !forth && reads_upwards(words)) return BackOrder::kReversed;
  // "Messreihenfolge: Rücklauf zuerst" and "nicht in der Reihenfolge" state another thing.
  const bool other =
      turned || any_of(words, {"zuerst", "danach", "dann", "first", "then", "nicht", "not", "kein"});
  if (order && measured && back && !forth && !other) return BackOrder::kReversed;
  // "Gemessen in umgekehrter Reihenfolge" is about the motion, or about the table.
  const bool unclear = (order && (measured || (turned && back))) || (back && falls && listed);
  return unclear ? BackOrder::kUnclear : BackOrder::kNothing;
}

bool states_increments(std::string_view text, bool heading) {
  const std::vector<std::string> words = words_of_sentence(text);
  if (reads_upwards(words)) return false;  // "der oberste Wert gehört zur letzten Position"
  if (names_position_before(words)) return true;
  if (starts(words, {"schrittfehler", "schrittabweich", "schrittdiff", "einzelschrittfehler",
                     "einzelschrittabweich", "inkrementfehler", "inkrementabweich"}))
    return true;
  // "Increment" in a title is often the step of the positions, or that of an encoder.
  if (heading && starts(words, {"incremental", "increment", "inkrement"})) return true;
  const bool deviation = heading || std::any_of(words.begin(), words.end(), [](const std::string& word) {
                           return says_deviation(without_point(word)) ||
                                  word.find("abweichung") != word.npos || word.find("fehler") != word.npos;
                         });
  const bool encoder = starts(words, {"geber", "messsystem", "encoder", "maßstab", "scale", "drehgeber"});
  if (!deviation) return false;
  if (!encoder && starts(words, {"inkrementell", "incremental"})) return true;
  static const FactWords kEach = {"je", "pro", "per", "jedem", "jeden", "jeder", "each", "every"},
                         kSteps = {"schritt",   "schrittes", "schritten",  "step",      "steps",
                                   "intervall", "interval",  "inkrement",  "increment", "pitch",
                                   "steigung",  "teilung",   "teilschritt"};
  for (std::size_t k = 0; k + 1 < words.size(); ++k) {
    const std::string next = without_point(words[k + 1]);
    if (kEach.contains(words[k]) && kSteps.contains(next)) return true;
    if ((words[k] == "step" || words[k] == "schritt") && says_deviation(next)) return true;
    if (kSteps.contains(words[k]) && k + 2 < words.size() && words[k + 2] == words[k]) return true;
  }
  return false;
}

}  // namespace vernier::importer
