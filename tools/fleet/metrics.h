// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <atomic>
#include <string>

#include "tools/fleet/gateway.h"
#include "tools/registry/registry.h"

namespace vernier::fleet {

/// Returns the state of the fleet in the Prometheus text format 0.0.4. The names of the metrics are in
/// tools/docs/fleet.md.
std::string metrics_text(registry::Registry& registry, std::int64_t at_us);

/// Serves the metrics of a registry over HTTP, as /metrics at HOST:PORT, until `stop`. Throws InputError if
/// the server cannot listen at this address.
void serve_metrics(const std::string& registry, const std::string& address, const std::atomic<bool>& stop,
                   const Say& say);

}  // namespace vernier::fleet
