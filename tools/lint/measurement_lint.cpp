// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/lint/measurement_lint.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "tools/format/columns.h"
#include "tools/format/units.h"
#include "tools/import/distances/pair_names.h"
#include "tools/import/kinds.h"
#include "tools/lint/lint_table.h"
#include "tools/lint/measurement_meaning.h"
#include "tools/model/chain/prediction.h"
#include "tools/model/machine.h"
#include "tools/model/measurement.h"
#include "tools/model/measurement_names.h"
#include "tools/sheet/encoding.h"
#include "tools/sheet/heading.h"
#include "tools/sheet/sheet.h"
#include "tools/sheet/sheet_number.h"
#include "tools/text/csv.h"
#include "tools/text/numbers.h"
#include "tools/text/similar.h"
#include "tools/text/words.h"

namespace vernier::lint {
namespace {

constexpr double kAbsent = std::numeric_limits<double>::quiet_NaN();  // an empty cell

std::string command(const std::string& file, const std::string& kind = "table") {
  const auto slash = file.rfind('/'), dot = file.rfind('.');
  const std::string stem = file.substr(
      0, dot == std::string::npos || (slash != std::string::npos && dot < slash) ? file.size() : dot);
  return "vernier import " + kind + " " + quoted_for_shell(file) + " -o " +
         quoted_for_shell(stem + "_read.csv");
}

class Look {
 public:
  Look(std::string bytes, const std::string& file, const model::Machine* machine)
      : bytes_(std::move(bytes)),
        text_(bytes_),
        file_(file),
        machine_(machine),
        findings_(file),
        names_(machine) {}

  std::vector<LintFinding> all() {
    if (look_at_bytes() && split() && look_at_header()) {
      look_at_rows();
      look_for_lengths_between_points();
      if (!table_.rows.empty()) look_at_meaning(table_, file_, machine_, findings_);
    }
    confirm();
    return findings_.take();
  }

 private:
  // ---- how it is written

  bool look_at_bytes() {
    if (const auto* const kind = importer::import_kind_of(file_))
      return findings_.error(0, "", "this is the file of an instrument, not a measurement file",
                             "read it: " + command(file_, kind->name)),
             false;
    if (sheet::is_workbook(text_))
      return findings_.error(0, "", "this file is a workbook (.xlsx), not a measurement file",
                             "read it: " + command(file_)),
             false;
    if (text_.starts_with("\xD0\xCF\x11\xE0"))
      return findings_.error(0, "", "this file is a workbook of the old format (.xls)",
                             "save the workbook as .xlsx or CSV, then use vernier import table"),
             false;
    const sheet::Encoding encoding = sheet::encoding_of(text_);
    if (encoding == sheet::Encoding::kUtf16Le || encoding == sheet::Encoding::kUtf16Be)
      return findings_.error(0, "", std::string("written in ") + sheet::encoding_name(encoding),
                             "read it: " + command(file_)),
             false;
    if (encoding == sheet::Encoding::kUtf8Bom) {
      findings_.remark(1, "", "the file begins with a byte order mark", "the commands ignore it");
      text_ = text_.substr(3);
    }
    if (encoding == sheet::Encoding::kWindows1252) {
      if (text_.find('\0') != std::string::npos)
        return findings_.error(0, "", "zero bytes: no text file"), false;
      findings_.warn(0, "", "the file is not UTF-8: letters beyond ASCII are in another code page",
                     fmt::format("µ and ° in units will not be understood; {} reads it", command(file_)));
      text_ = sheet::utf8_of(bytes_, encoding);
    }
    if (text_.find('\0') != std::string::npos)
      return findings_.error(0, "", "zero bytes: no text file"), false;
    return true;
  }

