// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/words/sign_words.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "tools/import/words/sheet_words.h"
#include "tools/text/words.h"

namespace vernier::importer {
namespace {

using WordSet = std::set<std::string, std::less<>>;

/// Words before a nominal or an actual value, or behind it, without a meaning for the sign.
const WordSet kBesideOperand = {"position",  "pos",      "positionen", "positions", "value",      "wert",
                                "werte",     "axis",     "achse",      "der",       "die",        "das",
                                "des",       "the",      "values",     "von",       "of",         "maß",
                                "mass",      "lage",     "koordinate", "punkt",     "coordinate", "point",
                                "dimension", "stellung", "anzeige",    "display"};
/// Words of a comparison or of a document: "Soll-Ist-Vergleich" states no sign.
const WordSet kComparisons = {"vergleich", "comparison", "compare", "tabelle",  "table",     "protokoll",
                              "report",    "bericht",    "messung", "liste",    "list",      "daten",
                              "data",      "analyse",    "werte",   "analysis", "vergleiche"};
const WordSet kMinusWords = {"minus", "less", "weniger", "abzüglich", "abzueglich", "abzgl", "abzügl"};
const WordSet kTowards = {"zu", "to", "gegen", "gegenüber", "vs", "versus", "bis"};

/// From kBreak on a part of the text ends.
enum class SignKind { kWord, kMinus, kEquals, kColon, kOpen, kClose, kBreak, kSlash };

struct SignToken {
  SignKind kind = SignKind::kWord;
  std::string word;
  bool strong = false;                  // a minus that is no hyphen: the word, or U+2212
  bool before = false, behind = false;  // a dash without a blank before it, behind it
};

enum class OperandRole { kNone, kAside, kNominal, kActual, kReference };

bool says_nominal(const std::string& word) {
  static const WordSet kWords = {
      "target",   "targets",      "nominal",    "nom",         "cmd",     "command",  "commanded",
      "setpoint", "ziel",         "programmed", "prog",        "desired", "required", "theoretical",
      "vorgabe",  "zielposition", "zielwert",   "theoretisch", "machine", "maschine", "expected",
      "demand",   "steuerung",    "control",    "controller",  "cnc"};
  return kWords.contains(word) || (word.starts_with("soll") && word != "sollte" && word != "sollten") ||
         word.starts_with("nenn") || word.starts_with("nominal");
}

bool says_actual(const std::string& word) {
  static const WordSet kWords = {"measured", "actual", "act",     "meas",     "mess",        "reading",
                                 "real",     "laser",  "tracker", "feedback", "measurement", "messung",
                                 "observed", "read",   "actuals", "readings"};
  if (word.starts_with("ist"))
    for (const char* rest : {"wert", "pos", "ma", "koord", "stell", "punkt", "lage"})
      if (word.substr(3).starts_with(rest)) return true;
  return kWords.contains(word) || word == "ist" || word.starts_with("gemessen") ||
         word.starts_with("messwert") || word.starts_with("messpos");
}

OperandRole role_of(const std::string& word) {
  static const WordSet kReferences = {"reference", "ref", "referenz", "referenzwert"};
  const bool letter =
      word.size() == 1 && std::string_view("xyzabcuvwmp").find(word[0]) != std::string_view::npos;
  if (letter || kBesideOperand.contains(word)) return OperandRole::kAside;
  if (kReferences.contains(word)) return OperandRole::kReference;
  // X_soll, xist: the letter of an axis before the word.
  for (const bool cut : {false, true}) {
    if (cut && (word.size() < 4 || std::string_view("xyzabcp").find(word[0]) == std::string_view::npos))
      break;
    const std::string bare = cut ? word.substr(1) : word;
    if (says_nominal(bare)) return OperandRole::kNominal;
    if (says_actual(bare)) return OperandRole::kActual;
  }
  return OperandRole::kNone;
}

/// A machine or an instrument instead of its position.
bool is_instrument(const std::string& word) {
  static const WordSet kWords = {"machine", "maschine", "steuerung", "control", "cnc", "laser", "tracker"};
  return kWords.contains(word);
}

/// A word for a deviation or for its sign.
bool says_deviation_or_sign(const std::string& word) {
  static const WordSet kWords = {"sign", "signs",  "convention", "konvention", "dx",     "dy",
                                 "dz",   "\u0394", "\u0394x",    "\u0394y",    "\u0394z"};
  return kWords.contains(word) || says_deviation(word) || word.starts_with("vorzeichen") ||
         word.ends_with("abweichung") || word.ends_with("abweichungen") || word.ends_with("fehler") ||
         word.ends_with("differenz");
}

/// SignTokens of a text; a dash between a word and a word beside it ("X-Soll", "Ist-Wert") is left out.
class SignTokens {
 public:
  explicit SignTokens(std::string_view text) {
    const std::string small = text::in_small_letters(text);
    for (std::size_t at = 0; at < small.size();) at += take(small, at);
    flush();
    join();
  }
  const std::vector<SignToken>& list() const { return list_; }

