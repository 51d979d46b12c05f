// SPDX-License-Identifier: GPL-3.0-or-later
// Used instead of fleet.cpp if its packages were missing when this program was built.
#include "tools/commands/command.h"
#include "tools/text/error.h"

namespace vernier::commands::fleet_cli {

void register_fleet(CLI::App& vernier) {
  CLI::App* fleet = vernier.add_subcommand(
      "fleet", "Manage many machines: state, due checks, common drift, correction images in stages, batches");
  fleet->allow_extras();
  fleet->callback([] {
    throw text::InputError(
        "this vernier was built without `fleet`: install libprotobuf-dev protobuf-compiler libpaho-mqtt-dev "
        "libpq-dev libsqlite3-dev libtomlplusplus-dev and build it again");
  });
}

}  // namespace vernier::commands::fleet_cli
