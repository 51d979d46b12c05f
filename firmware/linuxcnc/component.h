// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <pthread.h>

#include <atomic>
#include <memory>

#include "firmware/core/service.h"
#include "firmware/linuxcnc/hatch.h"
#include "firmware/linuxcnc/hatch_link.h"
#include "firmware/linuxcnc/joints.h"
#include "firmware/linuxcnc/remote_store.h"
#include "firmware/linuxcnc/signals.h"
#include "hal/linux/monotonic_clock.h"

namespace vernier {

/// The program of a board as a component in the servo thread of LinuxCNC: the Service of firmware/core on HAL
/// pins. In addition to the tick, the component has two threads that are not realtime: the keeper (guardian
/// and links) and the store, which waits for the process vernier-hal. Until vernier-hal is connected, the
/// commands of the joints are passed on unchanged.
class Component {
 public:
  /// Function that writes a message to the log of LinuxCNC. `level`: as in rtapi_print_msg (1: error, 3:
  /// note).
  using Say = void (*)(int level, const char* text);

  /// `pins`, `hatch`: must exist longer than this object. `mm_per_unit`: unit of lengths of the machine, mm.
  /// Not real-time safe.
  Component(const Pins& pins, Hatch& hatch, const Wiring& wiring, double mm_per_unit, Say say);
  /// Call the destructor only after the last tick. Not real-time safe.
  ~Component();
  Component(const Component&) = delete;
  Component& operator=(const Component&) = delete;
  /// Starts the two threads. Returns false if the operating system refuses the threads. Not
  /// real-time safe.
  bool start() noexcept;
  /// Ends the two threads. After stop(), ticks may still run, and the shared memory (hatch) is not used any
  /// more. Not real-time safe.
  void stop() noexcept;

  /// Executes one cycle of the servo thread. `period_ns`: period of the servo thread, ns. Real-time safe.
  void tick(long period_ns) noexcept;

 private:
  static void* keep(void* component);
  static void* look_after_store(void* component);
  void attach() noexcept;
  Attached meet(const Introduction& introduction, char* text, std::uint32_t room) noexcept;
  std::unique_ptr<Service> make_service(const Introduction& introduction) noexcept;
  UploadResult boot(const Introduction& introduction) noexcept;
  void tell() noexcept;
  void show(const TickReport& report) noexcept;

  const Pins& pins_;
  Hatch& hatch_;
  Wiring wiring_;
  Say say_;
  MonotonicClock clock_;
  Joints joints_;
  StandingJoints standing_;
  PinInputs inputs_;
  EnablePin enable_;
  HatchLink link_;
  std::atomic<bool> stop_{false};
  pthread_t keeper_{}, store_thread_{};
  bool keeps_ = false, stores_ = false;
  std::atomic<std::uint32_t> tick_us_{0};  // period of the servo thread; 0: the thread has not run yet
  // The component creates these objects when vernier-hal connects for the first time.
  std::unique_ptr<RemoteStore> store_;
  std::unique_ptr<PinProbe> probe_;
  std::unique_ptr<Service> made_;
  std::atomic<Service*> service_{nullptr};
  Introduction met_;
  // Members that only the tick uses.
  bool cleared_ = false, held_ = false;
  // The last reported state. Only the keeper thread uses the last reported state.
  std::atomic<std::uint32_t> fault_{0}, limits_{0};
  std::uint32_t told_fault_ = 0, told_limits_ = 0;
};

}  // namespace vernier