 private:
  /// Reads one sign or one byte of a word; returns the number of bytes.
  std::size_t take(const std::string& text, std::size_t at) {
    static constexpr std::array<std::string_view, 9> kDashes = {
        "-", "\u2212", "\u2010", "\u2011", "\u2012", "\u2013", "\u2014", "\u2015", "\uff0d"};
    // "./." is the commercial minus.
    if (text.compare(at, 3, "./.") == 0) {
      flush();
      list_.push_back({SignKind::kMinus, "", true, false, false});
      return 3;
    }
    for (const std::string_view arrow : {std::string_view("->"), std::string_view("\u2192")})
      if (text.compare(at, arrow.size(), arrow) == 0) {
        flush();
        list_.push_back({SignKind::kWord, "to", false, false, false});
        return arrow.size();
      }
    for (const std::string_view dash : kDashes)
      if (text.compare(at, dash.size(), dash) == 0) {
        flush();
        const auto blank = [&](std::size_t place) { return text[place] == ' ' || text[place] == '\t'; };
        const std::size_t end = at + dash.size();
        const bool again =
            !list_.empty() && list_.back().kind == SignKind::kMinus && at > 0 && !blank(at - 1);
        if (!again)
          list_.push_back({SignKind::kMinus, "", dash == "\u2212", at > 0 && !blank(at - 1),
                           end < text.size() && !blank(end)});
        return dash.size();
      }
    const char c = text[at];
    static const std::string kBlanks = " \t._\"'", kOpens = "([{<", kCloses = ")]}>", kBreaks = ",;/|+*";
    const auto sign = [&](SignKind kind) {
      flush();
      list_.push_back({kind, "", false, false, false});
    };
    if (kBlanks.find(c) != std::string::npos)
      flush();
    else if (kOpens.find(c) != std::string::npos)
      sign(SignKind::kOpen);
    else if (kCloses.find(c) != std::string::npos)
      sign(SignKind::kClose);
    else if (kBreaks.find(c) != std::string::npos)
      sign(c == '/' ? SignKind::kSlash : SignKind::kBreak);
    else if (c == '=' || c == ':')
      sign(c == '=' ? SignKind::kEquals : SignKind::kColon);
    else
      word_ += c;
    return 1;
  }

  void flush() {
    if (word_.empty()) return;
    const bool minus = kMinusWords.contains(word_);
    list_.push_back({minus ? SignKind::kMinus : SignKind::kWord, word_, minus, false, false});
    word_.clear();
  }

