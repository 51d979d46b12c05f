// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::results {

/// Adds the member "detail" to a result. The member "detail" contains all data that the report draws: rows,
/// columns, observations, circles, worst rows. `result`: the JSON object that receives the member "detail".
void add_detail(nlohmann::ordered_json& result, const model::Machine& machine,
                const model::Measurement& measurement, const Eigen::VectorXd& residual);

/// Calls visit(name, unit, kind, values) for each quantity that was set or recorded in the rows: axes,
/// motion, time, visit, inputs, candidate inputs. The argument `kind` is axis, direction, motion, time,
/// visit, input or candidate.
using VisitColumn =
    std::function<void(const std::string&, const std::string&, const char*, const model::Column&)>;
void each_column(const model::Machine& machine, const model::Measurement& measurement,
                 const VisitColumn& visit);

/// Returns the circular tests among the rows with their curves: the numbers of circular_json and, for each
/// run, angle_deg, measured_um, model_um and check of every sample, and its row if requested.
nlohmann::ordered_json circular_detail(const model::Machine& machine, const model::Measurement& measurement,
                                       const Eigen::VectorXd& residual, bool with_rows = false);

/// Returns the ISO 230-4 numbers of every circular test among the rows (a list, empty without such tests).
nlohmann::ordered_json circular_json(const model::Machine& machine, const model::Measurement& measurement);

/// Returns diagrams of the residuals of two models over the columns of the strongest findings
/// (findings_json): [{observation, unit (um or urad), column, column_unit, x[], before[], after[], check[]}].
/// The function returns at most three diagrams of 4000 readings. If there are no findings about the
/// residual, the diagrams show the residuals over the row number. `before`, `after`: residuals of the two
/// models, one value per observation, mm or deg.
nlohmann::ordered_json before_after_pictures(const nlohmann::ordered_json& findings,
                                             const model::Machine& machine,
                                             const model::Measurement& measurement,
                                             const Eigen::VectorXd& before, const Eigen::VectorXd& after);

}  // namespace vernier::results
