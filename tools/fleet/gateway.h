// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <atomic>
#include <functional>
#include <string>

#include "tools/fleet/gateway_file.h"

namespace vernier::fleet {

/// A line for people: start, end or failure of something.
using Say = std::function<void(const std::string&)>;

/// Reads boards, stores their data in a spool, and publishes the data as a Sparkplug edge node until `stop`.
/// The devices of the node are the machines. A record leaves the spool when the registry has confirmed that
/// the record is stored. Brokers, registries, boards and the gateway may be unavailable or fail at any time.
/// Throws InputError if the spool cannot be opened, DatabaseError if the spool fails later.
void run_gateway(const GatewayFile& file, const std::atomic<bool>& stop, const Say& say);

}  // namespace vernier::fleet
