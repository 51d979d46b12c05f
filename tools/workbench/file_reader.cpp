// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/workbench/file_reader.h"

#include <fmt/format.h>

#include "tools/workbench/files/file_desk.h"

namespace vernier::workbench {
namespace {

Message message_of(const ApiRequest& request) {
  Message message = {request.method, request.path, request.body};
  for (const auto& [name, value] : request.query) message.insert(message.end(), {name, value});
  return message;
}

bool read_request(const Message& message, ApiRequest& request) {
  if (message.size() < 3 || message.size() % 2 == 0) return false;
  request = {message[0], message[1], {}, message[2]};
  for (std::size_t i = 3; i < message.size(); i += 2) request.query.emplace(message[i], message[i + 1]);
  return true;
}

Message message_of(const ApiReply& reply) {
  Message message = {std::to_string(reply.status), reply.type, reply.body};
  for (const auto& [name, value] : reply.headers) message.insert(message.end(), {name, value});
  return message;
}

bool read_reply(const Message& message, ApiReply& reply) {
  if (message.size() < 3 || message.size() % 2 == 0) return false;
  reply = {static_cast<int>(whole_number(message[0])), message[1], message[2], {}};
  for (std::size_t i = 3; i < message.size(); i += 2) reply.headers.emplace_back(message[i], message[i + 1]);
  return true;
}

}  // namespace

ApiReply FileReader::reply(const ApiRequest& request) {
  const std::scoped_lock lock(guard_);
  return reply_of(project_, [&] {
    if (!reader_)
      reader_ = std::make_unique<Conversation>(
          program_, std::vector<std::string>{"workbench", project_.root().string(), "--reader"},
          project_.root().string());
    Message answer;
    ApiReply reply;
    if (reader_->ask(message_of(request), patience_s_, answer) && read_reply(answer, reply)) return reply;
    const std::string how = reader_->end();
    reader_.reset();
    throw text::InputError(
        fmt::format("the reading process ended during this request ({}): a file of the request cannot be "
                    "read, and nothing was changed",
                    how));
  });
}

void serve_files(const Project& project, int stream) {
  FileDesk desk(project);
  ApiRequest request;
  for (Message message; read_message(stream, 0, message) && read_request(message, request);)
    if (!write_message(stream, 0, message_of(desk.reply(request)))) return;
}

}  // namespace vernier::workbench
