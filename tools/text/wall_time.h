// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <optional>
#include <string>

namespace vernier::text {

/// now_us returns the time in microseconds since 1970 UTC by the clock of this computer; now_ms returns it in
/// milliseconds.
std::int64_t now_us();
std::int64_t now_ms();

inline constexpr double kUsADay = 86'400e6;

/// Returns a time (us since 1970) as text: "2026-11-23T13:05:53Z".
std::string utc_text(std::int64_t time_us);
/// parse_utc converts a text with a UTC time to us since 1970. "2026-11-23" means midnight; the Z may be
/// missing. The function parse_utc() returns nullopt if the text is not a time, or if the calendar does not
/// have this day (2026-02-30).
std::optional<std::int64_t> parse_utc(const std::string& text);

}  // namespace vernier::text
