// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/sheet/workbook.h"

#include <fmt/format.h>
#include <zip.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <pugixml.hpp>

#include "tools/sheet/dates.h"
#include "tools/sheet/number_format.h"
#include "tools/sheet/sheet_number.h"
#include "tools/text/error.h"
#include "tools/text/numbers.h"
#include "tools/text/words.h"

namespace vernier::sheet {
namespace {

/// A larger unpacked part is not a survey but a decompression bomb.
constexpr zip_uint64_t kMostBytes = 256u << 20;
/// A row has all cells up to its last one. Rows with one cell far to the right would make a small
/// file large.
constexpr std::size_t kMostEmpty = 4u << 20, kMostEmptyForOne = 2;
constexpr std::size_t kMostRows = 1048576;  // of the format itself

class Package {
 public:
  Package(const std::string& bytes, const std::string& file) : file_(file) {
    zip_error_t error;
    zip_error_init(&error);
    zip_source_t* const source = zip_source_buffer_create(bytes.data(), bytes.size(), 0, &error);
    zip_ = zip_open_from_source(source, ZIP_RDONLY, &error);
    if (zip_ == nullptr) {
      zip_source_free(source);
      throw text::InputError({file, 0}, "", std::string("not a workbook: ") + zip_error_strerror(&error));
    }
  }
  ~Package() { zip_discard(zip_); }
  Package(const Package&) = delete;
  Package& operator=(const Package&) = delete;

  std::optional<std::string> part(const std::string& name) const {
    zip_stat_t status;
    if (zip_stat(zip_, name.c_str(), ZIP_FL_NOCASE, &status) != 0) return std::nullopt;
    if (status.size > kMostBytes)
      throw text::InputError({file_, 0}, name, "this part of the workbook is too large");
    const std::unique_ptr<zip_file_t, int (*)(zip_file_t*)> open(zip_fopen_index(zip_, status.index, 0),
                                                                 zip_fclose);
    std::string text(status.size, '\0');
    if (!open || zip_fread(open.get(), text.data(), text.size()) != static_cast<zip_int64_t>(text.size()))
      throw text::InputError({file_, 0}, name, "this part of the workbook cannot be read");
    return text;
  }

 private:
  std::string file_;
  zip_t* zip_ = nullptr;
};

/// Returns the name without its prefix: x:row and row are the same.
std::string_view local(const pugi::xml_node& node) {
  const std::string_view name = node.name();
  const auto colon = name.find(':');
  return colon == std::string_view::npos ? name : name.substr(colon + 1);
}

pugi::xml_node child(const pugi::xml_node& node, std::string_view name) {
  for (const pugi::xml_node one : node.children())
    if (local(one) == name) return one;
  return {};
}

/// Returns all text of a string, including runs with their own formatting, without phonetic hints.
std::string text_of(const pugi::xml_node& node) {
  std::string text;
  for (const pugi::xml_node one : node.children()) {
    if (local(one) == "t") text += one.text().get();
    if (local(one) != "r") continue;
    for (const pugi::xml_node run : one.children())
      if (local(run) == "t") text += run.text().get();
  }
  return text;
}

class Reader {
 public:
  Reader(const std::string& bytes, const std::string& file) : file_(file), package_(bytes, file) {
    read_part("xl/workbook.xml", workbook_);
    if (const auto strings = package_.part("xl/sharedStrings.xml")) {
      pugi::xml_document document;
      load(document, *strings, "xl/sharedStrings.xml");
      for (const pugi::xml_node item : document.document_element().children())
        if (local(item) == "si") strings_.push_back(text_of(item));
    }
    from_1904_ = child(workbook_.document_element(), "workbookPr").attribute("date1904").as_bool();
    if (const auto styles = package_.part("xl/styles.xml")) read_styles(*styles);
  }

