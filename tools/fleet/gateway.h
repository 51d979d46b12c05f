// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <atomic>
#include <functional>
#include <string>

#include "tools/fleet/gateway_file.h"

namespace vernier::fleet {

/// Function that writes a line for people: start, end or failure of a part of the gateway.
using Say = std::function<void(const std::string&)>;

/// Runs a gateway until `stop`: reads boards, stores their data in a spool, and publishes the data as a
/// Sparkplug edge node. The devices of the edge node are the machines. A record is removed from the spool
/// after the registry has confirmed that it is stored. Brokers, registries, boards and the gateway itself may
/// be unavailable or fail at any time. Throws InputError if the spool cannot be opened, and DatabaseError if
/// the spool fails later.
void run_gateway(const GatewayFile& file, const std::atomic<bool>& stop, const Say& say);

}  // namespace vernier::fleet
