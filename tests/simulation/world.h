// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A board, its links, its medium and its clock in one thread and one seeded world, in which all of them fail.
#include <functional>
#include <map>
#include <memory>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "firmware/core/service.h"
#include "firmware/core/sign_of_life.h"
#include "hal/linux/modbus/modbus_conversation.h"
#include "hal/sim/plant.h"
#include "hal/sim/roaming.h"
#include "hal/sim/sim_slot_store.h"
#include "tests/simulation/simulated_drive.h"
#include "tools/upload/signing.h"

namespace vernier::simulation {

using namespace vernier::upload;

constexpr TimeUs kTick(20'000);
constexpr TimeUs kTrialTime(60'000'000);
constexpr std::int64_t kBoardLimit = 25'000;  // nm, below what the image allows
constexpr std::uint32_t kAllAxes = 3;
constexpr std::uint32_t kStoreBytes = 1 << 14;

/// An invariant that did not hold: what, and when.
struct Broken {
  std::string what;
};

/// A clock that a test can make late, or step.
class WorldClock : public Clock {
 public:
  InstantNs now() noexcept override { return now_; }
  HalFault sleep_until(InstantNs due) noexcept override {
    now_ = (now_ < due ? due : now_) + late;
    late = {};
    return HalFault::kNone;
  }
  InstantNs late;

 private:
  InstantNs now_{1'000'000'000};
};

struct Counts {
  std::uint64_t ticks = 0, late_ticks = 0, stops = 0, deaths = 0, torn_writes = 0, flips = 0, slow_media = 0,
                lost_frames = 0, doubled_frames = 0, changed_frames = 0, late_frames = 0, forged = 0,
                replayed = 0, silent_axes = 0, refused_writes = 0, uploads = 0, confirmed = 0, given_up = 0,
                timed_out = 0, images_lost = 0, faults = 0, active = 0, signs = 0, kept_out = 0;
  DriveCounts drive;
  std::uint64_t injected() const {
    return drive.all() + late_ticks + stops + deaths + torn_writes + flips + slow_media + lost_frames +
           doubled_frames + changed_frames + late_frames + forged + replayed + silent_axes + refused_writes;
  }
};

/// Devices between plant and board that fall silent or refuse. The correction of X goes to a drive.
class FlakyDevices : public AxisReader, public InputReader, public CorrectionWriter {
 public:
  FlakyDevices(SimPlant& plant, SimulatedDrive& drive) : plant_(plant), drive_(drive) {}
  HalFault read_axis(std::uint32_t axis, AxisReading& reading) noexcept override {
    return silent ? HalFault::kNoReading : plant_.read_axis(axis, reading);
  }
  HalFault read_path(PathReading& reading) noexcept override { return plant_.read_path(reading); }
  bool gives_motion() const noexcept override { return plant_.gives_motion(); }
  HalFault read_input(std::uint32_t input, InputMicro& value) noexcept override {
    return silent ? HalFault::kNoReading : plant_.read_input(input, value);
  }
  HalFault write_correction(std::uint32_t axis, AxisTravel correction) noexcept override {
    if (refuse) return HalFault::kRefused;
    return axis == 0 ? drive_.write_correction(axis, correction) : plant_.write_correction(axis, correction);
  }
  AxisTravel within_range(std::uint32_t axis, AxisTravel correction) const noexcept override {
    return axis == 0 ? drive_.within_range(axis, correction) : plant_.within_range(axis, correction);
  }
  bool silent = false, refuse = false;

 private:
  SimPlant& plant_;
  SimulatedDrive& drive_;
};

/// The link of the world: one link, over which the operator and a stranger have connections of their own.
class Line : public CommandLink {
 public:
  void carries(ModbusConversation& talk, InstantNs now) { talk_ = &talk, now_ = now; }
  HalFault serve(CommandHandler& handler, TimeUs wait) noexcept override;

 private:
  ModbusConversation* talk_ = nullptr;
  InstantNs now_;
};

/// The world. Everything that happens to the board happens in run().
class World {
 public:
  explicit World(std::uint64_t seed);

  /// Lets so many ticks pass, with faults in between; throws Broken.
  void run(std::int64_t ticks);
  /// Brings a request to the board over a line that loses, doubles, changes and delays; empty: no reply came.
  std::vector<std::uint8_t> carry(const std::vector<std::uint8_t>& request);
  /// A frame of somebody who has no key: forged, or one that was seen before.
  void attack();

  bool one_in(std::uint64_t count) { return random_() % count == 0; }
  std::uint64_t any() { return random_(); }
  const SigningKey& key() const { return key_; }
  Service& service() { return *service_; }
  /// The operator says that an image may run from now on; and that its confirmation was asked for.
  void signed_image(std::uint64_t fingerprint) { signed_.insert(fingerprint); }
  void asked_to_confirm(std::uint64_t issued) { in_flight_.insert(issued); }
  void knows_confirmed(std::uint64_t issued) { confirmed_ = issued, in_flight_.clear(); }
  /// The operator has taken the correction of these axes out (bits), and has an answer.
  void took_out(std::uint32_t axes) { pending_out_ |= axes, looks_since_ = 0; }
  /// The operator is about to say something that may bring the correction of these axes in again.
  void may_bring_in(std::uint32_t axes) {
    pending_out_ &= ~axes, sure_out_ &= ~axes, out_since_death_ &= ~axes;
  }
  std::uint64_t confirmed() const { return confirmed_; }
  std::uint64_t deaths() const { return counts.deaths; }
  /// Nothing fails for a while: for what must succeed in the end.
  bool calm = false;
  Counts counts;

 private:
  void start();
  void connect();
  void die();
  void tick();
  void hurt_before_tick();
  void hurt_medium();
  void serve();
  void check_drives();
  void check_image();
  void check_trial();
  void check_life();
  void note_out();
  std::vector<std::uint8_t> exchange_frame(const std::vector<std::uint8_t>& frame, bool trusted);
  void need(bool holds, const char* what) const;

  std::mt19937_64 random_;
  SigningKey key_ = new_key();
  WorldClock clock_;
  std::unique_ptr<Roaming> motion_;
  std::unique_ptr<SimPlant> plant_;
  std::unique_ptr<SimulatedDrive> drive_;
  std::unique_ptr<FlakyDevices> devices_;
  SimSlotStore store_{kStoreBytes};
  std::unique_ptr<Service> service_;
  std::unique_ptr<ModbusConversation> talk_;
  Line line_;
  std::uint64_t connections_ = 0;
  std::unique_ptr<SignOfLife> life_;
  std::set<std::uint64_t> signed_;
  struct Seen {
    std::vector<std::uint8_t> frame;
    InstantNs at;
    bool delivered;
  };
  std::vector<Seen> seen_;  // by who listens on the line
  std::uint64_t confirmed_ = 0, newest_ = 0;
  std::set<std::uint64_t> in_flight_;  // asked to be confirmed, without an answer since
  std::uint32_t security_ = 0;
  AxisTravel before_[2];
  std::int64_t silent_left_ = 0, refuse_left_ = 0, medium_busy_ = 0, ticks_at_sign_ = -1;
  InstantNs trial_until_;
  std::uint64_t trial_seen_ = 0;
  std::uint8_t before_axis_weights_ = 0;
  // Axes whose correction the operator or a fault took out: answered; stored too; stored before the last
  // death.
  std::uint32_t pending_out_ = 0, sure_out_ = 0, out_since_death_ = 0;
  int looks_since_ = 0, looks_with_fault_ = 0;
  bool torn_ = false, slot_bad_ = false;
};

/// The image of the small machine for this world's tick, with a scale error of its own.
std::vector<std::uint8_t> image_of(int variant);

}  // namespace vernier::simulation
