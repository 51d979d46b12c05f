// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/workbench/api.h"

#include <fmt/format.h>

#include <algorithm>

#include "tools/import/kinds.h"
#include "tools/text/error.h"
#include "tools/text/files.h"
#include "tools/workbench/files/file_desk.h"

namespace vernier::workbench {
namespace {

using Json = nlohmann::ordered_json;

bool ends_with(const std::string& text, std::string_view end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// The kind of `vernier import` for the file of an instrument, null for another file.
Json importer_of(const std::string& file) {
  const importer::ImportKind* const kind = importer::import_kind_of(file);
  return kind == nullptr ? Json(nullptr) : Json(kind->name);
}

}  // namespace

Api::Api(const std::string& directory, const std::string& program, std::string version, const Json& commands)
    : project_(directory),
      version_(std::move(version)),
      commands_(commands),
      history_(project_),
      reader_(program, project_),
      jobs_(program, project_, history_) {}

ApiReply Api::reply(const ApiRequest& request) {
  return reply_of(project_, [&] { return answer(request); });
}

ApiReply Api::answer(const ApiRequest& request) {
  struct Route {
    const char *method, *path;
    ApiReply (Api::*answer)(const ApiRequest&);
  };
  static constexpr Route kRoutes[] = {
      {"GET", "/api/file", &Api::get_file},       {"PUT", "/api/file", &Api::put_file},
      {"DELETE", "/api/file", &Api::delete_file}, {"GET", "/api/lines", &Api::lines},
      {"GET", "/api/jobs", &Api::jobs},           {"POST", "/api/jobs", &Api::jobs},
      {"DELETE", "/api/jobs", &Api::jobs},        {"GET", "/api/history", &Api::history},
      {"POST", "/api/history", &Api::history},    {"GET", "/api/live", &Api::live}};
  if (request.method == "GET" && request.path == "/api/project") return project_page();
  if (request.method == "GET" && request.path == "/api/commands") return json_reply(commands_.allowed());
  if (FileDesk::answers(request) && request.method != "PUT") return reader_.reply(request);
  for (const Route& route : kRoutes)
    if (request.method == route.method && request.path == route.path) return (this->*route.answer)(request);
  return json_reply({{"message", "nothing here"}}, 404);
}

ApiReply Api::project_page() {
  Json files = Json::array();
  for (const ProjectFile& file : project_.list())
    files.push_back({{"name", file.name},
                     {"kind", kind_name(file.kind)},
                     {"importer", importer_of(file.name)},
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
  if (!std::filesystem::is_regular_file(path)) throw text::InputError("\"" + name + "\": no file");
  ApiReply reply{200, "application/octet-stream", text::read_file(path.string()), {}};
  if (ends_with(name, ".html")) {
    // A report may run its script, but in a separate origin: it has no access to the workbench.
    reply.type = "text/html; charset=utf-8";
    reply.headers.emplace_back(
        "Content-Security-Policy",
        "sandbox allow-scripts allow-downloads; default-src 'none'; script-src 'unsafe-inline'; style-src "
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
    throw text::InputError(
        fmt::format("\"{}\": a file of this name already exists; replace or delete it", name));
  if (ApiReply checked = reader_.reply(request); checked.status != 200) return checked;
  project_.save(name, request.body);
  return json_reply({{"name", name}, {"bytes", request.body.size()}});
}

ApiReply Api::delete_file(const ApiRequest& request) {
  const std::string name = request.word("name");
  project_.remove(name);
  return json_reply({{"name", name}});
}

/// The lines around an error: {"first", "lines": [...]}; no lines of a file that is no text (a workbook).
ApiReply Api::lines(const ApiRequest& request) {
  constexpr std::size_t kAround = 2, kLongest = 400;
  const std::string text = text::read_file(project_.existing(request.word("name")).string());
  const std::size_t wanted = whole_number(request.word("line"));
  const std::size_t first = wanted > kAround ? wanted - kAround : 1;
  Json list = Json::array();
  std::size_t number = 1, at = 0;
  const bool is_text = text.find('\0') == std::string::npos;
  while (is_text && at < text.size() && number <= wanted + kAround) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    if (number >= first) list.push_back(text.substr(at, std::min(end - at, kLongest)));
    at = end + 1;
    ++number;
  }
  return json_reply({{"first", first}, {"lines", list}});
}

ApiReply Api::jobs(const ApiRequest& request) {
  if (request.method == "POST") {
    const std::uint64_t id = jobs_.start(commands_.plan(body_json(request), project_));
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
      throw text::InputError("\"" + what + "\": undo or redo");
  }
  return json_reply({{"history", history_.entries()}, {"script", history_.script()}});
}

ApiReply Api::live(const ApiRequest& request) {
  const std::string after = request.word("after");
  return json_reply(live_.pictures(request.word("to"), after.empty() ? 0 : whole_number(after)));
}

}  // namespace vernier::workbench
