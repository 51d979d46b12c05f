// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/registry/registry.h"

namespace vernier::registry {

/// One vernier command for each of many machines. A scheduler executes the commands from a folder with
/// batch.json (this data), machines (one name per line), a script for the scheduler, and
/// answers/MACHINE.json.
struct Batch {
  std::string id;  // hash BLAKE2b-256 of batch.json
  std::string name;
  std::string directory;             // absolute path of the folder in which the command runs
  std::vector<std::string> command;  // words after `vernier`; {machine} is replaced in each word
  std::vector<std::string> machines;
};

/// The answer for one machine: the result and the exit status of its command.
struct BatchAnswer {
  std::string machine;
  std::int64_t status = 0;        // exit status of the command: 0 done, 2 the result is negative
  nlohmann::ordered_json result;  // JSON result of `--json`; null if the command has no such option
};

/// An answer that is not recorded in the registry, and the reason.
struct NotBooked {
  std::string machine;
  std::string state;  // "missing", "incomplete", "failed" or "refused"
  std::string why;
};

/// Result of collect(): number of answers that this call recorded in the registry, and number of answers that
/// were recorded before.
struct Collected {
  std::int64_t booked = 0, before = 0;
  std::vector<NotBooked> not_booked;
};

/// A row in the table `answers` of the registry.
struct BookedAnswer {
  std::string batch, name, machine, result;
  std::int64_t status = 0, at_us = 0;
};

/// Writes batch.json and the list of machines to a new folder, and returns the batch with its id. Throws
/// InputError if the folder already contains a batch, if the name of a machine is not permitted, or if a
/// machine occurs twice.
Batch write_batch(const std::string& folder, Batch batch);
/// Reads a batch from its folder. Throws InputError if the folder contains no batch.
Batch read_batch(const std::string& folder);
/// Returns the words of the command for one machine. Throws InputError if the machine is not in the batch.
std::vector<std::string> command_of(const Batch& batch, const std::string& machine);
/// Writes the answer for a machine completely or not at all. `message`: the last line of a failure.
void write_answer(const std::string& folder, const Batch& batch, const BatchAnswer& answer,
                  const std::string& message);
/// True if the folder contains the answer for a machine with the exit status 0 or 2.
bool has_answer(const std::string& folder, const Batch& batch, const std::string& machine);

/// Records the answer for each machine in the registry, each answer once. An answer that is missing,
/// incomplete, failed, or of another machine or batch is listed and not recorded. If the function throws
/// DatabaseError, no answer was recorded.
Collected collect(Registry& registry, const std::string& folder, const Batch& batch);
/// Returns the recorded answers, by batch and machine. If `name` is empty, the answers of all batches are
/// returned.
std::vector<BookedAnswer> booked_answers(Registry& registry, const std::string& name);

}  // namespace vernier::registry
