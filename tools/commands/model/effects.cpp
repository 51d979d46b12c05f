// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>

#include "tools/commands/command.h"
#include "tools/effects/add_string.h"
#include "tools/effects/candidate.h"
#include "tools/effects/fitted_effect.h"
#include "tools/model/machine_reader.h"
#include "tools/text/error.h"
#include "tools/text/files.h"

namespace vernier::commands::effects_cli {
namespace {

struct EffectsArguments {
  std::string id, json;
  std::vector<std::string> files;
};

struct AddArguments {
  std::string effect, machine, output, json;
  std::vector<std::string> files;
};

nlohmann::ordered_json effect_json(const effects::Effect& effect) {
  nlohmann::ordered_json json = {{"id", effect.id},
                                 {"title", effect.title},
                                 {"formula", effect.formula},
                                 {"signature", effect.signature},
                                 {"exposed_by", effect.exposed_by},
                                 {"impostors", effect.impostors}};
  for (const effects::EffectForm& form : effect.forms)
    json["forms"].push_back(
        {{"label", form.label}, {"place", effects::place_name(form.place)}, {"term", form.term}});
  return json;
}

void print_effect(std::FILE* out, const effects::Effect& effect) {
  fmt::print(out, "{}: {}\n  term         {}\n  signature    {}\n  exposed by   {}\n  confused with",
             effect.id, effect.title, effect.formula, effect.signature, effect.exposed_by);
  for (const std::string& other : effect.impostors) fmt::print(out, " {}", other);
  fmt::print(out, "\n");
  if (effect.size && !effect.size->name.empty())
    fmt::print(out, "  size         {} = {} {}\n", effect.size->name, effect.size->factor,
               fmt::join(effect.size->unknowns, " "));
  for (const effects::EffectForm& form : effect.forms)
    fmt::print(out, "  form {:<12} at {:<7} {}\n", form.label, effects::place_name(form.place), form.term);
}

void run_effects(const EffectsArguments& arguments) {
  std::vector<effects::Effect> all = effects::effect_catalogue(arguments.files);
  if (arguments.id == effects::custom_effect().id) all.push_back(effects::custom_effect());
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  std::FILE* out = human_stream(arguments.json);
  bool found = false;
  for (const effects::Effect& effect : all) {
    if (!arguments.id.empty() && effect.id != arguments.id) continue;
    found = true;
    json.push_back(effect_json(effect));
    if (arguments.id.empty())
      fmt::print(out, "{:<20} {:<52} {}\n", effect.id, effect.title, effect.formula);
    else
      print_effect(out, effect);
  }
  if (!found)
    throw text::InputError(
        fmt::format("\"{}\": unknown effect (`vernier effects` lists them)", arguments.id));
  write_json(arguments.json, json);
}

void run_add(const AddArguments& arguments) {
  effects::MachineText with = effects::machine_text(text::read_file(arguments.machine), arguments.machine);
  const model::Machine machine = with.machine;
  const std::vector<effects::Effect> effects = effects::effect_catalogue(arguments.files);
  const effects::Candidate candidate =
      effects::put_in(with, effects::parse_add_string(arguments.effect, machine, effects));
  text::write_file(arguments.output, with.text);
  nlohmann::ordered_json json = {
      {"effect", candidate.choice.effect->id}, {"label", candidate.label}, {"said", candidate.spoken}};
  for (const effects::CandidateTerm& term : candidate.terms)
    json["terms"].push_back({{"branch", term.place.workpiece ? "workpiece" : "tool"},
                             {"transform", effects::transform_at(machine, term.place).n},
                             {"dof", effects::dof_name(machine, term.place)},
                             {"term", term.text}});
  for (const effects::CandidateUnknown& unknown : candidate.unknowns)
    json["statics"].push_back({{"name", unknown.name}, {"start", unknown.start}, {"unit", unknown.unit}});
  write_json(arguments.json, json);
  std::FILE* out = human_stream(arguments.json);
  fmt::print(out, "added {} ({})\n", candidate.spoken, candidate.label);
  for (const effects::CandidateTerm& term : candidate.terms)
    fmt::print(out, "  {} of transform {}: + {}\n", effects::dof_name(machine, term.place),
               effects::transform_at(machine, term.place).n, term.text);
  fmt::print(out, "the coefficients of the effect are not fitted yet; next: vernier fit {} MEAS -o FITTED\n",
             arguments.output);
}

}  // namespace

void register_effects(CLI::App& vernier) {
  auto arguments = std::make_shared<EffectsArguments>();
  CLI::App* command = vernier.add_subcommand("effects", "Print the catalogue of effects");
  command->add_option("ID", arguments->id, "id of an effect: print only this effect, with its forms");
  command->add_option("--effects", arguments->files, "files with effects of your own; may be repeated")
      ->type_name(kReads);
  command->add_option("--json", arguments->json,
                      "file for the result as JSON, for programs; - for standard output");
  command->footer(
      "Write your own effects into a text file (no recompilation is necessary): see tools/docs/effects.md.");
  command->callback([arguments] { run_effects(*arguments); });
}

void register_add(CLI::App& vernier) {
  auto arguments = std::make_shared<AddArguments>();
  CLI::App* command = vernier.add_subcommand("add", "Add an effect to the chain of a machine file");
  command
      ->add_option("EFFECT", arguments->effect,
                   "effect to add: the `add` string of a candidate, or ID:axis=X,...")
      ->required();
  command->add_option("MACHINE", arguments->machine, "machine file (XML)")->type_name(kReads)->required();
  command->add_option("-o,--output", arguments->output, "the new machine file")
      ->type_name(kWrites)
      ->required();
  command->add_option("--effects", arguments->files, "files with effects of your own; may be repeated")
      ->type_name(kReads);
  command->add_option("--json", arguments->json,
                      "file for the result as JSON, for programs; - for standard output");
  command->footer(
      "Keys: axis, axis2, input, input2, branch, transform (its n), dof, reference, unit, form, sum, from, "
      "to, runs,\n"
      "start.NAME, and for ID custom as the last one term=EXPRESSION with the unknown k. Coefficients start "
      "at 0 with\n"
      "nominal 0, so the predictions of the model do not change until a fit. Exit status 0 done, 1 bad input "
      "(nothing written).");
  command->callback([arguments] { run_add(*arguments); });
}

}  // namespace vernier::commands::effects_cli
