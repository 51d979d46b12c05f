// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace vernier::fleet {

/// Address of a broker and the credentials of the client.
struct Broker {
  std::string address = "tcp://localhost:1883";  // or ssl://HOST:8883
  std::string user, password;                    // empty: none
  std::string authority;  // file (PEM) of the authority that signs the broker; ssl only
};

/// Throws InputError if an address has not the form tcp://HOST[:PORT] or ssl://HOST[:PORT], because no retry
/// can find such a broker.
void require_broker_address(const std::string& address);

struct MqttMessage {
  std::string topic, payload;
  bool retained = false;  // it was there before we came
};

/// The message that the broker publishes if the connection ends without a disconnect message.
struct MqttWill {
  std::string topic, payload;
  bool retained = false;
};

/// A connection to a broker (MQTT 3.1.1, clean session). A thread of the library keeps received messages
/// until take() returns them.
class MqttConnection {
 public:
  /// Connects. Throws InputError naming the address.
  MqttConnection(const Broker& broker, const std::string& client, const MqttWill& will);
  ~MqttConnection();  // without part() no disconnect message is sent: the broker publishes the will
  MqttConnection(const MqttConnection&) = delete;
  MqttConnection& operator=(const MqttConnection&) = delete;

  bool connected() const;
  void subscribe(const std::string& filter, int qos);
  /// Publishes a message. QoS 0 is what Sparkplug requires for data and births; QoS 1 is for STATE. False:
  /// the connection is gone.
  bool publish(const std::string& topic, const std::string& payload, int qos = 0, bool retained = false);
  /// Returns the received messages, at most `most`; waits up to `patience` for the first message.
  std::vector<MqttMessage> take(std::chrono::milliseconds patience, std::size_t most = 1000);
  /// Disconnects in order: the broker does not publish the will.
  void part();

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;
};

}  // namespace vernier::fleet
