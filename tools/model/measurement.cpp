// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/model/measurement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <tuple>

#include "tools/format/columns.h"
#include "tools/format/csv_file.h"
#include "tools/format/units.h"
#include "tools/model/column_reader.h"
#include "tools/model/measurement_names.h"
#include "tools/text/files.h"
#include "tools/text/numbers.h"
#include "tools/text/words.h"

namespace vernier::model {
namespace {

constexpr double kAbsent = std::numeric_limits<double>::quiet_NaN();  // an empty cell
namespace columns = format::columns;
using format::AxisQuantity;

/// Reads one file into a Measurement of its own.
class Builder {
 public:
  Builder(const format::CsvFile& csv, const Machine& machine) : machine_(machine), reader_(csv) {
    result_.states = make_states(reader_.rows(), machine);
    result_.files = {csv.file};
    result_.file.assign(reader_.rows(), 0);
    result_.line = csv.line;
  }

  Measurement build() {
    check_names();
    read_axes();
    read_corrections();
    read_motion();
    read_inputs();
    read_labels();
    count_travel_since_reversals();
    read_geometry();
    read_directions();
    read_distances();
    read_things();
    read_observations();
    if (machine_.instrument && !reader_.has(columns::kUncertainty)) state_uncertainty(*machine_.instrument);
    for (const format::CsvColumn& column : reader_.unused())
      if (reader_.is_text(column.name))
        result_.labels.push_back({column.name, reader_.words(column.name)});
      else
        result_.candidates.push_back({column.name, column.unit, reader_.raw(column.name)});
    return std::move(result_);
  }

  /// Rows to exclude because an input cell is empty.
  const std::vector<char>& excluded() const { return excluded_; }

 private:
  void check_names() {
    for (const Axis& axis : machine_.axes)
      if (is_no_axis_name(machine_, axis.name))
        throw text::InputError({machine_.file, axis.line}, axis.name, kMeasuredName);
    for (const Input& input : machine_.inputs)
      if (is_no_input_name(machine_, input.name))
        throw text::InputError({machine_.file, input.line}, input.name, kMeasuredName);
  }

  void read_axes() {
    require_axes();
    for (std::size_t i = 0; i < machine_.axes.size(); ++i) {
      const Axis& axis = machine_.axes[i];
      result_.states.axis[i] =
          reader_.numbers(axis.name, format::dimension_of(AxisQuantity::kPosition, axis.rotary), true);
    }
  }

  /// One message for all missing axes: the file of one axis lacks all others of the machine.
  void require_axes() const {
    std::vector<const Axis*> missing;
    for (const Axis& axis : machine_.axes)
      if (!reader_.has(axis.name)) missing.push_back(&axis);
    if (missing.empty()) return;
    if (missing.size() == machine_.axes.size() && missing.size() > 1)
      throw text::InputError(
          reader_.header(), missing.front()->name,
          fmt::format(
              "no axis of the machine has a column; if the columns have other names "
              "(a1, joint_1), read them by their names: vernier import table {} "
              "--machine MACHINE.xml -o NEW.csv; distances between points (a caliper on a printed "
              "square) need the positions of the points: import their table with these positions (the page "
              "import, \"Distances between named points\")",
              reader_.header().file));
    std::string set;
    for (const Axis* const axis : missing) set += " " + set_of_axis(*axis);
    throw text::InputError(reader_.header(), missing.front()->name,
                           fmt::format("the column of this axis is missing; if the axis did not move, add "
                                       "its position: vernier import table {}{} -o NEW.csv",
                                       reader_.header().file, set));
  }

  /// Reads the corrections that a board added. Axis positions are the commanded ones until the
  /// correction is known in all rows.
  void read_corrections() {
    const auto zero = Column::Zero(static_cast<Eigen::Index>(reader_.rows()));
    for (std::size_t i = 0; i < machine_.axes.size(); ++i) {
      const std::string name = format::axis_column(AxisQuantity::kCorrection, machine_.axes[i].name);
      if (!reader_.has(name)) continue;
      if (result_.correction.empty()) result_.correction.assign(machine_.axes.size(), zero);
      const Column read = reader_.numbers(
          name, format::dimension_of(AxisQuantity::kCorrection, machine_.axes[i].rotary), false);
      result_.correction[i] = read.isNaN().select(0, read);
    }
    const std::string_view prefix = format::entry_of(AxisQuantity::kCorrection).prefix;
    for (const format::CsvColumn& column : reader_.unused())
      if (column.name.starts_with(prefix) && reader_.has(column.name.substr(prefix.size())))
        throw text::InputError(reader_.header(), column.name, "the machine file has no axis of this name");
    if (reader_.has(columns::kCorrected)) read_fingerprints();
  }

  void read_fingerprints() {
    result_.corrected = reader_.words(columns::kCorrected);
    bool any = false;
    for (std::size_t row = 0; row < reader_.rows(); ++row) {
      std::string& word = result_.corrected[row];
      if (word.empty()) continue;
      any = true;
      word = text::in_small_letters(word);
      if (word.size() != 16 || word.find_first_not_of("0123456789abcdef") != std::string::npos)
        throw text::InputError(reader_.place(row), reader_.cell(columns::kCorrected, row),
                               "the fingerprint of an image has 16 hexadecimal digits");
    }
    if (!any) result_.corrected.clear();
  }

  void motion(const std::string& name, format::Dimension dimension, Column& target, double factor = 1) {
    if (!reader_.has(name)) return;
    target = factor * reader_.numbers(name, dimension, true);
    result_.recorded.push_back(name);
  }
  void motion(const char* name, Column& target, double factor = 1) {
    motion(name, format::dimension_of(*format::find_column(name)), target, factor);
  }
  void motion(AxisQuantity quantity, const Axis& axis, Column& target) {
    motion(format::axis_column(quantity, axis.name), format::dimension_of(quantity, axis.rotary), target);
  }

