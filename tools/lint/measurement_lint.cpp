// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/lint/measurement_lint.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "tools/model/chain.h"
#include "tools/model/measurement.h"
#include "tools/sheet/encoding.h"
#include "tools/sheet/heading.h"
#include "tools/sheet/sheet.h"
#include "tools/sheet/sheet_number.h"
#include "tools/text/csv.h"
#include "tools/text/numbers.h"
#include "tools/text/similar.h"
#include "tools/text/units.h"
#include "tools/text/words.h"

namespace vernier {
namespace {

constexpr double kAbsent = std::numeric_limits<double>::quiet_NaN();

const std::set<std::string>& readings() {
  static const std::set<std::string> kNames = {"x", "y", "z", "rx", "ry", "rz", "length", "d"};
  return kNames;
}

/// "name[unit]" of a heading cell, whatever is wrong with it.
struct Column {
  std::string name, unit;
  bool label = false;  // words, not numbers
  std::vector<double> value;
  std::vector<std::string> cell;
};

/// One run of empty rows aside, the lines of the file that count.
struct Row {
  std::vector<std::string> cells;
  std::size_t line = 0;
};

std::string quoted_for_shell(const std::string& file) {
  return file.find_first_of(" '\"$()&;*?") == std::string::npos ? file : "'" + file + "'";
}

std::string command(const std::string& file) {
  const auto slash = file.rfind('/'), dot = file.rfind('.');
  const std::string stem = file.substr(
      0, dot == std::string::npos || (slash != std::string::npos && dot < slash) ? file.size() : dot);
  return "vernier import table " + quoted_for_shell(file) + " -o " + quoted_for_shell(stem + "_read.csv");
}

class Look {
 public:
  Look(std::string bytes, const std::string& file, const Machine* machine)
      : bytes_(std::move(bytes)), text_(bytes_), file_(file), machine_(machine), findings_(file) {}

  std::vector<LintFinding> all() {
    if (look_at_bytes() && split() && look_at_header()) {
      look_at_rows();
      if (!rows_.empty()) look_at_meaning();
    }
    confirm();
    return findings_.take();
  }

 private:
  void error(std::size_t line, const std::string& word, const std::string& what,
             const std::string& meaning = "") {
    findings_.add(LintWeight::kError, line, word, what, meaning);
  }
  void warn(std::size_t line, const std::string& word, const std::string& what,
            const std::string& meaning = "") {
    findings_.add(LintWeight::kWarning, line, word, what, meaning);
  }
  void remark(std::size_t line, const std::string& word, const std::string& what,
              const std::string& meaning = "") {
    findings_.add(LintWeight::kRemark, line, word, what, meaning);
  }

  // ---- how it is written

  bool look_at_bytes() {
    if (is_workbook(text_))
      return error(0, "", "a workbook (.xlsx), no measurement file", "read it: " + command(file_)), false;
    if (text_.starts_with("\xD0\xCF\x11\xE0"))
      return error(0, "", "a workbook of the old kind (.xls)",
                   "save it as .xlsx or CSV, then vernier import table"),
             false;
    const Encoding encoding = encoding_of(text_);
    if (encoding == Encoding::kUtf16Le || encoding == Encoding::kUtf16Be)
      return error(0, "", std::string("written in ") + encoding_name(encoding), "read it: " + command(file_)),
             false;
    if (encoding == Encoding::kUtf8Bom) {
      remark(1, "", "begins with a byte order mark", "it is read over");
      text_ = text_.substr(3);
    }
    if (encoding == Encoding::kWindows1252) {
      if (text_.find('\0') != std::string::npos) return error(0, "", "zero bytes: no text file"), false;
      warn(0, "", "not UTF-8: letters beyond ASCII are of some other code page",
           "µ and ° in units will not be understood; " + command(file_) + " reads it");
      text_ = utf8_of(bytes_, encoding);
    }
    if (text_.find('\0') != std::string::npos) return error(0, "", "zero bytes: no text file"), false;
    return true;
  }

