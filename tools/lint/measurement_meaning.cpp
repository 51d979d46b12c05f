// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/lint/measurement_meaning.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>
#include <map>
#include <vector>

#include "tools/format/columns.h"
#include "tools/format/units.h"
#include "tools/import/sizes/outlying_cells.h"
#include "tools/lint/dense_points.h"
#include "tools/lint/direction_order.h"
#include "tools/lint/run_order.h"
#include "tools/model/chain/thing_shape.h"
#include "tools/model/chain/travel.h"
#include "tools/text/numbers.h"
#include "tools/text/similar.h"

namespace vernier::lint {
namespace {

namespace columns = format::columns;

class Meaning {
 public:
  Meaning(const LintTable& table, const std::string& file, const model::Machine* machine,
          LintFindings& findings)
      : table_(table), file_(file), machine_(machine), names_(machine), findings_(findings) {}

  void look() {
    for (const LintColumn& column : table_.columns) look_at_column(column);
    look_at_things();
    look_at_labels();
    look_at_time();
    for (const LintColumn& column : table_.columns)
      if (names_.is_of_axis(column.name, format::AxisQuantity::kSense))
        look_at_directions(table_, column, names_, findings_);
    look_for_missing_directions(table_, names_, findings_);
    look_at_signs_of_runs(table_, names_, findings_);
    look_at_normals();
    look_at_repeats();
    look_at_scale();
    look_at_sizes();
    look_at_stations();
    for (const LintColumn& column : table_.columns) {
      look_for_wild_cells(column);
      look_for_outliers(column);
    }
  }

 private:
  void look_at_column(const LintColumn& column) {
    if (column.label) return;
    const bool reading = names_.is_reading(table_, column);
    const format::ColumnGroup* const known = format::find_column(column.name);
    const auto of_axis = names_.of_axis(column.name);
    // The correction of a board may be missing in a row; no other quantity of an axis may.
    const bool filled_column = (known != nullptr && known->filled) ||
                               (of_axis && of_axis->quantity != format::AxisQuantity::kPosition &&
                                of_axis->quantity != format::AxisQuantity::kCorrection);
    const bool sense = of_axis && of_axis->quantity == format::AxisQuantity::kSense;
    const auto unit = format::find_unit(column.unit);
    const bool uncertainty = known != nullptr && known->use == format::ColumnUse::kUncertainty &&
                             (!known->later || (unit && unit->dimension == format::dimension_of(*known)));
    const bool never_negative = reading && format::entry_of(known->form).never_negative;
    double least = std::numeric_limits<double>::infinity(), most = -least;
    std::size_t filled = 0;
    for (std::size_t row = 0; row < table_.rows.size(); ++row) {
      const double value = column.value[row];
      if (column.cell[row].empty() && names_.is_axis(column.name))
        findings_.add_of_kind("empty " + column.name, LintWeight::kError, line(row), column.name,
                              "an axis position may not be empty");
      if (column.cell[row].empty() && filled_column)
        findings_.add_of_kind("empty " + column.name, LintWeight::kError, line(row), column.name,
                              "this column may not have empty cells");
      if (std::isnan(value)) continue;
      ++filled;
      least = std::min(least, value);
      most = std::max(most, value);
      if (sense && value != -1 && value != 0 && value != 1)
        findings_.add_of_kind("dir " + column.name, LintWeight::kError, line(row), column.cell[row],
                              "a direction is 1, -1 or 0");
      if (uncertainty && value <= 0)
        findings_.add_of_kind("uncertainty " + column.name, LintWeight::kError, line(row), column.cell[row],
                              "an uncertainty is greater than 0");
      if (never_negative && value < 0)
        findings_.add_of_kind("negative", LintWeight::kError, line(row), column.cell[row],
                              "a length is not negative");
    }
    if (filled == 0) {
      const bool template_cells = reading;
      findings_.add(LintWeight::kWarning, table_.header_line, column.name, "all cells are empty",
                    template_cells ? "is this a template without readings?" : "");
      return;
    }
    if (reading) any_reading_ = true;
    if (names_.is_axis(column.name)) look_at_axis(column, least, most);
    if (column.name == columns::kFeed && most <= 0)
      findings_.warn(table_.header_line, column.name, "the feed is 0 in all rows",
                     "lag and dynamic effects show only while the machine moves");
    if (column.name == columns::kUncertainty && most > 1)
      findings_.warn(table_.header_line, column.name,
                     fmt::format("an uncertainty of {} mm", text::number_text(most)), "µm? Write u[um]");
    if (unit && unit->dimension == format::Dimension::kTemperature)
      if (const std::string doubt = temperature_doubt(least, most); !doubt.empty())
        findings_.warn(table_.header_line, column.name,
                       fmt::format("from {:.4g} to {:.4g} degC", least, most), doubt);
  }