  void read_motion() {
    States& states = result_.states;
    for (std::size_t i = 0; i < machine_.axes.size(); ++i) {
      const Axis& axis = machine_.axes[i];
      motion(AxisQuantity::kSpeed, axis, states.velocity[i]);
      motion(AxisQuantity::kAcceleration, axis, states.acceleration[i]);
      motion(AxisQuantity::kSense, axis, states.direction[i]);
      motion(AxisQuantity::kSince, axis, states.since[i]);
      for (std::size_t row = 0; row < reader_.rows(); ++row) {
        const double dir = states.direction[i][static_cast<Eigen::Index>(row)];
        if (dir != -1 && dir != 0 && dir != 1)
          throw text::InputError(reader_.place(row),
                                 reader_.cell(format::axis_column(AxisQuantity::kSense, axis.name), row),
                                 "a direction is -1, 0 or 1");
      }
    }
    motion(columns::kFeed, states.feed, 60);  // mm/min
    motion(columns::kCurvature, states.curvature);
    motion(columns::kTime, states.time);
    for (std::size_t k = 0; k < 3; ++k)
      if (const std::string name = columns::kNormal[k]; reader_.has(name))
        states.normal[k] = reader_.numbers(name, format::Dimension::kNone, false);
    for (Column& normal : states.normal) normal = normal.isNaN().select(0, normal);
  }

  /// Computes the travel since the last reversal of each axis that has no such column, from the positions and
  /// approach directions of successive rows of a run. The rows show all reversals of an axis only if each
  /// step agrees with the approach direction of its row. If one step disagrees (the axis went beyond the
  /// position and back), the travel of this axis is not known in any row. A turn at one position, as at the
  /// ends of a linear test, counts as travel 0: the axis went a little beyond it. A run begins where the row
  /// before it in the file ended; if the way to its first row disagrees with the direction of this row, the
  /// axis turned shortly before, and the travel is 0 too.
  void count_travel_since_reversals() {
    States& states = result_.states;
    for (std::size_t i = 0; i < machine_.axes.size(); ++i) {
      const std::string& axis = machine_.axes[i].name;
      if (reader_.has(format::axis_column(AxisQuantity::kSince, axis)) ||
          !reader_.has(format::axis_column(AxisQuantity::kSense, axis)))
        continue;
      if (const auto since = travel_since_reversals(states.axis[i], states.direction[i]))
        states.since[i] = *since;
    }
  }

  std::optional<Column> travel_since_reversals(const Column& position, const Column& direction) const {
    constexpr double kStill = 0.01;  // mm or deg: a shorter step is the scatter of a read position
    struct Before {
      double position = 0, direction = 0, since = 0;
      bool any = false;
    };
    std::vector<Before> of_run(result_.states.run_names.size());
    Column since(position.size());
    Before last;  // of any run
    for (Eigen::Index row = 0; row < position.size(); ++row) {
      Before& before = of_run[result_.states.run[static_cast<std::size_t>(row)]];
      const bool begins = !before.any;
      if (begins) before = last;
      const double step = before.any ? position[row] - before.position : 0, sense = direction[row];
      const bool moved = std::abs(step) > kStill, agrees = step * sense > 0;
      if (moved && !agrees && !begins) return std::nullopt;
      if (moved && !agrees)
        before.since = 0;
      else if (before.direction * sense < 0)
        before.since = std::abs(step);
      else
        before.since = std::min(before.since + std::abs(step), kLongWay);
      before.position = position[row];
      if (sense != 0) before.direction = sense;
      before.any = true;
      last = before;
      since[row] = before.since;
    }
    return since;
  }

  void read_inputs() {
    excluded_.assign(reader_.rows(), 0);
    for (std::size_t i = 0; i < machine_.inputs.size(); ++i) {
      const Input& input = machine_.inputs[i];
      if (!reader_.has(input.name)) continue;
      Column& target = result_.states.input[i];
      target = reader_.raw(input.name);
      const format::Unit written = *format::find_unit(reader_.unit(input.name));
      const auto declared = format::find_unit(input.unit);
      const bool same_text = input.unit == written.name;
      if (!same_text && !input.unit.empty()) {
        if (!declared || declared->dimension != written.dimension)
          throw text::InputError(reader_.header(),
                                 input.name + (written.dimension == format::Dimension::kNone ? "" : "[") +
                                     written.name +
                                     (written.dimension == format::Dimension::kNone ? "" : "]"),
                                 fmt::format("the machine file declares this input in {}", input.unit));
        target = (written.factor * target + written.offset - declared->offset) / declared->factor;
      }
      for (std::size_t row = 0; row < reader_.rows(); ++row)
        if (std::isnan(target[static_cast<Eigen::Index>(row)])) excluded_[row] = 1;
    }
  }

  void read_labels() {
    result_.check.assign(reader_.rows(), 0);
    if (reader_.has(columns::kRole)) {
      const std::vector<std::string> roles = reader_.words(columns::kRole);
      for (std::size_t row = 0; row < roles.size(); ++row) {
        if (!roles[row].empty() && !format::is_role(roles[row]))
          throw text::InputError(reader_.place(row), roles[row], format::kRoleRule);
        result_.check[row] = roles[row] == format::kCheckRole ? 1 : 0;
      }
    }
    States& states = result_.states;
    if (reader_.has(columns::kRun)) {
      const Labels runs = labels_of(reader_.words(columns::kRun));
      states.run = runs.of;
      states.run_names = runs.names;
    }
    if (has_word(columns::kSetup))
      states.setup = labels_of(setups_of_rows(reader_.words(columns::kSetup)));
    else if (const std::string own = set_up_of_this_file(); !own.empty())
      states.setup = labels_of(setups_of_rows(std::vector<std::string>(reader_.rows(), own)));
    if (has_word(columns::kClock)) states.clock = labels_of(reader_.words(columns::kClock));
    if (has_word(columns::kBlock)) states.block = labels_of(reader_.words(columns::kBlock));
    std::vector<double> seen(states.names(states.clock).size(), 0);
    for (std::size_t row = 0; row < reader_.rows(); ++row)
      states.visit[static_cast<Eigen::Index>(row)] = seen[states.of(states.clock, row)]++;
    if (reader_.has(columns::kVisit))
      states.visit = reader_.numbers(columns::kVisit, format::Dimension::kNone, true);
    result_.uncertainty = Column::Zero(static_cast<Eigen::Index>(reader_.rows()));
    if (reader_.has(columns::kUncertainty)) {
      const bool angle = reader_.dimension(columns::kUncertainty) == format::Dimension::kAngle;
      result_.uncertainty = reader_.numbers(
          columns::kUncertainty, angle ? format::Dimension::kAngle : format::Dimension::kLength, true);
      require_above_zero(columns::kUncertainty, result_.uncertainty);
    }
    if (!has_word(columns::kAngleUncertainty) ||
        reader_.dimension(columns::kAngleUncertainty) != format::Dimension::kAngle)
      return;
    const Column read = reader_.numbers(columns::kAngleUncertainty, format::Dimension::kAngle, false);
    require_above_zero(columns::kAngleUncertainty, read);
    result_.angle_uncertainty = read.isNaN().select(0, read);
  }

