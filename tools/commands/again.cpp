// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <fmt/ranges.h>

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
#include "tools/text/process.h"
#include "tools/text/words.h"

namespace vernier::commands::again_cli {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  std::string file, json;
};

/// Files with a provenance in the output folders of `improve` and `compile`.
constexpr std::array kOfFolders = {"improve.json", "bound.json"};
/// Commands that only read and write files. A record can come from anybody: no other command runs.
constexpr std::array kOfFiles = {
    "add",     "ballbar-path", "check",    "compare", "compile", "correct",  "derive", "diagnose", "evaluate",
    "exclude", "export",       "features", "fit",     "import",  "improve",  "lint",   "map",      "new",
    "part",    "plan",         "pose",     "replay",  "set",     "simulate", "solve"};

/// An empty folder, removed at the end. Inside it the files of the computer have their own paths.
class Mirror {
 public:
  Mirror() {
    std::error_code none;
    std::string name = (fs::temp_directory_path(none) / "vernier-again-XXXXXX").string();
    if (none || mkdtemp(name.data()) == nullptr)
      throw text::InputError({name, 0}, "", "the folder for temporary files cannot be created");
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

/// Runs this program in a folder. Returns its exit status.
int run_in(const fs::path& folder, const std::vector<std::string>& words) {
  constexpr std::size_t kMostBytes = std::size_t{1} << 30;  // that the command may print
  text::RunningProcess running;
  return text::run_process(
             "/proc/self/exe", words, folder.string(), kMostBytes, [](std::string_view) {}, running)
      .exit;
}

/// Position of the path in a word of a command line: FILE, --option=FILE, -oFILE.
std::size_t path_begin(const std::string& word) {
  constexpr std::size_t kShortOption = 2;
  if (word.starts_with("--")) return word.find('=') == std::string::npos ? 0 : word.find('=') + 1;
  return word.starts_with('-') && word.size() > kShortOption ? kShortOption : 0;
}

/// Replaces a text as it stands in a page, and as it stands in the record of the page.
void replace_in_file(std::string& text, const std::string& what, const std::string& by) {
  text::replace_all(text, what, by);
  text::replace_all(text, in_comment(what), in_comment(by));
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
  explicit Again(const std::string& file)
      : file_(file_meant(file)), content_(text::read_file(file_)), whole_folder_(fs::is_directory(file)) {
    std::optional<Provenance> made = provenance_of(content_, file_);
    if (!made)
      throw text::InputError(
          {file_, 0}, "",
          "this file has no record of how it was made. Reports (HTML), machine files and JSON results of "
          "this version have a record; tables (CSV) and programs have no record");
    made_ = std::move(*made);
    place_ = fs::weakly_canonical(fs::absolute(file_));
    folder_ = (place_.parent_path() / made_.folder).lexically_normal();
    require_harmless();
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
            "this input is not at " + path + ". Put the input there, then repeat `vernier again`");
      if (sha256_of(text::read_file(path)) != input.sha256) names.push_back(input.name);
    }
    return names;
  }

  /// A file and its content, made again.
  struct Remade {
    std::string name, text;
  };

  /// The file, made again from the inputs, with the version of the program that made the file; and every
  /// other file that the command makes in its folder, if the user named a folder. Throws LimitNotMet if the
  /// command does not make the file.
  std::vector<Remade> remade() const {
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
    std::vector<Remade> files = {{file_, as_made(made, mirror)}};
    if (!whole_folder_) return files;
    for (const fs::directory_entry& other : fs::recursive_directory_iterator(made.parent_path()))
      if (other.is_regular_file() && other.path() != made && !is_input(other.path(), mirror))
        files.push_back(
            {(fs::path(file_).parent_path() / other.path().lexically_relative(made.parent_path())).string(),
             as_made(other.path(), mirror)});
    std::sort(files.begin() + 1, files.end(),
              [](const Remade& a, const Remade& b) { return a.name < b.name; });
    return files;
  }

 private:
  /// The text as this command would have written it at the place of the file.
  std::string as_made(const fs::path& made, const Mirror& mirror) const {
    std::string text = text::read_file(made.string());
    replace_in_file(text, mirror.root(), "");
    if (const std::optional<Provenance> by = provenance_of(text, made.string()))
      replace_in_file(text, by->program, made_.program);
    return text;
  }

