// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <optional>

#include "tools/check/history.h"
#include "tools/commands/command.h"
#include "tools/commands/fleet/fleet_kinds.h"
#include "tools/compile/compile.h"
#include "tools/fleet/check_readings.h"
#include "tools/model/machine_reader.h"
#include "tools/registry/digest.h"
#include "tools/registry/machine_name.h"
#include "tools/registry/open_database.h"
#include "tools/text/error.h"
#include "tools/text/numbers.h"
#include "tools/text/process.h"
#include "tools/text/wall_time.h"
#include "tools/text/words.h"
#include "tools/upload/client.h"
#include "tools/upload/open_transport.h"
#include "tools/upload/url.h"

namespace vernier::commands::fleet_cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kMostDays = 1e5;

struct AddArguments {
  std::string registry, name;
  std::optional<std::string> url, note, board, board_key;
  std::optional<double> check_days;
  bool trust = false;
};

/// The name and key of the board that answers at the machine's address, which the user takes for the right
/// one.
void trust_board(registry::FleetMachine& machine) {
  if (machine.url.empty())
    throw text::InputError(
        {}, machine.name,
        "--trust reads name and key from the board: give the address of the board with --url");
  upload::Client board(upload::open_transport(upload::parse_url(machine.url)));
  if (board.info().board.empty())
    throw text::LimitNotMet(fmt::format(
        "{}: this board has no name, and the registry was not changed; set name in the board file",
        machine.url));
  machine.board = board.info().board;
  const auto key = board.proved_key();
  machine.board_key = key ? upload::board_key_text(*key) : "";
}

/// The description of the board by the user. A name that differs from the previous one is another board,
/// whose key is not known yet.
void enter_board(const AddArguments& arguments, registry::FleetMachine& machine) {
  if (arguments.trust && (arguments.board || arguments.board_key))
    throw text::InputError(
        "--trust reads name and key from the board, --board and --board-key state name and key: give either "
        "--trust or the other two options");
  if (arguments.board && *arguments.board != machine.board)
    machine.board = *arguments.board, machine.board_key.clear();
  if (arguments.board && arguments.board->size() >= kBoardNameBytes)
    throw text::InputError({}, *arguments.board, "this text is too long for the name of a board");
  if (arguments.board_key)
    machine.board_key = arguments.board_key->empty()
                            ? ""
                            : upload::board_key_text(upload::parse_board_key(*arguments.board_key));
  if (!machine.board_key.empty() && machine.board.empty())
    throw text::InputError("--board-key needs --board, the name of the board");
  if (arguments.trust) trust_board(machine);
}

void refuse_known_key(const registry::FleetMachine& machine, const std::vector<registry::FleetMachine>& all) {
  for (const registry::FleetMachine& other : all)
    if (!machine.board_key.empty() && other.name != machine.name && other.board_key == machine.board_key)
      throw text::LimitNotMet(
          fmt::format("this board has the key of the machine {}: one board cannot belong to two machines, "
                      "and the registry was not changed",
                      other.name));
}

void run_add(const AddArguments& arguments) {
  registry::require_machine_name(arguments.name);
  if (arguments.url && !arguments.url->empty()) upload::parse_url(*arguments.url);
  registry::Registry registry = make_registry(arguments.registry);
  registry::FleetMachine machine{arguments.name, {}, {}, 0, text::now_us()};
  // Entries that are not given again are kept.
  for (const registry::FleetMachine& known : registry.machines())
    if (known.name == arguments.name) machine = known;
  if (arguments.url) machine.url = *arguments.url;
  if (arguments.note) machine.note = *arguments.note;
  if (arguments.check_days) machine.check_days = *arguments.check_days;
  enter_board(arguments, machine);
  refuse_known_key(machine, registry.machines());
  registry.put(machine);
  if (arguments.trust)
    fmt::print(stderr,
               "{}: board {} with {} is entered; the name and key are those that the board at {} states\n",
               machine.name, machine.board,
               machine.board_key.empty() ? "no board key" : "key " + machine.board_key, machine.url);
}

struct ListArguments {
  std::string registry, machine, json;
  double stale_s = registry::kStaleAfter_s;
};

Json or_text(const std::string& text) { return text.empty() ? Json(nullptr) : Json(text); }

Json machine_json(const registry::FleetMachine& machine, const registry::RecordedCalibration* runs) {
  Json json = {{"machine", machine.name},
               {"url", or_text(machine.url)},
               {"board", or_text(machine.board)},
               {"board_key", or_text(machine.board_key)},
               {"note", machine.note},
               {"check_days", machine.check_days},
               {"added", text::utc_text(machine.added_us)},
               {"name_allowed", registry::is_machine_name(machine.name)}};
  json["calibration"] = nullptr;
  if (runs != nullptr)
    json["calibration"] = {{"at", text::utc_text(runs->at_us)},
                           {"model", runs->model},
                           {"model_hash", runs->model_hash},
                           {"image", or_text(runs->image)},
                           {"data", runs->data},
                           {"data_hash", runs->data_hash},
                           {"signed_by", runs->signed_by},
                           {"checked_against", runs->checked_against},
                           {"checked_hash", runs->checked_hash}};
  return json;
}

