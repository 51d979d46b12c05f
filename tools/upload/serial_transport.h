// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <chrono>
#include <memory>

#include "tools/upload/transport.h"
#include "tools/upload/url.h"

namespace vernier::upload {

/// Opens the connection to a board at a serial line (frames of tables/serial_frame.h):
/// serial://DEVICE[?baud=115200], 8N1, raw mode. wait: longest time until a reply of the board is complete.
/// Throws InputError with the name of the device if the connection fails.
std::unique_ptr<Transport> open_serial_transport(const BoardUrl& url, std::chrono::milliseconds wait);

}  // namespace vernier::upload
