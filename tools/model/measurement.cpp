// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/model/measurement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <set>

#include "tools/text/csv.h"
#include "tools/text/files.h"
#include "tools/text/numbers.h"
#include "tools/text/units.h"

namespace vernier {
namespace {

constexpr double kAbsent = std::numeric_limits<double>::quiet_NaN();
/// Columns that say what a board had added: before an axis' name, and the image that ran.
const std::string kCorrection = "correction", kCorrected = "corrected";

/// One file's columns as numbers in their base units; NaN for an empty cell.
class FileReader {
 public:
  explicit FileReader(const CsvFile& csv) : csv_(csv) {
    for (std::size_t i = 0; i < csv.columns.size(); ++i) index_[csv.columns[i].name] = i;
  }

  bool has(const std::string& name) const { return index_.contains(name); }

  /// A column that must have this dimension; `required`: an empty cell is an error.
  Column numbers(const std::string& name, Dimension dimension, bool required) {
    const std::size_t column = index_.at(name);
    used_.insert(name);
    const Unit unit = *find_unit(csv_.columns[column].unit);
    if (unit.dimension != dimension)
      throw InputError(header(), csv_.columns[column].unit.empty() ? name : name + "[" + unit.name + "]",
                       dimension == Dimension::kNone
                           ? std::string("this column is a pure number, it has no unit")
                           : std::string("this column needs a unit like ") + base_unit(dimension));
    return read(column, unit.factor, unit.offset, required);
  }

  /// A column as it is, without conversion.
  Column raw(const std::string& name) {
    used_.insert(name);
    return read(index_.at(name), 1, 0, false);
  }

  std::vector<std::string> words(const std::string& name) {
    used_.insert(name);
    const std::size_t column = index_.at(name);
    std::vector<std::string> result;
    for (const auto& row : csv_.rows) result.push_back(row[column]);
    return result;
  }

  std::vector<CsvColumn> unused() const {
    std::vector<CsvColumn> list;
    for (const CsvColumn& column : csv_.columns)
      if (!used_.contains(column.name)) list.push_back(column);
    return list;
  }

  Place header() const { return {csv_.file, csv_.header_line}; }
  Place place(std::size_t row) const { return {csv_.file, csv_.line[row]}; }
  const std::string& unit(const std::string& name) const { return csv_.columns[index_.at(name)].unit; }
  const std::string& cell(const std::string& name, std::size_t row) const {
    return csv_.rows[row][index_.at(name)];
  }
  std::size_t rows() const { return csv_.rows.size(); }

 private:
  Column read(std::size_t column, double factor, double offset, bool required) {
    Column result(static_cast<Eigen::Index>(rows()));
    for (std::size_t row = 0; row < rows(); ++row) {
      const std::string& text = csv_.rows[row][column];
      double& value = result[static_cast<Eigen::Index>(row)];
      if (text.empty()) {
        if (required) throw InputError(place(row), csv_.columns[column].name, "this column may not be empty");
        value = kAbsent;
        continue;
      }
      const auto number = parse_number(text);
      if (!number) throw InputError(place(row), text, "not a number, in column " + csv_.columns[column].name);
      value = factor * *number + offset;
    }
    return result;
  }

  const CsvFile& csv_;
  std::map<std::string, std::size_t> index_;
  std::set<std::string> used_;
};

/// Reads one file into a Measurement of its own.
class Builder {
 public:
  Builder(const CsvFile& csv, const Machine& machine) : machine_(machine), reader_(csv) {
    std::vector<double> references;
    for (const Input& input : machine.inputs) references.push_back(input.reference);
    result_.states = make_states(reader_.rows(), machine.axes.size(), references);
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
    read_geometry();
    read_observations();
    for (const CsvColumn& column : reader_.unused())
      result_.candidates.push_back({column.name, column.unit, reader_.raw(column.name)});
    return std::move(result_);
  }

  /// Rows to leave out because an input cell is empty.
  const std::vector<char>& excluded() const { return excluded_; }