void run_list(const ListArguments& arguments) {
  registry::Registry registry = open_registry(arguments.registry);
  if (!arguments.machine.empty()) registry.machine(arguments.machine);
  const auto calibrations = registry.calibrations(arguments.machine);
  Json all = Json::array();
  std::FILE* const out = human_stream(arguments.json);
  for (const registry::FleetMachine& machine : registry.machines()) {
    if (!arguments.machine.empty() && machine.name != arguments.machine) continue;
    const auto runs = std::find_if(calibrations.begin(), calibrations.end(),
                                   [&](const auto& one) { return one.machine == machine.name; });
    const registry::RecordedCalibration* const newest = runs == calibrations.end() ? nullptr : &*runs;
    all.push_back(machine_json(machine, newest));
    fmt::print(out, "{:<20} {:<28} {}\n", machine.name, machine.url,
               newest == nullptr ? machine.note
                                 : fmt::format("{} {} signed by {} {}", newest->image, newest->model,
                                               newest->signed_by, text::utc_text(newest->at_us)));
    // Entered by an older version, which took other names.
    if (!registry::is_machine_name(machine.name))
      fmt::print(out, "  this name is not allowed: vernier fleet rename {} NEW_NAME\n",
                 text::shell_text("", {machine.name}).substr(1));
  }
  write_json(arguments.json, {{"machines", all}});
}

Json live_json(const registry::LiveState& one, const registry::LiveAge& age) {
  Json json = {{"machine", one.machine},
               {"state", registry::name_of(age.state)},
               {"online", age.state == registry::LiveAge::State::kOnline},
               {"age_s", one.received_us == 0 ? Json(nullptr) : Json(age.age_s)},
               {"gateway", one.gateway},
               {"mode", one.mode},
               {"fault", one.fault},
               {"image", or_text(one.image)},
               {"at", text::utc_text(one.at_us)},
               {"gateway_clock_off", age.clock_off},
               {"gateway_clock_offset_s", one.historical ? Json(nullptr) : Json(age.clock_s)},
               {"waited_in_store", one.historical},
               {"samples", one.samples}};
  for (const auto& [name, value] : one.values) json["values"][name] = Json::parse(value);
  return json;
}

/// One line for people. If the state is not current, mode and fault are reported as the last received ones.
std::string live_line(const registry::LiveState& one, const registry::LiveAge& age) {
  using State = registry::LiveAge::State;
  const char* const word = age.state == State::kOnline  ? "online"
                           : age.state == State::kStale ? "STALE"
                                                        : "AWAY";
  std::string said = one.fault == "none" || one.fault.empty() ? one.mode : one.mode + ", fault " + one.fault;
  if (age.state != State::kOnline) said = "last heard: " + said;
  std::string line =
      fmt::format("{:<20} {:<8} {:<32} {:<17} {} samples", one.machine, word, said, one.image, one.samples);
  if (one.received_us != 0) line += fmt::format(", the last {:.0f} s ago", age.age_s);
  if (one.historical)
    line += fmt::format(", which had waited in the gateway's store since {}", text::utc_text(one.at_us));
  if (age.clock_off)
    line += fmt::format("; the clock of gateway {} has an error of {:+.0f} s", one.gateway, age.clock_s);
  return line;
}

void run_status(const ListArguments& arguments) {
  registry::Registry registry = open_registry(arguments.registry);
  Json all = Json::array();
  std::FILE* const out = human_stream(arguments.json);
  const std::int64_t now_us = registry.database().now_us();
  for (const registry::LiveState& one : registry.live()) {
    if (!arguments.machine.empty() && one.machine != arguments.machine) continue;
    const registry::LiveAge age = registry::live_age(one, now_us, arguments.stale_s);
    all.push_back(live_json(one, age));
    fmt::print(out, "{}\n", live_line(one, age));
    if (arguments.machine.empty()) continue;
    for (const auto& [name, value] : one.values) fmt::print(out, "  {:<40} {}\n", name, value);
  }
  if (!arguments.machine.empty() && all.empty())
    throw text::InputError({}, arguments.machine, "the registry has not received any data of this machine");
  Json unknown = Json::array();
  for (const registry::NotEntered& one : registry.not_entered()) {
    unknown.push_back({{"machine", one.machine},
                       {"gateway", one.gateway},
                       {"samples", one.samples},
                       {"at", text::utc_text(one.at_us)}});
    if (arguments.machine.empty())
      fmt::print(out, "{} samples of {} by gateway {} were not stored: the machine is not in the registry\n",
                 one.samples,
                 one.machine.empty() ? "further machines" : Json(one.machine).dump(-1, ' ', true),
                 Json(one.gateway).dump(-1, ' ', true));
  }
  write_json(arguments.json, {{"machines", all}, {"not_entered", unknown}});
}

