// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <set>

#include "tools/commands/certain_steps.h"
#include "tools/commands/command.h"
#include "tools/commands/report_header.h"
#include "tools/commands/survey.h"
#include "tools/compile/compile.h"
#include "tools/diagnose/diagnosis.h"
#include "tools/diagnose/sentences.h"
#include "tools/effects/roles.h"
#include "tools/exchange/printer/bed_shape.h"
#include "tools/exchange/tip_link.h"
#include "tools/format/columns.h"
#include "tools/kinematics/inverse.h"
#include "tools/model/machine_reader.h"
#include "tools/model/rebind.h"
#include "tools/plan/advice.h"
#include "tools/report/report.h"
#include "tools/results/detail.h"
#include "tools/results/diagnosis_json.h"
#include "tools/results/results.h"
#include "tools/results/safety_json.h"
#include "tools/simulate/corrected.h"
#include "tools/simulate/replay.h"
#include "tools/text/error.h"
#include "tools/text/optional_json.h"

namespace vernier::commands::improve_cli {
namespace {

using Json = nlohmann::ordered_json;

struct ImproveArguments {
  SurveyArguments survey;
  std::string output, json;
  std::vector<std::string> effects;
  bool yes = false;
  ReportHeader header;
};

/// A step of the stepwise model that was accepted, and the machine file with it.
struct ModelStep {
  std::string label, effect, add, file, text;
  std::optional<double> rms_um, check_rms_um;      // of lengths
  std::optional<double> rms_urad, check_rms_urad;  // of rotations
};

bool agreed(const ImproveArguments& arguments, const diagnose::LadderStep& step, std::FILE* out) {
  fmt::print(out, "+ {}: rms of fit rows {}, rms of check rows {}\n", step.said,
             results::error_or_dash(step.rms_um, step.rms_urad),
             results::error_or_dash(step.check_rms_um, step.check_rms_urad));
  if (arguments.yes) return true;
  fmt::print(out, "  add it? [y/n] ");
  std::fflush(out);
  std::string answer;
  if (!std::getline(std::cin, answer)) {
    fmt::print(out, "no answer was given: the loop stops (--yes adds effects without asking)\n");
    return false;
  }
  return !answer.empty() && (answer[0] == 'y' || answer[0] == 'Y');
}

/// Cycle time of the simulated loop for a measurement, us: that of the board, or longer if the measurement
/// has more cycles than a few seconds of computing simulate. Lags and slew limits are compiled for this time.
/// Returns nullopt if the measurement is too long even for the longest cycle time.
std::optional<std::uint32_t> cycle_us_of(const model::Measurement& m) {
  constexpr double kMostCycles = 2e7;
  constexpr std::uint32_t kBoard_us = 1000,
                          kLongest_us = 50'000;  // 50 ms: short beside each lag of a machine
  const double duration_us = m.rows() > 0 ? 1e6 * (m.states.time.maxCoeff() - m.states.time.minCoeff()) : 0;
  for (const std::uint32_t cycle : {kBoard_us, 2000U, 5000U, 10'000U, 20'000U, kLongest_us})
    if (duration_us <= kMostCycles * cycle) return cycle;
  return std::nullopt;
}

/// Tool point of a simulated loop, instead of that of the machine file.
constexpr const char* kReflector = "reflector";

/// Readings of the measurement with the running correction of a machine, or the reason why they are unknown.
Json replayed(const ModelStep& model_step, const model::Measurement& rows, const model::Machine& from) {
  try {
    const model::Machine in_file = model::parse_machine(model_step.text, model_step.file);
    const std::optional<model::Machine> at_reflector = exchange::with_tool_point_at_reflector(in_file);
    const model::Machine& machine = at_reflector ? *at_reflector : in_file;
    const model::Measurement m = model::rebind(rows, from, machine);
    const std::optional<std::uint32_t> cycle_us = cycle_us_of(m);
    if (!cycle_us)
      return {{"label", model_step.label},
              {"why_not", "the measurement lasts longer than eleven days; divide it into shorter files"}};
    compile::CompileOptions options;
    options.tick_us = *cycle_us;
    const compile::CompiledMachine compiled = compile::compile_machine(machine, model_step.text, options);
    const auto image = compile::load_image(compiled.image, machine);
    const simulate::ReplayResult r = simulate::replay(*image, m, {});
    Json json = {{"label", model_step.label},
                 {"tick_us", *cycle_us},
                 {"tool_point", at_reflector ? kReflector : "machine file"},
                 {"ticks", r.ticks},
                 {"saturated", r.saturated},
                 {"slewing", r.slewing}};
    const fit::RoleStatistics before = fit::role_statistics(m, r.before, false),
                              after = fit::role_statistics(m, r.after, false),
                              check_before = fit::role_statistics(m, r.before, true),
                              check_after = fit::role_statistics(m, r.after, true);
    const auto put = [&](const std::string& key, const fit::RoleStatistics& statistics) {
      json[key + "_um"] = text::or_null(statistics.rms_um);
      json[key + "_urad"] = text::or_null(statistics.rms_urad);
    };
    put("rms_before", before);
    put("rms_after", after);
    put("check_rms_before", check_before);
    put("check_rms_after", check_after);
    const auto largest = [](const std::optional<double>& fit, const std::optional<double>& check) {
      return text::or_null(fit && check ? std::max(*fit, *check) : fit ? fit : check);
    };
    json["max_before_um"] = largest(before.max_um, check_before.max_um);
    json["max_after_um"] = largest(after.max_um, check_after.max_um);
    json["max_before_urad"] = largest(before.max_urad, check_before.max_urad);
    json["max_after_urad"] = largest(after.max_urad, check_after.max_urad);
    return json;
  } catch (const text::InputError& error) {
    return {{"label", model_step.label}, {"why_not", error.what()}};
  } catch (const text::LimitNotMet& error) {
    return {{"label", model_step.label}, {"why_not", error.what()}};
  }
}

/// One run through all steps.
class Improver {
 public:
  explicit Improver(const ImproveArguments& arguments)
      : arguments_(arguments),
        out_(human_stream(arguments.json)),
        survey_(read_survey(arguments.survey)),
        noise_(estimate_noise(survey_)),
        column_sentences_(effects::complete_columns(survey_.machine, survey_.rows)),
        text_(std::move(survey_.text)),
        machine_(std::move(survey_.machine)),
        first_(machine_),
        rows_(std::move(survey_.rows)),
        all_rows_(rows_),
        effects_(effects::effect_catalogue(arguments.effects)) {}

