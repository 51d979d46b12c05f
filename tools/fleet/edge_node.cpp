// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fleet/edge_node.h"

#include "tools/text/wall_time.h"

namespace vernier::fleet {
namespace {

constexpr std::uint64_t kSequence = 256;

std::uint64_t clock_ms() { return static_cast<std::uint64_t>(text::now_ms()); }

SparkplugPayload death_of(std::uint64_t number) {
  SparkplugPayload payload;
  payload.time_ms = clock_ms();
  payload.metrics = {{std::string(kDeathMetric), number}};
  return payload;
}

// Names and types that a birth message declares.
std::string shape_of(const std::vector<Metric>& metrics) {
  std::string shape;
  for (const Metric& metric : metrics)
    shape += metric.name + "\t" + std::to_string(metric.value.index()) + "\n";
  return shape;
}

}  // namespace

EdgeNode::EdgeNode(const Broker& broker, std::string group, std::string node, const std::string& host,
                   std::uint64_t death_number)
    : group_(std::move(group)),
      node_(std::move(node)),
      death_number_(death_number),
      connection_(
          broker, "vernier-" + group_ + "-" + node_,
          {topic_text({group_, node_, "", SparkplugKind::kNDeath}), encode(death_of(death_number)), false}) {
  connection_.subscribe(topic_text({group_, node_, "", SparkplugKind::kNCmd}), 1);
  connection_.subscribe(state_topic(host), 1);
}

bool EdgeNode::birth(const std::vector<Metric>& metrics) {
  shapes_.clear();
  next_seq_ = 0;
  SparkplugPayload payload;
  payload.metrics = {{std::string(kDeathMetric), death_number_}, {std::string(kRebirthMetric), false}};
  payload.metrics.insert(payload.metrics.end(), metrics.begin(), metrics.end());
  born_ = send(SparkplugKind::kNBirth, "", std::move(payload));
  return born_;
}

bool EdgeNode::data(const std::string& device, SparkplugPayload payload) {
  const std::string shape = shape_of(payload.metrics);
  std::string& known = shapes_[device];
  if (known != shape) {
    // A birth message reports the present state, whenever the values were taken.
    SparkplugPayload birth;
    birth.metrics = payload.metrics;
    for (Metric& metric : birth.metrics) metric.historical = false;
    if (!send(SparkplugKind::kDBirth, device, std::move(birth))) return false;
    known = shape;
  }
  return send(SparkplugKind::kDData, device, std::move(payload));
}

bool EdgeNode::death(const std::string& device) {
  if (shapes_.erase(device) == 0) return true;
  return send(SparkplugKind::kDDeath, device, {});
}

void EdgeNode::part() {
  if (born_)
    connection_.publish(topic_text({group_, node_, "", SparkplugKind::kNDeath}),
                        encode(death_of(death_number_)), 1);
  connection_.part();
}

bool EdgeNode::send(SparkplugKind kind, const std::string& device, SparkplugPayload payload) {
  payload.time_ms = clock_ms();
  payload.seq = next_seq_;
  if (!connection_.publish(topic_text({group_, node_, device, kind}), encode(payload))) return false;
  next_seq_ = (next_seq_ + 1) % kSequence;
  return true;
}

}  // namespace vernier::fleet
