// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/commands/command.h"

#include <fmt/format.h>

#include "tools/derive/print_equation.h"
#include "tools/model/machine_reader.h"

namespace vernier::commands::derive_cli {
namespace {

constexpr std::size_t kSamples = 200;
constexpr std::uint64_t kSeed = 20260101;

struct Arguments {
  std::string machine, output, json;
  bool latex = false;
  derive::ErrorSizes sizes;
};

void run_derive(const Arguments& arguments) {
  derive::DerivedMachine derived{
      derive::derive(model::read_machine(arguments.machine), arguments.sizes), {}, {}, kSamples};
  derived.bound = derive::bound_second_order(derived.equation);
  derived.sampled = derive::sample_second_order(derived.equation, kSamples, kSeed);
  const std::string text = arguments.latex ? derive::print_latex(derived) : derive::print_text(derived);
  if (!arguments.output.empty()) text::write_file(arguments.output, text);
  write_json(arguments.json, arguments.json.empty() ? nlohmann::ordered_json{} : derive::to_json(derived));
  if (arguments.output.empty())
    fmt::print(human_stream(arguments.json), "{}", text);
  else
    fmt::print(human_stream(arguments.json), "{}: {} errors\n", arguments.output,
               derived.equation.parameters.size());
}

}  // namespace

void register_derive(CLI::App& vernier) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* const command = vernier.add_subcommand(
      "derive", "Derive the error equation in symbols (text, LaTeX) with a bound of its second order");
  command->add_option("machine", arguments->machine, "machine file (XML)")->type_name(kReads)->required();
  command->add_flag("--latex", arguments->latex, "write the equation as LaTeX (amsmath) instead of text");
  command->add_option("-o,--output", arguments->output, "file for the equation (default: standard output)")
      ->type_name(kWrites);
  command->add_option("--json", arguments->json,
                      "file for the result as JSON, for programs; - for standard output");
  command
      ->add_option("--length", arguments->sizes.length_mm,
                   "size of a length error for the bound, mm, if the machine file does not state the scale")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber);
  command
      ->add_option("--angle", arguments->sizes.angle_rad,
                   "size of an angle error for the bound, rad, if the machine file does not state the scale")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber);
  command
      ->add_option("--number", arguments->sizes.number,
                   "size of another error for the bound, in the unit of the error, if the machine file does "
                   "not state the scale")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber);
  command->callback([arguments] { run_derive(*arguments); });
}

}  // namespace vernier::commands::derive_cli