  void run() {
    constexpr int kMostRounds = 4;
    for (int round = 0; round < kMostRounds; ++round)
      if (!climb(round)) break;
    finish();
  }

 private:
  /// Diagnoses the present machine and adds the effects found. False if no effect is added.
  bool climb(int round) {
    diagnose::DiagnoseOptions options;
    options.effects = effects_;
    Progress progress("diagnose");
    options.progress = [&](double share, const std::string& step) { progress.update(share, step); };
    diagnose::Diagnosis d = diagnose_and_estimate_noise(text_, machine_, rows_, noise_, options);
    add_sentences(d.explanation, column_sentences_);
    add_sentences(d.explanation, noise_sentences(noise_));
    add_sentences(d.explanation, station_advice(d, machine_, rows_).sentences);
    d.next_measurement = plan::advice_for(text_, machine_, rows_, d, effects_);
    if (round == 0 && !d.end.absurd.empty()) throw text::LimitNotMet(d.end.absurd + "; nothing is written");
    last_ = results::diagnosis_json(d, rows_);
    if (round == 0) {
      text::make_folder(arguments_.output);
      first_diagnosis_ = last_;
      const diagnose::LadderStep& given = d.ladder[0];
      take({"the given model after a fit", "", "", "", given.text, given.rms_um, given.check_rms_um,
            given.rms_urad, given.check_rms_urad});
      fmt::print(out_, "the given model after a fit: rms of fit rows {}, rms of check rows {}\n",
                 results::error_or_dash(given.rms_um, given.rms_urad),
                 results::error_or_dash(given.check_rms_um, given.check_rms_urad));
    }
    fmt::print(out_, "verdict: {}. {}\n", diagnose::verdict_name(d.verdict), d.explanation);
    for (const std::string& next : d.next_measurement) fmt::print(out_, "measure next: {}\n", next);
    const std::size_t certain = certain_steps(d);
    open_.clear();
    if (d.verdict == diagnose::Verdict::kAmbiguous && certain == 0) {
      if (const auto step = step_beside_open(d, text_, machine_, rows_, options)) {
        fmt::print(out_,
                   "the first effect has several possible causes; the next is certain with each of them\n");
        if (not_confirmed_at_tool_point(*step) || !agreed(arguments_, *step, out_)) return false;
        add(*step);
        go_on();
        return true;
      }
      open_ = left_open(d);
      fmt::print(out_,
                 "no effect is added: measure the proposed poses and give all files to improve; or add one "
                 "cause with vernier add\n{}\n",
                 open_);
    }
    if (certain == 0) return false;
    for (std::size_t i = 1; i <= certain; ++i) {
      const diagnose::LadderStep& step = d.ladder[i];
      if (not_confirmed_at_tool_point(step)) return false;
      if (!agreed(arguments_, step, out_)) return false;
      add(step);
    }
    go_on();
    return true;
  }

