// SPDX-License-Identifier: GPL-3.0-or-later
// vernier-hal: the composition root of the component's helper, which keeps its images and serves its link.
#include <hal.h>
#include <rtapi.h>
#include <sys/random.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "firmware/daemon/image_file.h"
#include "firmware/daemon/settings/key_file.h"
#include "firmware/linuxcnc/hatch_link.h"
#include "firmware/linuxcnc/helper_arguments.h"
#include "firmware/linuxcnc/store_server.h"
#include "hal/linux/file_lock.h"
#include "hal/linux/file_slot_store.h"
#include "hal/linux/modbus/modbus_server.h"

namespace {

using namespace vernier;

constexpr int kDone = 0, kBadInput = 1, kAnswerIsNo = 2;
constexpr std::uint32_t kSlotBytes = 1u << 20;  // as a daemon's without slot_bytes
constexpr TimeUs kWait(20'000), kLookAround(200'000);

std::atomic<bool> stop_asked{false};
static_assert(std::atomic<bool>::is_always_lock_free);

/// This process as HAL knows it.
class HalMember {
 public:
  // One that was killed has left its name behind, which HAL keeps until it ends itself.
  HalMember() : id_(hal_init("vernier-hal")) {
    if (id_ < 0) id_ = hal_init(("vernier-hal." + std::to_string(::getpid())).c_str());
  }
  ~HalMember() {
    if (memory_ >= 0) rtapi_shmem_delete(memory_, id_);
    if (id_ >= 0) hal_exit(id_);
  }
  HalMember(const HalMember&) = delete;
  HalMember& operator=(const HalMember&) = delete;
  bool good() const { return id_ >= 0; }
  void ready() { hal_ready(id_); }
  /// The component's memory; null if it is not loaded.
  Hatch* hatch() {
    memory_ = rtapi_shmem_new(Hatch::kKey, id_, sizeof(Hatch));
    void* memory = nullptr;
    if (memory_ < 0 || rtapi_shmem_getptr(memory_, &memory) < 0) return nullptr;
    auto* const hatch = static_cast<Hatch*>(memory);
    return hatch->magic.load() == Hatch::kMagic && process_lives(hatch->component) ? hatch : nullptr;
  }

