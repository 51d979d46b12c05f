// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <memory>

#include "tools/upload/transport.h"
#include "tools/upload/url.h"

namespace vernier::upload {

/// Opens the way to a board. Throws InputError naming the address. tool.
std::unique_ptr<Transport> open_transport(const BoardUrl& url);

}  // namespace vernier::upload
