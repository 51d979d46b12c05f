// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <map>
#include <string>

#include "tools/fleet/mqtt.h"
#include "tools/fleet/sparkplug.h"

namespace vernier::fleet {

/// One connection of a Sparkplug edge node to a broker (Sparkplug 3.0.0, chapter 5). Births are sent before
/// data, sequence numbers have no gap, and the death certificate is the MQTT will. Every function of EdgeNode
/// returns false after the connection is lost.
class EdgeNode {
 public:
  /// Connects with the MQTT will, and subscribes to commands and to the state of the host application `host`.
  /// Throws InputError if the connection is not possible.
  EdgeNode(const Broker& broker, std::string group, std::string node, const std::string& host,
           std::uint64_t death_number);

  MqttConnection& connection() { return connection_; }
  /// Publishes the birth of the node with its metrics, bdSeq and Rebirth. After a birth of the node, the
  /// earlier births of all its devices are invalid.
  bool birth(const std::vector<Metric>& metrics);
  bool born() const { return born_; }
  /// Publishes data of a device. If names or types are new, the birth of the device is published first.
  bool data(const std::string& device, SparkplugPayload payload);
  /// Publishes that the device is not connected (DDEATH). If the device had no birth certificate, no message
  /// is sent.
  bool death(const std::string& device);
  /// Publishes the death certificate of the node (with the content of the MQTT will) and disconnects.
  void part();

 private:
  bool send(SparkplugKind kind, const std::string& device, SparkplugPayload payload);

  std::string group_, node_;
  std::uint64_t death_number_, next_seq_ = 0;
  bool born_ = false;
  std::map<std::string, std::string> shapes_;  // metric names and types of the devices with a valid birth
  MqttConnection connection_;
};

}  // namespace vernier::fleet