  void look_at_axis(const LintColumn& column, double least, double most) {
    const bool turns = names_.is_rotary(column.name);
    const char* const unit = turns ? "deg" : "mm";
    if (most - least < 1e-9)
      findings_.warn(table_.header_line, column.name,
                     fmt::format("axis {} never moves: it is at {} {} in all rows", column.name,
                                 text::number_text(least), unit),
                     kAxisStands);
    if (machine_ == nullptr) return;
    const model::Axis& axis = machine_->axes[*machine_->find_axis(column.name)];
    if (!axis.min || !axis.max) return;
    const double travel = *axis.max - *axis.min, slack = model::kTravelSlack * travel;
    std::size_t first = 0;
    const std::size_t outside = model::rows_outside_travel(
        axis,
        Eigen::Map<const Eigen::ArrayXd>(column.value.data(), static_cast<Eigen::Index>(column.value.size())),
        &first);
    const auto close = [&](double factor) {
      return least * factor >= *axis.min - slack && most * factor <= *axis.max + slack &&
             (most - least) * factor > 0.2 * travel;
    };
    if (outside > 0) {
      std::string meaning = "another machine, or another zero?";
      if (close(1e-3)) meaning = "µm read as mm?";
      if (close(1 / 25.4)) meaning = "";
      if (turns && close(1.0 / 3600)) meaning = "arcsec read as deg?";
      findings_.warn(line(first), column.cell[first],
                     fmt::format("{} is outside the travel of {} to {} {} in {} of {} rows", column.name,
                                 text::number_text(*axis.min), text::number_text(*axis.max), unit, outside,
                                 table_.rows.size()),
                     meaning);
    } else if (most - least > 1e-9 && most - least < 0.05 * travel) {
      std::string meaning;
      if (!turns && close(25.4)) meaning = "inch read as mm?";
      if (!turns && close(1e3)) meaning = "m read as mm?";
      if (turns && close(180 / std::acos(-1.0))) meaning = "rad read as deg?";
      findings_.add(meaning.empty() ? LintWeight::kRemark : LintWeight::kWarning, table_.header_line,
                    column.name,
                    fmt::format("this column covers only {:.3g} {} of the travel of {:.4g} {}", most - least,
                                unit, travel, unit),
                    meaning);
    }
  }

  void look_at_labels() {
    std::size_t check = 0;
    if (const LintColumn* role = table_.find(columns::kRole))
      for (std::size_t row = 0; row < table_.rows.size(); ++row) {
        const std::string& word = role->cell[row];
        if (!word.empty() && !format::is_role(word)) {
          const auto meant = text::word_meant(word, {format::kRoles.begin(), format::kRoles.end()});
          findings_.add_of_kind("role", LintWeight::kError, line(row), word, format::kRoleRule,
                                meant ? "did you mean " + *meant + "?" : "");
        }
        check += word == format::kCheckRole ? 1 : 0;
      }
    if (check == table_.rows.size())
      findings_.warn(table_.header_line, columns::kRole, "all rows are check rows: the fit has no rows");
    if (check == 0)
      findings_.remark(table_.header_line, columns::kRole,
                       "no check rows in the file: the fit is not tested on held-out rows",
                       "give some rows the role check, distributed over the working volume");
    if (table_.find(columns::kUncertainty) == nullptr)
      findings_.remark(table_.header_line, columns::kUncertainty,
                       "no standard uncertainty u in the file: the fit estimates the noise from repeated "
                       "rows, or from the residual",
                       "a column u[um], the instrument's");
    if (!any_reading_ && !names_undeclared_touches())
      findings_.error(table_.header_line, "", "no row has a reading", "is this a template without readings?");
  }

