// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "firmware/daemon/device_axes.h"
#include "firmware/daemon/settings/board_file.h"

namespace vernier {

class CanopenAxes;

/// Opens the drives on one CANopen bus for axes of kind "canopen". Axis k of the result belongs to axes[k].
/// If the bus is missing, the function returns null and sets `error`. If a setting is wrong, it throws
/// BoardError. Not real-time safe.
std::unique_ptr<CanopenAxes> open_canopen_axes(const std::vector<PositionAxis>& axes, std::string& error);

/// Reads the settings of an output of kind "canopen" for one axis. Throws BoardError if a setting is wrong.
/// Not real-time safe.
OutputOpener canopen_output_of(const std::vector<OutputAxis>& axes);
inline std::vector<const char*> canopen_output_settings() {
  return {"interface", "node", "object", "scale",        "range",      "polarity", "sync_us",
          "sync",      "tpdo", "rpdo",   "heartbeat_ms", "timeout_ms", "pdo_test", "delay_ms"};
}

/// A CANopen drive takes one offset with each SYNC message. Throws BoardError in two cases: the ticks do not
/// follow the SYNC of the drives of the outputs, or an identifier of a drive has another use. Not real-time
/// safe.
void require_sync_of_drives(const BoardFile& board);

}  // namespace vernier
