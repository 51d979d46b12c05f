#include "tools/cli/results.h"

#include <fmt/format.h>

namespace vernier {
namespace {

using nlohmann::ordered_json;

ordered_json or_null(const std::optional<double>& value) {
  return value ? ordered_json(*value) : ordered_json(nullptr);
}

std::size_t observations_of_fit_rows(const Measurement& m) {
  std::size_t count = 0;
  for (const Observation& o : m.observations) count += m.check[o.row] == 0 ? 1U : 0U;
  return count;
}

ordered_json shared(const Machine& machine, const Measurement& m, const RoleStatistics& before,
                    const RoleStatistics& fit, const RoleStatistics& check, std::size_t parameters) {
  return {{"machine", machine.name},
          {"machine_file", machine.file},
          {"files", m.files},
          {"rms_before_um", or_null(before.rms_um)},
          {"rms_um", or_null(fit.rms_um)},
          {"check_rms_um", or_null(check.rms_um)},
          {"max_um", or_null(fit.max_um)},
          {"check_max_um", or_null(check.max_um)},
          {"rms_before_urad", or_null(before.rms_urad)},
          {"rms_urad", or_null(fit.rms_urad)},
          {"check_rms_urad", or_null(check.rms_urad)},
          {"max_urad", or_null(fit.max_urad)},
          {"noise_um", or_null(noise_um(m))},
          {"n_obs", observations_of_fit_rows(m)},
          {"n_check", check.count},
          {"n_params", parameters},
          {"n_excluded", m.excluded}};
}

}  // namespace

ordered_json fit_json(const FitResult& result, const Measurement& m) {
  ordered_json json =
      shared(result.machine, m, result.before, result.after, result.check, result.parameters.size());
  json["parameters"] = ordered_json::array();
  for (const ParameterEstimate& item : result.estimates)
    json["parameters"].push_back(
        {{"name", item.name}, {"value", item.value}, {"std", or_null(item.std)}, {"unit", item.unit}});
  json["unidentifiable"] = ordered_json::array();
  for (const auto& group : result.observability.unidentifiable) {
    ordered_json names = ordered_json::array();
    for (const std::size_t i : group) names.push_back(result.parameters[i].name);
    json["unidentifiable"].push_back(names);
  }
  json["rank"] = result.observability.rank;
  json["condition"] = result.observability.condition;
  json["chi_square"] = result.chi_square;
  json["degrees_of_freedom"] = result.freedom;
  json["iterations"] = result.iterations;
  json["converged"] = result.converged;
  json["notes"] = result.machine.notes;
  return json;
}

ordered_json compare_json(const Machine& machine, const Measurement& m, const Eigen::VectorXd& residual) {
  const RoleStatistics fit = role_statistics(m, residual, false), check = role_statistics(m, residual, true);
  ordered_json json = shared(machine, m, fit, fit, check, 0);
  json["parameters"] = ordered_json::array();
  json["unidentifiable"] = ordered_json::array();
  json["circular"] = circular_json(machine, m);
  json["notes"] = machine.notes;
  return json;
}

std::string number_or_dash(const std::optional<double>& value, const char* unit) {
  return value ? fmt::format("{:.4g} {}", *value, unit) : std::string("-");
}

}  // namespace vernier
