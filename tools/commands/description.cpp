// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/commands/description.h"

#include <algorithm>
#include <cctype>

#include "tools/commands/command.h"
#include "tools/text/numbers.h"
#include "tools/text/words.h"

namespace vernier::commands {
namespace {

using Json = nlohmann::ordered_json;

std::string kind_of(const CLI::Option& option) {
  if (option.get_items_expected_max() == 0) return "flag";
  // Tests of the value come behind the type: "INT:INT in [1 - 10]", "FILE:written:…".
  const std::string type = option.get_type_name() + ":";
  constexpr std::pair<const char*, const char*> kPaths[] = {{kReadsOrServer, "reads-or-server"},
                                                            {kWrites, "writes"},
                                                            {kWritesFolder, "writes-folder"},
                                                            {kReads, "reads"},
                                                            {kReadsFolder, "reads-folder"}};
  for (const auto& [name, kind] : kPaths)
    if (type.starts_with(std::string(name) + ":")) return kind;
  if (type.starts_with("UINT")) return "count";
  return type.starts_with("FLOAT") || type.starts_with("INT") ? "number" : "text";
}

/// The limits of CLI::Range, which are only in its description: "FLOAT:FLOAT in [0 - 1]".
void add_range(const CLI::Option& option, Json& json) {
  const std::string type = option.get_type_name();
  const auto open = type.find(" in ["), middle = type.find(" - ", open), close = type.find(']', middle);
  if (open == std::string::npos || middle == std::string::npos || close == std::string::npos) return;
  const auto low = text::parse_number(type.substr(open + 5, middle - open - 5)),
             high = text::parse_number(type.substr(middle + 3, close - middle - 3));
  if (!low || !high) return;
  json["low"] = *low;
  json["high"] = *high;
}

Json described(const CLI::Option& option) {
  const bool positional = option.get_positional();
  std::string name = positional                    ? option.get_name(true)
                     : option.get_lnames().empty() ? option.get_snames().front()
                                                   : option.get_lnames().front();
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  Json json = {{"name", name},
               {"typed", positional                    ? ""
                         : option.get_snames().empty() ? "--" + name
                                                       : "-" + option.get_snames().front()},
               {"kind", kind_of(option)},
               {"list", option.get_items_expected_max() > 1 ||
                            option.get_multi_option_policy() == CLI::MultiOptionPolicy::TakeAll},
               {"required", option.get_required()},
               {"help", option.get_description()}};
  if (const auto words = allowed_words(option); !words.empty()) json["words"] = words;
  add_range(option, json);
  if (!option.get_default_str().empty()) json["default"] = option.get_default_str();
  return json;
}

void add_commands(const CLI::App& app, const std::string& before, Json& list) {
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    Json options = Json::array();
    for (const CLI::Option* option : command->get_options())
      if (!option->get_group().empty() && option != command->get_help_ptr())
        options.push_back(described(*option));
    const std::string name = before + command->get_name();
    list.push_back({{"name", name}, {"help", command->get_description()}, {"options", std::move(options)}});
    add_commands(*command, name + " ", list);
  }
}

}  // namespace

std::vector<std::string> allowed_words(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const auto open = type.find('{'), close = type.find('}');
  if (open == std::string::npos || close == std::string::npos) return {};
  std::vector<std::string> words = text::parts_of(type.substr(open + 1, close - open - 1), ',');
  // A word of the command line that is used for one of our values is written as word->value.
  for (std::string& word : words) word = word.substr(0, word.find("->"));
  return words;
}

nlohmann::ordered_json describe(const CLI::App& vernier) {
  Json list = Json::array();
  add_commands(vernier, "", list);
  return list;
}

}  // namespace vernier::commands
