// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/distances/distance_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>

#include "tools/format/columns.h"
#include "tools/format/units.h"
#include "tools/import/words/joint_names.h"
#include "tools/import/words/sheet_words.h"
#include "tools/import/words/title_units.h"
#include "tools/sheet/sheet_number.h"
#include "tools/sheet/unit_factor.h"
#include "tools/text/error.h"
#include "tools/text/numbers.h"
#include "tools/text/words.h"

namespace vernier::importer {
namespace {

namespace columns = format::columns;

constexpr int kDecimals = 9;     // of a mm: below every instrument
constexpr double kShare = 0.05;  // largest permitted difference of a measured distance: 5 %, as for
constexpr double kLeast_mm = 1;  // deviations of an axis, and 1 mm at least: no printer or mill is worse
constexpr double kSamePoint_mm = 0.001;  // nearer points are one point

/// A distance that the table states for two points.
struct Distance {
  std::size_t from = 0, to = 0;  // indices of the points
  std::size_t row = 0;           // of the sheet
  std::size_t column = 0;
  double mm = 0;
  bool nominal = false;
};

class Maker {
 public:
  Maker(const sheet::Sheet& sheet, const sheet::SheetTable& table, const PairSheet& pairs,
        std::vector<SheetColumn>& columns, const SheetWishes& wishes, const NamedPoints& named,
        PointDistances& result)
      : sheet_(sheet),
        table_(table),
        pairs_(pairs),
        columns_(columns),
        wishes_(wishes),
        named_(named),
        result_(result) {
    result_.axes = named.axes;
    result_.place = heading();
    for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row)
      if (const auto pair = pair_of(row)) {
        note_point(pair->first);
        note_point(pair->second);
      }
    std::stable_sort(
        result_.points.begin(), result_.points.end(),
        [](const std::string& one, const std::string& other) { return key_of(one) < key_of(other); });
    find_positions();
  }

  void make(const std::string& ask) {
    if (!ask.empty()) throw text::InputError(heading(), "", ask);
    if (result_.points.empty())
      throw text::InputError(heading(), "", "no row of the table has a distance between two named points");
    refuse_unused_points();
    result_.asks_positions = !result_.missing.empty();
    if (result_.asks_positions) throw refusal_for_positions(result_, "give" + options_of_points(result_));
    refuse_equal_positions();
    settle_units();
    read_distances();
    compare();
    write();
  }

 private:
  text::Place place(std::size_t row) const { return {sheet_.file, sheet_.line[row]}; }
  text::Place heading() const { return place(table_.has_headings ? table_.heading_row : table_.first_data); }

  /// The pair of points of a row; no value for a row that was not measured.
  std::optional<PointPair> pair_of(std::size_t row) const {
    const auto number = text::parse_count(sheet_.rows[row][pairs_.column]);
    if (!number || *number < 1 || *number > pairs_.pairs.size()) return std::nullopt;
    return pairs_.pairs[*number - 1];
  }

  void note_point(const std::string& name) {
    if (std::find(result_.points.begin(), result_.points.end(), name) == result_.points.end())
      result_.points.push_back(name);
  }

  /// The order of names: P2 is before P10.
  static std::tuple<std::string, std::size_t, std::string> key_of(const std::string& name) {
    const std::size_t end = name.find_last_not_of("0123456789");
    const std::string digits = name.substr(end == std::string::npos ? 0 : end + 1);
    return {name.substr(0, name.size() - digits.size()), digits.size(), digits};
  }

  /// The label of a point in the measurement file: a number alone would be the number of a row in `from`.
  std::string label(std::size_t i) const {
    std::string name = result_.points[i];
    while (text::parse_number(name) ||
           (name != result_.points[i] &&
            std::find(result_.points.begin(), result_.points.end(), name) != result_.points.end()))
      name.insert(0, "P");
    return name;
  }

  void find_positions() {
    for (const std::string& name : result_.points) {
      const auto found = std::find_if(named_.points.begin(), named_.points.end(),
                                      [&](const NamedPoint& one) { return one.name == name; });
      point_.push_back(found == named_.points.end() ? nullptr : &*found);
      if (point_.back() == nullptr) result_.missing.push_back(name);
    }
  }

