// SPDX-License-Identifier: GPL-3.0-or-later
// `vernier export klipper|rrf|marlin|grbl`.
#include <fmt/format.h>

#include <algorithm>

#include "tools/commands/command.h"
#include "tools/commands/fit_findings.h"
#include "tools/commands/out/exporting.h"
#include "tools/exchange/printer/correction.h"
#include "tools/exchange/printer/firmware_files.h"
#include "tools/fit/findings.h"
#include "tools/kinematics/at.h"
#include "tools/maths/factors.h"
#include "tools/model/fit_record.h"
#include "tools/model/measurement.h"
#include "tools/text/error.h"

namespace vernier::commands::exchange_cli {
namespace {

using exchange::Firmware;

struct PrinterArguments {
  ExchangeArguments common;
  std::string steps, bed, profile;
  std::vector<std::string> touches;
};

/// Word of --bed: the heights do not follow a bed.
constexpr const char* kNoBed = "none";

/// The name of the profile. Two exports for one printer need two names: Klipper uses the later of two
/// sections with one name.
std::string profile_of(const PrinterArguments& arguments) {
  if (arguments.profile.find_first_not_of(exchange::kOfProfileName) != std::string::npos)
    throw text::InputError(
        fmt::format("--profile: '{}' must have only letters A to Z, digits, - and _", arguments.profile));
  return arguments.profile.empty() ? "vernier" : arguments.profile;
}

exchange::PresentSetting present_of(const PrinterArguments& arguments) {
  exchange::PresentSetting present;
  present.profile = profile_of(arguments);
  if (arguments.steps.empty()) return present;
  const std::vector<double> numbers = kinematics::number_list(arguments.steps, {3}, "--steps");
  for (const double number : numbers)
    if (!(number > 0))
      throw text::InputError(fmt::format("--steps: '{}' must be three positive numbers", arguments.steps));
  present.steps = {numbers[0], numbers[1], numbers[2]};
  return present;
}

Json shape_json(const exchange::BedShape& shape) {
  return {{"touches_of_probe", shape.by_probe},
          {"touches_of_nozzle", shape.by_nozzle},
          {"probe_offset_mm", shape.offset},
          {"check_rows", shape.checks},
          {"check_rms_um", shape.checks > 0 ? Json(shape.check_rms_um) : Json(nullptr)},
          {"repeat_rms_um", shape.repeat_rms_um > 0 ? Json(shape.repeat_rms_um) : Json(nullptr)},
          {"undetermined_um", shape.undetermined_um}};
}

void print_shape(std::FILE* out, const exchange::BedShape& shape) {
  if (shape.by_probe == 0)
    fmt::print(out, "the heights follow {} touches of the nozzle\n", shape.by_nozzle);
  else if (shape.by_nozzle == 0)
    fmt::print(
        out,
        "the heights follow {} touches of a probe at ({:g}, {:g}) mm beside the nozzle; no fit row touches "
        "with the nozzle\n",
        shape.by_probe, shape.offset[0], shape.offset[1]);
  else
    fmt::print(
        out,
        "the heights follow {} touches of a probe at ({:g}, {:g}) mm beside the nozzle, and the difference "
        "between nozzle and probe at {} touches of the nozzle\n",
        shape.by_probe, shape.offset[0], shape.offset[1], shape.by_nozzle);
  if (shape.repeat_rms_um > 0)
    fmt::print(
        out,
        "touches of one place differ by {:.3g} um rms from their mean; a bed that was warmer in some of "
        "the touches has another shape there\n",
        shape.repeat_rms_um);
  if (shape.checks > 0)
    fmt::print(out, "check rows with the nozzle: {}, rms of the height error {:.3g} um\n", shape.checks,
               shape.check_rms_um);
}

/// Errors of the heights that the touches do not determine, or that the files do not contain.
void add_left_out_of_bed(std::vector<exchange::LeftOut>& left, const exchange::Bed& bed,
                         const model::Machine& machine) {
  if (!bed.shape && machine.fitted->rms_mm * 1000 > exchange::kNothing_um)
    left.push_back(
        {"heights of the touches that the plane of the bed and the model do not contain, rms of the "
         "last fit (with --touches FILE the heights contain them)",
         machine.fitted->rms_mm * 1000});
  if (bed.shape && bed.shape->undetermined_um > exchange::kNothing_um)
    left.push_back(
        {"height at the nozzle that touches of a probe alone do not determine: they do not distinguish "
         "the shape of the bed from the straightness of a carriage (touch some points with the "
         "nozzle)",
         bed.shape->undetermined_um});
}

/// Skews and steps that the files do not contain, because the last fit did not measure them.
void add_unmeasured(std::vector<exchange::LeftOut>& left, const exchange::PrinterCorrection& correction) {
  for (const exchange::UnmeasuredPart& part : correction.unmeasured) {
    if (part.um <= exchange::kNothing_um) continue;
    constexpr double kUmPerM = 1e6;
    const bool skew = part.name.size() == 2;
    const std::string value = skew ? fmt::format("{:.3g} deg", part.value / maths::kRadPerDeg)
                                   : fmt::format("{:.3g} um/m", part.value * kUmPerM);
    left.push_back({fmt::format("{} {}: the readings of the last fit do not determine it (value of the model "
                                "{}), and the files do not contain it",
                                skew ? "squareness" : "scale", part.name, value),
                    part.um});
    left.back().measured = false;
  }
}

Json errors_json(const exchange::PrinterErrors& errors) {
  return {{"errors",
           {{"positions", errors.positions},
            {"before_um", three_json(errors.before_um)},
            {"after_um", three_json(errors.after_um)},
            {"rms_before_um", errors.rms_before_um},
            {"rms_after_um", errors.rms_after_um}}}};
}

/// True if the touches of the last fit do not distinguish the bed from the axes.
bool is_bed_or_axes(const model::Machine& machine) {
  const auto& findings = machine.fitted->findings;
  return std::any_of(findings.begin(), findings.end(),
                     [](const auto& finding) { return finding.code == fit::kFlatnessAssumed; });
}

/// Returns the machine without the errors of its axes. If touches of the bed are all that the fit had, some
/// of them with a probe beside the nozzle, the heights follow the touches like the mesh of the firmware
/// itself. The errors of the fitted axes would be at other positions than the heights that show them.
model::Machine with_straight_axes(const model::Machine& fitted, const exchange::Bed& bed,
                                  const PrinterArguments& arguments) {
  if (arguments.touches.empty())
    throw text::InputError(
        {arguments.common.machine, 0}, bed.name,
        "the fit had only touches of this plane and took it as flat: touches of a probe beside the nozzle do "
        "not distinguish a bow of the bed from axes that are not straight. Give the touches (--touches "
        "FILE), "
        "and a few touches of the nozzle if possible (a second --touches); --bed none leaves the bed out");
  return model::nominal_machine(fitted);
}

/// Errors by inputs, speed, travel since reversal and time: the files are those of one state.
void add_left_out_of_state(std::vector<exchange::LeftOut>& left, const model::Machine& machine,
                           const exchange::ThreeAxes& axes, const exchange::PrinterCorrection& correction,
                           const model::States& at, const std::optional<exchange::Bed>& bed) {
  for (exchange::LeftOut& one : exchange::errors_of_inputs(machine, axes, correction, at, bed))
    left.push_back(std::move(one));
  for (const std::size_t axis : axes.axis)
    for (exchange::LeftOut& one : exchange::beyond_own_axis(machine, axis, at))
      if (!one.other_axis && !one.of_input) left.push_back(std::move(one));
}

void export_printer(const PrinterArguments& arguments, Firmware firmware, const char* name) {
  const ExchangeArguments& common = arguments.common;
  const model::Machine fitted = read_model(common.machine);
  const exchange::PresentSetting present = present_of(arguments);
  if (firmware == Firmware::kGrbl && !present.steps)
    throw text::InputError(
        "grbl can store only steps per mm: give the present steps per mm with --steps X,Y,Z");
  const exchange::ThreeAxes axes = exchange::three_axes(fitted);
  const exchange::PrinterFeatures features = exchange::features_of(firmware, present);
  std::optional<exchange::Bed> bed =
      features.mesh && arguments.bed != kNoBed ? exchange::bed_of(fitted, axes, arguments.bed) : std::nullopt;
  const bool follows_touches = bed && is_bed_or_axes(fitted);
  if (!follows_touches) require_safe(fitted, common, true);
  const model::Machine machine = follows_touches ? with_straight_axes(fitted, *bed, arguments) : fitted;
  const model::States at = state_of(machine, common);
  if (!arguments.touches.empty() && !bed)
    throw text::InputError(
        "--touches: the last fit of this machine has no plane that was touched, or --bed is none");
  if (!arguments.touches.empty())
    exchange::give_shape(*bed, machine, axes, model::read_measurement(arguments.touches, machine));
  exchange::PrinterCorrection correction =
      exchange::printer_correction(machine, axes, features, at, common.tolerance_um, bed);
  const std::vector<exchange::ConfigurationFile> texts =
      exchange::firmware_files(firmware, present, machine.name, correction);
  const exchange::PrinterErrors errors = exchange::printer_errors(machine, axes, correction, at, bed);
  refuse_without_errors(common, errors.rms_before_um);
  const Json files = write_folder(common, texts);
  if (bed && bed->shape) print_shape(human_stream(common.json), *bed->shape);
  if (bed)
    fmt::print(human_stream(common.json),
               "the heights follow the {} \"{}\", X {:g} to {:g} mm, Y {:g} to {:g} mm\n",
               bed->shape ? "bed" : "plane", bed->name, bed->low[0], bed->high[0], bed->low[1], bed->high[1]);
  if (follows_touches)
    fmt::print(
        human_stream(common.json),
        "with straight axes the touches show an error of the height of {:.4g} um rms ({} positions). The "
        "files hold these heights to {:.4g} um rms; that is not the accuracy of the machine.\n",
        errors.rms_before_um, errors.positions, errors.rms_after_um);
  else
    print_rms(common, errors.positions, errors.rms_before_um, errors.rms_after_um);
  Json extra = errors_json(errors);
  std::vector<exchange::LeftOut> left = remaining(errors.after_um);
  add_unmeasured(left, correction);
  add_left_out_of_state(left, machine, axes, correction, at, bed);
  if (bed) {
    extra["bed"] = bed->name;
    if (bed->shape) extra["bed_shape"] = shape_json(*bed->shape);
    add_left_out_of_bed(left, *bed, machine);
    extra["errors"]["beyond_bed_um"] = errors.beyond_bed_um;
    if (errors.beyond_bed_um > errors.after_um[2] + exchange::kNothing_um)
      left.push_back(
          {"error along Z by the model that remains with the files outside the touched region of the bed",
           errors.beyond_bed_um});
  }
  finish(machine, common, name, left, files, {}, true, extra);
}

void add_printer(CLI::App* parent, const char* name, const char* what, const char* steps, Firmware firmware) {
  auto arguments = std::make_shared<PrinterArguments>();
  arguments->common.tolerance_um = 1;
  CLI::App* command = add_export(parent, name, what, kWritesFolder, "directory",
                                 std::shared_ptr<ExchangeArguments>(arguments, &arguments->common));
  command->add_option("--steps", arguments->steps, steps)->type_name("X,Y,Z");
  command
      ->add_option("--tolerance", arguments->common.tolerance_um,
                   "largest error of the interpolated height between the points of the mesh, um")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  if (firmware != Firmware::kGrbl)
    command
        ->add_option(
            "--bed", arguments->bed,
            "plane whose slope the heights follow: an <artefact> that the last fit touched, or none; "
            "default: the only touched plane")
        ->type_name("NAME");
  if (firmware == Firmware::kKlipper)
    command
        ->add_option("--profile", arguments->profile,
                     "name of the file and of its sections [skew_correction NAME] and [bed_mesh NAME]; two "
                     "exports for one printer need two names; default: vernier")
        ->type_name("NAME");
  if (firmware != Firmware::kGrbl)
    command
        ->add_option(
            "--touches", arguments->touches,
            "measurement files with touches of the bed: the heights contain the shape of the bed, at the "
            "nozzle also where an offset probe touched; may be repeated")
        ->type_name(kReads);
  command->footer(
      "The command writes the corrections of squareness, heights and steps per mm that the firmware "
      "supports, and prints the\n"
      "remaining error, evaluated on the chain between the points. The remaining error does not include a "
      "constant offset of an\n"
      "axis and a rotation of the whole part about Z.");
  command->callback([arguments, firmware, name] { export_printer(*arguments, firmware, name); });
}

}  // namespace

void add_printer_exports(CLI::App* parent) {
  constexpr const char* kSteps =
      "present steps per mm of X, Y and Z; without this option the scale is not corrected";
  add_printer(
      parent, "klipper", "Klipper: skew_correction, bed_mesh and rotation_distance",
      "present rotation_distance of X, Y and Z, mm per turn; without this option the scale is not corrected",
      Firmware::kKlipper);
  add_printer(parent, "rrf", "RepRapFirmware: M556, height map and M92", kSteps, Firmware::kRepRap);
  add_printer(parent, "marlin", "Marlin: M852, M421 and M92", kSteps, Firmware::kMarlin);
  add_printer(parent, "grbl", "grbl: steps per mm ($100 to $102), the only correction that grbl can store",
              kSteps, Firmware::kGrbl);
}

}  // namespace vernier::commands::exchange_cli