  void add(const diagnose::LadderStep& step) {
    take({"+ " + step.said, step.effect, step.add, "", step.text, step.rms_um, step.check_rms_um,
          step.rms_urad, step.check_rms_urad});
  }

  /// Makes the machine of the last step the present machine.
  void go_on() {
    const model::Machine before = machine_;
    text_ = model_steps_.back().text;
    machine_ = model::parse_machine(text_, arguments_.survey.machine);
    rows_ = model::rebind(rows_, before, machine_);
    // An estimate of u contains the errors that the added effects explain.
    estimate_noise_again(text_, machine_, rows_, noise_);
  }

  /// Returns what the user has although no cause is certain: the machine without the open causes, the size of
  /// what remains, and the command that adds the most likely cause.
  std::string left_open(const diagnose::Diagnosis& d) const {
    const std::string& file = model_steps_.back().file;
    // An estimate of the noise from the residual contains this error: what the effects explain does not.
    const std::optional<double>&all = d.ladder.front().rms_um, &rest = d.ladder.back().rms_um;
    const double left_um = all && rest ? std::sqrt(std::max(0.0, *all * *all - *rest * *rest)) : 0;
    std::string text =
        fmt::format("The file {} is the machine fitted without these causes, for vernier export.", file);
    if (left_um > 0)
      text += fmt::format(" An error of {:.2g} um rms at these readings remains uncorrected.", left_um);
    const std::string choice = choice_of_cause(d, file);
    if (choice.empty()) return text;
    text += " " + choice;
    const bool by_rows = std::any_of(d.causes.begin(), d.causes.end(), [](const auto& cause) {
      return cause.add.find("form=count") != std::string::npos;
    });
    if (by_rows)
      text +=
          " A drift from row to row is a cause only if the rows are in the order of their readings: a table "
          "that is sorted by its positions has another order.";
    return text;
  }

  /// A step that was learned from touches of an offset probe: true, with a sentence, if check rows that touch
  /// with the tool point itself do not confirm it. The probe has another position than the tool, and touches
  /// of one probe do not distinguish the shape of the touched object from an error of a carriage.
  bool not_confirmed_at_tool_point(const diagnose::LadderStep& step) {
    const std::set<std::string> planes = planes_of_probe();
    if (planes.empty()) return false;
    const model::Machine before = model::parse_machine(model_steps_.back().text, model_steps_.back().file),
                         after = model::parse_machine(step.text, arguments_.survey.machine);
    for (const std::string& plane : planes) {
      const exchange::BedShape from(
          exchange::bed_touches(before, model::rebind(all_rows_, first_, before), plane)),
          to(exchange::bed_touches(after, model::rebind(all_rows_, first_, after), plane));
      Json record = {{"effect", step.effect}, {"artefact", plane}, {"check_rows", from.checks}};
      std::string why;
      if (from.checks == 0) {
        why = fmt::format(
            "not added: {}. The rows touch \"{}\" with a probe at ({:g}, {:g}) mm beside the tool point, and "
            "no check row touches it with the tool point. The term may be the shape of \"{}\" or an error at "
            "the probe alone. Touch some points with the tool point (rows with role check, probeX and probeY "
            "0)",
            step.said, plane, from.offset[0], from.offset[1], plane);
      } else if (to.check_rms_um > from.check_rms_um) {
        why = fmt::format(
            "not added: {}. It is not confirmed at the tool point: the rms of the height of \"{}\" at {} "
            "check rows changes from {:.3g} um to {:.3g} um",
            step.said, plane, from.checks, from.check_rms_um, to.check_rms_um);
        record["check_rms_before_um"] = from.check_rms_um, record["check_rms_um"] = to.check_rms_um;
      } else {
        continue;
      }
      fmt::print(out_, "{}\n", why);
      record["why_not"] = std::move(why);
      refused_ = std::move(record);
      return true;
    }
    return false;
  }