  void refuse_unused_points() {
    std::vector<std::string> unused;
    for (const NamedPoint& one : named_.points)
      if (std::find(result_.points.begin(), result_.points.end(), one.name) == result_.points.end())
        unused.push_back(one.name);
    if (unused.empty()) return;
    if (!named_.list.empty()) {
      result_.notes.push_back(fmt::format("{}: no distance to the point {}: it is left out", named_.list,
                                          text::joined(unused, ", ")));
      return;
    }
    throw text::InputError(
        {sheet_.file, 0}, unused.front(),
        fmt::format("no row of the table has a distance to this point (points of the table: {}): correct the "
                    "name, or omit this --point",
                    text::joined(result_.points, ", ")));
  }

  double apart_mm(std::size_t i, std::size_t j) const {
    double sum = 0;
    for (std::size_t k = 0; k < point_[i]->at_mm.size(); ++k) {
      const double d = point_[i]->at_mm[k] - point_[j]->at_mm[k];
      sum += d * d;
    }
    return std::sqrt(sum);
  }

  void refuse_equal_positions() const {
    for (std::size_t i = 0; i < point_.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        if (apart_mm(i, j) < kSamePoint_mm)
          throw text::InputError(
              {sheet_.file, 0}, result_.points[i],
              fmt::format("this point and the point {} have the same position: correct one "
                          "of them",
                          result_.points[j]));
  }

  bool is_role(std::size_t k, const char* name) const {
    return columns_[k].use == SheetColumn::Use::kColumn && columns_[k].name == name;
  }

  std::optional<double> value(std::size_t row, std::size_t k) const {
    const std::string& cell = sheet_.rows[row][k];
    if (is_missing(cell)) return std::nullopt;
    const auto number = sheet::number_at(sheet_, row, k);
    if (!number)
      throw text::InputError(
          place(row), cell,
          fmt::format("not a number, for the column \"{}\": correct the cell, or write - in "
                      "a cell without a value",
                      table_.headings[k].text));
    return number;
  }

  /// A column of distances whose unit nothing states.
  bool lacks_unit(std::size_t k) const {
    return (is_role(k, columns::kDistance) || is_role(k, kNominalName)) && columns_[k].unit.empty();
  }

  /// True if a number is a distance of stated points, of whichever pair: two exchanged points do not change
  /// the unit.
  bool is_distance_mm(double number) const {
    for (std::size_t i = 0; i < point_.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        if (std::abs(number - apart_mm(i, j)) <= std::max(kLeast_mm, kShare * apart_mm(i, j))) return true;
    return false;
  }

  /// The unit in which most distances without a unit agree with the stated points; empty: no unit.
  std::string unit_of_points() const {
    static constexpr std::array<const char*, 5> kUnits = {"mm", "cm", "in", "m", "um"};
    for (const char* const unit : kUnits) {
      std::size_t all = 0, good = 0;
      for (std::size_t k = 0; k < columns_.size(); ++k)
        for (std::size_t row = table_.first_data; lacks_unit(k) && row < sheet_.rows.size(); ++row)
          if (const auto number = pair_of(row) ? sheet::number_at(sheet_, row, k) : std::nullopt) {
            ++all;
            good += is_distance_mm(*number * format::find_unit(unit)->factor) ? 1 : 0;
          }
      if (2 * good > all) return unit;
    }
    return "";
  }

  [[noreturn]] void refuse_without_unit(std::size_t k) const {
    for (std::size_t row = table_.first_data; row < sheet_.rows.size(); ++row) {
      const auto pair = pair_of(row);
      const auto number = pair ? sheet::number_at(sheet_, row, k) : std::nullopt;
      if (!number) continue;
      throw text::InputError(
          place(row), sheet_.rows[row][k],
          fmt::format(
              "the distances have no unit, and in no usual unit they agree with the stated points: the "
              "distance of {} and {} is {} here, and the stated points are {} mm apart; check the "
              "positions of the points, or give the unit (--unit mm)",
              pair->first, pair->second, text::fixed_text(*number, 3),
              text::fixed_text(apart_mm(at(pair->first), at(pair->second)), 3)));
    }
    throw text::InputError(heading(), table_.headings[k].text, "no row has a distance: fill in this column");
  }

  /// A heading may state a part of a unit alone: "Abweichung (1/100)".
  [[noreturn]] void refuse_small_without_unit(std::size_t k) const {
    const std::string& text = table_.headings[k].text;
    std::string unit;
    for (std::size_t from = text.find_first_of("([ "); from != std::string::npos && unit.empty();
         from = text.find_first_of("([ ", from + 1))
      if (const auto factor = sheet::factor_behind(text.substr(from)); factor && factor->value > 0)
        unit = sheet::unit_times(factor->value, "mm").value_or("");
    if (!unit.empty())
      throw text::InputError(
          heading(), text,
          fmt::format("this column states a part of a unit, but no unit: if one unit is {}, give --column "
                      "\"{}[{}]={}\"",
                      unit, columns_[k].name, unit, text));
    throw text::InputError(heading(), text,
                           fmt::format("this column has no unit: give --unit mm, or --column \"{}[mm]={}\"",
                                       columns_[k].name, text));
  }

  std::size_t at(const std::string& name) const {
    return static_cast<std::size_t>(std::find(result_.points.begin(), result_.points.end(), name) -
                                    result_.points.begin());
  }

  /// Units of columns without one: that of --unit, of a title, or that in which the distances agree with the
  /// stated points. Deviations have no other evidence.
  void settle_units() {
    const TitleUnits titles = units_of_titles(sheet_, table_);
    const std::string of_points = wishes_.unit.empty() ? unit_of_points() : "";
    bool by_points = false;
    for (std::size_t k = 0; k < columns_.size(); ++k) {
      if (!lacks_unit(k)) continue;
      by_points |= !of_points.empty();
      std::string& unit = columns_[k].unit;
      unit = !wishes_.unit.empty() ? wishes_.unit : !of_points.empty() ? of_points : titles.positions.unit;
      if (unit.empty()) refuse_without_unit(k);
    }
    if (by_points)
      result_.notes.push_back(fmt::format(
          "the distances have no unit: in {} they agree with the distances of the stated points", of_points));
    for (std::size_t k = 0; k < columns_.size(); ++k) {
      SheetColumn& column = columns_[k];
      const bool small = is_role(k, kDeviationName) || is_role(k, columns::kUncertainty);
      if (!small || !column.unit.empty()) continue;
      column.unit = !wishes_.unit.empty() ? wishes_.unit : titles.deviations.unit;
      if (column.unit.empty()) refuse_small_without_unit(k);
    }
    for (std::size_t k = 0; k < columns_.size(); ++k) {
      if (columns_[k].use != SheetColumn::Use::kColumn || columns_[k].unit.empty() || columns_[k].words)
        continue;
      const auto unit = format::find_unit(columns_[k].unit);
      if (!unit || unit->dimension != format::Dimension::kLength)
        throw text::InputError(heading(), table_.headings[k].text,
                               fmt::format("the unit {} is no unit of length", columns_[k].unit));
    }
  }

  double mm(std::size_t k, double number) const {
    return number * format::find_unit(columns_[k].unit)->factor;
  }

  void read_distances() {
    std::optional<std::size_t> nominal, deviation;
    bool measured = false;
    for (std::size_t k = 0; k < columns_.size(); ++k) {
      if (is_role(k, kNominalName) && !nominal) nominal = k;
      if (is_role(k, kDeviationName)) deviation = k;
      measured |= is_role(k, columns::kDistance);
    }
    if (!measured && deviation && !wishes_.turned && !columns_[*deviation].sign_text.empty())
      throw text::InputError(
          heading(), columns_[*deviation].sign_text,
          "the sign of these deviations is not clear: give --sign actual-nominal or --sign "
          "nominal-actual");
    for (std::size_t row = table_.first_data; row < sheet_.rows.size(); ++row) {
      const auto pair = pair_of(row);
      if (!pair) continue;
      const Distance one{at(pair->first), at(pair->second), row, 0, 0, false};
      std::optional<double> target;
      if (nominal)
        if (const auto number = value(row, *nominal)) {
          target = mm(*nominal, *number);
          add(one, *nominal, *target, true);
        }
      for (std::size_t k = 0; k < columns_.size(); ++k) {
        if (is_role(k, columns::kDistance)) {
          if (const auto number = value(row, k)) add(one, k, mm(k, *number), false);
        } else if (!measured && is_role(k, kDeviationName)) {
          const bool turned = wishes_.turned ? *wishes_.turned : columns_[k].turned;
          if (const auto number = value(row, k))
            add(one, k, (target ? *target : apart_mm(one.from, one.to)) + (turned ? -1 : 1) * mm(k, *number),
                false);
        }
      }
    }
    if (std::none_of(distances_.begin(), distances_.end(), [](const Distance& one) { return !one.nominal; }))
      throw text::InputError(heading(), "", "no row has a measured distance: fill in the measured distances");
  }

  void add(Distance one, std::size_t column, double mm_value, bool nominal) {
    if (!(mm_value > 0))
      throw text::InputError(place(one.row), sheet_.rows[one.row][column],
                             "a distance must be larger than 0");
    one.column = column;
    one.mm = mm_value;
    one.nominal = nominal;
    distances_.push_back(one);
  }

  double limit_mm(const Distance& one, double apart) const {
    return one.nominal ? named_.tolerance_mm : std::max(kLeast_mm, kShare * apart);
  }

  /// Number of distances that disagree with the stated points, if the positions of two points are exchanged.
  std::size_t wrong(std::size_t first, std::size_t second) const {
    const auto swapped = [&](std::size_t i) { return i == first ? second : i == second ? first : i; };
    return static_cast<std::size_t>(
        std::count_if(distances_.begin(), distances_.end(), [&](const Distance& one) {
          const double apart = apart_mm(swapped(one.from), swapped(one.to));
          return std::abs(one.mm - apart) > limit_mm(one, apart);
        }));
  }

  /// The exchanges of two points that make all distances agree. A square has two of them, and only the print
  /// shows which one is right: the other one mirrors the square.
  std::string exchanged() const {
    std::vector<std::string> found;
    for (std::size_t i = 0; i < point_.size(); ++i)
      for (std::size_t j = i + 1; j < point_.size(); ++j)
        if (wrong(i, j) == 0) found.push_back(result_.points[i] + " and " + result_.points[j]);
    if (found.empty()) return "check the positions of both points, and the two points of this row";
    return fmt::format("if the positions of {} are exchanged, all distances agree{}",
                       text::joined(found, ", or of "),
                       found.size() > 1 ? "; only one of these is right, look at the part" : "");
  }

  /// Refuses distances that all agree with the stated points in another unit than that of their headings.
  void refuse_other_unit() const {
    static constexpr std::array<const char*, 5> kUnits = {"cm", "in", "m", "um", "mm"};
    for (const char* const unit : kUnits) {
      std::size_t column = 0;
      const bool agree = std::all_of(distances_.begin(), distances_.end(), [&](const Distance& one) {
        const SheetColumn& of = columns_[one.column];
        column = one.column;
        const double factor = of.unit.empty() ? 1 : format::find_unit(of.unit)->factor;
        const double apart = apart_mm(one.from, one.to),
                     other = one.mm / factor * format::find_unit(unit)->factor;
        return !is_role(one.column, kDeviationName) &&
               std::abs(other - apart) <= std::max(kLeast_mm, kShare * apart);
      });
      if (!agree || distances_.empty() || columns_[column].unit == unit) continue;
      throw text::InputError(
          heading(), table_.headings[column].text,
          fmt::format("the distances do not agree with the stated points in {}, and all of them agree in {}: "
                      "correct the unit in the headings ([{}]), or the positions of the points",
                      columns_[column].unit, unit, unit));
    }
  }

  void compare() const {
    const auto bad = [&](const Distance& one) {
      const double apart = apart_mm(one.from, one.to);
      return std::abs(one.mm - apart) > limit_mm(one, apart);
    };
    auto worst = std::find_if(distances_.begin(), distances_.end(),
                              [&](const Distance& one) { return one.nominal && bad(one); });
    if (worst == distances_.end()) worst = std::find_if(distances_.begin(), distances_.end(), bad);
    if (worst == distances_.end()) return;
    const double apart = apart_mm(worst->from, worst->to);
    refuse_other_unit();
    const bool read_well =
        worst->nominal && std::any_of(distances_.begin(), distances_.end(), [&](const auto& one) {
          return one.row == worst->row && !one.nominal && !bad(one);
        });
    if (read_well)
      throw text::InputError(
          place(worst->row), sheet_.rows[worst->row][worst->column],
          fmt::format(
              "the nominal distance of {0} and {1} is {2} mm, and the stated points are {3} mm apart "
              "(permitted difference: {4:.3g} mm, --tolerance); the measured distance of this row agrees "
              "with the points: correct the nominal distance, or leave out this column (--leave \"{5}\")",
              result_.points[worst->from], result_.points[worst->to], text::fixed_text(worst->mm, 3),
              text::fixed_text(apart, 3), limit_mm(*worst, apart), table_.headings[worst->column].text));
    throw text::InputError(
        place(worst->row), sheet_.rows[worst->row][worst->column],
        fmt::format("the {} distance of {} and {} is {} mm, and the stated points are {} mm apart (permitted "
                    "difference: {:.3g} mm{}): {}",
                    worst->nominal ? "nominal" : "measured", result_.points[worst->from],
                    result_.points[worst->to], text::fixed_text(worst->mm, 3), text::fixed_text(apart, 3),
                    limit_mm(*worst, apart), worst->nominal ? ", --tolerance" : "", exchanged()));
  }

  void write() {
    ImportTable& table = result_.table;
    table.file = sheet_.file;
    std::vector<const Distance*> measured;
    for (const Distance& one : distances_)
      if (!one.nominal) measured.push_back(&one);
    const std::size_t head =
        table_.has_headings ? sheet_.line[table_.heading_row] : sheet_.line[table_.first_data];
    table.line.assign(point_.size(), head);
    for (const Distance* const one : measured) table.line.push_back(sheet_.line[one->row]);
    // A label of the rows that is the name of a point would make `from` ambiguous.
    ImportTable::Column names{"point", "", {}};
    for (std::size_t i = 0; i < point_.size(); ++i) names.cells.push_back(label(i));
    const std::vector<std::string> labels = names.cells;
    for (const Distance* const one : measured)
      names.cells.push_back(labels[one->from] + "-" + labels[one->to]);
    table.columns.push_back(std::move(names));
    for (std::size_t a = 0; a < named_.axes.size(); ++a) {
      ImportTable::Column axis{named_.axes[a].name, named_.axes[a].rotary ? "deg" : "mm", {}};
      for (const NamedPoint* const one : point_)
        axis.cells.push_back(text::fixed_text(one->values[a], kDecimals));
      for (const Distance* const one : measured)
        axis.cells.push_back(text::fixed_text(point_[one->to]->values[a], kDecimals));
      table.columns.push_back(std::move(axis));
    }
    ImportTable::Column distance{columns::kDistance, "mm", std::vector<std::string>(point_.size())};
    ImportTable::Column from{columns::kFrom, "", std::vector<std::string>(point_.size())};
    for (const Distance* const one : measured) {
      distance.cells.push_back(text::fixed_text(one->mm, kDecimals));
      from.cells.push_back(labels[one->from]);
    }
    table.columns.push_back(std::move(distance));
    table.columns.push_back(std::move(from));
    for (std::size_t k = 0; k < columns_.size(); ++k) add_other(k, measured, labels);
    for (const MappedColumn& constant : wishes_.constants) {
      if (table.find(constant.name) != nullptr)
        throw text::InputError(heading(), constant.name,
                               "the table already has this column: omit --set, or exclude the column of the "
                               "table (--leave HEADING)");
      table.columns.push_back(
          {constant.name, constant.unit,
           std::vector<std::string>(table.line.size(), constant_cell(constant, sheet_.decimal_comma))});
    }
    if (table.find(columns::kUncertainty) == nullptr)
      result_.notes.push_back(
          "no standard uncertainty of the distances: a fit beside other readings needs it; state that of the "
          "caliper, for example --set \"u[mm]=0.02\"");
    note_apart(measured);
    note_diagonals(measured);
    std::string repeated;
    if (measured.size() > pairs_of(measured))
      repeated = fmt::format(", {} of them repeated", measured.size() - pairs_of(measured));
    result_.notes.push_back(fmt::format("{} measured distances between {} points{}: a row for each",
                                        measured.size(), point_.size(), repeated));
  }

  /// The standard uncertainty of the readings in mm that an option or a column states; 0: none.
  double stated_u_mm() const {
    for (const MappedColumn& constant : wishes_.constants)
      if (constant.name == columns::kUncertainty)
        if (const auto value = text::parse_number(constant.constant)) {
          const auto unit = format::find_unit(constant.unit);
          return *value * (unit ? unit->factor : 1);
        }
    double most = 0;
    for (std::size_t k = 0; k < columns_.size(); ++k)
      for (std::size_t row = table_.first_data; is_role(k, columns::kUncertainty) && row < sheet_.rows.size();
           ++row)
        if (const auto number = sheet::number_at(sheet_, row, k)) most = std::max(most, mm(k, *number));
    return most;
  }

  /// Notes readings of one distance that differ by more than the repeatability limit: 2.8 standard deviations
  /// for two readings (ISO 5725-6:1994, 4.1.4), by the stated uncertainty. Without one, calipers: the limit
  /// is twice the largest permissible error of a caliper with a digit step of 0.05 mm (0.05 mm, DIN 862).
  void note_apart(const std::vector<const Distance*>& measured) {
    constexpr double kRepeatability = 2.8;  // standard deviations
    constexpr double kCaliper_mm = 0.1;     // twice 0.05 mm
    std::map<std::pair<std::size_t, std::size_t>, std::vector<const Distance*>> same;
    for (const Distance* const one : measured)
      same[{std::min(one->from, one->to), std::max(one->from, one->to)}].push_back(one);
    const double u_mm = stated_u_mm(), limit_mm = u_mm > 0 ? kRepeatability * u_mm : kCaliper_mm;
    for (const auto& [pair, readings] : same) {
      const auto [least, most] = std::minmax_element(
          readings.begin(), readings.end(), [](const auto* a, const auto* b) { return a->mm < b->mm; });
      const double apart = (*most)->mm - (*least)->mm;
      if (!(apart > limit_mm)) continue;
      const std::string source = u_mm > 0 ? fmt::format("{:.3g} mm for u = {:.3g} mm", limit_mm, u_mm)
                                          : fmt::format("{:g} mm for two readings of a caliper", limit_mm);
      result_.notes.push_back(
          fmt::format("the readings of the distance of {} and {} differ by {} mm ({} mm in line {}, {} mm in "
                      "line {}), more than "
                      "{}: all of them are used; if one is wrong, delete its row",
                      result_.points[pair.first], result_.points[pair.second], text::fixed_text(apart, 3),
                      text::fixed_text((*least)->mm, 3), sheet_.line[(*least)->row],
                      text::fixed_text((*most)->mm, 3), sheet_.line[(*most)->row], source));
    }
  }

  /// Notes parallelograms whose sides contradict their diagonals: AC^2 + BD^2 = AB^2 + BC^2 + CD^2 + DA^2. In
  /// a distorted one the right side is larger by four times the squared distance of the midpoints of the
  /// diagonals (Euler), which is below 1 um for a distortion of 0.3 mm.
  void note_diagonals(const std::vector<const Distance*>& measured) {
    // Without u: twice the limit of two readings of a caliper. With u: three standard deviations of the sum,
    // which are 2 u, because the squared sides of a rectangle are those of one diagonal.
    constexpr double kUnknown_mm = 0.2, kTimesU = 6;
    constexpr std::size_t kMostPoints = 40;  // more are a grid, and no square of a caliper
    const double u_mm = stated_u_mm(), limit_mm = u_mm > 0 ? kTimesU * u_mm : kUnknown_mm;
    std::map<std::pair<std::size_t, std::size_t>, double> of_pair;
    for (const Distance* const one : measured) of_pair.emplace(std::minmax(one->from, one->to), one->mm);
    const auto length = [&](std::size_t i, std::size_t j) {
      const auto found = of_pair.find(std::minmax(i, j));
      return found == of_pair.end() ? 0 : found->second;
    };
    const std::size_t n = point_.size() > kMostPoints ? 0 : point_.size();
    for (std::size_t a = 0; a < n; ++a)
      for (std::size_t c = a + 1; c < n; ++c)
        for (std::size_t b = a + 1; b < n; ++b)
          for (std::size_t d = b + 1; d < n; ++d) {
            if (b == c || d == c || !is_parallelogram(a, b, c, d)) continue;
            const double ac = length(a, c), bd = length(b, d);
            double sides = 0, least = std::min(ac, bd);
            for (const double side : {length(a, b), length(b, c), length(c, d), length(a, d)}) {
              sides += side * side;
              least = std::min(least, side);
            }
            const double apart = (sides - ac * ac - bd * bd) / (ac + bd);
            if (least <= 0 || std::abs(apart) < limit_mm) continue;
            const auto name = [&](std::size_t i, std::size_t j) {
              return result_.points[i] + "-" + result_.points[j];
            };
            result_.notes.push_back(
                fmt::format("the sides and diagonals of {}, {}, {}, {} contradict each other by {:.2f} mm, "
                            "so that one of "
                            "these six distances is wrong: the sides agree with {:.2f} mm for {} ({:.2f} mm "
                            "measured), or "
                            "with {:.2f} mm for {} ({:.2f} mm measured); measure both again",
                            result_.points[a], result_.points[b], result_.points[c], result_.points[d],
                            std::abs(apart), std::sqrt(std::max(0.0, sides - bd * bd)), name(a, c), ac,
                            std::sqrt(std::max(0.0, sides - ac * ac)), name(b, d), bd));
          }
  }

  /// True if the stated points a, b, c, d are the corners of a parallelogram in this order.
  bool is_parallelogram(std::size_t a, std::size_t b, std::size_t c, std::size_t d) const {
    constexpr double kSame_mm = 0.01;  // stated positions have two or three decimals
    for (std::size_t k = 0; k < named_.axes.size(); ++k) {
      const auto at = [&](std::size_t i) { return point_[i]->values[k]; };
      if (named_.axes[k].rotary || std::abs(at(a) + at(c) - at(b) - at(d)) > kSame_mm) return false;
    }
    return true;
  }

  static std::size_t pairs_of(const std::vector<const Distance*>& measured) {
    std::map<std::pair<std::size_t, std::size_t>, std::size_t> pairs;
    for (const Distance* const one : measured)
      ++pairs[{std::min(one->from, one->to), std::max(one->from, one->to)}];
    return pairs.size();
  }

  /// The uncertainty and labels of the rows. A row of a point alone has no reading: it has the uncertainty of
  /// the first reading, because a column u has no empty cells.
  void add_other(std::size_t k, const std::vector<const Distance*>& measured,
                 const std::vector<std::string>& labels) {
    const SheetColumn& column = columns_[k];
    if (column.use != SheetColumn::Use::kColumn || is_role(k, columns::kDistance) ||
        is_role(k, kNominalName) || is_role(k, kDeviationName) || is_role(k, kPairName))
      return;
    if (result_.table.find(column.name) != nullptr) return;
    ImportTable::Column made{column.name, column.words ? "" : "mm", {}};
    for (const Distance* const one : measured) {
      if (column.words) {
        const std::string& cell = sheet_.rows[one->row][k];
        made.cells.push_back(is_missing(cell) ? "" : cell);
        if (std::find(labels.begin(), labels.end(), cell) != labels.end()) return;
      } else {
        const auto number = value(one->row, k);
        made.cells.push_back(number ? text::fixed_text(mm(k, *number), kDecimals) : "");
      }
    }
    const std::string first = column.words || made.cells.empty() ? "" : made.cells.front();
    made.cells.insert(made.cells.begin(), point_.size(), first);
    result_.table.columns.push_back(std::move(made));
  }

  const sheet::Sheet& sheet_;
  const sheet::SheetTable& table_;
  const PairSheet& pairs_;
  std::vector<SheetColumn>& columns_;
  const SheetWishes& wishes_;
  const NamedPoints& named_;
  PointDistances& result_;
  std::vector<const NamedPoint*> point_;
  std::vector<Distance> distances_;
};

}  // namespace

PointDistances distances_of(const sheet::Sheet& sheet, const sheet::SheetTable& table, const PairSheet& pairs,
                            std::vector<SheetColumn>& columns, const SheetWishes& wishes,
                            const NamedPoints& named, const std::string& ask) {
  PointDistances result;
  Maker maker(sheet, table, pairs, columns, wishes, named, result);
  try {
    maker.make(ask);
  } catch (const text::InputError& error) {
    result.refusal = error;
  }
  return result;
}

text::InputError refusal_for_positions(const PointDistances& distances, const std::string& remedy) {
  return {
      distances.place, text::joined(distances.missing, ", "),
      fmt::format("the rows are distances between named points, and a fit needs the commanded position of "
                  "each point in the machine. State a list of the positions (--nominal FILE), or fill in "
                  "the positions ({} in mm) and {}",
                  axis_names(distances.axes), remedy)};
}

std::string options_of_points(const PointDistances& distances) {
  std::string options;
  for (const std::string& name : distances.missing)
    options += fmt::format(" --point \"{}={}\"", name, axis_names(distances.axes));
  return options;
}

}  // namespace vernier::importer
