// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <memory>
#include <mutex>
#include <string>

#include "tools/workbench/files/project.h"
#include "tools/workbench/files/request.h"
#include "tools/workbench/runs/conversation.h"

namespace vernier::workbench {

/// The part of the server that communicates with a FileDesk in a separate process (`vernier workbench DIR
/// --reader`). FileReader starts this process when it is needed, sends the requests one by one, and starts a
/// new process if the previous process has ended. Several threads may call the functions of FileReader.
class FileReader {
 public:
  /// `patience_s`: if the process gives no answer for this time, FileReader ends the process.
  FileReader(std::string program, const Project& project, double patience_s = 60)
      : program_(std::move(program)), project_(project), patience_s_(patience_s) {}

  /// Answers a request like FileDesk::reply. The status is 422 if the separate process ended because of the
  /// request.
  ApiReply reply(const ApiRequest& request);

 private:
  std::string program_;
  const Project& project_;
  double patience_s_;
  std::mutex guard_;
  std::unique_ptr<Conversation> reader_;
};

/// Main function of the separate process: answers requests on `stream` until the stream ends.
void serve_files(const Project& project, int stream);

}  // namespace vernier::workbench
