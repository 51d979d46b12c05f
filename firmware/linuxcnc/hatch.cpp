// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware/linuxcnc/hatch.h"

#include <fcntl.h>
#include <linux/futex.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <climits>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <ctime>

namespace vernier {
namespace {

static_assert(std::atomic<std::uint32_t>::is_always_lock_free && sizeof(std::atomic<std::uint32_t>) == 4);

constexpr TimeUs kPatience(100'000);  // then it is seen whether the other process is still there

// Not the private form: the word is in memory of two processes.
void wait_on(std::atomic<std::uint32_t>& word, std::uint32_t while_it_is, TimeUs wait) noexcept {
  const timespec time{static_cast<time_t>(wait.count / 1'000'000),
                      static_cast<long>(wait.count % 1'000'000) * 1000};
  ::syscall(SYS_futex, &word, FUTEX_WAIT, while_it_is, &time, nullptr, 0);
}

void wake(std::atomic<std::uint32_t>& word) noexcept {
  ::syscall(SYS_futex, &word, FUTEX_WAKE, INT_MAX, nullptr, nullptr, 0);
}

}  // namespace

bool process_lives(std::int32_t pid) noexcept {
  if (pid <= 0 || (::kill(pid, 0) != 0 && errno == ESRCH)) return false;
  char path[32], text[512];
  std::snprintf(path, sizeof(path), "/proc/%d/stat", pid);
  const int file = ::open(path, O_RDONLY | O_CLOEXEC);
  if (file < 0) return true;
  const ssize_t size = ::read(file, text, sizeof(text) - 1);
  ::close(file);
  if (size <= 0) return false;
  text[size] = 0;
  // The name, which may hold anything, ends with the last parenthesis; then comes the state.
  const char* const name_end = std::strrchr(text, ')');
  return name_end == nullptr || name_end[1] == 0 || name_end[2] != 'Z';
}

bool wait_for_call(Call& call, TimeUs wait) noexcept {
  const std::uint32_t turn = call.turn.load(std::memory_order_acquire);
  if ((turn & 1) == 0) wait_on(call.turn, turn, wait);
  return is_asked(call);
}

void answer_call(Call& call) noexcept {
  // A request that was withdrawn meanwhile has no owner any more.
  std::uint32_t turn = call.turn.load(std::memory_order_relaxed);
  if ((turn & 1) != 0) call.turn.compare_exchange_strong(turn, turn + 1, std::memory_order_release);
  wake(call.turn);
}

bool make_call(Call& call, std::int32_t peer, const std::atomic<bool>& stop) noexcept {
  const std::uint32_t asked = call.turn.load(std::memory_order_relaxed) | 1;
  call.turn.store(asked, std::memory_order_release);
  wake(call.turn);
  for (;;) {
    wait_on(call.turn, asked, kPatience);
    if (call.turn.load(std::memory_order_acquire) != asked) return true;
    if (!stop && process_lives(peer)) continue;
    std::uint32_t now = asked;
    // Answered at the last moment is answered.
    return !call.turn.compare_exchange_strong(now, asked + 1, std::memory_order_acq_rel);
  }
}

}  // namespace vernier