  static bool is_filled(const std::string& cell) { return !cell.empty(); }

  /// True for rows with the name of a touched object, of a machine that declares none.
  bool names_undeclared_touches() const {
    const LintColumn* const on = table_.find(columns::kOn);
    return names_.lacks_artefact_of(table_) && std::any_of(on->cell.begin(), on->cell.end(), is_filled);
  }

  /// Labels of unknown points, and names of artefacts.
  void look_at_things() {
    const LintColumn *same = table_.find(columns::kSame), *on = table_.find(columns::kOn);
    if (same != nullptr && names_.is_reading(table_, *same)) look_at_points(*same);
    if (on == nullptr) return;
    if (names_undeclared_touches()) {
      // Without another reading, no command can read the file.
      const LintWeight weight = any_reading_ ? LintWeight::kWarning : LintWeight::kError;
      findings_.add(weight, table_.header_line, columns::kOn,
                    "the machine file has no <artefact>: this column is not read",
                    fmt::format("declare in the machine file what the tool point touched (vernier set "
                                "--artefact {}:TYPE, with plane, line, point, sphere or cylinder as TYPE)",
                                *std::find_if(on->cell.begin(), on->cell.end(), is_filled)));
    }
    if (names_.lacks_artefact_of(table_)) return;
    if (names_.is_reading(table_, *on)) look_at_artefacts(*on);
    for (std::size_t row = 0; same != nullptr && row < table_.rows.size(); ++row)
      if (!same->cell[row].empty() && !on->cell[row].empty())
        findings_.add_of_kind("same and on", LintWeight::kError, line(row), on->cell[row],
                              "the columns same and on both have a label in this row: a touch belongs to an "
                              "unknown point (same) or to an artefact (on); empty one of the two cells");
  }

  void look_at_points(const LintColumn& same) {
    const LintColumn* const setup = table_.find(columns::kSetup);
    std::map<std::pair<std::string, std::string>, std::vector<std::size_t>> rows_of;
    for (std::size_t row = 0; row < table_.rows.size(); ++row)
      if (!same.cell[row].empty())
        rows_of[{same.cell[row], setup == nullptr ? "" : setup->cell[row]}].push_back(row);
    for (const auto& [label, rows] : rows_of) {
      any_reading_ = true;
      if (rows.size() == 1)
        findings_.add_of_kind(
            "one row", LintWeight::kWarning, line(rows.front()), label.first,
            "only one row has this label, so the row gives no information",
            "check the label for a typing error; the tool point must touch an unknown point from many poses");
    }
    if (!rows_of.empty() && table_.find(columns::kDistance) == nullptr &&
        table_.find(columns::kOn) == nullptr)
      findings_.remark(table_.header_line, columns::kSame,
                       "no known length in the file: without linear axes the readings do not determine the "
                       "size of the machine",
                       "the column distance is the distance between two points");
  }

  void look_at_artefacts(const LintColumn& on) {
    std::vector<std::string> known;
    if (machine_ != nullptr)
      for (const model::Artefact& one : machine_->artefacts) known.push_back(one.name);
    std::map<std::string, std::size_t> touches;
    for (std::size_t row = 0; row < table_.rows.size(); ++row) {
      const std::string& name = on.cell[row];
      if (name.empty()) continue;
      any_reading_ = true;
      ++touches[name];
      if (machine_ == nullptr || std::find(known.begin(), known.end(), name) != known.end()) continue;
      const auto meant = text::word_meant(name, known);
      findings_.add_of_kind("artefact " + name, LintWeight::kError, line(row), name,
                            "the machine file has no artefact of this name",
                            meant ? "did you mean " + *meant + "?" : "");
    }
    if (machine_ == nullptr) return;
    for (const model::Artefact& one : machine_->artefacts) {
      const auto found = touches.find(one.name);
      const auto unknown = static_cast<std::size_t>(model::unknowns_of(one));
      if (found == touches.end() || found->second * one.dimension() > unknown) continue;
      findings_.warn(
          table_.header_line, one.name,
          fmt::format(
              "this artefact has {} touches and {} unknown values, so the touches give no information",
              found->second, unknown),
          "touch the artefact more often, or state its radius or position if they are known");
    }
  }

