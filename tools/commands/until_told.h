// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <atomic>
#include <functional>

namespace vernier::commands {

/// Runs a function that continues until SIGINT, SIGTERM or SIGHUP: the signal sets `stop` and then calls
/// `on_signal` in another thread. If the function has not returned after one second, the process ends with
/// the status `late`: a wait for a network or for a long computation does not delay the end. This end of the
/// process loses no stored data, in the same way as a power cut.
void until_told(
    const std::function<void(const std::atomic<bool>& stop)>& run,
    const std::function<void()>& on_signal = [] {}, int late = 0);

}  // namespace vernier::commands
