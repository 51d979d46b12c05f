// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/words/doubtful_words.h"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include "tools/format/units.h"
#include "tools/import/words/sheet_words.h"
#include "tools/sheet/unit_factor.h"
#include "tools/text/numbers.h"
#include "tools/text/words.h"

namespace vernier::importer {
namespace {

/// A rule: each group of `all` (groups are separated by blanks) has a word in the text, and no word of the
/// text is in `none`. Words of a group are separated by |: "wort" is the beginning of a word, "=wort" a whole
/// word, "*wort" a part of a word, "zu~kurz" two words behind each other.
struct DoubtRule {
  Doubtful subject;
  std::string all, none;
};

const std::string kOfValues =
    "wert|*werte|value|reading|abweich|*abweichung|deviat|error|fehler|*fehler|anzeig|display|zahl|=numbers|"
    "figure|result|ergebnis|=alle|=all|=jedem|=each|=every|angezeigt|shown|ablesung|reads";
const std::string kOfState =
    " aktiv|activ|deaktiv|gelösch|cleared|deleted|=aus|=off|=ein|=on|=alt|=old|=keine|=none|=vor|=nach|=ohne|"
    "=mit|=before|=after|=without|=with|disabled|enabled|=leer|=null|=0|eingeschalt|ausgeschalt";
const std::string kOfMotion =
    "weg|schlitten|ziel|position|*position|carriage|slide|target|travel|achse|axis|=ist|tisch|table|gefahren|"
    "moved|stops|stopped|command";
const std::string kMeaning =
    "bedeut|heiß|mean|indicat|shows|zeigt|denot|stand|steht|=wenn|=falls|=if|=when|==|entspr|signif|"
    "represent|"
    "count|gezähl|zähl|weit|kurz|wenig|=viel|overtravel|undertravel|overshoot|undershoot|short|=far|behind|"
    "beyond|past|hinter|ahead|towards|away";

const std::string kToAdd =
    "to~be~added|be~added|must~add|to~add|to~be~subtracted|be~subtracted|hinzuzufüg|zu~addieren|abzuzieh|"
    "zu~subtrah";

// The one list of words. A note is soft: a rule with one group names words that protocols hardly use
// otherwise.
const std::vector<DoubtRule>& rules() {
  using D = Doubtful;
  static const std::vector<DoubtRule> kRules = {
      {D::kSign, "*vorzeichen|=sign|=signs|polarit =#words", "=keine|=ohne|design"},
      {D::kSign, "positiv|negativ",
       "*richtung|direction|approach|anfahr|seite|=side|lauf|läufe|=run|=runs|ende|endschalt|halb|fahrt|"
       "temperatur|limit|anschlag|stop|test|beurteil|gmbh|kunde|customer"},
      {D::kSign, "=plus|=minus|=+|pluswert|minuswert|pluszeichen|minuszeichen " + kMeaning,
       "*richtung|direction|anfahr|approach|=from|=aus|temperatur"},
      {D::kSign,
       "overtravel|undertravel|overshoot|undershoot =+|=plus|=minus|count|gezähl|shown|angezeigt|mean", ""},
      {D::kSign,
       "zu~wenig|zu~viel|zu~weit|zu~kurz|zu~lang|too~short|too~far|too~long|too~little|too~much|stops~short|"
       "nicht~erreich|nicht~ganz|not~reach|vor~dem~ziel|short~of " +
           kOfMotion + "|" + kOfValues,
       "warm"},
      {D::kSign,
       "korrekturwert|kompensationswert|ausgleichswert|kompensationstab|korrekturtab|kompensationsdat|"
       "korrekturdat|correction~val|correction~tab|correction~data|compensation~val|compensation~tab|"
       "compensation~data|aufzuschalt|=korrekturen|=corrections|einzugeben|to~be~entered|gegenzusteuer",
       kOfState.substr(1) + "|will~be~computed|werden~berechnet|werden~ermittelt"},
      // With a length the text is about this length: "12 µm sind zu addieren".
      {D::kSign, kToAdd, kOfState.substr(1) + "|=#length"},
      {D::kAddition, kToAdd + " =#length", ""},
      {D::kSign,
       "umgekehrt|revers|invers|invert|gespiegel|mirrored|vertausch|swapped|opposite|entgegengesetz|flipped|"
       "negier|negated|gegensinn|gegenläuf|seitenverk " +
           kOfValues,
       "*richtung|direction|reihenfolge|order|lauf|läufe|=run|=runs|=x|=y|fahrt|umkehr|reversal|spanne"},
      {D::kIncrements,
       "änder|zuwachs|zunahme|unterschied|differen|change|increment|inkrement|increase|fortschritt|=gain|"
       "verschieb|abweich|deviat|relativ|bezogen|=delta "
       "vorig|vorherig|vorhergeh|vorangeg|vorangehend|=davor|previous|preced|=prior|vorgänger|benachbart|"
       "neighbo|adjacent|consecutiv|aufeinanderf|seit~letzt|since~last|since~the~last|darüber|=above|"
       "zum~letzten|zur~letzten",
       "kalibr|calibr|wartung|service|abnahme|kompensat|compens|version|steigend|rück|return"},
      {D::kIncrements,
       "änder|zuwachs|zunahme|unterschied|differen|change|increment|increase "
       "zeile~zu~zeile|punkt~zu~punkt|schritt~zu~schritt|position~zu~position|row~to~row|point~to~point|"
       "position~to~position|step~to~step|je~schritt|pro~schritt|per~step|je~zeile|per~row",
       "*richtung|direction"},
      {D::kIncrements,
       "nicht~aufsumm|nicht~kumul|not~summed|not~accumul|not~cumul|aufzusumm|aufzuaddier|summed~up|to~be~"
       "summed|aufsummier",
       ""},
      {D::kFactor,
       "*doppelt|zweifach|dreifach|vierfach|*zehnfach|zehntel~der|*hundertfach|*tausendfach|tenfold|twofold|"
       "double|twice|=halb|=halbe|=halber|=halbes|halbier|=half|halve|halving|triple|verdoppel|verdreifach " +
           kOfValues + "|pass|beam|strahl",
       "stunde|hour|column|spalte|wiederhol|=mirror|gelagert|tag|=day|umdrehung"},
      {D::kFactor, "multipliz|multipli|vervielfach|dividier|divided|geteilt~durch|divide|magnif|verstärk",
       ""},
      {D::kFactor, "doppelspiegel|double~pass|doppeldurchgang|vierfachreflex|doppelreflex", ""},
      {D::kFactor, "*faktor|factor|skalier|scaled|rescaled|*übersetz|überhöh|gespreizt|exaggerat",
       "überdeckung|coverage|erweiterung|unsicher|uncertain|expansion|ausdehnung|=k|sicherheit|safety|"
       "temperatur|thermal|prozess|=1:1"},
      {D::kFactor, "=#ratio", "maßstab|zeichnung|drawing"},
      {D::kFactor, "=#times", ""},
      {D::kAddition,
       "addiert|=added|hinzugefügt|hinzugerechn|dazugezähl|zugeschlag|aufgeschlag|subtrahier|subtracted|"
       "abgezogen|erhöht|vermindert|raised|increased|lowered|=bias|angehoben|versetzt~um|shifted~by|"
       "verschoben~um|konstante|bereinigt|detrend|beseitigt|entfernt|removed|herausgerech|eliminier " +
           kOfValues + "|mittel|mean|offset|trend|steigung|slope|gerade|line|linear|anteil",
       "ausreißer|outlier|gehäuse|cover|abdeckung"},
      {D::kInvalid,
       "ungültig|verworf|=invalid|invalidated|discard|reject|unbrauchb|unusable|wiederholen|to~be~repeated|"
       "be~repeated|repeat~this|redo|misst~falsch|ausreißer|outlier|nicht~verwend|nicht~benutz|not~use|"
       "not~be~used|nicht~gewertet|nicht~werten|ignorier|ignore|*fehlmessung|fehlerhaft|faulty|gestrichen|"
       "streichen|exclude|ausgeschlossen|nicht~gültig|not~valid|=void|abgebroch|aborted|gestört|disturb|"
       "kollision|collision|bumped|=stoß|angestoßen|verfälsch|verrutsch|slipped|falsch~abgeles|misread|"
       "unsicher~abgeles|suspect|unreliab|unzuverläss|nicht~berücksicht|zweifelhaft|verdächtig|wrong|falsch",
       "=keine|=kein|=no|=none|=without|=ohne|entfernt|removed|gelöscht|deleted|untersuchung|repair|"
       "reparatur"},
      {D::kZero,
       "nullpunkt|nullage|nulllage|genullt|nullen|nullgesetzt|nullung|=null|rezero|=zero|zeroed|=origin|"
       "ursprung|*koordinate|coordinate|maschinenposition|machine~pos|offset|versatz|verschoben|shifted|"
       "preset|referenzpunkt|reference~point|bezugspunkt|datum "
       "=#length|=neu|=neuer|=neue|=new|=again|erneut|wieder|=re|zwischen|between|ander|different|verscho|"
       "shifted|=moved|jedem|jeder|=each|=every|=ab|=nach~lauf|after~run|mitte|middle|centre|center",
       "datei|kalibrier|version|reflektor|reflector|flansch|flange|werkzeug|=tool"},
      {D::kZero, "rezero|re~zero|nachgenullt|neu~genullt|umgenullt|neu~angesetzt|neu~angetastet|umgesetzt",
       ""},
      {D::kBackOrder,
       "unten~nach~oben|von~unten|bottom~to~top|bottom~up|upwards|last~first|letzte~zuerst|umgekehrter~"
       "reihen|reverse~order|reversed~order|rückwärts~zu~lesen|read~backward|read~upward|absteigend|"
       "descending|reihenfolge~der~messung|kopfüber|last~target~first|oberste|unterste|topmost|uppermost|"
       "lowermost|=bottom|fernen~ende|far~end|anderen~ende|other~end|zuletzt~zuerst "
       "*spalte|column|wert|*werte|value|rück|zurück|return|back|lesen|gelesen|read|liste|listed|beginn|"
       "begin|start|=lauf|=run|zeilen|rows|lines",
       "angefahren|approach"},
      {D::kDirections,
       "gegenrichtung|gegengericht|richtung~gewechs|richtung~wechs|richtungswechsel|wechselnd|alterniert|"
       "direction~chang|direction~revers|direction~altern|change~of~direction|opposite~direction|"
       "direction~was|directions~altern|umgesteuert|return~stroke|rückhub|back~stroke|return~pass|"
       "return~run|return~travel|umgekehrter~richtung|umgekehrte~richtung",
       "=ohne|=without|nur~eine"},
      {D::kDirections,
       "zweite|zweiter|second|other|=even|=odd|gerade|ungerade|geradzahl|ungeradzahl|=erste|=ersten|=letzte|"
       "=letzten|=first|=last|linke|rechte|=left|=right|=#integer|übrigen|remaining|=rest "
       "lauf|läufe|*läufe|=run|=runs|spalte|*spalten|column|messreihe|=reihe|=reihen|zeile|=row|=rows|serie|"
       "series|ablesung|=reading|=readings|durchgang|durchgänge|=pass|=passes|messung|fahrt "
       "vorwärts|rückwärts|=hin|zurück|rück|forward|backward|revers|return|=back|*richtung|direction|"
       "=unten|=oben|below|above|abwärts|aufwärts|=up|=down|links|rechts|left|right|plusrichtung|"
       "minusrichtung|ascending|descending|steigend|fallend",
       "=je|jeweils|wiederhol"},
      {D::kDirections,
       "angefahren|approached|anfahrt|anfahren|came~from|coming~from =unten|=oben|below|above|"
       "links|rechts|left|right|=plus|=minus|=+|positiv|negativ|=either|=one|einer|einseitig",
       "beiden|=both"},
      {D::kCodes, "=#code", ""},
      {D::kFactor,
       "einheiten~von|einheit~von|units~of|counts~of|pro~teilstrich|je~teilstrich|per~count|per~digit", ""},
      {D::kAddition,
       "ausgleichsgerade|regressionsgerade|best~fit~line|end~point~fit|endpunktgerade "
       "herausger|entfernt|removed|abgezogen|subtracted|bezogen|relativ|taken~out",
       ""},
      {D::kDirections,
       "high~to~low|low~to~high|von~groß~nach~klein|from~large~to|from~the~far|vom~ende|zum~anfang "
       "lauf|läufe|=run|=runs|spalte|column|=reihe|=pass",
       ""}};
  return kRules;
}

bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

/// Words in small letters. "=" and ":" are "=", a sign that is no hyphen is a word; numbers keep their point
/// and their colon.
std::vector<std::string> words_of_doubt(std::string_view text) {
  std::string small = text::in_small_letters(text);
  for (const std::string_view minus : {"\u2212", "\u2013", "\u2014"}) text::replace_all(small, minus, "-");
  text::replace_all(small, "\u00d7", " x ");
  text::replace_all(small, "*", " x ");
  std::string spaced;
  for (std::size_t at = 0; at < small.size(); ++at) {
    const char c = small[at];
    const bool after = at > 0 && is_digit(small[at - 1]);
    const bool before = at + 1 < small.size() && is_digit(small[at + 1]);
    const bool start = at == 0 || small[at - 1] == ' ';
    if (std::string_view(".,:").find(c) != std::string_view::npos && after && before)
      spaced += c == ',' ? '.' : c;
    else if (c == '=' || c == ':')
      spaced += " = ";
    else if (c == '+' && !(before || (at + 2 < small.size() && is_digit(small[at + 2]))))
      spaced += " + ";  // "+ 120 mm" is a sum
    else if (c == '-')
      spaced += start && before ? std::string(" -") : start ? " - " : " ";
    else if (std::string_view("+\t_./;,()[]#!\"'|?").find(c) != std::string_view::npos)
      spaced += ' ';
    else
      spaced += c;
  }
  return text::words_in(spaced, " ");
}

/// A ratio with 1 on one side, "2:1", and no time of day.
bool is_ratio(const std::string& word) {
  const std::size_t colon = word.find(':');
  if (colon == std::string::npos || word.find(':', colon + 1) != std::string::npos) return false;
  const std::string left = word.substr(0, colon), right = word.substr(colon + 1);
  return (left == "1") != (right == "1") && left != "0" &&
         right.find_first_not_of("0123456789") == right.npos;
}

/// Words for units, and the units of the measurement file.
const std::map<std::string, std::string>& unit_words() {
  static const std::map<std::string, std::string> kUnits = {{"zoll", "in"},
                                                            {"inch", "in"},
                                                            {"inches", "in"},
                                                            {"fahrenheit", "degF"},
                                                            {"°f", "degF"},
                                                            {"kelvin", "K"},
                                                            {"celsius", "degC"},
                                                            {"radian", "rad"},
                                                            {"radians", "rad"},
                                                            {"bogenmaß", "rad"},
                                                            {"rad", "rad"},
                                                            {"hundertstel", "0.01mm"},
                                                            {"hundredths", "0.01mm"},
                                                            {"tausendstel", "um"},
                                                            {"thousandths", "thou"},
                                                            {"mils", "thou"},
                                                            {"thou", "thou"},
                                                            {"nanometer", "nm"},
                                                            {"nm", "nm"},
                                                            {"mikrometer", "um"},
                                                            {"micrometer", "um"},
                                                            {"microns", "um"},
                                                            {"micron", "um"},
                                                            {"µm", "um"},
                                                            {"um", "um"},
                                                            {"millimeter", "mm"},
                                                            {"mm", "mm"},
                                                            {"metres", "m"},
                                                            {"meters", "m"},
                                                            {"metern", "m"},
                                                            {"zehntel", "0.1mm"},
                                                            {"bogensekunden", "arcsec"},
                                                            {"winkelsekunden", "arcsec"},
                                                            {"arcsec", "arcsec"},
                                                            {"arcseconds", "arcsec"}};
  return kUnits;
}

/// Marks of the words that need a look at their neighbours.
std::set<std::string> marks_of(const std::vector<std::string>& words) {
  static const std::set<std::string> kLengths = {"mm", "m",  "in",  "inch", "zoll",
                                                 "µm", "um", "deg", "°",    "grad"};
  std::set<std::string> marks;
  // A word alone is the label of another cell: "Vorzeichen:".
  constexpr std::ptrdiff_t kSeveral = 2;
  if (std::count_if(words.begin(), words.end(), [](const auto& word) { return word != "="; }) >= kSeveral)
    marks.insert("#words");
  for (std::size_t k = 0; k < words.size(); ++k) {
    const auto next = [&](std::size_t step) {
      return k + step < words.size() ? words[k + step] : std::string();
    };
    const auto number = text::parse_number(words[k]);
    if (is_ratio(words[k])) marks.insert("#ratio");
    if (number && *number != 0 && kLengths.contains(next(1))) marks.insert("#length");
    if (is_run_number(words[k])) marks.insert("#integer");
    const auto value = [](const std::string& word) {
      return says_deviation(word) || word.find("abweich") != word.npos || word.find("wert") != word.npos ||
             word.starts_with("value") || word.starts_with("reading") || word.starts_with("error") ||
             word.starts_with("fehler") || word.starts_with("deviat") || word.starts_with("anzeig");
    };
    // "2 x Abweichung", "mal 10", "times two".
    if (number && (next(1) == "x" || next(1) == "mal" || next(1) == "times") && value(next(2)))
      marks.insert("#times");
    if ((words[k] == "mal" || words[k] == "times" || words[k] == "x") &&
        (text::parse_number(next(1)) || next(1) == "two" || next(1) == "ten" || next(1) == "zwei" ||
         next(1) == "zehn") &&
        std::any_of(words.begin(), words.end(), value))
      marks.insert("#times");
    const auto direction = [](const std::string& word) { return word.size() > 2 && sense_said(word) != 0; };
    const auto code = [](const std::string& word) {
      return !word.empty() && word.size() <= 2 && word != "=" && word != "+" && word != "-";
    };
    if (words[k] == "=" && k > 0 &&
        ((direction(next(1)) && code(words[k - 1])) || (direction(words[k - 1]) && code(next(1)))))
      marks.insert("#code");
  }
  return marks;
}

bool matches(const std::string& word, const std::string& pattern) {
  if (pattern.starts_with('=')) return word == pattern.substr(1);
  if (pattern.starts_with('*')) return word.find(pattern.substr(1)) != std::string::npos;
  return word.starts_with(pattern);
}

bool has_one_of(const std::vector<std::string>& words, const std::set<std::string>& marks,
                const std::string& group) {
  for (const std::string& pattern : text::words_in(group, "|")) {
    if (pattern.starts_with("=#")) {
      if (marks.contains(pattern.substr(1))) return true;
      continue;
    }
    const std::vector<std::string> row = text::words_in(pattern, "~");
    for (std::size_t k = 0; k + row.size() <= words.size(); ++k) {
      bool all = true;
      for (std::size_t i = 0; all && i < row.size(); ++i) all = matches(words[k + i], row[i]);
      if (all) return true;
    }
  }
  return false;
}

}  // namespace

std::set<Doubtful> doubtful_in(std::string_view text) {
  const std::vector<std::string> words = words_of_doubt(text);
  const std::set<std::string> marks = marks_of(words);
  std::set<Doubtful> found;
  for (const DoubtRule& rule : rules()) {
    if (found.contains(rule.subject) || has_one_of(words, marks, rule.none)) continue;
    const std::vector<std::string> groups = text::words_in(rule.all, " ");
    if (std::all_of(groups.begin(), groups.end(),
                    [&](const std::string& group) { return has_one_of(words, marks, group); }))
      found.insert(rule.subject);
  }
  return found;
}

bool may_state(std::string_view text, Doubtful subject) { return doubtful_in(text).contains(subject); }

namespace {

/// The unit that word `k` names, alone or as a part of the unit behind it ("Zehntel Mikrometer"), with its
/// words; empty: none.
std::pair<std::string, std::string> unit_at(const std::vector<std::string>& words, std::size_t k) {
  constexpr std::size_t kFurthest = 3;  // words: "tenths of a micron"
  const auto& units = unit_words();
  std::string text = words[k];
  if (const auto factor = sheet::factor_at_end(words[k]); factor && factor->value > 0)
    for (std::size_t next = k + 1; next < words.size() && next <= k + kFurthest; ++next) {
      text += " " + words[next];
      const auto whole = units.find(words[next]);
      if (whole == units.end()) continue;
      const auto part = sheet::unit_times(factor->value, whole->second);
      return part ? std::pair(text, *part) : std::pair<std::string, std::string>();
    }
  const auto found = units.find(words[k]);
  return found != units.end() ? std::pair(found->first, found->second)
                              : std::pair<std::string, std::string>();
}

}  // namespace

std::pair<std::string, std::string> unit_against_headings(std::string_view text,
                                                          const sheet::SheetTable& table) {
  static const std::string kOther =
      "auflösung|resolution|toleranz|tolerance|vorschub|feed|speed|geschwind|wellenlänge|wavelength|unsicher|"
      "uncertain|teilung|raster|gewinde|thread|schraube|screw|messbereich|range|ziffernschritt";
  const std::vector<std::string> words = words_of_doubt(text);
  if (has_one_of(words, {}, kOther)) return {};
  for (std::size_t k = 0; k < words.size(); ++k) {
    const auto [name, symbol] = unit_at(words, k);
    if (symbol.empty() || (k > 0 && text::parse_number(words[k - 1]))) continue;
    const auto unit = format::find_unit(symbol);
    if (!unit) continue;
    bool quantity = false, same = false;
    for (const sheet::Heading& heading : table.headings) {
      const auto of_column = heading.unit.empty() ? std::nullopt : format::find_unit(heading.unit);
      quantity |= of_column && of_column->dimension == unit->dimension;
      same |= of_column && of_column->dimension == unit->dimension && of_column->factor == unit->factor &&
              (unit->dimension != format::Dimension::kTemperature || heading.unit == symbol);
    }
    if (quantity && !same) return {name, symbol};
  }
  return {};
}

}  // namespace vernier::importer