  bool split() {
    std::size_t number = 0;
    std::vector<std::string> lines;
    std::vector<std::size_t> numbers;
    for (std::size_t at = 0; at < text_.size();) {
      const std::size_t end = std::min(text_.find('\n', at), text_.size());
      const std::string line = trimmed(text_.substr(at, end - at));
      at = end + 1;
      ++number;
      if (line.empty() || line.front() == '#') continue;
      lines.push_back(line);
      numbers.push_back(number);
    }
    if (lines.empty()) return error(0, "", "nothing but remarks and empty lines"), false;
    std::string joined_lines;
    for (std::size_t i = 0; i < std::min<std::size_t>(lines.size(), 200); ++i)
      joined_lines += lines[i] + "\n";
    const char separator = guess_separator(joined_lines, "");
    if (separator != ',' && lines.front().find(separator) != std::string::npos &&
        lines.front().find(',') == std::string::npos && (separator != ' ' || lines.size() > 1)) {
      error(numbers.front(), lines.front().substr(0, 30),
            std::string("columns parted by ") + separator_word(separator) + ", not by comma",
            "a spreadsheet or an instrument's table; read it: " + command(file_));
      for (std::size_t i = 1; i < lines.size(); ++i)
        for (const std::string& cell : parts_of(lines[i], separator == ' ' ? ' ' : separator))
          if (decimal_sign_in(cell) == DecimalSign::kComma) {
            error(numbers[i], cell, "a decimal comma", "that import reads it too");
            return false;
          }
      return false;
    }
    for (std::size_t i = 0; i < lines.size(); ++i) try {
        rows_.push_back({fields_of(lines[i], {}, {file_, numbers[i]}), numbers[i]});
      } catch (const InputError& problem) {
        error(numbers[i], lines[i].substr(0, 30), "a quote without its fellow",
              "quotes go around a whole field, doubled inside");
      }
    if (rows_.empty()) return false;
    header_ = rows_.front();
    rows_.erase(rows_.begin());
    return true;
  }

  bool is_axis(const std::string& name) const {
    if (machine_ != nullptr) return machine_->find_axis(name).has_value();
    if (name.size() == 1) return std::string("XYZABCUVW").find(name) != std::string::npos;
    return name.size() == 2 && name[0] == 'J' && std::isdigit(static_cast<unsigned char>(name[1])) != 0;
  }
  bool is_rotary(const std::string& name) const {
    if (machine_ != nullptr) return machine_->axes[*machine_->find_axis(name)].rotary;
    return std::string("ABCJ").find(name[0]) != std::string::npos;
  }
  std::string axis_of(const std::string& name, const std::string& prefix) const {
    if (!name.starts_with(prefix) || name.size() == prefix.size()) return "";
    const std::string axis = name.substr(prefix.size());
    return is_axis(axis) ? axis : "";
  }

  /// The unit that a column of this name needs, as a base unit; "" none; "?" any.
  std::string needed_unit(const std::string& name) const {
    if (is_axis(name)) return is_rotary(name) ? "deg" : "mm";
    for (const auto& [prefix, length, angle] :
         {std::tuple("v", "mm/s", "deg/s"), std::tuple("a", "mm/s^2", "deg/s^2"),
          std::tuple("since", "mm", "deg"), std::tuple("correction", "mm", "deg")})
      if (const std::string axis = axis_of(name, prefix); !axis.empty())
        return is_rotary(axis) ? angle : length;
    if (!axis_of(name, "dir").empty()) return "";
    static const std::map<std::string, std::string> kUnits = {
        {"x", "mm"},      {"y", "mm"},  {"z", "mm"},   {"rx", "deg"},    {"ry", "deg"},    {"rz", "deg"},
        {"length", "mm"}, {"d", "mm"},  {"cx", "mm"},  {"cy", "mm"},     {"cz", "mm"},     {"px", "mm"},
        {"py", "mm"},     {"pz", "mm"}, {"nx", ""},    {"ny", ""},       {"nz", ""},       {"t", "s"},
        {"run", ""},      {"role", ""}, {"visit", ""}, {"feed", "mm/s"}, {"curv", "1/mm"}, {"corrected", ""}};
    const auto found = kUnits.find(name);
    return found == kUnits.end() ? "?" : found->second;
  }

