// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <initializer_list>
#include <map>
#include <string>
#include <vector>

#include "firmware/core/service.h"
#include "firmware/daemon/settings/key_file.h"

namespace vernier {

/// Connection of a signal of the board to a device: a kind that open_devices.cpp knows, and the settings as
/// written in the board file.
struct SignalSource {
  std::string kind;                                // "can", "iio", "pwm", "sim" ...; empty: not wired
  std::map<std::string, std::string> texts;        // every setting that is a text
  std::map<std::string, double> numbers;           // every setting that is a number
  std::string where;                               // "board.toml:12: axis.X.output"
  std::map<std::string, std::string> places = {};  // the same for each setting, with the line of the setting

  [[noreturn]] void fail(const std::string& what) const;  // throws BoardError
  /// As fail(), with the line of the setting `name`.
  [[noreturn]] void fail_at(const std::string& name, const std::string& what) const;
  /// Throws BoardError if the file has a setting that is not among `names`, apart from kind.
  void only(const std::vector<const char*>& names) const;
  const std::string& text(const std::string& name) const;  // throws BoardError where absent
  double number(const std::string& name) const;            // the same
  double number(const std::string& name, double otherwise) const;
  /// Returns the setting `name` as a whole number from low to high; throws BoardError if the setting is
  /// absent or not valid.
  std::int64_t whole(const std::string& name, std::int64_t low, std::int64_t high) const;
  std::int64_t whole(const std::string& name, std::int64_t otherwise, std::int64_t low,
                     std::int64_t high) const;
  std::string text(const std::string& name, const std::string& otherwise) const;
};

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

/// Reads and checks a board file and the key files that it names. Throws BoardError. setup.
BoardFile read_board_file(const std::string& path);

}  // namespace vernier
