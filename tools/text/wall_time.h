// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <optional>
#include <string>

namespace vernier::text {

/// now_us: microseconds since 1970 UTC by the clock of this computer; now_ms: milliseconds.
std::int64_t now_us();
std::int64_t now_ms();

inline constexpr double kUsADay = 86'400e6;

/// "2026-11-23T13:05:53Z" of a time in us since 1970.
std::string utc_text(std::int64_t time_us);
/// parse_utc converts such a text to us; "2026-11-23" is midnight, the Z may be missing. `nullopt` if the
/// text is not a time, or if the calendar has no such day (2026-02-30).
std::optional<std::int64_t> parse_utc(const std::string& text);

}  // namespace vernier::text