  /// Sets u of each row from the uncertainty that the machine file states for the instrument.
  void state_uncertainty(const ReadingUncertainty& instrument) {
    const Column far = lengths_from(instrument.at);
    for (const Observation& o : result_.observations) {
      const auto row = static_cast<Eigen::Index>(o.row);
      const bool own_u = result_.angle_uncertainty.size() > 0 && result_.angle_uncertainty[row] > 0;
      if (is_rotation(o.kind) && !own_u)
        throw text::InputError(
            reader_.place(o.row), columns::kAngleUncertainty,
            "the machine file states u for lengths only: give a standard uncertainty for the rotations");
      if (is_rotation(o.kind)) continue;
      const bool is_length = o.kind == ObservationKind::kLength || o.kind == ObservationKind::kDistance;
      double& u = result_.uncertainty[row];
      u = std::max(u, instrument.of_length(is_length ? o.value : far[row]));
    }
  }

  /// Returns the distance of the point of each row from `at`, mm. The read point is used, in the
  /// directions that were read. For a deviation the nominal point is used.
  Column lengths_from(const std::array<double, 3>& at) const {
    Column squares = Column::Zero(static_cast<Eigen::Index>(reader_.rows()));
    for (const Observation& o : result_.observations) {
      const auto row = static_cast<Eigen::Index>(o.row);
      if (o.kind <= ObservationKind::kZ)
        squares[row] += std::pow(o.value - at[static_cast<std::size_t>(o.kind)], 2);
      if (o.kind == ObservationKind::kD)
        squares[row] = (result_.nominal_point.col(row) - Eigen::Vector3d(at[0], at[1], at[2])).squaredNorm();
    }
    return squares.sqrt();
  }

  void require_above_zero(const std::string& name, const Column& values) const {
    for (std::size_t row = 0; row < reader_.rows(); ++row)
      if (values[static_cast<Eigen::Index>(row)] <= 0)
        throw text::InputError(reader_.place(row), reader_.cell(name, row),
                               "an uncertainty is greater than 0");
  }

  /// Is there a column of this name that the machine file does not declare as an input?
  bool has_word(const std::string& name) const { return reader_.has(name) && !machine_.find_input(name); }

  static Labels labels_of(const std::vector<std::string>& words) {
    Labels labels;
    std::map<std::string, std::size_t> known;
    for (const std::string& word : words) {
      const auto [found, fresh] = known.emplace(word, labels.names.size());
      if (fresh) labels.names.push_back(word);
      labels.of.push_back(found->second);
    }
    return labels;
  }

  /// Returns the set-up of each row. A run for which the machine file has a BaseShift keeps its
  /// own set-up.
  std::vector<std::string> setups_of_rows(std::vector<std::string> setups) const {
    const States& states = result_.states;
    for (std::size_t row = 0; row < setups.size(); ++row)
      for (const BaseShift& shift : machine_.base_shifts)
        if (!shift.of_setup && shift.run == states.run_names[states.run[row]]) setups[row] = *shift.run;
    return setups;
  }

  /// Returns the name of the BaseShift or ToolShift that the machine file has for this file; empty without
  /// one.
  std::string set_up_of_this_file() const {
    const std::string &file = result_.files.front(), in_folder = set_up_of_file(file, true);
    for (const std::string& name : {in_folder, set_up_of_file(file)})
      for (const auto* shifts : {&machine_.base_shifts, &machine_.tool_shifts})
        if (std::any_of(shifts->begin(), shifts->end(),
                        [&](const BaseShift& shift) { return shift.of_setup && shift.run == name; }))
          return name;
    return {};
  }

  /// Are the columns of this name a reading in this file, and not an input of the machine file?
  bool is_reading(const std::string& name) const {
    return reader_.has(name) && format::is_reading(reader_.column(name), [&](std::string_view other) {
             const std::string word(other);
             return has_word(word) ? &reader_.column(word) : nullptr;
           });
  }

  /// ax ay az: three pure numbers, a unit vector if they are given. Columns of words with these
  /// names are other columns.
  void read_directions() {
    if (!is_reading(columns::kDirection.front())) return;
    for (const char* name : columns::kDirection)
      if (reader_.is_text(name)) return;
    result_.direction.resize(3, static_cast<Eigen::Index>(reader_.rows()));
    for (std::size_t k = 0; k < 3; ++k)
      result_.direction.row(static_cast<Eigen::Index>(k)) =
          reader_.numbers(columns::kDirection[k], format::Dimension::kNone, false).matrix().transpose();
    for (std::size_t row = 0; row < reader_.rows(); ++row) {
      auto direction = result_.direction.col(static_cast<Eigen::Index>(row));
      const auto given = 3 - direction.array().isNaN().count();
      if (given != 0 && (given != 3 || std::abs(direction.norm() - 1) > 0.01))
        throw text::InputError(reader_.place(row), reader_.cell(columns::kDirection.front(), row),
                               text::joined({columns::kDirection.begin(), columns::kDirection.end()}, ", ") +
                                   " must be a unit vector");
      direction.normalize();
    }
    has_directions_ = true;
  }

