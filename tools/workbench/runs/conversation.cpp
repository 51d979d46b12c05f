// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/workbench/runs/conversation.h"

#include <poll.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstring>

#include "tools/text/error.h"
#include "tools/text/process.h"

namespace vernier::workbench {
namespace {

// A frame of 1e5 rows has some 20 MB.
constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 30, kMostTexts = 1u << 20;

bool ready(int stream, short events, double patience_s) {
  pollfd wait{stream, events, 0};
  const int time = patience_s > 0 ? static_cast<int>(patience_s * 1000) : -1;
  int count = 0;
  while ((count = ::poll(&wait, 1, time)) < 0 && errno == EINTR) {
  }
  return count > 0;
}

bool read_all(int stream, double patience_s, char* bytes, std::size_t size) {
  while (size > 0) {
    if (!ready(stream, POLLIN, patience_s)) return false;
    const ssize_t count = ::recv(stream, bytes, size, 0);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    bytes += count;
    size -= static_cast<std::size_t>(count);
  }
  return true;
}

bool write_all(int stream, double patience_s, const char* bytes, std::size_t size) {
  while (size > 0) {
    if (!ready(stream, POLLOUT, patience_s)) return false;
    const ssize_t count = ::send(stream, bytes, size, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (count < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    if (count <= 0) return false;
    bytes += count;
    size -= static_cast<std::size_t>(count);
  }
  return true;
}

bool read_number(int stream, double patience_s, std::uint64_t& number) {
  char bytes[sizeof number];
  if (!read_all(stream, patience_s, bytes, sizeof bytes)) return false;
  std::memcpy(&number, bytes, sizeof number);
  return true;
}

void add_number(std::string& bytes, std::uint64_t number) {
  char raw[sizeof number];
  std::memcpy(raw, &number, sizeof number);
  bytes.append(raw, sizeof raw);
}

}  // namespace

bool read_message(int stream, double patience_s, Message& message) {
  std::uint64_t count = 0, all = 0;
  message.clear();
  if (!read_number(stream, patience_s, count) || count > kMostTexts) return false;
  for (std::uint64_t i = 0; i < count; ++i) {
    std::uint64_t size = 0;
    if (!read_number(stream, patience_s, size) || size > kMostBytes - all) return false;
    all += size;
    message.emplace_back(size, '\0');
    if (!read_all(stream, patience_s, message.back().data(), size)) return false;
  }
  return true;
}

bool write_message(int stream, double patience_s, const Message& message) {
  std::string head;
  add_number(head, message.size());
  if (!write_all(stream, patience_s, head.data(), head.size())) return false;
  for (const std::string& text : message) {
    std::string size;
    add_number(size, text.size());
    if (!write_all(stream, patience_s, size.data(), size.size()) ||
        !write_all(stream, patience_s, text.data(), text.size()))
      return false;
  }
  return true;
}

Conversation::Conversation(const std::string& program, const std::vector<std::string>& arguments,
                           const std::string& directory) {
  int ends[2];
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
    throw text::InputError(std::string("no way to a process: ") + std::strerror(errno));
  stream_ = ends[0];
  child_ = text::start_process(program, arguments, directory, {ends[1], ends[1], STDERR_FILENO});
  ::close(ends[1]);
  if (child_ >= 0) return;
  ::close(stream_);
  throw text::InputError(std::string("a process cannot be started: ") + std::strerror(errno));
}

Conversation::~Conversation() { end(); }

bool Conversation::ask(const Message& question, double patience_s, Message& answer) {
  return write_message(stream_, patience_s, question) && read_message(stream_, patience_s, answer);
}

std::string Conversation::end() {
  if (child_ < 0) return "no answer";
  ::close(stream_);
  // A process that has broken off gets time to report its end; a process that hangs does not.
  int status = 0;
  pid_t ended = 0;
  for (int i = 0; i < 50 && ended == 0; ++i) {
    ended = ::waitpid(child_, &status, WNOHANG);
    if (ended == 0) ::usleep(2000);
  }
  if (ended == 0) {
    ::kill(-child_, SIGKILL);
    while (::waitpid(child_, &status, 0) < 0 && errno == EINTR) {
    }
  }
  child_ = -1;
  if (ended == 0) return "no answer";
  return WIFEXITED(status) ? "exit status " + std::to_string(WEXITSTATUS(status))
                           : "signal " + std::to_string(WTERMSIG(status));
}

}  // namespace vernier::workbench
