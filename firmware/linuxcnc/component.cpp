// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware/linuxcnc/component.h"

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <vector>

namespace vernier {
namespace {

constexpr TimeUs kKeeperWait(5'000);  // between two rounds of the guardian
constexpr TimeUs kStoreWait(10'000);  // between two checks for a request to the store
constexpr std::int64_t kSettleTicks = 5;
constexpr std::uint32_t kMostImage = 1u << 26;
constexpr int kError = 1;

WeightQ16 weight_of(double share) noexcept {
  return WeightQ16(
      share > 0 ? static_cast<std::int32_t>(std::lround(std::min(share, 1.0) * kFullWeight.count)) : 0);
}

InstantNs delay_of(double seconds) noexcept {
  constexpr double kMost = 0.05;  // ProbeSettings
  return InstantNs(seconds > 0 ? std::llround(std::min(seconds, kMost) * 1e9) : 0);
}

// Signals are the controller's.
bool start_thread(pthread_t& thread, void* (*run)(void*), void* argument) noexcept {
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  // Not the schedule of the thread that loads modules, which may be a realtime one.
  const sched_param ordinary{};
  pthread_attr_setinheritsched(&attributes, PTHREAD_EXPLICIT_SCHED);
  pthread_attr_setschedpolicy(&attributes, SCHED_OTHER);
  pthread_attr_setschedparam(&attributes, &ordinary);
  const bool started = pthread_create(&thread, &attributes, run, argument) == 0;
  pthread_attr_destroy(&attributes);
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  return started;
}

bool same(const Introduction& a, const Introduction& b) noexcept {
  return a.keys == b.keys && a.capacity == b.capacity && a.board == b.board &&
         a.board_class == b.board_class && std::equal(a.key, a.key + a.keys, b.key) &&
         std::strncmp(a.store, b.store, sizeof(a.store)) == 0;
}

}  // namespace

Component::Component(const Pins& pins, Hatch& hatch, const Wiring& wiring, double mm_per_unit, Say say)
    : pins_(pins),
      hatch_(hatch),
      wiring_(wiring),
      say_(say),
      joints_(pins, wiring_, mm_per_unit),
      standing_(joints_),
      inputs_(pins, static_cast<std::uint32_t>(wiring_.inputs.size())),
      enable_(pins, joints_),
      link_(hatch.link) {}

bool Component::start() noexcept {
  keeps_ = start_thread(keeper_, &keep, this);
  stores_ = start_thread(store_thread_, &look_after_store, this);
  return keeps_ && stores_;
}

void Component::stop() noexcept {
  if (stop_.exchange(true)) return;
  hatch_.magic.store(0);
  if (keeps_) pthread_join(keeper_, nullptr);
  if (stores_) pthread_join(store_thread_, nullptr);
}

Component::~Component() { stop(); }

void Component::tick(long period_ns) noexcept {
  const double seconds = static_cast<double>(period_ns) * 1e-9;
  tick_us_.store(static_cast<std::uint32_t>((period_ns + 500) / 1000), std::memory_order_relaxed);
  joints_.read(seconds);
  if (Service* const service = service_.load(std::memory_order_acquire); service != nullptr) {
    service->set_weight(weight_of(*pins_.weight));
    service->set_probe_delay(delay_of(*pins_.probe_delay));
    const bool clear = *pins_.clear, hold = *pins_.hold;
    if (clear && !cleared_) service->order(Command::kClearFault);
    if (hold != held_) service->order(hold ? Command::kHold : Command::kRelease);
    cleared_ = clear, held_ = hold;
    show(service->tick());
    for (std::uint32_t i = 0; i < wiring_.axes.size(); ++i) joints_.set_slew(i, made_->cycle().slew(i));
  }
  joints_.write();
  const bool at_limit = joints_.any_at_limit();
  *pins_.at_limit = at_limit;
  *pins_.abort = at_limit && *pins_.limit_mode == 1;
}

void Component::show(const TickReport& report) noexcept {
  const Cycle& cycle = made_->cycle();
  bool any = false;
  std::uint32_t limits = 0;
  for (std::uint32_t i = 0; i < wiring_.axes.size(); ++i) {
    const bool held = (cycle.limits(i) & (kAtImageLimit | kAtBoardLimit | kAtOutputLimit)) != 0;
    *pins_.joint[i].saturated = held;
    any = any || held;
    limits |= joints_.at_limit(i) ? 1u << i : 0u;
  }
  *pins_.saturated = any;
  *pins_.active = report.mode == Mode::kActive;
  *pins_.mode = static_cast<std::int32_t>(report.mode);
  // While it checks no fault is latched; the missing condition is shown once a correction is requested.
  const bool waits = report.mode == Mode::kChecking && *pins_.enable;
  const Fault fault = waits ? cycle.found() : report.latched;
  *pins_.fault = fault != Fault::kNone;
  *pins_.fault_code = static_cast<std::int32_t>(fault);
  const Histogram& execution = made_->runner().times().execution;
  *pins_.execution = static_cast<std::uint32_t>(std::min<std::int64_t>(execution.last_ns(), UINT32_MAX));
  *pins_.execution_max = static_cast<std::uint32_t>(std::min<std::int64_t>(execution.max_ns(), UINT32_MAX));
  fault_.store(static_cast<std::uint32_t>(fault), std::memory_order_relaxed);
  limits_.store(limits, std::memory_order_relaxed);
}

// ---- the keeper

void* Component::keep(void* component) {
  Component& self = *static_cast<Component*>(component);
  while (!self.stop_) {
    Service* const service = self.service_.load(std::memory_order_acquire);
    if (service == nullptr) {
      self.clock_.sleep_until(self.clock_.now() + instant_ns(kKeeperWait));
      continue;
    }
    wait_for_call(self.hatch_.link, kKeeperWait);
    LinkRights rights;
    rights.access = self.link_.access();
    service->serve(self.link_, TimeUs(0), rights);
    service->guard();
    self.tell();
  }
  return nullptr;
}

void Component::tell() noexcept {
  char text[120];
  const std::uint32_t fault = fault_.load(std::memory_order_relaxed);
  if (fault != told_fault_ && fault != 0) {
    std::snprintf(text, sizeof(text), "vernier: fault: %s: no correction\n",
                  name_of(static_cast<Fault>(fault)));
    say_(kError, text);
  }
  told_fault_ = fault;
  const std::uint32_t limits = limits_.load(std::memory_order_relaxed);
  for (std::uint32_t i = 0; i < wiring_.axes.size(); ++i) {
    if ((limits & ~told_limits_ & 1u << i) == 0) continue;
    std::snprintf(
        text, sizeof(text),
        "vernier: joint %u (%s) is held at its limit: the correction would move the joint beyond the limit\n",
        static_cast<unsigned>(i), wiring_.axes[i].name.c_str());
    say_(kError, text);
  }
  told_limits_ = limits;
}

// ---- the store

void* Component::look_after_store(void* component) {
  Component& self = *static_cast<Component*>(component);
  while (!self.stop_) {
    const bool ran = self.tick_us_.load(std::memory_order_relaxed) != 0;
    if (wait_for_call(self.hatch_.attach, kStoreWait) && ran) self.attach();
    if (!ran) self.clock_.sleep_until(self.clock_.now() + instant_ns(kStoreWait));
    if (self.made_) self.made_->look_after_store();
  }
  return nullptr;
}

void Component::attach() noexcept {
  Call& call = hatch_.attach;
  Introduction introduction;
  std::memcpy(static_cast<void*>(&introduction), call.bytes, sizeof(introduction));
  char text[200] = {};
  const Attached attached = meet(introduction, text, sizeof(text));
  std::memcpy(call.bytes, text, sizeof(text));
  call.size = sizeof(text);
  call.result = static_cast<std::int32_t>(attached);
  answer_call(call);
}

Attached Component::meet(const Introduction& introduction, char* text, std::uint32_t room) noexcept {
  if (introduction.keys > BoardIdentity::kMostKeys) return Attached::kOtherStore;
  if (made_) {
    if (!same(introduction, met_)) return Attached::kOtherStore;
    hatch_.helper = introduction.pid;
    return Attached::kResumed;
  }
  hatch_.helper = introduction.pid;
  met_ = introduction;
  store_ = std::make_unique<RemoteStore>(hatch_, introduction.capacity, stop_);
  made_ = make_service(introduction);
  probe_->follow(made_->runner());
  const UploadResult result = boot(introduction);
  service_.store(made_.get(), std::memory_order_release);
  if (result.fault == UploadFault::kNone)
    return made_->uploader().record().confirmed_fingerprint == 0 ? Attached::kEmpty : Attached::kStarted;
  std::snprintf(text, room, "%s", describe(result).c_str());
  return Attached::kImageRefused;
}

std::unique_ptr<Service> Component::make_service(const Introduction& introduction) noexcept {
  const TimeUs tick(tick_us_.load());
  ServiceOptions options;
  options.wiring = wiring_;
  options.upload.tick = tick;
  std::vector<std::uint32_t> memory(kWordsBeyondCaches);
  options.upload.budget = measured_work_budget(clock_, tick, memory);
  options.upload.identity.board = introduction.board;
  options.upload.identity.board_class = introduction.board_class;
  for (std::uint32_t i = 0; i < introduction.keys; ++i)
    options.upload.identity.keys.push_back({introduction.key[i], "public-key"});
  options.nonce = introduction.nonce;
  options.seed = introduction.seed;
  // The pin is read once per tick: a contact that opens for a few ticks bounces.
  options.probe.settle = instant_ns(TimeUs(kSettleTicks * tick.count));
  options.store_beside = true;
  options.activate = options.clear_on_enable = options.in_controller = true;
  probe_ = std::make_unique<PinProbe>(pins_, tick);
  const Board board{.clock = clock_,
                    .axes = joints_,
                    .inputs = inputs_,
                    .corrections = joints_,
                    .probe = probe_.get(),
                    .actual = &standing_,
                    .enable = &enable_};
  return std::make_unique<Service>(options, board, *store_);
}

UploadResult Component::boot(const Introduction& introduction) noexcept {
  if (introduction.given_bytes == 0) return made_->boot();
  UploadResult refused;
  refused.fault = UploadFault::kTooLarge;
  if (introduction.given_bytes > kMostImage) return refused;
  const auto bytes = std::make_unique<std::uint8_t[]>(introduction.given_bytes);
  if (store_->read_given(0, bytes.get(), introduction.given_bytes) != HalFault::kNone) {
    refused.fault = UploadFault::kStore;
    return refused;
  }
  return made_->boot_with({bytes.get(), introduction.given_bytes});
}

}  // namespace vernier