  void look_at_time() {
    const LintColumn *time = table_.find(columns::kTime), *run = table_.find(columns::kRun);
    if (time == nullptr) return;
    std::map<std::string, std::size_t> last;
    for (std::size_t row = 0; row < table_.rows.size(); ++row) {
      if (std::isnan(time->value[row])) continue;
      const std::string label = run == nullptr ? "" : run->cell[row];
      const auto before = last.find(label);
      if (before != last.end() && time->value[row] < time->value[before->second])
        findings_.add_of_kind(
            "time " + label, LintWeight::kWarning, line(row), time->cell[row],
            fmt::format("t decreases in {}: {} s after {} s",
                        label.empty() ? std::string("this file") : "run " + label,
                        text::number_text(time->value[row]), text::number_text(time->value[before->second])),
            "the rows of a run must be in the order of time; begin a new run for a new set-up or another "
            "clock");
      last[label] = row;
    }
  }

  void look_at_normals() {
    const LintColumn *nx = table_.find(columns::kNormal[0]), *ny = table_.find(columns::kNormal[1]),
                     *nz = table_.find(columns::kNormal[2]), *d = table_.find(columns::kDeviation);
    if (nx == nullptr || ny == nullptr || nz == nullptr) return;
    for (std::size_t row = 0; row < table_.rows.size(); ++row) {
      if (d != nullptr && std::isnan(d->value[row])) continue;
      const double size = std::hypot(nx->value[row], ny->value[row], nz->value[row]);
      if (std::isnan(size) || std::abs(size - 1) <= 0.01) continue;
      findings_.add_of_kind("normal", d != nullptr ? LintWeight::kError : LintWeight::kWarning, line(row),
                            nx->cell[row],
                            fmt::format("nx ny nz is not a unit vector: its length is {:.4g}", size));
    }
  }

  void look_at_repeats() {
    std::map<std::vector<std::string>, std::size_t> seen;
    for (std::size_t row = 0; row < table_.rows.size(); ++row) {
      const auto [first, fresh] = seen.emplace(table_.rows[row].cells, row);
      if (!fresh)
        findings_.add_of_kind("twice", LintWeight::kWarning, line(row), "",
                              fmt::format("the same row as line {}, to the last digit", line(first->second)),
                              "was the row copied? The fit counts both rows as independent readings");
    }
  }

  /// Are the stations of a table much farther apart than the points of this survey?
  void look_at_stations() {
    if (machine_ == nullptr) return;
    std::vector<std::vector<double>> positions;
    for (const model::Axis& axis : machine_->axes) {
      const LintColumn* const column = table_.find(axis.name);
      positions.push_back(column == nullptr ? std::vector<double>() : column->value);
    }
    std::vector<std::size_t> readings(table_.rows.size());
    for (const LintColumn& column : table_.columns) {
      if (column.label || !names_.is_reading(table_, column)) continue;
      for (std::size_t row = 0; row < readings.size(); ++row)
        readings[row] += std::isnan(column.value[row]) ? 0 : 1;
    }
    for (const DensePoints& points : dense_points(*machine_, positions, readings))
      findings_.remark(table_.header_line, points.axis, dense_points_text(points),
                       dense_points_remedy(points));
  }