  void join() {
    std::vector<SignToken> joined;
    for (std::size_t k = 0; k < list_.size(); ++k) {
      const SignToken& one = list_[k];
      const bool hyphen = one.kind == SignKind::kMinus && !one.strong && one.before && one.behind && k > 0 &&
                          k + 1 < list_.size() && list_[k - 1].kind == SignKind::kWord &&
                          list_[k + 1].kind == SignKind::kWord;
      if (hyphen && (role_of(list_[k - 1].word) == OperandRole::kAside ||
                     role_of(list_[k + 1].word) == OperandRole::kAside))
        continue;
      joined.push_back(one);
    }
    list_ = std::move(joined);
  }

  std::string word_;
  std::vector<SignToken> list_;
};

/// A difference "nominal - actual" or "actual - nominal" in a text.
class Difference {
 public:
  Difference(const std::vector<SignToken>& list, std::size_t minus, SignPlace place)
      : list_(list), minus_(minus), place_(place) {
    left_ = operand(minus, -1);
    right_ = operand(minus, +1);
    find_subject();
  }

  SignSaid said() const {
    const OperandRole a = role(left_), b = role(right_);
    const bool known = (a == OperandRole::kNominal && b == OperandRole::kActual) ||
                       (a == OperandRole::kActual && b == OperandRole::kNominal);
    if (place_ == SignPlace::kTitle && of_correction_) return SignSaid::kNothing;
    if (!known) return states_unknown(a, b) ? SignSaid::kUnclear : SignSaid::kNothing;
    const bool turned = a == OperandRole::kNominal;
    const SignSaid sign = turned ? SignSaid::kNominalLessActual : SignSaid::kActualLessNominal;
    const std::string next = word_behind();
    if (place_ == SignPlace::kHeading && names_operand_behind()) return SignSaid::kNothing;
    if (kComparisons.contains(next) || compared_)
      return place_ == SignPlace::kHeading && turned ? SignSaid::kUnclear : SignSaid::kNothing;
    if (negated_) return SignSaid::kUnclear;
    if (denied_) return turned ? SignSaid::kActualLessNominal : SignSaid::kNominalLessActual;
    const bool strong = list_[minus_].strong;
    if (equals_ || strong) return sign;
    // "Soll-Ist-Abweichung" often means only the deviation of both.
    if (says_deviation_or_sign(next)) return turned ? SignSaid::kUnclear : SignSaid::kNothing;
    if (compound_) return turned ? SignSaid::kUnclear : SignSaid::kNothing;
    // "Abweichungen Maschine - Laser" may only list the two.
    const bool list = is_instrument(list_[*left_].word) || is_instrument(list_[*right_].word);
    if (place_ == SignPlace::kHeading || (of_deviation_ && !list)) return sign;
    return turned ? SignSaid::kUnclear : SignSaid::kNothing;
  }

 private:
  OperandRole role(std::optional<std::size_t> at) const {
    return at ? role_of(list_[*at].word) : OperandRole::kNone;
  }

  /// Index of the word for nominal or actual on one side of the minus, past the words beside it.
  std::optional<std::size_t> operand(std::size_t from, int step) {
    std::size_t at = from;
    for (int passed = 0; passed < 4; ++passed) {
      if (step < 0 && at == 0) return std::nullopt;
      at = step < 0 ? at - 1 : at + 1;
      if (at >= list_.size() || list_[at].kind != SignKind::kWord) return std::nullopt;
      const OperandRole found = role_of(list_[at].word);
      if (found != OperandRole::kAside) return at;
    }
    return std::nullopt;
  }

