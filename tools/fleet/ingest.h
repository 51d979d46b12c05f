// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <atomic>
#include <string>

#include "tools/fleet/gateway.h"
#include "tools/fleet/mqtt.h"

namespace vernier::fleet {

/// Options for storing the data from a broker in a registry.
struct IngestOptions {
  std::string registry, group = "vernier", host = "vernier";
  Broker broker;
};

/// Runs the Sparkplug host application until `stop`. The function run_ingest receives the messages of all
/// edge nodes of a group and writes their data to the registry, each sample once. The function run_ingest
/// reports to the gateways which samples are stored. The broker and the database may be unavailable at any
/// time. Throws InputError if the registry is not valid at the beginning.
void run_ingest(const IngestOptions& options, const std::atomic<bool>& stop, const Say& say);

}  // namespace vernier::fleet
