// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/vibration/feature_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>

#include "tools/format/columns.h"
#include "tools/format/units.h"
#include "tools/text/error.h"
#include "tools/text/numbers.h"

namespace vernier::vibration {
namespace {

std::optional<std::size_t> column_named(const format::CsvFile& file, const std::string& name) {
  for (std::size_t i = 0; i < file.columns.size(); ++i)
    if (file.columns[i].name == name) return i;
  return {};
}

std::vector<double> column_values(const format::CsvFile& file, std::size_t column) {
  std::vector<double> values;
  for (std::size_t row = 0; row < file.rows.size(); ++row) {
    const std::string& cell = file.rows[row][column];
    const auto value = text::parse_number(cell);
    if (!value) throw text::InputError({file.file, file.line[row]}, cell, "no number");
    values.push_back(*value);
  }
  return values;
}

/// Returns the rate of even times. Throws if they are not even.
double rate_of(const format::CsvFile& file, const std::vector<double>& t_s) {
  const auto n = static_cast<double>(t_s.size() - 1);
  const double step = (t_s.back() - t_s.front()) / n;
  for (std::size_t i = 0; i < t_s.size(); ++i)
    if (!(step > 0) || std::fabs(t_s[i] - t_s.front() - step * static_cast<double>(i)) > 0.01 * step)
      throw text::InputError({file.file, file.line[i]}, text::number_text(t_s[i]),
                             "the intervals between the times t differ by more than 1 % of a sample period");
  return 1 / step;
}

const Signal& signal_named(const VibrationRecord& record, const std::string& name) {
  for (const Signal& signal : record.signals)
    if (signal.name == name) return signal;
  throw text::InputError(fmt::format("\"{}\": the accelerometer record has no signal of this name", name));
}

std::string header_of(const Signal& signal, std::size_t feature) {
  std::string name = signal.name + "_" + kFeatureNames[feature];
  if (in_signal_unit(feature) && !signal.unit.empty()) name += "[" + signal.unit + "]";
  return name;
}

}  // namespace

std::vector<double> numeric_column(const format::CsvFile& file, const std::string& name) {
  const auto column = column_named(file, name);
  if (!column)
    throw text::InputError({file.file, file.header_line}, name, "the file has no column of this name");
  std::vector<double> values = column_values(file, *column);
  if (const auto unit = format::find_unit(file.columns[*column].unit))
    for (double& value : values) value = unit->factor * value + unit->offset;
  return values;
}

std::vector<double> measured_lengths_um(const format::CsvFile& file, const std::string& name) {
  const auto column = column_named(file, name);
  if (!column)
    throw text::InputError({file.file, file.header_line}, name, "the file has no column of this name");
  const auto unit = format::find_unit(file.columns[*column].unit);
  if (!unit || unit->dimension != format::Dimension::kLength)
    throw text::InputError({file.file, file.header_line}, name,
                           "this column is not a length (unit mm, um, m or in)");
  std::vector<double> lengths_um;
  for (std::size_t row = 0; row < file.rows.size(); ++row) {
    const std::string& cell = file.rows[row][*column];
    const auto value = text::parse_number(cell);
    if (!value && !cell.empty()) throw text::InputError({file.file, file.line[row]}, cell, "no number");
    lengths_um.push_back(value ? 1e3 * unit->factor * *value : std::numeric_limits<double>::quiet_NaN());
  }
  return lengths_um;
}

VibrationRecord read_vibration(const format::CsvFile& file, std::optional<double> rate_Hz,
                               const std::vector<std::string>& positions) {
  if (file.rows.size() < 2)
    throw text::InputError({file.file, 0}, file.file, "the accelerometer record has fewer than two samples");
  VibrationRecord record;
  record.samples = file.rows.size();
  if (column_named(file, format::columns::kTime)) {
    const std::vector<double> t_s = numeric_column(file, format::columns::kTime);
    record.start_s = t_s.front();
    record.rate_Hz = rate_of(file, t_s);
  } else if (rate_Hz) {
    record.rate_Hz = *rate_Hz;
  } else {
    throw text::InputError({file.file, file.header_line}, format::columns::kTime,
                           "the record has no column t; give the samples per second with --rate");
  }
  for (const std::string& name : positions)
    record.positions.push_back({name, "", numeric_column(file, name)});
  for (std::size_t i = 0; i < file.columns.size(); ++i) {
    const format::CsvColumn& column = file.columns[i];
    if (column.name == format::columns::kTime ||
        std::count(positions.begin(), positions.end(), column.name) != 0)
      continue;
    record.signals.push_back({column.name, column.unit, column_values(file, i)});
  }
  if (record.signals.empty()) throw text::InputError({file.file, file.header_line}, file.file, "no signal");
  return record;
}

void add_difference(VibrationRecord& record, const std::string& definition) {
  const auto equals = definition.find('='),
             minus = definition.find('-', equals == std::string::npos ? 0 : equals);
  if (equals == std::string::npos || minus == std::string::npos ||
      !text::is_name(definition.substr(0, equals)))
    throw text::InputError(fmt::format("\"{}\": not of the form NAME=A-B", definition));
  const Signal& a = signal_named(record, definition.substr(equals + 1, minus - equals - 1));
  const Signal& b = signal_named(record, definition.substr(minus + 1));
  if (a.unit != b.unit)
    throw text::InputError(
        fmt::format("\"{}\": the two signals have different units, {} and {}", definition, a.unit, b.unit));
  Signal difference{definition.substr(0, equals), a.unit, a.value};
  for (std::size_t i = 0; i < record.samples; ++i) difference.value[i] -= b.value[i];
  record.signals.push_back(std::move(difference));
}

FeatureColumns feature_columns(const VibrationRecord& record, const FeatureChoice& choice,
                               const std::vector<std::optional<std::size_t>>& ends) {
  FeatureColumns columns;
  columns.cells.resize(ends.size());
  Fourier fourier(choice.window);
  for (const Signal& signal : record.signals) {
    for (const std::size_t feature : choice.features) columns.header.push_back(header_of(signal, feature));
    std::vector<double> x = signal.value;
    const double mean = std::accumulate(x.begin(), x.end(), 0.0) / static_cast<double>(x.size());
    if (choice.centred)
      for (double& value : x) value -= mean;
    for (std::size_t row = 0; row < ends.size(); ++row) {
      const bool full = ends[row] && *ends[row] + 1 >= choice.window && *ends[row] < x.size();
      SignalFeatures values;
      values.fill(std::numeric_limits<double>::quiet_NaN());
      if (full && !choice.features.empty())
        values = signal_features(std::span(x).subspan(*ends[row] + 1 - choice.window, choice.window),
                                 record.rate_Hz, fourier);
      if (!full && &signal == &record.signals.front()) ++columns.empty_rows;
      for (const std::size_t feature : choice.features)
        columns.cells[row].push_back(std::isfinite(values[feature]) ? text::number_text(values[feature])
                                                                    : "");
    }
  }
  return columns;
}

Series acceleration_of(const std::vector<double>& t_s, const std::vector<double>& position) {
  Series series;
  for (std::size_t i = 1; i + 1 < t_s.size(); ++i) {
    const double before = t_s[i] - t_s[i - 1], after = t_s[i + 1] - t_s[i];
    const double fall = (position[i] - position[i - 1]) / before,
                 rise = (position[i + 1] - position[i]) / after;
    series.t_s.push_back(t_s[i]);
    series.value.push_back(2 * (rise - fall) / (before + after));
  }
  return series;
}

}  // namespace vernier::vibration