  /// Reads the word that names the row at the other end of a distance. It is a label that exactly
  /// one row of the file has, or the number of a data row, from 1.
  void read_distances() {
    if (!is_reading(columns::kDistance)) return;
    const std::vector<std::string> from = reader_.words(columns::kFrom);
    std::map<std::string, std::size_t> rows_of_word;
    std::set<std::string> twice;
    for (const format::CsvColumn& column : reader_.unused())
      if (reader_.is_text(column.name)) {
        const std::vector<std::string> words = reader_.peek(column.name);
        for (std::size_t row = 0; row < words.size(); ++row)
          if (!words[row].empty() && !rows_of_word.emplace(words[row], row).second) twice.insert(words[row]);
      }
    result_.other_end.assign(reader_.rows(), kNoRow);
    for (std::size_t row = 0; row < reader_.rows(); ++row) {
      if (from[row].empty()) continue;
      const auto known = rows_of_word.find(from[row]);
      if (known != rows_of_word.end() && !twice.contains(from[row])) {
        result_.other_end[row] = known->second;
      } else {
        const auto number = known == rows_of_word.end() ? text::parse_number(from[row]) : std::nullopt;
        if (!number || *number < 1 || *number > static_cast<double>(reader_.rows()) ||
            *number != std::floor(*number))
          throw text::InputError(reader_.place(row), from[row],
                                 known == rows_of_word.end()
                                     ? "`from` names no row: no row has this label or this number"
                                     : "`from` is ambiguous: more than one row has this label");
        result_.other_end[row] = static_cast<std::size_t>(*number) - 1;
      }
      if (result_.other_end[row] == row)
        throw text::InputError(
            reader_.place(row), from[row],
            "the distance of this row refers to the row itself; give another row in `from`");
    }
    has_distances_ = true;
  }

  /// Is a column of labels of things a reading in this file? `on` needs an artefact of the machine file:
  /// older files may have a column of this name.
  /// Returns the first word of a column that is not empty.
  std::string first_word(const char* name) const {
    for (std::size_t row = 0; row < reader_.rows(); ++row)
      if (!reader_.cell(name, row).empty()) return std::string(reader_.cell(name, row));
    return {};
  }

  bool names_things(const char* name) const {
    if (!has_word(name)) return false;
    if (std::string_view(name) != columns::kOn || !machine_.artefacts.empty()) return true;
    for (std::size_t row = 0; row < reader_.rows(); ++row)
      if (!reader_.cell(name, row).empty()) return false;
    return true;  // a template that is not filled in
  }

  void read_things() {
    result_.thing.assign(reader_.rows(), kNoThing);
    if (names_things(columns::kSame))
      read_labels_of_things(columns::kSame, [&](std::size_t, const std::string& label) {
        return Thing{format::ReadingForm::kSame, label, {}, {}};
      });
    if (names_things(columns::kOn))
      read_labels_of_things(columns::kOn, [&](std::size_t row, const std::string& label) {
        return Thing{format::ReadingForm::kOn, label, {}, artefact_of(row, label)};
      });
    if (result_.things.empty()) {
      result_.thing.clear();
      return;
    }
    for (std::size_t row = 0; row < reader_.rows(); ++row) check_ends(row);
  }

  template <class Make>
  void read_labels_of_things(const char* name, const Make& make) {
    const std::vector<std::string> words = reader_.words(name);
    std::map<std::pair<std::string, std::string>, std::size_t> known;
    for (std::size_t row = 0; row < reader_.rows(); ++row) {
      if (words[row].empty()) continue;
      if (result_.thing[row] != kNoThing)
        throw text::InputError(reader_.place(row), words[row],
                               "the columns same and on both have a label in this row: a touch belongs to an "
                               "unknown point (same) or to an artefact (on); empty one of the two cells");
      Thing thing = make(row, words[row]);
      thing.setup = thing.is_in_every_set_up() ? "" : set_up_of_thing(row);
      const auto [at, fresh] = known.try_emplace({words[row], thing.setup}, result_.things.size());
      if (fresh) result_.things.push_back(std::move(thing));
      result_.thing[row] = at->second;
    }
  }

  /// Returns the set-up in which the row meets a thing: the word of the column `setup`, else the run if the
  /// machine file has a BaseShift for the run; empty: one set-up.
  std::string set_up_of_thing(std::size_t row) const {
    const States& states = result_.states;
    if (!states.setup.of.empty()) return states.setup.names[states.setup.of[row]];
    const std::string& run = states.run_names[states.run[row]];
    return std::any_of(machine_.base_shifts.begin(), machine_.base_shifts.end(),
                       [&](const BaseShift& shift) { return shift.run == run; })
               ? run
               : std::string();
  }

  const Artefact& artefact_of(std::size_t row, const std::string& name) const {
    const std::string setup = set_up_of_thing(row);
    std::string names, elsewhere;
    for (const Artefact& one : machine_.artefacts) {
      if (one.name != name) {
        names += (names.empty() ? "" : ", ") + one.name;
        continue;
      }
      if (!one.setup || *one.setup == setup) return one;
      elsewhere = *one.setup;
    }
    throw text::InputError(
        reader_.place(row), name,
        elsewhere.empty()
            ? fmt::format("the machine file has no artefact of this name; it has {}", names)
            : fmt::format(
                  "the machine file has this artefact in the set-up \"{}\", the row is in the set-up \"{}\"",
                  elsewhere, setup));
  }

  /// A distance is between two tool points, or between two unknown points.
  void check_ends(std::size_t row) const {
    const std::size_t other = result_.other_end.empty() ? kNoRow : result_.other_end[row];
    if (other == kNoRow) return;
    const auto met = [&](std::size_t one) {
      return result_.thing[one] == kNoThing                          ? 0
             : result_.things[result_.thing[one]].is_unknown_point() ? 1
                                                                     : 2;
    };
    if (met(row) == 2 || met(other) == 2)
      throw text::InputError(
          reader_.place(row), columns::kDistance,
          "a row of a distance must not touch an artefact: give the artefacts their known positions instead");
    if (met(row) != met(other))
      throw text::InputError(reader_.place(row), columns::kDistance,
                             "one end of this distance is a point of the column same, the other end is not: "
                             "name the points of both rows in the column same");
  }

