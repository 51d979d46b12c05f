// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "firmware/core/service.h"
#include "hal/sim/plant.h"
#include "hal/sim/roaming.h"
#include "hal/sim/sim_clock.h"
#include "hal/sim/sim_slot_store.h"
#include "tests/unit/firmware/small_machine.h"
#include "tools/model/machine_reader.h"
#include "tools/upload/signing.h"

namespace vernier {

using namespace vernier::compile;
using namespace vernier::model;
using namespace vernier::upload;

/// The small machine with another scale error, so that its equation is another one.
inline std::vector<std::uint8_t> small_image_bytes(double scale, const std::string& text = kSmallMachine) {
  std::string changed = text;
  const std::string before = "<k value=\"0.0001\"";
  changed.replace(changed.find(before), before.size(), "<k value=\"" + std::to_string(scale) + "\"");
  const Machine machine = parse_machine(changed, "small.xml");
  return compile_machine(machine, changed, {}).image;
}

/// A board of the small machine with a store, whose power can be switched off and on.
class UploadRig {
 public:
  explicit UploadRig(SimSlotStore& store, const SigningKey& key, TimeUs trial = TimeUs(5'000'000),
                     DigitalInput* enable = nullptr, DigitalOutput* healthy = nullptr,
                     std::uint32_t toggle = 0)
      : store_(store),
        motion_({{0, 600'000'000}, {0, 200'000'000}}, {InputMicro(21'000'000)}, TimeUs(1000), 0.1, 1),
        plant_(motion_, 2, 1, {}) {
    ServiceOptions options;
    options.wiring = {{{"X"}, {"Y"}}, {"T"}};
    options.upload.identity = key.public_part();
    options.upload.trial_time = trial;
    options.activate = true;
    options.healthy_toggle = toggle;
    const Board board{.clock = clock_,
                      .axes = plant_,
                      .inputs = plant_,
                      .corrections = plant_,
                      .enable = enable,
                      .healthy = healthy};
    service_ = std::make_unique<Service>(options, board, store_);
    boot_ = service_->boot();
    plant_.release();
  }

  void run(int ticks) {
    for (int i = 0; i < ticks; ++i) {
      plant_.advance();
      service_->look_after_programs();
      before_[0] = plant_.written(0), before_[1] = plant_.written(1);
      service_->tick();
      worst_[0] = std::max(worst_[0], std::abs((plant_.written(0) - before_[0]).count));
      worst_[1] = std::max(worst_[1], std::abs((plant_.written(1) - before_[1]).count));
    }
  }
  /// The whole way of an upload in pieces; the result of the step that failed, or of finish.
  UploadResult send(const std::vector<std::uint8_t>& upload, std::uint32_t piece = 100) {
    Uploader& uploader = this->uploader();
    service_->look_after_programs();
    UploadResult result = uploader.begin(static_cast<std::uint32_t>(upload.size()));
    for (std::uint32_t at = 0; at < upload.size() && result.fault == UploadFault::kNone; at += piece)
      result = uploader.add(at, upload.data() + at,
                            std::min<std::uint32_t>(piece, static_cast<std::uint32_t>(upload.size()) - at));
    if (result.fault != UploadFault::kNone) return result;
    return uploader.finish();
  }

  Service& service() { return *service_; }
  Uploader& uploader() { return const_cast<Uploader&>(service_->uploader()); }
  SimPlant& plant() { return plant_; }
  const UploadResult& boot_result() const { return boot_; }
  /// Largest change of a drive from tick to tick so far, counts.
  std::int64_t worst_step(std::size_t axis) const { return worst_[axis]; }
  std::uint64_t running() const {
    const BoundProgram& program = service_->cycle().program();
    return program.empty() ? 0 : program.program.equation.instructions.size;
  }

 private:
  SimSlotStore& store_;
  Roaming motion_;
  SimClock clock_;
  SimPlant plant_;
  std::unique_ptr<Service> service_;
  UploadResult boot_;
  AxisTravel before_[2];
  std::int64_t worst_[2] = {};
};

}  // namespace vernier
