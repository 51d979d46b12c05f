// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <atomic>
#include <string>

#include "tools/fleet/gateway.h"
#include "tools/fleet/mqtt.h"

namespace vernier::fleet {

/// From a broker into a registry.
struct IngestOptions {
  std::string registry, group = "vernier", host = "vernier";
  Broker broker;
};

/// The host application: hears all edge nodes of a group, writes what their machines say into the registry,
/// each sample once, and tells the gateways what is stored, until `stop`. Broker and database may be away at
/// any time. Throws InputError where the registry is none at the beginning. tool.
void run_ingest(const IngestOptions& options, const std::atomic<bool>& stop, const Say& say);

}  // namespace vernier::fleet