  /// Reads three columns that belong to a reading: lengths of a point, or pure numbers of a
  /// direction.
  void three(const std::array<const char*, 3>& names, const char* owner, Eigen::Matrix3Xd& target) {
    target = Eigen::Matrix3Xd::Zero(3, static_cast<Eigen::Index>(reader_.rows()));
    for (std::size_t k = 0; k < 3; ++k) {
      if (!reader_.has(names[k])) {
        if (reader_.has(owner))
          throw text::InputError(reader_.header(), owner,
                                 std::string("this column needs ") + names[k] + " beside it");
        continue;
      }
      const Column column =
          reader_.numbers(names[k], format::dimension_of(*format::find_column(names[k])), false);
      target.row(static_cast<Eigen::Index>(k)) = column.matrix().transpose();
    }
  }

  void read_geometry() {
    three(columns::kCentre, columns::kLength, result_.centre);
    three(columns::kNominalPoint, columns::kDeviation, result_.nominal_point);
    Eigen::Matrix3Xd normal;
    three(columns::kNormal, columns::kDeviation, normal);
  }

  void read_observations() {
    std::array<Column, format::kReadingKindCount> values;
    bool any = false;
    for (std::size_t k = 0; k < format::kReadingKindCount; ++k) {
      const auto kind = static_cast<ObservationKind>(k);
      if (is_direction(kind)) {
        if (has_directions_) values[k] = 0 * result_.direction.row(0).transpose().array();
      } else if (is_measured(kind)) {
        values[k] = reader_.numbers(
            format::name_of(kind), is_rotation(kind) ? format::Dimension::kAngle : format::Dimension::kLength,
            false);
      }
      any = any || values[k].size() > 0;
    }
    any = any || names_things(columns::kSame) || names_things(columns::kOn);
    if (!any && has_word(columns::kOn))
      throw text::InputError(
          reader_.header(), columns::kOn,
          "the machine file has no <artefact>; state what the tool point touched, such as <artefact name=\"" +
              first_word(columns::kOn) + "\" type=\"plane\"/>, before </variables> of the machine file");
    if (!any)
      throw text::InputError(reader_.header(), "",
                             "no measured column (" + format::reading_column_names() + ")");
    for (std::size_t row = 0; row < reader_.rows(); ++row)
      for (std::size_t k = 0; k < values.size(); ++k) {
        const auto at = static_cast<Eigen::Index>(row);
        if (values[k].size() == 0 || std::isnan(values[k][at])) continue;
        const auto kind = static_cast<ObservationKind>(k);
        check_geometry(kind, row);
        result_.observations.push_back({kind, row, values[k][at]});
      }
    add_touches();
  }

  /// Adds the readings of things, which are 0, behind the other readings of their row.
  void add_touches() {
    if (result_.things.empty()) return;
    std::vector<Observation> all;
    std::size_t next = 0;
    for (std::size_t row = 0; row < reader_.rows(); ++row) {
      for (; next < result_.observations.size() && result_.observations[next].row == row; ++next)
        all.push_back(result_.observations[next]);
      if (result_.thing[row] == kNoThing) continue;
      const Thing& thing = result_.things[result_.thing[row]];
      const auto first = thing.is_unknown_point() ? ObservationKind::kSameX : ObservationKind::kOn1;
      for (std::size_t k = 0; k < thing.artefact.dimension(); ++k)
        all.push_back({static_cast<ObservationKind>(static_cast<std::size_t>(first) + k), row, 0});
    }
    result_.observations = std::move(all);
    count_lengths_once();
  }

  /// A length between two unknown points that several rows state alike is one reading: that of the smallest
  /// u.
  void count_lengths_once() {
    std::map<std::tuple<std::size_t, std::size_t, double, char>, std::size_t> best;
    const auto key = [&](const Observation& o) {
      const std::size_t a = result_.thing[o.row], b = result_.thing[result_.other_end[o.row]];
      return std::tuple(std::min(a, b), std::max(a, b), o.value, result_.check[o.row]);
    };
    const auto is_length = [&](const Observation& o) {
      return o.kind == ObservationKind::kDistance && result_.is_between_things(o.row);
    };
    const auto u = [&](std::size_t row) { return result_.uncertainty[static_cast<Eigen::Index>(row)]; };
    for (const Observation& o : result_.observations) {
      if (!is_length(o)) continue;
      const auto [at, fresh] = best.try_emplace(key(o), o.row);
      if (!fresh && u(o.row) < u(at->second)) at->second = o.row;
    }
    std::erase_if(result_.observations,
                  [&](const Observation& o) { return is_length(o) && best.at(key(o)) != o.row; });
  }

  bool is_measured(ObservationKind kind) const {
    return !is_of_thing(kind) && is_reading(format::name_of(kind));
  }

  /// A length needs its centre, a deviation its nominal point and a unit normal.
  void check_geometry(ObservationKind kind, std::size_t row) {
    const auto at = static_cast<Eigen::Index>(row);
    const auto finite = [&](const Eigen::Matrix3Xd& m) { return m.col(at).allFinite(); };
    if (kind == ObservationKind::kLength && !finite(result_.centre))
      throw text::InputError(reader_.place(row), columns::kLength, all_needed(columns::kCentre));
    if (format::entry_of(format::form_of(kind)).never_negative &&
        reader_.cell(format::name_of(kind), row).front() == '-')
      throw text::InputError(reader_.place(row), reader_.cell(format::name_of(kind), row),
                             "a measured length must not be negative");
    if (kind == ObservationKind::kDistance && result_.other_end[row] == kNoRow)
      throw text::InputError(reader_.place(row), columns::kFrom,
                             "this cell must not be empty: give the row at the other end of the distance");
    if (format::is_of_board(kind)) {
      const format::ColumnGroup& group = format::reading_columns(format::form_of(kind));
      for (const char* const name : group.list())
        if (reader_.cell(name, row).empty())
          throw text::InputError(reader_.place(row), name, all_needed(group.names));
    }
    if (is_inclination(kind) && !machine_.workpiece.empty())
      throw text::InputError(
          reader_.header(), format::name_of(kind),
          "readings of inclination are supported only if the workpiece of the machine does not move");
    if (kind != ObservationKind::kD) return;
    if (!finite(result_.nominal_point))
      throw text::InputError(reader_.place(row), columns::kDeviation, all_needed(columns::kNominalPoint));
    const auto& n = result_.states.normal;
    const double size = std::hypot(n[0][at], n[1][at], n[2][at]);
    if (std::abs(size - 1) > 0.01)
      throw text::InputError(reader_.place(row), reader_.cell(columns::kNormal.front(), row),
                             "nx, ny, nz must be a unit vector");
  }

