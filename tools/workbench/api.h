// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "tools/workbench/history.h"
#include "tools/workbench/jobs.h"
#include "tools/workbench/live_board.h"
#include "tools/workbench/project.h"
#include "tools/workbench/rows.h"

namespace vernier {

/// A request of the page that has proved where it comes from.
struct ApiRequest {
  std::string method, path;  // "GET", "/api/rows"
  std::multimap<std::string, std::string> query;
  std::string body;
  /// The value of a query word, empty where it is absent.
  std::string word(const std::string& name) const;
  std::vector<std::string> words(const std::string& name) const;
};

struct ApiReply {
  int status = 200;
  std::string type = "application/json", body;
  std::vector<std::pair<std::string, std::string>> headers;
};

/// What the page can ask for, without a network: files, commands, rows, predictions, terms, history, a board.
/// May be called from several threads. tool.
class Api {
 public:
  /// directory: of the project. program: the `vernier` that runs commands. version: shown on the page.
  /// Throws InputError where there is no such folder.
  Api(const std::string& directory, std::string program, std::string version);

  /// Never throws: bad input is 422 with {"message"}, an unknown path 404, our own fault 500.
  ApiReply reply(const ApiRequest& request);

 private:
  ApiReply answer(const ApiRequest& request);
  ApiReply project_page();
  ApiReply get_file(const ApiRequest& request);
  ApiReply put_file(const ApiRequest& request);
  ApiReply lines(const ApiRequest& request);
  ApiReply excluded(const ApiRequest& request);
  ApiReply jobs(const ApiRequest& request);
  ApiReply history(const ApiRequest& request);
  ApiReply rows(const ApiRequest& request);
  ApiReply parameters(const ApiRequest& request);
  ApiReply predict(const ApiRequest& request);
  ApiReply explain(const ApiRequest& request);
  ApiReply names(const ApiRequest& request);
  ApiReply term(const ApiRequest& request);
  ApiReply live(const ApiRequest& request);
  std::string without_root(std::string text) const;

  Project project_;
  std::string version_;
  CommandHistory history_;
  RowCache cache_;
  LiveBoard live_;
  Jobs jobs_;
};

}  // namespace vernier
