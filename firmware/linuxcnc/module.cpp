// SPDX-License-Identifier: GPL-3.0-or-later
// vernier.so: what rtapi_app loads. With component.cpp the composition root of the component.
#include "firmware/linuxcnc/module.h"

#include <hal.h>
#include <rtapi.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <new>

#include "firmware/linuxcnc/component.h"
#include "firmware/linuxcnc/load_arguments.h"

// Arguments of `loadrt vernier`: filled in by rtapi_app, which finds them by the names that the macros make.
static char* axes[vernier::kMaxAxes];
RTAPI_MP_ARRAY_STRING(axes, 8, "names of the machine's axes, in the order of the joints from joint 0 on")
static char* inputs[vernier::kMaxInputs];
RTAPI_MP_ARRAY_STRING(inputs, 24, "names of the measured inputs; each input has a pin")
static char* rotary[vernier::kMaxAxes];
RTAPI_MP_ARRAY_STRING(rotary, 8,
                      "names of the rotary axes (default: A, B and C; none: the machine has no rotary axis)")
static char* units;
RTAPI_MP_STRING(units, "of lengths, as [TRAJ]LINEAR_UNITS: mm (default) or inch")
MODULE_LICENSE("GPL");
MODULE_DESCRIPTION("Correction of a machine's geometric errors in the servo thread");

namespace {

using namespace vernier;

static_assert(kMaxAxes == 8 && kMaxInputs == 24);

int component_id = -1, memory_id = -1;
Component* component = nullptr;

void say(int level, const char* text) { rtapi_print_msg(static_cast<msg_level_t>(level), "%s", text); }

void run(void*, long period_ns) { component->tick(period_ns); }

Hatch* open_hatch() {
  memory_id = rtapi_shmem_new(Hatch::kKey, component_id, sizeof(Hatch));
  void* memory = nullptr;
  if (memory_id < 0 || rtapi_shmem_getptr(memory_id, &memory) < 0) return nullptr;
  auto* const hatch = new (memory) Hatch;
  hatch->component = ::getpid();
  return hatch;
}

// The memory goes while HAL still knows the component, then its function out of the threads; a tick that is
// under way ends long before the component goes.
int leave(int result) {
  constexpr unsigned kLongestTick_us = 50'000;
  if (component != nullptr) component->stop();
  if (memory_id >= 0) rtapi_shmem_delete(memory_id, component_id);
  if (component_id >= 0) hal_exit(component_id);
  memory_id = component_id = -1;
  if (component != nullptr) ::usleep(kLongestTick_us);
  delete component;
  component = nullptr;
  return result;
}

int enter() {
  LoadedWiring loaded;
  char why[120], text[140];
  if (!read_load_arguments({axes, inputs, rotary, units}, loaded, why)) {
    std::snprintf(text, sizeof(text), "vernier: %s\n", why);
    say(RTAPI_MSG_ERR, text);
    return -EINVAL;
  }
  component_id = hal_init("vernier");
  if (component_id < 0) return component_id;
  Hatch* const hatch = open_hatch();
  if (hatch == nullptr) {
    say(RTAPI_MSG_ERR, "vernier: the memory that is shared with vernier-hal cannot be made\n");
    return leave(-ENOMEM);
  }
  const Pins* const pins = make_pins(component_id, loaded.wiring);
  if (pins == nullptr) return leave(-EINVAL);
  component = new Component(*pins, *hatch, loaded.wiring, loaded.mm_per_unit, say);
  if (!component->start()) return leave(-EAGAIN);
  // It computes in floating point, and there is one of it.
  if (const int result = hal_export_funct("vernier.0", run, nullptr, 1, 0, component_id); result < 0)
    return leave(result);
  hatch->magic.store(Hatch::kMagic);
  return hal_ready(component_id);
}

}  // namespace

int rtapi_app_main() { return enter(); }
void rtapi_app_exit() { leave(0); }