  WorkbookSheet read(const std::string& wanted) {
    std::vector<std::string> names, hidden;
    std::optional<WorkbookSheet> found;
    std::size_t number = 0;
    for (const pugi::xml_node entry : child(workbook_.document_element(), "sheets").children()) {
      names.emplace_back(entry.attribute("name").value());
      ++number;
      // A hidden sheet is often an old state of the data: it is read only if the user names it.
      const std::string_view state = entry.attribute("state").value();
      if (wanted.empty() && (state == "hidden" || state == "veryHidden")) {
        hidden.push_back(names.back());
        continue;
      }
      if (found && (!wanted.empty() || is_table(*found))) continue;
      if (!wanted.empty() && wanted != names.back() && wanted != std::to_string(number)) continue;
      WorkbookSheet sheet = cells_of(entry);
      if (!wanted.empty() || is_table(sheet) || (!found && !sheet.rows.empty())) found = std::move(sheet);
    }
    if (found) {
      found->all = std::move(names);
      look_beside(*found);
      look_at_hidden_sheets(*found);
      return std::move(*found);
    }
    if (wanted.empty() && !hidden.empty())
      throw text::InputError({file_, 0}, "",
                             fmt::format("no visible sheet of this workbook contains a cell; hidden sheets "
                                         "are {}: to read one, give --sheet",
                                         text::joined(hidden, ", ")));
    if (wanted.empty()) throw text::InputError({file_, 0}, "", "no sheet of this workbook contains a cell");
    throw text::InputError(
        {file_, 0}, wanted,
        fmt::format("the workbook has no sheet of this name; its sheets are {}", text::joined(names, ", ")));
  }

 private:
  /// Two rows with two numbers each, as numbers or as text: a cover sheet has a serial number and a date.
  static bool is_table(const WorkbookSheet& sheet) {
    std::size_t rows = 0;
    for (std::size_t i = 0; i < sheet.rows.size(); ++i) {
      std::size_t numbers = 0;
      for (std::size_t k = 0; k < sheet.rows[i].size(); ++k) {
        const std::string& cell = sheet.rows[i][k];
        numbers +=
            sheet.is_number[i][k] != 0 || plain_number(cell, true) || plain_number(cell, false) ? 1 : 0;
      }
      rows += numbers >= 2 ? 1 : 0;
    }
    return rows >= 2;
  }

  /// Adds the texts on the other visible sheets, and the names of those with a table; a sheet that cannot be
  /// read has none.
  void look_beside(WorkbookSheet& found) const {
    constexpr std::size_t kLongEnough = 5, kMostTexts = 1000;
    std::vector<TextElsewhere>& texts = found.elsewhere;
    for (const pugi::xml_node entry : child(workbook_.document_element(), "sheets").children()) {
      const std::string_view state = entry.attribute("state").value();
      if (found.name == entry.attribute("name").value() || state == "hidden" || state == "veryHidden")
        continue;
      try {
        const WorkbookSheet sheet = cells_of(entry);
        const bool table = is_table(sheet);
        if (table) found.tables_beside.push_back(sheet.name);
        for (std::size_t i = 0; i < sheet.rows.size(); ++i)
          for (std::size_t k = 0; k < sheet.rows[i].size() && texts.size() < kMostTexts; ++k)
            if (sheet.is_number[i][k] == 0 && sheet.rows[i][k].size() >= kLongEnough)
              texts.push_back({sheet.name, table, sheet.rows[i][k]});
      } catch (const text::InputError&) {
        continue;
      }
    }
  }

  /// Quotes the first texts of hidden sheets: they may be an old state, or state the sign of the table.
  void look_at_hidden_sheets(WorkbookSheet& found) const {
    constexpr std::size_t kShown = 3;
    for (const pugi::xml_node entry : child(workbook_.document_element(), "sheets").children()) {
      const std::string_view state = entry.attribute("state").value();
      const std::string name = entry.attribute("name").value();
      if ((state != "hidden" && state != "veryHidden") || name == found.name) continue;
      std::string text = fmt::format("the hidden sheet \"{}\"", name);
      std::size_t shown = 0;
      try {
        const WorkbookSheet sheet = cells_of(entry);
        for (std::size_t i = 0; i < sheet.rows.size(); ++i)
          for (std::size_t k = 0; k < sheet.rows[i].size(); ++k)
            if (!sheet.rows[i][k].empty() && sheet.is_number[i][k] == 0 && shown++ < kShown)
              text += fmt::format("{} \"{}\"", shown == 1 ? " with" : ",", sheet.rows[i][k]);
      } catch (const text::InputError&) {
      }
      found.unread.push_back(text);
    }
  }

