// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/workbench/files/rows.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "tools/effects/add_string.h"
#include "tools/effects/fitted_effect.h"
#include "tools/effects/survey/complete_survey.h"
#include "tools/fit/files/file_noise.h"
#include "tools/fit/fit.h"
#include "tools/fit/least_squares/statistics.h"
#include "tools/fit/set_up.h"
#include "tools/format/readings.h"
#include "tools/maths/factors.h"
#include "tools/model/chain/chain.h"
#include "tools/model/fit_record.h"
#include "tools/model/machine_writer.h"
#include "tools/results/detail.h"
#include "tools/results/results.h"
#include "tools/simulate/corrected.h"
#include "tools/text/files.h"
#include "tools/text/optional_json.h"
#include "tools/workbench/files/blob.h"
#include "tools/workbench/files/values.h"

namespace vernier::workbench {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr std::size_t kKeptRows = 6;

std::vector<float> in_report_units(const model::Measurement& m, const Eigen::VectorXd& residual) {
  std::vector<float> values(m.observations.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = static_cast<float>(
        residual[static_cast<Eigen::Index>(i)] *
        (model::is_rotation(m.observations[i].kind) ? maths::kUradPerDeg : maths::kUmPerMm));
  return values;
}

void add_figures(Json& json, const model::Measurement& m, const Eigen::VectorXd& residual) {
  const fit::RoleStatistics fit = fit::role_statistics(m, residual, false),
                            check = fit::role_statistics(m, residual, true);
  json["rms_um"] = text::or_null(fit.rms_um);
  json["max_um"] = text::or_null(fit.max_um);
  json["check_rms_um"] = text::or_null(check.rms_um);
  json["check_max_um"] = text::or_null(check.max_um);
  json["rms_urad"] = text::or_null(fit.rms_urad);
  json["check_rms_urad"] = text::or_null(check.rms_urad);
}

Json vectors(Blob& blob, const Eigen::Matrix3Xd& list) {
  Json json = Json::array();
  for (Eigen::Index k = 0; k < 3; ++k) json.push_back(blob.f32(Eigen::ArrayXd(list.row(k).transpose())));
  return json;
}

/// Unit vectors along which a row's length, distance or d is measured; 0 for rows without.
Eigen::Matrix3Xd directions(const model::Measurement& m, const Eigen::Matrix3Xd& point) {
  Eigen::Matrix3Xd list = Eigen::Matrix3Xd::Zero(3, point.cols());
  for (const model::Observation& o : m.observations) {
    const auto row = static_cast<Eigen::Index>(o.row);
    if (o.kind == model::ObservationKind::kLength)
      list.col(row) = (point.col(row) - m.centre.col(row)).stableNormalized();
    if (o.kind == model::ObservationKind::kDistance)
      list.col(row) =
          (point.col(row) - point.col(static_cast<Eigen::Index>(m.other_end[o.row]))).stableNormalized();
    if (o.kind == model::ObservationKind::kD)
      for (std::size_t k = 0; k < 3; ++k) list(static_cast<Eigen::Index>(k), row) = m.states.normal[k][row];
  }
  return list;
}

/// Standard uncertainty of each observation, mm or deg; 0 if the file gives none.
Eigen::VectorXd standard_uncertainties(const model::Measurement& m) {
  Eigen::VectorXd u = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(m.observations.size()));
  for (std::size_t i = 0; i < m.observations.size(); ++i)
    u[static_cast<Eigen::Index>(i)] = model::uncertainty_of(m, m.observations[i]);
  return u;
}

/// Result of the fit that wrote the file for a parameter, if its value is still that of the fit.
void add_knowledge(Json& json, const model::FitRecord& record, const std::string& name, double value) {
  const auto found = std::find(record.parameters.begin(), record.parameters.end(), name);
  if (found == record.parameters.end()) return;
  const auto row = static_cast<Eigen::Index>(found - record.parameters.begin());
  constexpr double kSame = 1e-9;  // share of the value: rounding by the file's digits
  if (std::abs(record.values[row] - value) > kSame * std::max(1e-9, std::abs(value))) return;
  json["std"] = record.factor.row(row).norm();
  if (static_cast<std::size_t>(row) < record.origins.size())
    json["from"] = record.origins[static_cast<std::size_t>(row)];
}

Json observations_json(Blob& blob, const model::Measurement& m, const Eigen::VectorXd& residual) {
  std::vector<std::uint8_t> kind;
  std::vector<std::uint32_t> row;
  for (const model::Observation& o : m.observations) {
    kind.push_back(static_cast<std::uint8_t>(o.kind));
    row.push_back(static_cast<std::uint32_t>(o.row));
  }
  Json kinds = Json::array(), rotations = Json::array();
  for (const format::ReadingKindEntry& entry : format::kReadingKinds) {
    kinds.push_back(entry.name);
    if (format::is_rotation(entry.kind)) rotations.push_back(entry.name);
  }
  return {{"kinds", kinds},
          {"rotations", rotations},
          {"kind", blob.u8(kind)},
          {"row", blob.u32(row)},
          {"u", blob.f32(in_report_units(m, standard_uncertainties(m)))},
          {"residual", blob.f32(in_report_units(m, residual))}};
}

std::vector<std::uint32_t> narrow(const std::vector<std::size_t>& values) {
  std::vector<std::uint32_t> list;
  for (const std::size_t value : values) list.push_back(static_cast<std::uint32_t>(value));
  return list;
}

}  // namespace

