// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <thread>

#include "tables/upload_format.h"
#include "tools/commands/command.h"
#include "tools/commands/description.h"
#include "tools/commands/until_told.h"
#include "tools/text/error.h"
#include "tools/text/files.h"
#include "tools/text/process.h"
#include "tools/upload/client.h"
#include "tools/upload/open_transport.h"
#include "tools/workbench/file_reader.h"
#include "tools/workbench/image_diff.h"
#include "tools/workbench/server.h"

namespace vernier::commands::workbench_cli {
namespace {

struct WorkbenchArguments {
  std::string directory = ".", json;
  std::uint16_t port = 0;
  bool no_browser = false, reader = false;
};

void open_browser(const std::string& url) {
  if (std::getenv("DISPLAY") == nullptr && std::getenv("WAYLAND_DISPLAY") == nullptr) return;
  std::thread([url] {
    text::RunningProcess running;
    try {
      text::run_process(
          "/usr/bin/xdg-open", {url}, "/", 1 << 20, [](std::string_view) {}, running);
    } catch (const text::InputError&) {
      // The address is printed too.
    }
  }).detach();
}

void run_workbench(const WorkbenchArguments& arguments, const CLI::App& vernier) {
  if (arguments.reader) return workbench::serve_files(workbench::Project(arguments.directory), STDIN_FILENO);
  std::optional<workbench::Api> api(std::in_place, arguments.directory,
                                    std::filesystem::read_symlink("/proc/self/exe").string(),
                                    VERNIER_VERSION " (" VERNIER_COMMIT ")", describe(vernier));
  workbench::WorkbenchServer server(*api, arguments.port);
  const auto serve = [&](const std::atomic<bool>&) {
    write_json(arguments.json,
               {{"url", server.url()}, {"port", server.port()}, {"folder", arguments.directory}});
    std::FILE* const out = human_stream(arguments.json);
    fmt::print(out,
               "{}\n"
               "This address works on this computer and for this session only. Ctrl-C ends the workbench.\n",
               server.url());
    std::fflush(nullptr);
    if (!arguments.no_browser) open_browser(server.url());
    server.serve();
    api.reset();  // ends jobs, and the connection to a board, which may wait
  };
  until_told(serve, [&] { server.stop(); });
}

struct DiffArguments {
  std::string directory, with, url, key, json;
};

std::vector<std::uint8_t> image_bytes(const std::string& directory) {
  const std::string text = text::read_file(directory + "/machine.vimg");
  return {text.begin(), text.end()};
}

std::vector<std::uint8_t> board_image(const std::string& url, const std::string& key) {
  upload::Client client(upload::open_transport(upload::parse_url(url)));
  client.sign_with(upload::given_key(key));
  Progress progress("image-diff");
  auto upload =
      client.confirmed([&](double share) { progress.update(share, "reading what the board runs"); });
  if (!upload)
    throw text::LimitNotMet("the store of the board has no image that was confirmed after its trial");
  return upload::image_in(*upload);
}

void run_diff(const DiffArguments& arguments) {
  if (arguments.with.empty() == arguments.url.empty())
    throw text::InputError("give either --with DIR or --to URL");
  const auto mine = image_bytes(arguments.directory);
  const auto other =
      arguments.url.empty() ? image_bytes(arguments.with) : board_image(arguments.url, arguments.key);
  const nlohmann::ordered_json json = workbench::image_diff(mine, other);
  write_json(arguments.json, json);
  std::FILE* const out = human_stream(arguments.json);
  fmt::print(out, "{} {} {}\n", json["a"]["fingerprint"].get<std::string>(),
             json["same"].get<bool>() ? "is the same equation as" : "differs from",
             json["b"]["fingerprint"].get<std::string>());
  for (const auto& name : json["only_a"]) fmt::print(out, "  + {}\n", name.get<std::string>());
  for (const auto& name : json["only_b"]) fmt::print(out, "  - {}\n", name.get<std::string>());
  if (json.contains("why_not"))
    fmt::print(out, "  the corrections of the two images are not compared: {}\n",
               json["why_not"].get<std::string>());
  else
    for (const auto& one : json["corrections"])
      fmt::print(out, "  {}: corrections differ by {:.4g} {} rms, {:.4g} at most\n",
                 one["axis"].get<std::string>(), one["rms"].get<double>(), one["unit"].get<std::string>(),
                 one["max"].get<double>());
}

}  // namespace

void register_workbench(CLI::App& vernier) {
  auto arguments = std::make_shared<WorkbenchArguments>();
  CLI::App* command = vernier.add_subcommand(
      "workbench", "Open the workflow in a browser; only this computer can open the page");
  command->add_option("DIR", arguments->directory, "folder with machines, measurements, images")
      ->type_name(kReadsFolder)
      ->capture_default_str();
  command
      ->add_option("--port", arguments->port,
                   "TCP port of 127.0.0.1 on which the server listens (0: any free port)")
      ->capture_default_str();
  command->add_flag("--no-browser", arguments->no_browser, "only print the address");
  command->add_flag("--reader", arguments->reader, "")->group("");  // started by the server to read files
  command->add_option("--json", arguments->json,
                      "output for programs, {url, port}, when the server is ready; - for standard output");
  command->footer(
      "The server runs until it is interrupted (Ctrl-C). The printed address contains the token of the "
      "session.\n"
      "The page reads and writes only files in DIR, and shows the command of every button "
      "(tools/docs/workbench.md).");
  command->callback([arguments, &vernier] { run_workbench(*arguments, vernier); });
}

void register_image_diff(CLI::App& vernier) {
  auto arguments = std::make_shared<DiffArguments>();
  CLI::App* command = vernier.add_subcommand("image-diff",
                                             "Show the differences between a compiled correction image and "
                                             "another image, or the confirmed image of a board");
  command->add_option("DIR", arguments->directory, "directory that `vernier compile` wrote")
      ->type_name(kReadsFolder)
      ->required();
  command->add_option("--with", arguments->with, "another such directory")->type_name(kReadsFolder);
  command->add_option("--to", arguments->url, "address of the board whose confirmed image is compared");
  command
      ->add_option("--key", arguments->key,
                   "secret key of `vernier keys` (or VERNIER_KEY): a board with keys sends its correction "
                   "image only to the owner of a trusted key")
      ->type_name(kReads);
  command->add_option("--json", arguments->json,
                      "file for the result as JSON, for programs; - for standard output");
  command->footer(
      "Exit status 0 done, 1 bad input or no board, 2 the board's store contains no confirmed image.");
  command->callback([arguments] { run_diff(*arguments); });
}

}  // namespace vernier::commands::workbench_cli