struct RecordArguments {
  std::string registry, machine, model, image, signed_by;
  std::vector<std::string> data, against;
};

std::string hash_of_files(const std::vector<std::string>& files) {
  std::string all;
  for (const std::string& file : files) all += registry::digest_of(text::read_file(file));
  return files.empty() ? "" : files.size() == 1 ? all : registry::digest_of(all);
}

void run_record(const RecordArguments& arguments) {
  registry::RecordedCalibration one;
  one.machine = arguments.machine;
  one.model = arguments.model;
  model::read_machine(one.model);  // refuses a file that is not a machine file
  one.model_hash = hash_of_files({arguments.model});
  if (!arguments.image.empty()) {
    const auto image = compile::load_image_dir(arguments.image);
    one.image = text::fingerprint_text(image->view.header().fingerprint);
  }
  one.data = text::joined(arguments.data, " ");
  one.data_hash = hash_of_files(arguments.data);
  one.signed_by = arguments.signed_by;
  one.checked_against = text::joined(arguments.against, " ");
  one.checked_hash = hash_of_files(arguments.against);
  one.at_us = text::now_us();
  registry::Registry registry = open_registry(arguments.registry);
  registry.machine(one.machine);
  registry.put(one);
}

struct CheckArguments {
  std::string registry, machine, result, history, at;
};

void run_check(const CheckArguments& arguments) {
  const std::int64_t now_us = text::now_us(), at_us = time_of(arguments.at, now_us);
  if (at_us > now_us) throw text::InputError({}, arguments.at, "this time is in the future");
  registry::FleetCheck check = fleet::parse_check(text::read_file(arguments.result), arguments.result);
  check.machine = arguments.machine, check.at_us = at_us;
  std::vector<registry::FleetReading> readings;
  if (!arguments.history.empty()) {
    const auto history = check::parse_history(text::read_file(arguments.history), arguments.history);
    if (history.checks.empty())
      throw text::InputError({arguments.history, 0}, "", "the file contains no check");
    check.label = history.checks.back().label;
    readings = fleet::readings_of(history.checks.back(), arguments.machine, at_us);
  }
  registry::Registry registry = open_registry(arguments.registry);
  registry.machine(arguments.machine);
  if (!registry.put(check, readings)) throw text::LimitNotMet("the registry already contains this check");
}

void add_machine_kinds(CLI::App& fleet) {
  const auto add = std::make_shared<AddArguments>();
  CLI::App* command =
      fleet.add_subcommand("add", "add a machine to the registry, or change the entry of a machine");
  command
      ->add_option("MACHINE", add->name,
                   "name of the machine, and name of the device in its MQTT topics: letters, digits, . _ -")
      ->required();
  add_registry(*command, add->registry);
  command->add_option("--url", add->url, "its board: tcp://HOST[:1502], rtu://DEVICE, can://INTERFACE");
  command->add_option("--board", add->board,
                      "name that the machine's board must have (name in the board file)");
  command->add_option("--board-key", add->board_key,
                      "public key of the machine's board: 64 hexadecimal digits (vernier board identify), or "
                      "the file identity.pub of the board");
  command->add_flag("--trust", add->trust,
                    "read name and key from the board at the address, and store both in the registry; use "
                    "this option only if you are sure that the right board is at this address");
  command
      ->add_option("--check-days", add->check_days,
                   "number of days after the last check when the next check is due; 0: no check is due")
      ->check(CLI::Range(0.0, kMostDays));
  command->add_option("--note", add->note, "for people");
  command->callback([add] { run_add(*add); });

  const auto names = std::make_shared<std::array<std::string, 3>>();
  command = fleet.add_subcommand("rename", "rename a machine; all entries of the machine stay");
  command->add_option("MACHINE", (*names)[0], "its name in the registry")->required();
  command->add_option("NEW_NAME", (*names)[1], "letters, digits, . _ - ; the first a letter or digit")
      ->required();
  add_registry(*command, (*names)[2]);
  command->callback([names] { open_registry((*names)[2]).give_name((*names)[0], (*names)[1]); });

  const auto list = std::make_shared<ListArguments>();
  command = fleet.add_subcommand("list", "machines, and the calibration that was last recorded for each");
  command->add_option("MACHINE", list->machine, "only this one");
  add_registry(*command, list->registry);
  command->add_option("--json", list->json,
                      "file for the result as JSON, for programs; - for standard output");
  command->callback([list] { run_list(*list); });

  const auto status = std::make_shared<ListArguments>();
  command = fleet.add_subcommand(
      "status", "newest state of each machine: online, stale or away; mode, fault, correction image");
  command->add_option("MACHINE", status->machine, "show only this machine, with all its values");
  add_registry(*command, status->registry);
  command
      ->add_option("--stale", status->stale_s,
                   "age limit of the newest sample, s: with an older sample the machine is stale, not "
                   "online; a multiple of the gateway's period_s")
      ->check(CLI::Range(0.1, 1e6))
      ->capture_default_str();
  command->add_option("--json", status->json,
                      "file for the result as JSON, for programs; - for standard output");
  command->callback([status] { run_status(*status); });
}

