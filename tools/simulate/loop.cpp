// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulate/loop.h"

#include <algorithm>
#include <chrono>
#include <memory>

#include "firmware/core/runner.h"
#include "hal/sim/analogue_chain.h"
#include "hal/sim/plant.h"
#include "hal/sim/sim_clock.h"
#include "tools/simulate/counts.h"
#include "tools/text/error.h"

namespace vernier {
namespace {

/// Half an hour at 1 kHz: a correction that takes longer to come in has a slew limit that is a mistake.
constexpr std::size_t kMostPreRoll = 1'800'000;

/// The path as the controller of the simulated machine knows it.
class PathTrajectory : public Trajectory {
 public:
  PathTrajectory(const Machine& machine, const States& states) : machine_(machine), states_(states) {}

  void at(std::int64_t tick, PlantState& state) noexcept override {
    const Eigen::Index k = std::clamp<Eigen::Index>(tick, 0, static_cast<Eigen::Index>(states_.count) - 1);
    for (std::size_t i = 0; i < machine_.axes.size(); ++i) {
      const double scale = machine_.axes[i].rotary ? kCountsPerDeg : kCountsPerMm;
      AxisReading& axis = state.axis[i];
      axis.position = AxisPosition(counts(scale * states_.axis[i][k]));
      axis.velocity = AxisSpeed(counts(scale * states_.velocity[i][k]));
      axis.acceleration = AxisAcceleration(counts(scale * states_.acceleration[i][k]));
      axis.since = states_.since[i][k] >= kLongWay ? AxisTravel(INT64_MAX)
                                                   : AxisTravel(counts(scale * states_.since[i][k]));
      axis.sense = static_cast<std::int8_t>(states_.direction[i][k]);
    }
    for (std::size_t i = 0; i < machine_.inputs.size(); ++i)
      state.input[i] = InputMicro(counts(1e6 * states_.input[i][k]));
    state.path.feed = FeedNmPerMin(counts(1e6 * states_.feed[k]));
    state.path.tells_feed = true;
    state.path.curvature = CurvatureNanoPerMm(counts(1e9 * states_.curvature[k]));
    state.path.visit = VisitCount(counts(states_.visit[k]));
  }

 private:
  const Machine& machine_;
  const States& states_;
};

CycleLimits limits_off() {
  constexpr std::int64_t kNever = std::int64_t{1} << 50;
  CycleLimits limits;
  limits.linear.step = limits.rotary.step = kNever;
  limits.linear.frozen_travel = limits.rotary.frozen_travel = kNever;
  return limits;
}

PlantOptions plant_options(const LoopOptions& options) {
  PlantOptions plant;
  plant.seed = options.seed;
  plant.run_in = true;
  plant.delay_ticks = options.delay_ticks;
  plant.position_noise_counts = 1e3 * options.noise_um;
  return plant;
}

TimeUs time_of(const States& states, std::size_t tick) {
  return TimeUs(counts(1e6 * states.time[static_cast<Eigen::Index>(tick)]));
}

/// One run; the parts of the board live here.
class Loop {
 public:
  Loop(const ImageView& image, const Machine& machine, const States& states, const LoopOptions& options)
      : machine_(machine),
        states_(states),
        trajectory_(machine, states),
        plant_(trajectory_, image.axes().size, image.inputs().size, plant_options(options)),
        cycle_(image, Board{clock_, plant_, plant_, plant_}, limits_off()),
        runner_(cycle_, clock_, TimeUs(image.header().tick_us)) {
    if (options.dac_bits) chain_.emplace(*options.dac_bits);
    const auto count = static_cast<Eigen::Index>(states.count);
    result_.correction.assign(machine.axes.size(), Column::Zero(count));
  }

  LoopResult run() {
    bring_in();
    plant_.release();
    for (std::size_t tick = 0; tick < states_.count; ++tick) follow(tick);
    result_.mode = cycle_.mode();
    result_.fault = cycle_.latched();
    result_.health = cycle_.health();
    return std::move(result_);
  }

 private:
  void bring_in() {
    for (bool asked = false; cycle_.mode() != Mode::kActive; ++result_.pre_roll) {
      if (result_.pre_roll == kMostPreRoll)
        throw LimitNotMet(std::string("the firmware did not become active, it is in mode ") +
                          name_of(cycle_.mode()) + "; is maxslew too low to bring the correction in?");
      plant_.advance();
      runner_.set_time(time_of(states_, 0));
      const bool ask = cycle_.mode() == Mode::kReady && !asked;
      asked = asked || ask;
      runner_.step(ask ? Command::kActivate : Command::kNone);
    }
  }

  void follow(std::size_t tick) {
    using std::chrono::steady_clock;
    plant_.advance();
    runner_.set_time(time_of(states_, tick));
    const auto begin = steady_clock::now();
    const TickReport report = runner_.step(Command::kNone);
    result_.execution.add(
        std::chrono::duration_cast<std::chrono::nanoseconds>(steady_clock::now() - begin).count());
    bool saturated = (report.output.flags & kSaturated) != 0;
    for (std::size_t i = 0; i < machine_.axes.size(); ++i)
      result_.correction[i][static_cast<Eigen::Index>(tick)] = applied(i, saturated);
    result_.saturated += saturated ? 1 : 0;
    result_.slewing += (report.output.flags & kSlewing) != 0 ? 1 : 0;
    result_.beyond_range += (report.output.flags & kBeyondRange) != 0 ? 1 : 0;
    result_.not_active += report.mode != Mode::kActive ? 1 : 0;
  }

  /// What the axis moves by, mm or deg. The analogue chain is that of a linear axis.
  double applied(std::size_t axis, bool& saturated) const {
    const AxisTravel written = plant_.written(static_cast<std::uint32_t>(axis));
    if (machine_.axes[axis].rotary) return static_cast<double>(written.count) / kCountsPerDeg;
    if (!chain_) return static_cast<double>(written.count) / kCountsPerMm;
    saturated = saturated || chain_->saturates(written);
    return chain_->offset_nm(chain_->code_for(written)) / kCountsPerMm;
  }

  const Machine& machine_;
  const States& states_;
  PathTrajectory trajectory_;
  SimClock clock_;
  SimPlant plant_;
  Cycle cycle_;
  Runner runner_;
  std::optional<AnalogueChain> chain_;
  LoopResult result_;
};

}  // namespace

LoopResult run_loop(const ImageView& image, const Machine& machine, const States& states,
                    const LoopOptions& options) {
  return std::make_unique<Loop>(image, machine, states, options)->run();
}

}  // namespace vernier
