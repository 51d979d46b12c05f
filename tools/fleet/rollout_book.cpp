// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fleet/rollout_book.h"

#include <fmt/format.h>

#include <cstring>

#include "tables/image_format.h"
#include "tools/registry/cells.h"
#include "tools/text/numbers.h"
#include "tools/text/wall_time.h"

namespace vernier::fleet {

std::uint64_t fingerprint_of(const RolloutMachine& machine) {
  ImageHeader header;
  std::memcpy(&header, machine.image.data(), sizeof(header));
  return header.fingerprint;
}

void RolloutBook::enter(const std::vector<RolloutMachine>& machines) {
  registry::Transaction transaction(registry_.database());
  for (std::size_t i = 0; i < machines.size(); ++i)
    registry_.database().run(
        "INSERT INTO rollout (name, machine, stage, place, image, state, said, at_us) VALUES ($1, $2, $3, "
        "$4, "
        "$5, 'waiting', '', $6) ON CONFLICT (name, machine) DO UPDATE SET stage = excluded.stage, place = "
        "excluded.place",
        {name_, machines[i].name, registry::cell(machines[i].stage),
         registry::cell(static_cast<std::int64_t>(i)), text::fingerprint_text(fingerprint_of(machines[i])),
         registry::cell(text::now_us())});
  transaction.commit();
}

// values: those of `set`, $1 on; the condition's follow.
void RolloutBook::run(const std::string& set, const std::string& machine,
                      std::vector<registry::Cell> values) {
  const std::size_t n = values.size();
  values.insert(values.end(),
                {registry::Cell(name_), registry::Cell(machine), registry::Cell(locks_.holder())});
  registry_.database().run(
      fmt::format("UPDATE rollout SET {} WHERE name = ${} AND machine = ${} AND EXISTS (SELECT 1 FROM "
                  "machine_lock l WHERE l.machine = ${} AND l.holder = ${})",
                  set, n + 1, n + 2, n + 2, n + 3),
      values);
  if (registry_.database().written() != 1)
    throw registry::LockLost(fmt::format(
        "{}: another call works on this machine now, so this call did not change the registry", machine));
}

void RolloutBook::write(const RolloutMachine& machine, const char* state, const std::string& said) {
  run("state = $1, said = $2, at_us = $3, image = $4", machine.name,
      {registry::Cell(state), registry::Cell(said), registry::cell(text::now_us()),
       registry::Cell(text::fingerprint_text(fingerprint_of(machine)))});
}

void RolloutBook::begin_trial(const RolloutMachine& machine, std::uint64_t issued) {
  run("state = 'trial', said = '', at_us = $1, image = $2, issued = $3", machine.name,
      {registry::cell(text::now_us()), registry::Cell(text::fingerprint_text(fingerprint_of(machine))),
       registry::cell(static_cast<std::int64_t>(issued))});
}

void RolloutBook::allow() {
  registry_.database().run("UPDATE rollout SET state = 'waiting' WHERE name = $1 AND state = 'taken-back'",
                           {name_});
}

std::vector<RolloutState> rollout_states(registry::Registry& registry, const std::string& name) {
  std::vector<RolloutState> states;
  for (const registry::Row& row :
       registry.database().run("SELECT machine, state, said, image, stage, at_us, issued FROM rollout WHERE "
                               "name = $1 ORDER BY place, machine",
                               {name}))
    states.push_back({registry::words(row[0]), registry::words(row[1]), registry::words(row[2]),
                      registry::words(row[3]), registry::whole(row[4]), registry::whole(row[5]),
                      static_cast<std::uint64_t>(registry::whole(row[6]))});
  return states;
}

}  // namespace vernier::fleet
