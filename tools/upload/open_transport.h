// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <chrono>
#include <memory>
#include <optional>

#include "tools/upload/transport.h"
#include "tools/upload/url.h"

namespace vernier::upload {

/// Checking an image and writing it to a slow medium takes a board some seconds; a small board at a serial
/// line checks two signatures for the end of an upload, seconds each.
inline constexpr std::chrono::milliseconds kReplyDeadline{15'000}, kSerialReplyDeadline{60'000};

/// Opens the connection to a board. wait: longest time until an answer is complete, independent of the
/// intervals between its bytes (without a value: one of the deadlines above); over Modbus a request has two
/// answers. Throws InputError naming the address.
std::unique_ptr<Transport> open_transport(const BoardUrl& url,
                                          std::optional<std::chrono::milliseconds> wait = std::nullopt);

}  // namespace vernier::upload
