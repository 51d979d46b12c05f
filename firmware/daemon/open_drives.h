// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "firmware/daemon/device_axes.h"
#include "firmware/daemon/settings/board_file.h"

namespace vernier {

class CanopenAxes;

/// Opens the drives of one CANopen bus that axes of kind "canopen" name. Axis k of the result is axes[k].
/// Null with `error` set if the bus is missing; a wrong setting throws BoardError. Not real-time safe.
std::unique_ptr<CanopenAxes> open_canopen_axes(const std::vector<PositionAxis>& axes, std::string& error);

/// Reads the settings of an output of kind "canopen": one axis. A wrong setting throws BoardError.
/// Not real-time safe.
OutputOpener canopen_output_of(const std::vector<OutputAxis>& axes);
inline const std::vector<const char*> kCanopenOutputSettings = {
    "interface", "node", "object", "scale",        "range",      "polarity", "sync_us",
    "sync",      "tpdo", "rpdo",   "heartbeat_ms", "timeout_ms", "pdo_test", "delay_ms"};

/// A drive takes one offset with each SYNC. Refuses a board file whose ticks do not follow the SYNC of the
/// drives of its outputs, and one in which an identifier of a drive has another use. Throws BoardError.
/// Not real-time safe.
void require_sync_of_drives(const BoardFile& board);

}  // namespace vernier
