// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <chrono>
#include <cstdlib>
#include <cstring>
#include <memory>

#include "tools/commands/command.h"
#include "tools/compile/compile.h"
#include "tools/safety/safety_sheet.h"
#include "tools/text/error.h"
#include "tools/upload/client.h"
#include "tools/upload/signing.h"

namespace vernier::upload_cli {
namespace {

struct Arguments {
  std::string directory, url, key, json, output;
  bool confirm = false, revert = false, force = false;
};

std::vector<std::uint8_t> read_image(const std::string& directory) {
  const std::string path = directory + "/machine.vimg";
  const std::string text = read_file(path);
  std::vector<std::uint8_t> bytes(text.begin(), text.end());
  std::vector<std::uint64_t> words((bytes.size() + 7) / 8);  // aligned
  std::memcpy(words.data(), bytes.data(), bytes.size());
  ImageView view;
  const auto workspace = std::make_unique<ImageWorkspace>();
  const ImageFault fault = view.open(reinterpret_cast<const std::uint8_t*>(words.data()),
                                     static_cast<std::uint32_t>(bytes.size()), *workspace);
  if (fault != ImageFault::kNone) throw InputError(path + ": " + describe(fault));
  return bytes;
}

std::uint64_t now_us() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::microseconds>(now).count());
}

std::string key_path(const Arguments& arguments) {
  if (!arguments.key.empty()) return arguments.key;
  if (const char* const path = std::getenv("VERNIER_KEY"); path != nullptr && *path != '\0') return path;
  throw InputError("--key is missing: the secret key that signs the image (`vernier keys` makes one)");
}

nlohmann::ordered_json slots_json(const SlotsReply& slots) {
  const auto hex = [](std::uint8_t slot, std::uint64_t fingerprint) -> nlohmann::ordered_json {
    if (slot == kNoSlot) return nullptr;
    return fmt::format("{:016x}", fingerprint);
  };
  return {{"confirmed", hex(slots.confirmed, slots.confirmed_fingerprint)},
          {"trial", hex(slots.trial, slots.trial_fingerprint)},
          {"trial_left_s", slots.trial_left_ms * 1e-3}};
}

/// The sheet once more: the machine file beside the image may have been changed, or compiled elsewhere. What
/// was accepted at compilation stands in the image.
void require_safe(const std::string& directory) {
  const auto image = load_image_dir(directory);
  std::vector<SafetyRule> accepted;
  for (std::size_t rule = 0; rule < kSafetyRuleCount; ++rule)
    if ((image->view.header().accepted_rules >> rule & 1U) != 0)
      accepted.push_back(static_cast<SafetyRule>(rule));
  const SafetySheet sheet = safety_sheet(image->machine, accepted);
  if (!sheet.ok()) throw LimitNotMet(sheet.refusal());
}

void send(const Arguments& arguments, Client& client) {
  const std::vector<std::uint8_t> image = read_image(arguments.directory);
  require_safe(arguments.directory);
  const SigningKey key = read_secret_key(key_path(arguments));
  const SlotsReply slots = client.slots();
  // A forced upload names what it replaces, so that nobody can force it a second time over something else.
  const auto upload = make_upload(image, key, now_us(), arguments.force ? slots.issued : 0);
  Progress progress("upload");
  client.upload(upload, [&](double share) { progress.update(share); });
}

void run(const Arguments& arguments) {
  if (arguments.directory.empty() && !arguments.confirm && !arguments.revert)
    throw InputError("nothing to do: name a compiled directory, --confirm or --revert");
  if (arguments.revert && (arguments.confirm || !arguments.directory.empty()))
    throw InputError("--revert stands alone");
  Client client(open_transport(parse_url(arguments.url)));
  if (!arguments.directory.empty()) send(arguments, client);
  if (arguments.confirm) client.confirm();
  if (arguments.revert) client.revert();
  const SlotsReply slots = client.slots();
  std::FILE* const people = human_stream(arguments.json);
  if (slots.trial != kNoSlot)
    fmt::print(people,
               "{:016x} runs on trial for {:.0f} s more, then the board goes back to what it ran before\n"
               "keep it: vernier upload --confirm --to {}\n",
               slots.trial_fingerprint, slots.trial_left_ms * 1e-3, arguments.url);
  else if (slots.confirmed != kNoSlot)
    fmt::print(people, "{:016x} is confirmed\n", slots.confirmed_fingerprint);
  else
    fmt::print(people, "the board has no confirmed image\n");
  write_json(arguments.json, slots_json(slots));
}

}  // namespace

void register_upload(CLI::App& vernier) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* const command = vernier.add_subcommand(
      "upload", "sign a compiled image, bring it to a board and try it; keep or revert it");
  command->add_option("DIR", arguments->directory, "directory that `vernier compile` wrote");
  command
      ->add_option("--to", arguments->url,
                   "board: tcp://HOST[:1502], rtu://DEVICE?baud=115200&parity=E&unit=1, "
                   "can://INTERFACE?send=0x600&receive=0x601, "
                   "serial://DEVICE?baud=115200")
      ->required();
  command->add_option("--key", arguments->key, "secret key of `vernier keys` (or VERNIER_KEY)");
  command->add_flag("--confirm", arguments->confirm, "keep the image on trial; with DIR: at once");
  command->add_flag("--revert", arguments->revert, "give the image on trial up");
  command->add_flag("--force", arguments->force, "even where the board's clock of images says it is older");
  command->add_option("--json", arguments->json, "result for programs; - is standard output");
  command->footer("Exit status: 0 done, 1 bad input or no board, 2 the board refuses (and says why).");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace vernier::upload_cli