  static std::string all_needed(const std::array<const char*, 3>& names) {
    return fmt::format("{}, {} and {} may not be empty here", names[0], names[1], names[2]);
  }

  const Machine& machine_;
  ColumnReader reader_;
  Measurement result_;
  std::vector<char> excluded_;
  bool has_directions_ = false, has_distances_ = false;
};

Column join(const Column& a, const Column& b) {
  Column result(a.size() + b.size());
  result << a, b;
  return result;
}
Eigen::Matrix3Xd join(const Eigen::Matrix3Xd& a, const Eigen::Matrix3Xd& b) {
  Eigen::Matrix3Xd result(3, a.cols() + b.cols());
  result << a, b;
  return result;
}
template <class T>
void append(std::vector<T>& a, const std::vector<T>& b) {
  a.insert(a.end(), b.begin(), b.end());
}
void join_all(std::vector<Column>& a, const std::vector<Column>& b) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] = join(a[i], b[i]);
}

void append_states(States& all, const States& next, bool apart) {
  append_labels(all, next, apart);
  join_all(all.axis, next.axis);
  join_all(all.velocity, next.velocity);
  join_all(all.acceleration, next.acceleration);
  join_all(all.direction, next.direction);
  join_all(all.since, next.since);
  join_all(all.input, next.input);
  for (std::size_t i = 0; i < 3; ++i) all.normal[i] = join(all.normal[i], next.normal[i]);
  all.feed = join(all.feed, next.feed);
  all.curvature = join(all.curvature, next.curvature);
  all.time = join(all.time, next.time);
  all.visit = join(all.visit, next.visit);
  all.count += next.count;
}

void append_candidates(Measurement& all, const Measurement& next) {
  const auto before = static_cast<Eigen::Index>(all.rows()), more = static_cast<Eigen::Index>(next.rows());
  for (CandidateInput& candidate : all.candidates) {
    Column tail = Column::Constant(more, kAbsent);
    for (const CandidateInput& other : next.candidates)
      if (other.name == candidate.name) {
        if (other.unit != candidate.unit)
          throw text::InputError({next.files[0], 0}, other.name,
                                 "another file gives this column in another unit: [" + candidate.unit + "]");
        tail = other.value;
      }
    candidate.value = join(candidate.value, tail);
  }
  for (const CandidateInput& candidate : next.candidates)
    if (std::none_of(all.candidates.begin(), all.candidates.end(),
                     [&](const CandidateInput& other) { return other.name == candidate.name; }))
      all.candidates.push_back(
          {candidate.name, candidate.unit, join(Column::Constant(before, kAbsent), candidate.value)});
}

/// Appends columns of words. If one of two files lacks a column, its cells are empty there.
void append_labels_of_rows(Measurement& all, const Measurement& next) {
  for (const LabelColumn& other : next.labels)
    if (std::none_of(all.labels.begin(), all.labels.end(),
                     [&](const LabelColumn& one) { return one.name == other.name; }))
      all.labels.push_back({other.name, std::vector<std::string>(all.rows())});
  for (LabelColumn& one : all.labels) {
    one.value.resize(all.rows() + next.rows());
    for (const LabelColumn& other : next.labels)
      if (other.name == one.name)
        std::copy(other.value.begin(), other.value.end(),
                  one.value.begin() + static_cast<std::ptrdiff_t>(all.rows()));
  }
}

/// Appends the things of the rows. A thing that both measurements met is one thing, unless `apart`.
void append_things(Measurement& all, const Measurement& next, bool apart) {
  if (all.thing.empty() && next.thing.empty()) return;
  all.thing.resize(all.rows(), kNoThing);
  const std::size_t known = apart ? 0 : all.things.size();
  std::vector<std::size_t> at;
  for (const Thing& thing : next.things) {
    const auto end = all.things.begin() + static_cast<std::ptrdiff_t>(known);
    const auto found = std::find_if(all.things.begin(), end, [&](const Thing& one) { return one.is(thing); });
    at.push_back(found == end ? all.things.size() : static_cast<std::size_t>(found - all.things.begin()));
    if (found == end) all.things.push_back(thing);
  }
  for (std::size_t row = 0; row < next.rows(); ++row)
    all.thing.push_back(next.thing_of(row) == kNoThing ? kNoThing : at[next.thing[row]]);
}

/// Appends data that only some rows have: ua, directions, things, other ends of distances.
void append_optional(Measurement& all, const Measurement& next, bool apart) {
  const auto before = static_cast<Eigen::Index>(all.rows()), more = static_cast<Eigen::Index>(next.rows());
  const auto with = [](const Column& column, Eigen::Index count) {
    return column.size() > 0 ? column : Column(Column::Zero(count));
  };
  if (all.angle_uncertainty.size() > 0 || next.angle_uncertainty.size() > 0)
    all.angle_uncertainty = join(with(all.angle_uncertainty, before), with(next.angle_uncertainty, more));
  const auto pointing = [](const Eigen::Matrix3Xd& m, Eigen::Index count) {
    return m.cols() > 0 ? m : Eigen::Matrix3Xd(Eigen::Matrix3Xd::Constant(3, count, kAbsent));
  };
  if (all.direction.cols() > 0 || next.direction.cols() > 0)
    all.direction = join(pointing(all.direction, before), pointing(next.direction, more));
  append_things(all, next, apart);
  if (all.other_end.empty() && next.other_end.empty()) return;
  all.other_end.resize(all.rows(), kNoRow);
  for (std::size_t row = 0; row < next.rows(); ++row) {
    const std::size_t other = next.other_end.empty() ? kNoRow : next.other_end[row];
    all.other_end.push_back(other == kNoRow ? kNoRow : other + all.rows());
  }
}

