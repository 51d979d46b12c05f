// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/registry/registry.h"

namespace vernier::registry {

/// One vernier command for each of many machines, in a folder from which a scheduler executes the commands:
/// batch.json (this), machines (a name a line), a script for the scheduler, answers/MACHINE.json.
struct Batch {
  std::string id;  // BLAKE2b-256 of batch.json
  std::string name;
  std::string directory;             // absolute; the command runs there
  std::vector<std::string> command;  // words behind `vernier`; {machine} is replaced in each
  std::vector<std::string> machines;
};

/// The answer of a machine: the result and the exit status of its command.
struct BatchAnswer {
  std::string machine;
  std::int64_t status = 0;        // exit status of the command: 0 done, 2 the answer is no
  nlohmann::ordered_json result;  // of `--json`; null for a command without it
};

/// An answer that is not recorded in the registry, with the reason.
struct NotBooked {
  std::string machine;
  std::string state;  // "missing", "incomplete", "failed", "refused"
  std::string why;
};

/// Result of collect(): numbers of answers that this call booked and that were booked before.
struct Collected {
  std::int64_t booked = 0, before = 0;
  std::vector<NotBooked> not_booked;
};

/// A line of `answers`.
struct BookedAnswer {
  std::string batch, name, machine, result;
  std::int64_t status = 0, at_us = 0;
};

/// Writes batch.json and machines into a new folder, and returns the batch with its id. Throws InputError if
/// the folder already contains a batch, if the name of a machine is not allowed, or if a machine occurs
/// twice.
Batch write_batch(const std::string& folder, Batch batch);
/// Throws InputError if the folder contains no batch.
Batch read_batch(const std::string& folder);
/// The words of one machine. Throws InputError if the machine is not in the batch.
std::vector<std::string> command_of(const Batch& batch, const std::string& machine);
/// Writes the answer of a machine as a whole or not at all; `message`: the last line of a failure.
void write_answer(const std::string& folder, const Batch& batch, const BatchAnswer& answer,
                  const std::string& message);
/// True if the folder has the answer of a machine (exit status 0 or 2).
bool has_answer(const std::string& folder, const Batch& batch, const std::string& machine);

/// Records the answer of each machine in the registry, once. An answer that is missing, incomplete, failed,
/// of another machine or of another batch is listed and not booked. Throws DatabaseError: no answer was
/// booked.
Collected collect(Registry& registry, const std::string& folder, const Batch& batch);
/// The booked answers, by batch and machine; of all batches if `name` is empty.
std::vector<BookedAnswer> booked_answers(Registry& registry, const std::string& name);

}  // namespace vernier::registry