 private:
  void check_names() {
    const auto reserved = [this](const std::string& name) {
      for (const Axis& axis : machine_.axes)
        if (name == kCorrection + axis.name) return true;
      for (const char* word : {"x", "y", "z", "rx", "ry", "rz", "length", "cx", "cy", "cz", "d", "px", "py",
                               "pz", "u", "run", "role", "corrected"})
        if (name == word) return true;
      return false;
    };
    for (const Axis& axis : machine_.axes)
      if (reserved(axis.name))
        throw InputError({machine_.file, axis.line}, axis.name,
                         "measurement files use this name for a measured column");
    for (const Input& input : machine_.inputs)
      if (reserved(input.name))
        throw InputError({machine_.file, input.line}, input.name,
                         "measurement files use this name for a measured column");
  }

  void read_axes() {
    for (std::size_t i = 0; i < machine_.axes.size(); ++i) {
      const Axis& axis = machine_.axes[i];
      if (!reader_.has(axis.name))
        throw InputError(reader_.header(), axis.name, "the column of this axis is missing");
      result_.states.axis[i] =
          reader_.numbers(axis.name, axis.rotary ? Dimension::kAngle : Dimension::kLength, true);
    }
  }

  /// What a board had added; axis positions stay as commanded until it is known in all rows.
  void read_corrections() {
    const auto zero = Column::Zero(static_cast<Eigen::Index>(reader_.rows()));
    for (std::size_t i = 0; i < machine_.axes.size(); ++i) {
      const std::string name = kCorrection + machine_.axes[i].name;
      if (!reader_.has(name)) continue;
      if (result_.correction.empty()) result_.correction.assign(machine_.axes.size(), zero);
      const Column read =
          reader_.numbers(name, machine_.axes[i].rotary ? Dimension::kAngle : Dimension::kLength, false);
      result_.correction[i] = read.isNaN().select(0, read);
    }
    for (const CsvColumn& column : reader_.unused())
      if (column.name.starts_with(kCorrection) && reader_.has(column.name.substr(kCorrection.size())))
        throw InputError(reader_.header(), column.name, "the machine file has no such axis");
    if (reader_.has(kCorrected)) read_fingerprints();
  }