  /// Quotes the comments of the cells of a sheet. `part`: the file of the sheet.
  void look_at_comments(WorkbookSheet& sheet, const std::string& part) const {
    const std::size_t slash = part.rfind('/');
    if (slash == std::string::npos) return;
    const std::string name = part.substr(0, slash) + "/_rels" + part.substr(slash) + ".rels";
    const auto relations = package_.part(name);
    if (!relations) return;
    pugi::xml_document document;
    load(document, *relations, name);
    for (const pugi::xml_node relation : document.document_element().children()) {
      if (!std::string_view(relation.attribute("Type").value()).ends_with("/comments")) continue;
      std::string target = relation.attribute("Target").value();
      if (target.starts_with("../")) target = "xl/" + target.substr(3);
      if (target.starts_with("/")) target = target.substr(1);
      const auto text = package_.part(target);
      if (!text) continue;
      pugi::xml_document comments;
      load(comments, *text, target);
      for (const pugi::xml_node one : child(comments.document_element(), "commentList").children())
        if (const std::string words = text::trimmed(text_of(child(one, "text"))); !words.empty())
          sheet.unread.push_back(
              fmt::format("the comment of cell {} \"{}\"", one.attribute("ref").value(), words));
    }
  }

  /// Quotes the printed headers and footers of a sheet with a text beside codes (&P is the page).
  static void look_at_printed_header(WorkbookSheet& sheet, const pugi::xml_node& root) {
    for (const pugi::xml_node one : child(root, "headerFooter").children()) {
      const std::string_view code = one.text().get();
      std::string text;
      for (std::size_t at = 0; at < code.size(); ++at) {
        if (code[at] != '&' || at + 1 == code.size()) {
          text += code[at];
        } else if (code[++at] == '"') {  // the name of a font
          at = std::min(code.find('"', at + 1), code.size());
        } else {
          text += ' ';
        }
      }
      std::string other;  // words that are no number of a page
      for (const std::string& word : text::words_in(text, " \t\n/"))
        if (word.size() > 1 && word != "Seite" && word != "Page" && word != "von" && word != "of")
          other += word;
      if (!other.empty())
        sheet.unread.push_back(fmt::format("the printed {} \"{}\"",
                                           local(one).ends_with("Header") ? "header" : "footer",
                                           text::trimmed(text)));
    }
  }

  void load(pugi::xml_document& document, const std::string& text, const std::string& name) const {
    const auto result =
        document.load_buffer(text.data(), text.size(), pugi::parse_default | pugi::parse_ws_pcdata);
    if (!result) throw text::InputError({file_, 0}, name, std::string("broken: ") + result.description());
  }
  void read_part(const std::string& name, pugi::xml_document& document) const {
    const auto text = package_.part(name);
    if (!text) throw text::InputError({file_, 0}, name, "this zip file is not a workbook: a part is missing");
    load(document, *text, name);
  }

  /// Reads which cell styles show a number as a date.
  void read_styles(const std::string& text) {
    pugi::xml_document document;
    load(document, text, "xl/styles.xml");
    std::map<unsigned, std::string> formats;
    for (const pugi::xml_node format : child(document.document_element(), "numFmts").children())
      formats[format.attribute("numFmtId").as_uint()] = format.attribute("formatCode").value();
    std::vector<bool> struck;  // for each font
    for (const pugi::xml_node font : child(document.document_element(), "fonts").children()) {
      const pugi::xml_node strike = child(font, "strike");
      struck.push_back(strike && strike.attribute("val").as_bool(true));
    }
    for (const pugi::xml_node style : child(document.document_element(), "cellXfs").children()) {
      const auto font = static_cast<std::size_t>(style.attribute("fontId").as_uint());
      is_struck_.push_back(font < struck.size() && struck[font]);
      const unsigned id = style.attribute("numFmtId").as_uint();
      const auto own = formats.find(id);
      is_date_.push_back(own == formats.end() ? is_date_format(id) : is_date_format(own->second));
      formats_.push_back(is_date_.back()        ? ""
                         : own == formats.end() ? std::string(built_in_format(id))
                                                : own->second);
    }
  }

  /// The number format of a cell with a number, if it shows more than the number; empty: none.
  std::string telling_format(const pugi::xml_node& cell) const {
    const auto style = static_cast<std::size_t>(cell.attribute("s").as_uint());
    if (!is_number(cell) || style >= formats_.size() || number_format(formats_[style]).plain()) return "";
    return formats_[style];
  }

  using Formats = std::map<std::pair<std::size_t, std::string>, FormattedCells>;

  bool is_struck(const pugi::xml_node& cell) const {
    const auto style = static_cast<std::size_t>(cell.attribute("s").as_uint());
    return style < is_struck_.size() && is_struck_[style];
  }

