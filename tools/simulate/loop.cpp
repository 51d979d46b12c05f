// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulate/loop.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>

#include "firmware/core/cycle/runner.h"
#include "hal/sim/analogue_chain.h"
#include "hal/sim/plant.h"
#include "hal/sim/sim_clock.h"
#include "tools/simulate/counts.h"
#include "tools/text/error.h"

namespace vernier::simulate {
namespace {

/// Half an hour at 1 kHz: if a correction needs longer to reach its full weight, its slew limit is
/// a mistake.
constexpr std::size_t kMostPreRoll = 1'800'000;

TimeUs time_of(const model::States& states, std::size_t tick) {
  return TimeUs(counts(1e6 * states.time[static_cast<Eigen::Index>(tick)]));
}

/// States with one state per tick.
class StatesPath : public TickPath {
 public:
  StatesPath(const model::Machine& machine, const model::States& states)
      : machine_(machine), states_(states) {}
  std::size_t count() const noexcept override { return states_.count; }
  void at(std::size_t tick, PlantState& state) const noexcept override {
    tell_state(machine_, states_, static_cast<Eigen::Index>(tick), state);
  }
  TimeUs time(std::size_t tick) const noexcept override { return time_of(states_, tick); }
  bool kept(std::size_t) const noexcept override { return true; }

 private:
  const model::Machine& machine_;
  const model::States& states_;
};

/// The path in the form for the plant: before its start and after its end the machine is at rest.
class PathTrajectory : public Trajectory {
 public:
  explicit PathTrajectory(const TickPath& path) : path_(path) {}
  void at(std::int64_t tick, PlantState& state) noexcept override {
    path_.at(static_cast<std::size_t>(
                 std::clamp<std::int64_t>(tick, 0, static_cast<std::int64_t>(path_.count()) - 1)),
             state);
  }

 private:
  const TickPath& path_;
};

CycleLimits limits_off() {
  constexpr std::int64_t kNever = std::int64_t{1} << 50;  // us: 36 years
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

/// One run, with the parts of the board.
class Loop {
 public:
  Loop(const ImageView& image, const model::Machine& machine, const TickPath& path,
       const LoopOptions& options)
      : machine_(machine),
        path_(path),
        trajectory_(path),
        plant_(trajectory_, image.axes().size, image.inputs().size, plant_options(options)),
        cycle_(image, Board{clock_, plant_, plant_, plant_}, limits_off()),
        runner_(cycle_, clock_, TimeUs(image.header().tick_us)) {
    if (options.dac_bits) chain_.emplace(*options.dac_bits);
    Eigen::Index kept = 0;
    for (std::size_t tick = 0; tick < path.count(); ++tick) kept += path.kept(tick) ? 1 : 0;
    result_.correction.assign(machine.axes.size(), model::Column::Zero(kept));
  }

  LoopResult run() {
    bring_in();
    plant_.release();
    for (std::size_t tick = 0; tick < path_.count(); ++tick) follow(tick);
    result_.mode = cycle_.mode();
    result_.fault = cycle_.latched();
    result_.health = cycle_.health();
    return std::move(result_);
  }

 private:
  void bring_in() {
    for (bool asked = false; cycle_.mode() != Mode::kActive; ++result_.pre_roll) {
      if (result_.pre_roll == kMostPreRoll)
        throw text::LimitNotMet(
            fmt::format("the firmware did not enter the mode Active; its mode is {}; possible cause: maxslew "
                        "is too low for the correction",
                        name_of(cycle_.mode())));
      plant_.advance();
      runner_.set_time(path_.time(0));
      const bool ask = cycle_.mode() == Mode::kReady && !asked;
      asked = asked || ask;
      runner_.step(ask ? Command::kActivate : Command::kNone);
    }
  }

  void follow(std::size_t tick) {
    using std::chrono::steady_clock;
    plant_.advance();
    runner_.set_time(path_.time(tick));
    const auto begin = steady_clock::now();
    const TickReport report = runner_.step(Command::kNone);
    result_.execution.add(
        std::chrono::duration_cast<std::chrono::nanoseconds>(steady_clock::now() - begin).count());
    bool saturated = (report.output.flags & kSaturated) != 0;
    const bool kept = path_.kept(tick);
    for (std::size_t i = 0; i < machine_.axes.size(); ++i) {
      const double moved = applied(i, saturated);
      if (kept) result_.correction[i][kept_] = moved;
    }
    kept_ += kept ? 1 : 0;
    result_.saturated += saturated ? 1 : 0;
    result_.slewing += (report.output.flags & kSlewing) != 0 ? 1 : 0;
    result_.beyond_range += (report.output.flags & kBeyondRange) != 0 ? 1 : 0;
    result_.not_active += report.mode != Mode::kActive ? 1 : 0;
  }

  /// Returns the motion of the axis by the correction, mm or deg. The analogue output is that of a
  /// linear axis.
  double applied(std::size_t axis, bool& saturated) const {
    const AxisTravel written = plant_.written(static_cast<std::uint32_t>(axis));
    if (machine_.axes[axis].rotary) return static_cast<double>(written.count) / kCountsPerDeg;
    if (!chain_) return static_cast<double>(written.count) / kCountsPerMm;
    saturated = saturated || chain_->saturates(written);
    return chain_->offset_nm(chain_->code_for(written)) / kCountsPerMm;
  }

  const model::Machine& machine_;
  const TickPath& path_;
  PathTrajectory trajectory_;
  SimClock clock_;
  SimPlant plant_;
  Cycle cycle_;
  Runner runner_;
  std::optional<AnalogueChain> chain_;
  LoopResult result_;
  Eigen::Index kept_ = 0;
};

}  // namespace

void tell_state(const model::Machine& machine, const model::States& states, Eigen::Index k,
                PlantState& state) noexcept {
  for (std::size_t i = 0; i < machine.axes.size(); ++i) {
    const double scale = machine.axes[i].rotary ? kCountsPerDeg : kCountsPerMm;
    AxisReading& axis = state.axis[i];
    axis.position = AxisPosition(counts(scale * states.axis[i][k]));
    axis.velocity = AxisSpeed(counts(scale * states.velocity[i][k]));
    axis.acceleration = AxisAcceleration(counts(scale * states.acceleration[i][k]));
    axis.since = states.since[i][k] >= model::kLongWay ? AxisTravel(INT64_MAX)
                                                       : AxisTravel(counts(scale * states.since[i][k]));
    axis.sense = static_cast<std::int8_t>(states.direction[i][k]);
  }
  for (std::size_t i = 0; i < machine.inputs.size(); ++i)
    state.input[i] = InputMicro(counts(1e6 * states.input[i][k]));
  state.path.feed = FeedNmPerMin(counts(1e6 * states.feed[k]));
  state.path.tells_feed = true;
  state.path.curvature = CurvatureNanoPerMm(counts(1e9 * states.curvature[k]));
  state.path.visit = VisitCount(counts(states.visit[k]));
}

LoopResult run_loop(const ImageView& image, const model::Machine& machine, const model::States& states,
                    const LoopOptions& options) {
  return run_loop(image, machine, StatesPath(machine, states), options);
}

LoopResult run_loop(const ImageView& image, const model::Machine& machine, const TickPath& path,
                    const LoopOptions& options) {
  return std::make_unique<Loop>(image, machine, path, options)->run();
}

}  // namespace vernier::simulate