  void read_fingerprints() {
    result_.corrected = reader_.words(kCorrected);
    bool any = false;
    for (std::size_t row = 0; row < reader_.rows(); ++row) {
      std::string& word = result_.corrected[row];
      if (word.empty()) continue;
      any = true;
      std::transform(word.begin(), word.end(), word.begin(),
                     [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
      if (word.size() != 16 || word.find_first_not_of("0123456789abcdef") != std::string::npos)
        throw InputError(reader_.place(row), reader_.cell(kCorrected, row),
                         "the fingerprint of an image has 16 hexadecimal digits");
    }
    if (!any) result_.corrected.clear();
  }

  void motion(const std::string& name, Dimension dimension, Column& target, double factor = 1) {
    if (!reader_.has(name)) return;
    target = factor * reader_.numbers(name, dimension, true);
    result_.recorded.push_back(name);
  }

  void read_motion() {
    States& states = result_.states;
    for (std::size_t i = 0; i < machine_.axes.size(); ++i) {
      const Axis& axis = machine_.axes[i];
      motion("v" + axis.name, axis.rotary ? Dimension::kAngularSpeed : Dimension::kSpeed, states.velocity[i]);
      motion("a" + axis.name, axis.rotary ? Dimension::kAngularAcceleration : Dimension::kAcceleration,
             states.acceleration[i]);
      motion("dir" + axis.name, Dimension::kNone, states.direction[i]);
      motion("since" + axis.name, axis.rotary ? Dimension::kAngle : Dimension::kLength, states.since[i]);
      for (std::size_t row = 0; row < reader_.rows(); ++row) {
        const double dir = states.direction[i][static_cast<Eigen::Index>(row)];
        if (dir != -1 && dir != 0 && dir != 1)
          throw InputError(reader_.place(row), reader_.cell("dir" + axis.name, row),
                           "a direction is -1, 0 or 1");
      }
    }
    motion("feed", Dimension::kSpeed, states.feed, 60);
    motion("curv", Dimension::kCurvature, states.curvature);
    motion("t", Dimension::kTime, states.time);
    for (std::size_t k = 0; k < 3; ++k)
      if (const std::string name = std::string("n") + "xyz"[k]; reader_.has(name))
        states.normal[k] = reader_.numbers(name, Dimension::kNone, false);
    for (Column& normal : states.normal) normal = normal.isNaN().select(0, normal);
  }

  void read_inputs() {
    excluded_.assign(reader_.rows(), 0);
    for (std::size_t i = 0; i < machine_.inputs.size(); ++i) {
      const Input& input = machine_.inputs[i];
      if (!reader_.has(input.name)) continue;
      Column& target = result_.states.input[i];
      target = reader_.raw(input.name);
      const Unit written = *find_unit(reader_.unit(input.name));
      const auto declared = find_unit(input.unit);
      const bool same_text = input.unit == written.name;
      if (!same_text && !input.unit.empty()) {
        if (!declared || declared->dimension != written.dimension)
          throw InputError(reader_.header(),
                           input.name + (written.dimension == Dimension::kNone ? "" : "[") + written.name +
                               (written.dimension == Dimension::kNone ? "" : "]"),
                           "the machine file declares this input in " + input.unit);
        target = (written.factor * target + written.offset - declared->offset) / declared->factor;
      }
      for (std::size_t row = 0; row < reader_.rows(); ++row)
        if (std::isnan(target[static_cast<Eigen::Index>(row)])) excluded_[row] = 1;
    }
  }

  void read_labels() {
    result_.check.assign(reader_.rows(), 0);
    if (reader_.has("role")) {
      const std::vector<std::string> roles = reader_.words("role");
      for (std::size_t row = 0; row < roles.size(); ++row) {
        if (roles[row] != "fit" && roles[row] != "check" && !roles[row].empty())
          throw InputError(reader_.place(row), roles[row], "a role is fit or check");
        result_.check[row] = roles[row] == "check" ? 1 : 0;
      }
    }
    States& states = result_.states;
    if (reader_.has("run")) {
      states.run_names.clear();
      std::map<std::string, std::size_t> known;
      const std::vector<std::string> runs = reader_.words("run");
      for (std::size_t row = 0; row < runs.size(); ++row) {
        const auto [found, fresh] = known.emplace(runs[row], states.run_names.size());
        if (fresh) states.run_names.push_back(runs[row]);
        states.run[row] = found->second;
      }
    }
    std::vector<double> seen(states.run_names.size(), 0);
    for (std::size_t row = 0; row < reader_.rows(); ++row)
      states.visit[static_cast<Eigen::Index>(row)] = seen[states.run[row]]++;
    if (reader_.has("visit")) states.visit = reader_.numbers("visit", Dimension::kNone, true);
    result_.uncertainty = Column::Zero(static_cast<Eigen::Index>(reader_.rows()));
    if (!reader_.has("u")) return;
    const bool angle = find_unit(reader_.unit("u"))->dimension == Dimension::kAngle;
    result_.uncertainty = reader_.numbers("u", angle ? Dimension::kAngle : Dimension::kLength, true);
    for (std::size_t row = 0; row < reader_.rows(); ++row)
      if (result_.uncertainty[static_cast<Eigen::Index>(row)] <= 0)
        throw InputError(reader_.place(row), reader_.cell("u", row), "an uncertainty is greater than 0");
  }

  void three(const std::string& prefix, const char* owner, Eigen::Matrix3Xd& target) {
    target = Eigen::Matrix3Xd::Zero(3, static_cast<Eigen::Index>(reader_.rows()));
    for (std::size_t k = 0; k < 3; ++k) {
      const std::string name = prefix + "xyz"[k];
      if (!reader_.has(name)) {
        if (reader_.has(owner))
          throw InputError(reader_.header(), owner, "this column needs " + name + " beside it");
        continue;
      }
      const Column column = prefix == "n" ? reader_.numbers(name, Dimension::kNone, false)
                                          : reader_.numbers(name, Dimension::kLength, false);
      target.row(static_cast<Eigen::Index>(k)) = column.matrix().transpose();
    }
  }

  void read_geometry() {
    three("c", "length", result_.centre);
    three("p", "d", result_.nominal_point);
    Eigen::Matrix3Xd normal;
    three("n", "d", normal);
  }

  void read_observations() {
    std::array<Column, 8> values;
    bool any = false;
    for (std::size_t k = 0; k < kObservationNames.size(); ++k) {
      if (!reader_.has(kObservationNames[k])) continue;
      const bool rotation = is_rotation(static_cast<ObservationKind>(k));
      values[k] =
          reader_.numbers(kObservationNames[k], rotation ? Dimension::kAngle : Dimension::kLength, false);
      any = true;
    }
    if (!any) throw InputError(reader_.header(), "", "no measured column (x y z rx ry rz length d)");
    for (std::size_t row = 0; row < reader_.rows(); ++row)
      for (std::size_t k = 0; k < values.size(); ++k) {
        const auto at = static_cast<Eigen::Index>(row);
        if (values[k].size() == 0 || std::isnan(values[k][at])) continue;
        const auto kind = static_cast<ObservationKind>(k);
        check_geometry(kind, row);
        result_.observations.push_back({kind, row, values[k][at]});
      }
  }

  /// A length needs its centre, a deviation its nominal point and a unit normal.
  void check_geometry(ObservationKind kind, std::size_t row) {
    const auto at = static_cast<Eigen::Index>(row);
    const auto finite = [&](const Eigen::Matrix3Xd& m) { return m.col(at).allFinite(); };
    if (kind == ObservationKind::kLength && !finite(result_.centre))
      throw InputError(reader_.place(row), "length", "cx, cy and cz may not be empty here");
    if (kind == ObservationKind::kLength && reader_.cell("length", row).front() == '-')
      throw InputError(reader_.place(row), reader_.cell("length", row), "a length is not negative");
    if (kind != ObservationKind::kD) return;
    if (!finite(result_.nominal_point))
      throw InputError(reader_.place(row), "d", "px, py and pz may not be empty here");
    const auto& n = result_.states.normal;
    const double size = std::hypot(n[0][at], n[1][at], n[2][at]);
    if (std::abs(size - 1) > 0.01)
      throw InputError(reader_.place(row), reader_.cell("nx", row), "nx, ny, nz must be a unit vector");
  }

  const Machine& machine_;
  FileReader reader_;
  Measurement result_;
  std::vector<char> excluded_;
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

void append_states(States& all, const States& next) {
  std::vector<std::size_t> run_of;
  for (const std::string& name : next.run_names) {
    auto found = std::find(all.run_names.begin(), all.run_names.end(), name);
    if (found == all.run_names.end()) found = all.run_names.insert(all.run_names.end(), name);
    run_of.push_back(static_cast<std::size_t>(found - all.run_names.begin()));
  }
  for (const std::size_t run : next.run) all.run.push_back(run_of[run]);
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
          throw InputError({next.files[0], 0}, other.name,
                           "another file gives this column in [" + candidate.unit + "]");
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

/// Where only one of two has a correction, the other's is 0; and so with the images.
void append_corrections(Measurement& all, Measurement& next) {
  for (auto [one, other] : {std::pair(&all, &next), std::pair(&next, &all)}) {
    if (one->correction.empty() && !other->correction.empty())
      one->correction.assign(other->correction.size(), Column::Zero(static_cast<Eigen::Index>(one->rows())));
    if (one->corrected.empty() && !other->corrected.empty()) one->corrected.resize(one->rows());
  }
  join_all(all.correction, next.correction);
  append(all.corrected, next.corrected);
}

void append_measurement(Measurement& all, Measurement next) {
  append_candidates(all, next);
  append_corrections(all, next);
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
  append_states(all.states, next.states);
}

/// Fills the corrections of rows that name only the image, and moves the axes to where the machine stood.
void add_corrections(Measurement& m, const Machine& machine, const std::string& text,
                     const ImageCorrection& images) {
  if (m.correction.empty() && !m.corrected.empty()) {
    const auto row = static_cast<std::size_t>(
        std::find_if(m.corrected.begin(), m.corrected.end(), [](const auto& word) { return !word.empty(); }) -
        m.corrected.begin());
    if (row == m.rows()) return;  // the rows that it ran in are excluded
    if (!images)
      throw InputError({m.files.front(), m.line[row]}, m.corrected[row],
                       "what this image added is not known: say where it is (--images DIR), or give columns "
                       "correction" +
                           machine.axes.front().name + " and so on");
    m.correction.assign(machine.axes.size(), Column::Zero(static_cast<Eigen::Index>(m.rows())));
    images(m, machine, text);
  }
  for (std::size_t i = 0; i < m.correction.size(); ++i) m.states.axis[i] += m.correction[i];
}

/// Leaves out the rows that are marked, and counts them.
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

Column commanded(const Measurement& m, std::size_t axis) {
  if (m.correction.empty()) return m.states.axis[axis];
  // Adding and taking away loses the last bit; what somebody wrote has fewer than nine decimals.
  return ((m.states.axis[axis] - m.correction[axis]) * 1e9).round() / 1e9;
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

bool Measurement::has_recorded(std::string_view name) const {
  return std::find(recorded.begin(), recorded.end(), name) != recorded.end();
}

void require_time_order(const Measurement& m) {
  std::vector<std::size_t> last(m.states.run_names.size(), m.rows());
  for (std::size_t row = 0; row < m.rows(); ++row) {
    std::size_t& before = last[m.states.run[row]];
    const auto at = static_cast<Eigen::Index>(row), from = static_cast<Eigen::Index>(before);
    if (before < m.rows() && m.states.time[at] < m.states.time[from])
      throw InputError(
          {m.files[m.file[row]], m.line[row]}, "t",
          fmt::format("falls from {} to {} s in run \"{}\": rows are in the order of time",
                      m.states.time[from], m.states.time[at], m.states.run_names[m.states.run[row]]));
    before = row;
  }
}

Measurement select_rows(const Measurement& all, const std::vector<std::size_t>& keep) {
  Measurement result;
  result.files = all.files;
  result.states = select_states(all.states, keep);
  std::vector<std::size_t> position(all.rows(), all.rows());
  for (std::size_t i = 0; i < keep.size(); ++i) position[keep[i]] = i;
  for (Observation o : all.observations)
    if (position[o.row] < all.rows()) {
      o.row = position[o.row];
      result.observations.push_back(o);
    }
  const auto count = static_cast<Eigen::Index>(keep.size());
  result.uncertainty.resize(count);
  result.correction.assign(all.correction.size(), Column(count));
  result.centre.resize(3, count);
  result.nominal_point.resize(3, count);
  for (const CandidateInput& candidate : all.candidates)
    result.candidates.push_back({candidate.name, candidate.unit, Column(count)});
  for (Eigen::Index to = 0; to < count; ++to) {
    const auto from = static_cast<Eigen::Index>(keep[static_cast<std::size_t>(to)]);
    result.uncertainty[to] = all.uncertainty[from];
    for (std::size_t k = 0; k < all.correction.size(); ++k)
      result.correction[k][to] = all.correction[k][from];
    result.centre.col(to) = all.centre.col(from);
    result.nominal_point.col(to) = all.nominal_point.col(from);
    for (std::size_t k = 0; k < all.candidates.size(); ++k)
      result.candidates[k].value[to] = all.candidates[k].value[from];
  }
  if (!all.corrected.empty()) result.corrected = pick(all.corrected, keep);
  result.check = pick(all.check, keep);
  result.file = pick(all.file, keep);
  result.line = pick(all.line, keep);
  result.excluded = all.excluded;
  result.recorded = all.recorded;
  return result;
}

Measurement parse_measurement(const std::string& text, const std::string& file, const Machine& machine,
                              const ImageCorrection& images) {
  const CsvFile csv = parse_csv(text, file);
  Builder builder(csv, machine);
  const Measurement all = builder.build();
  Measurement rows = without(all, builder.excluded());
  add_corrections(rows, machine, text, images);
  return rows;
}

Measurement read_measurement(const std::vector<std::string>& paths, const Machine& machine,
                             const ImageCorrection& images) {
  if (paths.empty()) throw InputError("no measurement file");
  Measurement all;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    Measurement next = parse_measurement(read_file(paths[i]), paths[i], machine, images);
    if (i == 0)
      all = std::move(next);
    else
      append_measurement(all, std::move(next));
  }
  return all;
}

}  // namespace vernier
