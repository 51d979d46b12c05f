// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/provenance/made_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include "tools/text/error.h"
#include "tools/text/files.h"
#include "tools/text/process.h"
#include "tools/text/words.h"

namespace vernier::provenance {
namespace {

namespace fs = std::filesystem;

/// Files with a provenance in the output folders of `improve` and `compile`.
constexpr std::array kOfFolders = {"improve.json", "bound.json"};

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

std::string file_meant(const std::string& given) {
  if (!fs::is_directory(given)) return given;
  for (const char* name : kOfFolders)
    if (fs::exists(fs::path(given) / name)) return (fs::path(given) / name).string();
  throw text::InputError(
      {given, 0}, "",
      fmt::format("this is a folder without {}: name a file in the folder", fmt::join(kOfFolders, " or ")));
}

/// An absolute path in the command line moves into the mirror.
void move_to(const std::string& root, std::string& word) {
  const std::size_t begin = path_begin(word);
  if (begin < word.size() && word[begin] == '/') word.insert(begin, root);
}

}  // namespace

/// An empty folder, removed at the end. Inside it the files of the computer have their own paths.
class MadeFile::Mirror {
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

MadeFile::MadeFile(const std::string& file_or_folder)
    : file_(file_meant(file_or_folder)),
      content_(text::read_file(file_)),
      whole_folder_(fs::is_directory(file_or_folder)) {
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

std::vector<std::string> MadeFile::changed_inputs() const {
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

std::vector<Remade> MadeFile::remade() const {
  const Mirror mirror;
  for (const ProvenanceInput& input : made_.inputs) mirror.take(at(input.name));
  fs::create_directories(mirror.of(folder_));
  fs::create_directories(mirror.of(place_).parent_path());
  std::vector<std::string> words = made_.command;
  for (std::string& word : words) {
    make_folder_of(word, mirror);
    move_to(mirror.root(), word);
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
  std::sort(files.begin() + 1, files.end(), [](const Remade& a, const Remade& b) { return a.name < b.name; });
  return files;
}

/// The text as this command would have written it at the place of the file.
std::string MadeFile::as_made(const fs::path& made, const Mirror& mirror) const {
  std::string text = text::read_file(made.string());
  replace_in_file(text, mirror.root(), "");
  if (const std::optional<Provenance> by = provenance_of(text, made.string()))
    replace_in_file(text, by->program, made_.program);
  return text;
}

bool MadeFile::is_input(const fs::path& path, const Mirror& mirror) const {
  return std::ranges::any_of(made_.inputs, [&](const ProvenanceInput& input) {
    return mirror.of(at(input.name)) == path.lexically_normal();
  });
}

/// Throws InputError for a command that does more than read and write files, and for a name that leaves the
/// temporary folder.
void MadeFile::require_harmless() const {
  const auto& command = made_.command;
  if (command.empty() || !makes_files_from_files(command.front()))
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

/// A word of the command line can name an output in a folder that exists: so it exists in the mirror.
void MadeFile::make_folder_of(const std::string& word, const Mirror& mirror) const {
  const fs::path folder = at(word.substr(path_begin(word))).parent_path();
  std::error_code none;
  if (fs::is_directory(folder, none)) fs::create_directories(mirror.of(folder));
}

}  // namespace vernier::provenance