  bool split() {
    std::size_t number = 0;
    std::vector<std::string> lines;
    std::vector<std::size_t> numbers;
    for (std::size_t at = 0; at < text_.size();) {
      const std::size_t end = std::min(text_.find('\n', at), text_.size());
      const std::string line = text::trimmed(text_.substr(at, end - at));
      at = end + 1;
      ++number;
      if (line.empty() || line.front() == '#') continue;
      lines.push_back(line);
      numbers.push_back(number);
    }
    if (lines.empty())
      return findings_.error(0, "", "the file contains only comments and empty lines"), false;
    std::string joined_lines;
    for (std::size_t i = 0; i < std::min<std::size_t>(lines.size(), 200); ++i)
      joined_lines += lines[i] + "\n";
    const char separator = sheet::guess_separator(joined_lines, "");
    if (separator != ',' && lines.front().find(separator) != std::string::npos &&
        lines.front().find(',') == std::string::npos && (separator != ' ' || lines.size() > 1)) {
      findings_.error(
          numbers.front(), lines.front().substr(0, 30),
          std::string("columns separated by ") + sheet::separator_word(separator) + ", not by comma",
          fmt::format("a spreadsheet or an instrument's table; read it: {}", command(file_)));
      for (std::size_t i = 1; i < lines.size(); ++i)
        for (const std::string& cell : text::parts_of(lines[i], separator == ' ' ? ' ' : separator))
          if (sheet::decimal_sign_in(cell) == sheet::DecimalSign::kComma) {
            findings_.error(numbers[i], cell, "a decimal comma", "that import reads it too");
            return false;
          }
      return false;
    }
    for (std::size_t i = 0; i < lines.size(); ++i) try {
        table_.rows.push_back({text::fields_of(lines[i], {}, {file_, numbers[i]}), numbers[i]});
      } catch (const text::InputError& problem) {
        findings_.error(numbers[i], lines[i].substr(0, 30), "a quote without its fellow",
                        "put quotes around the whole field, and double a quote inside the field");
      }
    if (table_.rows.empty()) return false;
    header_ = table_.rows.front().cells;
    table_.header_line = table_.rows.front().line;
    table_.rows.erase(table_.rows.begin());
    return true;
  }

  bool look_at_header() {
    while (!header_.empty() && header_.back().empty()) {
      header_.pop_back();
      trailing_ = true;
    }
    if (trailing_)
      findings_.error(
          table_.header_line, "", "the header ends with commas",
          fmt::format("the file has empty columns, as a spreadsheet writes them; import the file with {}",
                      command(file_)));
    std::size_t numbers = 0;
    for (const std::string& cell : header_) numbers += sheet::plain_number(cell, false).has_value() ? 1 : 0;
    if (numbers * 2 > header_.size())
      return findings_.error(table_.header_line, header_.front(),
                             "the first line contains numbers, but it must be the header",
                             "the first line names the columns: X[mm],x[mm],…"),
             false;
    std::set<std::string> seen;
    std::vector<std::string> own;
    const std::vector<std::string> known = names_.known();
    for (const std::string& cell : header_) {
      LintColumn column;
      const auto open = cell.find('[');
      column.name = text::trimmed(cell.substr(0, open));
      const bool bracket = open != std::string::npos && cell.ends_with(']');
      if (bracket) column.unit = text::trimmed(cell.substr(open + 1, cell.size() - open - 2));
      if (!text::is_name(column.name) || (open != std::string::npos && !bracket)) {
        const sheet::Heading heading = sheet::parse_heading(cell);
        findings_.error(table_.header_line, cell,
                        cell.empty()
                            ? "a column without a name"
                            : "a column heading is name[unit]; the name has only letters, digits and _",
                        heading.unit.empty() ? ""
                                             : "meant is " + sheet::name_from_words(heading.name) + "[" +
                                                   heading.unit + "]? " + command(file_) + " reads it so");
        column.name = sheet::name_from_words(heading.name);
        column.unit = heading.unit;
      } else if (!column.unit.empty() && !format::find_unit(column.unit)) {
        const auto meant = sheet::unit_meant(column.unit);
        findings_.error(table_.header_line, column.unit, "unknown unit",
                        meant ? "meant is " + *meant + "? " + command(file_) + " reads it so"
                              : "known are " + format::known_units());
        column.unit = meant.value_or("");
      } else if (!bracket && !names_.needed_unit(column.name).empty() &&
                 names_.needed_unit(column.name) != "?") {
        findings_.error(
            table_.header_line, column.name, "no unit",
            "write " + column.name + "[" + names_.needed_unit(column.name) + "], or [um], [in], … as it is");
        column.unit = names_.needed_unit(column.name);
      } else if (!column.unit.empty() && names_.needed_unit(column.name) != "?") {
        const std::string needs = names_.needed_unit(column.name);
        if (needs.empty())
          findings_.error(table_.header_line, cell,
                          "this column is a pure number or a word and must not have a unit");
        else if (format::find_unit(needs)->dimension != format::find_unit(column.unit)->dimension)
          findings_.error(table_.header_line, cell,
                          fmt::format("this column needs a unit, for example {}", needs));
      }
      if (!seen.insert(column.name).second)
        findings_.error(table_.header_line, column.name, "this column occurs twice");
      const format::ColumnGroup* const of_formats = format::find_column(column.name);
      column.label = of_formats != nullptr && of_formats->words;
      if (names_.needed_unit(column.name) == "?" &&
          std::find(known.begin(), known.end(), column.name) == known.end()) {
        const auto meant = text::word_meant(column.name, known);
        const bool nearly = meant && column.name.size() > 2 && text::letters_apart(column.name, *meant) <= 1;
        if (nearly)
          findings_.warn(table_.header_line, column.name, "the machine file does not use this column",
                         "did you mean " + *meant + "?");
        else
          own.push_back(column.name);
      }
      table_.columns.push_back(std::move(column));
    }
    if (!own.empty())
      findings_.remark(
          table_.header_line, text::joined(own, ", "),
          machine_ != nullptr
              ? "the machine file does not use these columns: diagnose tests whether they explain the "
                "residual"
              : "the formats do not define these columns: diagnose tests whether they explain the residual");
    look_for_columns();
    return true;
  }