std::string RowCache::key_of(const std::string& machine, const std::vector<std::string>& measurements) const {
  std::string key;
  std::vector<std::string> names = {machine};
  names.insert(names.end(), measurements.begin(), measurements.end());
  for (const std::string& name : names) {
    const fs::path path = project_.existing(name);
    key += name + "\n" + std::to_string(fs::file_size(path)) + " " +
           std::to_string(fs::last_write_time(path).time_since_epoch().count()) + "\n";
  }
  return key;
}

std::shared_ptr<const LoadedRows> RowCache::get(const std::string& machine,
                                                const std::vector<std::string>& measurements, bool datum) {
  if (measurements.empty()) throw text::InputError("no measurement is named");
  const std::string key = (datum ? "datum\n" : "") + key_of(machine, measurements);
  {
    const std::scoped_lock lock(guard_);
    for (const Entry& entry : kept_)
      if (entry.key == key) return entry.rows;
  }
  auto rows = std::make_shared<LoadedRows>();
  std::vector<std::string> paths;
  for (const std::string& name : measurements) paths.push_back(project_.existing(name).string());
  effects::CompletedSurvey survey =
      effects::complete_survey(text::read_file(project_.existing(machine).string()), machine, paths,
                               simulate::corrections_of_images(project_.root().string()));
  rows->text = std::move(survey.text);
  rows->machine = std::move(survey.machine);
  rows->measurement = std::move(survey.rows);
  rows->datum = datum;
  if (datum) rows->machine = fit::set_up(rows->machine, rows->measurement);
  rows->measurement.files = measurements;
  for (const fit::FileNoise& noise :
       fit::file_noise_of_residual(rows->measurement, fit::residuals(rows->machine, rows->measurement)))
    rows->notes.push_back(noise.sentence());
  const std::scoped_lock lock(guard_);
  if (kept_.size() >= kKeptRows) kept_.erase(kept_.begin());
  kept_.push_back({key, rows});
  return rows;
}

std::string rows_blob(const LoadedRows& rows) {
  const model::Machine& machine = rows.machine;
  const model::Measurement& m = rows.measurement;
  const Eigen::VectorXd residual = fit::residuals(machine, m);
  const Eigen::Matrix3Xd point = model::forward(machine, m.states).position;
  Blob blob;
  Json json = {
      {"machine", machine.name}, {"files", m.files}, {"n_rows", m.rows()}, {"n_excluded", m.excluded}};
  add_figures(json, m, residual);
  json["noise_um"] = text::or_null(fit::noise_um(m));
  json["notes"] = rows.notes;
  json["corrected"] =
      std::any_of(m.corrected.begin(), m.corrected.end(), [](const auto& one) { return !one.empty(); });
  json["columns"] = Json::array();
  results::each_column(
      machine, m,
      [&](const std::string& name, const std::string& unit, const char* kind, const model::Column& data) {
        json["columns"].push_back({{"name", name}, {"unit", unit}, {"kind", kind}, {"data", blob.f32(data)}});
      });
  json["runs"] = m.states.run_names;
  json["row_run"] = blob.u32(narrow(m.states.run));
  json["row_check"] = blob.u8({m.check.begin(), m.check.end()});
  json["row_file"] = blob.u32(narrow(m.file));
  json["row_line"] = blob.u32(narrow(m.line));
  json["point"] = vectors(blob, point);
  json["direction"] = vectors(blob, directions(m, point));
  json["observations"] = observations_json(blob, m, residual);
  json["circular"] = results::circular_detail(machine, m, residual, true);
  return blob.bytes(json);
}

std::string prediction_blob(const LoadedRows& rows, const std::map<std::string, double>& values) {
  model::Machine machine = rows.machine;
  set_values(machine, values);
  const Eigen::VectorXd residual = fit::residuals(machine, rows.measurement);
  Blob blob;
  Json json;
  add_figures(json, rows.measurement, residual);
  json["residual"] = blob.f32(in_report_units(rows.measurement, residual));
  return blob.bytes(json);
}

std::string explanation_blob(const LoadedRows& rows, const std::string& add) {
  const model::Measurement& m = rows.measurement;
  const fit::FitResult base = fit::fit(rows.machine, m);
  const effects::MachineText fitted =
      effects::machine_text(effects::fitted_text(rows.text, base).text, rows.machine.file);
  effects::EffectToFit effect;
  effect.choice = effects::parse_add_string(add, fitted.machine, effects::built_in_effects());
  const effects::FittedEffects with = effects::fit_with_effects(fitted, m, {effect});
  if (with.rows.observations.size() != m.observations.size())
    throw text::InputError(
        "this effect excludes rows with an empty input, so the page cannot show the effect for all rows");
  Blob blob;
  Json json = {{"label", with.effects[0].spoken}};
  add_figures(json, with.rows, with.fit.residual);
  json["explained"] = blob.f32(in_report_units(m, base.residual - with.fit.residual));
  json["before"] = blob.f32(in_report_units(m, base.residual));
  return blob.bytes(json);
}

nlohmann::ordered_json parameters_json(const LoadedRows& rows) {
  const model::ParameterSet parameters(rows.machine,
                                       rows.measurement.states.names(rows.measurement.states.setup));
  const Eigen::VectorXd values = parameters.get(rows.machine);
  Json list = Json::array();
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const double value = values[static_cast<Eigen::Index>(i)];
    const model::Parameter& one = parameters[i];
    Json json = {{"name", one.name},   {"value", value}, {"unit", one.unit},
                 {"nominal", nullptr}, {"std", nullptr}, {"from", nullptr}};
    if (one.kind == model::ParameterKind::kStatic)
      if (const auto& nominal = rows.machine.statics[one.item].nominal) json["nominal"] = *nominal;
    if (const auto& record = rows.machine.fitted) add_knowledge(json, *record, one.name, value);
    list.push_back(json);
  }
  return list;
}

}  // namespace vernier::workbench
