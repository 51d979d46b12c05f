// SPDX-License-Identifier: GPL-3.0-or-later
// usage: module_bench MODULE.so CALLS [IMAGE AXES INPUTS]
// Calls the function of a realtime module as HAL's thread does, its float inputs walking from call to call;
// HAL itself is a stand-in. With an image the module is vernier.so, and the calls begin when the whole
// correction is in. `bench_counted` is what callgrind counts.
#include <dlfcn.h>
#include <hal.h>
#include <rtapi.h>
#include <unistd.h>

#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include "firmware/linuxcnc/store_server.h"
#include "hal/sim/sim_slot_store.h"

namespace {

using namespace vernier;

union Value {
  double number;
  std::uint64_t word;
};
std::map<std::string, Value*> pins;
std::vector<Value*> inputs;  // float pins that are read
void (*function)(void*, long) = nullptr;
void* function_argument = nullptr;
alignas(64) unsigned char shared[sizeof(Hatch)];

int add_pin(hal_pin_dir_t direction, void* at, bool number, const char* format, va_list words) {
  char name[128];
  std::vsnprintf(name, sizeof(name), format, words);
  auto* const value = new Value{};
  *static_cast<void**>(at) = value;
  pins[name] = value;
  if (number && direction == HAL_IN) inputs.push_back(value);
  return 0;
}

}  // namespace

// What modules want of HAL.
extern "C" {
int hal_init(const char*) { return 1; }
int hal_exit(int) { return 0; }
int hal_ready(int) { return 0; }
void* hal_malloc(long size) { return std::calloc(1, static_cast<std::size_t>(size)); }
#define PIN(type, ctype, number)                                                                 \
  int hal_pin_##type##_newf(hal_pin_dir_t direction, ctype** at, int, const char* format, ...) { \
    va_list words;                                                                               \
    va_start(words, format);                                                                     \
    const int result = add_pin(direction, at, number, format, words);                            \
    va_end(words);                                                                               \
    return result;                                                                               \
  }
PIN(bit, hal_bit_t, false)
PIN(float, hal_float_t, true)
PIN(s32, hal_s32_t, false)
PIN(u32, hal_u32_t, false)
int hal_param_float_newf(hal_param_dir_t, hal_float_t* at, int, const char*, ...) { return *at = 0, 0; }
int hal_param_bit_newf(hal_param_dir_t, hal_bit_t* at, int, const char*, ...) { return *at = false, 0; }
int hal_export_funct(const char*, void (*run)(void*, long), void* argument, int, int, int) {
  function = run;
  function_argument = argument;
  return 0;
}
void rtapi_print_msg(msg_level_t, const char* format, ...) {
  va_list words;
  va_start(words, format);
  std::vfprintf(stderr, format, words);
  va_end(words);
}
int rtapi_snprintf(char* text, unsigned long size, const char* format, ...) {
  va_list words;
  va_start(words, format);
  const int result = std::vsnprintf(text, size, format, words);
  va_end(words);
  return result;
}
int rtapi_shmem_new(int, int, unsigned long) { return 1; }
int rtapi_shmem_getptr(int, void** memory) { return *memory = shared, 0; }
int rtapi_shmem_delete(int, int) { return 0; }

__attribute__((noinline)) void bench_counted() { function(function_argument, 1'000'000); }
}

namespace {

void set_words(void* module, const char* name, std::vector<std::string>& words) {
  void* const at = dlsym(module, (std::string("rtapi_info_address_") + name).c_str());
  if (at == nullptr) return;
  char** const list = *static_cast<char***>(at);
  for (std::size_t i = 0; i < words.size(); ++i) list[i] = words[i].data();
}

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> words;
  for (std::size_t from = 0; from < text.size();) {
    const std::size_t end = std::min(text.find(',', from), text.size());
    words.push_back(text.substr(from, end - from));
    from = end + 1;
  }
  return words;
}

/// Every joint on its own sine through 100 mm, as at F6000.
void walk(int call) {
  for (std::size_t i = 0; i < inputs.size(); ++i)
    inputs[i]->number = 150 + 100 * std::sin(1e-3 * call + static_cast<double>(i));
}

bool bring_in(const std::string& path, std::vector<std::string>& sensors) {
  std::ifstream file(path, std::ios::binary);
  const std::vector<std::uint8_t> image{std::istreambuf_iterator<char>(file), {}};
  auto* const hatch = reinterpret_cast<Hatch*>(shared);
  SimSlotStore slots(1 << 20);
  StoreServer server(hatch->store, slots, image);
  std::atomic<bool> stop{false}, started{false};
  std::thread helper([&] {
    while (!stop) server.serve(TimeUs(1'000));
  });
  std::thread attach([&] {
    Introduction introduction;
    introduction.pid = ::getpid();
    introduction.capacity = 1 << 20;
    introduction.given_bytes = static_cast<std::uint32_t>(image.size());
    std::memcpy(hatch->attach.bytes, static_cast<void*>(&introduction), sizeof(introduction));
    started = make_call(hatch->attach, ::getpid(), stop) && hatch->attach.result == 0;
    if (!started) std::fprintf(stderr, "%s\n", reinterpret_cast<const char*>(hatch->attach.bytes));
  });
  inputs.clear();
  for (const auto& [name, value] : pins)
    if (name.ends_with(".cmd-in")) inputs.push_back(value);
  for (std::string& sensor : sensors) pins["vernier.0.input." + sensor]->number = 22;
  *reinterpret_cast<hal_bit_t*>(pins["vernier.0.enable"]) = true;
  const auto* const active = reinterpret_cast<hal_bit_t*>(pins["vernier.0.active"]);
  for (int call = 0; call < 200'000 && !*active; ++call) {
    walk(call);
    function(function_argument, 1'000'000);
    if (!started) ::usleep(500);
  }
  stop = true;
  helper.join();
  attach.join();
  return *active;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3 && argc != 6) return 1;
  void* const module = dlopen(argv[1], RTLD_NOW | RTLD_GLOBAL);
  if (module == nullptr) return std::fprintf(stderr, "%s\n", dlerror()), 1;
  std::vector<std::string> axes = split(argc == 6 ? argv[4] : ""), sensors = split(argc == 6 ? argv[5] : "");
  set_words(module, "axes", axes);
  set_words(module, "inputs", sensors);
  const auto enter = reinterpret_cast<int (*)()>(dlsym(module, "rtapi_app_main"));
  if (enter == nullptr || enter() != 0 || function == nullptr) return 1;
  if (argc == 6 && !bring_in(argv[3], sensors))
    return std::fputs("the correction has not come in\n", stderr), 1;
  for (int call = 0; call < std::atoi(argv[2]); ++call) {
    walk(call);
    bench_counted();
  }
  reinterpret_cast<void (*)()>(dlsym(module, "rtapi_app_exit"))();
  return 0;
}
