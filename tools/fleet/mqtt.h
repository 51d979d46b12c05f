// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace vernier::fleet {

/// Address of an MQTT broker, and the credentials of the client.
struct Broker {
  std::string address = "tcp://localhost:1883";  // the other form is ssl://HOST:8883
  std::string user, password;                    // empty: no credentials
  std::string authority;  // PEM file of the authority that signs the broker's certificate; only for ssl
};

/// Throws InputError if an address does not have the form tcp://HOST[:PORT] or ssl://HOST[:PORT], because
/// repeated attempts cannot find such a broker.
void require_broker_address(const std::string& address);

struct MqttMessage {
  std::string topic, payload;
  bool retained = false;  // true: the message was stored at the broker before this client connected
};

/// The message that the broker publishes if the connection ends without a disconnect message (MQTT will).
struct MqttWill {
  std::string topic, payload;
  bool retained = false;
};

/// A connection to an MQTT broker (MQTT 3.1.1, clean session). A thread of the MQTT library keeps the
/// received messages until take() returns them.
class MqttConnection {
 public:
  /// Connects to the broker. Throws InputError with the address if the connection is not possible.
  MqttConnection(const Broker& broker, const std::string& client, const MqttWill& will);
  ~MqttConnection();  // if part() was not called, no disconnect message is sent, and the broker publishes the
                      // will
  MqttConnection(const MqttConnection&) = delete;
  MqttConnection& operator=(const MqttConnection&) = delete;

  bool connected() const;
  void subscribe(const std::string& filter, int qos);
  /// Publishes a message on a topic. Sparkplug requires QoS 0 for data and births, and QoS 1 for STATE.
  /// Returns false if the connection is lost.
  bool publish(const std::string& topic, const std::string& payload, int qos = 0, bool retained = false);
  /// Returns the received messages, at most `most`. The function waits for the first message for at most
  /// `patience`.
  std::vector<MqttMessage> take(std::chrono::milliseconds patience, std::size_t most = 1000);
  /// Disconnects with a disconnect message, so that the broker does not publish the will.
  void part();

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;
};

}  // namespace vernier::fleet
