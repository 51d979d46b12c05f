// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace vernier::fleet {

/// Value of a metric. The C++ type of the metric determines the datatype of Sparkplug: Double, Int64, UInt64,
/// Boolean, String.
using MetricValue = std::variant<double, std::int64_t, std::uint64_t, bool, std::string>;

/// A named value of a Sparkplug message.
struct Metric {
  std::string name;
  MetricValue value;
  std::uint64_t time_ms = 0;  // time since 1970; 0: the time of the payload
  bool historical = false;    // true: the value had to wait for the broker or the host
  bool operator==(const Metric&) const = default;
};

/// Content of a Sparkplug message (Sparkplug 3.0.0, 6.4).
struct SparkplugPayload {
  std::uint64_t time_ms = 0;
  std::optional<std::uint64_t> seq;  // sequence number 0..255; no value in NDEATH and commands
  std::vector<Metric> metrics;
  /// Returns the metric with the name `name`; null if there is no such metric.
  const Metric* find(std::string_view name) const;
};

/// Convert a payload to bytes and bytes to a payload. decode() returns nullopt if the bytes are not a
/// payload. decode() omits a metric with an unsupported type, a null metric, and a text that is not UTF-8
/// without NUL.
std::string encode(const SparkplugPayload& payload);
std::optional<SparkplugPayload> decode(std::string_view bytes);

/// Returns the value of a metric of any integer type as a whole number; nullopt for other values.
std::optional<std::uint64_t> count_of(const Metric* metric);
/// Returns the value of a metric that is a text; nullopt for other values.
std::optional<std::string> text_of(const Metric* metric);

enum class SparkplugKind : std::uint8_t { kNBirth, kNDeath, kNData, kNCmd, kDBirth, kDDeath, kDData, kDCmd };

/// Parts of a Sparkplug topic "spBv1.0/GROUP/KIND/NODE[/DEVICE]".
struct SparkplugTopic {
  std::string group, node, device;
  SparkplugKind kind = SparkplugKind::kNData;
};
std::string topic_text(const SparkplugTopic& topic);
/// Parses the topic of an edge node; nullopt if the text is not such a topic.
std::optional<SparkplugTopic> parse_topic(std::string_view text);
/// Returns the topic on which a host application publishes its state.
std::string state_topic(const std::string& host);
/// Returns the state message of a host application: JSON of Sparkplug 3.0.0, 6.4.24.
std::string state_text(bool online, std::uint64_t time_ms);
/// Returns true if the state message reports that the host is online, and false if it is offline; nullopt for
/// any other text.
std::optional<bool> online_of(std::string_view state);

/// True if a Sparkplug topic can contain this name. The name must not be empty, must not contain + / #, and
/// must be printable.
bool fits_a_topic(std::string_view name);

/// Names of the metrics with which a gateway and the registry exchange the numbers of stored records
/// (tools/docs/fleet.md).
inline constexpr std::string_view kSpoolMetric = "Vernier/Spool", kNumberMetric = "Vernier/Number",
                                  kAfterMetric = "Vernier/After", kStoredMetric = "Vernier/Stored",
                                  kResendMetric = "Vernier/Resend", kRebirthMetric = "Node Control/Rebirth",
                                  kDeathMetric = "bdSeq";

}  // namespace vernier::fleet