  /// All names that mean something in this file.
  std::vector<std::string> known_names() const {
    std::vector<std::string> names = {"x",   "y",    "z",    "rx",   "ry", "rz",    "length",   "d",  "cx",
                                      "cy",  "cz",   "px",   "py",   "pz", "nx",    "ny",       "nz", "t",
                                      "run", "role", "feed", "curv", "u",  "visit", "corrected"};
    if (machine_ == nullptr) return names;
    for (const Axis& axis : machine_->axes)
      for (const char* prefix : {"", "dir", "since", "v", "a", "correction"})
        names.push_back(prefix + axis.name);
    for (const Input& input : machine_->inputs) names.push_back(input.name);
    return names;
  }

  bool look_at_header() {
    while (!header_.cells.empty() && header_.cells.back().empty()) {
      header_.cells.pop_back();
      trailing_ = true;
    }
    if (trailing_)
      error(header_.line, "", "commas at the end of the header",
            "empty columns of a spreadsheet; read it: " + command(file_));
    std::size_t numbers = 0;
    for (const std::string& cell : header_.cells) numbers += plain_number(cell, false).has_value() ? 1 : 0;
    if (numbers * 2 > header_.cells.size())
      return error(header_.line, header_.cells.front(), "a row of numbers where the header should be",
                   "the first line names the columns: X[mm],x[mm],…"),
             false;
    std::set<std::string> seen;
    std::vector<std::string> own;
    const std::vector<std::string> known = known_names();
    for (const std::string& cell : header_.cells) {
      Column column;
      const auto open = cell.find('[');
      column.name = trimmed(cell.substr(0, open));
      const bool bracket = open != std::string::npos && cell.ends_with(']');
      if (bracket) column.unit = trimmed(cell.substr(open + 1, cell.size() - open - 2));
      if (!is_name(column.name) || (open != std::string::npos && !bracket)) {
        const Heading heading = parse_heading(cell);
        error(header_.line, cell,
              cell.empty() ? "a column without a name"
                           : "a column is name[unit], its name of letters, digits and _",
              heading.unit.empty() ? ""
                                   : "meant is " + name_from_words(heading.name) + "[" + heading.unit +
                                         "]? " + command(file_) + " reads it so");
        column.name = name_from_words(heading.name);
        column.unit = heading.unit;
      } else if (!column.unit.empty() && !find_unit(column.unit)) {
        const auto meant = unit_meant(column.unit);
        error(header_.line, column.unit, "nobody knows this unit",
              meant ? "meant is " + *meant + "? " + command(file_) + " reads it so"
                    : "known are " + known_units());
        column.unit = meant.value_or("");
      } else if (!bracket && needed_unit(column.name) != "" && needed_unit(column.name) != "?") {
        error(header_.line, column.name, "no unit",
              "write " + column.name + "[" + needed_unit(column.name) + "], or [um], [in], … as it is");
        column.unit = needed_unit(column.name);
      } else if (!column.unit.empty() && needed_unit(column.name) != "?") {
        const std::string needs = needed_unit(column.name);
        if (needs.empty())
          error(header_.line, cell, "a pure number or a word: it has no unit");
        else if (find_unit(needs)->dimension != find_unit(column.unit)->dimension)
          error(header_.line, cell, "this column needs a unit like " + needs);
      }
      if (!seen.insert(column.name).second) error(header_.line, column.name, "this column stands twice");
      column.label = column.name == "run" || column.name == "role" || column.name == "corrected";
      if (needed_unit(column.name) == "?" && column.name != "u" &&
          std::find(known.begin(), known.end(), column.name) == known.end()) {
        const auto meant = word_meant(column.name, known);
        const bool nearly = meant && column.name.size() > 2 && letters_apart(column.name, *meant) <= 1;
        if (nearly)
          warn(header_.line, column.name, "a column that the machine does not know",
               "did you mean " + *meant + "?");
        else
          own.push_back(column.name);
      }
      columns_.push_back(std::move(column));
    }
    if (!own.empty())
      remark(header_.line, joined(own, ", "),
             machine_ != nullptr ? "columns that the machine does not know: kept as candidates for diagnose"
                                 : "columns of one's own: kept as candidates for diagnose");
    look_for_columns();
    return true;
  }