  /// Are measured points as far apart as the machine was sent? A factor of 1000 or 25.4 is a unit.
  void look_at_scale() {
    double measured = 0, sent = 0;
    std::size_t used = 0;
    for (const char* const name : columns::kPoint) {
      const LintColumn* point = table_.find(name);
      const LintColumn* position = table_.find(std::string(1, static_cast<char>(std::toupper(*name))));
      if (point == nullptr || position == nullptr) continue;
      double mean_p = 0, mean_q = 0, count = 0;
      for (std::size_t row = 0; row < table_.rows.size(); ++row)
        if (!std::isnan(point->value[row]) && !std::isnan(position->value[row])) {
          mean_p += point->value[row];
          mean_q += position->value[row];
          count += 1;
        }
      if (count < 3) continue;
      for (std::size_t row = 0; row < table_.rows.size(); ++row)
        if (!std::isnan(point->value[row]) && !std::isnan(position->value[row])) {
          measured += std::pow(point->value[row] - mean_p / count, 2);
          sent += std::pow(position->value[row] - mean_q / count, 2);
        }
      ++used;
    }
    // If rotary axes move the tool, travel of the linear axes gives no information on the points.
    for (const LintColumn& column : table_.columns)
      if (names_.is_axis(column.name) && names_.is_rotary(column.name)) return;
    if (used == 0 || sent < 1 || measured <= 0) return;
    const double ratio = std::sqrt(measured / sent);
    const auto near = [&](double factor) { return std::abs(ratio / factor - 1) < 0.15; };
    std::string meaning;
    if (near(1e3)) meaning = "the readings are in µm, or the positions in m?";
    if (near(1e-3)) meaning = "the readings are in m, or the positions in µm?";
    // The heading may be wrong: µm under mm, or mm under µm.
    for (const char* name : columns::kPoint)
      if (const LintColumn* point = table_.find(name); point != nullptr) {
        if (near(1e3) && point->unit == "mm") meaning += " " + wrong_heading(name, "µm", "mm", "um");
        if (near(1e-3) && point->unit == "um") meaning += " " + wrong_heading(name, "mm", "µm", "mm");
        break;
      }
    if (near(25.4)) meaning = "the positions are in inch?";
    if (near(1 / 25.4)) meaning = "the readings are in inch?";
    if (meaning.empty() && ratio < 0.02)
      meaning = fmt::format(
          "deviations instead of positions? vernier import table {} --deviation \"X=x\" … adds them to the "
          "positions",
          quoted_for_shell(file_));
    if (!meaning.empty())
      findings_.warn(
          table_.header_line, columns::kPoint.front(),
          fmt::format("the measured values spread over {:.4g} times the range of the commanded positions",
                      ratio),
          meaning);
  }

  static std::string wrong_heading(const std::string& name, const char* holds, const char* heading,
                                   const char* write) {
    return fmt::format("{} under a heading of {}? Write {}[{}]", holds, heading, name, write);
  }

  /// Columns that are small by nature, corrections and uncertainties: µm under mm, or the other way.
  void look_at_sizes() {
    constexpr double kMostCorrection_mm = 2,
                     kLeast_mm = 1e-5;  // of a board's correction; of a measured value
    for (const LintColumn& column : table_.columns) {
      const auto of_axis = names_.of_axis(column.name);
      const bool correction = of_axis && of_axis->quantity == format::AxisQuantity::kCorrection;
      if (column.label || (!correction && column.name != columns::kUncertainty)) continue;
      if (correction && names_.is_rotary(of_axis->axis)) continue;
      double most = 0;
      for (const double value : column.value)
        most = std::isnan(value) ? most : std::max(most, std::abs(value));
      const auto say = [&](const std::string& meaning) {
        findings_.warn(
            table_.header_line, column.name,
            fmt::format("{:.4g} {} at most", most / format::find_unit(column.unit)->factor, column.unit),
            meaning);
      };
      if (correction && column.unit == "mm" && most > kMostCorrection_mm)
        say(wrong_heading(column.name, "µm", "mm", "um"));
      if (column.unit == "um" && most > 0 && most < kLeast_mm)
        say(wrong_heading(column.name, "mm", "µm", "mm"));
    }
  }

