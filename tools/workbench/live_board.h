// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <condition_variable>
#include <deque>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

namespace vernier::workbench {

/// Watches one board at a time, like `vernier watch`. A thread reads the state of the board kLiveRateHz times
/// a second, stores the last states, and disconnects after kLetGoS without a request of the page.
class LiveBoard {
 public:
  static constexpr double kLiveRateHz = 20, kLetGoS = 5;

  LiveBoard() = default;
  ~LiveBoard();
  LiveBoard(const LiveBoard&) = delete;
  LiveBoard& operator=(const LiveBoard&) = delete;

  /// Returns pictures (live_json) with a number above `after`, each with `seq` and `at_s`: {"pictures":
  /// [...], "error": text or null}. Returns when a picture is available, at most after half a second. A new
  /// url disconnects the previous board. Throws InputError if the url is not an address of a board.
  nlohmann::ordered_json pictures(const std::string& url, std::uint64_t after);

 private:
  void watch(const std::string& url);
  void look(const std::string& url);
  void end();

  std::mutex ending_;  // held while one watch is exchanged for another
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
