// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fleet/metrics.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <thread>

#include "tools/http/gated_server.h"
#include "tools/registry/cells.h"
#include "tools/registry/due.h"
#include "tools/registry/open_database.h"
#include "tools/text/error.h"
#include "tools/text/numbers.h"
#include "tools/text/wall_time.h"

namespace vernier::fleet {
namespace {

/// A family of series: its words once, then a line a series.
class Family {
 public:
  Family(std::string& text, std::string name, const char* type, const char* help)
      : text_(text), name_(std::move(name)) {
    text_ += fmt::format("# HELP {} {}\n# TYPE {} {}\n", name_, help, name_, type);
  }
  void add(const std::vector<std::pair<const char*, std::string>>& labels, double value) {
    text_ += name_;
    for (std::size_t i = 0; i < labels.size(); ++i)
      text_ += fmt::format("{}{}=\"{}\"", i == 0 ? "{" : ",", labels[i].first, escaped(labels[i].second));
    text_ += labels.empty() ? " " : "} ";
    text_ += text::number_text(value) + "\n";
  }

 private:
  static std::string escaped(const std::string& value) {
    std::string result;
    for (const char c : value) {
      if (c == '\\' || c == '"') result += '\\';
      result += c == '\n' ? "\\n" : std::string(1, c);
    }
    return result;
  }
  std::string& text_;
  std::string name_;
};

void put_live(std::string& text, const std::vector<registry::LiveState>& live, std::int64_t now_us) {
  const auto age_of = [&](const registry::LiveState& one) {
    return registry::live_age(one, now_us, registry::kStaleAfter_s);
  };
  Family up(text, "vernier_machine_online", "gauge",
            "1 if a gateway is connected to the machine's board; 0 if not, or if the newest sample is older "
            "than 30 s.");
  for (const registry::LiveState& one : live)
    up.add({{"machine", one.machine}, {"gateway", one.gateway}},
           age_of(one).state == registry::LiveAge::State::kOnline ? 1 : 0);
  Family age(text, "vernier_machine_sample_age_seconds", "gauge",
             "Time since the registry received the newest sample, by the registry's clock.");
  for (const registry::LiveState& one : live)
    if (one.received_us != 0) age.add({{"machine", one.machine}}, age_of(one).age_s);
  Family clock(text, "vernier_gateway_clock_offset_seconds", "gauge",
               "Difference gateway clock minus registry clock, from the newest sample of the machine.");
  for (const registry::LiveState& one : live)
    if (one.received_us != 0 && !one.historical)
      clock.add({{"machine", one.machine}, {"gateway", one.gateway}}, age_of(one).clock_s);
  Family at(text, "vernier_machine_newest_sample_timestamp_seconds", "gauge",
            "Time at which the newest stored sample was taken.");
  for (const registry::LiveState& one : live)
    at.add({{"machine", one.machine}}, static_cast<double>(one.at_us) * 1e-6);
  Family samples(text, "vernier_machine_samples_total", "counter", "Samples stored.");
  for (const registry::LiveState& one : live)
    samples.add({{"machine", one.machine}}, static_cast<double>(one.samples));
  Family state(text, "vernier_machine_info", "gauge",
               "State and correction image of the machine's board, as labels.");
  for (const registry::LiveState& one : live)
    state.add({{"machine", one.machine}, {"mode", one.mode}, {"fault", one.fault}, {"image", one.image}}, 1);
  Family value(text, "vernier_machine_value", "gauge",
               "Value of a quantity in the newest sample, in the unit of the machine file.");
  for (const registry::LiveState& one : live)
    for (const auto& [name, json] : one.values)
      if (const auto number = text::parse_number(json))
        value.add({{"machine", one.machine}, {"name", name}}, *number);
}

}  // namespace

std::string metrics_text(registry::Registry& registry, std::int64_t at_us) {
  std::string text;
  put_live(text, registry.live(), registry.database().now_us());
  registry::Database& database = registry.database();
  Family faults(text, "vernier_machine_faults_total", "counter",
                "Number of faults that the machine's board reported.");
  for (const registry::Row& row :
       database.run("SELECT machine, fault, COUNT(*) FROM fault_event GROUP BY machine, "
                    "fault ORDER BY machine, fault"))
    faults.add({{"machine", registry::words(row[0])}, {"fault", registry::words(row[1])}},
               registry::real(row[2]));
  const std::vector<registry::DueMachine> due = registry::due_machines(registry, at_us);
  Family overdue(text, "vernier_machine_check_due_seconds", "gauge",
                 "Time until the next check is due; negative: the check is overdue.");
  for (const registry::DueMachine& one : due)
    if (one.due_us) overdue.add({{"machine", one.machine}}, static_cast<double>(*one.due_us - at_us) * 1e-6);
  Family verdict(text, "vernier_machine_check_info", "gauge", "Verdict of the last check, as a label.");
  for (const registry::DueMachine& one : due)
    if (one.last_us) verdict.add({{"machine", one.machine}, {"verdict", one.verdict}}, 1);
  Family lost(text, "vernier_lost_samples_total", "counter",
              "Number of samples that a gateway discarded because its store was full.");
  lost.add({},
           registry::real(
               database.run("SELECT COALESCE(SUM(before_number - after_number - 1), 0) FROM loss").at(0)[0]));
  Family answers(text, "vernier_batch_answers", "gauge",
                 "Number of recorded answers of a batch, by exit status.");
  for (const registry::Row& row :
       database.run("SELECT name, status, COUNT(*) FROM answer GROUP BY name, status ORDER BY name, status"))
    answers.add({{"batch", registry::words(row[0])}, {"status", registry::words(row[1])}},
                registry::real(row[2]));
  Family unknown(text, "vernier_not_entered_samples_total", "counter",
                 "Number of discarded samples: the machine of the sample is not in the registry.");
  for (const registry::NotEntered& one : registry.not_entered())
    unknown.add({{"machine", one.machine}, {"gateway", one.gateway}}, static_cast<double>(one.samples));
  return text;
}

void serve_metrics(const std::string& registry, const std::string& address, const std::atomic<bool>& stop,
                   const Say& say) {
  const std::size_t colon = address.rfind(':');
  int port = -1;
  if (colon != std::string::npos)
    std::from_chars(address.data() + colon + 1, address.data() + address.size(), port);
  if (port < 0 || port > 65535) throw text::InputError({}, address, "give HOST:PORT");
  const std::string host = address.substr(0, colon);
  { registry::Registry there(registry::open_database(registry)); }
  http::GatedServer server;
  // No request has a body: the library would read one before it looks for the address.
  server.set_pre_routing_handler([](const httplib::Request& request, httplib::Response& response) {
    if (request.method == "GET" || request.method == "HEAD")
      return httplib::Server::HandlerResponse::Unhandled;
    response.status = 405;
    return httplib::Server::HandlerResponse::Handled;
  });
  server.Get("/metrics", [&](const httplib::Request&, httplib::Response& response) {
    try {
      registry::Registry here(registry::open_database(registry));
      response.set_content(metrics_text(here, text::now_us()), "text/plain; version=0.0.4; charset=utf-8");
    } catch (const std::runtime_error& error) {
      response.status = 503;
      response.set_content(std::string(error.what()) + "\n", "text/plain");
    }
  });
  const bool bound = port != 0 ? server.bind_to_port(host, port) : (port = server.bind_to_any_port(host)) > 0;
  if (!bound) throw text::InputError({}, address, "the program cannot listen at this address");
  say(fmt::format("http://{}:{}/metrics", host, port));
  std::thread watch([&] {
    while (!stop) std::this_thread::sleep_for(std::chrono::milliseconds(50));
    server.stop();
  });
  server.listen_after_bind();
  watch.join();
}

}  // namespace vernier::fleet
