// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/text/wall_time.h"

#include <fmt/format.h>

#include <chrono>
#include <ctime>

namespace vernier::text {
namespace {

template <typename Unit>
std::int64_t now() {
  return std::chrono::duration_cast<Unit>(std::chrono::system_clock::now().time_since_epoch()).count();
}

}  // namespace

std::int64_t now_us() { return now<std::chrono::microseconds>(); }
std::int64_t now_ms() { return now<std::chrono::milliseconds>(); }

std::string utc_text(std::int64_t time_us) {
  const std::time_t seconds = time_us / 1'000'000;
  std::tm parts{};
  gmtime_r(&seconds, &parts);
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}Z", parts.tm_year + 1900, parts.tm_mon + 1,
                     parts.tm_mday, parts.tm_hour, parts.tm_min, parts.tm_sec);
}

std::optional<std::int64_t> parse_utc(const std::string& text) {
  for (const char* form : {"%Y-%m-%dT%H:%M:%SZ", "%Y-%m-%dT%H:%M:%S", "%Y-%m-%dT%H:%M", "%Y-%m-%d"}) {
    std::tm parts{};
    const char* const end = strptime(text.c_str(), form, &parts);
    if (end == nullptr || *end != '\0') continue;
    const int day = parts.tm_mday;
    const std::time_t seconds = timegm(&parts);  // moves a day beyond the end of its month to the next month
    if (parts.tm_mday != day) return {};
    return std::int64_t{seconds} * 1'000'000;
  }
  return {};
}

}  // namespace vernier::text
