// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/check/check_record.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "tools/effects/probe.h"
#include "tools/fit/fit.h"
#include "tools/fit/noise/noise.h"
#include "tools/fit/set_up.h"
#include "tools/fit/solve.h"
#include "tools/format/readings.h"
#include "tools/maths/orthonormal.h"
#include "tools/model/chain/prediction.h"
#include "tools/model/fit_record.h"
#include "tools/model/parameters.h"
#include "tools/text/error.h"

namespace vernier::check {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Smallest share of a column's square that is independent of the set-up and of the tested parameters before
/// it. Below it the column is the same parameter under another name.
constexpr double kOwn = 1e-3;
/// Share of a column's length, without the set-up, below which the column is rounding: no independent
/// direction and no degree of freedom.
constexpr double kRounding = 1e-7;
/// Effect of a change by 1 on the readings, of the largest effect of a parameter with the same unit. Below it
/// a change that the readings show is not plausible: 5 u of 2 um at a reach of 1 m need 6 deg.
constexpr double kLeastEffect = 1e-4;

/// Collects the columns of the tested parameters, weighted, with the set-up projected out.
class Collector {
 public:
  Collector(model::Machine machine, const model::Measurement& m) : machine_(std::move(machine)), m_(m) {
    const double fallback = std::max(machine_.fitted->rms_mm, 1e-9);
    weight_.resize(static_cast<Index>(m.observations.size()));
    for (std::size_t i = 0; i < m.observations.size(); ++i) {
      const double u = model::uncertainty_of(m, m.observations[i]);
      weight_[static_cast<Index>(i)] = 1 / (u > 0 ? u : fallback);
    }
    take_noise();
  }

  CheckRecord collect(std::string label) {
    record_.label = std::move(label);
    record_.readings = m_.observations.size();
    take_all();
    const Index count = static_cast<Index>(columns_.size());
    MatrixXd x(weight_.size(), count);
    for (Index j = 0; j < count; ++j) x.col(j) = columns_[static_cast<std::size_t>(j)];
    record_.gram = x.transpose() * x;
    record_.moment = x.transpose() * residual_;
    const MatrixXd basis = maths::orthonormal(x, 1e-6, nullptr);
    record_.square = residual_.squaredNorm();
    record_.rest = (residual_ - basis * (basis.transpose() * residual_)).squaredNorm();
    record_.beyond_set_up = static_cast<double>(weight_.size() - set_up_.cols());
    record_.freedom = static_cast<double>(weight_.size() - set_up_.cols() - basis.cols());
    return std::move(record_);
  }

  QuantityColumns raw() {
    take_all();
    QuantityColumns result{record_.quantities, record_.parameters, {}, raw_set_up_};
    result.columns.resize(weight_.size(), static_cast<Index>(raw_.size()));
    for (std::size_t j = 0; j < raw_.size(); ++j) result.columns.col(static_cast<Index>(j)) = raw_[j];
    return result;
  }

 private:
  /// The noise of the survey, if it exceeded the stated noise of each reading; empty if one has u and the
  /// other has not.
  void take_noise() {
    const auto& kept = machine_.fitted->noise;
    if (!kept) return;
    std::vector<std::size_t> all(m_.observations.size());
    std::iota(all.begin(), all.end(), 0);
    const bool of_u = std::all_of(all.begin(), all.end(), [&](std::size_t i) {
      return model::uncertainty_of(m_, m_.observations[i]) > 0;
    });
    if (of_u != kept->of_u) return;
    // In mm it is the residual of the fit that readings without u are weighed by.
    const double unit = kept->of_u ? 1 : 1 / std::max(machine_.fitted->rms_mm, 1e-9);
    layout_ = fit::noise_layout(m_, all);
    noise_.own = unit * kept->own, noise_.pose = unit * kept->pose, noise_.run = unit * kept->run;
    noise_.drift = unit * kept->drift;
    noise_.drifts = kept->drifts;
    noise_.in_time = layout_.in_time;
    // If only one of both has a clock, its steps are used for the rows of the other.
    noise_.time_constant = kept->time_constant;
    if (kept->in_time && !layout_.in_time) noise_.time_constant /= std::max(kept->step, 1e-9);
    if (!kept->in_time && layout_.in_time) noise_.time_constant *= layout_.step;
  }