  /// The words before the difference, up to the beginning of the text or a break.
  void find_subject() {
    std::size_t at = left_ ? *left_ : minus_;
    while (at > 0 && list_[at - 1].kind == SignKind::kWord &&
           role_of(list_[at - 1].word) == OperandRole::kAside)
      --at;
    if (at == 0) return;
    denied_ = list_[at - 1].kind == SignKind::kWord &&
              (list_[at - 1].word == "nicht" || list_[at - 1].word == "not");
    equals_ = list_[at - 1].kind == SignKind::kEquals;
    defined_ = equals_ || list_[at - 1].kind == SignKind::kColon || list_[at - 1].kind == SignKind::kOpen;
    const bool opened = list_[at - 1].kind == SignKind::kOpen;
    negated_ = opened && at > 1 && list_[at - 2].kind == SignKind::kMinus &&
               (at == 2 || list_[at - 3].kind != SignKind::kWord);  // "1- (Soll-Ist)" is a run backward
    bool correction = false, state = false;
    for (std::size_t k = at; k-- > 0 && list_[k].kind < SignKind::kBreak;) {
      const std::string& word = list_[k].word;
      if (list_[k].kind != SignKind::kWord) continue;
      of_deviation_ |= says_deviation_or_sign(word);
      correction |= says_correction(word);
      state |= says_state_of_correction(word);
      compared_ |= word.starts_with("vergleich") || word == "comparison";
    }
    of_correction_ = correction && !of_deviation_ && !state;
  }

  /// The word behind the difference, past the words beside the operand; empty if another sign follows.
  std::string word_behind() const {
    for (std::size_t k = *right_ + 1; k < list_.size(); ++k) {
      if (list_[k].kind == SignKind::kMinus && !list_[k].strong && list_[k].before && list_[k].behind) {
        compound_ = true;
        continue;
      }
      if (list_[k].kind != SignKind::kWord) return "";
      if (role_of(list_[k].word) != OperandRole::kAside) return list_[k].word;
    }
    return "";
  }

  /// "Soll-Ist" above "Soll X": the upper line of headings only groups the columns.
  bool names_operand_behind() const {
    for (std::size_t k = *right_ + 1; k < list_.size(); ++k)
      if (const OperandRole role = role_of(list_[k].word);
          role == OperandRole::kNominal || role == OperandRole::kActual)
        return true;
    return false;
  }

  /// A definition of the deviation with words that are not known: "Abweichung = Referenz - Messwert".
  bool states_unknown(OperandRole a, OperandRole b) const {
    const SignToken& minus = list_[minus_];
    const bool spaced = minus.strong || (!minus.before && !minus.behind);
    if (!spaced || !of_deviation_ || !left_ || !right_) return false;
    if (a == OperandRole::kNone && b == OperandRole::kNone) return equals_;
    return (defined_ || minus.strong) && a != b;
  }

