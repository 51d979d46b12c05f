// SPDX-License-Identifier: Apache-2.0
#include "firmware/daemon/calibrate_output.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <istream>
#include <ostream>
#include <string>

#include "firmware/daemon/settings/board_file.h"

namespace vernier {
namespace {

constexpr TimeUs kStep(10'000);
constexpr std::int64_t kStepsOfRange = 500;  // 5 s

/// Moves the output code by code, never faster than its range in five seconds.
class Mover {
 public:
  Mover(CorrectionWriter& output, const AnalogueScale& scale, std::int64_t start, Clock& clock)
      : output_(output), scale_(scale), clock_(clock), code_(start) {}

  bool move_to(std::int64_t code) {
    const std::int64_t most = (scale_.high - scale_.low) / kStepsOfRange + 1;
    do {
      code_ += std::clamp(code - code_, -most, most);
      if (output_.write_correction(0, scale_.correction_of(code_)) != HalFault::kNone) return false;
      if (code_ != code) clock_.sleep_until(clock_.now() + instant_ns(kStep));
    } while (code_ != code);
    return true;
  }

 private:
  CorrectionWriter& output_;
  const AnalogueScale& scale_;
  Clock& clock_;
  std::int64_t code_;
};

bool ask(std::istream& answers, std::ostream& questions, std::int64_t code, double& measured) {
  for (std::string line;;) {
    questions << "code " << code << ": measured? " << std::flush;
    if (!std::getline(answers, line) || line == "q") return false;
    char* end = nullptr;
    measured = std::strtod(line.c_str(), &end);
    if (end != line.c_str() && *end == '\0' && std::isfinite(measured)) return true;
    questions << "enter a number, or q to end without a result\n";
  }
}

}  // namespace

std::vector<CalibrationPoint> calibrate_output(CorrectionWriter& output, const AnalogueScale& scale,
                                               std::int64_t start, int steps, Clock& clock,
                                               std::istream& answers, std::ostream& questions,
                                               const std::atomic<bool>& stop) {
  Mover mover(output, scale, start, clock);
  std::vector<CalibrationPoint> points;
  bool good = mover.move_to(scale.zero);
  for (int i = 0; good && i < 2 * steps - 1 && !stop; ++i) {
    const std::int64_t step = i < steps ? i : 2 * (steps - 1) - i;
    const std::int64_t code = scale.low + (scale.high - scale.low) * step / (steps - 1);
    good = mover.move_to(code);
    double measured = 0;
    if (!good || !ask(answers, questions, code, measured)) break;
    points.push_back({code, measured});
  }
  if (!mover.move_to(scale.zero) || !good)
    throw BoardError{"calibration: the output refuses a code; test the driver and the range of the output"};
  return points;
}

}  // namespace vernier
