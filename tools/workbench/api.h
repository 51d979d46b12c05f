// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

#include "tools/workbench/file_reader.h"
#include "tools/workbench/files/project.h"
#include "tools/workbench/files/request.h"
#include "tools/workbench/live_board.h"
#include "tools/workbench/runs/history.h"
#include "tools/workbench/runs/jobs.h"

namespace vernier::workbench {

/// The requests of the page, without a network: files, commands, rows, predictions, terms, history, a board.
/// A request that needs a file is answered by a separate process (FileReader), or by a command. May be called
/// from several threads.
class Api {
 public:
  /// directory: of the project. program: the `vernier` that runs commands. version: shown on the page.
  /// commands: of that program, as CommandTable reads them. Throws InputError if the folder does not exist.
  Api(const std::string& directory, const std::string& program, std::string version,
      const nlohmann::ordered_json& commands);

  /// Answers a request and never throws: bad input is 422 with {"message"}, an unknown path 404, an internal
  /// error 500.
  ApiReply reply(const ApiRequest& request);

 private:
  ApiReply answer(const ApiRequest& request);
  ApiReply project_page();
  ApiReply get_file(const ApiRequest& request);
  ApiReply put_file(const ApiRequest& request);
  ApiReply lines(const ApiRequest& request);
  ApiReply jobs(const ApiRequest& request);
  ApiReply history(const ApiRequest& request);
  ApiReply live(const ApiRequest& request);

  Project project_;
  std::string version_;
  CommandTable commands_;
  CommandHistory history_;
  FileReader reader_;
  LiveBoard live_;
  Jobs jobs_;
};

}  // namespace vernier::workbench