  const Column* find(const std::string& name) const {
    for (const Column& column : columns_)
      if (column.name == name) return &column;
    return nullptr;
  }

  /// What the header lacks.
  void look_for_columns() {
    const bool any = std::any_of(columns_.begin(), columns_.end(),
                                 [](const Column& c) { return readings().contains(c.name); });
    if (!any)
      error(header_.line, "", "no measured column (x y z rx ry rz length d)",
            "small letters are what was measured, capitals where the machine was sent");
    for (const char* name : {"length", "d"}) {
      if (find(name) == nullptr) continue;
      for (const char* beside : name[0] == 'l' ? std::array{"cx", "cy", "cz", "cz", "cz", "cz"}
                                               : std::array{"nx", "ny", "nz", "px", "py", "pz"})
        if (find(beside) == nullptr) {
          findings_.add_of_kind(std::string("beside ") + beside, LintWeight::kError, header_.line, name,
                                std::string("this column needs ") + beside + " beside it");
        }
    }
    if (machine_ == nullptr) return;
    for (const Axis& axis : machine_->axes)
      if (find(axis.name) == nullptr) {
        std::vector<std::string> names;
        for (const Column& column : columns_) names.push_back(column.name);
        const auto meant = word_meant(axis.name, names);
        error(header_.line, axis.name, "the column of this axis is missing",
              meant && letters_apart(axis.name, *meant) == 0
                  ? "there is " + *meant + ": names have capitals where the machine file has them"
                  : "");
      }
    look_for_motion();
  }

  /// Motion that the machine's terms live on and that no column gives: it is then 0 in all rows.
  void look_for_motion() {
    std::set<std::string> wanted;
    bool lag = false;
    for (const auto* branch : {&machine_->tool, &machine_->workpiece})
      for (const Transform& transform : *branch)
        for (std::size_t i = 0; i < transform.dof_count(); ++i)
          walk(*transform.dof[i], [&](const Expr& node) {
            lag |= node.op == Op::kLag;
            if (node.op != Op::kSymbol) return;
            switch (node.symbol.kind) {
              case SymbolKind::kVelocity:
              case SymbolKind::kAcceleration:
              case SymbolKind::kDirection:
              case SymbolKind::kSince:
              case SymbolKind::kFeed:
              case SymbolKind::kCurvature:
              case SymbolKind::kNormal:
              case SymbolKind::kTime:
                wanted.insert(node.name);
                break;
              default:
                break;
            }
          });
    if (lag) wanted.insert("t");
    for (const std::string& name : wanted)
      if (find(name) == nullptr)
        warn(header_.line, name,
             "a term of the machine file needs this column; without it it is 0 in all rows and the term "
             "cannot be seen",
             "log it, or hold the term in the fit");
    for (const Input& input : machine_->inputs)
      if (find(input.name) == nullptr)
        warn(header_.line, input.name,
             fmt::format("no column for this input: it is {} in all rows", number_text(input.reference)));
  }

  // ---- its rows

