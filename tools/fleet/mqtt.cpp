// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fleet/mqtt.h"

#include <MQTTClient.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <deque>
#include <mutex>

#include "tools/text/error.h"
#include "tools/text/numbers.h"

namespace vernier::fleet {
namespace {

constexpr int kKeepAliveS = 20, kConnectS = 5, kFarewellMs = 1000;
// Largest number of messages that wait here. Further messages are discarded; the sequence numbers of the
// sender show the gap.
constexpr std::size_t kMostWaiting = 200'000;

}  // namespace

struct MqttConnection::Inside {
  MQTTClient client = nullptr;
  std::mutex mutex;
  std::condition_variable came;
  std::deque<MqttMessage> waiting;
  std::atomic<bool> lost{false};

  static int arrived(void* context, char* topic, int topic_bytes, MQTTClient_message* message) {
    auto& self = *static_cast<Inside*>(context);
    MqttMessage one{
        topic_bytes > 0 ? std::string(topic, static_cast<std::size_t>(topic_bytes)) : std::string(topic),
        std::string(static_cast<const char*>(message->payload),
                    static_cast<std::size_t>(message->payloadlen)),
        message->retained != 0};
    {
      const std::lock_guard lock(self.mutex);
      if (self.waiting.size() < kMostWaiting) self.waiting.push_back(std::move(one));
    }
    self.came.notify_one();
    MQTTClient_freeMessage(&message);
    MQTTClient_free(topic);
    return 1;
  }
  static void gone(void* context, char*) {
    auto& self = *static_cast<Inside*>(context);
    self.lost = true;
    self.came.notify_one();
  }
};

void require_broker_address(const std::string& address) {
  constexpr std::size_t kMostPort = 65535;
  const std::size_t scheme = address.starts_with("tcp://") || address.starts_with("ssl://") ? 6 : 0;
  const std::string place = address.substr(scheme);
  // An IPv6 address is written in brackets; its colons do not separate a port.
  const std::size_t colon =
      place.find(':', place.starts_with("[") ? std::min(place.find(']'), place.size()) : 0);
  const std::string host = place.substr(0, colon);
  const auto port = colon == std::string::npos ? std::optional<std::size_t>(1883)
                                               : text::parse_count(std::string_view(place).substr(colon + 1));
  const bool named = !host.empty() && host.find_first_of(" \t\n/@") == std::string::npos;
  if (scheme == 0 || !named || !port || *port == 0 || *port > kMostPort)
    throw text::InputError({}, address, "the address must be tcp://HOST:1883 or ssl://HOST:8883");
}

MqttConnection::MqttConnection(const Broker& broker, const std::string& client, const MqttWill& will)
    : inside_(std::make_unique<Inside>()) {
  const auto fail = [&](int code) {
    const char* const why = MQTTClient_strerror(code);
    if (inside_->client != nullptr) MQTTClient_destroy(&inside_->client);
    throw text::InputError(
        {}, broker.address,
        std::string("no broker answers at this address: ") + (why == nullptr ? "refused" : why));
  };
  int code = MQTTClient_create(&inside_->client, broker.address.c_str(), client.c_str(),
                               MQTTCLIENT_PERSISTENCE_NONE, nullptr);
  if (code != MQTTCLIENT_SUCCESS) fail(code);
  MQTTClient_setCallbacks(inside_->client, inside_.get(), Inside::gone, Inside::arrived, nullptr);
  MQTTClient_connectOptions options = MQTTClient_connectOptions_initializer;
  options.keepAliveInterval = kKeepAliveS;
  options.cleansession = 1;
  options.connectTimeout = kConnectS;
  options.MQTTVersion = MQTTVERSION_3_1_1;
  MQTTClient_willOptions last = MQTTClient_willOptions_initializer;
  last.topicName = will.topic.c_str();
  last.payload = {static_cast<int>(will.payload.size()), will.payload.data()};
  last.qos = 1;
  last.retained = will.retained ? 1 : 0;
  if (!will.topic.empty()) options.will = &last;
  if (!broker.user.empty()) options.username = broker.user.c_str();
  if (!broker.password.empty()) options.password = broker.password.c_str();
  MQTTClient_SSLOptions ssl = MQTTClient_SSLOptions_initializer;
  ssl.verify = 1;
  if (!broker.authority.empty()) ssl.trustStore = broker.authority.c_str();
  if (broker.address.starts_with("ssl://")) options.ssl = &ssl;
  code = MQTTClient_connect(inside_->client, &options);
  if (code != MQTTCLIENT_SUCCESS) fail(code);
}

MqttConnection::~MqttConnection() {
  // The destructor sends no disconnect message: the broker detects the lost connection and publishes the
  // will.
  MQTTClient_destroy(&inside_->client);
}

bool MqttConnection::connected() const {
  return !inside_->lost && MQTTClient_isConnected(inside_->client) != 0;
}

void MqttConnection::subscribe(const std::string& filter, int qos) {
  const int code = MQTTClient_subscribe(inside_->client, filter.c_str(), qos);
  if (code != MQTTCLIENT_SUCCESS) throw text::InputError({}, filter, "the broker refuses the subscription");
}

bool MqttConnection::publish(const std::string& topic, const std::string& payload, int qos, bool retained) {
  if (!connected()) return false;
  return MQTTClient_publish(inside_->client, topic.c_str(), static_cast<int>(payload.size()), payload.data(),
                            qos, retained ? 1 : 0, nullptr) == MQTTCLIENT_SUCCESS;
}

std::vector<MqttMessage> MqttConnection::take(std::chrono::milliseconds patience, std::size_t most) {
  std::unique_lock lock(inside_->mutex);
  inside_->came.wait_for(lock, patience, [&] { return !inside_->waiting.empty() || inside_->lost; });
  std::vector<MqttMessage> taken;
  while (!inside_->waiting.empty() && taken.size() < most) {
    taken.push_back(std::move(inside_->waiting.front()));
    inside_->waiting.pop_front();
  }
  return taken;
}

void MqttConnection::part() { MQTTClient_disconnect(inside_->client, kFarewellMs); }

}  // namespace vernier::fleet
