// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "firmware/core/service.h"
#include "firmware/daemon/settings/key_file.h"
#include "firmware/daemon/settings/signal_source.h"

namespace vernier {

/// Entry of one axis or one input of the board file.
struct AxisEntry {
  Wiring::Axis wiring;
  double low = 0, high = 0;  // mm or deg; travel, and range of a simulated axis
  std::string default_step;  // text of a default of max_step, if max_step is not given for a real output
  SignalSource position, output;
};
struct InputEntry {
  std::string name, unit;
  SignalSource source;
  double reference = 0;  // reading of a simulated one
};

/// Entry of a link of the board file, with the rights of the link.
struct LinkEntry {
  SignalSource source;
  LinkRights rights;
};

/// Contents of a board file (TOML) after reading and checking; tools/docs/board.md describes the file.
struct BoardFile {
  std::string path;
  std::string store;  // directory of the slots
  std::uint32_t slot_bytes = 1u << 20;
  ServiceOptions service;
  std::vector<AxisEntry> axes;
  std::vector<InputEntry> inputs;
  SignalSource probe;                  // line of the touch probe; its delay is in `service`
  SignalSource sync;                   // of the ticks
  SignalSource enable, healthy;        // digital lines from and to the machine's controller
  std::vector<LinkEntry> links;        // kind: "modbus-tcp", "modbus-rtu", "isotp"
  int priority = 80;                   // SCHED_FIFO
  std::string watchdog;                // device of a hardware watchdog; empty: no watchdog
  std::vector<std::string> key_files;  // public keys, read already
};

/// Reads and checks a board file and the key files that it names. Throws BoardError. Not real-time safe.
BoardFile read_board_file(const std::string& path);

}  // namespace vernier
