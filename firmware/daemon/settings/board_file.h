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
  double low = 0, high = 0;  // limits of the travel and of a simulated axis, mm or deg
  std::string default_step;  // text for a default of max_step, used if max_step is not given for a real
                             // output
  SignalSource position, output;
};
struct InputEntry {
  std::string name, unit;
  SignalSource source;
  double reference = 0;  // constant reading of a simulated input
};

/// Entry of a link of the board file, with the rights of the link.
struct LinkEntry {
  SignalSource source;
  LinkRights rights;
};

/// Contents of a board file (TOML) after reading and checking; tools/docs/board.md describes the file.
struct BoardFile {
  std::string path;
  std::string store;  // directory with the image slots
  std::uint32_t slot_bytes = 1u << 20;
  ServiceOptions service;
  std::vector<AxisEntry> axes;
  std::vector<InputEntry> inputs;
  SignalSource probe;                  // signal line of the touch probe; its delay is in `service`
  SignalSource sync;                   // sync signal of the ticks
  SignalSource enable, healthy;        // digital lines from and to the controller of the machine
  std::vector<LinkEntry> links;        // kinds: "modbus-tcp", "modbus-rtu", "isotp"
  int priority = 80;                   // priority in SCHED_FIFO
  std::string watchdog;                // device of a hardware watchdog; empty: no watchdog
  std::vector<std::string> key_files;  // files of public keys, which are already read
};

/// Reads and checks a board file and the key files that it names. Throws BoardError if a file is not valid.
/// Not real-time safe.
BoardFile read_board_file(const std::string& path);

}  // namespace vernier
