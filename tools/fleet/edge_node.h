// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <map>
#include <string>

#include "tools/fleet/mqtt.h"
#include "tools/fleet/sparkplug.h"

namespace vernier::fleet {

/// One connection of a Sparkplug edge node: births before data, sequence numbers without a gap, the death
/// certificate as the MQTT will (Sparkplug 3.0.0, chapter 5). Every call of EdgeNode returns false once the
/// connection is lost.
class EdgeNode {
 public:
  /// Connects with the MQTT will, and subscribes to commands and to the state of `host`. Throws InputError.
  EdgeNode(const Broker& broker, std::string group, std::string node, const std::string& host,
           std::uint64_t death_number);

  MqttConnection& connection() { return connection_; }
  /// Publishes the birth of the node with metrics in addition to bdSeq and Rebirth; after it no device has a
  /// valid birth.
  bool birth(const std::vector<Metric>& metrics);
  bool born() const { return born_; }
  /// Publishes data of a device; publishes the birth of the device first if names or types are new.
  bool data(const std::string& device, SparkplugPayload payload);
  /// Publishes that the device is not connected (DDEATH); sends no message if the device had no birth
  /// certificate.
  bool death(const std::string& device);
  /// Publishes the death certificate of the node, as its MQTT will does, and disconnects.
  void part();

 private:
  bool send(SparkplugKind kind, const std::string& device, SparkplugPayload payload);

  std::string group_, node_;
  std::uint64_t death_number_, next_seq_ = 0;
  bool born_ = false;
  std::map<std::string, std::string> shapes_;  // of the devices that are born
  MqttConnection connection_;
};

}  // namespace vernier::fleet