  /// Over its uncertainty, as if readings were independent.
  VectorXd weighed(const VectorXd& column) const {
    MatrixXd own = weight_.cwiseProduct(column);
    if (!layout_.series.empty()) fit::whiten(layout_, noise_, own);
    return own;
  }

  void take_all() {
    take_parameters();
    take_places();
    take_drifts();
  }

  VectorXd beside_set_up(const VectorXd& column) const {
    VectorXd own = weighed(column);
    const double full = own.norm();
    if (set_up_.cols() > 0) own -= set_up_ * (set_up_.transpose() * own);
    if (own.norm() <= kRounding * full) own.setZero();
    return own;
  }

  void take_parameters() {
    const model::ParameterSet parameters(machine_, m_.states.names(m_.states.setup));
    const model::Linearisation linear = model::linearise(machine_, m_, parameters);
    const MatrixXd jacobian(linear.jacobian);
    std::vector<Index> shifts, others;
    for (std::size_t i = 0; i < parameters.size(); ++i)
      (model::is_set_up(parameters[i].kind) ? shifts : others).push_back(static_cast<Index>(i));
    raw_set_up_ = weight_.asDiagonal() * jacobian(Eigen::all, shifts);
    MatrixXd whitened = raw_set_up_;
    if (!layout_.series.empty()) fit::whiten(layout_, noise_, whitened);
    set_up_ = maths::orthonormal(whitened, 1e-9, nullptr);
    VectorXd left(weight_.size());
    for (std::size_t i = 0; i < m_.observations.size(); ++i)
      left[static_cast<Index>(i)] = m_.observations[i].value - linear.predicted[static_cast<Index>(i)];
    residual_ = beside_set_up(left);
    std::map<std::string, double> largest;  // effect of the parameters of each unit of lengths and angles
    for (const Index i : others)
      if (const std::string& unit = parameters[static_cast<std::size_t>(i)].unit;
          unit == "mm" || unit == "deg" || unit == "rad")
        largest[unit] = std::max(largest[unit], jacobian.col(i).norm());
    for (const Index i : others) {
      const model::Parameter& p = parameters[static_cast<std::size_t>(i)];
      const auto most = largest.find(p.unit);
      const bool has_effect = most == largest.end() || jacobian.col(i).norm() > kLeastEffect * most->second;
      columns_.push_back(has_effect ? beside_set_up(jacobian.col(i)) : VectorXd::Zero(weight_.size()));
      raw_.push_back(weight_.cwiseProduct(VectorXd(jacobian.col(i))));
      record_.quantities.push_back({p.name, p.unit, false});
    }
    record_.parameters = columns_.size();
    for (const VectorXd& column : columns_)
      if (column.norm() > 0) known_.push_back(column.normalized());
  }

  void offer(CheckedQuantity quantity, const VectorXd& raw) {
    const VectorXd column = beside_set_up(raw);
    const double full = weighed(raw).norm();
    if (!(column.norm() > kOwn * full) || full <= 0) return;
    const VectorXd unit = column.normalized();
    for (const VectorXd& other : known_)
      if (1 - std::abs(unit.dot(other)) < kOwn) return;
    known_.push_back(unit);
    columns_.push_back(column);
    raw_.push_back(weight_.cwiseProduct(raw));
    record_.quantities.push_back(std::move(quantity));
  }