  void look_at_rows() {
    std::vector<Row> kept;
    for (Row& row : rows_) {
      const std::size_t width = columns_.size();
      const bool tail = row.cells.size() > width &&
                        std::all_of(row.cells.begin() + static_cast<std::ptrdiff_t>(width), row.cells.end(),
                                    [](const std::string& cell) { return cell.empty(); });
      if (tail && !trailing_)
        findings_.add_of_kind("trailing", LintWeight::kError, row.line, "", "commas at the end of the row",
                              "empty columns of a spreadsheet; read it: " + command(file_));
      if (tail) row.cells.resize(width);
      if (std::all_of(row.cells.begin(), row.cells.end(),
                      [](const std::string& cell) { return cell.empty(); })) {
        findings_.add_of_kind("hollow", LintWeight::kError, row.line, "", "a row of nothing but commas",
                              "take it away; " + command(file_) + " does");
        continue;
      }
      if (row.cells.size() != width) {
        const bool more = row.cells.size() > width;
        findings_.add_of_kind(more ? "wide" : "narrow", LintWeight::kError, row.line,
                              joined(row.cells, ",").substr(0, 30),
                              fmt::format("{} fields where the header has {}", row.cells.size(), width),
                              more ? "decimal commas? Numbers have a decimal point here"
                                   : "a line that was cut, or a field without its comma");
        continue;
      }
      kept.push_back(std::move(row));
    }
    rows_ = std::move(kept);
    if (rows_.empty()) return error(header_.line, "", "no row below the header that can be read");
    for (std::size_t k = 0; k < columns_.size(); ++k) read_column(k);
  }

  void read_column(std::size_t k) {
    Column& column = columns_[k];
    const auto unit = find_unit(column.unit);
    std::size_t words = 0;
    for (const Row& row : rows_) words += !row.cells[k].empty() && !parse_number(row.cells[k]) ? 1 : 0;
    // Words in most rows of a column of one's own: labels, not numbers gone wrong.
    const bool own = needed_unit(column.name) == "?" && column.name != "u";
    if (own && 2 * words > rows_.size()) {
      column.label = true;
      remark(header_.line, column.name, "a column of words",
             "numbers can explain an error, words only tell rows apart");
    }
    for (const Row& row : rows_) {
      const std::string& cell = row.cells[k];
      column.cell.push_back(cell);
      column.value.push_back(kAbsent);
      if (column.label || cell.empty()) continue;
      const auto number = parse_number(cell);
      if (number) {
        column.value.back() = (unit ? unit->factor : 1) * *number + (unit ? unit->offset : 0);
        continue;
      }
      std::string meaning = "an empty cell is a reading that is missing";
      if (plain_number(cell, true))
        meaning = "decimal comma? " + command(file_) + " reads it";
      else if (plain_number(cell, false))
        meaning = "a sign between thousands? Write the number without";
      else if (!axis_of(column.name, "dir").empty())
        meaning = "a direction is 1, -1 or 0";
      findings_.add_of_kind("number " + column.name, LintWeight::kError, row.line, cell,
                            "not a number, in column " + column.name, meaning);
    }
  }

  // ---- what it says

  std::size_t line(std::size_t row) const { return rows_[row].line; }

  void look_at_meaning() {
    for (const Column& column : columns_) look_at_column(column);
    look_at_labels();
    look_at_time();
    look_at_normals();
    look_at_repeats();
    look_at_scale();
  }