  bool shows_date(const pugi::xml_node& cell) const {
    const auto style = static_cast<std::size_t>(cell.attribute("s").as_uint());
    return style < is_date_.size() && is_date_[style];
  }

  /// A relation gives the part of a sheet.
  std::string part_of(const pugi::xml_node& entry) const {
    std::string id;
    for (const pugi::xml_attribute attribute : entry.attributes())
      if (std::string_view(attribute.name()).ends_with(":id")) id = attribute.value();
    pugi::xml_document relations;
    read_part("xl/_rels/workbook.xml.rels", relations);
    for (const pugi::xml_node relation : relations.document_element().children()) {
      if (relation.attribute("Id").value() != id) continue;
      const std::string target = relation.attribute("Target").value();
      return target.starts_with("/") ? target.substr(1) : "xl/" + target;
    }
    throw text::InputError({file_, 0}, entry.attribute("name").value(),
                           "the workbook has no file for this sheet");
  }

  WorkbookSheet cells_of(const pugi::xml_node& entry) const {
    WorkbookSheet sheet;
    sheet.name = entry.attribute("name").value();
    pugi::xml_document document;
    const std::string part = part_of(entry);
    read_part(part, document);
    look_at_comments(sheet, part);
    look_at_printed_header(sheet, document.document_element());
    std::size_t row_number = 0, filled = 0, empty = 0;
    Formats formats;
    for (const pugi::xml_node row : child(document.document_element(), "sheetData").children()) {
      sheet.hidden_rows += row.attribute("hidden").as_bool() ? 1 : 0;
      row_number = row.attribute("r") ? row.attribute("r").as_uint() : row_number + 1;
      if (row_number > kMostRows)
        throw text::InputError({file_, 0}, sheet.name,
                               "the sheet has a row beyond the last row of the format");
      std::vector<std::string> cells;
      std::vector<char> numbers;
      bool any = false;
      std::string formula;  // the first one without a value
      for (const pugi::xml_node cell : row.children()) {
        const std::size_t column = column_of(cell, cells.size());
        if (column >= kMostColumns)
          throw text::InputError({file_, row_number}, "",
                                 "the sheet has a column beyond the last column of the format");
        const std::string value =
            text::trimmed(text::with_plain_blanks(text::without_invisible(value_of(cell, row_number))));
        if (value.empty()) {
          if (const pugi::xml_node computed = child(cell, "f"); computed && formula.empty())
            formula = "=" + std::string(computed.text().get());
          continue;
        }
        if (cells.size() <= column) {
          empty += column - cells.size();
          if (empty > kMostEmpty + kMostEmptyForOne * filled)
            throw text::InputError({file_, row_number}, cell.attribute("r").value(),
                                   "nearly all cells up to here are empty: the sheet contains no table");
          cells.resize(column + 1);
          numbers.resize(column + 1);
        }
        ++filled;
        cells[column] = value;
        numbers[column] = is_number(cell) ? 1 : 0;
        if (const std::string format = telling_format(cell); !format.empty()) {
          FormattedCells& same = formats[{column, format}];
          if (++same.count == 1) same = {column, format, cell.attribute("r").value(), row_number, 1};
        }
        if (is_struck(cell))
          sheet.unread.push_back(
              fmt::format("the struck-out cell {} \"{}\"", cell.attribute("r").value(), value));
        any = true;
      }
      if (!any) continue;
      const bool data = std::count(numbers.begin(), numbers.end(), 1) > 0;
      if (data && !formula.empty())
        throw text::InputError({file_, row_number}, formula,
                               "a formula without a value: the program that wrote the workbook did not "
                               "compute it; open the workbook in a spreadsheet program and save it");
      sheet.rows.push_back(std::move(cells));
      sheet.is_number.push_back(std::move(numbers));
      sheet.line.push_back(row_number);
    }
    for (auto& [key, cells] : formats) sheet.formats.push_back(std::move(cells));
    for (const pugi::xml_node merge : child(document.document_element(), "mergeCells").children())
      fill_merged(sheet, merge.attribute("ref").value());
    return sheet;
  }

  /// Column and row of "AB12", from 1; 0 for what is none.
  struct CellPlace {
    std::size_t column = 0, row = 0;
  };
  static CellPlace place_of(std::string_view reference) {
    CellPlace place;
    auto c = reference.begin();
    for (; c != reference.end() && *c >= 'A' && *c <= 'Z'; ++c)
      if (place.column <= kMostColumns)
        place.column = 26 * place.column + static_cast<std::size_t>(*c - 'A') + 1;
    for (; c != reference.end() && *c >= '0' && *c <= '9'; ++c)
      if (place.row <= kMostRows) place.row = 10 * place.row + static_cast<std::size_t>(*c - '0');
    return place;
  }

