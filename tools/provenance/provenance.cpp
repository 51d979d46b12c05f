// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/provenance/provenance.h"

#include <fmt/format.h>
#include <sodium.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <string_view>
#include <utility>

#include "tools/text/error.h"
#include "tools/text/file_hooks.h"
#include "tools/text/words.h"

namespace vernier::provenance {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Commands that only read and write files: their results do not depend on a board, a server, a fleet or a
/// key.
constexpr std::array kOfFiles = {
    "add",     "ballbar-path", "check",    "compare", "compile", "correct",  "derive", "diagnose", "evaluate",
    "exclude", "export",       "features", "fit",     "import",  "improve",  "lint",   "map",      "new",
    "part",    "plan",         "pose",     "replay",  "set",     "simulate", "solve"};

constexpr std::string_view kOpen = "<!-- made by: ", kClose = " -->";

enum class Kind : std::uint8_t { kOther, kMarkup, kJson };

/// HTML pages and machine files take a comment, JSON objects take a key.
Kind kind_of(const std::string& text) {
  const auto first = text.find_first_not_of(" \t\r\n");
  const auto last = text.find_last_not_of(" \t\r\n");
  if (first == std::string::npos) return Kind::kOther;
  if (text[first] == '{' && text[last] == '}') return Kind::kJson;
  const std::string begin = text::in_small_letters(text.substr(first, 64));
  const bool page = begin.starts_with("<!doctype html");
  const bool machine = text[first] == '<' && text.find("<machine") != std::string::npos && text[last] == '>';
  return page || machine ? Kind::kMarkup : Kind::kOther;
}

/// Position of the last comment with a provenance; npos without.
std::size_t comment_in(const std::string& text) { return text.rfind(kOpen); }

std::string without_comment(std::string text) {
  for (std::size_t at = 0; (at = comment_in(text)) != std::string::npos;) {
    const auto end = text.find(kClose, at);
    if (end == std::string::npos) break;
    const std::size_t line_break = end + kClose.size() < text.size() && text[end + kClose.size()] == '\n';
    text.erase(at, end + kClose.size() + line_break - at);
  }
  return text;
}

/// `--json -` prints the result and changes no file.
std::vector<std::string> without_printed_json(const std::vector<std::string>& arguments) {
  std::vector<std::string> kept;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (arguments[i] == "--json=-") continue;
    if (arguments[i] == "--json" && i + 1 < arguments.size() && arguments[i + 1] == "-")
      ++i;
    else
      kept.push_back(arguments[i]);
  }
  return kept;
}

/// Records what this process reads and writes.
class Recorder {
 public:
  Recorder(const std::vector<std::string>& arguments, std::string program)
      : command_(without_printed_json(arguments)), program_(std::move(program)) {}

  void was_read(const std::string& path, const std::string& text) {
    std::error_code none;
    if (!fs::is_regular_file(path, none) || written_.contains(fs::weakly_canonical(path, none).string()))
      return;
    inputs_[path] = sha256_of(text);
    texts_.insert(inputs_[path]);
  }

  std::string with_provenance(const std::string& path, const std::string& text) {
    std::error_code none;
    written_.insert(fs::weakly_canonical(path, none).string());
    const Kind kind = kind_of(text);
    if (kind == Kind::kOther || texts_.contains(sha256_of(text))) return text;
    const Json made = record_for(path);
    if (kind == Kind::kMarkup) {
      std::string marked = without_comment(text);
      if (marked.empty() || marked.back() != '\n') marked += '\n';
      return marked + std::string(kOpen) + in_comment(made.dump()) + std::string(kClose) + "\n";
    }
    if (!Json::accept(text)) return text;
    const std::string open = text.substr(0, text.find_last_of('}'));
    const auto last = open.find_last_not_of(" \t\r\n");
    return open.substr(0, last + 1) + (open[last] == '{' ? "" : ",") + "\n \"made_by\": " + made.dump() +
           "\n}\n";
  }

 private:
  Json record_for(const std::string& path) const {
    std::error_code none;
    const fs::path here = fs::current_path(none);
    const fs::path place = fs::weakly_canonical(fs::absolute(path, none), none).parent_path();
    Json inputs = Json::array();
    for (const auto& [name, sum] : inputs_)
      inputs.push_back(
          {{"name", fs::path(name).is_absolute() ? fs::path(name).lexically_relative(here).string() : name},
           {"sha256", sum}});
    const std::string folder = here.lexically_relative(place).string();
    return {{"program", program_}, {"command", command_}, {"folder", folder}, {"inputs", inputs}};
  }

  std::vector<std::string> command_;
  std::string program_;
  std::map<std::string, std::string> inputs_;  // path as read, SHA-256
  std::set<std::string> texts_;                // SHA-256 of each input
  std::set<std::string> written_;              // canonical paths
};

/// The text of a page has the name of the program: a record must not bring other text into it.
void require_program(const std::string& program, const std::string& file) {
  const bool plain = std::ranges::all_of(program, [](unsigned char c) {
    return std::isalnum(c) != 0 ||
           std::string_view(" .()+-_").find(static_cast<char>(c)) != std::string_view::npos;
  });
  if (!plain || !program.starts_with("vernier ") || program.find("--") != std::string::npos)
    throw text::InputError({file, 0}, "program", "the record does not name a version of this program");
}

}  // namespace

std::string in_comment(const std::string& text) {
  std::string result = text;
  for (std::size_t at = 0; (at = result.find('-', at)) != std::string::npos; at += 6)
    result.replace(at, 1, "\\u002d");
  return result;
}

std::string sha256_of(const std::string& bytes) {
  std::array<unsigned char, crypto_hash_sha256_BYTES> hash{};
  crypto_hash_sha256(hash.data(), reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
  std::string text;
  for (const unsigned char byte : hash) text += fmt::format("{:02x}", byte);
  return text;
}

bool makes_files_from_files(const std::string& command) {
  return std::ranges::find(kOfFiles, command) != kOfFiles.end();
}

void record_provenance(const std::vector<std::string>& arguments, const std::string& program) {
  if (arguments.empty() || !makes_files_from_files(arguments.front())) return;
  const auto recorder = std::make_shared<Recorder>(arguments, program);
  text::set_file_hooks(
      {[recorder](const std::string& path, const std::string& text) { recorder->was_read(path, text); },
       [recorder](const std::string& path, const std::string& text) {
         return recorder->with_provenance(path, text);
       }});
}

std::optional<Provenance> provenance_of(const std::string& content, const std::string& name) {
  Json made;
  if (kind_of(content) == Kind::kJson) {
    const Json all = Json::parse(content, nullptr, false);
    if (!all.is_object() || !all.contains("made_by")) return std::nullopt;
    made = all["made_by"];
  } else {
    const auto at = comment_in(content);
    if (at == std::string::npos) return std::nullopt;
    const auto begin = at + kOpen.size(), end = content.find(kClose, begin);
    if (end == std::string::npos) throw text::InputError({name, 0}, "made by", "the comment does not end");
    made = Json::parse(content.substr(begin, end - begin), nullptr, false);
  }
  try {
    Provenance result{made.at("program").get<std::string>(),
                      made.at("command").get<std::vector<std::string>>(),
                      made.at("folder").get<std::string>(),
                      {}};
    require_program(result.program, name);
    for (const Json& one : made.at("inputs"))
      result.inputs.push_back({one.at("name").get<std::string>(), one.at("sha256").get<std::string>()});
    return result;
  } catch (const Json::exception&) {
    throw text::InputError({name, 0}, "made_by",
                           "the provenance of this file is malformed: program, command, folder or inputs");
  }
}

}  // namespace vernier::provenance
