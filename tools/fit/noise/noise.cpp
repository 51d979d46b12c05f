// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fit/noise/noise.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include "tools/fit/noise/whitener.h"
#include "tools/format/readings.h"
#include "tools/text/words.h"

namespace vernier::fit {
namespace {

NoiseRatios ratios_of(const NoiseModel& model) {
  const double own = model.own * model.own;
  return {model.pose * model.pose / own,
          model.run * model.run / own,
          model.drift * model.drift / own,
          std::max(model.time_constant, 1e-300),
          model.in_time,
          model.drifts};
}

}  // namespace

double NoiseModel::shared() const { return std::sqrt(pose * pose + run * run + drift * drift); }

double NoiseModel::price() const {
  double parameters = (pose > 0 ? 1 : 0) + (run > 0 ? 1 : 0) + (drift > 0 ? 2 : 0);
  std::set<std::size_t> places;  // for a set-up the row is relevant
  for (const NoiseStep& step : steps)
    parameters += step.of_set_up() || !places.insert(step.row).second ? 1 : 1 + kPriceOfPlace;
  return parameters;
}

std::vector<std::string> drifting_kinds(const NoiseModel& model) {
  return model.drift > 0 ? format::names_of_kinds(model.drifts) : std::vector<std::string>();
}

double NoiseModel::total() const { return std::hypot(own, shared()); }

Eigen::MatrixXd step_columns(const NoiseLayout& layout, const std::vector<NoiseStep>& steps,
                             Eigen::Index readings) {
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(readings, static_cast<Eigen::Index>(steps.size()));
  for (std::size_t k = 0; k < steps.size(); ++k)
    for (const NoiseSeries& series : layout.series) {
      if (series.kind != steps[k].kind) continue;
      for (std::size_t i = 0; i < series.reading.size(); ++i)
        if (series.row[i] >= steps[k].row)
          columns(series.reading[i], static_cast<Eigen::Index>(k)) =
              steps[k].of_set_up() ? series.normal[i][steps[k].component] : 1;
    }
  return columns;
}

std::vector<NoiseStep> set_up_steps(const NoiseLayout& layout) {
  std::vector<NoiseStep> steps;
  for (const NoiseSeries& series : layout.series) {
    if (series.kind != static_cast<int>(model::ObservationKind::kD)) continue;
    for (std::size_t i = 0; i < series.reading.size(); ++i)
      if (i == 0 || series.setup[i] != series.setup[i - 1])
        for (int component = 0; component < 3; ++component)
          steps.push_back({series.kind, series.row[i], 0, 0, component});
  }
  constexpr std::size_t kOneSetUp =
      3;  // components of a single set-up, which cannot be distinguished from another one
  return steps.size() > kOneSetUp ? steps : std::vector<NoiseStep>();
}

double whiten(const NoiseLayout& layout, const NoiseModel& model, Eigen::MatrixXd& columns) {
  const double own = 2 * std::log(model.own) * static_cast<double>(columns.rows());
  if (model.independent()) {
    columns /= model.own;
    return own;
  }
  Eigen::MatrixXd readings = columns.transpose();
  const double log_det = whiten(layout, ratios_of(model), readings);
  columns = readings.transpose() / model.own;
  return own + log_det;
}

void whiten_transposed(const NoiseLayout& layout, const NoiseModel& model, Eigen::MatrixXd& columns) {
  columns /= model.own;
  if (model.independent()) return;
  Eigen::MatrixXd readings = columns.transpose();
  whiten_transposed(layout, ratios_of(model), readings);
  columns = readings.transpose();
}

Eigen::MatrixXd covariance_times(const NoiseLayout& layout, const NoiseModel& model,
                                 const Eigen::MatrixXd& columns) {
  const Eigen::MatrixXd x = columns.transpose();
  Eigen::MatrixXd y = model.own * model.own * x;
  for (const NoiseSeries& series : layout.series) {
    const std::size_t n = series.reading.size();
    // Sums over blocks of one set-up and one pose. Each sum is added to all its readings.
    const auto share = [&](double variance, const std::function<bool(std::size_t)>& begins) {
      if (variance <= 0) return;
      for (std::size_t first = 0; first < n;) {
        std::size_t last = first + 1;
        while (last < n && !begins(last)) ++last;
        Eigen::VectorXd sum = Eigen::VectorXd::Zero(x.rows());
        for (std::size_t i = first; i < last; ++i) sum += x.col(series.reading[i]);
        for (std::size_t i = first; i < last; ++i) y.col(series.reading[i]) += variance * sum;
        first = last;
      }
    };
    const auto new_setup = [&](std::size_t i) { return series.setup[i] != series.setup[i - 1]; };
    const auto new_clock = [&](std::size_t i) { return series.clock[i] != series.clock[i - 1]; };
    share(model.run * model.run, new_setup);
    share(model.pose * model.pose,
          [&](std::size_t i) { return new_setup(i) || series.pose[i] != series.pose[i - 1]; });
    if (model.drift <= 0 || !is_drifting(model.drifts, series.kind)) continue;
    // exp(-|t - t'| / tau): earlier readings, then later ones, each by one recursion.
    const auto rho = [&](std::size_t i) {
      return new_clock(i) ? 0 : std::exp(-passed(series, i, model.in_time) / model.time_constant);
    };
    const double variance = model.drift * model.drift;
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(x.rows());
    for (std::size_t i = 0; i < n; ++i) {
      if (i > 0) sum *= rho(i);
      sum += x.col(series.reading[i]);
      y.col(series.reading[i]) += variance * sum;
    }
    sum.setZero();
    for (std::size_t i = n; i-- > 0;) {
      y.col(series.reading[i]) += variance * sum;
      sum += x.col(series.reading[i]);
      if (i > 0) sum *= rho(i);
    }
  }
  return y.transpose();
}

std::string step_in_words(const NoiseStep& step, const NoiseUnit& unit) {
  const bool rotation = model::is_rotation(static_cast<model::ObservationKind>(step.kind));
  const double size = step.unit > 0 ? step.unit : unit.of(rotation);
  return fmt::format("{:.3g} +- {:.2g} {} in {}", step.height * size, step.std * size, unit_name(rotation),
                     format::name_of(static_cast<format::ReadingKind>(step.kind)));
}

std::string in_words(const NoiseModel& model, const NoiseUnit& unit) {
  const double size = unit.of_all();
  const char* const name = unit_name(unit.angles_only);
  std::string text = fmt::format("independent noise of each reading {:.3g} {}", model.own * size, name);
  if (model.pose > 0)
    text += fmt::format(", common error of the readings of a pose {:.3g} {}", model.pose * size, name);
  if (model.run > 0)
    text += fmt::format(", common error of the readings of a run {:.3g} {}", model.run * size, name);
  if (model.drift > 0)
    text += fmt::format(", a drift of {:.3g} {} that lasts {:.3g} {}", model.drift * size, name,
                        model.time_constant, model.in_time ? "s" : "rows");
  if (const std::vector<std::string> kinds = drifting_kinds(model); !kinds.empty())
    text += " in " + text::joined(kinds, ", ");
  double set_ups = 0, count = 0;
  for (const NoiseStep& step : model.steps) {
    if (!step.of_set_up()) continue;
    set_ups += step.height * step.height;
    count += 1.0 / 3;
  }
  if (count > 0)
    text += fmt::format(", the touched object shifts by {:.3g} um rms from set-up to set-up",
                        std::sqrt(set_ups / count) * unit.um);
  for (const NoiseStep& step : model.steps) {
    if (!step.of_set_up())
      text += fmt::format(", a step of {} from row {} on", step_in_words(step, unit), step.row + 1);
  }
  return text;
}

}  // namespace vernier::fit
