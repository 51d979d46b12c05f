// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/reading/title_positions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "tools/format/units.h"
#include "tools/import/columns/column_guess.h"
#include "tools/import/columns/sheet_columns.h"
#include "tools/import/words/sheet_words.h"
#include "tools/sheet/sheet_number.h"
#include "tools/text/error.h"
#include "tools/text/numbers.h"
#include "tools/text/words.h"

namespace vernier::importer {
namespace {

using TitleWords = std::set<std::string, std::less<>>;

enum class Part { kWord, kNumber, kEquals, kMark };

struct Token {
  Part part = Part::kMark;
  std::string text;
  bool blank = false;  // true: a blank is before the token
};

bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }
bool is_letter(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) != 0 || static_cast<unsigned char>(c) >= 0x80;
}

/// End of the number that begins at `at`; `at` if no number begins there.
std::size_t end_of_number(const std::string& text, std::size_t at, bool sign) {
  std::size_t end = at;
  if (sign && end < text.size() && (text[end] == '-' || text[end] == '+')) ++end;
  const std::size_t digits = end;
  while (end < text.size() && is_digit(text[end])) ++end;
  if (end == digits) return at;
  if (end + 1 < text.size() && (text[end] == '.' || text[end] == ',') && is_digit(text[end + 1]))
    for (++end; end < text.size() && is_digit(text[end]);) ++end;
  return end;
}

std::vector<Token> tokens_of(const std::string& title) {
  std::vector<Token> tokens;
  bool blank = true;
  for (std::size_t at = 0; at < title.size();) {
    if (title[at] == ' ' || title[at] == '\t') {
      blank = true;
      ++at;
      continue;
    }
    const bool sign = blank || (!tokens.empty() && tokens.back().part == Part::kEquals);
    std::size_t end = end_of_number(title, at, sign);
    Token token{Part::kNumber, "", blank};
    if (end == at) {
      token.part = title[at] == '=' || title[at] == ':' ? Part::kEquals : Part::kMark;
      while (end < title.size() && is_letter(title[end])) ++end;
      if (end > at) token.part = Part::kWord;
      end = std::max(end, at + 1);
    }
    token.text = title.substr(at, end - at);
    tokens.push_back(std::move(token));
    at = end;
    blank = false;
  }
  return tokens;
}

bool is_linear(const std::string& axis) { return axis == "X" || axis == "Y" || axis == "Z"; }

bool says_place(const std::string& word) {
  static const TitleWords kWords = {"bei", "at", "auf", "on", "steht", "stands", "à"};
  return kWords.contains(word);
}
bool says_axis(const std::string& word) { return word == "achse" || word == "axis" || word == "axe"; }

/// Words between an axis and the number of its position: "X-Achse fest auf 250".
bool is_between(const std::string& word) {
  static const TitleWords kWords = {"position", "pos",   "fest", "fixed", "konstant",
                                    "constant", "const", "ist",  "is"};
  return kWords.contains(word) || says_place(word) || says_axis(word);
}

/// Words that may follow a position without a unit.
bool may_follow(const std::string& word) {
  static const TitleWords kWords = {"und",      "and",      "et",    "fest", "fixed",
                                    "konstant", "constant", "const", "mit",  "with"};
  return kWords.contains(word) || says_place(word) || sense_said(word) != 0;
}

