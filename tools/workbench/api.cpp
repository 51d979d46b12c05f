// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/workbench/api.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "tools/model/machine.h"
#include "tools/model/machine_reader.h"
#include "tools/text/csv.h"
#include "tools/text/error.h"
#include "tools/text/files.h"
#include "tools/text/words.h"
#include "tools/workbench/excluded.h"
#include "tools/workbench/terms.h"

namespace vernier {
namespace {

using Json = nlohmann::ordered_json;

ApiReply json_reply(const Json& json, int status = 200) {
  return {status, "application/json", json.dump(-1, ' ', false, Json::error_handler_t::replace), {}};
}

ApiReply blob_reply(std::string bytes) { return {200, "application/octet-stream", std::move(bytes), {}}; }

nlohmann::json body_json(const ApiRequest& request) {
  if (nests_deeper_than(request.body, kMostJsonDepth)) throw InputError("the request nests too deeply");
  auto json = nlohmann::json::parse(request.body, nullptr, false);
  if (!json.is_object()) throw InputError("the request holds no JSON object");
  return json;
}

std::uint64_t whole_number(const std::string& text) {
  std::uint64_t value = 0;
  const auto end = std::from_chars(text.data(), text.data() + text.size(), value);
  if (end.ec != std::errc() || end.ptr != text.data() + text.size())
    throw InputError("\"" + text + "\": no whole number");
  return value;
}

std::string text_at(const nlohmann::json& json, const char* key) {
  const auto found = json.find(key);
  if (found == json.end() || !found->is_string())
    throw InputError(std::string("\"") + key + "\": a text is missing");
  return found->get<std::string>();
}

std::vector<std::string> texts_at(const nlohmann::json& json, const char* key) {
  std::vector<std::string> list;
  const auto found = json.find(key);
  if (found == json.end() || !found->is_array())
    throw InputError(std::string("\"") + key + "\": a list is missing");
  for (const auto& one : *found) {
    if (!one.is_string()) throw InputError(std::string("\"") + key + "\": holds something that is no text");
    list.push_back(one.get<std::string>());
  }
  return list;
}

bool ends_with(const std::string& text, std::string_view end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// Machines and measurements are read before they are kept, so that an error shows where it was dropped.
void check_before_keeping(const std::string& name, const std::string& bytes) {
  if (ends_with(name, ".xml")) parse_machine(bytes, name);
  if (ends_with(name, ".csv")) parse_csv(bytes, name);
}

}  // namespace

std::string ApiRequest::word(const std::string& name) const {
  const auto found = query.find(name);
  return found == query.end() ? std::string() : found->second;
}

std::vector<std::string> ApiRequest::words(const std::string& name) const {
  std::vector<std::string> list;
  const auto range = query.equal_range(name);
  for (auto at = range.first; at != range.second; ++at) list.push_back(at->second);
  return list;
}

Api::Api(const std::string& directory, std::string program, std::string version)
    : project_(directory),
      version_(std::move(version)),
      history_(project_),
      cache_(project_),
      jobs_(std::move(program), project_, history_) {}

std::string Api::without_root(std::string text) const {
  const std::string root = project_.root().string() + "/";
  for (auto at = text.find(root); at != std::string::npos; at = text.find(root, at))
    text.erase(at, root.size());
  return text;
}

ApiReply Api::reply(const ApiRequest& request) {
  try {
    return answer(request);
  } catch (const InputError& error) {
    return json_reply({{"message", without_root(error.what())}}, 422);
  } catch (const LimitNotMet& error) {
    return json_reply({{"message", without_root(error.what())}}, 422);
  } catch (const std::exception& error) {
    return json_reply({{"message", std::string("internal error: ") + error.what()}}, 500);
  }
}

ApiReply Api::answer(const ApiRequest& request) {
  struct Route {
    const char *method, *path;
    ApiReply (Api::*answer)(const ApiRequest&);
  };
  static constexpr Route kRoutes[] = {{"GET", "/api/file", &Api::get_file},
                                      {"PUT", "/api/file", &Api::put_file},
                                      {"GET", "/api/lines", &Api::lines},
                                      {"GET", "/api/excluded", &Api::excluded},
                                      {"GET", "/api/jobs", &Api::jobs},
                                      {"POST", "/api/jobs", &Api::jobs},
                                      {"DELETE", "/api/jobs", &Api::jobs},
                                      {"GET", "/api/history", &Api::history},
                                      {"POST", "/api/history", &Api::history},
                                      {"GET", "/api/rows", &Api::rows},
                                      {"GET", "/api/parameters", &Api::parameters},
                                      {"POST", "/api/predict", &Api::predict},
                                      {"POST", "/api/explain", &Api::explain},
                                      {"GET", "/api/names", &Api::names},
                                      {"POST", "/api/term", &Api::term},
                                      {"GET", "/api/live", &Api::live}};
  if (request.method == "GET" && request.path == "/api/project") return project_page();
  for (const Route& route : kRoutes)
    if (request.method == route.method && request.path == route.path) return (this->*route.answer)(request);
  return json_reply({{"message", "nothing here"}}, 404);
}

ApiReply Api::project_page() {
  Json files = Json::array();
  for (const ProjectFile& file : project_.list())
    files.push_back({{"name", file.name},
                     {"kind", kind_name(file.kind)},
                     {"bytes", file.bytes},
                     {"modified_s", file.modified_s}});
  return json_reply({{"folder", project_.root().filename().string()},
                     {"version", version_},
                     {"files", files},
                     {"history", history_.entries()}});
}

ApiReply Api::get_file(const ApiRequest& request) {
  const std::string name = request.word("name");
  const auto path = project_.existing(name);
  if (!std::filesystem::is_regular_file(path)) throw InputError("\"" + name + "\": no file");
  ApiReply reply{200, "application/octet-stream", read_file(path.string()), {}};
  if (ends_with(name, ".html")) {
    // A report may run its own script, but in an origin of its own: it reaches nothing of the workbench.
    reply.type = "text/html; charset=utf-8";
    reply.headers.emplace_back(
        "Content-Security-Policy",
        "sandbox allow-scripts; default-src 'none'; script-src 'unsafe-inline'; style-src "
        "'unsafe-inline'; img-src data: blob:");
  } else {
    reply.headers.emplace_back("Content-Disposition", "attachment");
  }
  return reply;
}

ApiReply Api::put_file(const ApiRequest& request) {
  const std::string name = request.word("name");
  project_.writable(name);
  if (!request.words("new").empty() && std::filesystem::exists(project_.writable(name)))
    throw InputError("\"" + name + "\": there is such a file already");
  check_before_keeping(name, request.body);
  project_.save(name, request.body);
  return json_reply({{"name", name}, {"bytes", request.body.size()}});
}

/// The lines around an error: {"first", "lines": [...]}.
ApiReply Api::lines(const ApiRequest& request) {
  constexpr std::size_t kAround = 2, kLongest = 400;
  const std::string text = read_file(project_.existing(request.word("name")).string());
  const std::size_t wanted = whole_number(request.word("line"));
  const std::size_t first = wanted > kAround ? wanted - kAround : 1;
  Json list = Json::array();
  std::size_t number = 1, at = 0;
  while (at < text.size() && number <= wanted + kAround) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    if (number >= first) list.push_back(text.substr(at, std::min(end - at, kLongest)));
    at = end + 1;
    ++number;
  }
  return json_reply({{"first", first}, {"lines", list}});
}

ApiReply Api::excluded(const ApiRequest& request) {
  Json list = Json::array();
  for (const ExcludedRow& row : excluded_rows(read_file(project_.existing(request.word("name")).string())))
    list.push_back({{"line", row.line}, {"reason", row.reason}, {"row", row.row}});
  return json_reply({{"excluded", list}});
}

ApiReply Api::jobs(const ApiRequest& request) {
  if (request.method == "POST") {
    const std::uint64_t id = jobs_.start(plan_command(body_json(request), project_));
    return json_reply(jobs_.state(id), 202);
  }
  const std::uint64_t id = whole_number(request.word("id"));
  if (request.method == "DELETE") jobs_.cancel(id);
  return json_reply(jobs_.state(id));
}

ApiReply Api::history(const ApiRequest& request) {
  if (request.method == "POST") {
    const std::string what = text_at(body_json(request), "do");
    if (what == "undo")
      history_.undo();
    else if (what == "redo")
      history_.redo();
    else
      throw InputError("\"" + what + "\": undo or redo");
  }
  return json_reply({{"history", history_.entries()}, {"script", history_.script()}});
}

ApiReply Api::rows(const ApiRequest& request) {
  return blob_reply(rows_blob(*cache_.get(request.word("machine"), request.words("measurement"))));
}

ApiReply Api::parameters(const ApiRequest& request) {
  return json_reply(parameters_json(*cache_.get(request.word("machine"), request.words("measurement"))));
}

ApiReply Api::predict(const ApiRequest& request) {
  const auto json = body_json(request);
  const auto rows = cache_.get(text_at(json, "machine"), texts_at(json, "measurements"));
  std::map<std::string, double> values;
  if (!json.contains("values") || !json["values"].is_object()) throw InputError("\"values\" is missing");
  for (const auto& [name, value] : json["values"].items()) {
    if (!value.is_number() || !std::isfinite(value.get<double>()))
      throw InputError("\"" + name + "\": no number");
    values[name] = value.get<double>();
  }
  return blob_reply(prediction_blob(*rows, values));
}

ApiReply Api::explain(const ApiRequest& request) {
  const auto json = body_json(request);
  const auto rows = cache_.get(text_at(json, "machine"), texts_at(json, "measurements"));
  return blob_reply(explanation_blob(*rows, text_at(json, "add")));
}

ApiReply Api::names(const ApiRequest& request) {
  const std::string name = request.word("machine");
  const Machine machine = parse_machine(read_file(project_.existing(name).string()), name);
  Json transforms = Json::array();
  for (const auto* branch : {&machine.tool, &machine.workpiece})
    for (const Transform& transform : *branch) {
      Json dofs = Json::array();
      for (std::size_t i = 0; i < transform.dof_count(); ++i)
        dofs.push_back({{"dof", transform.dof_name(i)}, {"text", transform.text[i]}});
      transforms.push_back(
          {{"branch", branch == &machine.tool ? "tool" : "workpiece"}, {"n", transform.n}, {"dofs", dofs}});
    }
  return json_reply({{"names", expression_names(machine)}, {"transforms", transforms}});
}

ApiReply Api::term(const ApiRequest& request) {
  const auto json = body_json(request);
  const std::string name = text_at(json, "machine");
  Machine machine = parse_machine(read_file(project_.existing(name).string()), name);
  // Columns of the measurement that the machine does not know: `add` declares what a term uses of them.
  if (json.contains("columns") && json["columns"].is_array()) {
    for (const auto& column : json["columns"]) {
      Input input;
      input.name = text_at(column, "name");
      input.unit = text_at(column, "unit");
      if (resolve_name(machine, input.name).kind == SymbolKind::kUnresolved) machine.inputs.push_back(input);
    }
  }
  return json_reply(check_term(machine, text_at(json, "term"), text_at(json, "unit")));
}

ApiReply Api::live(const ApiRequest& request) {
  const std::string after = request.word("after");
  return json_reply(live_.pictures(request.word("to"), after.empty() ? 0 : whole_number(after)));
}

}  // namespace vernier
