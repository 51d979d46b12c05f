// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/workbench/files/request.h"

#include <fmt/format.h>

#include <charconv>

#include "tools/text/error.h"
#include "tools/text/words.h"

namespace vernier::workbench {
namespace {

std::string without_root(const Project& project, std::string text) {
  const std::string root = project.root().string() + "/";
  for (auto at = text.find(root); at != std::string::npos; at = text.find(root, at))
    text.erase(at, root.size());
  return text;
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

ApiReply json_reply(const nlohmann::ordered_json& json, int status) {
  return {status,
          "application/json",
          json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace),
          {}};
}

ApiReply blob_reply(std::string bytes) { return {200, "application/octet-stream", std::move(bytes), {}}; }

ApiReply reply_of(const Project& project, const std::function<ApiReply()>& answer) {
  try {
    return answer();
  } catch (const text::InputError& error) {
    return json_reply({{"message", without_root(project, error.what())}}, 422);
  } catch (const text::LimitNotMet& error) {
    return json_reply({{"message", without_root(project, error.what())}}, 422);
  } catch (const std::exception& error) {
    return json_reply({{"message", std::string("internal error: ") + error.what()}}, 500);
  }
}

nlohmann::json body_json(const ApiRequest& request) {
  if (text::nests_deeper_than(request.body, text::kMostJsonDepth))
    throw text::InputError("the request nests too deeply");
  auto json = nlohmann::json::parse(request.body, nullptr, false);
  if (!json.is_object()) throw text::InputError("the request contains no JSON object");
  return json;
}

std::uint64_t whole_number(const std::string& text) {
  std::uint64_t value = 0;
  const auto end = std::from_chars(text.data(), text.data() + text.size(), value);
  if (end.ec != std::errc() || end.ptr != text.data() + text.size())
    throw text::InputError("\"" + text + "\": no whole number");
  return value;
}

std::string text_at(const nlohmann::json& json, const char* key) {
  const auto found = json.find(key);
  if (found == json.end() || !found->is_string())
    throw text::InputError(std::string("\"") + key + "\": a text is missing");
  return found->get<std::string>();
}

std::vector<std::string> texts_at(const nlohmann::json& json, const char* key) {
  std::vector<std::string> list;
  const auto found = json.find(key);
  if (found == json.end() || !found->is_array())
    throw text::InputError(std::string("\"") + key + "\": a list is missing");
  for (const auto& one : *found) {
    if (!one.is_string())
      throw text::InputError(fmt::format("\"{}\": contains a value that is not a text", key));
    list.push_back(one.get<std::string>());
  }
  return list;
}

}  // namespace vernier::workbench
