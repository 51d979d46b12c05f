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
  std::string name;  // also the device of its topics
  std::string url;   // of its board; empty: no board
  std::string note;
  double check_days = 0;  // a check is due so long after the last one; 0: never
  std::int64_t added_us = 0;
  std::string board{};      // name that its board must have; empty: not entered
  std::string board_key{};  // public half of the board's own key, 64 hexadecimal digits; empty: not entered
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

/// The last state of a machine in the registry. `at_us` is the gateway's clock; `received_us` is the
/// registry's.
struct LiveState {
  std::string machine, gateway, mode, fault, image;
  bool online = false;
  std::int64_t at_us = 0;                                   // when its newest sample was taken
  std::int64_t samples = 0;                                 // stored
  std::vector<std::pair<std::string, std::string>> values;  // names and JSON values of that sample
  std::int64_t received_us = 0;  // when the registry took that sample; 0: not known
  bool historical = false;       // the sample had waited in the gateway's store
};

/// Reliability of a live state at a given time.
struct LiveAge {
  enum class State : std::uint8_t { kOnline, kStale, kAway } state = State::kAway;
  double age_s = 0;    // since the registry took the newest sample
  double clock_s = 0;  // gateway's clock less the registry's, where the sample had not waited
  bool clock_off = false;
};
/// now_us: of the registry's clock (Database::now_us); stale_s: an older state is not accepted. The clock of
/// a gateway has an error if its time is more than 2 s ahead or 10 s behind.
LiveAge live_age(const LiveState& live, std::int64_t now_us, double stale_s);
/// "online", "stale" or "away".
const char* name_of(LiveAge::State state);
inline constexpr double kStaleAfter_s = 30;

/// A machine that is not in the registry, and whose samples were not stored; "" stands for all machines
/// beyond the first hundred.
struct NotEntered {
  std::string machine, gateway;  // the gateway that sent the last sample
  std::int64_t samples = 0, at_us = 0;
};

/// The registry of a fleet: machines, their images, their states. A registry on a server and a registry in a
/// file have the same contents. All calls of Registry throw DatabaseError.
class Registry {
 public:
  /// Opens a registry; creates the tables if they do not exist. Throws InputError for a registry of a newer
  /// program.
  explicit Registry(std::unique_ptr<Database> database);
  Database& database() { return *database_; }

  /// Adds a machine, or changes the machine of that name. Throws InputError for a name that is not allowed
  /// (machine_name.h).
  void put(const FleetMachine& machine);
  std::vector<FleetMachine> machines();
  /// Throws InputError if no machine has that name.
  FleetMachine machine(const std::string& name);
  /// Gives a machine with all its entries another name. Throws InputError if no machine has the old name, or
  /// if the new name is already used or not allowed.
  void give_name(const std::string& from, const std::string& to);
  /// Returns the machines that are not in the registry, and whose samples arrived and were not stored.
  std::vector<NotEntered> not_entered();
  /// Enters the key of a machine's board if no key is entered. Returns false if the board of another machine
  /// has this key, or if a key was entered meanwhile.
  bool trust_board_key(const std::string& machine, const std::string& key);

  void put(const RecordedCalibration& calibration);
  /// Returns the calibrations, newest first; those of all machines if `machine` is empty.
  std::vector<RecordedCalibration> calibrations(const std::string& machine);

  /// Adds a check with its readings; false: the registry already has this check.
  bool put(const FleetCheck& check, const std::vector<FleetReading>& readings);
  /// Returns the checks of a machine in the order of time.
  std::vector<FleetCheck> checks(const std::string& machine);
  std::vector<FleetReading> readings(std::int64_t since_us);

  std::vector<LiveState> live();
  /// Deletes samples that were taken before a time; returns the number of deleted samples. A sample that is
  /// already stored is not stored again.
  std::int64_t forget_samples(std::int64_t before_us);

 private:
  void make_tables();
  void upgrade(std::int64_t version);
  std::unique_ptr<Database> database_;
};

}  // namespace vernier::registry