  void look_at_column(const Column& column) {
    if (column.label) return;
    const bool reading = readings().contains(column.name);
    double least = std::numeric_limits<double>::infinity(), most = -least;
    std::size_t filled = 0;
    for (std::size_t row = 0; row < rows_.size(); ++row) {
      const double value = column.value[row];
      if (column.cell[row].empty() && is_axis(column.name))
        findings_.add_of_kind("empty " + column.name, LintWeight::kError, line(row), column.name,
                              "an axis position may not be empty");
      if (column.cell[row].empty() && (column.name == "u" || column.name == "t"))
        findings_.add_of_kind("empty " + column.name, LintWeight::kError, line(row), column.name,
                              "this column may not have empty cells");
      if (std::isnan(value)) continue;
      ++filled;
      least = std::min(least, value);
      most = std::max(most, value);
      if (!axis_of(column.name, "dir").empty() && value != -1 && value != 0 && value != 1)
        findings_.add_of_kind("dir " + column.name, LintWeight::kError, line(row), column.cell[row],
                              "a direction is 1, -1 or 0");
      if (column.name == "u" && value <= 0)
        findings_.add_of_kind("u", LintWeight::kError, line(row), column.cell[row],
                              "an uncertainty is greater than 0");
      if (column.name == "length" && value < 0)
        findings_.add_of_kind("length", LintWeight::kError, line(row), column.cell[row],
                              "a length is not negative");
    }
    if (filled == 0) {
      const bool template_cells = reading;
      findings_.add(LintWeight::kWarning, header_.line, column.name, "all cells are empty",
                    template_cells ? "a template that is still to be filled in?" : "");
      return;
    }
    if (reading) any_reading_ = true;
    if (is_axis(column.name)) look_at_axis(column, least, most);
    if (column.name == "feed" && most <= 0)
      warn(header_.line, "feed", "the feed is 0 in all rows",
           "lag and dynamic effects show only while the machine moves");
    if (column.name == "u" && most > 1)
      warn(header_.line, "u", fmt::format("an uncertainty of {} mm", number_text(most)), "µm? Write u[um]");
    if (find_unit(column.unit) && find_unit(column.unit)->dimension == Dimension::kTemperature &&
        (least < -40 || most > 120))
      warn(header_.line, column.name, fmt::format("from {:.4g} to {:.4g} degC", least, most),
           "K or another unit?");
  }

  void look_at_axis(const Column& column, double least, double most) {
    const bool turns = is_rotary(column.name);
    const char* const unit = turns ? "deg" : "mm";
    if (most - least < 1e-9)
      warn(header_.line, column.name,
           fmt::format("axis {} never moves: it stands at {} {} in all rows", column.name, number_text(least),
                       unit),
           "its errors cannot be told from the set-up's");
    if (machine_ == nullptr) return;
    const Axis& axis = machine_->axes[*machine_->find_axis(column.name)];
    if (!axis.min || !axis.max) return;
    const double travel = *axis.max - *axis.min, slack = 0.01 * travel;
    std::size_t outside = 0, first = 0;
    for (std::size_t row = 0; row < rows_.size(); ++row)
      if (column.value[row] < *axis.min - slack || column.value[row] > *axis.max + slack)
        if (outside++ == 0) first = row;
    const auto close = [&](double factor) {
      return least * factor >= *axis.min - slack && most * factor <= *axis.max + slack &&
             (most - least) * factor > 0.2 * travel;
    };
    if (outside > 0) {
      std::string meaning = "another machine, or another zero?";
      if (close(1e-3)) meaning = "µm read as mm?";
      if (close(1 / 25.4)) meaning = "";
      if (turns && close(1.0 / 3600)) meaning = "arcsec read as deg?";
      warn(line(first), column.cell[first],
           fmt::format("{} is outside the travel of {} to {} {} in {} of {} rows", column.name,
                       number_text(*axis.min), number_text(*axis.max), unit, outside, rows_.size()),
           meaning);
    } else if (most - least > 1e-9 && most - least < 0.05 * travel) {
      std::string meaning;
      if (!turns && close(25.4)) meaning = "inch read as mm?";
      if (!turns && close(1e3)) meaning = "m read as mm?";
      if (turns && close(180 / std::acos(-1.0))) meaning = "rad read as deg?";
      remark(header_.line, column.name,
             fmt::format("moves over {:.3g} of {:.4g} {} only", most - least, travel, unit), meaning);
    }
  }

