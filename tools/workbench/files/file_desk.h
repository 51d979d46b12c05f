// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

#include "tools/workbench/files/project.h"
#include "tools/workbench/files/request.h"
#include "tools/workbench/files/rows.h"

namespace vernier::workbench {

/// Contains all functions of the workbench that read a machine, a measurement or a term. The functions that
/// read files run in a separate process. A harmful file therefore ends only this process and not the server.
class FileDesk {
 public:
  explicit FileDesk(const Project& project) : project_(project), cache_(project) {}

  /// True if FileDesk answers this request. For a request to store data (PUT), FileDesk only checks the data.
  static bool answers(const ApiRequest& request);
  /// Answers a request and never throws an exception, like Api::reply.
  ApiReply reply(const ApiRequest& request);

 private:
  ApiReply answer(const ApiRequest& request);
  ApiReply check(const ApiRequest& request);
  ApiReply excluded(const ApiRequest& request);
  ApiReply rows(const ApiRequest& request);
  ApiReply parameters(const ApiRequest& request);
  ApiReply predict(const ApiRequest& request);
  ApiReply explain(const ApiRequest& request);
  ApiReply names(const ApiRequest& request);
  ApiReply term(const ApiRequest& request);
  ApiReply kind(const ApiRequest& request);
  ApiReply robot(const ApiRequest& request);
  ApiReply sheet(const ApiRequest& request);
  ApiReply safety(const ApiRequest& request);
  ApiReply lint(const ApiRequest& request);

  struct Route;
  static const Route* find(const ApiRequest& request);

  const Project& project_;
  RowCache cache_;
};

}  // namespace vernier::workbench