  /// Lengths between two named points ("AB"), in a file without the positions of an axis.
  void look_for_lengths_between_points() {
    const LintColumn* points = nullptr;
    bool length = false;
    for (const LintColumn& column : table_.columns) {
      if (names_.is_axis(column.name)) return;
      const auto unit = column.unit.empty() ? std::nullopt : format::find_unit(column.unit);
      length |= unit && unit->dimension == format::Dimension::kLength;
      if (column.cell.size() > 1 &&
          std::all_of(column.cell.begin(), column.cell.end(), importer::names_two_points))
        points = &column;
    }
    if (points != nullptr && length)
      findings_.error(
          table_.header_line, points->name,
          "the rows are lengths between two points, and a fit needs the positions of the points",
          fmt::format("give the positions: vernier import table {} --point \"{}=X,Y,Z\" and so on "
                      "for each point (the page touch, \"A printer and a printed square\")",
                      file_, points->cell.front().substr(0, 1)));
  }

  /// Columns that are missing in the header.
  void look_for_columns() {
    const bool any = std::any_of(table_.columns.begin(), table_.columns.end(),
                                 [&](const LintColumn& c) { return names_.is_reading(table_, c); });
    if (!any && !names_.lacks_artefact_of(table_))
      findings_.error(table_.header_line, "", "no measured column (" + format::reading_column_names() + ")",
                      "small letters are measured values, capitals commanded positions; if the readings "
                      "have other names, assign the columns: " +
                          command(file_));
    for (const LintColumn& column : table_.columns) {
      if (!names_.is_reading(table_, column)) continue;
      for (const format::ColumnGroup* const group :
           format::columns_beside(format::find_column(column.name)->form))
        for (const char* const beside : group->list())
          if (table_.find(beside) == nullptr)
            findings_.add_of_kind(std::string("beside ") + beside, LintWeight::kError, table_.header_line,
                                  column.name, std::string("this column needs ") + beside + " beside it");
    }
    if (machine_ == nullptr) return;
    const auto has_column = [&](const model::Axis& axis) { return table_.find(axis.name) != nullptr; };
    const bool none =
        machine_->axes.size() > 1 && std::none_of(machine_->axes.begin(), machine_->axes.end(), has_column);
    for (const model::Axis& axis : machine_->axes)
      if (!has_column(axis)) {
        std::vector<std::string> names;
        for (const LintColumn& column : table_.columns) names.push_back(column.name);
        const auto meant = text::word_meant(axis.name, names);
        findings_.error(
            table_.header_line, axis.name, "the column of this axis is missing",
            meant && text::letters_apart(axis.name, *meant) == 0
                ? fmt::format("there is {}: names have capitals where the machine file has them", *meant)
            : none
                ? std::string(
                      "no axis of the machine has a column; if the columns have other names (a1, joint_1), "
                      "read them by their names: vernier import table FILE --machine MACHINE.xml -o "
                      "NEW.csv")
                : fmt::format(
                      "if the axis did not move, add its position: vernier import table FILE {} -o NEW.csv",
                      model::set_of_axis(axis)));
      }
    look_for_motion();
  }

