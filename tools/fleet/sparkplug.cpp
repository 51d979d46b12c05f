// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fleet/sparkplug.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include <sparkplug_b.pb.h>
#include "tools/text/words.h"

namespace vernier::fleet {
namespace {

using Message = sparkplug_messages::Payload;

// Numbers of the data types (Sparkplug 3.0.0, 6.4.16).
enum DataType : std::uint32_t {
  kInt8 = 1,
  kInt32 = 3,
  kInt64 = 4,
  kUInt8 = 5,
  kUInt64 = 8,
  kFloat = 9,
  kDouble = 10,
  kBoolean = 11,
  kString = 12,
  kDateTime = 13,
  kText = 14,
};

constexpr std::array<std::string_view, 8> kKinds = {"NBIRTH", "NDEATH", "NDATA", "NCMD",
                                                    "DBIRTH", "DDEATH", "DDATA", "DCMD"};
constexpr std::string_view kRoot = "spBv1.0";

/// UTF-8 without NUL (RFC 3629): what every database takes as a text.
bool is_text(std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    const auto first = static_cast<unsigned char>(text[at++]);
    const int more = first < 0x80                    ? 0
                     : first >= 0xC2 && first < 0xE0 ? 1
                     : (first & 0xF0u) == 0xE0       ? 2
                     : first >= 0xF0 && first < 0xF5 ? 3
                                                     : -1;
    if (first == 0 || more < 0) return false;
    std::uint32_t letter = more == 0 ? first : first & (0x3Fu >> static_cast<unsigned>(more));
    for (int i = 0; i < more; ++i, ++at) {
      if (at == text.size() || (static_cast<unsigned char>(text[at]) & 0xC0u) != 0x80u) return false;
      letter = letter << 6 | (static_cast<unsigned char>(text[at]) & 0x3Fu);
    }
    constexpr std::uint32_t kLeast[] = {0, 0x80, 0x800, 0x10000};
    if (letter < kLeast[more] || letter > 0x10FFFF || (letter >= 0xD800 && letter < 0xE000)) return false;
  }
  return true;
}

struct PutValue {
  Message::Metric& to;
  void operator()(double value) const { to.set_datatype(kDouble), to.set_double_value(value); }
  // Signed numbers travel as their two's complement (6.4.16).
  void operator()(std::int64_t value) const {
    to.set_datatype(kInt64), to.set_long_value(static_cast<std::uint64_t>(value));
  }
  void operator()(std::uint64_t value) const { to.set_datatype(kUInt64), to.set_long_value(value); }
  void operator()(bool value) const { to.set_datatype(kBoolean), to.set_boolean_value(value); }
  void operator()(const std::string& value) const { to.set_datatype(kString), to.set_string_value(value); }
};

std::int64_t extended(std::uint32_t bits, std::uint32_t type) {
  if (type == kInt8) return static_cast<std::int8_t>(bits);
  if (type == kInt8 + 1) return static_cast<std::int16_t>(bits);
  return static_cast<std::int32_t>(bits);
}

std::optional<MetricValue> value_of(const Message::Metric& metric) {
  if (metric.is_null()) return {};
  const std::uint32_t type = metric.datatype();
  switch (metric.value_case()) {
    case Message::Metric::kDoubleValue:
      return metric.double_value();
    case Message::Metric::kFloatValue:
      return static_cast<double>(metric.float_value());
    case Message::Metric::kBooleanValue:
      return metric.boolean_value();
    case Message::Metric::kStringValue:
      if (!is_text(metric.string_value())) return {};
      return metric.string_value();
    case Message::Metric::kLongValue:
      if (type == kInt64) return static_cast<std::int64_t>(metric.long_value());
      return static_cast<std::uint64_t>(metric.long_value());
    case Message::Metric::kIntValue:
      if (type >= kInt8 && type <= kInt32) return extended(metric.int_value(), type);
      return static_cast<std::uint64_t>(metric.int_value());
    default:
      return {};
  }
}

}  // namespace

const Metric* SparkplugPayload::find(std::string_view name) const {
  const auto found =
      std::find_if(metrics.begin(), metrics.end(), [&](const Metric& one) { return one.name == name; });
  return found == metrics.end() ? nullptr : &*found;
}