/// If only one of the two has a correction, the correction of the other is 0. The images are
/// handled in the same way.
void append_corrections(Measurement& all, Measurement& next) {
  for (auto [one, other] : {std::pair(&all, &next), std::pair(&next, &all)}) {
    if (one->correction.empty() && !other->correction.empty())
      one->correction.assign(other->correction.size(), Column::Zero(static_cast<Eigen::Index>(one->rows())));
    if (one->corrected.empty() && !other->corrected.empty()) one->corrected.resize(one->rows());
  }
  join_all(all.correction, next.correction);
  append(all.corrected, next.corrected);
}

/// Fills the corrections of rows that name only the image. Moves the axes to the actual positions
/// of the machine.
void add_corrections(Measurement& m, const Machine& machine, const std::string& text,
                     const ImageCorrection& images) {
  if (m.correction.empty() && !m.corrected.empty()) {
    const auto row = static_cast<std::size_t>(
        std::find_if(m.corrected.begin(), m.corrected.end(), [](const auto& word) { return !word.empty(); }) -
        m.corrected.begin());
    if (row == m.rows()) return;  // the rows with an active image are excluded
    if (!images)
      throw text::InputError(
          {m.files.front(), m.line[row]}, m.corrected[row],
          fmt::format("the correction of this image is not known: give the folder of the image (--images "
                      "DIR), or the columns {} and so on",
                      format::axis_column(AxisQuantity::kCorrection, machine.axes.front().name)));
    m.correction.assign(machine.axes.size(), Column::Zero(static_cast<Eigen::Index>(m.rows())));
    images(m, machine, text);
  }
  for (std::size_t i = 0; i < m.correction.size(); ++i) m.states.axis[i] += m.correction[i];
}

/// Returns the rows without the marked ones, and counts those.
Measurement without(const Measurement& all, const std::vector<char>& excluded) {
  std::vector<std::size_t> keep;
  for (std::size_t row = 0; row < all.rows(); ++row)
    if (excluded[row] == 0) keep.push_back(row);
  Measurement result = select_rows(all, keep);
  result.excluded = all.rows() - keep.size();
  return result;
}

template <class T>
std::vector<T> pick(const std::vector<T>& all, const std::vector<std::size_t>& keep) {
  std::vector<T> result;
  for (const std::size_t i : keep) result.push_back(all[i]);
  return result;
}

}  // namespace

std::string set_up_of_file(const std::string& path, bool with_folder) {
  const std::filesystem::path file(path);
  const std::string folder = file.parent_path().filename().string();
  return (with_folder && !folder.empty() ? folder + "/" : "") + file.stem().string();
}

Column commanded(const Measurement& m, std::size_t axis) {
  if (m.correction.empty()) return m.states.axis[axis];
  // Addition and subtraction lose the last bit. A written position has fewer than nine decimals.
  return ((m.states.axis[axis] - m.correction[axis]) * 1e9).round() / 1e9;
}

double uncertainty_of(const Measurement& m, const Observation& o) {
  const auto row = static_cast<Eigen::Index>(o.row);
  if (is_rotation(o.kind) && m.angle_uncertainty.size() > 0 && m.angle_uncertainty[row] > 0)
    return m.angle_uncertainty[row];
  return m.uncertainty[row];
}

double commanded(const Measurement& m, std::size_t axis, Eigen::Index row) {
  if (m.correction.empty()) return m.states.axis[axis][row];
  return std::round((m.states.axis[axis][row] - m.correction[axis][row]) * 1e9) / 1e9;
}

States commanded_states(const Measurement& m) {
  States states = m.states;
  for (std::size_t i = 0; i < m.correction.size(); ++i) states.axis[i] = commanded(m, i);
  return states;
}

bool Measurement::is_between_things(std::size_t row) const {
  const std::size_t other = other_end.empty() ? kNoRow : other_end[row];
  return other != kNoRow && thing_of(row) != kNoThing && thing_of(other) != kNoThing &&
         things[thing[row]].is_unknown_point() && things[thing[other]].is_unknown_point();
}

bool is_free_of_set_up(const Measurement& m, const Observation& o) {
  if (is_of_thing(o.kind)) return !m.things[m.thing[o.row]].in_measuring_frame();
  return is_free_of_setup(o.kind) || (o.kind == ObservationKind::kDistance && m.is_between_things(o.row));
}

bool Measurement::has_recorded(std::string_view name) const {
  return std::find(recorded.begin(), recorded.end(), name) != recorded.end();
}

void require_time_order(const Measurement& m) {
  const std::vector<std::string>& clocks = m.states.names(m.states.clock);
  std::vector<std::size_t> last(clocks.size(), m.rows());
  for (std::size_t row = 0; row < m.rows(); ++row) {
    const std::size_t clock = m.states.of(m.states.clock, row);
    std::size_t& before = last[clock];
    const auto at = static_cast<Eigen::Index>(row), from = static_cast<Eigen::Index>(before);
    if (before < m.rows() && m.states.time[at] < m.states.time[from])
      throw text::InputError(
          {m.files[m.file[row]], m.line[row]}, format::columns::kTime,
          fmt::format("falls from {} to {} s in run \"{}\": rows are in the order of time; if a "
                      "file has a clock of its own, write a column \"{}\" with another name "
                      "in each file; if not, state the files in the order of time",
                      m.states.time[from], m.states.time[at], clocks[clock], format::columns::kRun));
    before = row;
  }
}

