// SPDX-License-Identifier: GPL-3.0-or-later
#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "tools/commands/command.h"
#include "tools/commands/provenance.h"
#include "tools/text/error.h"

namespace vernier::commands::again_cli {
namespace {

namespace fs = std::filesystem;

std::string as_text(const std::string& text) { return text; }

struct Arguments {
  std::string file, json;
};

/// Files with a provenance in the output folders of `improve` and `compile`.
constexpr std::array kOfFolders = {"improve.json", "bound.json"};

/// An empty folder, removed at the end. Inside it the files of the computer have their own paths.
class Mirror {
 public:
  Mirror() {
    std::string name = (fs::temp_directory_path() / "vernier-again-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr)
      throw text::InputError({name, 0}, "", "cannot be made: the folder for temporary files");
    root_ = fs::canonical(name).string();
  }
  ~Mirror() {
    std::error_code none;
    fs::remove_all(root_, none);
  }
  Mirror(const Mirror&) = delete;
  Mirror& operator=(const Mirror&) = delete;

  const std::string& root() const { return root_; }
  fs::path of(const fs::path& absolute) const { return root_ + absolute.lexically_normal().string(); }
  void take(const fs::path& absolute) const {
    const fs::path place = of(absolute);
    fs::create_directories(place.parent_path());
    if (!fs::exists(place)) fs::copy_file(absolute, place);
  }

 private:
  std::string root_;
};

/// Runs this program in a folder, without output. Returns its exit status.
int run_in(const fs::path& folder, const std::vector<std::string>& words) {
  std::vector<std::string> all = {"vernier"};
  all.insert(all.end(), words.begin(), words.end());
  std::vector<char*> argv;
  for (std::string& word : all) argv.push_back(word.data());
  argv.push_back(nullptr);
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("no process can be started");
  if (child == 0) {
    const int nothing = open("/dev/null", O_RDWR | O_CLOEXEC);
    if (nothing < 0 || chdir(folder.c_str()) != 0) _exit(127);
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) dup2(nothing, stream);
    execv("/proc/self/exe", argv.data());
    _exit(127);
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128;
}

void replace_all(std::string& text, const std::string& what, const std::string& by) {
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size())
    text.replace(at, what.size(), by);
}

/// The first difference of two texts.
struct Difference {
  std::size_t byte = 0, line = 1;  // both from 1
};

Difference first_difference(const std::string& a, const std::string& b) {
  const auto [left, right] = std::mismatch(a.begin(), a.end(), b.begin(), b.end());
  return {static_cast<std::size_t>(left - a.begin()) + 1,
          static_cast<std::size_t>(std::count(a.begin(), left, '\n')) + 1};
}

std::string file_meant(const std::string& given) {
  if (!fs::is_directory(given)) return given;
  for (const char* name : kOfFolders)
    if (fs::exists(fs::path(given) / name)) return (fs::path(given) / name).string();
  throw text::InputError(
      {given, 0}, "",
      fmt::format("is a folder without {}: name a file in it", fmt::join(kOfFolders, " or ")));
}

/// One `vernier again`, step by step.
class Again {
 public:
  explicit Again(const std::string& file) : file_(file_meant(file)), content_(text::read_file(file_)) {
    std::optional<Provenance> made = provenance_of(content_, file_);
    if (!made)
      throw text::InputError(
          {file_, 0}, "",
          "does not say how it was made. Reports (HTML), machine files and JSON results of "
          "this version do; tables (CSV) and programs do not");
    made_ = std::move(*made);
    place_ = fs::weakly_canonical(fs::absolute(file_));
    folder_ = (place_.parent_path() / made_.folder).lexically_normal();
  }

  const std::string& file() const { return file_; }
  const std::string& content() const { return content_; }
  const Provenance& made() const { return made_; }

  /// Inputs that are not the bytes that the command read. Throws InputError if one is missing.
  std::vector<std::string> changed() const {
    std::vector<std::string> names;
    for (const ProvenanceInput& input : made_.inputs) {
      const std::string path = at(input.name).string();
      if (!fs::exists(path))
        throw text::InputError(
            {file_, 0}, input.name,
            "this input is not at " + path + ". Put it there, then repeat `vernier again`");
      if (sha256_of(text::read_file(path)) != input.sha256) names.push_back(input.name);
    }
    return names;
  }

