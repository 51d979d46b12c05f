// SPDX-License-Identifier: Apache-2.0
#include "hal/linux/counter_axis.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>

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

/// Time in which the axis passes half the range of the counter at its largest speed, ns.
double time_of_half(std::int64_t range, const PositionScale& scale, const CounterAxis::Speed& speed) {
  const double travel =
      0.5 * static_cast<double>(range) * static_cast<double>(scale.span) / static_cast<double>(scale.counts);
  return travel / static_cast<double>(std::max<std::int64_t>(speed.most_per_tick, 1)) * 1e3 *
         static_cast<double>(speed.tick.count);
}

}  // namespace

std::unique_ptr<CounterAxis> CounterAxis::open(const std::string& count, int bits, const PositionScale& scale,
                                               const Speed& speed, Clock& clock, std::string& error) {
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
  const double half_ns = time_of_half(range, scale, speed);
  const double needed_ns =
      (static_cast<double>(speed.missing_ticks) + 1) * 1e3 * static_cast<double>(speed.tick.count);
  if (half_ns <= needed_ns) {
    char text[200];
    std::snprintf(text, sizeof text,
                  "the counter has too few bits: at max_speed the axis passes half the range of the counter "
                  "in %.3g ms, and a reading may be %.3g ms old (missing_ticks)",
                  half_ns * 1e-6, needed_ns * 1e-6);
    return error = text, nullptr;
  }
  const InstantNs longest(static_cast<std::int64_t>(std::min(half_ns, 1e18)));
  std::unique_ptr<CounterAxis> axis(new CounterAxis(std::move(*attribute), range, scale, longest, clock));
  std::error_code failed;
  axis->place_ = std::filesystem::canonical(count, failed).string();
  return axis;
}

void CounterAxis::begin_tick() noexcept {
  std::int64_t count = 0;
  fresh_ = count_.read(count) == HalFault::kNone && wrapped_.take(count);
  if (!fresh_) return;
  const InstantNs now = clock_.now();
  lost_ = lost_ || (known_ && now.count - read_at_.count >= longest_.count);
  known_ = true;
  read_at_ = now;
}

HalFault CounterAxis::read_axis(std::uint32_t index, AxisReading& reading) noexcept {
  if (index != 0) return HalFault::kNoDevice;
  if (!fresh_) return HalFault::kNoReading;
  reading = {};
  reading.position = converter_.position_of(wrapped_.position());
  reading.referenced = !lost_;
  return HalFault::kNone;
}

}  // namespace vernier