  /// Motion that the machine's terms live on and that no column gives: it is then 0 in all rows.
  void look_for_motion() {
    std::set<std::string> wanted;
    bool lag = false;
    for (const auto* branch : {&machine_->tool, &machine_->workpiece})
      for (const model::Transform& transform : *branch)
        for (std::size_t i = 0; i < transform.dof_count(); ++i)
          model::walk(*transform.dof[i], [&](const model::Expr& node) {
            lag |= node.op == model::Op::kLag;
            if (node.op != model::Op::kSymbol) return;
            switch (node.symbol.kind) {
              case model::SymbolKind::kVelocity:
              case model::SymbolKind::kAcceleration:
              case model::SymbolKind::kDirection:
              case model::SymbolKind::kSince:
              case model::SymbolKind::kFeed:
              case model::SymbolKind::kCurvature:
              case model::SymbolKind::kNormal:
              case model::SymbolKind::kTime:
                wanted.insert(node.name);
                break;
              default:
                break;
            }
          });
    if (lag) wanted.insert(format::columns::kTime);
    for (const std::string& name : wanted)
      if (table_.find(name) == nullptr)
        findings_.warn(table_.header_line, name,
                       "a term of the machine file uses this column; without the column the quantity is 0 in "
                       "all rows, and the readings do not determine the term",
                       kRecordOrHold);
    for (const model::Input& input : machine_->inputs)
      if (table_.find(input.name) == nullptr)
        findings_.warn(table_.header_line, input.name,
                       fmt::format("no column for this input: it is {} in all rows",
                                   text::number_text(input.reference)));
  }

  // ---- its rows

  void look_at_rows() {
    std::vector<LintRow> kept;
    for (LintRow& row : table_.rows) {
      const std::size_t width = table_.columns.size();
      const bool tail = row.cells.size() > width &&
                        std::all_of(row.cells.begin() + static_cast<std::ptrdiff_t>(width), row.cells.end(),
                                    [](const std::string& cell) { return cell.empty(); });
      if (tail && !trailing_)
        findings_.add_of_kind(
            "trailing", LintWeight::kError, row.line, "", "commas at the end of the row",
            fmt::format("the file has empty columns, as a spreadsheet writes them; import the file with {}",
                        command(file_)));
      if (tail) row.cells.resize(width);
      if (std::all_of(row.cells.begin(), row.cells.end(),
                      [](const std::string& cell) { return cell.empty(); })) {
        findings_.add_of_kind("hollow", LintWeight::kError, row.line, "", "a row that contains only commas",
                              "take it away; " + command(file_) + " does");
        continue;
      }
      if (row.cells.size() != width) {
        const bool more = row.cells.size() > width;
        findings_.add_of_kind(more ? "wide" : "narrow", LintWeight::kError, row.line,
                              text::joined(row.cells, ",").substr(0, 30),
                              fmt::format("{} fields where the header has {}", row.cells.size(), width),
                              more ? "decimal commas? Numbers have a decimal point here"
                                   : "the line is incomplete, or a comma between two fields is missing");
        continue;
      }
      kept.push_back(std::move(row));
    }
    table_.rows = std::move(kept);
    if (table_.rows.empty())
      return findings_.error(table_.header_line, "", "no row below the header is readable");
    for (std::size_t k = 0; k < table_.columns.size(); ++k) read_column(k);
  }

  void read_column(std::size_t k) {
    LintColumn& column = table_.columns[k];
    const auto unit = format::find_unit(column.unit);
    std::size_t words = 0, filled = 0;
    for (const LintRow& row : table_.rows) {
      filled += row.cells[k].empty() ? 0 : 1;
      words += !row.cells[k].empty() && !text::parse_number(row.cells[k]) ? 1 : 0;
    }
    // Words in most cells that hold anything of a column of one's own: labels, not numbers gone wrong.
    const format::ColumnGroup* const known = format::find_column(column.name);
    const bool own = names_.needed_unit(column.name) == "?" && (known == nullptr || known->later);
    if (own && 2 * words > filled) {
      column.label = true;
      findings_.remark(
          table_.header_line, column.name, "a column of words",
          "only a column of numbers can explain an error; a column of words only forms groups of rows");
    }
    for (const LintRow& row : table_.rows) {
      const std::string& cell = row.cells[k];
      column.cell.push_back(cell);
      column.value.push_back(kAbsent);
      if (column.label || cell.empty()) continue;
      const auto number = text::parse_number(cell);
      if (number) {
        column.value.back() = (unit ? unit->factor : 1) * *number + (unit ? unit->offset : 0);
        continue;
      }
      std::string meaning = "an empty cell means that the reading is missing";
      if (sheet::plain_number(cell, true))
        meaning = "decimal comma? " + command(file_) + " reads it";
      else if (sheet::plain_number(cell, false))
        meaning = "is this a thousands separator? Write the number without it";
      else if (names_.is_of_axis(column.name, format::AxisQuantity::kSense))
        meaning = "a direction is 1, -1 or 0";
      findings_.add_of_kind("number " + column.name, LintWeight::kError, row.line, cell,
                            "not a number, in column " + column.name, meaning);
    }
  }

