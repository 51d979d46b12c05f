// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tools/registry/database.h"

namespace vernier::registry {

/// A machine of the fleet.
struct FleetMachine {
  std::string name;  // name of the machine; it is also the device in its MQTT topics
  std::string url;   // address of the machine's board; empty: the machine has no board
  std::string note;
  double check_days = 0;  // a check is due this number of days after the last check; 0: never
  std::int64_t added_us = 0;
  std::string board{};      // name that the board of the machine must have; empty: not entered
  std::string board_key{};  // public key of the board, 64 hexadecimal digits; empty: not entered
};

/// The image that runs on a machine, and the origin of the image.
struct RecordedCalibration {
  std::string machine, model, model_hash, image, data, data_hash, signed_by, checked_against, checked_hash;
  std::int64_t at_us = 0;
};

/// Result of one `vernier check` of a machine.
struct FleetCheck {
  std::string machine, label, verdict, explanation;
  double evidence = 0, alarm = 0;
  std::int64_t at_us = 0;
};

/// Value of one quantity of a machine in one check.
struct FleetReading {
  std::string machine, quantity, unit;
  std::int64_t at_us = 0;
  double value = 0, std = 0;
};

/// The last known state of a machine in the registry. The time at_us is by the clock of the gateway;
/// received_us is by the clock of the registry.
struct LiveState {
  std::string machine, gateway, mode, fault, image;
  bool online = false;
  std::int64_t at_us = 0;                                   // time at which the newest sample was taken
  std::int64_t samples = 0;                                 // number of stored samples
  std::vector<std::pair<std::string, std::string>> values;  // names and JSON values of the newest sample
  std::int64_t received_us = 0;  // time at which the registry received the newest sample; 0: unknown
  bool historical = false;       // true: the newest sample had waited in the spool of the gateway
};

/// Evaluation of a live state at a given time: whether the machine is connected, and the age of the state.
struct LiveAge {
  enum class State : std::uint8_t { kOnline, kStale, kAway } state = State::kAway;
  double age_s = 0;    // time since the registry received the newest sample
  double clock_s = 0;  // clock of the gateway minus clock of the registry, if the sample had not waited
  bool clock_off = false;
};
/// `now_us`: present time by the clock of the registry (Database::now_us). `stale_s`: largest age; an older
/// state is stale. The clock of a gateway is wrong if its time is more than 2 s ahead of or 10 s behind the
/// registry.
LiveAge live_age(const LiveState& live, std::int64_t now_us, double stale_s);
/// Returns the name of the state: "online", "stale" or "away".
const char* name_of(LiveAge::State state);
inline constexpr double kStaleAfter_s = 30;

/// A machine that sent samples but is not in the registry, so that its samples were not stored. The name ""
/// represents all further machines that are not in the registry, after the first hundred.
struct NotEntered {
  std::string machine, gateway;  // gateway that sent the last sample
  std::int64_t samples = 0, at_us = 0;
};

/// The registry of a fleet: the machines, their images and their states. A registry on a server and a
/// registry in a file have the same content. All functions of Registry can throw DatabaseError.
class Registry {
 public:
  /// Opens a registry. If the tables of the registry do not exist, they are created. Throws InputError if a
  /// newer program created the registry.
  explicit Registry(std::unique_ptr<Database> database);
  Database& database() { return *database_; }

  /// Adds a machine, or changes the machine with the same name. Throws InputError if the name is not
  /// permitted (machine_name.h).
  void put(const FleetMachine& machine);
  std::vector<FleetMachine> machines();
  /// Throws InputError if no machine of the registry has the given name.
  FleetMachine machine(const std::string& name);
  /// Changes the name of a machine and of all its entries. Throws InputError if no machine has the old name,
  /// or if the new name is already used or not permitted.
  void give_name(const std::string& from, const std::string& to);
  /// Returns the machines that sent samples but are not in the registry, so that their samples were not
  /// stored.
  std::vector<NotEntered> not_entered();
  /// Enters the public key of a machine's board if no key is entered yet. Returns false if the board of
  /// another machine has this key, or if another key was entered in the meantime.
  bool trust_board_key(const std::string& machine, const std::string& key);

  void put(const RecordedCalibration& calibration);
  /// Returns the calibrations of a machine, newest first. If `machine` is empty, the calibrations of all
  /// machines are returned.
  std::vector<RecordedCalibration> calibrations(const std::string& machine);

  /// Adds a check with its readings. Returns false if the registry already contains this check.
  bool put(const FleetCheck& check, const std::vector<FleetReading>& readings);
  /// Returns the checks of a machine in time order.
  std::vector<FleetCheck> checks(const std::string& machine);
  std::vector<FleetReading> readings(std::int64_t since_us);

  std::vector<LiveState> live();
  /// Deletes the samples that were taken before a time, and returns their number. A sample that was already
  /// stored before is not stored again.
  std::int64_t forget_samples(std::int64_t before_us);

 private:
  void make_tables();
  void upgrade(std::int64_t version);
  std::unique_ptr<Database> database_;
};

}  // namespace vernier::registry