  /// Names of the planes that fit rows touched with an offset probe.
  std::set<std::string> planes_of_probe() const {
    std::set<std::string> planes;
    for (std::size_t row = 0; row < all_rows_.rows(); ++row) {
      const std::size_t thing = all_rows_.thing_of(row);
      if (thing == model::kNoThing || all_rows_.check[row] != 0) continue;
      const model::Thing& touched = all_rows_.things[thing];
      if (touched.artefact.type != model::ArtefactType::kPlane) continue;
      for (const char* const name : format::columns::kProbe)
        if (const auto input = first_.find_input(name);
            input && all_rows_.states.input[*input][static_cast<Eigen::Index>(row)] != 0)
          planes.insert(touched.label);
    }
    return planes;
  }

  void take(ModelStep model_step) {
    model_step.file = fmt::format("{}/{}{}.xml", arguments_.output, model_steps_.size(),
                                  model_step.effect.empty() ? "_model" : "_" + model_step.effect);
    text::write_file(model_step.file, model_step.text);
    model_steps_.push_back(std::move(model_step));
  }

  std::string explanation() const {
    std::string last = last_["explanation"].get<std::string>();
    if (!open_.empty()) last += " " + open_;
    return refused_.is_null() ? last : last + " " + refused_["why_not"].get<std::string>() + ".";
  }

  void finish() {
    Json json = {{"machine", first_.name},        {"files", arguments_.survey.measurements},
                 {"verdict", last_["verdict"]},   {"explanation", explanation()},
                 {"noise_um", last_["noise_um"]}, {"noise_urad", last_["noise_urad"]}};
    for (const std::string unit : {"_um", "_urad"}) {
      json["rms_before" + unit] = first_diagnosis_["rms" + unit];
      json["check_rms_before" + unit] = first_diagnosis_["check_rms" + unit];
      json["rms" + unit] = last_["rms" + unit];
      json["check_rms" + unit] = last_["check_rms" + unit];
    }
    json["candidates"] = first_diagnosis_["candidates"];
    if (!refused_.is_null()) json["not_confirmed"] = refused_;
    json["next_measurement"] = last_["next_measurement"];
    for (const ModelStep& model_step : model_steps_) {
      Json step = {{"effect", model_step.effect.empty() ? Json(nullptr) : Json(model_step.effect)},
                   {"add", model_step.add.empty() ? Json(nullptr) : Json(model_step.add)},
                   {"label", model_step.label},
                   {"machine", model_step.file}};
      step["rms_um"] = text::or_null(model_step.rms_um);
      step["check_rms_um"] = text::or_null(model_step.check_rms_um);
      step["rms_urad"] = text::or_null(model_step.rms_urad);
      step["check_rms_urad"] = text::or_null(model_step.check_rms_urad);
      json["ladder"].push_back(step);
    }
    simulate(json);
    judge(json);
    const std::string page = arguments_.output + "/improve.html";
    Json shown = json;
    shown["pictures"] = pictures();
    text::write_file(page, report::improve_report_html(arguments_.header.on(std::move(shown))));
    text::write_file(arguments_.output + "/improve.json", json.dump(1) + "\n");
    write_json(arguments_.json, json);
    fmt::print(out_, "written to {}: {} machine files, improve.json, improve.html\n", arguments_.output,
               model_steps_.size());
  }

