#include <fmt/format.h>

#include <cmath>
#include <memory>

#include "tools/cli/command.h"
#include "tools/cli/results.h"
#include "tools/fit/domain.h"
#include "tools/fit/fit.h"
#include "tools/model/machine.h"
#include "tools/model/measurement.h"
#include "tools/model/numbers.h"

namespace vernier {
namespace {

struct FitArguments {
  std::string machine, output, json;
  std::vector<std::string> measurements;
  std::vector<std::string> stages, priors;
  std::string loss = "squared", solver = "normal-equations";
  double loss_scale = 3;
};

void print_group(std::FILE* out, const FitResult& result, const std::vector<std::size_t>& group) {
  std::string names;
  constexpr std::size_t kMost = 8;
  for (std::size_t i = 0; i < group.size() && i < kMost; ++i)
    names += (i ? ", " : "") + result.parameters[group[i]].name;
  if (group.size() > kMost) names += fmt::format(" and {} more", group.size() - kMost);
  fmt::print(out, "  {} {}\n", names,
             group.size() == 1 ? "has no effect on these data" : "cannot be told apart with these data");
}

/// The combination that the data see least, where it is weak enough to matter.
void print_weakest(std::FILE* out, const FitResult& result) {
  constexpr double kWeak = 1e-2;
  for (const Observability::Weak& weak : result.observability.weakest) {
    if (weak.ratio > kWeak) continue;
    std::string names;
    for (std::size_t i = 0; i < weak.parts.size() && i < 6; ++i)
      names += (i ? ", " : "") + result.parameters[weak.parts[i]].name;
    fmt::print(out, "weakly determined ({:.1e} of the best): {}{}\n", weak.ratio, names,
               weak.parts.size() > 6 ? ", ..." : "");
  }
}

/// Is what is left noise? Said only where the noise is known.
void print_verdict(std::FILE* out, const FitResult& result) {
  if (result.normalised_check)
    fmt::print(out, "check rows over the uncertainty of reading and model: rms {:.3f}, {:.1f} % within 3\n",
               result.normalised_check->rms, 100 * result.normalised_check->within_3);
  if (!result.noise_um || !result.after.rms_um || result.freedom <= 0) return;
  // chi^2 / dof has a standard deviation of sqrt(2 / dof) where the residual is noise.
  const double reduced = std::pow(*result.after.rms_um / *result.noise_um, 2) *
                         static_cast<double>(result.before.count) / static_cast<double>(result.freedom);
  if (reduced > 1 + 5 * std::sqrt(2.0 / static_cast<double>(result.freedom)))
    fmt::print(out, "the residual is {:.2g} times the noise: something is missing from this model\n",
               std::sqrt(reduced));
}

void print_result(std::FILE* out, const FitResult& result, const Measurement& m) {
  fmt::print(out, "{:<24} {:>15} {:>12}  {}\n", "parameter", "value", "std", "unit");
  for (const ParameterEstimate& item : result.estimates)
    fmt::print(out, "{:<24} {:>15.6g} {:>12}  {}\n", item.name, item.value,
               item.std ? fmt::format("{:.2g}", *item.std) : "-", item.unit);
  if (!result.observability.unidentifiable.empty()) {
    fmt::print(out, "not determined (left at their start along these combinations):\n");
    for (const auto& group : result.observability.unidentifiable) print_group(out, result, group);
  }
  for (const auto& [name, std] : result.priors)
    fmt::print(out, "held near its start as if measured there: {} with std {:g}\n", name, std);
  print_weakest(out, result);
  fmt::print(out, "rms before      {}\n", number_or_dash(result.before.rms_um, "um"));
  fmt::print(out, "rms fit rows    {}   max {}\n", number_or_dash(result.after.rms_um, "um"),
             number_or_dash(result.after.max_um, "um"));
  fmt::print(out, "rms check rows  {}   max {}\n", number_or_dash(result.check.rms_um, "um"),
             number_or_dash(result.check.max_um, "um"));
  if (result.after.rms_urad)
    fmt::print(out, "rms rotations   {} before {}\n", number_or_dash(result.after.rms_urad, "urad"),
               number_or_dash(result.before.rms_urad, "urad"));
  fmt::print(out, "noise           {}\n", number_or_dash(result.noise_um, "um"));
  fmt::print(out, "{} observations, {} parameters, rank {}, {} rows excluded, {} iterations{}\n",
             result.before.count, result.parameters.size(), result.observability.rank, m.excluded,
             result.iterations, result.converged ? "" : ", NOT CONVERGED");
  print_verdict(out, result);
}

std::vector<std::string> split_list(const std::string& text) {
  std::vector<std::string> list(1);
  for (const char c : text) {
    if (c == ',')
      list.emplace_back();
    else
      list.back() += c;
  }
  return list;
}

Prior prior_of(const std::string& text) {
  const auto at = text.rfind('=');
  const auto std = at == std::string::npos ? std::nullopt : parse_number(text.substr(at + 1));
  if (!std || *std <= 0) throw InputError("\"" + text + "\": a prior is NAME=STD");
  return {text.substr(0, at), *std};
}

void run_fit(const FitArguments& arguments) {
  const std::string text = read_file(arguments.machine);
  const Machine machine = parse_machine(text, arguments.machine);
  const Measurement m = read_measurement(arguments.measurements, machine);
  FitOptions options;
  options.loss = arguments.loss == "huber"    ? Loss::kHuber
                 : arguments.loss == "cauchy" ? Loss::kCauchy
                                              : Loss::kSquared;
  options.loss_scale = arguments.loss_scale;
  options.solver = arguments.solver == "ceres" ? Solver::kCeres : Solver::kNormalEquations;
  for (const std::string& stage : arguments.stages) options.stages.push_back(split_list(stage));
  for (const std::string& prior : arguments.priors) options.priors.push_back(prior_of(prior));
  Progress progress("fit");
  options.progress = [&](int iteration, double cost) {
    progress.update(iteration / 100.0,
                    fmt::format("iteration {}, weighted sum of squares {:.6g}", iteration, cost));
  };
  const FitResult result = fit(machine, m, options);
  const nlohmann::ordered_json json = fit_json(result, m);
  if (!arguments.output.empty())
    write_file(arguments.output,
               close_domains(update_machine_text(text, result.machine, true), result.machine, m));
  write_json(arguments.json, json);
  for (const std::string& note : machine.notes) fmt::print(stderr, "note: {}\n", note);
  print_result(human_stream(arguments.json), result, m);
  print_domains(human_stream(arguments.json), json["domains"]);
}

}  // namespace

void register_fit(CLI::App& vernier) {
  auto arguments = std::make_shared<FitArguments>();
  CLI::App* command =
      vernier.add_subcommand("fit", "Estimate the free parameters of a machine from measurements");
  command->add_option("MACHINE", arguments->machine, "machine file (XML)")->required();
  command->add_option("MEAS", arguments->measurements, "measurement files (CSV)")->required();
  command->add_option("-o,--output", arguments->output, "the fitted machine file");
  command->add_option("--json", arguments->json, "result for programs; - for standard output");
  command->add_option("--loss", arguments->loss, "squared, huber or cauchy")
      ->check(CLI::IsMember({"squared", "huber", "cauchy"}))
      ->capture_default_str();
  command
      ->add_option("--loss-scale", arguments->loss_scale,
                   "where a robust loss bends, in u (in robust spreads of the residual where u is absent)")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_option(
      "--stage", arguments->stages,
      "patterns (comma between them) of the parameters freed in a stage before all are; may be repeated");
  command->add_option("--prior", arguments->priors,
                      "NAME=STD: hold parameters near their start as if measured there; may be repeated");
  command->add_option("--solver", arguments->solver, "normal-equations, or ceres as a cross-check")
      ->check(CLI::IsMember({"normal-equations", "ceres"}))
      ->capture_default_str();
  command->footer(
      "Weighted least squares (1/u^2) on rows with role fit. Parameters that the data cannot separate are\n"
      "named and left at their start along those combinations. Exit status 0 done, 1 bad input.");
  command->callback([arguments] { run_fit(*arguments); });
}

}  // namespace vernier
