// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <cstdlib>
#include <mutex>

#include "tools/commands/command.h"
#include "tools/commands/fleet/fleet_kinds.h"
#include "tools/commands/until_told.h"
#include "tools/fleet/ingest.h"
#include "tools/fleet/metrics.h"
#include "tools/text/error.h"
#include "tools/text/wall_time.h"

namespace vernier::commands::fleet_cli {
namespace {

constexpr const char* kPasswordVariable = "VERNIER_MQTT_PASSWORD";

std::string password() {
  const char* const word = std::getenv(kPasswordVariable);
  return word == nullptr ? "" : word;
}

void run_gateway_command(const std::string& path) {
  fleet::GatewayFile file = fleet::parse_gateway_file(text::read_file(path), path);
  file.broker.password = password();
  until_told([&](const std::atomic<bool>& stop) { fleet::run_gateway(file, stop, say_line); });
}

struct MetricsArguments {
  std::string registry, output, listen;
};

void run_metrics(const MetricsArguments& arguments) {
  if (arguments.listen.empty()) {
    registry::Registry registry = open_registry(arguments.registry);
    const std::string text = fleet::metrics_text(registry, text::now_us());
    if (!arguments.output.empty()) return text::write_file(arguments.output, text);
    if (std::fputs(text.c_str(), stdout) == EOF || std::fflush(stdout) != 0)
      throw text::InputError("standard output cannot be written");
    return;
  }
  until_told([&](const std::atomic<bool>& stop) {
    fleet::serve_metrics(arguments.registry, arguments.listen, stop, say_line);
  });
}

}  // namespace

void say_line(const std::string& line) {
  static std::mutex mutex;
  const std::lock_guard lock(mutex);
  fmt::print(stderr, "{}\n", line);
}

void add_services(CLI::App& fleet) {
  const auto file = std::make_shared<std::string>();
  CLI::App* gateway = fleet.add_subcommand("gateway",
                                           "read the state of boards and publish it (Sparkplug B); the "
                                           "gateway stores the samples until the registry has received them");
  gateway->add_option("FILE", *file, "gateway file (TOML): name, broker, store, boards")
      ->type_name(kReads)
      ->required();
  gateway->footer(
      "The gateway runs until it is interrupted. It reads the password of the broker from "
      "VERNIER_MQTT_PASSWORD.\n"
      "Exit status 0 stopped on request, 1 bad input, 70 the store fails (full or broken medium).");
  gateway->callback([file] { run_gateway_command(*file); });

  const auto options = std::make_shared<fleet::IngestOptions>();
  CLI::App* ingest = fleet.add_subcommand(
      "ingest", "write the samples that gateways publish into the registry, each sample once");
  add_registry(*ingest, options->registry);
  ingest->add_option("--broker", options->broker.address, "tcp://HOST:1883 or ssl://HOST:8883")
      ->capture_default_str();
  ingest->add_option("--user", options->broker.user, "user name at the broker");
  ingest
      ->add_option("--authority", options->broker.authority,
                   "file (PEM) with the certificate of the authority that signs the broker's certificate")
      ->type_name(kReads);
  ingest->add_option("--group", options->group, "Sparkplug group of the gateways")->capture_default_str();
  ingest
      ->add_option("--host", options->host,
                   "name of this host application (Sparkplug); the gateway files must state the same name")
      ->capture_default_str();
  ingest->footer(
      "The command runs until it is interrupted, also if the broker or the database is not available for a "
      "time. It reads\n"
      "the password of the broker from VERNIER_MQTT_PASSWORD. Exit status 0 stopped on request, 1 bad "
      "input.");
  ingest->callback([options] {
    fleet::require_broker_address(options->broker.address);
    if (options->registry.empty()) make_registry(options->registry);
    options->broker.password = password();
    until_told([&](const std::atomic<bool>& stop) { fleet::run_ingest(*options, stop, say_line); });
  });

  const auto metrics = std::make_shared<MetricsArguments>();
  CLI::App* command =
      fleet.add_subcommand("metrics", "print or serve the state of the machines in the format of Prometheus");
  add_registry(*command, metrics->registry);
  command
      ->add_option("-o,--output", metrics->output,
                   "output file in the format of node_exporter's textfile collector")
      ->type_name(kWrites);
  command->add_option("--listen", metrics->listen, "serve /metrics at HOST:PORT until interrupted");
  command->footer("Exit status 0 done, 1 bad input or no registry.");
  command->callback([metrics] { run_metrics(*metrics); });
}

}  // namespace vernier::commands::fleet_cli