/// Words of another quantity than a position.
bool says_other_quantity(const std::string& word) {
  static const TitleWords kWords = {"verfahrweg",
                                    "verfahrwege",
                                    "verfahrbereich",
                                    "arbeitsraum",
                                    "arbeitsbereich",
                                    "messbereich",
                                    "bereich",
                                    "hub",
                                    "travel",
                                    "travels",
                                    "stroke",
                                    "strokes",
                                    "workspace",
                                    "volume",
                                    "range",
                                    "toleranz",
                                    "tolerance",
                                    "schritt",
                                    "step",
                                    "steps",
                                    "schrittweite",
                                    "länge",
                                    "laenge",
                                    "length",
                                    "auflösung",
                                    "resolution",
                                    "unsicherheit",
                                    "uncertainty",
                                    "werkstück",
                                    "workpiece",
                                    "limit",
                                    "limits",
                                    "grenze",
                                    "grenzen",
                                    "max",
                                    "min",
                                    "vorschub",
                                    "feed",
                                    "seriennummer",
                                    "serial",
                                    "intervall",
                                    "interval",
                                    "messlänge",
                                    "messweg",
                                    "genauigkeit",
                                    "accuracy",
                                    "backlash",
                                    "umkehrspanne",
                                    "reversal",
                                    "korrektur",
                                    "correction",
                                    "kompensation",
                                    "compensation"};
  return kWords.contains(word);
}

/// Words of a shift: the number beside the axis may be no position of the machine.
bool says_shift(const std::string& small_title) {
  for (const std::string_view word : {"nullpunkt", "offset", "versatz", "zero", "origin", "ursprung", "g54"})
    if (small_title.find(word) != std::string::npos) return true;
  return false;
}

class TitleReader {
 public:
  TitleReader(const std::string& title, const SheetWishes& wishes)
      : guess_(wishes), known_(!wishes.axes.empty()), tokens_(tokens_of(title)) {
    for (const Token& token : tokens_) small_.push_back(text::in_small_letters(token.text));
    shift_ = says_shift(text::in_small_letters(title));
  }

  std::vector<TitlePosition> positions() {
    std::vector<TitlePosition> found;
    if (std::any_of(small_.begin(), small_.end(), says_other_quantity)) return found;
    for (std::size_t at = 0; at < tokens_.size(); ++at) {
      if (tokens_[at].part != Part::kWord || !guess_.is_axis(tokens_[at].text)) continue;
      if (const auto one = position_at(at)) found.push_back(*one);
    }
    return found;
  }

 private:
  bool is_word(std::size_t at) const { return at < tokens_.size() && tokens_[at].part == Part::kWord; }
  bool is_mark(std::size_t at, std::string_view marks) const {
    return at < tokens_.size() && tokens_[at].part == Part::kMark &&
           marks.find(tokens_[at].text) != std::string_view::npos;
  }
  bool is_axis(std::size_t at) const { return is_word(at) && guess_.is_axis(tokens_[at].text); }

  /// A letter without a sign of equality names an axis at the begin, behind a mark, a word such as "bei" or
  /// "Achse", or another position: not in "Maschine X 250".
  bool begins_position(std::size_t at) const {
    if (at == 0 || at == end_) return true;
    if (tokens_[at - 1].part == Part::kEquals || is_mark(at - 1, ",;(/")) return true;
    static const TitleWords kBefore = {"position", "pos", "und", "and", "mit", "with"};
    return is_word(at - 1) &&
           (says_place(small_[at - 1]) || says_axis(small_[at - 1]) || kBefore.contains(small_[at - 1]));
  }

  /// Reads a unit behind the number; moves `at` behind the unit. Empty: no unit.
  std::string unit_at(std::size_t& at) const {
    std::size_t word = at;
    const bool bracket = is_mark(word, "([");
    if (bracket) ++word;
    const bool mark = is_mark(word, "\"'");
    if (!is_word(word) && !mark) return "";
    const auto unit = sheet::unit_meant(tokens_[word].text);
    if (!unit) return "";
    // A and C are units too: "X=250 C=90" has two positions, "20 C" is a temperature.
    if (is_axis(word) && word + 1 < tokens_.size() &&
        (tokens_[word + 1].part == Part::kEquals || tokens_[word + 1].part == Part::kNumber))
      return "";
    // "in" before a word is no unit.
    if (tokens_[word].text == "in" && is_word(word + 1) && !is_axis(word + 1)) return "";
    at = word + 1;
    if (bracket && is_mark(at, ")]")) ++at;
    return *unit;
  }

