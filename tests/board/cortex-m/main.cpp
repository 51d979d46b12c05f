// SPDX-License-Identifier: GPL-3.0-or-later
// firmware/core on an emulated Cortex-M4 (MPS2 AN386, Arm DAI 0386): a UART link, slots in RAM, two axes that
// swing, and nothing else. The host uploads an image and confirms it; once it is active kTicks ticks of the
// whole service are counted and the figures printed. This file is all that a port needs: firmware/PORTING.md.
#include <cstddef>
#include <cstdint>
#include <new>

#include "firmware/core/service.h"
#include "tables/operator_record.h"
#include "tables/serial_frame.h"
#include "tests/bench/cortex-m/semihost.h"
#include "tests/board/cortex-m/machine.h"

namespace {

using namespace vernier;
using bench::at;

constexpr std::uint32_t kSlotBytes = 16 * 1024;
constexpr std::uint32_t kArenaBytes = 192 * 1024;
constexpr std::uint32_t kFactoryKey = 0x20200000;  // where the emulator puts the board's public key

// ---- memory: taken while setting up, never given back

alignas(8) unsigned char arena[kArenaBytes];
std::size_t arena_used = 0;
std::uint32_t late_requests = 0;
bool sealed = false;

void* take_memory(std::size_t bytes) {
  late_requests += sealed ? 1 : 0;
  void* const block = arena + arena_used;
  arena_used += (bytes + 7) / 8 * 8;
  if (arena_used > kArenaBytes) {
    bench::print("out of memory\n");
    bench::leave(1);
  }
  return block;
}

// ---- devices

void copy(std::uint8_t* to, const std::uint8_t* from, std::uint32_t size) {
  for (std::uint32_t i = 0; i < size; ++i) to[i] = from[i];
}

/// Slots and records in RAM, in the place of a flash: erased, it holds ones.
class RamStore : public SlotStore {
 public:
  RamStore() {
    for (auto& record : records_)
      for (std::uint8_t& byte : record) byte = 0xff;
  }
  std::uint32_t capacity() const noexcept override { return kSlotBytes; }
  HalFault read_record(std::uint32_t place, std::uint8_t* bytes, std::uint32_t size) noexcept override {
    if (place >= kRecords || size > sizeof(records_[0])) return HalFault::kNoDevice;
    return copy(bytes, records_[place], size), HalFault::kNone;
  }
  HalFault write_record(std::uint32_t place, const std::uint8_t* bytes,
                        std::uint32_t size) noexcept override {
    if (place >= kRecords || size > sizeof(records_[0])) return HalFault::kNoDevice;
    return copy(records_[place], bytes, size), HalFault::kNone;
  }
  HalFault read_image(std::uint32_t slot, std::uint32_t offset, std::uint8_t* bytes,
                      std::uint32_t size) noexcept override {
    if (!fits(slot, offset, size)) return HalFault::kNoReading;
    return copy(bytes, slots_[slot] + offset, size), HalFault::kNone;
  }
  HalFault write_image(std::uint32_t slot, std::uint32_t offset, const std::uint8_t* bytes,
                       std::uint32_t size) noexcept override {
    if (!fits(slot, offset, size)) return HalFault::kNoDevice;
    return copy(slots_[slot] + offset, bytes, size), HalFault::kNone;
  }
  HalFault finish_image(std::uint32_t, std::uint32_t) noexcept override { return HalFault::kNone; }

 private:
  static bool fits(std::uint32_t slot, std::uint32_t offset, std::uint32_t size) {
    return slot < kSlotCount && offset <= kSlotBytes && size <= kSlotBytes - offset;
  }
  static constexpr std::uint32_t kRecords = kSlotRecordCount + kOperatorRecordCount;
  std::uint8_t slots_[kSlotCount][kSlotBytes], records_[kRecords][sizeof(OperatorRecord)];
};

/// CMSDK UART 0 (Arm DDI 0479, section 4.3) with the framing of tables/serial_frame.h.
class UartLink : public CommandLink {
 public:
  UartLink() {
    at(kBase + 0x10) = 217;  // 25 MHz / 115200 baud
    at(kBase + 0x08) = 3;    // transmit, receive
  }
  HalFault serve(CommandHandler& handler, TimeUs) noexcept override {
    while ((at(kBase + 0x04) & kReceived) != 0)
      if (frames_.take(static_cast<std::uint8_t>(at(kBase)))) {
        std::uint8_t reply[kMaxReplyBytes], frame[kMaxFrameBytes];
        const std::uint32_t size = handler.answer(frames_.message(), frames_.size(), reply);
        if (size > 0) send(frame, write_frame(reply, size, frame));
      }
    return HalFault::kNone;
  }

