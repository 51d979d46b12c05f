// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>

namespace vernier {

/// Result of the request for realtime settings. For each setting that the operating system refused, it
/// contains the errno.
struct RealtimeGrant {
  int memory_error = 0;    // errno of mlockall; 0: granted
  int schedule_error = 0;  // errno of SCHED_FIFO; 0: granted
  int idle_error = 0;      // errno of /dev/cpu_dma_latency; 0: granted
};

/// Makes the calling thread a realtime thread. The memory is locked, the stack is written once, the scheduler
/// is SCHED_FIFO, and deep idle states are off while the process runs. If a setting is refused, the function
/// continues with the other settings, and the caller reports the refused setting. `priority`: 1..99. Not
/// real-time safe.
RealtimeGrant become_realtime(int priority) noexcept;

/// Sets only SCHED_FIFO for the calling thread. The function is used for threads besides the tick. The
/// function become_realtime_thread() returns 0 or the errno. Not real-time safe.
int become_realtime_thread(int priority) noexcept;

/// After this call, new threads have stacks of 1 MB instead of 8 MB, because all stacks are locked in memory.
/// Not real-time safe.
void keep_stacks_small() noexcept;

/// Number of stack bytes that become_realtime writes, so that no page fault occurs in the tick.
constexpr std::size_t kPrefaultedStack = std::size_t{256} * 1024;

}  // namespace vernier