  /// Content of the file, made again from the inputs, with the version of the program that made the file.
  /// Throws LimitNotMet if the command does not make it.
  std::string remade() const {
    const Mirror mirror;
    for (const ProvenanceInput& input : made_.inputs) mirror.take(at(input.name));
    fs::create_directories(mirror.of(folder_));
    fs::create_directories(mirror.of(place_).parent_path());
    std::vector<std::string> words = made_.command;
    for (std::string& word : words) {
      make_folder_of(word, mirror);
      move(word, mirror);
    }
    const int status = run_in(mirror.of(folder_), words);
    const fs::path made = mirror.of(place_);
    if (!fs::exists(made))
      throw text::LimitNotMet(
          fmt::format("{}: the command `vernier {}` ends with status {} and does not make this file", file_,
                      fmt::join(made_.command, " "), status));
    std::string text = text::read_file(made.string());
    for (const auto written : {as_text, in_comment}) replace_all(text, written(mirror.root()), "");
    if (const std::optional<Provenance> by = provenance_of(text, made.string()))
      for (const auto written : {as_text, in_comment})
        replace_all(text, written(by->program), written(made_.program));
    return text;
  }

 private:
  fs::path at(const std::string& name) const { return (folder_ / name).lexically_normal(); }

  /// A word of the command line can name an output in a folder that exists: so it exists in the mirror.
  void make_folder_of(const std::string& word, const Mirror& mirror) const {
    const auto value = word.starts_with("--") ? word.find('=') : std::string::npos;
    const fs::path folder = at(value == std::string::npos ? word : word.substr(value + 1)).parent_path();
    std::error_code none;
    if (fs::is_directory(folder, none)) fs::create_directories(mirror.of(folder));
  }

  /// An absolute path in the command line moves into the mirror.
  static void move(std::string& word, const Mirror& mirror) {
    const auto value = word.starts_with("--") ? word.find("=/") : std::string::npos;
    if (word.starts_with('/'))
      word = mirror.root() + word;
    else if (value != std::string::npos)
      word.insert(value + 1, mirror.root());
  }

  std::string file_, content_;
  Provenance made_;
  fs::path place_, folder_;  // of the file; in which the command ran
};

void run_again(const Arguments& arguments) {
  const Again again(arguments.file);
  const std::vector<std::string> changed = again.changed();
  const std::string remade = again.remade();
  const bool same = remade == again.content();
  nlohmann::ordered_json json = {{"file", again.file()},
                                 {"same", same},
                                 {"bytes", again.content().size()},
                                 {"program", again.made().program},
                                 {"command", again.made().command},
                                 {"changed_inputs", changed}};
  std::FILE* const out = human_stream(arguments.json);
  fmt::print(out, "made by: {}\ncommand: vernier {}\n", again.made().program,
             fmt::join(again.made().command, " "));
  for (const std::string& name : changed) fmt::print(out, "changed since: {}\n", name);
  if (same) {
    fmt::print(out, "{}: made again, all {} bytes are equal\n", again.file(), again.content().size());
    return write_json(arguments.json, json);
  }
  const Difference first = first_difference(again.content(), remade);
  json["first_difference"] = {{"byte", first.byte}, {"line", first.line}};
  write_json(arguments.json, json);
  throw text::LimitNotMet(fmt::format(
      "{}: made again, and the bytes differ from byte {} on (line {}){}", again.file(), first.byte,
      first.line,
      changed.empty() ? "" : ". Inputs have changed since: " + fmt::format("{}", fmt::join(changed, ", "))));
}

}  // namespace

void register_again(CLI::App& vernier) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* const command =
      vernier.add_subcommand("again", "Make a report or result again from its inputs, and compare all bytes");
  command
      ->add_option("file", arguments->file,
                   "report (HTML), machine file (XML), result (JSON), or the folder of improve or compile")
      ->type_name(kReads)
      ->required();
  command->add_option("--json", arguments->json, "result for programs (- is standard output)");
  command->footer(
      "The file says which command made it, in which folder, and the SHA-256 of each\n"
      "input. The command runs in a temporary folder with copies of the inputs. FILE\n"
      "stays as it is.\n"
      "Exit status: 0 all bytes are equal, 1 bad input (no such record, an input is\n"
      "missing), 2 the bytes differ: an input or the program has changed.");
  command->callback([arguments] { run_again(*arguments); });
}

}  // namespace vernier::commands::again_cli
