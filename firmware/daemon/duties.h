// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <atomic>
#include <string>
#include <thread>

#include "firmware/core/service.h"
#include "firmware/daemon/devices.h"
#include "hal/linux/service_manager.h"
#include "hal/linux/wake_up.h"

namespace vernier {

/// The threads of the daemon besides the tick, one thread for each duty:
///   guardian  hands programs over, ends trials, reports to the service manager that the tick ran;
///             the guardian only waits for time, so that no client and no medium can block it;
///   links     answers requests;
///   store     waits for the medium;
///   sensors   waits for drivers.
class Duties {
 public:
  /// All arguments must exist longer than this object. `priority`: priority of the guardian in SCHED_FIFO; 0:
  /// an ordinary thread. Not real-time safe.
  Duties(Service& service, Devices& devices, ServiceManager& manager, int priority);
  /// Ends the threads. The store completes its present request before it ends.
  ~Duties();
  Duties(const Duties&) = delete;
  Duties& operator=(const Duties&) = delete;

 private:
  void guard(int priority);
  void serve_links();
  void look_after_store();
  void sample();

  Service& service_;
  Devices& devices_;
  ServiceManager& manager_;
  std::atomic<bool> stop_{false};
  WakeUp store_, links_;
  std::thread guardian_, link_thread_, store_thread_, sensor_thread_;
};

}  // namespace vernier