void add_forget(CLI::App& fleet) {
  struct ForgetArguments {
    std::string registry;
    double days = 0;
  };
  const auto forget = std::make_shared<ForgetArguments>();
  CLI::App* command = fleet.add_subcommand("forget", "delete old samples; other data do not change");
  add_registry(*command, forget->registry);
  command->add_option("--days", forget->days, "number of days: older samples are deleted")
      ->required()
      ->check(CLI::Range(0.0, kMostDays));
  command->callback([forget] {
    const auto before = text::now_us() - static_cast<std::int64_t>(forget->days * text::kUsADay);
    fmt::print("{} samples deleted\n", open_registry(forget->registry).forget_samples(before));
  });
}

void add_record_kinds(CLI::App& fleet) {
  const auto record = std::make_shared<RecordArguments>();
  CLI::App* command = fleet.add_subcommand("record",
                                           "record the calibration that a machine uses: model, correction "
                                           "image, measurements, signer, measurements of the check");
  command->add_option("MACHINE", record->machine, "its name in the registry")->required();
  add_registry(*command, record->registry);
  command->add_option("--model", record->model, "machine file (XML)")->type_name(kReads)->required();
  command->add_option("--image", record->image, "directory that `vernier compile` wrote")
      ->type_name(kReadsFolder);
  command->add_option("--data", record->data, "measurement files to which the model was fitted")
      ->type_name(kReads);
  command->add_option("--signed-by", record->signed_by, "person responsible for it")->required();
  command->add_option("--against", record->against, "measurement files with which the model was checked")
      ->type_name(kReads);
  command->footer(
      "The registry stores the name and the hash (BLAKE2b-256) of each file. Exit status 0 done, 1 bad "
      "input.");
  command->callback([record] { run_record(*record); });

  const auto check = std::make_shared<CheckArguments>();
  command = fleet.add_subcommand("check", "record the result of `vernier check` for a machine");
  command->add_option("MACHINE", check->machine, "its name in the registry")->required();
  add_registry(*command, check->registry);
  command->add_option("--result", check->result, "file of `vernier check --json`")
      ->type_name(kReads)
      ->required();
  command
      ->add_option("--history", check->history,
                   "file of `vernier check --history`: the last check in this file gives the changes of the "
                   "parameters, which `alike` compares between machines")
      ->type_name(kReads);
  command->add_option("--at", check->at, "time of the measurement (UTC): 2026-11-23T13:05:00Z; default: now");
  command->footer("Exit status 0 done, 1 bad input, 2 the registry already contains this check.");
  command->callback([check] { run_check(*check); });
}

}  // namespace

void add_registry(CLI::App& command, std::string& place) {
  command.add_option("--registry", place, "postgresql://… or a file (or VERNIER_REGISTRY)")
      ->type_name(kReadsOrServer)
      ->envname("VERNIER_REGISTRY");
}

std::int64_t time_of(const std::string& text, std::int64_t otherwise) {
  if (text.empty()) return otherwise;
  const auto at = text::parse_utc(text);
  if (!at) throw text::InputError({}, text, "expected a time such as 2026-11-23T13:05:00Z");
  return *at;
}

registry::Registry make_registry(const std::string& place) {
  if (place.empty())
    throw text::InputError("--registry is missing: postgresql://USER@HOST/NAME, or a file for one machine");
  return registry::Registry(registry::open_database(place));
}

registry::Registry open_registry(const std::string& place) {
  if (!place.empty() && !registry::is_server(place) && !std::filesystem::exists(place))
    throw text::InputError({}, place, "the registry does not exist; `vernier fleet add` makes a registry");
  return make_registry(place);
}

void register_fleet(CLI::App& vernier) {
  CLI::App* fleet = vernier.add_subcommand(
      "fleet", "Manage many machines: state, due checks, common drift, correction images in stages, batches");
  fleet->require_subcommand(1);
  add_machine_kinds(*fleet);
  add_record_kinds(*fleet);
  add_forget(*fleet);
  add_services(*fleet);
  add_trends(*fleet);
  add_rollout(*fleet);
  add_batch(*fleet);
}

}  // namespace vernier::commands::fleet_cli
