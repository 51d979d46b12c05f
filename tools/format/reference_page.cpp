// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/format/reference_page.h"

#include <fmt/format.h>

#include "tools/format/columns.h"
#include "tools/format/readings.h"
#include "tools/format/units.h"
#include "tools/text/words.h"

namespace vernier::format {
namespace {

std::string code(std::string_view text) { return fmt::format("`{}`", text); }

/// "`x[mm]`, `y[mm]`, `z[mm]`".
std::string headings_of(const ColumnGroup& group) {
  std::vector<std::string> list;
  for (const char* const name : group.list()) list.push_back(code(heading(name, group.unit)));
  return text::joined(list, ", ");
}

std::string beside_of(ReadingForm form) {
  std::vector<std::string> list;
  for (const ColumnGroup* const group : columns_beside(form)) list.push_back(headings_of(*group));
  return list.empty() ? "–" : text::joined(list, ", ");
}

std::string kinds_page() {
  std::string text =
      "## Kinds of reading\n\n"
      "| kind | unit | columns | beside them | BaseShift of the set-up | the number is "
      "|\n|---|---|---|---|---|---|\n";
  for (const ReadingKindEntry& kind : kReadingKinds)
    text += fmt::format("| {} | {} | {} | {} | {} | {} |\n", code(kind.name), unit_of(kind.kind),
                        headings_of(reading_columns(kind.form)), beside_of(kind.form),
                        is_free_of_setup(kind.kind) ? "not used" : "used", kind.meaning);
  return text +
         "\nA measurement file may state angles in any unit of angle. The results of the commands state "
         "lengths in mm or µm, and rotations in deg or µrad.\n";
}

std::string columns_page() {
  std::string text = "## Columns\n\n| columns | hold | without the column |\n|---|---|---|\n";
  for (const ColumnGroup& group : column_groups()) {
    std::string headings = headings_of(group);
    if (group.or_unit != nullptr) headings += " or " + code(heading(group.names[0], group.or_unit));
    text += fmt::format("| {} | {} | {} |\n", headings, group.meaning,
                        group.if_absent != nullptr        ? group.if_absent
                        : group.use == ColumnUse::kBeside ? "an error where the file has the reading"
                                                          : "no reading");
  }
  return text;
}

std::string axis_columns_page() {
  std::string text =
      "## Columns of each axis\n\nThis table has the columns of a linear axis X and of a rotary axis C.\n\n"
      "| columns | hold | without the column |\n|---|---|---|\n";
  for (const AxisColumnEntry& column : kAxisColumns)
    text +=
        fmt::format("| {}, {} | {} | {} |\n", code(heading(axis_column(column.quantity, "X"), column.unit)),
                    code(heading(axis_column(column.quantity, "C"), unit_of(column.quantity, true))),
                    column.meaning, column.if_absent);
  return text;
}

std::string later_page() {
  std::vector<std::string> later;
  for (const ColumnGroup& group : column_groups())
    for (const char* const name : group.list())
      if (group.later) later.push_back(code(name));
  return fmt::format(
      "## Names of a later version\n\n"
      "Measurement files of the first version may use these column names with another meaning: {}.\n\n"
      "- If an input of the machine file has one of these names, the column is this input.\n"
      "- `ix` and `iy` are readings only with a unit of angle.\n"
      "- `ax`, `ay` and `az` are readings only if all three are in the file, without a unit.\n"
      "- `distance` is a reading only if the file has the column `from`.\n"
      "- `on` is a reading only if the machine file has an `<artefact>`.\n",
      text::joined(later, ", "));
}

std::string reserved_page() {
  std::vector<std::string> axis, input, terms;
  for (const ColumnGroup& group : column_groups())
    for (const char* const name : group.list()) {
      axis.push_back(code(name));
      if (!group.later) input.push_back(code(name));
      if (group.in_terms) terms.push_back(code(name));
    }
  return fmt::format(
      "## Reserved names\n\n"
      "| what | may not have the names |\n|---|---|\n| an axis | {} |\n| an input | {} |\n"
      "| any static, axis or input | {}, and the functions of expressions |\n\n"
      "The word `correction`, directly followed by the name of an axis (`correctionX`), is also reserved.\n"
      "If the machine has an axis X, no static, input or other axis may have the names {}.\n",
      text::joined(axis, ", "), text::joined(input, ", "), text::joined(terms, ", "), [] {
        std::vector<std::string> names;
        for (const AxisColumnEntry& column : kAxisColumns)
          if (column.in_terms) names.push_back(code(axis_column(column.quantity, "X")));
        return text::joined(names, ", ");
      }());
}

std::string units_page() {
  std::string text = "## Units\n\n| units | converted to |\n|---|---|\n";
  for (const Dimension dimension : all_dimensions()) {
    std::vector<std::string> names;
    for (const std::string& name : units_of(dimension)) names.push_back(code(name));
    if (!names.empty())
      text += fmt::format("| {} | {} |\n", text::joined(names, ", "), code(base_unit(dimension)));
  }
  return text +
         "\nIn a unit the program reads `µ` as `u`, `°` as `deg`, `°C` as `degC`, `″` as `arcsec` and `²` as "
         "`^2`. The program ignores a middle dot in a unit.\n";
}

}  // namespace

std::string reference_page() {
  return "# Columns of the measurement file\n\n"
         "This page lists every column of a measurement file that has a meaning, with its unit. The page\n"
         "[measurement file](measurement_file.md) explains the rules with an example. The command\n"
         "`vernier new --measurements` writes a measurement file with the columns of one kind of reading.\n"
         "The command `vernier lint` checks a measurement file.\n\n"
         "A program writes this page from the tables in `tools/format`. Do not edit this page by hand.\n\n" +
         kinds_page() + "\n" + columns_page() + "\n" + axis_columns_page() + "\n" + later_page() + "\n" +
         reserved_page() + "\n" + units_page();
}

}  // namespace vernier::format
