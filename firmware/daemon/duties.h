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

/// The daemon's threads beside the tick, one per duty:
///   guardian  hands programs over, ends trials, reports to the service manager that the tick ran;
///             the guardian waits for time only: no client and no medium can block it;
///   links     answers requests;
///   store     waits for the medium;
///   sensors   waits for drivers.
class Duties {
 public:
  /// All arguments outlive this object. priority: SCHED_FIFO of the guardian, 0: an ordinary thread.
  /// Not real-time safe.
  Duties(Service& service, Devices& devices, ServiceManager& manager, int priority);
  /// Ends the threads; the store first completes its present request.
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
