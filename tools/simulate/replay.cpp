// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulate/replay.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "tools/format/columns.h"
#include "tools/model/chain/prediction.h"
#include "tools/simulate/counts.h"

namespace vernier::simulate {
namespace {

/// Rows of one run, and the ticks between them: values linear, directions held. A tick is computed
/// when it is needed, because a record of hours has ten million.
class BetweenRows : public TickPath {
 public:
  BetweenRows(const model::Machine& machine, const model::Measurement& m, std::vector<std::size_t> rows,
              double period_s)
      : machine_(machine), m_(m), period_s_(period_s), rows_(std::move(rows)) {
    for (std::size_t i = 1; i < rows_.size(); ++i)
      if (time_at(i) <= time_at(i - 1))
        throw text::InputError({m.files[m.file[rows_[i]]], m.line[rows_[i]]}, format::columns::kTime,
                               "replay requires times that increase within each run");
    count_ =
        1 + static_cast<std::size_t>(std::floor((time_at(rows_.size() - 1) - time_at(0)) / period_s + 1e-6));
    for (std::size_t i = 0; i < rows_.size(); ++i)
      tick_of_row_.push_back(
          std::min(count_ - 1, static_cast<std::size_t>(std::lround((time_at(i) - time_at(0)) / period_s))));
    one_ = model::select_states(m.states, {rows_.front()});
  }

  /// Index of a row's correction among the stored ones.
  std::vector<Eigen::Index> kept_of_rows() const {
    std::vector<Eigen::Index> kept;
    Eigen::Index next = -1;
    for (std::size_t i = 0; i < tick_of_row_.size(); ++i) {
      if (i == 0 || tick_of_row_[i] != tick_of_row_[i - 1]) ++next;
      kept.push_back(next);
    }
    return kept;
  }

  std::size_t count() const noexcept override { return count_; }
  bool kept(std::size_t tick) const noexcept override {
    return std::binary_search(tick_of_row_.begin(), tick_of_row_.end(), tick);
  }
  TimeUs time(std::size_t tick) const noexcept override {
    place(tick);
    return TimeUs(counts(1e6 * between(m_.states.time)));
  }
  void at(std::size_t tick, PlantState& state) const noexcept override {
    place(tick);
    const model::States& rows = m_.states;
    for (std::size_t i = 0; i < rows.axis.size(); ++i) {
      one_.axis[i][0] = between(rows.axis[i]);
      one_.velocity[i][0] = between(rows.velocity[i]);
      one_.acceleration[i][0] = between(rows.acceleration[i]);
      one_.direction[i][0] = held(rows.direction[i]);
      one_.since[i][0] = held(rows.since[i]);
    }
    for (std::size_t i = 0; i < rows.input.size(); ++i) one_.input[i][0] = between(rows.input[i]);
    one_.feed[0] = between(rows.feed);
    one_.curvature[0] = between(rows.curvature);
    one_.visit[0] = held(rows.visit);
    tell_state(machine_, one_, 0, state);
  }

 private:
  double time_at(std::size_t i) const { return m_.states.time[static_cast<Eigen::Index>(rows_[i])]; }

  /// Finds the rows before and after a tick. Ticks are requested in order, or again from the
  /// start.
  void place(std::size_t tick) const noexcept {
    const double t = time_at(0) + static_cast<double>(tick) * period_s_;
    if (tick < tick_) before_ = 0;
    tick_ = tick;
    while (before_ + 2 < rows_.size() && time_at(before_ + 1) <= t + 1e-9) ++before_;
    fraction_ = rows_.size() < 2
                    ? 0
                    : std::min(1.0, (t - time_at(before_)) / (time_at(before_ + 1) - time_at(before_)));
  }
  double value(const model::Column& rows, std::size_t i) const noexcept {
    return rows[static_cast<Eigen::Index>(rows_[std::min(i, rows_.size() - 1)])];
  }
  double between(const model::Column& rows) const noexcept {
    const double low = value(rows, before_);
    return low + fraction_ * (value(rows, before_ + 1) - low);
  }
  double held(const model::Column& rows) const noexcept {
    return value(rows, fraction_ < 1 - 1e-6 ? before_ : before_ + 1);
  }

