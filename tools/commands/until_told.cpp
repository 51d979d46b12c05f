// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/commands/until_told.h"

#include <fmt/format.h>
#include <signal.h>

#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <thread>

namespace vernier::commands {
namespace {

/// Longest wait for an orderly end.
constexpr std::chrono::seconds kGrace{1};

}  // namespace

void until_told(const std::function<void(const std::atomic<bool>& stop)>& run,
                const std::function<void()>& on_signal, int late) {
  std::atomic<bool> stop{false};
  sigset_t set;
  sigemptyset(&set);
  for (const int one : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&set, one);
  pthread_sigmask(SIG_BLOCK, &set, nullptr);  // before any thread, so that all have it
  ::signal(SIGPIPE, SIG_IGN);
  std::mutex guard;
  std::condition_variable changed;
  bool over = false;
  std::thread wait([&] {
    int which = 0;
    sigwait(&set, &which);
    stop = true;
    on_signal();
    std::unique_lock lock(guard);
    if (changed.wait_for(lock, kGrace, [&] { return over; })) return;
    fmt::print(stderr, "ended {} s after the signal, without waiting for running work\n", kGrace.count());
    std::fflush(nullptr);
    std::_Exit(late);
  });
  const auto end = [&] {
    {
      const std::scoped_lock lock(guard);
      over = true;
    }
    changed.notify_all();
    pthread_kill(wait.native_handle(), SIGTERM);  // where something else than a signal ended it
    wait.join();
  };
  try {
    run(stop);
  } catch (...) {
    end();
    throw;
  }
  end();
}

}  // namespace vernier::commands
