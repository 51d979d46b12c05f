// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <memory>
#include <mutex>
#include <string>

#include "tools/workbench/files/project.h"
#include "tools/workbench/files/request.h"
#include "tools/workbench/runs/conversation.h"

namespace vernier::workbench {

/// The server's side of a FileDesk in a separate process (`vernier workbench DIR --reader`). FileReader
/// starts the process when needed, sends requests one by one, and starts a new process if one has ended. May
/// be called from several threads.
class FileReader {
 public:
  /// patience_s: the process is ended if it gives no answer for this time.
  FileReader(std::string program, const Project& project, double patience_s = 60)
      : program_(std::move(program)), project_(project), patience_s_(patience_s) {}

  /// Answers like FileDesk::reply; 422 if the reading process ended because of the request.
  ApiReply reply(const ApiRequest& request);

 private:
  std::string program_;
  const Project& project_;
  double patience_s_;
  std::mutex guard_;
  std::unique_ptr<Conversation> reader_;
};

/// The reading process: answers requests on `stream` until the stream ends.
void serve_files(const Project& project, int stream);

}  // namespace vernier::workbench