  /// Cells merged over several rows of data have their value in the first one: the name of a run beside its
  /// rows. Each row gets it. Headings and titles stay as they are.
  void fill_merged(WorkbookSheet& sheet, std::string_view reference) const {
    const auto colon = reference.find(':');
    if (colon == std::string_view::npos) return;
    const CellPlace from = place_of(reference.substr(0, colon)), to = place_of(reference.substr(colon + 1));
    if (from.column == 0 || from.column > kMostColumns || to.row <= from.row) return;
    const auto first = std::lower_bound(sheet.line.begin(), sheet.line.end(), from.row);
    if (first == sheet.line.end() || *first != from.row) return;
    auto row = static_cast<std::size_t>(first - sheet.line.begin());
    const std::size_t column = from.column - 1;
    if (column >= sheet.rows[row].size() || sheet.rows[row][column].empty()) return;
    const auto& kinds = sheet.is_number[row];
    const auto numbers = static_cast<std::size_t>(std::count(kinds.begin(), kinds.end(), 1));
    const auto filled = static_cast<std::size_t>(std::count_if(
        sheet.rows[row].begin(), sheet.rows[row].end(), [](const auto& cell) { return !cell.empty(); }));
    if (2 * numbers < filled) return;
    const std::string value = sheet.rows[row][column];
    const char number = kinds[column];
    for (++row; row < sheet.rows.size() && sheet.line[row] <= to.row; ++row) {
      if (sheet.rows[row].size() <= column) {
        sheet.rows[row].resize(column + 1);
        sheet.is_number[row].resize(column + 1);
      }
      // A cell with a value of its own ends the merge: merged cells have none, and overlapping ones no work.
      if (!sheet.rows[row][column].empty()) return;
      sheet.rows[row][column] = value;
      sheet.is_number[row][column] = number;
    }
  }

  /// "AB12" is column 27. Without a reference it is the next column.
  static std::size_t column_of(const pugi::xml_node& cell, std::size_t next) {
    const std::size_t column = place_of(cell.attribute("r").value()).column;
    return column == 0 ? next : column - 1;
  }

  static bool is_number(const pugi::xml_node& cell) {
    const std::string_view type = cell.attribute("t").value();
    return type.empty() || type == "n";
  }

  std::string value_of(const pugi::xml_node& cell, std::size_t row) const {
    const std::string_view type = cell.attribute("t").value();
    if (type == "inlineStr") return text_of(child(cell, "is"));
    const std::string value = child(cell, "v").text().get();
    if (type == "s") {
      const auto index = text::parse_number(value);
      if (!index || *index < 0 || *index >= static_cast<double>(strings_.size()))
        throw text::InputError({file_, row}, value,
                               "a cell refers to a text that the workbook does not contain");
      return strings_[static_cast<std::size_t>(*index)];
    }
    if (type == "b") return value == "0" ? "FALSE" : "TRUE";
    // Stored with 17 digits, but shown with the 15 digits of a spreadsheet: 200.00509999999997 is
    // 200.0051.
    const auto number = is_number(cell) ? text::parse_number(value) : std::nullopt;
    if (number && shows_date(cell)) return date_text(*number, from_1904_);
    if (!number) return value;
    const double shown = *text::parse_number(fmt::format("{:.15g}", *number));
    // A small number without an exponent: 0.0006, not 6e-04. 18 decimals hold its 15 digits.
    constexpr double kSmall = 1e-3, kTiny = 1e-12;
    const bool small = std::abs(shown) < kSmall && std::abs(shown) > kTiny;
    return small ? text::fixed_text(shown, 18) : text::number_text(shown);
  }

  std::string file_;
  Package package_;
  pugi::xml_document workbook_;
  std::vector<std::string> strings_;
  std::vector<bool> is_date_, is_struck_;  // of each cell style
  std::vector<std::string> formats_;       // of each cell style, the code of its numbers; empty: plain
  bool from_1904_ = false;
};

}  // namespace

WorkbookSheet read_workbook(const std::string& bytes, const std::string& file, const std::string& sheet) {
  return Reader(bytes, file).read(sheet);
}

}  // namespace vernier::sheet