  /// The error that a fit reports for the file, if no finding above has reported it.
  void confirm() {
    if (machine_ == nullptr || findings_.any(LintWeight::kError)) return;
    try {
      const model::Measurement rows = model::parse_measurement(
          bytes_, file_, *machine_, [](model::Measurement&, const model::Machine&, const std::string&) {});
      // What a fit begins with: the chain has a value at every row, as the file has it and at nominal.
      model::predict(*machine_, rows);
      model::predict(model::nominal_machine(*machine_), rows);
    } catch (const text::InputError& problem) {
      const std::string message = problem.what();
      findings_.error(
          0, "", message.starts_with(file_ + ":") ? "line " + message.substr(file_.size() + 1) : message);
    }
  }

  const std::string bytes_;  // as a fit would read them
  std::string text_;         // without mark, in UTF-8
  const std::string& file_;
  const model::Machine* machine_;
  LintFindings findings_;
  LintNames names_;
  std::vector<std::string> header_;  // its fields
  LintTable table_;
  bool trailing_ = false;
};

}  // namespace

std::vector<LintFinding> lint_measurement(const std::string& bytes, const std::string& file,
                                          const model::Machine* machine) {
  return Look(bytes, file, machine).all();
}

namespace {

/// True for a file of a printer: its configuration, its height map, or its log with touches.
bool is_of_printer(const std::string& text) {
  if (text.starts_with("RepRapFirmware height map")) return true;
  return text.find("[bed_mesh ") != std::string::npos || text.find("probe at ") != std::string::npos ||
         text.find("probe: at ") != std::string::npos ||
         (text.find("Bed X:") != std::string::npos && text.find("Z:") != std::string::npos);
}

}  // namespace

std::string import_command_for(const std::string& bytes, const std::string& file) {
  if (file.ends_with(".comp"))
    return "vernier import-tables linuxcnc " + quoted_for_shell(file) +
           " --machine MACHINE.xml --axis X -o NEW.xml";
  if (!sheet::is_workbook(bytes) && is_of_printer(sheet::utf8_text(bytes))) return command(file, "printer");
  if (const auto* const kind = importer::import_kind_of(file)) return command(file, kind->name);
  if (sheet::is_workbook(bytes)) return command(file);
  const sheet::Encoding encoding = sheet::encoding_of(bytes);
  if (encoding == sheet::Encoding::kUtf16Le || encoding == sheet::Encoding::kUtf16Be) return command(file);
  try {
    const sheet::Sheet sheet = sheet::read_sheet(bytes, file);
    const sheet::SheetTable table = sheet::parts_of_sheet(sheet);
    if (!table.has_headings) return "";
    bool odd = sheet.separator != ',' || sheet.decimal_comma || table.units_row > 0 ||
               encoding == sheet::Encoding::kWindows1252;
    for (const std::string& cell : sheet.rows[table.heading_row]) {
      const auto open = cell.find('[');
      const std::string name = text::trimmed(cell.substr(0, open));
      odd |= !text::is_name(name) ||
             (open != std::string::npos &&
              !format::find_unit(text::trimmed(cell.substr(open + 1, cell.size() - open - 2))));
      odd |= open == std::string::npos && !sheet::parse_heading(cell).unit.empty();
    }
    // Trailing separators leave columns that a sheet has dropped already.
    const auto heading = static_cast<std::ptrdiff_t>(sheet.line[table.heading_row]);
    std::size_t at = 0;
    for (std::ptrdiff_t line = 1; line < heading && at != std::string::npos; ++line)
      at = bytes.find('\n', at) + 1;
    odd |= text::trimmed(bytes.substr(at, bytes.find('\n', at) - at)).ends_with(',');
    return odd ? command(file) : "";
  } catch (const text::InputError&) {
    return "";
  }
}

}  // namespace vernier::lint
