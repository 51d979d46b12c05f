// SPDX-License-Identifier: Apache-2.0
#include "hal/linux/counter_axis.h"

#include <unistd.h>

namespace vernier {
namespace {

constexpr std::int64_t kMostRange = std::int64_t{1} << 40;

bool exists(const std::string& path) { return ::access(path.c_str(), F_OK) == 0; }

/// Number of different counts: from `bits`, or from the largest count that the driver states. 0: not known.
std::int64_t range_of(const std::string& count, int bits, std::string& error) {
  if (bits > 0) return std::int64_t{1} << bits;
  const std::string path = count + "/ceiling";
  if (!exists(path)) return error = path + " does not exist; give the width of the counter: bits = 32", 0;
  auto ceiling = SysfsAttribute::open(path, SysfsAttribute::Use::kRead, error);
  std::int64_t last = 0;
  if (!ceiling) return 0;
  if (ceiling->read(last) == HalFault::kNone && last >= 1 && last < kMostRange) return last + 1;
  return error = path + " is not between 1 and 2^40; give the width of the counter: bits = 32", 0;
}

}  // namespace

std::unique_ptr<CounterAxis> CounterAxis::open(const std::string& count, int bits, const PositionScale& scale,
                                               std::string& error) {
  auto attribute = SysfsAttribute::open(count + "/count", SysfsAttribute::Use::kRead, error);
  if (!attribute) return nullptr;
  const std::int64_t range = range_of(count, bits, error);
  if (range == 0) return nullptr;
  if (exists(count + "/enable")) {
    auto enable = SysfsAttribute::open(count + "/enable", SysfsAttribute::Use::kRead, error);
    std::int64_t on = 0;
    if (!enable) return nullptr;
    if (enable->read(on) != HalFault::kNone || on != 1)
      return error = "the counter does not count: write 1 to " + count + "/enable", nullptr;
  }
  return std::unique_ptr<CounterAxis>(new CounterAxis(std::move(*attribute), range, scale));
}

void CounterAxis::begin_tick() noexcept {
  std::int64_t count = 0;
  fresh_ = count_.read(count) == HalFault::kNone && wrapped_.take(count);
}

HalFault CounterAxis::read_axis(std::uint32_t index, AxisReading& reading) noexcept {
  if (index != 0) return HalFault::kNoDevice;
  if (!fresh_) return HalFault::kNoReading;
  reading = {};
  reading.position = converter_.position_of(wrapped_.position());
  return HalFault::kNone;
}

}  // namespace vernier
