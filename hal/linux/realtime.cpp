// SPDX-License-Identifier: Apache-2.0
#include "hal/linux/realtime.h"

#include <fcntl.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>

namespace vernier {
namespace {

void touch_stack() noexcept {
  volatile unsigned char room[kPrefaultedStack];
  for (std::size_t i = 0; i < kPrefaultedStack; i += 1024) room[i] = 0;
  static_cast<void>(room[0]);
}

// The kernel keeps idle states shallow while the file stays open; it is left open for the life of the
// process.
int hold_awake() noexcept {
  const int file = open("/dev/cpu_dma_latency", O_WRONLY | O_CLOEXEC);
  if (file < 0) return errno;
  const std::int32_t most_us = 0;
  if (write(file, &most_us, sizeof most_us) == sizeof most_us) return 0;
  const int error = errno;
  close(file);
  return error;
}

// Threads that this one makes are ordinary ones.
int become_fifo(int priority) noexcept {
  sched_param schedule{};
  schedule.sched_priority = priority;
  return sched_setscheduler(0, SCHED_FIFO | SCHED_RESET_ON_FORK, &schedule) != 0 ? errno : 0;
}

}  // namespace

RealtimeGrant become_realtime(int priority) noexcept {
  RealtimeGrant grant;
  if (mlockall(MCL_CURRENT | MCL_FUTURE) != 0) grant.memory_error = errno;
  touch_stack();
  grant.schedule_error = become_fifo(priority);
  grant.idle_error = hold_awake();
  return grant;
}

int become_realtime_thread(int priority) noexcept { return become_fifo(priority); }

void keep_stacks_small() noexcept {
  pthread_attr_t attributes;
  if (pthread_attr_init(&attributes) != 0) return;
  if (pthread_attr_setstacksize(&attributes, std::size_t{1} << 20) == 0)
    pthread_setattr_default_np(&attributes);
  pthread_attr_destroy(&attributes);
}

}  // namespace vernier
