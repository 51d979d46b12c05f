// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace vernier::fleet {

/// A value of a metric; the alternative decides Sparkplug's datatype: Double, Int64, UInt64, Boolean, String.
using MetricValue = std::variant<double, std::int64_t, std::uint64_t, bool, std::string>;

/// A named value of a Sparkplug message.
struct Metric {
  std::string name;
  MetricValue value;
  std::uint64_t time_ms = 0;  // since 1970; 0: as its payload
  bool historical = false;    // it waited for the broker or the host
  bool operator==(const Metric&) const = default;
};

/// Contents of a message (Sparkplug 3.0.0, 6.4).
struct SparkplugPayload {
  std::uint64_t time_ms = 0;
  std::optional<std::uint64_t> seq;  // 0..255; absent in NDEATH and commands
  std::vector<Metric> metrics;
  /// Returns the metric of this name; null if no metric has the name.
  const Metric* find(std::string_view name) const;
};

/// Converts a payload to bytes, and back; `nullopt` if the bytes are not a payload. A metric is skipped if
/// its type is not supported here, if it is null, or if its text is not UTF-8 without NUL.
std::string encode(const SparkplugPayload& payload);
std::optional<SparkplugPayload> decode(std::string_view bytes);

/// A whole number of any integer type; `nullopt` for other values.
std::optional<std::uint64_t> count_of(const Metric* metric);
/// A text; `nullopt` for other values.
std::optional<std::string> text_of(const Metric* metric);

enum class SparkplugKind : std::uint8_t { kNBirth, kNDeath, kNData, kNCmd, kDBirth, kDDeath, kDData, kDCmd };

/// "spBv1.0/GROUP/KIND/NODE[/DEVICE]".
struct SparkplugTopic {
  std::string group, node, device;
  SparkplugKind kind = SparkplugKind::kNData;
};
std::string topic_text(const SparkplugTopic& topic);
/// Parses the topic of an edge node; `nullopt` if the text is no such topic.
std::optional<SparkplugTopic> parse_topic(std::string_view text);
/// Returns the topic on which a host application publishes its state.
std::string state_topic(const std::string& host);
/// The state message: JSON of Sparkplug 3.0.0, 6.4.24.
std::string state_text(bool online, std::uint64_t time_ms);
/// True if the text reports that the host is online; `nullopt` for any other text.
std::optional<bool> online_of(std::string_view state);

/// True if a topic can contain this name: not empty, no + / #, printable.
bool fits_a_topic(std::string_view name);

/// Names of the metrics with which a gateway and the registry agree on the stored records
/// (tools/docs/fleet.md).
inline constexpr std::string_view kSpoolMetric = "Vernier/Spool", kNumberMetric = "Vernier/Number",
                                  kAfterMetric = "Vernier/After", kStoredMetric = "Vernier/Stored",
                                  kResendMetric = "Vernier/Resend", kRebirthMetric = "Node Control/Rebirth",
                                  kDeathMetric = "bdSeq";

}  // namespace vernier::fleet
