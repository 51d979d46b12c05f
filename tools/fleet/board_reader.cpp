// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fleet/board_reader.h"

#include <fmt/format.h>

#include <chrono>
#include <limits>
#include <nlohmann/json.hpp>

#include "tools/text/error.h"
#include "tools/text/files.h"
#include "tools/text/numbers.h"
#include "tools/text/words.h"
#include "tools/upload/open_transport.h"

namespace vernier::fleet {
namespace {

struct CounterMetric {
  const char* name;
  std::uint64_t HealthRecord::*value;
};
constexpr CounterMetric kCounterMetrics[] = {{"Health/Overruns", &HealthRecord::overruns},
                                             {"Health/Missing readings", &HealthRecord::missing_readings},
                                             {"Health/Missing inputs", &HealthRecord::missing_inputs},
                                             {"Health/Failed writes", &HealthRecord::failed_writes},
                                             {"Health/Saturated", &HealthRecord::saturated},
                                             {"Health/Faults", &HealthRecord::faults},
                                             {"Health/Refused commands", &HealthRecord::refused_commands},
                                             {"Health/Programs", &HealthRecord::programs}};

void put_tick(std::vector<Metric>& to, const upload::BoardInfo& info, const upload::BoardTick& tick) {
  to.push_back({"Board/Tick", tick.number});
  to.push_back({"Board/Time", tick.time_s});
  to.push_back({"Board/Mode", std::string(name_of(tick.mode))});
  to.push_back({"Board/Fault", std::string(name_of(tick.fault))});
  to.push_back({"Board/Holding", tick.holding});
  for (std::size_t i = 0; i < info.axes.size(); ++i) {
    const std::string axis = "Axes/" + info.axes[i].name + "/";
    to.push_back({axis + "Position", tick.position[i]});
    to.push_back({axis + "Correction", tick.correction[i]});
    to.push_back({axis + "Saturated", bool(tick.saturated[i])});
  }
  for (std::size_t i = 0; i < info.inputs.size(); ++i)
    to.push_back({"Inputs/" + info.inputs[i], tick.input[i]});
}

void put_state(std::vector<Metric>& to, const upload::BoardInfo& info, const upload::BoardState& state) {
  to.push_back({"Image/Fingerprint",
                state.fingerprint == 0 ? std::string() : text::fingerprint_text(state.fingerprint)});
  to.push_back({"Image/State", std::string(upload::name_of(state.image))});
  to.push_back({"Image/Weight", state.weight});
  for (std::size_t i = 0; i < info.axes.size(); ++i) {
    const std::string axis = "Axes/" + info.axes[i].name + "/";
    to.push_back({axis + "Wanted", state.axes[i].wanted});
    to.push_back({axis + "Achieved", state.axes[i].achieved});
  }
}

}  // namespace

BoardReader::BoardReader(const GatewayBoard& board)
    : board_(board), client_(upload::open_transport(upload::parse_url(board.url))) {
  if (!board.board.empty() && client_.info().board != board.board)
    throw text::LimitNotMet(
        fmt::format("{}: this board is {}, not {}", board.url,
                    client_.info().board.empty() ? "without a name" : client_.info().board, board.board));
}

std::vector<Metric> BoardReader::read() {
  std::vector<Metric> metrics;
  put_tick(metrics, client_.info(), client_.newest());
  put_state(metrics, client_.info(), client_.state());
  const HealthRecord health = client_.health();
  for (const CounterMetric& counter : kCounterMetrics)
    metrics.push_back({counter.name, health.*counter.value});
  for (const upload::BoardShare& share : client_.shares())
    metrics.push_back(
        {"Shares/" + client_.info().axes[share.axis].name + "/" + share.name, share.correction});
  if (!board_.check.empty()) read_check(metrics);
  return metrics;
}

void BoardReader::read_check(std::vector<Metric>& metrics) {
  std::error_code none;
  const auto time = std::filesystem::last_write_time(board_.check, none);
  if (!none && check_time_ != time) {
    const auto since_1970 = std::chrono::file_clock::to_sys(time).time_since_epoch();
    check_ = check_metrics(text::read_file(board_.check),
                           std::chrono::duration_cast<std::chrono::microseconds>(since_1970).count());
    check_time_ = time;
  }
  metrics.insert(metrics.end(), check_.begin(), check_.end());
}

std::vector<Metric> check_metrics(const std::string& json, std::int64_t time_us) {
  if (text::nests_deeper_than(json, text::kMostJsonDepth)) return {};
  const auto answer = nlohmann::json::parse(json, nullptr, false);
  if (!answer.is_object() || !answer.contains("verdict") || !answer["verdict"].is_string()) return {};
  const auto number = [&](const char* key) {
    // Null is used for values beyond the largest number.
    if (answer.contains(key) && answer[key].is_null()) return std::numeric_limits<double>::max();
    return answer.contains(key) && answer[key].is_number() ? answer[key].get<double>() : 0.0;
  };
  std::string changed, explanation;
  if (answer.contains("explanation") && answer["explanation"].is_string())
    explanation = answer["explanation"].get<std::string>();
  if (answer.contains("changed") && answer["changed"].is_array())
    for (const auto& one : answer["changed"])
      if (one.is_object() && one.contains("name") && one["name"].is_string())
        changed += (changed.empty() ? "" : ", ") + one["name"].get<std::string>();
  return {{"Check/Time", time_us},
          {"Check/Verdict", answer["verdict"].get<std::string>()},
          {"Check/Explanation", explanation},
          {"Check/Changed", changed},
          {"Check/Evidence", number("evidence")},
          {"Check/Alarm", number("alarm")}};
}

}  // namespace vernier::fleet