Measurement select_rows(const Measurement& all, const std::vector<std::size_t>& keep) {
  Measurement result;
  result.files = all.files;
  result.states = select_states(all.states, keep);
  // A row's observations are adjacent. If a row is kept twice, other rows refer to its first copy.
  std::vector<std::size_t> position(all.rows(), kNoRow), first(all.rows() + 1, 0);
  std::vector<std::size_t> met(all.things.size(), kNoRow);
  for (std::size_t i = keep.size(); i-- > 0;) {
    position[keep[i]] = i;
    if (all.thing_of(keep[i]) != kNoThing) met[all.thing[keep[i]]] = i;
  }
  for (const Observation& o : all.observations) ++first[o.row + 1];
  for (std::size_t row = 0; row < all.rows(); ++row) first[row + 1] += first[row];
  for (std::size_t i = 0; i < keep.size(); ++i) {
    const std::size_t other = all.other_end.empty() ? kNoRow : all.other_end[keep[i]];
    std::size_t end = other == kNoRow ? kNoRow : position[other];
    // Any row that met the point at the other end stands for it.
    if (end == kNoRow && all.is_between_things(keep[i])) end = met[all.thing[other]];
    if (!all.other_end.empty()) result.other_end.push_back(end);
    for (std::size_t k = first[keep[i]]; k < first[keep[i] + 1]; ++k) {
      Observation o = all.observations[k];
      if (o.kind == ObservationKind::kDistance && end == kNoRow) continue;
      o.row = i;
      result.observations.push_back(o);
    }
  }
  const auto count = static_cast<Eigen::Index>(keep.size());
  result.uncertainty.resize(count);
  result.correction.assign(all.correction.size(), Column(count));
  if (all.centre.cols() > 0) result.centre.resize(3, count);
  if (all.nominal_point.cols() > 0) result.nominal_point.resize(3, count);
  if (all.angle_uncertainty.size() > 0) result.angle_uncertainty.resize(count);
  if (all.direction.cols() > 0) result.direction.resize(3, count);
  for (const CandidateInput& candidate : all.candidates)
    result.candidates.push_back({candidate.name, candidate.unit, Column(count)});
  for (Eigen::Index to = 0; to < count; ++to) {
    const auto from = static_cast<Eigen::Index>(keep[static_cast<std::size_t>(to)]);
    result.uncertainty[to] = all.uncertainty[from];
    for (std::size_t k = 0; k < all.correction.size(); ++k)
      result.correction[k][to] = all.correction[k][from];
    if (all.centre.cols() > 0) result.centre.col(to) = all.centre.col(from);
    if (all.nominal_point.cols() > 0) result.nominal_point.col(to) = all.nominal_point.col(from);
    if (all.angle_uncertainty.size() > 0) result.angle_uncertainty[to] = all.angle_uncertainty[from];
    if (all.direction.cols() > 0) result.direction.col(to) = all.direction.col(from);
    for (std::size_t k = 0; k < all.candidates.size(); ++k)
      result.candidates[k].value[to] = all.candidates[k].value[from];
  }
  for (const LabelColumn& label : all.labels) result.labels.push_back({label.name, pick(label.value, keep)});
  if (!all.corrected.empty()) result.corrected = pick(all.corrected, keep);
  result.things = all.things;
  if (!all.thing.empty()) result.thing = pick(all.thing, keep);
  result.check = pick(all.check, keep);
  result.file = pick(all.file, keep);
  result.line = pick(all.line, keep);
  result.excluded = all.excluded;
  result.recorded = all.recorded;
  return result;
}

namespace {

/// A file without a column `t` beside files with one has times of its own: its rows are not at 0 s of the
/// other clock.
void keep_clocks_apart(Measurement& all, Measurement& next) {
  if (all.has_recorded(columns::kTime) == next.has_recorded(columns::kTime)) return;
  for (Measurement* const m : {&all, &next}) {
    if (m->has_recorded(columns::kTime)) continue;
    Labels& clock = m->states.clock;
    if (clock.of.empty()) clock = {m->states.run, m->states.run_names};
    for (std::string& name : clock.names)
      name = fmt::format("{} without {}", m->files.back(), columns::kTime);
  }
}

}  // namespace

void append_measurement(Measurement& all, Measurement next, bool apart) {
  keep_clocks_apart(all, next);
  append_candidates(all, next);
  append_corrections(all, next);
  append_labels_of_rows(all, next);
  append_optional(all, next, apart);
  for (Observation observation : next.observations) {
    observation.row += all.rows();
    all.observations.push_back(observation);
  }
  all.uncertainty = join(all.uncertainty, next.uncertainty);
  append(all.check, next.check);
  for (std::size_t& file : next.file) file = all.files.size();
  append(all.file, next.file);
  append(all.line, next.line);
  append(all.files, next.files);
  all.centre = join(all.centre, next.centre);
  all.nominal_point = join(all.nominal_point, next.nominal_point);
  all.excluded += next.excluded;
  for (const std::string& name : next.recorded)
    if (!all.has_recorded(name)) all.recorded.push_back(name);
  append_states(all.states, next.states, apart);
}

Measurement parse_measurement(const std::string& text, const std::string& file, const Machine& machine,
                              const ImageCorrection& images) {
  const format::CsvFile csv = format::parse_csv(text, file);
  Builder builder(csv, machine);
  const Measurement all = builder.build();
  Measurement rows = without(all, builder.excluded());
  add_corrections(rows, machine, text, images);
  return rows;
}

Measurement read_measurement(const std::vector<std::string>& paths, const Machine& machine,
                             const ImageCorrection& images) {
  if (paths.empty()) throw text::InputError("no measurement file");
  Measurement all;
  std::map<std::string, std::string> file_of_text;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const std::string text = text::read_file(paths[i]);
    if (const auto [known, is_new] = file_of_text.try_emplace(text, paths[i]); !is_new)
      throw text::InputError(
          fmt::format("{}: this file has the same readings as {}; give each measurement only once", paths[i],
                      known->second));
    Measurement next = parse_measurement(text, paths[i], machine, images);
    if (i == 0)
      all = std::move(next);
    else
      append_measurement(all, std::move(next));
  }
  return all;
}

}  // namespace vernier::model