 private:
  static constexpr std::uint32_t kBase = 0x40004000, kFull = 1, kReceived = 2;
  static void send(const std::uint8_t* bytes, std::uint32_t size) {
    for (std::uint32_t i = 0; i < size; ++i) {
      while ((at(kBase + 0x04) & kFull) != 0) {
      }
      at(kBase) = bytes[i];
    }
  }
  FrameReader frames_;
};

// ---- the board

/// Lives as long as the power is on: no destructor is ever run.
template <class T>
struct Forever {
  alignas(T) unsigned char bytes[sizeof(T)];
  template <class... Arguments>
  T& make(Arguments&&... arguments) {
    return *new (static_cast<void*>(bytes)) T(static_cast<Arguments&&>(arguments)...);
  }
};

Forever<TickClock> clock_memory;
Forever<Machine> machine_memory;
Forever<RamStore> store_memory;
Forever<UartLink> link_memory;
Forever<Service> service_memory;

ServiceOptions options_of_the_board() {
  ServiceOptions options;
  options.wiring = {{{"X"}, {"Y"}}, {"T"}};
  PublicKey key;
  copy(key.data(), reinterpret_cast<const std::uint8_t*>(kFactoryKey), kPublicKeyBytes);
  options.upload.identity = key;
  options.upload.places = Programs::kFewest;
  options.upload.dense_cells = 128;
  options.upload.trial_time = TimeUs(std::int64_t{3'600'000'000});  // ticks run faster than time here
  options.activate = true;
  options.ticks_kept = 64;
  options.touches_kept = 8;
  return options;
}

void say(const char* name, std::uint32_t value) {
  bench::print(name);
  bench::print(" ");
  bench::print_hex(value);
  bench::print("\n");
}

// ---- stack: painted, so that its deepest mark can be read

constexpr std::uint32_t kPaint = 0x5afe57ac;
constexpr std::uint32_t kPaintedWords = 8192;
std::uint32_t* stack_bottom() { return reinterpret_cast<std::uint32_t*>(0x20400000) - kPaintedWords; }
void paint_stack() {
  std::uint32_t now = 0;
  asm volatile("mov %0, sp" : "=r"(now));
  for (auto word = reinterpret_cast<std::uintptr_t>(stack_bottom()); word < now - 64; word += 4)
    at(static_cast<std::uint32_t>(word)) = kPaint;
}
std::uint32_t deepest_stack() {
  std::uint32_t untouched = 0;
  while (untouched < kPaintedWords && stack_bottom()[untouched] == kPaint) ++untouched;
  return (kPaintedWords - untouched) * 4;
}

struct Spent {
  std::uint64_t total = 0;
  std::uint32_t worst = 0;
};

// SysTick counts down, 25.6 counts an instruction at -icount shift=10.
void measured_tick(Service& service, Spent& spent) {
  const std::uint32_t before = bench::systick();
  service.tick();
  const std::uint32_t now = (before - bench::systick()) & 0xffffff;
  spent.total += now;
  if (now > spent.worst) spent.worst = now;
}

}  // namespace

void* operator new(std::size_t bytes) { return take_memory(bytes); }
void* operator new[](std::size_t bytes) { return take_memory(bytes); }
void operator delete(void*) noexcept {}
void operator delete[](void*) noexcept {}
void operator delete(void*, std::size_t) noexcept {}
void operator delete[](void*, std::size_t) noexcept {}

int main() {
  paint_stack();
  TickClock& clock = clock_memory.make();
  Machine& machine = machine_memory.make();
  RamStore& store = store_memory.make();
  UartLink& link = link_memory.make();
  const Board board{clock, machine, machine, machine};
  Service& service = service_memory.make(options_of_the_board(), board, store);
  service.boot();
  sealed = true;
  bench::print("ready\n");

  bench::start_systick();
  Spent idle;
  std::uint32_t taken_at = 0, begun_at = 0;  // ticks before the program was taken over, before it is measured
  while (service.cycle().mode() != Mode::kActive || service.uploader().slots().confirmed() == kNoSlot) {
    service.serve(link, TimeUs(0));
    measured_tick(service, idle);
    if (service.cycle().health().programs == 0) ++taken_at;
    ++begun_at;
  }
  Spent active;
  std::uint64_t hash = kFnvSeed;
  for (std::uint32_t i = 0; i < kTicks; ++i) {
    service.serve(link, TimeUs(0));
    measured_tick(service, active);
    hash = machine.mixed(hash);
  }
  const Health& health = service.cycle().health();
  say("ticks", kTicks);
  say("active_ticks", static_cast<std::uint32_t>(health.active_ticks));
  say("faults", static_cast<std::uint32_t>(health.faults));
  say("systick_total_high", static_cast<std::uint32_t>(active.total >> 32));
  say("systick_total_low", static_cast<std::uint32_t>(active.total));
  say("systick_worst", active.worst);
  say("position_x", static_cast<std::uint32_t>(machine.position(0)));
  say("correction_x", static_cast<std::uint32_t>(machine.written(0)));
  say("position_y", static_cast<std::uint32_t>(machine.position(1)));
  say("correction_y", static_cast<std::uint32_t>(machine.written(1)));
  say("hash_high", static_cast<std::uint32_t>(hash >> 32));
  say("hash_low", static_cast<std::uint32_t>(hash));
  say("taken_at", taken_at);
  say("begun_at", begun_at);
  say("arena", static_cast<std::uint32_t>(arena_used));
  say("late_requests", late_requests);
  say("stack", deepest_stack());
  say("sizeof_service", sizeof(Service));
  say("sizeof_cycle", sizeof(Cycle));
  say("sizeof_exchange", sizeof(Exchange));
  say("sizeof_program", sizeof(LoadedProgram));
  bench::leave(health.faults == 0 && late_requests == 0 ? 0 : 1);
}
