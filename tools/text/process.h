// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <sys/types.h>

#include <atomic>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace vernier::text {

/// Exit status of a program, and its output.
struct ProcessResult {
  int exit = -1;  // its exit status; 128 + signal if a signal ended it
  std::string out, err;
};

/// A running program, so that another thread can end it.
struct RunningProcess {
  std::atomic<pid_t> group{0};  // its process group; 0 before and after
  std::atomic<bool> cancelled{false};
  /// Ends the program immediately, or as soon as it starts.
  void cancel();
};

/// Runs `program` with `arguments` in `directory` and waits for its end. The program has no standard input
/// and a separate process group, and ends together with this program. `on_line`: called with each line of the
/// program's standard error. Output beyond `most_bytes` ends the program with exit 70. Throws InputError if
/// the program cannot be started.
ProcessResult run_process(const std::string& program, const std::vector<std::string>& arguments,
                          const std::string& directory, std::size_t most_bytes,
                          const std::function<void(std::string_view)>& on_line, RunningProcess& running);

/// Files that become a program's standard input, output and error.
struct StandardStreams {
  int in, out, error;
};
/// Starts a program in a separate process group; the program ends together with the thread that started it.
/// Returns the process number of the program; -1 with errno set. All files except `streams` are closed in the
/// program.
pid_t start_process(const std::string& program, const std::vector<std::string>& arguments,
                    const std::string& directory, const StandardStreams& streams);

/// The last line of a program's output that is not empty, without blanks around it, 400 bytes at most.
std::string last_line(std::string_view output);

/// A command for a shell: words are quoted if necessary.
std::string shell_text(const std::string& program, const std::vector<std::string>& arguments);

}  // namespace vernier::text
