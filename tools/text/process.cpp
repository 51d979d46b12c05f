// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/text/process.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>

#include "tools/text/error.h"
#include "tools/text/words.h"

namespace vernier::text {
namespace {

constexpr int kNotStarted = 127, kOurBug = 70;

/// Both ends of a pipe, closed when they go.
struct Pipe {
  Pipe() {
    if (::pipe2(end.data(), O_CLOEXEC) != 0)
      throw InputError(std::string("no pipe to a command: ") + std::strerror(errno));
  }
  ~Pipe() {
    close_end(0);
    close_end(1);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  void close_end(std::size_t i) {
    if (end[i] >= 0) ::close(end[i]);
    end[i] = -1;
  }
  std::array<int, 2> end{-1, -1};
};

/// Between fork and exec only calls that are safe there: everything was prepared by the parent.
[[noreturn]] void become(const char* program, char* const* arguments, char* const* environment,
                         const char* directory, const StandardStreams& streams) {
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::dup2(streams.in, 0) < 0 || ::dup2(streams.out, 1) < 0 || ::dup2(streams.error, 2) < 0)
    ::_exit(kNotStarted);
  // Connections of the server are no business of a command.
  ::close_range(3, ~0U, 0);
  if (::chdir(directory) != 0) ::_exit(kNotStarted);
  sigset_t none;
  ::sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  ::execve(program, arguments, environment);
  ::_exit(kNotStarted);
}

/// Standard error, cut into lines while it comes.
class Lines {
 public:
  explicit Lines(const std::function<void(std::string_view)>& on_line) : on_line_(on_line) {}
  void add(std::string_view bytes) {
    open_ += bytes;
    std::size_t from = 0;
    for (auto at = open_.find('\n'); at != std::string::npos; at = open_.find('\n', from)) {
      on_line_(std::string_view(open_).substr(from, at - from));
      from = at + 1;
    }
    open_.erase(0, from);
  }
  ~Lines() {
    if (!open_.empty()) on_line_(open_);
  }
  Lines(const Lines&) = delete;
  Lines& operator=(const Lines&) = delete;

 private:
  const std::function<void(std::string_view)>& on_line_;
  std::string open_;
};

/// Reads both pipes until both are closed; false where more came than was allowed.
bool collect(Pipe& out, Pipe& err, std::size_t most, ProcessResult& result, Lines& lines) {
  std::array<pollfd, 2> wait = {{{out.end[0], POLLIN, 0}, {err.end[0], POLLIN, 0}}};
  std::array<char, 65536> bytes;
  while (wait[0].fd >= 0 || wait[1].fd >= 0) {
    if (::poll(wait.data(), wait.size(), -1) < 0 && errno != EINTR) return false;
    for (std::size_t i = 0; i < wait.size(); ++i) {
      if (wait[i].fd < 0 || wait[i].revents == 0) continue;
      const ssize_t count = ::read(wait[i].fd, bytes.data(), bytes.size());
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) {
        wait[i].fd = -1;
        continue;
      }
      const std::string_view piece(bytes.data(), static_cast<std::size_t>(count));
      (i == 0 ? result.out : result.err) += piece;
      if (i == 1) lines.add(piece);
      if (result.out.size() + result.err.size() > most) return false;
    }
  }
  return true;
}

std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> list;
  for (std::string& text : texts) list.push_back(text.data());
  list.push_back(nullptr);
  return list;
}

}  // namespace

pid_t start_process(const std::string& program, const std::vector<std::string>& arguments,
                    const std::string& directory, const StandardStreams& streams) {
  std::vector<std::string> words = {program}, environment = {"VERNIER_PROGRESS=lines"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  for (char** entry = ::environ; *entry != nullptr; ++entry) environment.emplace_back(*entry);
  const std::vector<char*> argv = pointers(words), envp = pointers(environment);
  const pid_t child = ::fork();
  if (child == 0) become(program.c_str(), argv.data(), envp.data(), directory.c_str(), streams);
  if (child > 0) ::setpgid(child, child);  // in both processes, because either may be first
  return child;
}

ProcessResult run_process(const std::string& program, const std::vector<std::string>& arguments,
                          const std::string& directory, std::size_t most_bytes,
                          const std::function<void(std::string_view)>& on_line, RunningProcess& running) {
  Pipe out, err;
  const int nothing = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
  const pid_t child = start_process(program, arguments, directory, {nothing, out.end[1], err.end[1]});
  const int failed = errno;
  ::close(nothing);
  if (child < 0) throw InputError(std::string("a command cannot be started: ") + std::strerror(failed));
  running.group = child;
  if (running.cancelled) running.cancel();
  out.close_end(1);
  err.close_end(1);
  ProcessResult result;
  bool whole = true;
  {
    Lines lines(on_line);
    whole = collect(out, err, most_bytes, result, lines);
  }
  if (!whole) running.cancel();
  running.group = 0;  // from here on its number may belong to another one
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  result.exit = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  if (!whole) result.exit = kOurBug;
  return result;
}

void RunningProcess::cancel() {
  cancelled = true;
  const pid_t running = group;
  if (running > 0) ::kill(-running, SIGKILL);
}

std::string last_line(std::string_view output) {
  constexpr std::size_t kLongest = 400;
  std::string line;
  for (const std::string& one : words_in(output, "\n"))
    if (!trimmed(one).empty()) line = trimmed(one);
  return line.substr(0, kLongest);
}

std::string shell_text(const std::string& program, const std::vector<std::string>& arguments) {
  std::string text = program;
  constexpr std::string_view kPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=./:,@%";
  for (const std::string& word : arguments) {
    text += ' ';
    if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) {
      text += word;
      continue;
    }
    text += '\'';
    for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
    text += '\'';
  }
  return text;
}

}  // namespace vernier::text