  /// Residuals of the given and of the last model against what explained the first ones; none without an
  /// effect.
  Json pictures() const {
    if (model_steps_.size() < 2) return Json::array();
    const auto residuals_of = [&](const ModelStep& step) {
      const model::Machine machine = model::parse_machine(step.text, step.file);
      return fit::residuals(machine, model::rebind(all_rows_, first_, machine));
    };
    const Eigen::VectorXd before = residuals_of(model_steps_.front()),
                          after = residuals_of(model_steps_.back());
    if (before.size() != after.size()) return Json::array();
    return results::before_after_pictures(first_diagnosis_["findings"], first_, all_rows_, before, after);
  }

  /// The same fall in the 1 kHz loop: the correction of the first and of the last machine.
  void simulate(Json& json) {
    json["loop"] = Json::array();
    for (const ModelStep* model_step : {&model_steps_.front(), &model_steps_.back()}) {
      Json r = replayed(*model_step, all_rows_, first_);
      json["loop"].push_back(r);
      if (r.contains("why_not")) {
        fmt::print(out_, "simulated loop with {}: the loop did not run: {}\n", model_step->label,
                   r["why_not"].get<std::string>());
        continue;
      }
      const auto figure = [&](const std::string& key) -> std::optional<double> {
        return r[key].is_null() ? std::nullopt : std::optional(r[key].get<double>());
      };
      const auto error = [&](const std::string& key) {
        return results::error_or_dash(figure(key + "_um"), figure(key + "_urad"));
      };
      const int rate_Hz = 1'000'000 / r["tick_us"].get<int>();
      fmt::print(out_, "{} loop, {}{}: rms of fit rows {} -> {}, rms of check rows {} -> {}\n",
                 rate_Hz == 1000 ? "1 kHz" : fmt::format("{} Hz", rate_Hz), model_step->label,
                 r["tool_point"] == kReflector ? ", with the tool point at the reflector" : "",
                 error("rms_before"), error("rms_after"), error("check_rms_before"),
                 error("check_rms_after"));
      if (const std::string more = leaves_more(*model_step, r); !more.empty()) {
        fmt::print(out_, "  {}\n", more);
        json["loop"].back()["note"] = r["note"] = more;
      }
      json["simulation"] = r;
      if (model_steps_.size() == 1) break;
    }
  }

  /// States why the loop leaves a larger residual than the model, and what to do; empty if it does not.
  std::string leaves_more(const ModelStep& model_step, const Json& r) const {
    constexpr double kMore = 1.2;  // the image is in fixed point, and its axes need not express every error
    const char* unit = model_step.rms_um ? "um" : "urad";
    const std::optional<double> model = model_step.rms_um ? model_step.rms_um : model_step.rms_urad;
    const Json &after = r[fmt::format("rms_after_{}", unit)], &before = r[fmt::format("rms_before_{}", unit)];
    if (!model || !after.is_number() || after.get<double>() <= kMore * *model) return {};
    const bool worse = before.is_number() && after.get<double>() > before.get<double>();
    std::string text =
        fmt::format("the loop leaves {:.3g} {}, the model {:.3g} {}{}: ", after.get<double>(), unit, *model,
                    unit, worse ? ", and without the correction the residual is smaller" : "");
    const double ticks = std::max(1.0, r["ticks"].get<double>()), kOften = 0.01;
    if (r["saturated"].get<double>() > kOften * ticks)
      return text + fmt::format(
                        "the correction is at its limit in {:.0f} % of the cycles; raise maxcorrection "
                        "of the axes in the machine file",
                        100 * r["saturated"].get<double>() / ticks);
    if (r["slewing"].get<double>() > kOften * ticks)
      return text + fmt::format(
                        "the correction changes faster than maxslew allows in {:.0f} % of the cycles; "
                        "raise maxslew of the axes, or measure at a lower speed",
                        100 * r["slewing"].get<double>() / ticks);
    if (!planes_of_probe().empty())
      return text +
             "the rows touch with a probe beside the tool point, and the loop corrects the tool point; "
             "judge the correction by touches with the tool point (rows with probeX and probeY 0)";
    if (!all_rows_.things.empty())
      return text +
             "the fit estimates the position and the tilt of the touched objects with each model, and "
             "the loop moves the axes only; judge the correction by a measurement with the correction "
             "(compare --before OFF.csv --after ON.csv)";
    if (const std::string arm = left_by_arm(model_step); !arm.empty()) return text + arm;
    return text +
           "the axes of the machine cannot express all errors of the model, such as rotations of the "
           "tool or an error in a direction without an axis; vernier compile states what remains";
  }