  const std::vector<SignToken>& list_;
  std::size_t minus_;
  SignPlace place_;
  std::optional<std::size_t> left_, right_;
  bool defined_ = false;  // the difference follows = : or a bracket
  bool equals_ = false, negated_ = false, compared_ = false;
  bool denied_ = false;  // "nicht Soll - Ist"
  bool of_deviation_ = false, of_correction_ = false;
  mutable bool compound_ = false;
};

/// "Abweichung Soll zu Ist" and "Abw. Soll/Ist" name an order, but no sign.
bool leads_from_nominal_to_actual(const std::vector<SignToken>& list) {
  const bool deviation = std::any_of(list.begin(), list.end(), [](const SignToken& one) {
    return one.kind == SignKind::kWord && says_deviation_or_sign(one.word);
  });
  for (std::size_t k = 1; deviation && k + 1 < list.size(); ++k)
    if ((kTowards.contains(list[k].word) || list[k].kind == SignKind::kSlash) &&
        role_of(list[k - 1].word) == OperandRole::kNominal &&
        role_of(list[k + 1].word) == OperandRole::kActual)
      return true;
  return false;
}

/// Words of a text about a size; "=", "<", ">", "+" and "-" are words too.
std::vector<std::string> words_about_size(std::string_view text) {
  std::string spaced;
  char before = ' ';
  for (const char c : text::in_small_letters(text)) {
    if (c == '>' && (before == '-' || before == '=')) {
      spaced += " to ";  // an arrow
    } else if (c == '=' || c == ':') {
      spaced += " = ";
    } else if (c == '<' || c == '>') {
      spaced += std::string(" ") + c + " ";
    } else {
      spaced += c;
    }
    before = c;
  }
  std::vector<std::string> words = text::words_in(spaced, " \t_./;,()[]\"'|");
  for (std::string& word : words)
    if (word == "\u2212" || word == "\u2013") word = "-";
  return words;
}

/// The sign that a word states: 1 for positive, -1 for negative, 0 for other words.
int sign_of_word(const std::string& word) {
  if (word.starts_with("positiv") || word == "plus" || word == "pluszeichen" || word == "+") return 1;
  return word.starts_with("negativ") || word == "minus" || word == "minuszeichen" || word == "-" ? -1 : 0;
}

/// Words between a sign and its meaning.
bool says_meaning(const std::string& word) {
  static const WordSet kWords = {"wenn", "falls", "bei", "bedeutet", "heißt", "heisst",
                                 "if",   "when",  "for", "means",    "=",     "entspricht"};
  return kWords.contains(word);
}

/// True for the word of a sign, and for "plus", "minus", "+" and "-" if the text states their meaning.
bool states_sign(const std::vector<std::string>& words, std::size_t k) {
  if (sign_of_word(words[k]) == 0) return false;
  if (words[k].size() > 5) return true;
  return (k + 1 < words.size() && says_meaning(words[k + 1])) || (k > 0 && says_meaning(words[k - 1]));
}

bool is_negated(const std::vector<std::string>& words) {
  static const WordSet kWords = {"nicht", "not", "kein", "keine", "no", "isn't"};
  return std::any_of(words.begin(), words.end(), [](const auto& word) { return kWords.contains(word); });
}

/// A text about corrections, whose sign is not the sign of the deviations.
bool is_about_correction(const std::vector<std::string>& words) {
  return std::any_of(words.begin(), words.end(), says_correction) &&
         std::none_of(words.begin(), words.end(), says_state_of_correction);
}

/// 1 for a word of a comparison such as "größer", -1 for "kleiner", 0 for other words.
int comparison_of_word(const std::string& word) {
  static const WordSet kMore = {"größer", "groesser", "grösser", "greater", "larger",   "above",  "bigger",
                                "over",   "über",     "ueber",   "höher",   "oberhalb", "higher", ">"},
                       kLess = {"kleiner", "smaller", "less",      "below", "under",
                                "unter",   "lower",   "unterhalb", "<"};
  return kMore.contains(word) ? 1 : kLess.contains(word) ? -1 : 0;
}

/// "positiv, wenn Ist kleiner als Soll": a comparison that states the sign in words. The sign is clear if the
/// text has one sign and one comparison, and the comparison is between the two operands.
SignSaid sign_of_comparison(std::string_view text, Travel travel) {
  const std::vector<std::string> words = words_about_size(text);
  int sign = 0, more = 0;
  std::size_t signs = 0, comparisons = 0, nominals = 0, actuals = 0, at = 0, nominal = 0, actual = 0;
  for (std::size_t k = 0; k < words.size(); ++k) {
    if (states_sign(words, k)) {
      ++signs;
      sign = sign_of_word(words[k]);
    } else if (const int found = comparison_of_word(words[k]); found != 0) {
      ++comparisons;
      more = found;
      at = k;
    } else if (const OperandRole role = role_of(words[k]); role == OperandRole::kNominal) {
      ++nominals;
      nominal = k;
    } else if (role == OperandRole::kActual) {
      ++actuals;
      actual = k;
    }
  }
  if (signs == 0 || comparisons == 0 || nominals == 0 || actuals == 0) return SignSaid::kNothing;
  const bool between = (actual < at && at < nominal) || (nominal < at && at < actual);
  const bool single = signs == 1 && comparisons == 1 && nominals == 1 && actuals == 1;
  // Below zero "kleiner" may be about the amount.
  if (!single || !between || travel != Travel::kPositive || is_negated(words) || is_about_correction(words))
    return SignSaid::kUnclear;
  const bool actual_more = (more > 0) == (actual < nominal);
  return actual_more == (sign > 0) ? SignSaid::kActualLessNominal : SignSaid::kNominalLessActual;
}

/// True for a text about the sign that no rule reads: "Vorzeichen umgekehrt", "Korrektursinn", "positiv"
/// beside words for sizes or for nominal and actual.
bool mentions_sign(std::string_view text) {
  static const WordSet kSizes = {"groß",    "gross",    "klein",   "kurz",    "lang",  "weit",
                                 "short",   "long",     "far",     "large",   "small", "größer",
                                 "kleiner", "groesser", "greater", "less",    "above", "below",
                                 "over",    "under",    "größere", "kleinere"};
  static const WordSet kDirections = {"direction", "directions", "approach", "sense"};
  static const WordSet kEmpty = {"keine", "gelöscht", "none", "deleted", "leer", "null", "0", "zero"};
  const std::vector<std::string> words = words_about_size(text);
  bool correction = false, sign = false, state = false, linked = false, said = false, size = false;
  bool nominal = false, actual = false, direction = false;
  for (std::size_t k = 0; k < words.size(); ++k) {
    const std::string& word = words[k];
    if (word.starts_with("korrektursinn") || word.starts_with("korrekturvorzeichen")) return true;
    sign |= word == "sign" || word == "signs" || word.starts_with("vorzeichen");
    correction |= word.starts_with("korrekturwert");
    state |= says_state_of_correction(word) || kEmpty.contains(word);
    if (states_sign(words, k)) {
      said = true;
      linked |= k + 1 < words.size() && says_meaning(words[k + 1]);
    }
    size |= kSizes.contains(word);
    direction |= kDirections.contains(word) || word.find("richtung") != std::string::npos;
    if (is_instrument(word) || word == "messung" || word == "measurement") continue;
    nominal |= role_of(word) == OperandRole::kNominal;
    actual |= role_of(word) == OperandRole::kActual;
  }
  // "Vorzeichen" alone is the label of another cell.
  if ((sign && words.size() > 1 && words != std::vector<std::string>{words[0], "="}) ||
      (correction && !state))
    return true;
  if (direction || !said) return false;
  return size || (nominal && actual) || (linked && (nominal || actual));
}

/// "positiv, wenn zu kurz": the sign of a deviation by the length that the machine travels. Too short means
/// that the actual value is below the nominal one, if the positions are positive.
SignSaid sign_of_size(std::string_view text) {
  static const WordSet kShort = {"kurz", "kürzer", "short", "shorter", "undershoot"},
                       kLong = {"lang", "länger", "weit", "long", "longer", "far", "overshoot"},
                       kCompared = {"klein", "small"}, kLarge = {"groß", "gross", "grosz", "large", "big"},
                       kMeasures = {"maß",    "mass",   "weg",       "verfahrweg", "strecke",
                                    "travel", "istweg", "dimension", "distance",   "position"};
  const auto is_too = [](const std::string& word) { return word == "zu" || word == "too"; };
  const std::vector<std::string> words = words_about_size(text);
  const bool linked = std::any_of(words.begin(), words.end(), [&](const std::string& word) {
    return says_meaning(word) || is_too(word);
  });
  // "zu klein" is about the motion only beside a word for the motion or its actual value.
  const bool measured = std::any_of(words.begin(), words.end(), [&](const std::string& word) {
    return kMeasures.contains(word) || role_of(word) == OperandRole::kActual;
  });
  const bool aside = is_negated(words) || is_about_correction(words);
  SignSaid said = SignSaid::kNothing;
  int before = 0;
  for (std::size_t k = 0; k < words.size(); ++k) {
    if (const int sign = sign_of_word(words[k]); sign != 0) before = sign;
    const bool too = k > 0 && is_too(words[k - 1]);
    const bool small = kShort.contains(words[k]) || (too && kCompared.contains(words[k]));
    const bool bare = too && (kCompared.contains(words[k]) || kLarge.contains(words[k]));
    if (!small && !kLong.contains(words[k]) && !bare) continue;
    // "zu kurz = +" states the sign behind the size, "positiv, wenn zu kurz" before it.
    int sign = k + 2 < words.size() && (says_meaning(words[k + 1]) || is_too(words[k + 1]))
                   ? sign_of_word(words[k + 2])
                   : 0;
    if (sign == 0) sign = before;
    for (std::size_t next = k + 1; sign == 0 && next < words.size(); ++next) sign = sign_of_word(words[next]);
    if (sign == 0) continue;
    const bool turned = small == (sign > 0);
    said = both_signs(said, !linked || aside || (bare && !measured) ? SignSaid::kUnclear
                            : turned                                ? SignSaid::kNominalLessActual
                                                                    : SignSaid::kActualLessNominal);
  }
  return said;
}

/// "Messuhr läuft entgegen der Achse": the readings of an instrument that counts against the axis are nominal
/// - actual. A text about a turned instrument without a word for the axis is kUnclear.
SignSaid sign_of_mounting(std::string_view text) {
  static const WordSet kAgainst = {"entgegen", "entgegengesetzt", "gegen", "against", "opposite"},
                       kOpposed = {"entgegen",  "entgegengesetzt", "gegenläufig", "gegensinnig",
                                   "umgekehrt", "verkehrt",        "inverted",    "inverse",
                                   "reversed",  "invertiert",      "umgedreht",   "opposite",
                                   "opposed",   "seitenverkehrt"},
                       kBackward = {"rückwärts", "rueckwaerts", "backwards", "backward"},
                       kMotions = {"läuft",  "laeuft", "zählt", "zaehlt", "dreht",    "geht",
                                   "counts", "runs",   "turns", "reads",  "counting", "moves"};
  const auto instrument = [](const std::string& word) {
    static const WordSet kWords = {"uhr",      "taster",    "anzeige",    "display", "readout",    "gauge",
                                   "gage",     "dial",      "sensor",     "probe",   "instrument", "reading",
                                   "readings", "messgerät", "messgeraet", "fühler",  "dti"};
    return kWords.contains(word) || word.starts_with("messuhr") || word.ends_with("taster") ||
           word.ends_with("indicator") || word.starts_with("fühlhebel");
  };
  const auto of_axis = [](const std::string& word) {
    static const WordSet kWords = {
        "achse",     "achsrichtung", "axis",           "verfahrrichtung", "bewegung",         "motion",
        "direction", "travel",       "maschinenachse", "achsbewegung",    "bewegungsrichtung"};
    return kWords.contains(word) || word.ends_with("-achse") || word.ends_with("-axis");
  };
  const std::vector<std::string> words = words_about_size(text);
  const auto any = [&](const WordSet& list) {
    return std::any_of(words.begin(), words.end(), [&](const auto& word) { return list.contains(word); });
  };
  if (std::none_of(words.begin(), words.end(), instrument)) return SignSaid::kNothing;
  // Words up to that of the axis: "opposite to the positive axis", "gegen die Achse".
  constexpr std::size_t kBetween = 4, kBetweenShort = 2;
  for (std::size_t k = 0; k < words.size(); ++k) {
    if (!kAgainst.contains(words[k])) continue;
    const bool many_meanings = words[k] == "gegen" || words[k] == "against";  // "gegen Anschlag"
    const std::size_t end = std::min(words.size(), k + 1 + (many_meanings ? kBetweenShort : kBetween));
    for (std::size_t next = k + 1; next < end; ++next)
      if (of_axis(words[next])) return is_negated(words) ? SignSaid::kUnclear : SignSaid::kNominalLessActual;
  }
  return any(kOpposed) || (any(kBackward) && any(kMotions)) ? SignSaid::kUnclear : SignSaid::kNothing;
}

/// The sign of a text about a length, for positions on this side of zero.
SignSaid on_side(SignSaid said, Travel travel) {
  if (said == SignSaid::kNothing || said == SignSaid::kUnclear || travel == Travel::kPositive) return said;
  if (travel == Travel::kBothSides) return SignSaid::kUnclear;
  return said == SignSaid::kNominalLessActual ? SignSaid::kActualLessNominal : SignSaid::kNominalLessActual;
}

}  // namespace

SignSaid both_signs(SignSaid one, SignSaid other) {
  if (one == SignSaid::kNothing) return other;
  return other == SignSaid::kNothing || other == one ? one : SignSaid::kUnclear;
}

SignSaid sign_said(std::string_view text, SignPlace place, Travel travel) {
  const SignTokens tokens(text);
  SignSaid said =
      leads_from_nominal_to_actual(tokens.list()) ? SignSaid::kUnclear : sign_of_comparison(text, travel);
  for (std::size_t k = 0; k < tokens.list().size(); ++k)
    if (tokens.list()[k].kind == SignKind::kMinus)
      said = both_signs(said, Difference(tokens.list(), k, place).said());
  said = both_signs(said, on_side(sign_of_size(text), travel));
  if (said == SignSaid::kNothing) said = sign_of_mounting(text);
  if (said != SignSaid::kNothing || !mentions_sign(text)) return said;
  const bool deviation = std::any_of(tokens.list().begin(), tokens.list().end(),
                                     [](const SignToken& one) { return says_deviation(one.word); });
  return place == SignPlace::kTitle || deviation ? SignSaid::kUnclear : SignSaid::kNothing;
}

bool says_sign_is_usual(std::string_view text) {
  static const WordSet kUsual = {"unverändert", "unveraendert", "unchanged",    "geprüft",   "checked",
                                 "verified",    "ordnung",      "ok",           "korrekt",   "correct",
                                 "richtig",     "iso",          "kontrolliert", "bestätigt", "confirmed"};
  static const WordSet kWas = {"war", "was", "wurde", "had", "hatte"};
  static const WordSet kBefore = {"vor", "before", "früher", "damals", "previous", "alten", "old", "vorher"};
  static const WordSet kNo = {"no", "kein", "keine", "keinen", "without", "ohne"};
  static const WordSet kWrong = {"falsch", "wrong", "incorrect"};
  static constexpr std::array<std::string_view, 19> kChanges = {
      "umgekehrt", "umgedreht", "gedreht", "vertauscht", "revers",  "invers", "invert",
      "opposite",  "gespiegel", "negativ", "positiv",    "gegen",   "minus",  "plus",
      "swapped",   "flipped",   "negier",  "negated",    "entgegen"};
  bool sign = false, usual = false, was = false, before = false, no = false, change = false, wrong = false;
  bool negated = false, changed = false;
  for (const std::string& word : words_about_size(text)) {
    sign |= word == "sign" || word == "signs" || word.starts_with("vorzeichen");
    usual |= kUsual.contains(word);
    was |= kWas.contains(word);
    before |= kBefore.contains(word);
    no |= kNo.contains(word);
    negated |= word == "nicht" || word == "not" || word == "never";
    wrong |= kWrong.contains(word);
    change |= word == "change" || word == "changed" || word.find("wechsel") != std::string::npos ||
              word.find("umkehr") != std::string::npos || word.find("änderung") != std::string::npos;
    changed |= word == "+" || word == "-" ||
               std::any_of(kChanges.begin(), kChanges.end(),
                           [&](std::string_view start) { return word.starts_with(start); });
    const OperandRole role = role_of(word);
    changed |= role == OperandRole::kNominal ||
               (role == OperandRole::kActual && word != "ist" && !is_instrument(word));
  }
  if (!sign || changed || negated) return false;
  if (change) return no && !wrong;
  return was && before ? !usual : usual && !wrong && !no;
}

}  // namespace vernier::importer
