// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulate/replay.h"

#include <cmath>

#include "tools/model/prediction.h"

namespace vernier {
namespace {

/// Rows of one run and where its ticks fall between them.
struct RunTicks {
  std::vector<std::size_t> rows;
  std::vector<std::size_t> before;  // per tick: position in `rows` of the row at or before it
  std::vector<double> fraction;     // per tick
};

RunTicks ticks_of_run(const Measurement& m, std::size_t run, double period_s) {
  RunTicks ticks;
  for (std::size_t row = 0; row < m.rows(); ++row)
    if (m.states.run[row] == run) ticks.rows.push_back(row);
  const auto time = [&](std::size_t i) { return m.states.time[static_cast<Eigen::Index>(ticks.rows[i])]; };
  for (std::size_t i = 1; i < ticks.rows.size(); ++i)
    if (time(i) <= time(i - 1)) {
      const std::size_t row = ticks.rows[i];
      throw InputError({m.files[m.file[row]], m.line[row]}, "t",
                       "replay needs a time that increases within each run");
    }
  std::size_t at = 0;
  const auto count =
      1 + static_cast<std::size_t>(std::floor((time(ticks.rows.size() - 1) - time(0)) / period_s + 1e-6));
  for (std::size_t k = 0; k < count; ++k) {
    const double t = time(0) + static_cast<double>(k) * period_s;
    while (at + 2 < ticks.rows.size() && time(at + 1) <= t + 1e-9) ++at;
    ticks.before.push_back(at);
    ticks.fraction.push_back(
        ticks.rows.size() < 2 ? 0 : std::min(1.0, (t - time(at)) / (time(at + 1) - time(at))));
  }
  return ticks;
}

Column between_rows(const Column& rows, const RunTicks& ticks, bool held) {
  Column result(static_cast<Eigen::Index>(ticks.before.size()));
  for (std::size_t k = 0; k < ticks.before.size(); ++k) {
    const double low = rows[static_cast<Eigen::Index>(ticks.rows[ticks.before[k]])];
    const std::size_t after = std::min(ticks.before[k] + 1, ticks.rows.size() - 1);
    const double high = rows[static_cast<Eigen::Index>(ticks.rows[after])];
    const double f = ticks.fraction[k];
    result[static_cast<Eigen::Index>(k)] = held ? (f < 1 - 1e-6 ? low : high) : low + f * (high - low);
  }
  return result;
}

States states_at_ticks(const States& rows, const RunTicks& ticks, std::size_t run) {
  States states;
  states.count = ticks.before.size();
  const auto all = [&](const std::vector<Column>& columns, bool held) {
    std::vector<Column> result;
    for (const Column& column : columns) result.push_back(between_rows(column, ticks, held));
    return result;
  };
  states.axis = all(rows.axis, false);
  states.velocity = all(rows.velocity, false);
  states.acceleration = all(rows.acceleration, false);
  states.direction = all(rows.direction, true);
  states.since = all(rows.since, true);
  states.input = all(rows.input, false);
  states.feed = between_rows(rows.feed, ticks, false);
  states.curvature = between_rows(rows.curvature, ticks, false);
  states.time = between_rows(rows.time, ticks, false);
  states.visit = between_rows(rows.visit, ticks, true);
  for (std::size_t k = 0; k < 3; ++k) states.normal[k] = between_rows(rows.normal[k], ticks, true);
  make_one_run(states, rows.run_names[run]);
  return states;
}

}  // namespace

ReplayResult replay(const LoadedImage& image, const Measurement& m, const LoopOptions& options) {
  if (!m.has_recorded("t")) throw InputError({m.files.front(), 0}, "t", "replay needs this column");
  const double period_s = 1e-6 * image.view.header().tick_us;
  Measurement corrected = m;
  ReplayResult result;
  for (std::size_t run = 0; run < m.states.run_names.size(); ++run) {
    const RunTicks ticks = ticks_of_run(m, run, period_s);
    const LoopResult loop =
        run_loop(image.view, image.machine, states_at_ticks(m.states, ticks, run), options);
    result.ticks += ticks.before.size();
    result.saturated += loop.saturated;
    result.slewing += loop.slewing;
    result.not_active += loop.not_active;
    for (const std::size_t row : ticks.rows) {
      const auto at = static_cast<Eigen::Index>(row);
      const double since_start =
          m.states.time[at] - m.states.time[static_cast<Eigen::Index>(ticks.rows.front())];
      const auto tick = std::min(static_cast<Eigen::Index>(std::lround(since_start / period_s)),
                                 static_cast<Eigen::Index>(ticks.before.size()) - 1);
      for (std::size_t axis = 0; axis < image.machine.axes.size(); ++axis)
        corrected.states.axis[axis][at] += loop.correction[axis][tick];
    }
  }
  Machine nominal = nominal_machine(image.machine);
  nominal.base_shifts = image.machine.base_shifts;
  const Eigen::VectorXd as_commanded = predict(nominal, m), as_moved = predict(nominal, corrected);
  result.before.resize(as_commanded.size());
  for (std::size_t i = 0; i < m.observations.size(); ++i)
    result.before[static_cast<Eigen::Index>(i)] =
        m.observations[i].value - as_commanded[static_cast<Eigen::Index>(i)];
  result.after = result.before + as_moved - as_commanded;
  return result;
}

}  // namespace vernier
