// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fleet/ingest.h"

#include <fmt/format.h>

#include <chrono>
#include <map>
#include <nlohmann/json.hpp>
#include <thread>

#include "tools/fleet/sample_writer.h"
#include "tools/registry/open_database.h"
#include "tools/text/error.h"
#include "tools/text/wall_time.h"

namespace vernier::fleet {
namespace {

using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

constexpr auto kBatchPatience = 200ms;
constexpr std::size_t kMessagesABatch = 2000;
constexpr auto kPauseBetweenTries = 500ms;
constexpr auto kRebirthEvery = 5s;

std::uint64_t ms_now() { return static_cast<std::uint64_t>(text::now_ms()); }

/// Known data of an edge node on this connection.
struct NodeState {
  bool born = false, dead = false;
  std::uint64_t next_seq = 0, death = 0;
  Clock::time_point asked{};  // for a rebirth
};

/// One connection to the broker with one to the database.
class Listener {
 public:
  Listener(const IngestOptions& options, registry::Registry& registry, const Say& say)
      : options_(options),
        say_(say),
        writer_(registry),
        connection_(options.broker, "vernier-host-" + options.host,
                    {state_topic(options.host), state_text(false, ms_now()), true}) {
    writer_.online("", "", false);
    connection_.subscribe("spBv1.0/" + options.group + "/+/#", 1);
    connection_.publish(state_topic(options.host), state_text(true, ms_now()), 1, true);
  }

  bool connected() const { return connection_.connected(); }

  void step() {
    std::vector<DeviceData> data;
    for (const MqttMessage& message : connection_.take(kBatchPatience, kMessagesABatch)) {
      const auto topic = parse_topic(message.topic);
      if (!topic || topic->kind == SparkplugKind::kNCmd || topic->kind == SparkplugKind::kDCmd) continue;
      auto payload = decode(message.payload);
      if (!payload) continue;
      follow(*topic, *payload);
      if (topic->kind == SparkplugKind::kDData)
        data.push_back({topic->node, topic->device, std::move(*payload)});
    }
    for (const auto& [gateway, receipt] : writer_.write(data)) tell(gateway, receipt);
    for (const std::string& machine : writer_.take_not_entered())
      say_(
          fmt::format("machine {} is not in the registry: its samples are not stored. The owner enters a "
                      "machine with `vernier fleet add`",
                      nlohmann::json(machine).dump(-1, ' ', true, nlohmann::json::error_handler_t::replace)));
    ask_for_births();
  }

  /// Publishes that no data are stored here at present.
  void part() {
    if (connected()) connection_.publish(state_topic(options_.host), state_text(false, ms_now()), 1, true);
    connection_.part();
  }

 private:
  /// Births, deaths and the numbers in between, by the rules of Sparkplug 3.0.0, 6.4.
  void follow(const SparkplugTopic& topic, const SparkplugPayload& payload) {
    NodeState& node = nodes_[topic.node];
    if (topic.kind == SparkplugKind::kNDeath) {
      if (count_of(payload.find(kDeathMetric)) != node.death || !node.born) return;
      node.born = false;
      node.dead = true;
      writer_.online(topic.node, "", false);
      return;
    }
    node.dead = false;
    if (topic.kind == SparkplugKind::kNBirth) {
      node.born = true;
      node.death = count_of(payload.find(kDeathMetric)).value_or(0);
    } else if (!payload.seq || *payload.seq != node.next_seq) {
      node.born = false;
    }
    node.next_seq = (payload.seq.value_or(0) + 1) % 256;
    if (topic.kind == SparkplugKind::kDDeath) writer_.online(topic.node, topic.device, false);
  }

  void tell(const std::string& gateway, const Receipt& receipt) {
    command(gateway, {{std::string(kSpoolMetric), receipt.spool},
                      {std::string(kStoredMetric), receipt.stored},
                      {std::string(kResendMetric), receipt.resend}});
  }

  void ask_for_births() {
    for (auto& [name, node] : nodes_) {
      if (node.born || node.dead || Clock::now() - node.asked < kRebirthEvery) continue;
      node.asked = Clock::now();
      command(name, {{std::string(kRebirthMetric), true}});
    }
  }

  void command(const std::string& gateway, std::vector<Metric> metrics) {
    SparkplugPayload payload;
    payload.time_ms = ms_now();
    payload.metrics = std::move(metrics);
    connection_.publish(topic_text({options_.group, gateway, "", SparkplugKind::kNCmd}), encode(payload));
  }

  const IngestOptions& options_;
  const Say& say_;
  SampleWriter writer_;
  std::map<std::string, NodeState> nodes_;
  MqttConnection connection_;
};

}  // namespace

void run_ingest(const IngestOptions& options, const std::atomic<bool>& stop, const Say& say) {
  std::string before;
  bool begun = false;
  while (!stop) {
    try {
      registry::Registry registry(registry::open_database(options.registry));
      begun = true;
      Listener listener(options, registry, say);
      say("writes into " + registry.database().name());
      before.clear();
      try {
        while (!stop && listener.connected()) listener.step();
        say(stop ? "parted" : "the connection to the broker is lost");
        listener.part();
      } catch (const registry::DatabaseError&) {
        listener.part();
        throw;
      }
    } catch (const std::runtime_error& error) {
      // A server may be unavailable for a while. A file that is not a registry at the beginning is a typing
      // error.
      if (!begun && !registry::is_server(options.registry)) throw;
      if (before != error.what()) say(error.what());
      before = error.what();
    }
    for (auto end = Clock::now() + kPauseBetweenTries; !stop && Clock::now() < end;)
      std::this_thread::sleep_for(20ms);
  }
}

}  // namespace vernier::fleet
