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

/// A request of the page whose origin was verified.
struct ApiRequest {
  std::string method, path;  // "GET", "/api/rows"
  std::multimap<std::string, std::string> query;
  std::string body;
  /// Returns the value of a query word, empty if the word is absent.
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

/// The result of `answer`. If `answer` throws: bad input is 422 with {"message"}, an internal error is 500.
/// The project's folder is removed from messages.
ApiReply reply_of(const Project& project, const std::function<ApiReply()>& answer);

/// Returns the JSON object in the body of a request. body_json and the functions below throw InputError with
/// the word.
nlohmann::json body_json(const ApiRequest& request);
std::string text_at(const nlohmann::json& json, const char* key);
std::vector<std::string> texts_at(const nlohmann::json& json, const char* key);
std::uint64_t whole_number(const std::string& text);

}  // namespace vernier::workbench
