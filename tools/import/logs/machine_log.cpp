// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/logs/machine_log.h"

#include <cmath>

#include "tools/format/columns.h"
#include "tools/format/csv_file.h"
#include "tools/format/units.h"
#include "tools/model/chain/chain.h"
#include "tools/text/error.h"
#include "tools/text/numbers.h"

namespace vernier::importer {
namespace {

using Index = Eigen::Index;

class Log {
 public:
  Log(const std::string& text, const std::string& file) : csv_(format::parse_csv(text, file)) {}

  const format::CsvFile& csv() const { return csv_; }

  std::size_t need(const std::string& name) const {
    for (std::size_t k = 0; k < csv_.columns.size(); ++k)
      if (csv_.columns[k].name == name) return k;
    throw text::InputError({csv_.file, csv_.header_line}, name, "the log has no column of this name");
  }
  /// In the base unit.
  double number(std::size_t row, std::size_t column) const {
    const std::string& cell = csv_.rows[row][column];
    const auto value = text::parse_number(cell);
    if (!value)
      throw text::InputError({csv_.file, csv_.line[row]}, cell,
                             "not a number, for " + csv_.columns[column].name);
    const format::Unit unit = *format::find_unit(csv_.columns[column].unit);
    return *value * unit.factor + unit.offset;
  }
  Eigen::VectorXd numbers(std::size_t column) const {
    Eigen::VectorXd values(static_cast<Index>(csv_.rows.size()));
    for (std::size_t row = 0; row < csv_.rows.size(); ++row)
      values[static_cast<Index>(row)] = number(row, column);
    return values;
  }
  /// Value of a column in a dwell: the mean of its numbers as they are written, or its first word.
  std::string of(const Dwell& dwell, std::size_t column) const {
    double sum = 0;
    for (std::size_t row = dwell.first; row <= dwell.last; ++row) {
      const auto value = text::parse_number(csv_.rows[row][column]);
      if (!value) return csv_.rows[dwell.first][column];
      sum += *value;
    }
    // Nine decimals are below every axis: a mean of equal numbers leaves no tail of binary digits.
    return text::number_text(std::round(1e9 * sum / static_cast<double>(dwell.last - dwell.first + 1)) / 1e9);
  }

 private:
  format::CsvFile csv_;
};

Eigen::Matrix3Xd points_of(const ImportTable& tracker) {
  Eigen::Matrix3Xd points(3, static_cast<Index>(tracker.line.size()));
  Index k = 0;
  for (const char* name : format::columns::kPoint) {
    if (tracker.find(name) == nullptr)
      throw text::InputError({tracker.file, 0}, name,
                             "this column is not mapped: --log requires x, y and z of each point");
    const std::vector<double> values = tracker.numbers(name);
    points.row(k++) = Eigen::Map<const Eigen::RowVectorXd>(values.data(), points.cols());
  }
  return points;
}

/// Tool point of the nominal machine in each dwell.
Eigen::Matrix3Xd stands(const model::Machine& machine, const Eigen::MatrixXd& axes,
                        const std::vector<Dwell>& dwells) {
  model::States states = model::make_states(dwells.size(), machine);
  model::make_one_run(states, "log");
  for (std::size_t j = 0; j < dwells.size(); ++j)
    for (std::size_t a = 0; a < machine.axes.size(); ++a)
      states.axis[a][static_cast<Index>(j)] =
          axes.col(static_cast<Index>(a))
              .segment(static_cast<Index>(dwells[j].first),
                       static_cast<Index>(dwells[j].last - dwells[j].first + 1))
              .mean();
  return model::forward(model::nominal_machine(machine), states).position;
}

ImportTable paired_table(const ImportTable& tracker, const Log& log, const Pairing& pairing,
                         const std::vector<Dwell>& dwells) {
  ImportTable table{tracker.file, {}, {}};
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < pairing.dwell.size(); ++i)
    if (pairing.dwell[i]) kept.push_back(i), table.line.push_back(tracker.line[i]);
  for (std::size_t k = 0; k < log.csv().columns.size(); ++k) {
    const format::CsvColumn& column = log.csv().columns[k];
    if (column.name != format::columns::kTime && tracker.find(column.name) != nullptr)
      throw text::InputError({log.csv().file, log.csv().header_line}, column.name,
                             "both the log and the table of the tracker have this column");
    ImportTable::Column made{column.name, column.unit, {}};
    for (const std::size_t i : kept) made.cells.push_back(log.of(dwells[*pairing.dwell[i]], k));
    table.columns.push_back(std::move(made));
  }
  for (const auto& column : tracker.columns) {
    if (column.name == format::columns::kTime) continue;  // by the log's clock now
    ImportTable::Column made{column.name, column.unit, {}};
    for (const std::size_t i : kept) made.cells.push_back(column.cells[i]);
    table.columns.push_back(std::move(made));
  }
  return table;
}

}  // namespace

LoggedTable with_log(const ImportTable& tracker, const std::string& text, const std::string& log_file,
                     const model::Machine& machine, const LogOptions& options) {
  const Log log(text, log_file);
  const Eigen::VectorXd time = log.numbers(log.need(format::columns::kTime));
  for (Index row = 1; row < time.size(); ++row)
    if (time[row] < time[row - 1])
      throw text::InputError({log_file, log.csv().line[static_cast<std::size_t>(row)]},
                             format::columns::kTime,
                             "the time decreases in this row: the rows of a log must be in time order");
  Eigen::MatrixXd axes(time.size(), static_cast<Index>(machine.axes.size()));
  for (std::size_t a = 0; a < machine.axes.size(); ++a)
    axes.col(static_cast<Index>(a)) = log.numbers(log.need(machine.axes[a].name));
  LoggedTable result;
  PairingInput input;
  input.dwells =
      find_dwells(time, axes, Eigen::VectorXd::Constant(axes.cols(), options.still), options.dwell_s);
  if (input.dwells.empty())
    throw text::InputError({log_file, 0}, "",
                           "the log contains no dwell of this length: change --dwell or --still");
  input.stand = stands(machine, axes, input.dwells);
  input.point = points_of(tracker);
  input.distance_tolerance_mm = options.tolerance_mm;
  if (tracker.find(format::columns::kTime) != nullptr) {
    const std::vector<double> clock = tracker.numbers(format::columns::kTime);
    input.time = Eigen::Map<const Eigen::VectorXd>(clock.data(), static_cast<Index>(clock.size()));
  }
  result.pairing = pair_points(input);
  for (std::size_t i = 0; i < result.pairing.dwell.size(); ++i)
    if (!result.pairing.dwell[i]) result.unmatched_line.push_back(tracker.line[i]);
  if (result.unmatched_line.size() == tracker.line.size())
    throw text::InputError({tracker.file, 0}, "",
                           "no point agrees with a dwell of the log: check that machine and day are the "
                           "same, or give a larger --tolerance");
  result.dwells = input.dwells;
  result.table = paired_table(tracker, log, result.pairing, input.dwells);
  return result;
}

}  // namespace vernier::importer
