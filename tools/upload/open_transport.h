// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <chrono>
#include <memory>
#include <optional>

#include "tools/upload/transport.h"
#include "tools/upload/url.h"

namespace vernier::upload {

/// Longest time in which a board must reply. A board may need some seconds to check an image and to write it
/// to a slow medium. A small board at a serial line checks two signatures at the end of an upload, and each
/// check takes some seconds.
inline constexpr std::chrono::milliseconds kReplyDeadline{15'000}, kSerialReplyDeadline{60'000};

/// Opens the connection to a board. wait: longest time until a reply is complete, including all intervals
/// between its bytes; without a value, one of the two deadlines above applies. Over Modbus, a board sends
/// two replies to each request of a client. Throws InputError with the address of the board if the
/// connection fails.
std::unique_ptr<Transport> open_transport(const BoardUrl& url,
                                          std::optional<std::chrono::milliseconds> wait = std::nullopt);

}  // namespace vernier::upload
