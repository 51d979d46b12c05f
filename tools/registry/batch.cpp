// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/registry/batch.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <set>

#include "tools/registry/cells.h"
#include "tools/registry/digest.h"
#include "tools/registry/machine_name.h"
#include "tools/text/error.h"
#include "tools/text/files.h"
#include "tools/text/wall_time.h"
#include "tools/text/words.h"

namespace vernier::registry {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kVersion = 1;

std::string answer_file(const std::string& folder, const std::string& machine) {
  return folder + "/answers/" + machine + ".json";
}

bool is_answer(std::int64_t status) { return status == 0 || status == 2; }

std::string dumped(const Json& json) { return json.dump(1, ' ', false, Json::error_handler_t::replace); }

/// A file's JSON object; `nullopt` for half a file or another text.
std::optional<Json> object_of(const std::string& text) {
  if (text::nests_deeper_than(text, text::kMostJsonDepth)) return {};
  Json json = Json::parse(text, nullptr, false);
  if (!json.is_object()) return {};
  return json;
}

/// The answer in a file, or why it is not booked.
struct Found {
  NotBooked why_not;
  BatchAnswer answer;
};

Found find(const std::string& folder, const Batch& batch, const std::string& machine) {
  Found found{{machine, "", ""}, {machine, 0, nullptr}};
  const std::string file = answer_file(folder, machine);
  const auto no = [&](const char* state, std::string why) {
    found.why_not.state = state, found.why_not.why = std::move(why);
    return found;
  };
  if (!std::filesystem::is_regular_file(file)) return no("missing", "no " + file);
  const auto json = object_of(text::read_file(file));
  if (!json) return no("incomplete", fmt::format("{} is not a whole JSON object", file));
  const auto is = [&](const char* key, auto test) { return json->contains(key) && test((*json)[key]); };
  const auto is_text = [](const Json& value) { return value.is_string(); };
  if (!is("batch", is_text) || !is("machine", is_text) || !is("message", is_text) ||
      !json->contains("result") || !is("status", [](const Json& value) { return value.is_number_integer(); }))
    return no("incomplete",
              fmt::format("{} lacks one of the keys batch, machine, status, message, result", file));
  if ((*json)["batch"] != batch.id)
    return no("refused", fmt::format("{} is an answer of another batch", file));
  if ((*json)["machine"] != machine)
    return no("refused", file + " is the answer of " + (*json)["machine"].get<std::string>());
  found.answer.status = (*json)["status"].get<std::int64_t>();
  found.answer.result = (*json)["result"];
  if (!is_answer(found.answer.status))
    return no("failed", "exit status " + std::to_string(found.answer.status) + ": " +
                            (*json)["message"].get<std::string>());
  return found;
}

/// Answers that are in the folder and belong to no machine of the batch.
void list_others(const std::string& folder, const Batch& batch, Collected& collected) {
  std::vector<std::string> others;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(folder + "/answers", none)) {
    const std::string machine = entry.path().stem().string();
    if (entry.path().extension() == ".json" &&
        !std::binary_search(batch.machines.begin(), batch.machines.end(), machine))
      others.push_back(machine);
  }
  std::sort(others.begin(), others.end());
  for (const std::string& machine : others)
    collected.not_booked.push_back({machine, "refused", "this machine is not in the batch"});
}

}  // namespace

Batch write_batch(const std::string& folder, Batch batch) {
  std::sort(batch.machines.begin(), batch.machines.end());
  std::string lines;
  for (std::size_t i = 0; i < batch.machines.size(); ++i) {
    require_machine_name(batch.machines[i]);
    if (i > 0 && batch.machines[i] == batch.machines[i - 1])
      throw text::InputError({}, batch.machines[i], "this machine occurs twice");
    lines += batch.machines[i] + "\n";
  }
  const std::string file = folder + "/batch.json";
  if (std::filesystem::exists(file))
    throw text::InputError({file, 0}, "",
                           "this folder already contains a batch; name another folder with -o");
  const std::string json = dumped({{"vernier_batch", kVersion},
                                   {"name", batch.name},
                                   {"made", text::utc_text(text::now_us())},
                                   {"token", fresh_id()},  // two batches are never the same
                                   {"directory", batch.directory},
                                   {"command", batch.command},
                                   {"machines", batch.machines}}) +
                           "\n";
  text::make_folder(folder + "/answers");
  text::write_file(folder + "/machines", lines);
  text::write_file(file, json);
  batch.id = digest_of(json);
  return batch;
}

