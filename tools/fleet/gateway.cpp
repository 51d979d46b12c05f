// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fleet/gateway.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <map>
#include <mutex>
#include <set>
#include <thread>

#include "tools/fleet/board_reader.h"
#include "tools/fleet/edge_node.h"
#include "tools/fleet/spool.h"
#include "tools/text/error.h"
#include "tools/text/wall_time.h"

namespace vernier::fleet {
namespace {

using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

// A record is safe from the gateway's own death after so long; a medium is asked to sync so often.
constexpr auto kWriteEvery = 250ms;
constexpr auto kLoopPatience = 50ms;
// Unconfirmed records on their way; enough for a second of a large gateway, little enough to repeat.
constexpr std::uint64_t kWindow = 2000;
constexpr std::size_t kRecordsARead = 200;
constexpr auto kRepeatAfter = 5s;
constexpr auto kLongestPause = 30s;
// A sample that is older was not sent as it came.
constexpr std::uint64_t kFreshMs = 5000;

std::uint64_t wall_ms() { return static_cast<std::uint64_t>(text::now_ms()); }

/// Between the threads that read boards, the one that writes the spool and the one that publishes.
class GatewayDesk {
 public:
  explicit GatewayDesk(const GatewayFile& file)
      : spool_(file.store, file.group + "/" + file.name, file.most_records) {}

  void put(const std::string& machine, const std::vector<Metric>& metrics) {
    const std::uint64_t now = wall_ms();
    SparkplugPayload payload;
    payload.time_ms = now;
    payload.metrics = metrics;
    const std::lock_guard lock(mutex_);
    waiting_.push_back({0, machine, now, encode(payload)});
    away_.erase(machine);
  }
  void lose(const std::string& machine) {
    const std::lock_guard lock(mutex_);
    away_.insert(machine);
  }
  std::set<std::string> away() {
    const std::lock_guard lock(mutex_);
    return away_;
  }
  /// Writes down what waits.
  void write() {
    std::vector<SpoolRecord> records;
    {
      const std::lock_guard lock(mutex_);
      records.swap(waiting_);
    }
    const std::lock_guard lock(spool_mutex_);
    spool_.take(records);
  }
  /// With the spool in hand.
  template <class Work>
  auto with_spool(Work work) {
    const std::lock_guard lock(spool_mutex_);
    return work(spool_);
  }

 private:
  std::mutex mutex_, spool_mutex_;
  std::vector<SpoolRecord> waiting_;
  std::set<std::string> away_;
  Spool spool_;
};

/// Waits, but no longer than until `stop`.
void rest(std::chrono::nanoseconds time, const std::atomic<bool>& stop) {
  const auto end = Clock::now() + time;
  while (!stop && Clock::now() < end)
    std::this_thread::sleep_for(std::min<std::chrono::nanoseconds>(end - Clock::now(), 100ms));
}

void read_board(const GatewayBoard& board, double period_s, GatewayDesk& desk, const std::atomic<bool>& stop,
                const Say& say) {
  const auto period = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(period_s));
  std::unique_ptr<BoardReader> reader;
  Clock::duration pause = 1s;
  std::string before;
  auto due = Clock::now();
  while (!stop) {
    try {
      if (!reader) reader = std::make_unique<BoardReader>(board);
      desk.put(board.machine, reader->read());
      if (!before.empty()) say(board.machine + ": is back");
      before.clear();
      pause = 1s;
      due = std::max(due + period, Clock::now() - period);
      rest(due - Clock::now(), stop);
    } catch (const std::exception& error) {
      reader.reset();
      desk.lose(board.machine);
      if (before != error.what()) say(board.machine + ": " + error.what());
      before = error.what();
      rest(pause, stop);
      pause = std::min<Clock::duration>(2 * pause, kLongestPause);
      due = Clock::now();
    }
  }
}

/// The publishing side: one connection after the other.
class GatewayPublisher {
 public:
  GatewayPublisher(const GatewayFile& file, GatewayDesk& desk, const Say& say)
      : file_(file), desk_(desk), say_(say) {}

  /// Connects, waits for the host, publishes until the connection ends or the host goes.
  void run_connection(const std::atomic<bool>& stop) {
    const std::uint64_t number = desk_.with_spool([](Spool& spool) { return spool.next_birth(); });
    EdgeNode node(file_.broker, file_.group, file_.name, file_.host, number);
    say_("connected to " + file_.broker.address);
    host_ = false;
    while (!stop && node.connection().connected()) {
      const bool was = host_;
      hear(node);
      if (was && !host_) break;
      if (host_ && !node.born() && !give_birth(node)) break;
      if (node.born() && !publish(node)) break;
    }
    if (node.connection().connected()) node.part();
    say_(stop    ? "parted"
         : host_ ? "the connection to the broker is lost"
                 : "the registry host is not connected: the gateway stores the samples");
  }

 private:
  bool give_birth(EdgeNode& node) {
    const auto [id, stored] =
        desk_.with_spool([](Spool& spool) { return std::pair(spool.id(), spool.stored()); });
    sent_ = stored;
    progress_ = Clock::now();
    return node.birth({{std::string(kSpoolMetric), id},
                       {std::string(kStoredMetric), stored},
                       {std::string(kResendMetric), false}});
  }