  bool is_input(const fs::path& path, const Mirror& mirror) const {
    return std::ranges::any_of(made_.inputs, [&](const ProvenanceInput& input) {
      return mirror.of(at(input.name)) == path.lexically_normal();
    });
  }

  /// Throws InputError for a command that does more than read and write files, and for a name that leaves the
  /// temporary folder.
  void require_harmless() const {
    const auto& command = made_.command;
    if (command.empty() || std::ranges::find(kOfFiles, command.front()) == kOfFiles.end())
      throw text::InputError({file_, 0}, command.empty() ? "" : command.front(),
                             "the record contains a command that does not make output files from input "
                             "files; `vernier again` does not run this command");
    // Above the root of the computer there is nothing, but above that of the temporary folder there is.
    const auto depth = std::distance(folder_.begin(), folder_.end()) - 1;
    for (const std::string& word : command) {
      std::ptrdiff_t up = 0;
      for (std::size_t at = 0; (at = word.find("..", at)) != std::string::npos; at += 2) ++up;
      if (up > depth)
        throw text::InputError({file_, 0}, word,
                               "this file name has too many \"..\": it leads out of the temporary folder in "
                               "which the command runs again");
    }
  }

  fs::path at(const std::string& name) const { return (folder_ / name).lexically_normal(); }

  /// A word of the command line can name an output in a folder that exists: so it exists in the mirror.
  void make_folder_of(const std::string& word, const Mirror& mirror) const {
    const fs::path folder = at(word.substr(path_begin(word))).parent_path();
    std::error_code none;
    if (fs::is_directory(folder, none)) fs::create_directories(mirror.of(folder));
  }

  /// An absolute path in the command line moves into the mirror.
  static void move(std::string& word, const Mirror& mirror) {
    const std::size_t begin = path_begin(word);
    if (begin < word.size() && word[begin] == '/') word.insert(begin, mirror.root());
  }

  std::string file_, content_;
  bool whole_folder_ = false;
  Provenance made_;
  fs::path place_, folder_;  // of the file; in which the command ran
};

void run_again(const Arguments& arguments) {
  const Again again(arguments.file);
  const std::vector<std::string> changed = again.changed();
  const std::vector<Again::Remade> remade = again.remade();
  nlohmann::ordered_json json = {{"file", again.file()},
                                 {"same", true},
                                 {"files", remade.size()},
                                 {"bytes", again.content().size()},
                                 {"program", again.made().program},
                                 {"command", again.made().command},
                                 {"changed_inputs", changed}};
  std::FILE* const out = human_stream(arguments.json);
  fmt::print(out, "made by: {}\ncommand: vernier {}\n", again.made().program,
             fmt::join(again.made().command, " "));
  for (const std::string& name : changed) fmt::print(out, "changed since: {}\n", name);
  for (const Again::Remade& one : remade) {
    const std::string now = fs::exists(one.name) ? text::read_file(one.name) : "";
    if (now == one.text) {
      fmt::print(out, "{}: made again, all {} bytes are equal\n", one.name, now.size());
      continue;
    }
    const Difference first = first_difference(now, one.text);
    json["same"] = false;
    json["first_difference"] = {{"file", one.name}, {"byte", first.byte}, {"line", first.line}};
    write_json(arguments.json, json);
    throw text::LimitNotMet(fmt::format(
        "{}: made again, and the bytes differ from byte {} on (line {}){}", one.name, first.byte, first.line,
        changed.empty() ? ""
                        : ". Inputs have changed since: " + fmt::format("{}", fmt::join(changed, ", "))));
  }
  write_json(arguments.json, json);
}

}  // namespace

void register_again(CLI::App& vernier) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* const command = vernier.add_subcommand(
      "again", "Make a report or result again from the same inputs, and compare all bytes");
  command
      ->add_option("file", arguments->file,
                   "report (HTML), machine file (XML), result (JSON), or the folder of improve or compile")
      ->type_name(kReads)
      ->required();
  command->add_option("--json", arguments->json, "result for programs (- is standard output)");
  command->footer(
      "FILE contains a record: the command that made the file, its folder, and the SHA-256 of each\n"
      "input file. `vernier again` runs this command in a temporary folder with copies of the inputs,\n"
      "and does not change FILE.\n"
      "Exit status: 0 all bytes are equal, 1 bad input (FILE has no record, or an input is missing),\n"
      "2 the bytes differ, because an input or the program has changed.");
  command->callback([arguments] { run_again(*arguments); });
}

}  // namespace vernier::commands::again_cli