  const model::Machine& machine_;
  const model::Measurement& m_;
  double period_s_;
  std::vector<std::size_t> rows_, tick_of_row_;
  std::size_t count_ = 0;
  mutable std::size_t tick_ = 0, before_ = 0;
  mutable double fraction_ = 0;
  mutable model::States one_;
};

bool needs_time(const ImageView& image) {
  const Program program = image.program();
  return program.equation.lag_count > 0 ||
         std::any_of(program.channels.begin(), program.channels.end(),
                     [](const Channel& channel) { return channel.kind == ChannelKind::kTime; });
}

void add_loop(const LoopResult& loop, std::size_t ticks, ReplayResult& result) {
  result.ticks += ticks;
  result.saturated += loop.saturated;
  result.slewing += loop.slewing;
  result.not_active += loop.not_active;
}

/// The rows of each run. A file without times beside files with times has runs of its own (its clock).
std::vector<std::vector<std::size_t>> rows_of_runs(const model::Measurement& m) {
  std::map<std::pair<std::size_t, std::size_t>, std::vector<std::size_t>> runs;
  for (std::size_t row = 0; row < m.rows(); ++row)
    runs[{m.states.run[row], m.states.of(m.states.clock, row)}].push_back(row);
  std::vector<std::vector<std::size_t>> list;
  for (auto& [labels, rows] : runs) list.push_back(std::move(rows));
  return list;
}

/// False for rows without times: poses at rest.
bool has_times(const model::Measurement& m, const std::vector<std::size_t>& rows) {
  const auto time_of = [&](std::size_t row) { return m.states.time[static_cast<Eigen::Index>(row)]; };
  return m.has_recorded(format::columns::kTime) &&
         (rows.size() < 2 || std::any_of(rows.begin(), rows.end(), [&](std::size_t row) {
            return time_of(row) != time_of(rows.front());
          }));
}

}  // namespace

ReplayResult replay(const compile::LoadedImage& image, const model::Measurement& m,
                    const LoopOptions& options) {
  const double period_s = 1e-6 * image.view.header().tick_us;
  model::Measurement corrected = m;
  ReplayResult result;
  const auto move = [&](std::size_t row, const LoopResult& loop, Eigen::Index tick) {
    for (std::size_t axis = 0; axis < image.machine.axes.size(); ++axis)
      corrected.states.axis[axis][static_cast<Eigen::Index>(row)] += loop.correction[axis][tick];
  };
  for (const std::vector<std::size_t>& rows : rows_of_runs(m)) {
    if (has_times(m, rows)) {
      const BetweenRows path(image.machine, m, rows, period_s);
      const LoopResult loop = run_loop(image.view, image.machine, path, options);
      add_loop(loop, path.count(), result);
      const std::vector<Eigen::Index> kept = path.kept_of_rows();
      for (std::size_t i = 0; i < kept.size(); ++i) move(rows[i], loop, kept[i]);
      continue;
    }
    if (needs_time(image.view))
      throw text::InputError({m.files[m.file[rows.front()]], 0}, format::columns::kTime,
                             "replay needs this column: a term of the machine depends on time");
    for (const std::size_t row : rows) {
      const LoopResult loop =
          run_loop(image.view, image.machine, model::select_states(m.states, {row}), options);
      add_loop(loop, 1, result);
      move(row, loop, 0);
    }
  }
  model::Machine nominal = model::nominal_machine(image.machine);
  nominal.base_shifts = image.machine.base_shifts;
  nominal.tool_shifts = image.machine.tool_shifts;
  const Eigen::VectorXd as_commanded = model::predict(nominal, m),
                        as_moved = model::predict(nominal, corrected);
  result.before.resize(as_commanded.size());
  for (std::size_t i = 0; i < m.observations.size(); ++i)
    result.before[static_cast<Eigen::Index>(i)] =
        m.observations[i].value - as_commanded[static_cast<Eigen::Index>(i)];
  result.after = result.before + as_moved - as_commanded;
  return result;
}

}  // namespace vernier::simulate
