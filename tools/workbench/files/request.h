// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "tools/workbench/files/project.h"

namespace vernier::workbench {

/// A request of the page. The server has already verified the origin of the request.
struct ApiRequest {
  std::string method, path;  // for example "GET" and "/api/rows"
  std::multimap<std::string, std::string> query;
  std::string body;
  /// Returns the value of a query parameter; empty if the parameter is absent.
  std::string word(const std::string& name) const;
  std::vector<std::string> words(const std::string& name) const;
};

struct ApiReply {
  int status = 200;
  std::string type = "application/json", body;
  std::vector<std::pair<std::string, std::string>> headers;
};

ApiReply json_reply(const nlohmann::ordered_json& json, int status = 200);
ApiReply blob_reply(std::string bytes);

/// Returns the result of the function `answer`. If `answer` throws an exception, the status of the reply is
/// 422 with {"message"} for bad input, and 500 for an internal error. The path of the project folder is
/// removed from the messages.
ApiReply reply_of(const Project& project, const std::function<ApiReply()>& answer);

/// Returns the JSON object in the body of a request. body_json and the following functions throw InputError
/// with the wrong word.
nlohmann::json body_json(const ApiRequest& request);
std::string text_at(const nlohmann::json& json, const char* key);
std::vector<std::string> texts_at(const nlohmann::json& json, const char* key);
std::uint64_t whole_number(const std::string& text);

}  // namespace vernier::workbench
