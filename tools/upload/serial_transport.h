// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <chrono>
#include <memory>

#include "tools/upload/transport.h"
#include "tools/upload/url.h"

namespace vernier::upload {

/// A board at a serial line of bytes (tables/serial_frame.h): serial://DEVICE[?baud=115200], 8N1, raw. wait:
/// longest time until a reply is complete. Throws InputError naming the device.
std::unique_ptr<Transport> open_serial_transport(const BoardUrl& url, std::chrono::milliseconds wait);

}  // namespace vernier::upload
