// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <memory>
#include <optional>

#include "tools/commands/command.h"
#include "tools/commands/fit_findings.h"
#include "tools/kinematics/at.h"
#include "tools/kinematics/inverse.h"
#include "tools/offline/part_program.h"
#include "tools/offline/positions.h"
#include "tools/safety/safety_sheet.h"
#include "tools/text/assurance.h"
#include "tools/text/error.h"
#include "tools/text/optional_json.h"

namespace vernier::commands::correct_cli {
namespace {

struct CorrectArguments {
  std::string machine, path, output, json, at, zero, tool, place;
  double deviation_um = 0.5;
  bool back = false, with_rotary = false, chords = false;
};

/// Is this a list of positions? Its first line that is no comment is a header with commas or the name of a
/// column; a part program's is a block.
bool is_table(const std::string& path, const std::string& text) {
  if (path.ends_with(".csv")) return true;
  std::size_t at = 0;
  while (at < text.size()) {
    const auto end = std::min(text.find('\n', at), text.size());
    const std::string line = text.substr(at, end - at);
    at = end + 1;
    if (line.empty() || line[0] == '#' || line[0] == '\r') continue;
    return line.find(',') != std::string::npos && line.find('[') != std::string::npos;
  }
  return false;
}

/// Which axes a user's words name.
std::vector<char> named_in(const model::Machine& machine, const std::string& words) {
  std::vector<char> named(machine.axes.size(), 0);
  for (std::size_t i = 0; i < machine.axes.size(); ++i)
    named[i] = ("," + words).find("," + machine.axes[i].name + "=") != std::string::npos ? 1 : 0;
  return named;
}

/// Every position was corrected, and the blocks of a program follow.
text::Assurance assurance_of(const CorrectArguments& arguments, const offline::CorrectionSummary& summary,
                             const std::optional<double>& path_um) {
  text::Assurance assurance(text::AssuranceKind::kExport);
  assurance.at_most("not-converged", static_cast<double>(summary.not_converged), 0,
                    fmt::format("Positions of {} that cannot be corrected.", summary.positions));
  if (path_um)
    assurance.at_most("off-the-path", *path_um, arguments.deviation_um,
                      "Largest distance between the written blocks and the corrected path, um, over all "
                      "evaluated positions.");
  assurance.not_covered(
      "Errors that depend on quantities that the file does not contain (time, inputs) are evaluated at the "
      "values of --at.");
  return assurance;
}

/// "12.3 um", "0.0123 deg" of a robot, both of a machine of both kinds whose rotary axes correct too.
std::string largest_corrections(const offline::CorrectionSummary& summary, const model::Machine& machine,
                                bool with_rotary) {
  const std::string um = fmt::format("{:.4g} um", summary.largest_um(machine));
  const std::string deg = fmt::format("{:.4g} deg", summary.largest_deg(machine));
  if (kinematics::linear_axes(machine).empty()) return deg;
  return with_rotary && summary.largest_deg(machine) > 0 ? um + " and " + deg : um;
}

/// Why the correction of a position is so large: near a singular pose axes compensate each other.
std::string reason_of(const offline::BeyondLimit& one, const offline::CorrectionSummary& summary) {
  constexpr double kNearSingular = 5;  // times the usual condition number
  if (summary.usual_condition <= 0 || one.condition < kNearSingular * summary.usual_condition) return "";
  return fmt::format(
      ". There the machine is near a singular pose (condition number {:.3g}, median of all positions "
      "{:.3g}), "
      "in which axes turn about nearly the same line and a small error needs a large motion of them",
      one.condition, summary.usual_condition);
}

/// A correction beyond maxcorrection would move the machine further than its user permits.
void require_within_limits(const model::Machine& machine, const offline::CorrectionSummary& summary,
                           const std::string& path) {
  if (summary.beyond.empty()) return;
  const offline::BeyondLimit& worst = *std::ranges::max_element(
      summary.beyond, {},
      [&](const offline::BeyondLimit& one) { return one.size / *machine.axes[one.axis].max_correction; });
  const model::Axis& axis = machine.axes[worst.axis];
  const char* const unit = axis.rotary ? "deg" : "mm";
  std::string where =
      fmt::format("{} of {} positions exceed a maxcorrection", summary.beyond.size(), summary.positions);
  std::string remedy = "raise maxcorrection if your machine permits more";
  if (worst.line > 0) {
    constexpr std::size_t kMostLines = 12;  // of a message
    std::vector<std::size_t> lines;
    for (const offline::BeyondLimit& one : summary.beyond) lines.push_back(one.line);
    const bool many = lines.size() > kMostLines;
    if (many) lines.resize(kMostLines);
    where = fmt::format("largest in {}:{}; {} (line{} {}{})", path, worst.line, where,
                        lines.size() > 1 ? "s" : "", fmt::join(lines, ", "), many ? " ..." : "");
    remedy = "take these positions out of the list or move them, or " + remedy;
  }
  throw text::LimitNotMet(fmt::format(
      "the correction of {} is up to {:.4g} {}, and its maxcorrection in the machine file permits {:g} {}: "
      "no file is written, because positions that are not corrected among corrected ones would not be "
      "noticed; {}{}: {}",
      axis.name, worst.size, unit, *axis.max_correction, unit, where, reason_of(worst, summary), remedy));
}

/// The safety sheet says how far a fitted machine file can be trusted. Without the ranges of all axes there
/// is no sheet.
void note_what_is_not_safe(const model::Machine& machine) {
  const bool bounded = std::all_of(machine.axes.begin(), machine.axes.end(),
                                   [](const model::Axis& axis) { return axis.min && axis.max; });
  if (!machine.fitted || !bounded) return;
  const safety::SafetySheet sheet = safety::safety_sheet(machine);
  if (!sheet.ok()) fmt::print(stderr, "note: {}\n", sheet.refusal());
}

void run_correct(const CorrectArguments& arguments) {
  const model::Machine read = read_model(arguments.machine);
  const model::Machine machine = arguments.tool.empty() ? read : kinematics::tooled(read, arguments.tool);
  const std::string text = text::read_file(arguments.path);
  const model::States at = kinematics::state_at(machine, arguments.at);
  offline::CorrectorOptions options;
  options.back = arguments.back;
  options.with_rotary = arguments.with_rotary || machine.correct_orientation;
  offline::Corrector corrector(machine, options);
  nlohmann::ordered_json json = {{"machine", machine.name}, {"path", arguments.path}};
  std::string result;
  std::optional<double> path_um;  // of a program: how far its blocks leave the corrected path
  if (is_table(arguments.path, text)) {
    std::optional<Eigen::Isometry3d> place;
    if (!arguments.place.empty()) place = kinematics::placement(arguments.place, "--place");
    result = offline::corrected_positions(text, arguments.path, at, corrector, place);
  } else {
    if (arguments.back)
      throw text::InputError({arguments.path, 0}, "--back",
                             "this option is only for a CSV of positions, not for a part program");
    if (!arguments.place.empty())
      throw text::InputError({arguments.path, 0}, "--place",
                             "this option is only for a list of targets; for a part program use --zero");
    offline::PartProgramOptions program;
    program.deviation_mm = 1e-3 * arguments.deviation_um;
    program.arcs = !arguments.chords;
    const model::States zero = kinematics::state_at(machine, arguments.zero);
    for (std::size_t i = 0; i < machine.axes.size(); ++i) program.zero.push_back(zero.axis[i][0]);
    offline::PartProgram corrected = offline::corrected_program(
        text, arguments.path, at, named_in(machine, arguments.at), program, corrector);
    json["moves"] = corrected.moves;
    json["moves_written"] = corrected.written;
    json["arcs_written"] = corrected.arcs;
    path_um = 1000 * corrected.worst_mm;
    json["path_um"] = *path_um;
    result = std::move(corrected.text);
  }
  const offline::CorrectionSummary& summary = corrector.summary();
  json["positions"] = summary.positions;
  json["max_correction_um"] = summary.largest_um(machine);
  json["max_correction"] = nlohmann::ordered_json::object();
  for (std::size_t i = 0; i < machine.axes.size(); ++i)
    json["max_correction"][machine.axes[i].name] = summary.largest[i];
  json["left_um"] = 1000 * summary.left_mm;
  json["not_converged"] = summary.not_converged;
  json["assurance"] = assurance_of(arguments, summary, path_um).json();
  if (summary.not_converged > 0)
    throw text::LimitNotMet(fmt::format("{} of {} positions cannot be corrected with these axes",
                                        summary.not_converged, summary.positions));
  if (path_um && *path_um > arguments.deviation_um)
    throw text::LimitNotMet(
        fmt::format("the blocks deviate from the corrected path by {:.4g} um, --deviation permits {} um; no "
                    "file is written",
                    *path_um, arguments.deviation_um));
  if (!arguments.back) {
    require_within_limits(machine, summary, arguments.path);
    note_what_is_not_safe(machine);
  }
  text::write_file(arguments.output, result);
  write_json(arguments.json, json);
  std::FILE* out = human_stream(arguments.json);
  fmt::print(out, "{}: {} positions, corrections up to {}", arguments.output, summary.positions,
             largest_corrections(summary, machine, options.with_rotary));
  if (json.contains("moves"))
    fmt::print(out, "; {} moves of the program become {} moves, {} of them arcs",
               json["moves"].get<std::size_t>(), json["moves_written"].get<std::size_t>(),
               json["arcs_written"].get<std::size_t>());
  if (path_um)
    fmt::print(out, "; the written path differs from the corrected path by at most {:.3g} um", *path_um);
  fmt::print(out, "; left over {:.3g} um\n", 1000 * summary.left_mm);
}

}  // namespace

void register_correct(CLI::App& vernier) {
  auto arguments = std::make_shared<CorrectArguments>();
  CLI::App* command = vernier.add_subcommand(
      "correct", "Write positions or a part program with the correction, for a controller without a board");
  command->add_option("MACHINE", arguments->machine, "machine file (XML), fitted")
      ->type_name(kReads)
      ->required();
  command->add_option("PATH", arguments->path, "CSV of positions or targets, or a part program (RS-274)")
      ->type_name(kReads)
      ->required();
  command->add_option("-o,--output", arguments->output, "the same, corrected")
      ->type_name(kWrites)
      ->required();
  command->add_option(
      "--at", arguments->at,
      "values of the inputs, and positions of the axes before the program begins: \"T=25,X=0,Z=100\"");
  command->add_option("--zero", arguments->zero,
                      "machine position of the program's zero, tool length included: \"X=120,Y=80,Z=-40\"");
  command->add_option("--place", arguments->place,
                      "zero of the targets in workpiece coordinates: \"X,Y,Z\", \"X,Y,Z,TURN\" or "
                      "\"X,Y,Z,rX,rY,rZ\" (mm, deg)");
  command->add_option("--tool", arguments->tool,
                      "a tool of the file's <tools>, or \"X,Y,Z\" in mm from the end of the chain");
  command
      ->add_option("--deviation", arguments->deviation_um,
                   "largest permitted distance between a written block and the ideal path, which is "
                   "corrected at every point, um")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_flag(
      "--back", arguments->back,
      "reverse: converts commanded positions to those of an ideal machine at the same tool point");
  command->add_flag("--chords", arguments->chords,
                    "write arcs as straight blocks, for a control that does not execute G2 and G3");
  command->add_flag("--rotary", arguments->with_rotary,
                    "correct with all axes, tool point and tool direction; default: as in the machine file");
  command->add_option("--json", arguments->json,
                      "file for the result as JSON, for programs; - for standard output");
  command->footer(
      "The output file is marked as corrected or converted back, and the command refuses a second "
      "conversion. Exit status\n"
      "0 done, 1 bad input (nothing written), 2 a position cannot be corrected with these axes, a target "
      "cannot\n"
      "be reached, a correction exceeds the maxcorrection of its axis, or the blocks of a program deviate "
      "from\n"
      "the corrected path by more than --deviation.");
  command->callback([arguments] { run_correct(*arguments); });
}

}  // namespace vernier::commands::correct_cli
