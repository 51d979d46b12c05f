// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <memory>
#include <vector>

#include "firmware/core/cycle/cycle.h"
#include "hal/sim/plant.h"
#include "hal/sim/roaming.h"
#include "hal/sim/sim_clock.h"
#include "tests/unit/firmware/small_machine.h"

namespace vernier {

using namespace vernier::compile;

/// The small machine on the simulated plant, roaming through its range at 20 degC + `warmer`.
class Rig {
 public:
  explicit Rig(const PlantOptions& options = {}, const CycleLimits& limits = {}, std::int64_t warmer = 0)
      : image_(small_image()),
        motion_({{0, 600'000'000}, {0, 200'000'000}}, {InputMicro(20'000'000 + 1'000'000 * warmer)},
                TimeUs(1000), 0.1, options.seed),
        plant_(motion_, 2, 1, options),
        cycle_(std::make_unique<Cycle>(image_->view, Board{clock_, plant_, plant_, plant_}, limits)) {
    plant_.release();
  }

  TickReport tick(Command command = Command::kNone, Fault outer = Fault::kNone) {
    plant_.advance();
    return cycle_->tick(TimeUs(1000 * plant_.tick()), command, outer);
  }
  /// Ticks until the mode is reached, at most `most`; true where it was.
  bool run_to(Mode mode, int most = 2000) {
    for (int i = 0; i < most && cycle_->mode() != mode; ++i)
      tick(cycle_->mode() == Mode::kReady && mode == Mode::kActive && !asked() ? Command::kActivate
                                                                               : Command::kNone);
    return cycle_->mode() == mode;
  }
  bool asked() const { return cycle_->weight() != WeightQ16{}; }
  Cycle& cycle() { return *cycle_; }
  SimPlant& plant() { return plant_; }
  const ImageView& view() const { return image_->view; }

 private:
  std::unique_ptr<LoadedImage> image_;
  Roaming motion_;
  SimClock clock_;
  SimPlant plant_;
  std::unique_ptr<Cycle> cycle_;
};

}  // namespace vernier
