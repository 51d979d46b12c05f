// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/simulation/world.h"

#include <cstring>

#include "tests/unit/firmware/small_machine.h"

namespace vernier::simulation {

using namespace vernier::compile;
using namespace vernier::model;
HalFault Line::serve(CommandHandler& handler, TimeUs) noexcept {
  talk_->work(handler, now_);
  return HalFault::kNone;
}

namespace {

// At 50 Hz the small machine's 0.5 and 2 mm/s.
constexpr std::int64_t kSlew[2] = {10'000, 40'000};
constexpr ModbusLayout kLayout{kMailboxRegister, kMailboxRegisters, kLiveRegisters};

std::vector<std::uint8_t> frame_of(const std::vector<std::uint8_t>& pdu) {
  const std::size_t length = pdu.size() + 1;
  std::vector<std::uint8_t> frame(7 + pdu.size());
  frame[4] = static_cast<std::uint8_t>(length >> 8), frame[5] = static_cast<std::uint8_t>(length);
  frame[6] = 1;
  std::memcpy(frame.data() + 7, pdu.data(), pdu.size());
  return frame;
}

std::vector<std::uint8_t> write_of(const std::vector<std::uint8_t>& request) {
  const std::size_t registers = 1 + (request.size() + 1) / 2;
  std::vector<std::uint8_t> pdu(6 + 2 * registers);
  pdu[0] = 16, pdu[1] = kMailboxRegister >> 8, pdu[2] = kMailboxRegister & 0xff;
  pdu[4] = static_cast<std::uint8_t>(registers), pdu[5] = static_cast<std::uint8_t>(2 * registers);
  pdu[6] = static_cast<std::uint8_t>(request.size() >> 8), pdu[7] = static_cast<std::uint8_t>(request.size());
  std::memcpy(pdu.data() + 8, request.data(), request.size());
  return frame_of(pdu);
}

std::vector<std::uint8_t> read_of() {
  return frame_of({4, kMailboxRegister >> 8, kMailboxRegister & 0xff, 0, kMailboxRegisters});
}

}  // namespace

std::vector<std::uint8_t> image_of(int variant) {
  std::string text = kSmallMachine;
  const std::string from = "<k value=\"0.0001\"";
  text.replace(text.find(from), from.size(), "<k value=\"" + std::to_string(1e-5 * (1 + variant)) + "\"");
  CompileOptions options;
  options.tick_us = static_cast<std::uint32_t>(kTick.count);
  return compile_machine(parse_machine(text, "small.xml"), text, options).image;
}

World::World(std::uint64_t seed) : random_(seed) {
  motion_ = std::make_unique<Roaming>(std::vector<RoamingAxis>{{0, 600'000'000}, {0, 200'000'000}},
                                      std::vector<InputMicro>{InputMicro(21'000'000)}, kTick, 0.1, seed);
  plant_ = std::make_unique<SimPlant>(*motion_, 2, 1, PlantOptions{.seed = seed, .faults = {}});
  drive_ = std::make_unique<SimulatedDrive>(random_, kTick, kSlew[0]);
  devices_ = std::make_unique<FlakyDevices>(*plant_, *drive_);
  plant_->release();
  start();
}

void World::need(bool holds, const char* what) const {
  if (!holds) throw Broken{std::string(what) + " (tick " + std::to_string(counts.ticks) + ")"};
}

void World::start() {
  store_.restore_power();
  ServiceOptions options;
  options.wiring = {{{"X"}, {"Y"}}, {"T"}};
  options.upload.tick = kTick;
  options.upload.identity = key_.public_part();
  options.upload.trial_time = kTrialTime;
  options.store_beside = true;
  options.activate = true;
  options.ticks_kept = 64, options.touches_kept = 8;
  for (auto& byte : options.nonce) byte = static_cast<std::uint8_t>(random_());
  for (auto& byte : options.seed) byte = static_cast<std::uint8_t>(~options.nonce[0]);
  for (int i = 0; i < 2; ++i) {
    options.limits.axis[i].own = true;
    options.limits.axis[i].limits = options.limits.linear;
    options.limits.axis[i].limits.step = 100'000'000;
    options.limits.axis[i].largest = kBoardLimit;
  }
  // As the daemon does before its first tick, within the limits.
  drive_->start();
  for (std::uint32_t axis = 0; axis < 2; ++axis) {
    plant_->write_correction(axis, AxisTravel{});
    before_[axis] = AxisTravel{};
  }
  service_ = std::make_unique<Service>(options, Board{clock_, *devices_, *devices_, *devices_}, store_);
  const UploadResult boot = service_->boot();
  connect();
  life_ = std::make_unique<SignOfLife>(clock_.now());
  medium_busy_ = 0;
  trial_seen_ = 0;
  torn_ = false;
  const Slots& slots = service_->uploader().slots();
  need(slots.trial() == kNoSlot, "a start ends every trial");
  const std::uint64_t found = slots.issued();
  need(found == confirmed_ || in_flight_.contains(found), "the old image or the new one is confirmed");
  confirmed_ = found;
  in_flight_.clear();
  need(slots.newest_issued() >= newest_ || slots.newest_issued() >= confirmed_,
       "the floor of times does not fall");
  if (boot.fault != UploadFault::kNone) {
    need(slot_bad_, "a sound slot loads");
    need(service_->uploader().image_lost(), "an image that does not load is told");
    ++counts.images_lost;
  }
}

void World::connect() {
  talk_ = std::make_unique<ModbusConversation>(kLayout, 0, InstantNs(500'000'000));
  talk_->begin(clock_.now(), ++connections_);
}

void World::die() {
  ++counts.deaths;
  out_since_death_ = pending_out_ = sure_out_;
  if (looks_with_fault_ > 2) out_since_death_ = kAllAxes;
  looks_with_fault_ = 0;
  service_ = nullptr;
  start();
}

void World::hurt_medium() {
  const Slots& slots = service_->uploader().slots();
  if (!torn_ && one_in(40'000)) {
    // The power fails in the middle of some later write.
    store_.cut_power_after(random_() % 4000);
    torn_ = true;
    ++counts.torn_writes;
  }
  if (medium_busy_ == 0 && one_in(20'000)) {
    medium_busy_ = static_cast<std::int64_t>(random_() % 300);
    ++counts.slow_media;
  }
  if (slots.confirmed() != kNoSlot && one_in(600'000)) {
    std::uint8_t byte = 0;
    const auto at = static_cast<std::uint32_t>(random_() % 1200);
    if (store_.read_image(slots.confirmed(), at, &byte, 1) != HalFault::kNone) return;
    byte = static_cast<std::uint8_t>(byte ^ 1u << random_() % 8);
    if (store_.write_image(slots.confirmed(), at, &byte, 1) == HalFault::kNone)
      slot_bad_ = true, ++counts.flips;
  }
}

void World::hurt_before_tick() {
  if (one_in(3'000)) {
    clock_.late = InstantNs(static_cast<std::int64_t>(random_() % 60'000'000));
    ++counts.late_ticks;
  }
  if (one_in(400'000)) {
    clock_.late = InstantNs(static_cast<std::int64_t>(1'100'000'000 + random_() % 4'000'000'000));
    ++counts.stops;
  }
  if (silent_left_ == 0 && one_in(30'000))
    silent_left_ = 1 + static_cast<std::int64_t>(random_() % 20), ++counts.silent_axes;
  if (refuse_left_ == 0 && one_in(60'000))
    refuse_left_ = 1 + static_cast<std::int64_t>(random_() % 5), ++counts.refused_writes;
  hurt_medium();
}

void World::check_drives() {
  for (std::uint32_t axis = 0; axis < 2; ++axis) {
    // A drive without torque has its offset taken out at once.
    const bool torque = axis != 0 || (drive_->has_torque() && drive_->had_torque());
    const AxisTravel now = axis == 0 ? drive_->offset() : plant_->written(axis);
    need(!torque || std::abs((now - before_[axis]).count) <= kSlew[axis],
         "no drive moves faster than its slew limit");
    need(std::abs(now.count) <= kBoardLimit, "no drive goes beyond the board's limit");
    const bool out = (out_since_death_ >> axis & 1) != 0;
    need(!out || now == AxisTravel{}, "after a death, what was taken out waits for an operator");
    counts.kept_out += out ? 1 : 0;
    before_[axis] = now;
  }
}

void World::check_image() {
  auto& programs = const_cast<Programs&>(service_->uploader().programs());
  const LoadedProgram* const program = programs.look();
  const std::uint64_t runs = program != nullptr ? program->header.fingerprint : 0;
  programs.look_away();
  need(runs == 0 || signed_.contains(runs), "what runs was signed");
  const Slots& slots = service_->uploader().slots();
  if (!torn_) {
    need(slots.newest_issued() >= newest_, "the floor of times does not fall");
    need(slots.security() >= security_, "the security counter does not fall");
    newest_ = slots.newest_issued(), security_ = slots.security();
  }
  if (service_->uploader().image_lost() && slots.trial() == kNoSlot)
    need(service_->cycle().mode() != Mode::kActive || runs != 0, "nothing is Active without an image");
}

void World::check_trial() {
  const Programs& programs = service_->uploader().programs();
  if (programs.trial() != Trial::kRunning) {
    trial_seen_ = 0;
    return;
  }
  if (trial_seen_ == 0) {
    trial_seen_ = 1;
    trial_until_ = clock_.now() + instant_ns(kTrialTime);
  }
  // A round of the guardian, a tick, and what this tick was late.
  need(clock_.now() <=
           trial_until_ + InstantNs(3 * instant_ns(kTick).count + 6'000'000'000 * (clock_.late.count > 0)),
       "a trial ends on time");
}

void World::check_life() {
  const std::uint64_t ticks = service_->exchange().ticks.count();
  if (!life_->due(ticks, clock_.now())) return;
  need(static_cast<std::int64_t>(ticks) != ticks_at_sign_, "the watchdog is fed only where the tick ran");
  ticks_at_sign_ = static_cast<std::int64_t>(ticks);
  ++counts.signs;
}

void World::serve() {
  line_.carries(*talk_, clock_.now());
  service_->serve(line_, TimeUs(0));
  // The store's own context: it comes when its medium lets it.
  if (medium_busy_ > 0) {
    --medium_busy_;
    return;
  }
  service_->look_after_store();
  note_out();
}

// A setting counts as stored when the store has looked after it twice since: once may have been before the
// tick that took the command.
void World::note_out() {
  if (store_.dead()) return;
  looks_with_fault_ = service_->cycle().latched() != Fault::kNone ? looks_with_fault_ + 1 : 0;
  if (++looks_since_ > 2 && !service_->operator_memory().refused()) sure_out_ |= pending_out_;
}

void World::tick() {
  if (!calm) hurt_before_tick();
  devices_->silent = silent_left_ > 0;
  devices_->refuse = refuse_left_ > 0;
  silent_left_ -= silent_left_ > 0 ? 1 : 0;
  refuse_left_ -= refuse_left_ > 0 ? 1 : 0;
  plant_->advance();
  drive_->cycle(clock_.now(), calm);
  counts.drive = drive_->counts;
  const InstantNs late = clock_.late;
  const TickReport report = service_->tick();
  ++counts.ticks;
  counts.active += report.mode == Mode::kActive ? 1 : 0;
  check_drives();
  service_->guard();
  // What was late may have kept the guardian too: it shares the processor.
  if (late.count > 0) trial_until_ = trial_until_ + late;
  check_trial();
  serve();
  check_image();
  check_life();
  if (store_.dead() || (!calm && one_in(500'000))) die();
}

void World::run(std::int64_t ticks) {
  for (std::int64_t i = 0; i < ticks; ++i) {
    if (!calm && one_in(2'000)) attack();
    tick();
  }
}

std::vector<std::uint8_t> World::exchange_frame(const std::vector<std::uint8_t>& frame, bool trusted) {
  std::vector<std::uint8_t> sent = frame;
  if (seen_.size() > 200) seen_.erase(seen_.begin());
  int times = 1;
  if (!calm && one_in(200)) times = 0, ++counts.lost_frames;
  if (!calm && one_in(200)) times = 2, ++counts.doubled_frames;
  if (!calm && one_in(200))
    sent[7 + random_() % (sent.size() - 7)] ^= static_cast<std::uint8_t>(1u << random_() % 8),
        ++counts.changed_frames;
  if (!calm && one_in(200)) ++counts.late_frames, run(static_cast<std::int64_t>(random_() % 100));
  if (trusted) seen_.push_back({frame, clock_.now(), times > 0 && sent == frame});
  const std::uint64_t death = counts.deaths;
  // What is not taken in stays with the sender's computer.
  for (int wait = 0; wait < 800 && death == counts.deaths && talk_->room() < sent.size(); ++wait) tick();
  for (int i = 0; i < times && death == counts.deaths && talk_->room() >= sent.size(); ++i) {
    std::memcpy(talk_->space(), sent.data(), sent.size());
    talk_->took(static_cast<std::uint32_t>(sent.size()), clock_.now());
  }
  std::vector<std::uint8_t> reply;
  for (int wait = 0; wait < 800 && death == counts.deaths; ++wait) {
    tick();
    if (death == counts.deaths && talk_->waiting() > 0) {
      reply.assign(talk_->out(), talk_->out() + talk_->waiting());
      talk_->sent(talk_->waiting());
      break;
    }
    if (talk_->broken(clock_.now()) || times == 0) break;
  }
  if (reply.empty() && death == counts.deaths) connect();
  return reply;
}

std::vector<std::uint8_t> World::carry(const std::vector<std::uint8_t>& request) {
  if (exchange_frame(write_of(request), true).empty()) return {};
  const std::vector<std::uint8_t> reply = exchange_frame(read_of(), true);
  if (reply.size() < 11 || reply[7] != 4) return {};
  const std::size_t size = static_cast<std::size_t>(reply[9]) << 8 | reply[10];
  if (size == 0 || 11 + size > reply.size()) return {};
  return {reply.begin() + 11, reply.begin() + 11 + static_cast<std::ptrdiff_t>(size)};
}

// Somebody without a key, on a connection of his own. Whatever he sends, what the operator set stands.
void World::attack() {
  std::vector<std::uint8_t> frame;
  if (!seen_.empty() && one_in(2)) {
    // One that never arrived may come a few seconds late, as on any line; later it may not.
    const Seen& seen = seen_[random_() % seen_.size()];
    if (!seen.delivered && clock_.now() - seen.at < InstantNs(11'000'000'000)) return;
    frame = seen.frame;
    ++counts.replayed;
  } else {
    std::vector<std::uint8_t> request(2 + random_() % 100);
    for (auto& byte : request) byte = static_cast<std::uint8_t>(random_());
    request[0] = static_cast<std::uint8_t>(1 + random_() % kLinkOpCount);
    frame = one_in(10) ? frame_of({6, 0, 0, 0, static_cast<std::uint8_t>(random_() % 7)}) : write_of(request);
    ++counts.forged;
  }
  ModbusConversation stranger(kLayout, 0, InstantNs(500'000'000));
  stranger.begin(clock_.now(), ++connections_);
  std::memcpy(stranger.space(), frame.data(), frame.size());
  stranger.took(static_cast<std::uint32_t>(frame.size()), clock_.now());
  const Trial trial = service_->uploader().programs().trial();
  const std::uint64_t issued = service_->uploader().slots().issued();
  std::int32_t weight[2];
  for (int i = 0; i < 2; ++i) weight[i] = service_->exchange().axis_weight[i].load();
  const Command command = service_->exchange().command.load();
  line_.carries(stranger, clock_.now());
  service_->serve(line_, TimeUs(0));
  need(service_->uploader().programs().trial() == trial && service_->uploader().slots().issued() == issued,
       "no image changes without a signature");
  for (int i = 0; i < 2; ++i)
    need(service_->exchange().axis_weight[i].load() == weight[i], "no weight changes without a signature");
  need(service_->exchange().command.load() == command, "no command is given without a signature");
  need(!service_->store_is_asked() || talk_ != nullptr, "the store works for who signs");
}

}  // namespace vernier::simulation
