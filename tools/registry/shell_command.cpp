// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/registry/shell_command.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "tools/text/error.h"
#include "tools/text/words.h"

namespace vernier::registry {
namespace {

constexpr std::size_t kTailKept = 4000, kLongestLine = 400;

}  // namespace

std::string command_for(const std::string& command, const std::string& machine) {
  std::string quoted = "'";
  for (const char c : machine) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  quoted += "'";
  const std::string mark = "{machine}";
  std::string result = command;
  for (std::size_t at = result.find(mark); at != std::string::npos;
       at = result.find(mark, at + quoted.size()))
    result.replace(at, mark.size(), quoted);
  return result;
}

ShellCommand::ShellCommand(const std::string& command) {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) throw text::InputError({}, command, std::strerror(errno));
  const pid_t mother = ::getpid();
  pid_ = ::fork();
  if (pid_ < 0) {
    const std::string why = std::strerror(errno);
    ::close(ends[0]), ::close(ends[1]);
    pid_ = 0;
    throw text::InputError({}, command, why);
  }
  if (pid_ == 0) {
    ::setpgid(0, 0);
    // A killed worker takes its command with it; else two attempts would run side by side.
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != mother) ::_exit(127);
    sigset_t none;
    sigemptyset(&none);
    ::sigprocmask(SIG_SETMASK, &none, nullptr);
    ::signal(SIGPIPE, SIG_DFL);
    const int nothing = ::open("/dev/null", O_RDONLY);
    ::dup2(nothing, 0), ::dup2(ends[1], 1), ::dup2(ends[1], 2);
    ::execl("/bin/sh", "sh", "-c", command.c_str(), static_cast<char*>(nullptr));
    ::_exit(127);
  }
  ::close(ends[1]);
  output_ = ends[0];
  ::fcntl(output_, F_SETFL, O_NONBLOCK);
}

void ShellCommand::read() {
  char bytes[4096];
  for (ssize_t got = 0; output_ >= 0 && (got = ::read(output_, bytes, sizeof(bytes))) > 0;) {
    tail_.append(bytes, static_cast<std::size_t>(got));
    if (tail_.size() > 2 * kTailKept) tail_.erase(0, tail_.size() - kTailKept);
  }
}

bool ShellCommand::wait(std::chrono::milliseconds patience) {
  const auto end = std::chrono::steady_clock::now() + patience;
  while (pid_ != 0) {
    read();
    int status = 0;
    if (::waitpid(pid_, &status, WNOHANG) == pid_) {
      read();
      status_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
      pid_ = 0;
      ::close(output_);
      output_ = -1;
      break;
    }
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
    if (left.count() <= 0) return false;
    pollfd waiting{output_, POLLIN, 0};
    ::poll(&waiting, 1, static_cast<int>(std::min<std::int64_t>(left.count(), 20)));
    // A command that has closed its output and goes on must not make this spin.
    if ((waiting.revents & POLLHUP) != 0) ::usleep(1000);
  }
  return true;
}

std::string ShellCommand::last_line() const {
  std::string line;
  for (const std::string& one : text::words_in(tail_, "\n"))
    if (!text::trimmed(one).empty()) line = text::trimmed(one);
  return line.substr(0, kLongestLine);
}

void ShellCommand::end() {
  if (pid_ == 0) return;
  ::kill(-pid_, SIGKILL);
  ::waitpid(pid_, nullptr, 0);
  pid_ = 0;
  status_ = 128 + SIGKILL;
  ::close(output_);
  output_ = -1;
}

}  // namespace vernier::registry