  /// States what an arm, whose joints correct the tool point only, leaves; empty for other machines.
  static std::string left_by_arm(const ModelStep& model_step) {
    const model::Machine machine = model::parse_machine(model_step.text, model_step.file);
    if (!kinematics::linear_axes(machine).empty()) return {};
    return "the joints correct the tool point, not the direction of the tool, and near a singular pose they "
           "cannot move the tool point in every direction; vernier compile states the share of such poses";
  }

  /// Reports whether the last machine may run. No correction runs yet.
  void judge(Json& json) {
    json["safe_to_run"] = nullptr;
    try {
      const safety::SafetySheet sheet =
          safety::safety_sheet(model::parse_machine(model_steps_.back().text, model_steps_.back().file));
      json["safe_to_run"] = results::safe_to_run_json(sheet);
      const std::vector<std::string> unknown = sheet.not_known();
      // A model that lacks an effect is safe where its rules are met, and is not complete.
      const bool complete = last_["verdict"] == diagnose::verdict_name(diagnose::Verdict::kConsistent);
      fmt::print(
          out_, "{}{}{}\n",
          sheet.ok() ? "safe to run: every rule of the safety sheet is met" : sheet.refusal(),
          unknown.empty() ? "" : fmt::format("; without a value, not judged: {}", fmt::join(unknown, ", ")),
          sheet.ok() && !complete
              ? "; the sheet does not judge whether the model is complete (see the verdict)"
              : "");
    } catch (const text::InputError& error) {
      fmt::print(out_, "safe to run: not judged: {}\n", error.what());
    }
  }

  const ImproveArguments& arguments_;
  std::FILE* out_;
  Survey survey_;
  std::vector<fit::FileNoise> noise_;          // estimates of u
  std::vector<std::string> column_sentences_;  // how undeclared columns got a value in every row
  std::string text_;
  model::Machine machine_, first_;
  model::Measurement rows_, all_rows_;
  std::vector<effects::Effect> effects_;
  std::vector<ModelStep> model_steps_;
  Json first_diagnosis_, last_;
  std::string
      open_;      // what the user has although no cause is certain; empty: a cause is, or nothing is missing
  Json refused_;  // the step that check rows with the tool point do not confirm; null: there is none
};

}  // namespace

void register_improve(CLI::App& vernier) {
  auto arguments = std::make_shared<ImproveArguments>();
  CLI::App* command =
      vernier.add_subcommand("improve", "Repeat diagnose, add and fit until no further effect is named");
  add_survey(*command, arguments->survey);
  command
      ->add_option("-o,--output", arguments->output,
                   "folder for machine files, improve.json and improve.html")
      ->type_name(kWritesFolder)
      ->required();
  command->add_option("--effects", arguments->effects, "files with effects of your own; may be repeated")
      ->type_name(kReads);
  add_report_header(*command, arguments->header);
  command->add_option("--json", arguments->json,
                      "file for the result as JSON, for programs; - for standard output");
  command->add_flag("--yes", arguments->yes,
                    "add every effect that diagnose names, without a question to the user");
  command->footer(
      "The command adds an effect only if the verdict is missing-effect. Each step writes its fitted machine "
      "file. The last\n"
      "line of figures has the residuals of the measurement with the correction in the simulated 1 kHz loop "
      "(a slower loop, stated in\n"
      "the line, for a measurement of more than 5 hours). Exit status 0 done\n"
      "(for every verdict), 1 bad input, 2 the readings are not those of this machine or the fit did not\n"
      "converge: nothing written.");
  command->callback([arguments] { Improver(*arguments).run(); });
}

}  // namespace vernier::commands::improve_cli
