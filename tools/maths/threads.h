// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <algorithm>
#include <cstddef>
#include <future>
#include <thread>
#include <vector>

namespace vernier::maths {

/// Calls `work(thread, threads)` in each of `threads` threads, and waits for all of them: one thread for each
/// processor, at most four. Thread 0 is the caller's. If the threads take every `threads`-th item from the
/// item `thread` on, the result of an item never depends on the speed of the threads. An exception of a
/// thread passes on to the caller after all have ended.
template <typename Work>
void in_threads(const Work& work) {
  const std::size_t threads = std::max(1U, std::min(4U, std::thread::hardware_concurrency()));
  std::vector<std::future<void>> others;  // each waits in its destructor, also if this thread throws
  for (std::size_t thread = 1; thread < threads; ++thread)
    others.push_back(std::async(std::launch::async, [&, thread] { work(thread, threads); }));
  work(std::size_t{0}, threads);
  for (std::future<void>& other : others) other.get();
}

}  // namespace vernier::maths