std::string encode(const SparkplugPayload& payload) {
  Message message;
  message.set_timestamp(payload.time_ms);
  if (payload.seq) message.set_seq(*payload.seq);
  for (const Metric& metric : payload.metrics) {
    Message::Metric& to = *message.add_metrics();
    to.set_name(metric.name);
    to.set_timestamp(metric.time_ms != 0 ? metric.time_ms : payload.time_ms);
    if (metric.historical) to.set_is_historical(true);
    std::visit(PutValue{to}, metric.value);
  }
  return message.SerializeAsString();
}

std::optional<SparkplugPayload> decode(std::string_view bytes) {
  Message message;
  if (bytes.size() > INT32_MAX || !message.ParseFromArray(bytes.data(), static_cast<int>(bytes.size())))
    return {};
  SparkplugPayload payload;
  payload.time_ms = message.timestamp();
  if (message.has_seq()) payload.seq = message.seq();
  for (const Message::Metric& metric : message.metrics()) {
    std::optional<MetricValue> value = value_of(metric);
    if (!value || metric.name().empty() || !is_text(metric.name())) continue;
    payload.metrics.push_back({metric.name(), std::move(*value),
                               metric.has_timestamp() ? metric.timestamp() : payload.time_ms,
                               metric.is_historical()});
  }
  return payload;
}

std::optional<std::uint64_t> count_of(const Metric* metric) {
  if (metric == nullptr) return {};
  if (const auto* value = std::get_if<std::uint64_t>(&metric->value)) return *value;
  if (const auto* value = std::get_if<std::int64_t>(&metric->value); value != nullptr && *value >= 0)
    return static_cast<std::uint64_t>(*value);
  return {};
}

std::optional<std::string> text_of(const Metric* metric) {
  const auto* value = metric == nullptr ? nullptr : std::get_if<std::string>(&metric->value);
  return value == nullptr ? std::nullopt : std::optional(*value);
}

std::string topic_text(const SparkplugTopic& topic) {
  std::string text = std::string(kRoot) + "/" + topic.group + "/" +
                     std::string(kKinds[static_cast<std::size_t>(topic.kind)]) + "/" + topic.node;
  if (!topic.device.empty()) text += "/" + topic.device;
  return text;
}

std::optional<SparkplugTopic> parse_topic(std::string_view text) {
  std::vector<std::string> parts;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find('/', at), text.size());
    parts.emplace_back(text.substr(at, end - at));
    at = end + 1;
  }
  if (parts.size() < 4 || parts.size() > 5 || parts[0] != kRoot) return {};
  const auto kind = std::find(kKinds.begin(), kKinds.end(), parts[2]);
  if (kind == kKinds.end()) return {};
  const bool of_device = parts[2].front() == 'D';
  if (of_device != (parts.size() == 5)) return {};
  for (std::size_t i = 1; i < parts.size(); ++i)
    if (!fits_a_topic(parts[i])) return {};
  return SparkplugTopic{parts[1], parts[3], of_device ? parts[4] : "",
                        static_cast<SparkplugKind>(kind - kKinds.begin())};
}

std::string state_topic(const std::string& host) { return std::string(kRoot) + "/STATE/" + host; }

std::string state_text(bool online, std::uint64_t time_ms) {
  return nlohmann::ordered_json{{"online", online}, {"timestamp", time_ms}}.dump();
}

std::optional<bool> online_of(std::string_view state) {
  if (text::nests_deeper_than(state, text::kMostJsonDepth)) return {};
  const auto json = nlohmann::json::parse(state, nullptr, false);
  if (!json.is_object() || !json.contains("online") || !json["online"].is_boolean()) return {};
  return json["online"].get<bool>();
}

bool fits_a_topic(std::string_view name) {
  if (name.empty() || name.size() > 200 || !is_text(name)) return false;
  return std::none_of(name.begin(), name.end(), [](char c) {
    return c == '+' || c == '/' || c == '#' || static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
  });
}

}  // namespace vernier::fleet