  void look_at_labels() {
    std::size_t check = 0;
    if (const Column* role = find("role"))
      for (std::size_t row = 0; row < rows_.size(); ++row) {
        const std::string& word = role->cell[row];
        if (word != "fit" && word != "check" && !word.empty()) {
          const auto meant = word_meant(word, {"fit", "check"});
          findings_.add_of_kind("role", LintWeight::kError, line(row), word, "a role is fit or check",
                                meant ? "did you mean " + *meant + "?" : "");
        }
        check += word == "check" ? 1 : 0;
      }
    if (check == rows_.size())
      warn(header_.line, "role", "all rows are check rows: nothing is left for a fit");
    if (check == 0)
      remark(header_.line, "role", "no check rows: nothing will judge the fit",
             "give some rows the role check, spread over the volume");
    if (find("u") == nullptr)
      remark(header_.line, "u",
             "no standard uncertainty: the noise is taken from repeats, else from the residual",
             "a column u[um], the instrument's");
    if (!any_reading_)
      error(header_.line, "", "no reading in any row", "a template that is still to be filled in?");
  }

  void look_at_time() {
    const Column *time = find("t"), *run = find("run");
    if (time == nullptr) return;
    std::map<std::string, std::size_t> last;
    for (std::size_t row = 0; row < rows_.size(); ++row) {
      if (std::isnan(time->value[row])) continue;
      const std::string label = run == nullptr ? "" : run->cell[row];
      const auto before = last.find(label);
      if (before != last.end() && time->value[row] < time->value[before->second])
        findings_.add_of_kind(
            "time " + label, LintWeight::kWarning, line(row), time->cell[row],
            fmt::format("t falls in {}: {} s after {} s",
                        label.empty() ? std::string("this file") : "run " + label,
                        number_text(time->value[row]), number_text(time->value[before->second])),
            "rows are in the order of time; a new set-up or clock is a new run");
      last[label] = row;
    }
  }

  void look_at_normals() {
    const Column *nx = find("nx"), *ny = find("ny"), *nz = find("nz"), *d = find("d");
    if (nx == nullptr || ny == nullptr || nz == nullptr) return;
    for (std::size_t row = 0; row < rows_.size(); ++row) {
      if (d != nullptr && std::isnan(d->value[row])) continue;
      const double size = std::hypot(nx->value[row], ny->value[row], nz->value[row]);
      if (std::isnan(size) || std::abs(size - 1) <= 0.01) continue;
      findings_.add_of_kind("normal", d != nullptr ? LintWeight::kError : LintWeight::kWarning, line(row),
                            nx->cell[row],
                            fmt::format("nx ny nz is no unit vector: its length is {:.4g}", size));
    }
  }

  void look_at_repeats() {
    std::map<std::vector<std::string>, std::size_t> seen;
    for (std::size_t row = 0; row < rows_.size(); ++row) {
      const auto [first, fresh] = seen.emplace(rows_[row].cells, row);
      if (!fresh)
        findings_.add_of_kind("twice", LintWeight::kWarning, line(row), "",
                              fmt::format("the same row as line {}, to the last digit", line(first->second)),
                              "copied twice? It would count as two readings");
    }
  }