  void take_places() {
    const std::vector<effects::DofPlace> places = effects::all_places(machine_);
    model::Machine probed = machine_;
    for (model::Freedom& one : model::freedoms_of(probed)) one.set_free(false);
    for (const effects::DofPlace& place : places) effects::add_probe(probed, place);
    const MatrixXd response(model::linearise(probed, m_, model::ParameterSet(probed, {})).jacobian);
    const auto of = [&](const effects::DofPlace& place) {
      return static_cast<Index>(std::find(places.begin(), places.end(), place) - places.begin());
    };
    const auto times = [&](Index place, const model::Column& factor) {
      VectorXd column = response.col(place);
      for (std::size_t i = 0; i < m_.observations.size(); ++i)
        column[static_cast<Index>(i)] *= factor[static_cast<Index>(m_.observations[i].row)];
      return column;
    };
    const effects::AxisPlaces axes(machine_);
    for (std::size_t axis = 0; axis < machine_.axes.size(); ++axis) {
      if (!axes.own(axis)) continue;
      const std::string &name = machine_.axes[axis].name, unit = machine_.axes[axis].rotary ? "deg" : "mm";
      offer({"reversal of " + name, unit, false}, times(of(*axes.own(axis)), m_.states.direction[axis]));
      if (!machine_.axes[axis].rotary)
        offer({"scale of " + name, "", false}, times(of(*axes.own(axis)), m_.states.axis[axis]));
    }
    for (std::size_t i = 0; i < places.size(); ++i) {
      const bool angle = effects::is_angle(machine_, places[i]);
      offer({fmt::format("{} {} of transform {}{}", angle ? "tilt" : "offset",
                         effects::dof_name(machine_, places[i]), effects::transform_at(machine_, places[i]).n,
                         places[i].workpiece ? " (workpiece)" : ""),
             angle ? "deg" : "mm", false},
            response.col(static_cast<Index>(i)));
    }
  }

  /// The instrument, or its support, moves steadily from the first row to the last.
  void take_drifts() {
    std::map<model::ObservationKind, VectorXd> of_kind;
    const double last = std::max<double>(1, static_cast<double>(m_.rows()) - 1);
    for (std::size_t i = 0; i < m_.observations.size(); ++i) {
      VectorXd& column = of_kind[m_.observations[i].kind];
      if (column.size() == 0) column = VectorXd::Zero(weight_.size());
      column[static_cast<Index>(i)] = static_cast<double>(m_.observations[i].row) / last;
    }
    for (const auto& [kind, column] : of_kind)
      offer({fmt::format("drift of the instrument in {}", format::name_of(kind)),
             model::is_rotation(kind) ? "deg" : "mm", true},
            column);
  }

  model::Machine machine_;
  const model::Measurement& m_;
  VectorXd weight_, residual_;
  fit::NoiseLayout layout_;  // no series: readings are independent
  fit::NoiseModel noise_;
  MatrixXd set_up_, raw_set_up_;
  std::vector<VectorXd> columns_, known_, raw_;
  CheckRecord record_;
};

void require_fit(const model::Machine& machine) {
  if (!machine.fitted)
    throw text::InputError(
        {machine.file, 0}, machine.name,
        "was never fitted (no <fitted>): a check needs the uncertainty of a fit; run vernier fit first");
}

}  // namespace

QuantityColumns quantity_columns(const model::Machine& machine, const model::Measurement& measurement) {
  require_fit(machine);
  return Collector(machine, measurement).raw();
}

MatrixXd spread_of_fit(const model::Machine& machine, const std::vector<CheckedQuantity>& quantities,
                       std::size_t parameters) {
  const model::FitRecord& fitted = *machine.fitted;
  MatrixXd spread = MatrixXd::Zero(static_cast<Index>(parameters), fitted.factor.cols());
  for (std::size_t i = 0; i < parameters; ++i) {
    const auto found = std::find(fitted.parameters.begin(), fitted.parameters.end(), quantities[i].name);
    if (found != fitted.parameters.end())
      spread.row(static_cast<Index>(i)) = fitted.factor.row(found - fitted.parameters.begin());
  }
  return spread;
}

bool is_unmeasured(const model::Machine& machine, const CheckedQuantity& quantity) {
  const model::FitRecord& fitted = *machine.fitted;
  const auto found = std::find(fitted.parameters.begin(), fitted.parameters.end(), quantity.name);
  const auto at = static_cast<std::size_t>(found - fitted.parameters.begin());
  return at < fitted.origins.size() && fitted.origins[at] == fit::origin_name(fit::Origin::kPrior);
}

CheckRecord record_of(const model::Machine& machine, const model::Measurement& measurement,
                      std::string label) {
  require_fit(machine);
  return Collector(fit::set_up_anywhere(machine, measurement), measurement).collect(std::move(label));
}

}  // namespace vernier::check