  void hear(EdgeNode& node) {
    for (const MqttMessage& message : node.connection().take(kLoopPatience)) {
      if (message.topic == state_topic(file_.host)) {
        host_ = online_of(message.payload).value_or(host_);
        continue;
      }
      if (const auto payload = decode(message.payload)) obey(node, *payload);
    }
  }

  void obey(EdgeNode& node, const SparkplugPayload& command) {
    if (const Metric* rebirth = command.find(kRebirthMetric);
        rebirth != nullptr && rebirth->value == MetricValue(true) && node.born()) {
      const std::uint64_t sent = sent_;
      give_birth(node);
      sent_ = sent;  // a birth repeats no data
    }
    const auto stored = count_of(command.find(kStoredMetric));
    if (!stored) return;
    const Metric* const resend = command.find(kResendMetric);
    const bool again = resend != nullptr && resend->value == MetricValue(true);
    desk_.with_spool([&](Spool& spool) {
      if (text_of(command.find(kSpoolMetric)) != spool.id()) return;
      if (*stored > spool.last()) {
        say_("the registry has later samples than this store: the store is an older copy, and gets a new id");
        spool.begin_anew();
        sent_ = 0;
        return;
      }
      if (*stored > spool.stored()) progress_ = Clock::now();
      spool.stored(*stored);
      if (again) sent_ = *stored;
      sent_ = std::max(sent_, std::min(*stored, spool.last()));
    });
  }

  bool publish(EdgeNode& node) {
    const auto [records, id] = desk_.with_spool([&](Spool& spool) {
      if (sent_ == spool.stored()) progress_ = Clock::now();
      if (Clock::now() - progress_ > kRepeatAfter) {
        sent_ = spool.stored();
        progress_ = Clock::now();
      }
      const std::uint64_t room = kWindow - std::min(kWindow, sent_ - std::min(sent_, spool.stored()));
      return std::pair(spool.after(sent_, std::min<std::size_t>(room, kRecordsARead)), spool.id());
    });
    for (const SpoolRecord& record : records) {
      auto payload = decode(record.payload);
      // A machine's name is a level of a topic (MQTT 5.0, 4.7).
      if (!payload || record.machine.empty() || record.machine.find_first_of("+#/") != std::string::npos) {
        desk_.with_spool([&](Spool& spool) { spool.set_aside({record.number}); });
        continue;
      }
      const bool old = record.time_ms + kFreshMs < wall_ms();
      for (Metric& metric : payload->metrics) metric.historical = old;
      payload->metrics.push_back({std::string(kSpoolMetric), id, record.time_ms, old});
      payload->metrics.push_back({std::string(kNumberMetric), record.number, record.time_ms, old});
      payload->metrics.push_back({std::string(kAfterMetric), sent_, record.time_ms, old});
      if (!node.data(record.machine, std::move(*payload))) return false;
      sent_ = record.number;
    }
    tell_aside();
    if (!records.empty()) return true;
    for (const std::string& machine : desk_.away())
      if (!node.death(machine)) return false;
    return true;
  }

  void tell_aside() {
    const auto [count, file] =
        desk_.with_spool([](Spool& spool) { return std::pair(spool.count_aside(), spool.aside()); });
    if (count > told_aside_)
      say_(fmt::format("{} damaged records of the store are set aside in {}; the other records are sent",
                       std::to_string(count), file));
    told_aside_ = count;
  }

  const GatewayFile& file_;
  GatewayDesk& desk_;
  const Say& say_;
  bool host_ = false;
  std::uint64_t sent_ = 0;  // the last number that went out on this connection, or is stored
  Clock::time_point progress_{};
  std::uint64_t told_aside_ = 0;
};

}  // namespace

void run_gateway(const GatewayFile& file, const std::atomic<bool>& stop, const Say& say) {
  GatewayDesk desk(file);
  std::atomic<bool> end{false};
  std::mutex failed_mutex;
  std::string failed;
  std::vector<std::thread> threads;
  for (const GatewayBoard& board : file.boards)
    threads.emplace_back([&] { read_board(board, file.period_s, desk, end, say); });
  threads.emplace_back([&] {
    try {
      while (!end) {
        rest(kWriteEvery, end);
        desk.write();
      }
    } catch (const registry::DatabaseError& error) {
      const std::lock_guard lock(failed_mutex);
      failed = error.what();
      end = true;
    }
  });
  GatewayPublisher publisher(file, desk, say);
  std::string before;
  std::thread watch([&] {
    while (!stop && !end) std::this_thread::sleep_for(20ms);
    end = true;
  });
  while (!end) {
    try {
      publisher.run_connection(end);
      before.clear();
    } catch (const text::InputError& error) {
      if (before != error.what()) say(error.what());
      before = error.what();
    } catch (const registry::DatabaseError& error) {
      const std::lock_guard lock(failed_mutex);
      failed = error.what();
      end = true;
    }
    rest(1s, end);
  }
  for (std::thread& thread : threads) thread.join();
  watch.join();
  if (!failed.empty()) throw registry::DatabaseError(failed);
  desk.write();
}

}  // namespace vernier::fleet
