// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>

namespace vernier {

/// The realtime settings that the operating system granted; for each refused setting, the errno.
struct RealtimeGrant {
  int memory_error = 0;    // mlockall
  int schedule_error = 0;  // SCHED_FIFO
  int idle_error = 0;      // /dev/cpu_dma_latency
};

/// Makes the calling thread a realtime thread: memory locked, stack touched, SCHED_FIFO, deep idle states off
/// while the process lives. Continues without the refused settings; the caller reports the refused settings.
/// priority: 1..99. Not real-time safe.
RealtimeGrant become_realtime(int priority) noexcept;

/// Gives the calling thread only SCHED_FIFO, for a thread beside the tick. Returns 0 or the errno.
/// Not real-time safe.
int become_realtime_thread(int priority) noexcept;

/// Threads that are created after this call have stacks of 1 MB instead of 8 MB, because all stacks are
/// locked in memory. Not real-time safe.
void keep_stacks_small() noexcept;

/// Number of stack bytes that become_realtime touches, so that no page fault occurs in the tick.
constexpr std::size_t kPrefaultedStack = std::size_t{256} * 1024;

}  // namespace vernier
