// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>

namespace vernier {

/// What the operating system granted; for what it did not, the errno.
struct RealtimeGrant {
  int memory_error = 0;    // mlockall
  int schedule_error = 0;  // SCHED_FIFO
  int idle_error = 0;      // /dev/cpu_dma_latency
};

/// Makes the calling thread a realtime one: memory locked, stack touched, SCHED_FIFO, deep idle states off
/// while the process lives. Goes on without what is refused; the caller says so. priority: 1..99. setup.
RealtimeGrant become_realtime(int priority) noexcept;

/// Bytes of stack that become_realtime touches, so that the tick does not fault pages in.
constexpr std::size_t kPrefaultedStack = std::size_t{256} * 1024;

}  // namespace vernier