  /// Cells further from the middle half of their column than a hundred times its width: 9999, a lost point.
  /// For a measured position its difference from the commanded one is tested.
  void look_for_wild_cells(const LintColumn& column) {
    constexpr double kWild = 100;       // times the column's spread: a decimal point slips by ten
    constexpr std::size_t kFewest = 8;  // cells: with fewer no outlier can be found
    // Values that a machine logs of itself may jump: a heater is at its set-point except for the first
    // minutes.
    if (!names_.is_reading(table_, column) && !names_.is_axis(column.name)) return;
    const LintColumn* position =
        column.name.size() == 1
            ? table_.find(
                  std::string(1, static_cast<char>(std::toupper(static_cast<unsigned char>(column.name[0])))))
            : nullptr;
    if (position == &column) position = nullptr;
    std::vector<double> values, sorted;
    for (std::size_t row = 0; row < table_.rows.size(); ++row) {
      values.push_back(column.value[row] - (position != nullptr ? position->value[row] : 0));
      if (!std::isnan(values.back())) sorted.push_back(values.back());
    }
    if (sorted.size() < kFewest) return;
    std::sort(sorted.begin(), sorted.end());
    const double low = sorted[sorted.size() / 4], high = sorted[sorted.size() * 3 / 4], width = high - low;
    // Readings that are equal to the last digit contain no information on their scatter.
    if (!(width > 0)) return;
    for (std::size_t row = 0; row < values.size(); ++row)
      if (values[row] > high + kWild * width || values[row] < low - kWild * width)
        findings_.add_of_kind(
            "wild " + column.name, LintWeight::kWarning, line(row), column.cell[row],
            fmt::format(
                "this value of {} differs from the other values of its column by {:.3g} times their spread",
                column.name, (values[row] > high ? values[row] - high : low - values[row]) / width),
            "if this value is a mistake, a lost point or a mark for \"no reading\", leave the cell empty");
  }

  /// Measured positions that are far from their targets, compared with the rows before and behind: with the
  /// limits of the import, because the reading of a sheet may be corrected after it.
  void look_for_outliers(const LintColumn& column) {
    if (std::find(columns::kPoint.begin(), columns::kPoint.end(), column.name) == columns::kPoint.end())
      return;
    const LintColumn* const position = table_.find(
        std::string(1, static_cast<char>(std::toupper(static_cast<unsigned char>(column.name[0])))));
    if (position == nullptr || !names_.is_reading(table_, column)) return;
    std::vector<double> deviations;
    std::vector<std::size_t> rows;
    for (std::size_t row = 0; row < table_.rows.size(); ++row) {
      const double deviation = column.value[row] - position->value[row];
      if (std::isnan(deviation)) continue;
      deviations.push_back(deviation);
      rows.push_back(row);
    }
    constexpr double kUm = 1e3;  // um in a mm
    for (const importer::OutlyingValue& one : importer::outlying_values(deviations))
      findings_.add_of_kind(
          "outlier " + column.name, LintWeight::kWarning, line(rows[one.index]), column.cell[rows[one.index]],
          fmt::format(
              "the deviation {:.4g} um of this reading is far outside the deviations of the rows before "
              "and behind it ({:.4g} to {:.4g} um)",
              kUm * deviations[one.index], kUm * one.least, kUm * one.most),
          one.times > 1 ? fmt::format("1/{} of it agrees with them: is a decimal sign lost?", one.times)
          : one.times > 0
              ? "1000 times this deviation agrees with them: was the reading in another unit?"
              : "if the reading is a mistake, leave the cell empty; if not, the fit uses it as it is");
  }

  std::size_t line(std::size_t row) const { return table_.rows[row].line; }

  const LintTable& table_;
  const std::string& file_;
  const model::Machine* machine_;
  LintNames names_;
  LintFindings& findings_;
  bool any_reading_ = false;
};

}  // namespace

void look_at_meaning(const LintTable& table, const std::string& file, const model::Machine* machine,
                     LintFindings& findings) {
  Meaning(table, file, machine, findings).look();
}

std::string temperature_doubt(double least_degC, double most_degC) {
  // 7 to 43 degC, read as Fahrenheit; all of a survey so warm is rare, and a spindle's housing may be.
  constexpr double kLeast_degF = 45, kMost_degF = 110;
  if (least_degC < -40 || most_degC > 120) return "K or another unit?";
  if (least_degC >= kLeast_degF && most_degC <= kMost_degF) return "degF, or a heated part (bed, spindle)?";
  return {};
}

}  // namespace vernier::lint