  /// Does a range, a list or a dimension follow the number?
  bool goes_on(std::size_t at) const {
    static const TitleWords kTo = {"bis", "to", "x", "\u2013", "\u2026", "\u00b1", "\u00d7", "à"};
    if (at >= tokens_.size()) return false;
    if (tokens_[at].part == Part::kNumber || is_mark(at, "-*%")) return true;
    if (is_word(at) && kTo.contains(small_[at])) return true;
    if (is_mark(at, ".") && (is_mark(at + 1, ".") || is_word(at + 1))) return true;  // "0..500", "3. Lauf"
    const bool list = is_mark(at, ",;/") || (is_word(at) && (small_[at] == "und" || small_[at] == "and"));
    return list && at + 1 < tokens_.size() && tokens_[at + 1].part == Part::kNumber;
  }

  std::optional<TitlePosition> position_at(std::size_t letter) {
    constexpr std::size_t kMostBetween = 6;  // words and signs between the axis and the number
    const bool begins = begins_position(letter);
    bool equals = false, colon = false,
         place = letter > 0 && is_word(letter - 1) && says_place(small_[letter - 1]);
    std::size_t at = letter + 1;
    for (; at < tokens_.size() && at <= letter + kMostBetween; ++at) {
      const bool passed =
          tokens_[at].part == Part::kEquals || is_mark(at, "-().") || (is_word(at) && is_between(small_[at]));
      if (!passed) break;
      equals |= tokens_[at].text == "=";
      colon |= tokens_[at].text == ":";
      place |= is_word(at) && says_place(small_[at]);
    }
    if (at >= tokens_.size() || tokens_[at].part != Part::kNumber) return std::nullopt;
    if (!equals && !colon && !place && !begins) return std::nullopt;
    const bool name = at == letter + 1 && !tokens_[at].blank && tokens_[at].text.size() == 1;
    if (name) return std::nullopt;                            // "Y2"
    const bool minus_lost = !equals && is_mark(at - 1, "-");  // "X-250"
    TitlePosition found{tokens_[letter].text, tokens_[at].text, ""};
    found.unit = unit_at(++at);
    if (goes_on(at)) return std::nullopt;
    const bool follows = at >= tokens_.size() || !is_word(at) || is_axis(at) || may_follow(small_[at]);
    if (!follows && found.unit.empty() && !equals) return std::nullopt;  // "Achse X, 3 Läufe"
    if (!is_position(found, place)) return std::nullopt;
    found.read = !shift_ && !minus_lost && (follows || !found.unit.empty());
    end_ = is_mark(at, ",;)") ? at + 1 : at;
    return found;
  }

  /// Can the number be a position of this axis? A title has results too: "A = 12,3", "B = 3 µm", "U = 2 µm".
  bool is_position(const TitlePosition& one, bool place) const {
    const auto unit = one.unit.empty() ? std::nullopt : format::find_unit(one.unit);
    const bool length = unit && unit->dimension == format::Dimension::kLength, angle = is_angle(one.unit);
    constexpr double kLeastUnit = 0.1;  // mm: nobody writes the place of an axis in um
    if (!one.unit.empty() && !length && !angle) return false;
    if (length && unit->factor < kLeastUnit) return false;
    if (is_linear(one.axis)) return !angle;
    return (length && known_) || (angle && !one.unit.empty()) || place;
  }

  Guess guess_;
  bool known_ = false;  // the machine is known
  std::vector<Token> tokens_;
  std::vector<std::string> small_;
  bool shift_ = false;
  std::size_t end_ = std::string::npos;  // behind the position before
};

/// A text beside the table, and whether it is about this table.
struct TitleText {
  std::string text;
  std::size_t line = 0;
  bool own = true;
};

