// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <atomic>
#include <functional>

namespace vernier::commands {

/// Executes a function that runs until SIGINT, SIGTERM or SIGHUP. The signal sets `stop`, and then
/// `on_signal` is called in another thread. If the function has not returned one second after the signal, the
/// process ends with the exit status `late`. A wait for a network or a long computation therefore does not
/// delay the end of the process. A forced end of the process has the effect of a power failure: no stored
/// data are lost.
void until_told(
    const std::function<void(const std::atomic<bool>& stop)>& run,
    const std::function<void()>& on_signal = [] {}, int late = 0);

}  // namespace vernier::commands
