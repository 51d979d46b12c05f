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

/// Answers the requests of the workbench page (files, commands, rows, predictions, terms, history, a board).
/// The code that answers the requests does not contain the network server. A request that needs the content
/// of a file is answered by a separate process (FileReader) or by a command. Several threads may call the
/// functions of Api.
class Api {
 public:
  /// `directory`: folder of the project. `program`: path of the `vernier` program that runs commands.
  /// `version`: version of the program, shown on the page. `commands`: the commands of this program, in the
  /// form that CommandTable reads. Throws InputError if the project folder does not exist.
  Api(const std::string& directory, const std::string& program, std::string version,
      const nlohmann::ordered_json& commands);

  /// Answers a request of the workbench page and never throws an exception. The status is 422 with
  /// {"message"} for bad input, 404 for an unknown path, and 500 for an internal error.
  ApiReply reply(const ApiRequest& request);

 private:
  ApiReply answer(const ApiRequest& request);
  ApiReply project_page();
  ApiReply get_file(const ApiRequest& request);
  ApiReply put_file(const ApiRequest& request);
  ApiReply delete_file(const ApiRequest& request);
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