  /// Are measured points as far apart as the machine was sent? A factor of 1000 or 25.4 is a unit.
  void look_at_scale() {
    double measured = 0, sent = 0;
    std::size_t used = 0;
    for (const char letter : {'x', 'y', 'z'}) {
      const Column* point = find(std::string(1, letter));
      const Column* position = find(std::string(1, static_cast<char>(std::toupper(letter))));
      if (point == nullptr || position == nullptr) continue;
      double mean_p = 0, mean_q = 0, count = 0;
      for (std::size_t row = 0; row < rows_.size(); ++row)
        if (!std::isnan(point->value[row]) && !std::isnan(position->value[row])) {
          mean_p += point->value[row];
          mean_q += position->value[row];
          count += 1;
        }
      if (count < 3) continue;
      for (std::size_t row = 0; row < rows_.size(); ++row)
        if (!std::isnan(point->value[row]) && !std::isnan(position->value[row])) {
          measured += std::pow(point->value[row] - mean_p / count, 2);
          sent += std::pow(position->value[row] - mean_q / count, 2);
        }
      ++used;
    }
    // Where turning axes swing the tool, travel of the slides says nothing about the points.
    for (const Column& column : columns_)
      if (is_axis(column.name) && is_rotary(column.name)) return;
    if (used == 0 || sent < 1 || measured <= 0) return;
    const double ratio = std::sqrt(measured / sent);
    const auto near = [&](double factor) { return std::abs(ratio / factor - 1) < 0.15; };
    std::string meaning;
    if (near(1e3)) meaning = "the readings are in µm, or the positions in m?";
    if (near(1e-3)) meaning = "the readings are in m, or the positions in µm?";
    if (near(25.4)) meaning = "the positions are in inch?";
    if (near(1 / 25.4)) meaning = "the readings are in inch?";
    if (meaning.empty() && ratio < 0.02)
      meaning = "deviations instead of positions? vernier import table " + quoted_for_shell(file_) +
                " --deviation \"X[mm]=x\" … adds them to the positions";
    if (!meaning.empty())
      warn(header_.line, "x",
           fmt::format("what was measured spreads over {:.4g} of what the machine was sent", ratio), meaning);
  }

  /// What a fit says of the file, where nothing above has said it.
  void confirm() {
    if (machine_ == nullptr || findings_.any(LintWeight::kError)) return;
    try {
      parse_measurement(bytes_, file_, *machine_, [](Measurement&, const Machine&, const std::string&) {});
    } catch (const InputError& problem) {
      const std::string message = problem.what();
      error(0, "", message.starts_with(file_ + ":") ? "line " + message.substr(file_.size() + 1) : message);
    }
  }

  const std::string bytes_;  // as a fit would read them
  std::string text_;         // without mark, in UTF-8
  const std::string& file_;
  const Machine* machine_;
  LintFindings findings_;
  Row header_;
  std::vector<Row> rows_;
  std::vector<Column> columns_;
  bool trailing_ = false, any_reading_ = false;
};

}  // namespace

std::vector<LintFinding> lint_measurement(const std::string& bytes, const std::string& file,
                                          const Machine* machine) {
  return Look(bytes, file, machine).all();
}

std::string import_command_for(const std::string& bytes, const std::string& file) {
  if (is_workbook(bytes)) return command(file);
  const Encoding encoding = encoding_of(bytes);
  if (encoding == Encoding::kUtf16Le || encoding == Encoding::kUtf16Be) return command(file);
  try {
    const Sheet sheet = read_sheet(bytes, file);
    const SheetTable table = parts_of_sheet(sheet);
    if (!table.has_headings) return "";
    bool odd = sheet.separator != ',' || sheet.decimal_comma || table.units_row > 0 ||
               encoding == Encoding::kWindows1252;
    for (const std::string& cell : sheet.rows[table.heading_row]) {
      const auto open = cell.find('[');
      const std::string name = trimmed(cell.substr(0, open));
      odd |= !is_name(name) || (open != std::string::npos &&
                                !find_unit(trimmed(cell.substr(open + 1, cell.size() - open - 2))));
      odd |= open == std::string::npos && !parse_heading(cell).unit.empty();
    }
    // Trailing separators leave columns that a sheet has dropped already.
    const auto heading = static_cast<std::ptrdiff_t>(sheet.line[table.heading_row]);
    std::size_t at = 0;
    for (std::ptrdiff_t line = 1; line < heading && at != std::string::npos; ++line)
      at = bytes.find('\n', at) + 1;
    odd |= trimmed(bytes.substr(at, bytes.find('\n', at) - at)).ends_with(',');
    return odd ? command(file) : "";
  } catch (const InputError&) {
    return "";
  }
}

}  // namespace vernier
