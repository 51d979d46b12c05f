// SPDX-License-Identifier: GPL-3.0-or-later
// Approach directions and the order of readings that a text beside a table states in words.
#pragma once
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace vernier::importer {

/// The approach directions of the runs of a table, by a text.
struct StatedDirections {
  /// kAlternating: "abwechselnd vor und zurück", "odd runs forward, even runs back". kByNumber: "Läufe 1 und
  /// 3 vorwärts, 2 und 4 rückwärts". kAll: "alle Läufe vorwärts". kUnclear: the text is about alternating or
  /// equal directions, but does not state which one the first run has: "unidirektional".
  /// kNothing: the text is about something else.
  /// kFirstRuns: "die ersten beiden Spalten vorwärts, die letzten beiden rückwärts".
  enum class Kind { kNothing, kAlternating, kByNumber, kFirstRuns, kAll, kUnclear };
  Kind kind = Kind::kNothing;
  int first = 0;  // of the first run and of odd runs, or of all runs; 0: not stated
  std::vector<std::pair<int, int>> of_run{};  // kByNumber: runs and their directions
  int others = 0;  // kByNumber: direction of the runs that the text does not name; 0: not stated
  int first_runs = 0, last_runs = 0;  // kFirstRuns: numbers of runs at the begin and at the end
  bool assumed = false;               // the text states changes only: the first run is taken as forward
  bool one_way = false;               // kUnclear: all runs have one direction
  bool count = false;  // kUnclear: numbers of runs in each direction, "3 Läufe vorwärts, 3 zurück"
  bool way = false;    // the direction is that of the survey: "hin", "forward"

  /// Returns the direction of the run with this number; 0: the text does not state one. `runs`: number of
  /// runs of the table.
  int of(int run, int runs = 0) const;
};

/// Returns the directions that a text states for several runs.
StatedDirections directions_stated(std::string_view text);

/// Returns the meaning of the codes of a column of directions that a text states, by the code in small
/// letters: "1 = rückwärts, 2 = vorwärts". Empty: the text does not state two codes with different
/// directions.
std::map<std::string, int> direction_codes_stated(std::string_view text);

/// The order of the readings of the way back in a table with a column for each direction.
enum class BackOrder {
  kNothing,   // the text does not state an order
  kReversed,  // the readings of the way back are in the order of their measurement: the last row is the first
  kUnclear    // readings in the order of the measurement, and the text does not state which ones
};

/// Returns the order that a text states. `span`: smallest and largest position of the table; "von 300 nach
/// 0" is an order if both numbers are these positions.
BackOrder back_order_stated(std::string_view text, std::pair<double, double> span);

/// True for a text that states that each deviation is the change from the position before: the heading
/// "Abweichung je Schritt" or "Incremental error", the title "Errors per step". Without a word for
/// deviations, a step or an increment in a title is that of the positions.
bool states_increments(std::string_view text, bool heading);

}  // namespace vernier::importer