/// Titles with their cells joined ("X =" and "250 mm" may be in two cells), comments above the table, and
/// texts that may be about another table.
std::vector<TitleText> texts_of(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                                bool one_of_several) {
  std::vector<TitleText> list;
  const std::size_t end = table.upper_row ? *table.upper_row : table.heading_row;
  for (std::size_t row = 0; table.has_headings && row < end; ++row) {
    std::string text;
    for (const std::string& cell : sheet.rows[row])
      if (!cell.empty()) {
        const bool goes_on = text.ends_with('=') || text.ends_with(':') || text.ends_with(']');
        text += (text.empty() ? "" : goes_on ? " " : "; ") + cell;
      }
    if (!text.empty()) list.push_back({text, sheet.line[row], true});
  }
  for (const sheet::Remark& remark : sheet.remarks)
    if (table.has_headings && remark.line < sheet.line[table.heading_row])
      list.push_back({remark.text, remark.line, !one_of_several});
  for (const sheet::TextElsewhere& other : sheet.elsewhere)
    if (!other.table) list.push_back({other.text, 0, false});
  return list;
}

std::string unit_of(const TitlePosition& one) {
  return !one.unit.empty() ? one.unit : is_linear(one.axis) ? "mm" : "deg";
}

std::string option_of(const TitlePosition& one) {
  return fmt::format("--set \"{}[{}]={}\"", one.axis, unit_of(one), one.number);
}

/// Axes that have positions in the table or by an option.
std::set<std::string> axes_with_positions(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                                          const SheetWishes& wishes) {
  std::set<std::string> axes;
  for (const SheetColumn& column : columns_by_headings(sheet, table, wishes))
    if (column.use == SheetColumn::Use::kColumn) axes.insert(column.name);
  for (const MappedColumn& constant : wishes.constants) axes.insert(constant.name);
  axes.insert(axis_of_titles(sheet, table));
  return axes;
}

}  // namespace

std::vector<TitlePosition> positions_in_title(const std::string& title, const SheetWishes& wishes) {
  return TitleReader(title, wishes).positions();
}

void add_positions_of_titles(sheet::Sheet& sheet, const sheet::SheetTable& table, SheetWishes& wishes) {
  const std::set<std::string> known = axes_with_positions(sheet, table, wishes);
  std::map<std::string, std::pair<double, std::string>> stated;  // by axis: in mm or deg, and the title
  for (const TitleText& title : texts_of(sheet, table, wishes.format.table.has_value()))
    for (const TitlePosition& one : positions_in_title(title.text, wishes)) {
      if (known.contains(one.axis)) continue;
      if (!one.read || !title.own) {
        if (!stated.contains(one.axis))
          sheet.notes.push_back(
              fmt::format("the text \"{}\" has a number beside the axis {}, which is not read as its "
                          "position; if {} stood "
                          "there, give {}",
                          title.text, one.axis, one.axis, option_of(one)));
        continue;
      }
      const std::string unit = unit_of(one);
      MappedColumn constant{"", one.number, one.axis, unit, {sheet.file, title.line}, true};
      const bool doubtful = one.number.find(',') != std::string::npos && !sheet.decimal_comma &&
                            sheet::decimal_sign_in(one.number) == sheet::DecimalSign::kEither;
      const auto number =
          doubtful ? std::nullopt : text::parse_number(constant_cell(constant, sheet.decimal_comma));
      const double value = number ? *number * format::find_unit(unit)->factor : 0;
      const auto [before, fresh] = stated.emplace(one.axis, std::pair(value, title.text));
      if (!number || (!fresh && before->second.first != value))
        throw text::InputError(
            {sheet.file, title.line}, title.text,
            fmt::format(
                "{}: state the position of {} in mm, for example --set \"{}[mm]=0\" (0 is an example)",
                number
                    ? fmt::format("the title \"{}\" states another position of {}", before->second.second,
                                  one.axis)
                    : fmt::format("\"{}\" can have a decimal comma or a separator of thousands", one.number),
                one.axis, one.axis));
      if (!fresh) continue;
      wishes.constants.push_back(std::move(constant));
      sheet.notes.push_back(
          fmt::format("the title \"{}\" states the position {} = {} {}: each row gets this position; if it "
                      "is wrong, give "
                      "the right one with --set \"{}[{}]=POSITION\"",
                      title.text, one.axis, one.number, unit, one.axis, unit));
    }
}

}  // namespace vernier::importer