 private:
  int id_, memory_ = -1;
};

int refuse(const char* what, const std::string& why) {
  std::fprintf(stderr, "vernier-hal: %s: %s\n", what, why.c_str());
  return kBadInput;
}

/// The settings that are sent to the component; throws BoardError.
Introduction introduction_of(const HelperArguments& arguments, std::size_t given_bytes) {
  Introduction introduction;
  introduction.pid = ::getpid();
  introduction.capacity = kSlotBytes;
  introduction.given_bytes = static_cast<std::uint32_t>(given_bytes);
  for (const std::string& path : arguments.public_keys) {
    if (introduction.keys == BoardIdentity::kMostKeys)
      throw BoardError{"--public-key is given more than eight times; a board has at most eight public keys"};
    introduction.key[introduction.keys++] = read_public_key(path);
  }
  introduction.board = Name(arguments.board);
  introduction.board_class = Name(arguments.board_class);
  const auto fill = [](auto& bytes) {
    return ::getrandom(bytes.data(), bytes.size(), 0) == static_cast<ssize_t>(bytes.size());
  };
  if (!fill(introduction.nonce) || !fill(introduction.seed))
    throw BoardError{"the system gives no random numbers: signed requests are not possible"};
  const std::string store = std::filesystem::canonical(arguments.store).string();
  if (store.size() >= sizeof(introduction.store)) throw BoardError{store + ": the path is too long"};
  std::copy(store.begin(), store.end(), introduction.store);
  return introduction;
}

/// False if it has ended. The component answers when its thread runs.
bool introduce(Hatch& hatch, const Introduction& introduction) {
  Call& call = hatch.attach;
  std::memcpy(call.bytes, static_cast<const void*>(&introduction), sizeof(introduction));
  if (!make_call(call, hatch.component, stop_asked)) return false;
  call.bytes[Call::kMostBytes - 1] = 0;
  const char* const text = reinterpret_cast<const char*>(call.bytes);
  switch (static_cast<Attached>(call.result)) {
    case Attached::kStarted:
      std::fputs("vernier-hal: the component has received its image\n", stderr);
      return true;
    case Attached::kEmpty:
      std::fputs(
          "vernier-hal: the store has no image: the component corrects nothing until an image is uploaded or "
          "given with --image\n",
          stderr);
      return true;
    case Attached::kResumed:
      std::fputs("vernier-hal: the component continues with its running image\n", stderr);
      return true;
    case Attached::kImageRefused:
      std::fprintf(stderr, "vernier-hal: the image is not used: %s\n", text);
      return true;
    case Attached::kOtherStore:
      std::fputs(
          "vernier-hal: the component was started with another store, keys or board name: restart LinuxCNC"
          "\n",
          stderr);
  }
  return false;
}

int serve(const HelperArguments& arguments, const Introduction& introduction, Hatch& hatch,
          const std::vector<std::uint8_t>& given, ModbusServer* link) {
  FileSlotStore slots(arguments.store, kSlotBytes);
  StoreServer store(hatch.store, slots, given);
  std::thread store_thread([&] {
    while (!stop_asked) store.serve(kWait);
  });
  int result = introduce(hatch, introduction) ? kDone : kAnswerIsNo;
  if (stop_asked) result = kDone;
  HatchHandler handler(hatch, arguments.access, stop_asked);
  while (!stop_asked && result == kDone && hatch.magic.load() == Hatch::kMagic &&
         process_lives(hatch.component)) {
    if (link != nullptr)
      link->serve(handler, kLookAround);
    else
      std::this_thread::sleep_for(std::chrono::microseconds(kLookAround.count));
  }
  stop_asked = true;
  store_thread.join();
  return result;
}

int run(const HelperArguments& arguments) {
  std::error_code failed;
  std::filesystem::create_directories(arguments.store, failed);
  if (failed) return refuse(arguments.store.c_str(), failed.message());
  FileLock lock;
  if (const std::string missing = lock.take(arguments.store); !missing.empty())
    return refuse(arguments.store.c_str(), missing);
  std::vector<std::uint8_t> given;
  if (!arguments.image.empty() && (!read_bytes(arguments.image + "/machine.vimg", given) || given.empty()))
    return refuse((arguments.image + "/machine.vimg").c_str(), "cannot be read");
  std::unique_ptr<ModbusServer> link;
  if (!arguments.address.empty()) {
    std::string error;
    link = ModbusServer::tcp(arguments.address, arguments.port,
                             {kMailboxRegister, kMailboxRegisters, kLiveRegisters}, error);
    if (!link) return refuse("--listen", error);
  }
  const Introduction introduction = introduction_of(arguments, given.size());
  HalMember hal;
  if (!hal.good()) return refuse("HAL", "is not running");
  Hatch* const hatch = hal.hatch();
  if (hatch == nullptr) {
    std::fputs("vernier-hal: the component is not loaded: first run loadrt vernier axes=...\n", stderr);
    return kAnswerIsNo;
  }
  if (process_lives(hatch->helper.load())) return refuse("HAL", "has a vernier-hal already");
  hal.ready();
  return serve(arguments, introduction, *hatch, given, link.get());
}

}  // namespace

int main(int argc, char** argv) {
  HelperArguments arguments;
  if (!parse_helper_arguments(argc, argv, arguments)) {
    std::fputs(kHelperUsage, stderr);
    return kBadInput;
  }
  if (arguments.help || arguments.version) {
    std::fputs(arguments.help ? kHelperUsage : kHelperVersion, stdout);
    return kDone;
  }
  // A medium or a peer that refuses bytes is reported by the call; the signal would end the program.
  std::signal(SIGXFSZ, SIG_IGN);
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGTERM, [](int) { stop_asked = true; });
  std::signal(SIGINT, [](int) { stop_asked = true; });
  try {
    return run(arguments);
  } catch (const BoardError& error) {
    return refuse("not started", error.what);
  }
}
