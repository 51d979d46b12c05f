// SPDX-License-Identifier: Apache-2.0
#include "firmware/daemon/duties.h"

#include <cstdio>

#include "firmware/core/sign_of_life.h"
#include "hal/linux/realtime.h"

namespace vernier {
namespace {

constexpr TimeUs kGuardPeriod(5'000);
constexpr TimeUs kServeWait(20'000);
constexpr TimeUs kStoreWait(10'000);   // latest time to record the actions of guardian and operator
constexpr TimeUs kSampleWait(10'000);  // between two samples of the sensors

}  // namespace

Duties::Duties(Service& service, Devices& devices, ServiceManager& manager, int priority)
    : service_(service), devices_(devices), manager_(manager) {
  guardian_ = std::thread([this, priority] { guard(priority); });
  link_thread_ = std::thread([this] { serve_links(); });
  store_thread_ = std::thread([this] { look_after_store(); });
  sensor_thread_ = std::thread([this] { sample(); });
}

Duties::~Duties() {
  stop_ = true;
  store_.wake();
  links_.wake();
  for (std::thread* const thread : {&link_thread_, &store_thread_, &sensor_thread_, &guardian_})
    thread->join();
}

void Duties::guard(int priority) {
  if (priority > 0) become_realtime_thread(priority);
  Clock& clock = devices_.clock();
  InstantNs due = clock.now();
  SignOfLife life(due);
  while (!stop_) {
    service_.guard();
    if (life.due(service_.exchange().ticks.count(), clock.now())) {
      manager_.notify("WATCHDOG=1");
      devices_.feed_watchdog();
    }
    due = std::max(due + instant_ns(kGuardPeriod), clock.now());
    clock.sleep_until(due);
  }
}

void Duties::serve_links() {
  while (!stop_) {
    devices_.wait_for_request(kServeWait, links_);
    for (OpenLink& link : devices_.links()) service_.serve(*link.device, TimeUs(0), link.rights);
    if (service_.store_is_asked()) store_.wake();
  }
}

void Duties::look_after_store() {
  bool refused = false;
  while (!stop_) {
    store_.wait(service_.store_is_asked() ? kGuardPeriod : kStoreWait);
    if (service_.look_after_store()) links_.wake();
    if (const bool now = service_.operator_memory().refused(); now != refused) {
      refused = now;
      std::fputs(now ? "vernierd: the store refuses the operator's last setting: a start restores an older "
                       "setting\n"
                     : "vernierd: the store has the operator's last setting again\n",
                 stderr);
    }
  }
}

void Duties::sample() {
  while (!stop_ && devices_.has_sensors()) {
    devices_.sample();
    devices_.clock().sleep_until(devices_.clock().now() + instant_ns(kSampleWait));
  }
}

}  // namespace vernier
