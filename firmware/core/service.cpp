// SPDX-License-Identifier: Apache-2.0
#include "firmware/core/service.h"

#include <cstring>

#include "comp/fixed.h"

namespace vernier {
namespace {

// After this time without a stored state the medium, or the tick, does not respond: a setting that acts is
// answered as not stored.
constexpr TimeUs kStoreDeadline(5'000'000);
constexpr std::uint64_t kPerMillion[3] = {500'000, 990'000, 999'000};

ProbeSettings probe_settings(const ServiceOptions& options) {
  ProbeSettings settings = options.probe;
  settings.axes = static_cast<std::uint32_t>(options.wiring.axes.size());
  constexpr std::string_view kNames[3] = {"X", "Y", "Z"};
  for (std::uint32_t i = 0; i < settings.axes; ++i) {
    const Wiring::Axis& axis = options.wiring.axes[i];
    settings.rollover[i] = axis.rollover;
    for (int k = 0; k < 3; ++k)
      if (axis.name == kNames[k] && !axis.rotary) settings.xyz[k] = static_cast<std::uint8_t>(i);
  }
  return settings;
}

}  // namespace

Service::Service(ServiceOptions options, const Board& board, SlotStore& store)
    : options_(options),
      board_(board),
      exchange_(options_.ticks_kept, options_.touches_kept),
      uploader_(store, options_.wiring, exchange_, options_.upload),
      operator_(store, options_.wiring, exchange_),
      cycle_(options_.wiring, options_.upload.tick, board_, options_.limits),
      runner_(cycle_, board_.clock, options_.upload.tick, board_.sync, options_.sync_patience,
              options_.overruns),
      link_(exchange_, uploader_, options_.wiring, options_.upload.tick, options_.upload.identity),
      gate_(options_.upload.identity, options_.nonce, options_.seed, board_.identity) {
  if (board_.probe != nullptr) probing_.emplace(*board_.probe, probe_settings(options_), board_.actual);
  if (options_.in_controller) runner_.follow_caller();
}

void Service::take_over() noexcept {
  // The previous data must have been collected, else there is no room for the next.
  if (exchange_.retired.load(std::memory_order_relaxed) != nullptr) return;
  BoundProgram* const next = exchange_.offered.exchange(nullptr, std::memory_order_acquire);
  if (next != nullptr) exchange_.retired.store(cycle_.use(*next), std::memory_order_release);
}

// A line that cannot be read counts as off: with a cut wire no correction is applied.
void Service::read_enable() noexcept {
  if (board_.enable == nullptr) return;
  bool on = false;
  const bool before = enabled_;
  enabled_ = board_.enable->read_line(on) == HalFault::kNone && on;
  if (enabled_ && !before) activated_ = false, to_clear_ = options_.clear_on_enable;
  // The values that a hold kept are removed now; only an operator brings a correction back.
  if (!enabled_ && before && cycle_.holding()) taken_out_ = true;
}

void Service::tell_health(const TickReport& report) noexcept {
  if (board_.healthy == nullptr) return;
  // After a tick the mode is never Boot.
  const bool well = report.latched == Fault::kNone && report.mode != Mode::kChecking && !ending_;
  if (well && options_.healthy_toggle > 0) return pump();
  const Told now = well ? Told::kWell : Told::kUnwell;
  // A line that could not be switched is tried again with the next tick.
  if (now != told_ && board_.healthy->write_line(well) == HalFault::kNone) told_ = now, line_ = well;
}

// A line that does not change is not a sign of life, high or low: the relay behind it drops when the tick
// stops.
void Service::pump() noexcept {
  told_ = Told::kNothing;
  if (until_edge_ > 0) --until_edge_;
  if (until_edge_ > 0 || board_.healthy->write_line(!line_) != HalFault::kNone) return;
  line_ = !line_;
  until_edge_ = options_.healthy_toggle;
}

Command Service::next_command() noexcept {
  Command asked = exchange_.command.exchange(Command::kNone, std::memory_order_acq_rel);
  const Mode mode = cycle_.mode();
  const bool in = mode == Mode::kActive || (mode == Mode::kReady && cycle_.weight() != WeightQ16{});
  // A command that the cycle refuses has no effect later either. A deactivation always has one: without a
  // correction it keeps the correction out.
  if (asked == Command::kActivate && !enabled_) {
    cycle_.refuse_command();
    asked = Command::kNone;
  }
  if (asked == Command::kActivate && mode == Mode::kReady) taken_out_ = false;
  if (asked == Command::kDeactivate) taken_out_ = true;
  // After a clear the board waits for the next activation, also if it starts again or its enable line comes
  // on.
  if (asked == Command::kClearFault && mode == Mode::kFaulted && !options_.clear_on_enable) taken_out_ = true;
  if (asked == Command::kDeactivate && !in) asked = Command::kNone;
  if (ending_ || !enabled_) {
    if (in) return Command::kDeactivate;
    return asked == Command::kClearFault && !ending_ ? asked : Command::kNone;
  }
  // As switching it on does: the correction that the fault removed is applied again.
  if (asked == Command::kClearFault && options_.clear_on_enable && cycle_.latched() != Fault::kNone) {
    asked = Command::kNone;
    to_clear_ = true;
    activated_ = taken_out_;
  }
  // A fault that is still ramped out is cleared when it is out. Until then the cycle refuses every other
  // command: it must not end the clearing.
  if (to_clear_ && cycle_.latched() != Fault::kNone) {
    if (asked != Command::kNone) cycle_.refuse_command();
    return cycle_.mode() == Mode::kFaulted ? Command::kClearFault : Command::kNone;
  }
  to_clear_ = false;
  if (asked != Command::kNone || !options_.activate || activated_ || taken_out_) return asked;
  if (cycle_.mode() != Mode::kReady) return Command::kNone;
  activated_ = true;
  return Command::kActivate;
}

TickReport Service::tick() noexcept {
  take_over();
  read_enable();
  for (std::uint32_t i = 0; i < kMaxAxes; ++i)
    cycle_.set_axis_weight(
        i, WeightQ16(static_cast<std::int32_t>(
               multiply(exchange_.axis_weight[i].load(std::memory_order_relaxed), weight_.count, 16))));
  const TimeUs time = runner_.time();
  const TickReport report =
      runner_.step(next_command(), uploader_.image_lost() ? Fault::kImageLost : Fault::kNone);
  publish_operator();
  if (probing_) probing_->after_tick(cycle_, report, runner_.woke(), time, exchange_);
  tell_health(report);
  publish(report);
  return report;
}

void Service::publish(const TickReport& report) noexcept {
  record_.time_us = runner_.time().count;
  for (std::size_t i = 0; i < options_.wiring.axes.size(); ++i) {
    const auto axis = static_cast<std::uint32_t>(i);
    const AxisInput& state = cycle_.axis_state(axis);
    record_.position[i] = state.position.count;
    record_.sense[i] = state.sense;
    record_.correction[i] = narrow(clamp<std::int64_t>(cycle_.written(axis).count, INT32_MIN, INT32_MAX));
  }
  for (std::size_t i = 0; i < options_.wiring.inputs.size(); ++i)
    record_.input[i] = cycle_.input_value(static_cast<std::uint32_t>(i)).count;
  record_.feed_nm_per_min = cycle_.path().feed.count;
  record_.mode = static_cast<std::uint8_t>(report.mode);
  record_.fault = static_cast<std::uint8_t>(report.latched);
  record_.holding = cycle_.holding() ? 1 : 0;
  publish_state();
  exchange_.ticks.add(record_);
  publish_health();
  if (--until_equation_ == 0) {
    until_equation_ = kTicksPerEquation;
    publish_equation();
  }
}

void Service::publish_state() noexcept {
  const auto programs = static_cast<std::uint32_t>(cycle_.health().programs);
  if (programs != state_.programs) state_.since_us = record_.time_us;
  state_.programs = programs;
  state_.weight = static_cast<std::uint32_t>(cycle_.weight().count);
  record_.saturated = 0;
  for (std::uint32_t i = 0; i < options_.wiring.axes.size(); ++i) {
    state_.wanted[i] = narrow(clamp<std::int64_t>(cycle_.wanted(i).count, INT32_MIN, INT32_MAX));
    state_.achieved[i] = narrow(clamp<std::int64_t>(cycle_.achieved(i).count, INT32_MIN, INT32_MAX));
    state_.axis_weight[i] = cycle_.axis_weight(i).count;
    state_.limits[i] = cycle_.limits(i);
    const bool held = (cycle_.limits(i) & (kAtImageLimit | kAtBoardLimit | kAtOutputLimit)) != 0;
    record_.saturated = static_cast<std::uint8_t>(record_.saturated | (held ? 1u << i : 0u));
  }
  exchange_.state.publish(state_);
}

void Service::publish_equation() noexcept {
  equation_.programs = static_cast<std::uint32_t>(cycle_.health().programs);
  cycle_.equation_state(equation_.state);
  exchange_.equation.publish(equation_);
}

void Service::publish_health() noexcept {
  const Health& h = cycle_.health();
  HealthRecord& r = health_;
  r.ticks = h.ticks, r.active_ticks = h.active_ticks, r.overruns = h.overruns, r.skipped = h.skipped;
  r.missing_readings = h.missing_readings, r.missing_inputs = h.missing_inputs;
  r.frozen_readings = h.frozen_readings, r.jumps = h.jumps, r.unreferenced = h.unreferenced;
  r.implausible = h.implausible, r.failed_writes = h.failed_writes, r.saturated = h.saturated;
  r.slewing = h.slewing, r.beyond_range = h.beyond_range, r.faults = h.faults;
  r.refused_commands = h.refused_commands, r.programs = h.programs;
  const TickTimes& times = runner_.times();
  r.latency_ns[3] = times.latency.max_ns(), r.execution_ns[3] = times.execution.max_ns();
  if (--until_percentile_ == 0) {
    until_percentile_ = kTicksPerPercentile;
    const bool of_latency = percentile_ < 3;
    const std::uint32_t which = of_latency ? percentile_ : percentile_ - 3;
    const Histogram& histogram = of_latency ? times.latency : times.execution;
    (of_latency ? r.latency_ns : r.execution_ns)[which] = histogram.percentile_ns(kPerMillion[which]);
    percentile_ = percentile_ < 5 ? percentile_ + 1 : 0;
  }
  exchange_.health.publish(r);
}

// The values that a hold kept are lost: a start after a hold waits for an operator, as after a deactivation.
// So does a start with an image that may be one that was replaced.
void Service::restore() noexcept {
  const OperatorState state = operator_.load();
  const bool known = state.fault < kFaultCount;
  taken_out_ = state.out != 0 || state.holding != 0 || !known || uploader_.damaged();
  if (known && state.fault != 0) {
    cycle_.restore(static_cast<Fault>(state.fault));
    activated_ = true;  // before the fault: clearing the fault does not activate
  }
  publish_operator();
}

void Service::publish_operator() noexcept {
  const std::uint32_t out = taken_out_ ? 1u : 0u, holding = cycle_.holding() ? 1u << 8 : 0u;
  exchange_.operator_said.store(out | holding | static_cast<std::uint32_t>(cycle_.latched()) << 16,
                                std::memory_order_release);
}

UploadResult Service::boot() {
  const UploadResult result = uploader_.boot();
  restore();
  guard();
  return result;
}

UploadResult Service::boot_with(std::span<const std::uint8_t> image) {
  const UploadResult result = uploader_.boot_with(image);
  restore();
  guard();
  return result;
}

// Wakes the links once for the newest setting: earlier ones are stored with it.
bool Service::tell_settings() noexcept {
  const std::uint32_t asked = settings_asked_.load(std::memory_order_acquire);
  if (asked == settings_told_.load(std::memory_order_relaxed)) return false;
  const SettingTicket newest{.ticks = asked};
  const bool refused = operator_.refused() && newest.reached_by(operator_.refused_ticks());
  if (!newest.reached_by(operator_.stored_ticks()) && !refused) return false;
  settings_told_.store(asked, std::memory_order_relaxed);
  return true;
}

bool Service::look_after_store() noexcept {
  uploader_.look_after_store();
  operator_.save();
  if (uploader_.damaged() && (exchange_.operator_said.load(std::memory_order_acquire) & 1) == 0)
    uploader_.repair();
  const bool told = tell_settings();
  if (!desk_.asked()) return told;
  if (!answered_) answer_size_ = link_.answer(desk_.request(), desk_.size(), desk_.reply(), now());
  // An image is reverted when the tick has been offered another one, shortly after the command.
  answered_ =
      desk_.request()[0] == static_cast<std::uint8_t>(LinkOp::kRevert) && uploader_.programs().giving_up();
  if (answered_) return told;
  desk_.done(answer_size_);
  return true;
}

void Service::look_after_programs() noexcept {
  guard();
  look_after_store();
}

HalFault Service::serve(CommandLink& link, TimeUs wait, const LinkRights& rights) noexcept {
  rights_ = rights;
  caller_ = {reinterpret_cast<std::uintptr_t>(&link), 0};
  if (options_.store_beside) return link.serve(*this, wait);
  look_after_programs();
  const HalFault fault = link.serve(*this, wait);
  look_after_programs();
  return fault;
}

std::uint32_t Service::answer(const std::uint8_t* request, std::uint32_t size, std::uint8_t* reply) {
  signed_ = false;
  if (Gate::is_challenge(request, size)) {
    const ChallengeReply challenge = gate_.challenge(rights_.access, caller_, now());
    std::memcpy(reply + kReplyHeaderBytes, &challenge, sizeof(challenge));
    return Link::answer_with(LinkStatus::kDone, request, reply) +
           static_cast<std::uint32_t>(sizeof(challenge));
  }
  if (Gate::is_identify(request, size)) {
    IdentifyReply proof{};
    const LinkStatus status = gate_.identify(request, size, proof);
    const std::uint32_t head = Link::answer_with(status, request, reply);
    if (status != LinkStatus::kDone) return head;
    std::memcpy(reply + kReplyHeaderBytes, &proof, sizeof(proof));
    return head + static_cast<std::uint32_t>(sizeof(proof));
  }
  // Before the signature is tested: a request that is refused now is sent again unchanged, with its signature
  // not yet used.
  const bool may_need_store = options_.store_beside && Link::may_need_store(request, size);
  if (may_need_store && !desk_.free()) return Link::answer_busy(request, reply);
  const Gate::Opened opened = gate_.open(request, size, rights_.access, caller_, now());
  signed_ = opened.is_signed;
  if (opened.status != LinkStatus::kDone) return Link::answer_with(opened.status, request, reply);
  if (!may_need_store || !Link::needs_store(opened.request, opened.size)) {
    const std::uint32_t answered = link_.answer(opened.request, opened.size, reply, now());
    // A reply repeats the request, including its cover.
    if (answered > 0) reply[0] = request[0];
    const bool done = answered > 0 && reply[2] == static_cast<std::uint8_t>(LinkStatus::kDone);
    if (!done || !options_.store_beside || !Link::is_setting(opened.request, opened.size)) return answered;
    return leave_setting(reply[0], reply[1]);
  }
  ticket_ = desk_.leave(opened.request, opened.size, request[0]);
  return kLater;
}

CommandGiven Service::give(std::uint16_t command) {
  if (!gate_.lets_plain_commands(rights_.access, rights_.plain_commands)) return CommandGiven::kRefused;
  if (command >= kCommandCount || link_.give(static_cast<std::uint8_t>(command)) != LinkStatus::kDone)
    return CommandGiven::kRefused;
  if (!options_.store_beside) return CommandGiven::kTaken;
  leave_setting(0, 0);
  return CommandGiven::kLater;
}

// The tick that runs now may have looked for commands already; the next one takes it, and is over two counts
// later.
std::uint32_t Service::leave_setting(std::uint8_t op, std::uint8_t sequence) noexcept {
  const std::uint32_t ticks = static_cast<std::uint32_t>(exchange_.ticks.count()) + 2;
  ticket_ = SettingTicket{op, sequence, ticks}.packed();
  // Before the first tick nothing was stored yet.
  if (stored_seen_at_ == TimeUs{}) stored_seen_at_ = now();
  settings_asked_.store(ticks, std::memory_order_release);
  return kLater;
}

std::uint32_t Service::later(std::uint32_t ticket, std::uint8_t* reply) {
  if (!SettingTicket::is_one(ticket)) return desk_.collect(ticket, reply);
  const auto ticks = static_cast<std::uint32_t>(exchange_.ticks.count());
  return setting_stored(SettingTicket::unpacked(ticket, ticks), reply);
}

std::uint32_t Service::setting_stored(const SettingTicket& setting, std::uint8_t* reply) noexcept {
  const std::uint32_t stored = operator_.stored_ticks();
  if (stored != stored_seen_) stored_seen_ = stored, stored_seen_at_ = now();
  const bool done = setting.reached_by(stored);
  const bool refused = operator_.refused() && setting.reached_by(operator_.refused_ticks());
  if (!done && !refused && now() - stored_seen_at_ < kStoreDeadline) return kLater;
  if (setting.op == 0) {
    reply[0] = done ? 0 : 1;
    return 1;
  }
  const std::uint8_t head[] = {setting.op, setting.sequence};
  return Link::answer_with(done ? LinkStatus::kDone : LinkStatus::kNotStored, head, reply);
}

}  // namespace vernier
