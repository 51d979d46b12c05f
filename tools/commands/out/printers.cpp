// SPDX-License-Identifier: GPL-3.0-or-later
// `vernier export klipper|rrf|marlin|grbl`.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string_view>
#include <utility>

#include "tools/commands/command.h"
#include "tools/commands/fit_findings.h"
#include "tools/commands/out/exporting.h"
#include "tools/commands/out/square_fit.h"
#include "tools/effects/probe_offset.h"
#include "tools/exchange/printer/correction.h"
#include "tools/exchange/printer/firmware_files.h"
#include "tools/fit/findings.h"
#include "tools/fit/fit.h"
#include "tools/kinematics/at.h"
#include "tools/maths/factors.h"
#include "tools/model/fit_record.h"
#include "tools/model/machine_reader.h"
#include "tools/model/measurement.h"
#include "tools/model/parameters.h"
#include "tools/safety/safety_sheet.h"
#include "tools/text/error.h"
#include "tools/text/files.h"
#include "tools/text/words.h"

namespace vernier::commands::exchange_cli {
namespace {

using exchange::Firmware;

constexpr double kUmPerM = 1e6;

struct PrinterArguments {
  ExchangeArguments common;
  std::string steps, bed, profile, zero;
  std::vector<std::string> touches;
};

/// Word of --bed: the heights do not follow a bed.
constexpr const char* kNoBed = "none";

/// Words of --zero.
constexpr const char* kZeroOfTouches = "touches";
constexpr const char* kZeroInTheMiddle = "middle";

/// Mean height of the bed above which the zero of the touches is doubtful, mm: a z_offset of a probe is
/// usually 0.5 to 5 mm, and a printer whose offset of Z is set has less than 0.3 mm.
constexpr double kDoubtfulZero_mm = 0.5;

/// The name of the profile. Two exports for one printer need two names: Klipper uses the later of two
/// sections with one name.
std::string profile_of(const PrinterArguments& arguments) {
  if (arguments.profile.find_first_not_of(exchange::kOfProfileName) != std::string::npos)
    throw text::InputError(
        fmt::format("--profile: '{}' must have only letters A to Z, digits, - and _", arguments.profile));
  return arguments.profile.empty() ? "vernier" : arguments.profile;
}

exchange::PresentSetting present_of(const PrinterArguments& arguments, Firmware firmware) {
  exchange::PresentSetting present;
  present.profile = profile_of(arguments);
  if (arguments.steps.empty()) return present;
  const std::vector<double> numbers = kinematics::number_list(arguments.steps, {3}, "--steps");
  for (const double number : numbers)
    if (!(number > 0))
      throw text::InputError(fmt::format("--steps: '{}' must be three positive numbers", arguments.steps));
  // The spindle of Z turns more often for a millimetre than the belts of X and Y: less of a rotation
  // distance, more steps.
  const bool per_turn = firmware == Firmware::kKlipper;
  if (per_turn ? numbers[2] > 1.5 * numbers[0] : firmware != Firmware::kGrbl && numbers[2] < numbers[0] / 1.5)
    throw text::InputError(fmt::format("--steps {}: {} Give {}", arguments.steps,
                                       per_turn ? "these look like steps per mm, and Klipper has the "
                                                  "rotation_distance of each stepper, mm per turn."
                                                : "these look like the rotation_distance of Klipper, mm per "
                                                  "turn, and this firmware has steps per mm.",
                                       per_turn ? "those of printer.cfg, such as 40,40,8"
                                                : "those that the printer prints (M503), such as 80,80,400"));
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
        "the touches has another shape there (import printer --series N reads the touches of one survey)\n",
        shape.repeat_rms_um);
  if (shape.checks > 0)
    fmt::print(out, "check rows with the nozzle: {}, rms of the height error {:.3g} um\n", shape.checks,
               shape.check_rms_um);
}

/// Errors of the heights that the touches do not determine, or that the files do not contain.
void add_left_out_of_bed(std::vector<exchange::LeftOut>& left, const exchange::Bed& bed,
                         const model::Machine& machine) {
  if (!bed.shape && machine.fitted && machine.fitted->rms_mm * 1000 > exchange::kNothing_um)
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
    const bool skew = part.name.size() == 2;
    const std::string what = fmt::format("{} {}", skew ? "squareness" : "scale", part.name);
    if (part.um <= exchange::kNothing_um) {
      left.push_back({what + ": not measured (the last fit had no parameter of it)"});
      left.back().measured = false;
      continue;
    }
    const std::string value = skew ? fmt::format("{:.3g} deg", part.value / maths::kRadPerDeg)
                                   : fmt::format("{:.3g} um/m", part.value * kUmPerM);
    left.push_back({fmt::format("{}: the readings of the last fit do not determine it (value of the model "
                                "{}), and the files do not contain it",
                                what, value),
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

bool has_finding(const model::Machine& machine, const char* code) {
  if (!machine.fitted) return false;
  const auto& findings = machine.fitted->findings;
  return std::any_of(findings.begin(), findings.end(),
                     [&](const auto& finding) { return finding.code == code; });
}

/// True if the touches of the last fit do not distinguish the bed from the axes.
bool is_bed_or_axes(const model::Machine& machine) { return has_finding(machine, fit::kFlatnessAssumed); }

void require_touches(const exchange::Bed& bed, const PrinterArguments& arguments) {
  if (arguments.touches.empty())
    throw text::InputError(
        {arguments.common.machine, 0}, bed.name,
        "the fit took this plane as flat: touches of a probe beside the nozzle do "
        "not distinguish a bow of the bed from axes that are not straight. Give the touches (--touches "
        "FILE), and a few touches of the nozzle if possible (a second file for --touches); --bed none leaves "
        "the bed out");
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

/// The machines of one export, and the bed.
struct PrinterModel {
  model::Machine fitted;
  /// True: the heights follow the touches with straight axes, like the mesh of the firmware itself. Then the
  /// last fit does not distinguish the bed from the axes (errors of its axes would be at other positions than
  /// the heights that show them), or it did not measure the heights of the axes.
  bool follows_touches = false;
  model::Machine of_heights;  // with straight axes if the heights follow the touches
  std::optional<exchange::Bed> bed;
  model::States at;
};

/// Declares the probe of the touches, if the last fit had no touches.
model::Machine with_probe_of_touches(const model::Machine& machine, const PrinterArguments& arguments) {
  const model::CompletedText complete =
      effects::with_probe_offset(text::read_file(arguments.common.machine), machine,
                                 model::read_measurement(arguments.touches, machine));
  return model::parse_machine(complete.text, arguments.common.machine);
}

/// True if a word of the state (--at) is a column of the touches.
bool names_column_of_touches(const PrinterArguments& arguments) {
  std::string headings = ",";
  for (const std::string& file : arguments.touches) {
    const std::string text = text::read_file(file);
    headings += text.substr(0, text.find('\n')) + ",";
  }
  const std::vector<std::string> words = text::parts_of(arguments.common.at, ',');
  return std::any_of(words.begin(), words.end(), [&](const std::string& word) {
    const std::string name = text::trimmed(word.substr(0, word.find('=')));
    return !name.empty() && headings.find("," + name + "[") != std::string::npos;
  });
}

/// The state in which the files are exact. The heights follow the touches in the state of these.
model::States state_of_files(const model::Machine& machine, const PrinterArguments& arguments) {
  try {
    return state_of(machine, arguments.common);
  } catch (const text::InputError& error) {
    if (!names_column_of_touches(arguments)) throw;
    throw text::InputError(
        fmt::format("{}. The heights follow all touches of the files, also those in another state: for the "
                    "heights in one state, give with --touches the touches of one survey (vernier import "
                    "printer LOG --series N, or PRINTER.CFG --profile NAME) in the place of --at",
                    error.what()));
  }
}

PrinterModel model_of(const PrinterArguments& arguments, const exchange::PrinterFeatures& features) {
  PrinterModel model{read_model(arguments.common.machine), false, {}, {}, {}};
  const exchange::ThreeAxes axes = exchange::three_axes(model.fitted);
  const bool with_bed = features.mesh && arguments.bed != kNoBed;
  if (!arguments.touches.empty() && !with_bed)
    throw text::InputError("--touches: the heights follow no bed with --bed none");
  const bool fit_touched = model.fitted.fitted && !model.fitted.fitted->planes.empty();
  if (!arguments.touches.empty() && !fit_touched) {
    model.fitted = with_probe_of_touches(model.fitted, arguments);
    model.bed = exchange::bed_of_touches(
        model.fitted, axes, model::read_measurement(arguments.touches, model.fitted), arguments.bed);
    model.follows_touches =
        !exchange::heights_are_measured(model.fitted, axes, state_of_files(model.fitted, arguments));
  } else if (with_bed) {
    model.bed = exchange::bed_of(model.fitted, axes, arguments.bed);
    model.follows_touches = model.bed && is_bed_or_axes(model.fitted);
    if (model.follows_touches) require_touches(*model.bed, arguments);
  }
  model.of_heights = model.follows_touches ? model::nominal_machine(model.fitted) : model.fitted;
  model.at = state_of_files(model.fitted, arguments);
  if (!arguments.touches.empty())
    exchange::give_shape(*model.bed, model.of_heights, axes,
                         model::read_measurement(arguments.touches, model.of_heights));
  return model;
}

/// Refuses heights that would raise the residual of the touches that they follow.
void require_better_heights(const std::optional<exchange::TouchResidual>& touches) {
  if (!touches || !touches->worse()) return;
  throw text::LimitNotMet(fmt::format(
      "the heights would raise the deviation at the {} touches of the {} from {:.4g} to {:.4g} um rms: the "
      "errors of the fitted axes do not agree with these touches; nothing is written. Fit the touches of the "
      "bed alone (vernier fit MACHINE TOUCHES), and export that machine file; or give touches of the nozzle "
      "(a second file for --touches)",
      touches->touches, touches->of_nozzle ? "nozzle" : "probe", touches->before_um, touches->after_um));
}

/// Takes the zero of the heights from the touches, or from the middle of the mesh. Heights far from 0 may
/// contain the z_offset of a probe: the nozzle would print in the air or be driven into the bed.
void set_zero(exchange::PrinterCorrection& correction, const PrinterArguments& arguments) {
  exchange::HeightMesh& mesh = correction.mesh;
  if (arguments.zero == kZeroInTheMiddle) {
    mesh.z.array() -= mesh.at((mesh.x_low + mesh.x_high) / 2, (mesh.y_low + mesh.y_high) / 2);
    return;
  }
  const double mean = mesh.z.mean();
  if (arguments.zero == kZeroOfTouches || std::abs(mean) <= kDoubtfulZero_mm) return;
  throw text::LimitNotMet(fmt::format(
      "the heights of the touches have a mean of {:.3f} mm: if they contain the z_offset of a probe (a log "
      "of "
      "Klipper with \"probe at X,Y is z=Z\" and without configuration), the nozzle would print {:.3f} mm {}; "
      "nothing is written. Import the log again with --offset=X,Y,Z (Z: z_offset of the configuration); or "
      "state --zero middle (0 in the middle of the mesh, and the offset of Z of the printer is set again), "
      "or "
      "--zero touches if these are the heights of the bed above the zero of Z",
      mean, std::abs(mean), mean > 0 ? "above the bed" : "too low, in the bed"));
}

void refuse_empty(const exchange::PrinterCorrection& correction, const model::Machine& machine) {
  if (!correction.empty()) return;
  const std::string remedy = remedy_of_unmeasured(fit_of_square(machine));
  throw text::LimitNotMet(fmt::format(
      "the last fit measured no squareness, no scale and no height that this firmware could correct; nothing "
      "is written. {}",
      remedy.empty() ? "Give the touches of the bed with --touches, or the present steps with --steps"
                     : remedy));
}

/// A deviation for people: below a hundredth of a micrometre the digits are those of the arithmetic.
std::string shown_um(double um) {
  return um < exchange::kNothing_um ? fmt::format("below {}", exchange::kNothing_um)
                                    : fmt::format("{:.4g}", um);
}

void print_errors(const PrinterArguments& arguments, const PrinterModel& model,
                  const exchange::PrinterErrors& errors,
                  const std::optional<exchange::TouchResidual>& touches, double mean_mm) {
  std::FILE* const out = human_stream(arguments.common.json);
  const std::optional<exchange::Bed>& bed = model.bed;
  if (bed && bed->shape) print_shape(out, *bed->shape);
  if (bed)
    fmt::print(out, "the heights follow the {} \"{}\", X {:g} to {:g} mm, Y {:g} to {:g} mm\n",
               bed->shape ? "bed" : "plane", bed->name, bed->low[0], bed->high[0], bed->low[1], bed->high[1]);
  if (bed && bed->shape && arguments.zero != kZeroInTheMiddle)
    fmt::print(
        out,
        "the zero of the heights is that of the touches (mean height of the mesh {:.3f} mm): the offset "
        "of Z of the printer stays\n",
        mean_mm);
  else if (bed)
    fmt::print(out,
               "the heights are 0 in the middle of the mesh: set the offset of Z of the printer again\n");
  if (touches)
    fmt::print(
        out,
        "deviation of the height at the {} touches of the {}: {} um rms without the files, {} um rms with "
        "the files\n",
        touches->touches, touches->of_nozzle ? "nozzle" : "probe", shown_um(touches->before_um),
        shown_um(touches->after_um));
  if (model.follows_touches)
    fmt::print(
        out,
        "with straight axes the touches show an error of the height of {:.4g} um rms ({} positions). The "
        "files hold these heights to {:.4g} um rms; that is not the accuracy of the machine.\n",
        errors.rms_before_um, errors.positions, errors.rms_after_um);
  else
    print_rms(arguments.common, errors.positions, errors.rms_before_um, errors.rms_after_um);
}

/// The squareness and the scales that the files contain.
void print_straight_parts(std::FILE* out, const exchange::PrinterCorrection& correction) {
  const std::array<std::pair<const char*, double>, 3> skews = {
      {{"XY", correction.xy}, {"XZ", correction.xz}, {"YZ", correction.yz}}};
  for (const auto& [name, tangent] : skews)
    if (tangent != 0)
      fmt::print(out, "squareness {}: the files correct {:.4g} deg\n", name, -tangent / maths::kRadPerDeg);
  for (std::size_t i = 0; i < correction.lost_motion.size(); ++i)
    if (correction.lost_motion[i] > 0)
      fmt::print(out, "lost motion of {} at a reversal: the files correct {:.4g} um\n", exchange::kLetters[i],
                 maths::kUmPerMm * correction.lost_motion[i]);
  for (std::size_t i = 0; i < correction.steps.size(); ++i)
    if (correction.steps[i] != 1)
      fmt::print(out, "scale {}: the files correct {:.4g} um/m\n", exchange::kLetters[i],
                 -(correction.steps[i] - 1) * kUmPerM);
  if (correction.steps[0] != 1 || correction.steps[1] != 1)
    fmt::print(out,
               "the scales are those of the readings: if a printed part was measured, they contain the "
               "shrinkage of its material, and another material needs other scales\n");
}

/// Where Klipper has to include the file of the steppers.
void print_include(std::FILE* out, const std::vector<exchange::ConfigurationFile>& files) {
  constexpr const char* kSteppers = "_steppers.cfg";
  for (const exchange::ConfigurationFile& file : files)
    if (file.name.ends_with(kSteppers))
      fmt::print(out,
                 "{0}: write [include {0}] into printer.cfg below the sections of the steppers ([stepper_x] "
                 "and so on): above them it has no effect, because a later value replaces an earlier one\n",
                 file.name);
}

/// The correction without skew and steps: what remains of the heights is that of straight axes.
exchange::PrinterCorrection only_heights(exchange::PrinterCorrection correction) {
  correction.xy = correction.xz = correction.yz = 0;
  correction.steps = {1, 1, 1};
  return correction;
}

/// The refusal of a fit that left squareness and scales open begins with the fit that measures them: the
/// other parameters that such a fit holds are more than those that the sheet names.
void require_safe_printer(const model::Machine& machine, const ExchangeArguments& common) {
  try {
    require_safe(machine, common, true);
  } catch (const text::LimitNotMet& refusal) {
    const std::string remedy = remedy_of_unmeasured(fit_of_square(machine));
    if (remedy.empty()) throw;
    throw text::LimitNotMet(fmt::format("{}. Without distances of a square: {}", remedy, refusal.what()));
  }
}

/// Scales that the last fit measured, and that the files do not contain because the user did not state what
/// the printer has now.
void add_scales_without_steps(std::vector<exchange::LeftOut>& left, const PrinterModel& model,
                              const exchange::ThreeAxes& axes, const exchange::PrinterFeatures& features,
                              const char* setting, double tolerance_um) {
  if (features.steps) return;
  exchange::PrinterFeatures only_steps;
  only_steps.skew = only_steps.mesh = false;
  only_steps.steps = true;
  only_steps.size_known = features.size_known;
  const exchange::PrinterCorrection scales =
      exchange::printer_correction(model.of_heights, axes, only_steps, model.at, tolerance_um, std::nullopt,
                                   model.follows_touches ? &model.fitted : nullptr);
  for (std::size_t i = 0; i < scales.steps.size(); ++i)
    if (scales.steps[i] != 1)
      left.push_back({fmt::format("scale {} ({:.4g} um/m, measured): state the present {} of X, Y and Z with "
                                  "--steps X,Y,Z, and the files correct it",
                                  exchange::kLetters[i], -(scales.steps[i] - 1) * kUmPerM, setting),
                      maths::kUmPerMm * (axes.high[i] - axes.low[i]) * std::abs(scales.steps[i] - 1)});
}

void export_printer(const PrinterArguments& arguments, Firmware firmware, const char* name) {
  const ExchangeArguments& common = arguments.common;
  const exchange::PresentSetting present = present_of(arguments, firmware);
  if (firmware == Firmware::kGrbl && !present.steps)
    throw text::InputError(
        "grbl can store only steps per mm: give the present steps per mm with --steps X,Y,Z");
  exchange::PrinterFeatures features = exchange::features_of(firmware, present);
  const PrinterModel model = model_of(arguments, features);
  const auto& [fitted, follows_touches, machine, bed, at] = model;
  const exchange::ThreeAxes axes = exchange::three_axes(fitted);
  features.size_known = !has_finding(fitted, fit::kSizeUnknown);
  if (!follows_touches) require_safe_printer(fitted, common);
  const bool unmeasured_heights = features.mesh && !bed && !exchange::heights_are_measured(fitted, axes, at);
  if (unmeasured_heights) features.mesh = false;
  exchange::PrinterCorrection correction = exchange::printer_correction(
      machine, axes, features, at, common.tolerance_um, bed, follows_touches ? &fitted : nullptr);
  if (bed && bed->shape && correction.has_mesh()) set_zero(correction, arguments);
  const std::vector<exchange::ConfigurationFile> texts =
      exchange::firmware_files(firmware, present, machine.name, correction);
  const exchange::PrinterErrors errors = exchange::printer_errors(
      machine, axes, follows_touches ? only_heights(correction) : correction, at, bed);
  refuse_without_errors(common, errors.rms_before_um);
  refuse_empty(correction, fitted);
  const std::optional<exchange::TouchResidual> touches =
      bed ? exchange::touch_residual(machine, axes, correction, at, *bed) : std::nullopt;
  require_better_heights(touches);
  const Json files = write_folder(common, texts);
  print_errors(arguments, model, errors, touches, correction.has_mesh() ? correction.mesh.z.mean() : 0);
  print_straight_parts(human_stream(common.json), correction);
  print_include(human_stream(common.json), texts);
  Json extra = errors_json(errors);
  std::vector<exchange::LeftOut> left = remaining(errors.after_um);
  if (!follows_touches) {
    std::vector<double> lost_motion(machine.axes.size(), 0);
    for (std::size_t i = 0; i < axes.axis.size(); ++i) lost_motion[axes.axis[i]] = correction.lost_motion[i];
    for (exchange::LeftOut& one : exchange::beyond_straight_axes(machine, at, features.mesh, lost_motion))
      left.push_back(std::move(one));
  }
  add_unmeasured(left, correction);
  add_scales_without_steps(left, model, axes, features,
                           firmware == Firmware::kKlipper ? "rotation_distance" : "steps per mm",
                           common.tolerance_um);
  if (unmeasured_heights) {
    left.push_back(
        {"heights of the bed: not measured, the files contain no heights (--touches FILE gives the "
         "touches of the bed)"});
    left.back().measured = false;
  }
  add_left_out_of_state(left, machine, axes, correction, at, bed);
  if (bed) {
    extra["bed"] = bed->name;
    if (bed->shape) extra["bed_shape"] = shape_json(*bed->shape);
    if (touches)
      extra["bed_shape"]["residual"] = {{"touches", touches->touches},
                                        {"of_nozzle", touches->of_nozzle},
                                        {"rms_before_um", touches->before_um},
                                        {"rms_after_um", touches->after_um}};
    add_left_out_of_bed(left, *bed, machine);
    extra["errors"]["beyond_bed_um"] = errors.beyond_bed_um;
    if (errors.beyond_bed_um > errors.after_um[2] + exchange::kNothing_um)
      left.push_back(
          {"error along Z by the model that remains with the files outside the touched region of the bed",
           errors.beyond_bed_um});
  }
  const FitOfSquare again =
      correction.unmeasured.empty() || correction.measured("XY") ? FitOfSquare{} : fit_of_square(fitted);
  if (!again.hold.empty()) extra["fit_again"] = {{"hold", again.hold}, {"free", again.free}};
  finish(machine, common, name, left, files, {}, true, extra);
  if (!again.hold.empty()) fmt::print(human_stream(common.json), "{}\n", remedy_of_unmeasured(again));
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
  if (firmware != Firmware::kGrbl)
    command
        ->add_option("--zero", arguments->zero,
                     "zero of the heights with --touches: touches (the heights as they were measured, the "
                     "offset of Z of the printer stays), or middle (0 in the middle of the mesh); default: "
                     "touches, refused if their mean is more than 0.5 mm")
        ->check(CLI::IsMember({kZeroOfTouches, kZeroInTheMiddle}));
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
      "present steps per mm of X, Y and Z; form 40,40,8; without this option the scale is not corrected";
  add_printer(parent, "klipper", "Klipper: skew_correction, bed_mesh and rotation_distance",
              "present rotation_distance of X, Y and Z, mm per turn; form 40,40,8; without this option the "
              "scale is not corrected",
              Firmware::kKlipper);
  add_printer(parent, "rrf", "RepRapFirmware: M556, height map, M92 and M425", kSteps, Firmware::kRepRap);
  add_printer(parent, "marlin", "Marlin: M852, M421, M92 and M425", kSteps, Firmware::kMarlin);
  add_printer(parent, "grbl", "grbl: steps per mm ($100 to $102), the only correction that grbl can store",
              kSteps, Firmware::kGrbl);
}

}  // namespace vernier::commands::exchange_cli