Batch read_batch(const std::string& folder) {
  const std::string file = folder + "/batch.json", text = text::read_file(file);
  const auto json = object_of(text);
  try {
    if (!json || json->at("vernier_batch") != kVersion) throw std::invalid_argument("not a batch");
    Batch batch{digest_of(text), json->at("name"), json->at("directory"), json->at("command"),
                json->at("machines")};
    for (const std::string& machine : batch.machines) require_machine_name(machine);
    if (!std::is_sorted(batch.machines.begin(), batch.machines.end())) throw std::invalid_argument("order");
    return batch;
  } catch (const text::InputError&) {
    throw;
  } catch (const std::exception&) {
    throw text::InputError({file, 0}, "", "is not a file that `vernier fleet batch` wrote");
  }
}

std::vector<std::string> command_of(const Batch& batch, const std::string& machine) {
  if (!std::binary_search(batch.machines.begin(), batch.machines.end(), machine))
    throw text::InputError({}, machine, "this machine is not in the batch");
  std::vector<std::string> words;
  for (const std::string& word : batch.command) words.push_back(for_machine(word, machine));
  return words;
}

void write_answer(const std::string& folder, const Batch& batch, const BatchAnswer& answer,
                  const std::string& message) {
  text::write_file(answer_file(folder, answer.machine), dumped({{"batch", batch.id},
                                                                {"machine", answer.machine},
                                                                {"status", answer.status},
                                                                {"ended", text::utc_text(text::now_us())},
                                                                {"message", message},
                                                                {"result", answer.result}}) +
                                                            "\n");
}

bool has_answer(const std::string& folder, const Batch& batch, const std::string& machine) {
  return find(folder, batch, machine).why_not.state.empty();
}

Collected collect(Registry& registry, const std::string& folder, const Batch& batch) {
  Collected collected;
  Database& database = registry.database();
  std::set<std::string> entered;
  for (const FleetMachine& machine : registry.machines()) entered.insert(machine.name);
  Transaction transaction(database);
  for (const std::string& machine : batch.machines) {
    Found found = find(folder, batch, machine);
    if (found.why_not.state.empty() && !entered.contains(machine))
      found.why_not = {machine, "refused",
                       fmt::format("is not in the registry: vernier fleet add {}", machine)};
    if (!found.why_not.state.empty()) {
      collected.not_booked.push_back(found.why_not);
      continue;
    }
    const std::string result = found.answer.result.dump();
    database.run(
        "INSERT INTO answer (batch, machine, name, at_us, status, result) VALUES ($1, $2, $3, $4, $5, $6) ON "
        "CONFLICT DO NOTHING",
        {batch.id, machine, batch.name, cell(text::now_us()), cell(found.answer.status), result});
    if (database.written() == 1) {
      ++collected.booked;
      continue;
    }
    const auto there = database.run("SELECT status, result FROM answer WHERE batch = $1 AND machine = $2",
                                    {batch.id, machine});
    if (!there.empty() && whole(there[0][0]) == found.answer.status && words(there[0][1]) == result)
      ++collected.before;
    else
      collected.not_booked.push_back(
          {machine, "refused", "the answer differs from the answer in the registry"});
  }
  transaction.commit();
  list_others(folder, batch, collected);
  return collected;
}

std::vector<BookedAnswer> booked_answers(Registry& registry, const std::string& name) {
  std::vector<BookedAnswer> answers;
  for (const Row& row : registry.database().run("SELECT batch, name, machine, result, status, at_us FROM "
                                                "answer WHERE name = $1 OR $1 = '' ORDER BY "
                                                "name, batch, machine",
                                                {name}))
    answers.push_back(
        {words(row[0]), words(row[1]), words(row[2]), words(row[3]), whole(row[4]), whole(row[5])});
  return answers;
}

}  // namespace vernier::registry
