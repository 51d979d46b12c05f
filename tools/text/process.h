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
  int exit = -1;  // exit status of the program; 128 + signal if a signal ended the program
  std::string out, err;
};

/// A running program, which another thread can end.
struct RunningProcess {
  std::atomic<pid_t> group{0};  // process group of the program; 0 before its start and after its end
  std::atomic<bool> cancelled{false};
  /// Ends the program immediately. A program that is ended before it is started ends as soon as it starts.
  void cancel();
};

/// Runs `program` with `arguments` in the folder `directory`, and waits for its end. The program has no
/// standard input and its own process group. The started program ends together with this program. `on_line`:
/// function that is called with each line of the program's standard error. If the output exceeds
/// `most_bytes`, the program is ended with exit status 70. Throws InputError if the program cannot be
/// started.
ProcessResult run_process(const std::string& program, const std::vector<std::string>& arguments,
                          const std::string& directory, std::size_t most_bytes,
                          const std::function<void(std::string_view)>& on_line, RunningProcess& running);

/// File descriptors for the standard input, output and error of a program.
struct StandardStreams {
  int in, out, error;
};
/// Starts a program in its own process group. The program ends together with the thread that started it.
/// Returns the process id of the program, or -1 with errno set. In the program, all file descriptors except
/// `streams` are closed.
pid_t start_process(const std::string& program, const std::vector<std::string>& arguments,
                    const std::string& directory, const StandardStreams& streams);

/// Returns the last line of a program's output that is not empty, without leading and trailing blanks, at
/// most 400 bytes.
std::string last_line(std::string_view output);

/// Returns a command as text for a shell. Words are in quotes if this is necessary.
std::string shell_text(const std::string& program, const std::vector<std::string>& arguments);

}  // namespace vernier::text
