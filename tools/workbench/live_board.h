// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <condition_variable>
#include <deque>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

namespace vernier::workbench {

/// Monitors one board at a time, like the command `vernier watch`. A thread reads the state of the board
/// kLiveRateHz times per second and stores the last states. The thread disconnects if the page sends no
/// request for kLetGoS seconds.
class LiveBoard {
 public:
  static constexpr double kLiveRateHz = 20, kLetGoS = 5;

  LiveBoard() = default;
  ~LiveBoard();
  LiveBoard(const LiveBoard&) = delete;
  LiveBoard& operator=(const LiveBoard&) = delete;

  /// Returns the states of the board (live_json) with a number above `after`, each with `seq` and `at_s`:
  /// {"pictures": [...], "error": text or null}. The function waits until a new state is available, at most
  /// half a second. If `url` is different from the previous call, the previous board is disconnected. Throws
  /// InputError if `url` is not the address of a board.
  nlohmann::ordered_json pictures(const std::string& url, std::uint64_t after);

 private:
  void watch(const std::string& url);
  void look(const std::string& url);
  void end();

  std::mutex ending_;  // locked while the monitored board is replaced by another board
  std::mutex guard_;
  std::condition_variable changed_;
  std::thread thread_;
  std::string url_, error_;
  std::deque<nlohmann::ordered_json> kept_;
  std::uint64_t next_ = 1;
  double asked_s_ = 0;
  bool stop_ = false, running_ = false;
};

}  // namespace vernier::workbench
