// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <optional>

#include "tools/commands/command.h"
#include "tools/commands/fit_findings.h"
#include "tools/commands/run/board_claim.h"
#include "tools/commands/run/upload_kinds.h"
#include "tools/compile/compile.h"
#include "tools/safety/safety_sheet.h"
#include "tools/text/error.h"
#include "tools/text/numbers.h"
#include "tools/text/wall_time.h"
#include "tools/upload/client.h"
#include "tools/upload/live.h"
#include "tools/upload/open_transport.h"
#include "tools/upload/signing.h"

namespace vernier::commands::upload_cli {
namespace {

struct Arguments {
  std::string directory, url, key, json, output;
  ClaimWords claim;
  std::int64_t security = -1;  // the board's
  bool confirm = false, revert = false, force = false;
};

std::vector<std::uint8_t> read_image(const std::string& directory) {
  const std::string path = directory + "/machine.vimg";
  const std::string text = text::read_file(path);
  std::vector<std::uint8_t> bytes(text.begin(), text.end());
  std::vector<std::uint64_t> words((bytes.size() + 7) / 8);  // aligned
  std::memcpy(words.data(), bytes.data(), bytes.size());
  ImageView view;
  const auto workspace = std::make_unique<ImageWorkspace>();
  const ImageFault fault = view.open(reinterpret_cast<const std::uint8_t*>(words.data()),
                                     static_cast<std::uint32_t>(bytes.size()), *workspace);
  if (fault != ImageFault::kNone) throw text::InputError(path + ": " + describe(fault));
  return bytes;
}

nlohmann::ordered_json slots_json(const SlotsReply& slots) {
  const auto hex = [](std::uint8_t slot, std::uint64_t fingerprint) -> nlohmann::ordered_json {
    if (slot == kNoSlot) return nullptr;
    return text::fingerprint_text(fingerprint);
  };
  return {{"confirmed", upload::confirmed_json(slots)},
          {"trial", hex(slots.trial, slots.trial_fingerprint)},
          {"trial_left_s", slots.trial_left_ms * 1e-3}};
}

/// Evaluates the sheet again: the machine file beside the image may have been changed, or compiled elsewhere.
/// The rules accepted at compilation are in the image.
void require_safe(const std::string& directory) {
  const auto image = compile::load_image_dir(directory);
  repeat_findings(image->machine);
  std::vector<safety::SafetyRule> accepted;
  for (std::size_t rule = 0; rule < safety::kSafetyRuleCount; ++rule)
    if ((image->view.header().accepted_rules >> rule & 1U) != 0)
      accepted.push_back(static_cast<safety::SafetyRule>(rule));
  const safety::SafetySheet sheet = safety::safety_sheet(image->machine, accepted);
  if (!sheet.ok()) throw text::LimitNotMet(sheet.refusal());
}

/// An image must be newer than all images that the board has ever tried. If the clock of this computer is
/// behind them, it is signed right after the newest one on request. The limit of the board is never lowered.
std::uint64_t time_of_signing(const Arguments& arguments, const SlotsReply& slots) {
  const auto now = static_cast<std::uint64_t>(text::now_us());
  if (now > slots.newest_issued) return now;
  if (!arguments.force)
    throw text::LimitNotMet(
        "the clock of this computer is earlier than the signing time of the newest correction image that the "
        "board has run: set the clock, or sign with a time immediately after that image (--force)");
  return slots.newest_issued + 1;
}

std::uint32_t security_of(const Arguments& arguments, const SlotsReply& slots) {
  if (arguments.security < 0) return slots.security;
  if (arguments.security < slots.security)
    throw text::LimitNotMet(
        fmt::format("the security counter of the board is {} and cannot be lowered", slots.security));
  return static_cast<std::uint32_t>(arguments.security);
}

/// Sends the image; its fingerprint.
std::uint64_t send(const Arguments& arguments, upload::Client& client) {
  const std::vector<std::uint8_t> image = safe_image(arguments.directory);
  const auto key = upload::given_key(arguments.key);
  if (!key)
    throw text::InputError(
        "--key is missing: give the file of the secret key with which the command signs the correction image "
        "(`vernier keys` makes a key)");
  const SlotsReply slots = client.slots();
  const auto upload = upload::make_upload(image, *key, time_of_signing(arguments, slots),
                                          security_of(arguments, slots), client.info().board);
  Progress progress("upload");
  client.upload(upload, [&](double share) { progress.update(share); });
  ImageHeader header;
  std::memcpy(&header, image.data(), sizeof(header));
  return header.fingerprint;
}

/// The change that was made to the board, according to its later report.
struct Done {
  std::optional<std::uint64_t> sent, kept;  // fingerprints
  bool given_up = false;
};

text::Assurance vouch(const Arguments& arguments, upload::Client& client, const Done& done,
                      const SlotsReply& slots) {
  text::Assurance assurance(text::AssuranceKind::kUpload);
  vouch_for_board(assurance, arguments.claim, client.info().board);
  const auto require = [&](const char* rule, bool ok, const std::string& image, const char* state) {
    assurance.require(rule, ok, fmt::format("{} is {}{} on the board", image, ok ? "" : "not ", state));
  };
  if (done.kept)
    require("kept", slots.trial == kNoSlot && slots.confirmed_fingerprint == *done.kept,
            text::fingerprint_text(*done.kept), "confirmed");
  else if (done.sent)
    require("on-trial", slots.trial != kNoSlot && slots.trial_fingerprint == *done.sent,
            text::fingerprint_text(*done.sent), "on trial");
  if (done.given_up) require("given-up", slots.trial == kNoSlot, "the image that was on trial", "given up");
  const upload::BoardTick tick = client.newest();
  const upload::BoardState state = client.state();
  const bool all_axes = std::all_of(state.axes.begin(), state.axes.end(),
                                    [](const upload::BoardState::Axis& axis) { return axis.weight >= 1; });
  if (tick.mode != Mode::kActive || tick.fault != Fault::kNone || tick.holding || state.weight < 1 ||
      !all_axes)
    assurance.not_covered(
        fmt::format("whether the image is in effect: the board is in mode {}, fault {}{}, with {:.0f} % of "
                    "the correction active",
                    name_of(tick.mode), name_of(tick.fault),
                    tick.holding ? ", on hold"
                    : all_axes   ? ""
                                 : ", an axis below its full weight",
                    100 * state.weight));
  assurance.not_covered("The accuracy of the machine with this image was not measured");
  return assurance;
}

void tell(const Arguments& arguments, upload::Client& client, const Done& done) {
  const SlotsReply slots = client.slots();
  const text::Assurance assurance = vouch(arguments, client, done, slots);
  std::FILE* const people = human_stream(arguments.json);
  const std::string& board = client.info().board;
  const std::string on = board.empty() ? "a board without a name" : "board " + board;
  if (slots.trial != kNoSlot)
    fmt::print(people,
               "{}: {:016x} runs on trial for {:.0f} s more, then the board returns to its previous image\n"
               "to keep the new image: vernier upload --confirm --to {}{}\n",
               on, slots.trial_fingerprint, slots.trial_left_ms * 1e-3, arguments.url,
               board.empty() ? "" : " --board " + board);
  else
    fmt::print(people, "{}: {}\n", on, upload::confirmed_text(slots));
  for (const std::string& one : assurance.uncovered()) fmt::print(people, "not looked at: {}\n", one);
  nlohmann::ordered_json json = slots_json(slots);
  json["board"] = board;
  json["assurance"] = assurance.json();
  write_json(arguments.json, json);
  for (const text::AssuranceRule& rule : assurance.because())
    if (!rule.ok)
      throw text::LimitNotMet(fmt::format("the board did not execute the request: {}", rule.text));
}

void run(const Arguments& arguments) {
  if (arguments.directory.empty() && !arguments.confirm && !arguments.revert)
    throw text::InputError("no action is requested: name a compiled directory, --confirm or --revert");
  if (arguments.revert && (arguments.confirm || !arguments.directory.empty()))
    throw text::InputError("--revert cannot be combined with DIR or --confirm");
  upload::Client client(upload::open_transport(upload::parse_url(arguments.url)));
  client.sign_with(upload::given_key(arguments.key));
  require_claim(client, arguments.claim);
  Done done;
  if (!arguments.directory.empty()) done.sent = send(arguments, client);
  if (arguments.confirm) {
    const SlotsReply slots = client.slots();
    if (slots.trial != kNoSlot) done.kept = slots.trial_fingerprint;
    if (done.sent && done.kept != done.sent)
      throw text::LimitNotMet(
          "the correction image on trial differs from the image that was sent, so no image was confirmed");
    client.confirm();
  }
  if (arguments.revert) client.revert(), done.given_up = true;
  tell(arguments, client, done);
}

}  // namespace

std::vector<std::uint8_t> safe_image(const std::string& directory) {
  std::vector<std::uint8_t> image = read_image(directory);
  require_safe(directory);
  return image;
}

void register_upload(CLI::App& vernier) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* const command = vernier.add_subcommand("upload",
                                                   "Sign a correction image, send the image to a board and "
                                                   "run the image on trial; confirm or revert the image");
  command->add_option("DIR", arguments->directory, "directory that `vernier compile` wrote")
      ->type_name(kReadsFolder);
  command
      ->add_option("--to", arguments->url,
                   "board: tcp://HOST[:1502], rtu://DEVICE?baud=115200&parity=E&unit=1, "
                   "can://INTERFACE?send=0x600&receive=0x601, "
                   "serial://DEVICE?baud=115200")
      ->required();
  command->add_option("--key", arguments->key, "secret key of `vernier keys` (or VERNIER_KEY)")
      ->type_name(kReads);
  command->add_flag(
      "--confirm", arguments->confirm,
      "confirm the correction image on trial; with DIR: confirm the new image immediately after the upload");
  command->add_flag("--revert", arguments->revert, "revert the image on trial");
  command->add_flag("--force", arguments->force,
                    "sign with a time immediately after the newest image of the board, if the clock of this "
                    "computer is earlier than that image");
  add_board_claim(*command, arguments->claim);
  command
      ->add_option("--security", arguments->security,
                   "new value of the board's security counter: the board never again accepts a correction "
                   "image with a lower value")
      ->check(CLI::Range(std::int64_t{0}, std::int64_t{UINT32_MAX}));
  command->add_option("--json", arguments->json,
                      "file for the result as JSON, for programs; - for standard output");
  command->footer(
      "Exit status: 0 done, 1 bad input or no board, 2 the board refused the request (the message has the "
      "reason), another board answered (nothing was sent), or the board did not execute the request.");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace vernier::commands::upload_cli
