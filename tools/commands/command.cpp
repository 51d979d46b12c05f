// SPDX-License-Identifier: GPL-3.0-or-later
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string_view>

#include "tools/commands/command.h"
#include "tools/safety/safety_sheet.h"
#include "tools/text/error.h"

namespace vernier::commands {
namespace {

/// Progress is shown from this moment on, and at most so often.
constexpr double kShowAfterS = 1.0, kShowEveryS = 0.2;

/// True if a program reads the progress (VERNIER_PROGRESS=lines). Then every step is printed as a line
/// immediately.
bool wants_lines() {
  const char* const how = std::getenv("VERNIER_PROGRESS");
  return how != nullptr && std::string_view(how) == "lines";
}

double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Keys under which tools/docs/formats.md promises a figure: one that is not finite is our bug, no answer.
constexpr std::array kFigures = {"rms_before_um",
                                 "rms_um",
                                 "check_rms_um",
                                 "max_um",
                                 "check_max_um",
                                 "noise_um",
                                 "value",
                                 "std",
                                 "evidence",
                                 "p_value",
                                 "share",
                                 "change",
                                 "limit",
                                 "rms_after_um",
                                 "interval_um",
                                 "deviation_um",
                                 "std_um",
                                 "reduction",
                                 "interval",
                                 "before_um",
                                 "after_um",
                                 "bound_um",
                                 "total_um",
                                 "mean_um",
                                 "probability",
                                 "max_after_um",
                                 "check_rms_before_um",
                                 "check_rms_after_um",
                                 "rms_urad",
                                 "check_rms_urad",
                                 "noise_urad",
                                 "rms_after_urad",
                                 "check_rms_after_urad"};

/// Throws std::logic_error naming the key. The library writes numbers that are not finite as null.
void require_figures(const nlohmann::ordered_json& json, bool figure, const std::string& name) {
  if (json.is_number_float() && figure && !std::isfinite(json.get<double>()))
    throw std::logic_error("the figure \"" + name + "\" is not finite");
  if (json.is_object())
    for (const auto& [key, value] : json.items())
      require_figures(
          value, std::find(kFigures.begin(), kFigures.end(), std::string_view(key)) != kFigures.end(), key);
  else if (json.is_array())
    for (const auto& value : json) require_figures(value, figure, name);
}

}  // namespace

void write_json(const std::string& path, const nlohmann::ordered_json& result) {
  if (path.empty()) return;
  require_figures(result, false, "");
  const std::string text =
      result.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
  if (path != "-") return text::write_file(path, text);
  if (std::fputs(text.c_str(), stdout) == EOF || std::fflush(stdout) != 0)
    throw text::InputError({"standard output", 0}, "",
                           std::string("cannot be written: ") + std::strerror(errno));
}

std::FILE* human_stream(const std::string& json_path) { return json_path == "-" ? stderr : stdout; }

Progress::Progress(std::string what) : what_(std::move(what)), started_s_(now_s()) {}

Progress::~Progress() {
  if (shown_ && isatty(STDERR_FILENO) != 0) std::fputs("\r\033[K", stderr);
}

void Progress::update(double fraction, const std::string& step) {
  const double now = now_s();
  const bool lines = wants_lines();
  if ((!lines && now - started_s_ < kShowAfterS) || now - last_s_ < kShowEveryS) return;
  const bool terminal = isatty(STDERR_FILENO) != 0;
  if (!terminal && !lines && shown_ && now - last_s_ < 10)
    return;  // a log wants a line now and then, not a film
  last_s_ = now;
  shown_ = true;
  std::fprintf(stderr, terminal ? "\r\033[K%s: %3.0f %% %s" : "%s: %3.0f %% %s\n", what_.c_str(),
               100 * fraction, step.c_str());
  std::fflush(stderr);
}

CLI::Validator rule_words() {
  return {[](std::string&) { return std::string(); }, "{" + safety::rule_names(",") + "}"};
}

}  // namespace vernier::commands
