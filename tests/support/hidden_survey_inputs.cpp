// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/hidden_survey_inputs.h"

#include <cmath>
#include <numbers>

#include "tests/support/hidden_survey_motion.h"

namespace vernier::support {

using namespace vernier::model;
namespace {

/// Room, warm-up of every source and slow exchange, per run another weather.
std::vector<double> temperature(const std::vector<MotionRow>& rows, const std::vector<double>& weather,
                                double own, double lag_s, Draw& draw) {
  const double phase = draw.uniform(0, 6.28), swing = draw.uniform(0.3, 0.8),
               heat_tau = draw.uniform(900, 3600);
  std::vector<double> value;
  double state = 20 + weather.front(), heat = 0, last = rows.front().t;
  double source = own * draw.uniform(0.2, 1), until = last + draw.uniform(300, 1500);
  for (const MotionRow& row : rows) {
    const double room = 20 + weather[row.run] + swing * std::sin(2 * std::numbers::pi * row.t / 7200 + phase);
    const double dt = row.t - last;
    state += (room - state) * (1 - std::exp(-dt / lag_s));
    if (row.t > until) {
      source = own * draw.uniform(-0.3, 1.2);
      until = row.t + draw.uniform(300, 1500);
    }
    heat += (source - heat) * (1 - std::exp(-dt / heat_tau));
    last = row.t;
    value.push_back(to_step(state + heat, 0.01));
  }
  return value;
}

LoggedColumn blocks(const std::vector<MotionRow>& rows, const char* name, const char* unit,
                    LoggedColumn::Sort sort, const std::vector<double>& levels, Draw& draw) {
  LoggedColumn column{name, unit, sort, 0, {}};
  double now = draw.pick(levels);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (draw.chance(0.04)) now = draw.pick(levels);
    column.value.push_back(now);
  }
  return column;
}

}  // namespace

std::vector<LoggedColumn> log_inputs(const std::vector<MotionRow>& rows, const MotionOptions& options,
                                     Draw& draw) {
  using Sort = LoggedColumn::Sort;
  std::vector<LoggedColumn> columns;
  std::vector<double> weather;
  for (std::size_t r = 0; r < options.runs; ++r) weather.push_back(draw.uniform(-2.5, 2.5));
  const char* const names[] = {"T_room", "T_column", "T_scale", "T_spindle"};
  const double own[] = {0, 2, 1, 5}, lag_s[] = {30, 3600, 1200, 2400};
  const double slope = draw.sign() * draw.uniform(2, 5) / (rows.back().t - rows.front().t);
  for (std::size_t i = 0; i < 4; ++i) {
    LoggedColumn column{names[i], "degC", Sort::kTemperature, 20, {}};
    if (options.one_thermal) {
      const double gain = draw.uniform(0.7, 1.3), offset = draw.uniform(-0.5, 0.5);
      for (const MotionRow& row : rows)
        column.value.push_back(to_step(20 + offset + gain * slope * (row.t - rows.front().t), 1e-4));
    } else {
      column.value = temperature(rows, weather, own[i], lag_s[i], draw);
    }
    columns.push_back(std::move(column));
  }
  columns.push_back(blocks(rows, "payload", "kg", Sort::kLoad, {0, 2, 5, 10}, draw));
  columns.push_back(blocks(rows, "clamp", "N", Sort::kDecoy, {400, 500, 650}, draw));
  LoggedColumn shake{"acc_rms", "V", Sort::kVibration, 0, {}}, walk{"humidity", "V", Sort::kDecoy, 0, {}},
      still{"supply", "V", Sort::kDecoy, 0, {}};
  double level = 2.5;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    shake.value.push_back(to_step(0.05 * std::exp(0.8 * draw.normal()), 1e-5));
    walk.value.push_back(to_step(level += 0.01 * draw.normal(), 1e-4));
    still.value.push_back(24);
  }
  for (LoggedColumn* column : {&shake, &walk, &still}) columns.push_back(std::move(*column));
  return columns;
}

}  // namespace vernier::support
