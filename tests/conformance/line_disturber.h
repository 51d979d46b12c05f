// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <atomic>
#include <chrono>
#include <cstdint>
#include <deque>
#include <map>
#include <random>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace vernier {

/// A serial line with Modbus RTU between a client and a server, that damages what passes. The client opens
/// path(); the server is at the other end of the pseudo terminal `server`.
class LineDisturber {
 public:
  using Clock = std::chrono::steady_clock;
  using Frame = std::vector<std::uint8_t>;
  enum class Fault {
    kNone,
    kSlowBytes,       // `ms` before each byte of an answer
    kOtherUnit,       // the answer is of another unit, with a right checksum
    kBitErrors,       // one bit of every second answer
    kBitsOfRequests,  // one bit of every second request
    kException,       // the server does what the request says, and answers: device failure
    kNoAnswer,        // requests arrive, answers do not
    kCutLine,         // nothing arrives
    kOldAnswers,      // nothing arrives; to each request the answer to an earlier one comes
    kLate,            // every answer comes after `ms`
    kGarbage,         // bytes without sense before every second answer
    kCutAnswers,      // every second answer has no end
    kTwice,           // every answer comes twice, without a pause
    kAgain,           // every answer comes again after `ms`
    kOwnEcho,         // a transceiver that hears itself: each request comes back before its answer
  };

  explicit LineDisturber(const std::string& server, unsigned seed = 1);
  ~LineDisturber();
  LineDisturber(const LineDisturber&) = delete;
  LineDisturber& operator=(const LineDisturber&) = delete;

  const std::string& path() const { return path_; }
  std::atomic<Fault> fault{Fault::kNone};
  std::atomic<int> ms{0};

 private:
  void run();
  void pass(Frame request);
  void answer(const Frame& request, Frame frame);
  Frame read_frame(int fd, std::size_t (*size_of)(const Frame&), std::chrono::milliseconds patience) const;
  bool every_second() { return random_() % 2 == 0; }
  void turn_a_bit(Frame& frame);
  void send(const Frame& frame) const;

  std::string path_;
  const int client_, server_;
  std::mt19937 random_;
  std::map<Frame, Frame> before_;  // answer by unit, function and address
  std::deque<std::pair<Clock::time_point, Frame>> late_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace vernier
