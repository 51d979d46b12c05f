// SPDX-License-Identifier: Apache-2.0
#include "hal/linux/modbus/modbus_output.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <random>

#include "hal/support/rounded_ratio.h"

namespace vernier {
namespace {

using Steady = std::chrono::steady_clock;
using std::chrono::microseconds;

constexpr std::size_t kDelayBins = 10'000;  // of 0.1 ms: one second
constexpr int kTries = 10;                  // of the first exchange
constexpr std::uint64_t kLookEvery = 4;     // exchanges
constexpr std::uint16_t kOwnBefore = 1024;  // numbers of this board, before the newest one
using Block = std::array<std::uint16_t, ModbusOutputSettings::kValues + 2 * ModbusOutputSettings::kPlaces>;
/// Another board writes at least once in its period. The sequence numbers of a start begin anywhere: those of
/// two boards are not neighbours.
constexpr std::chrono::milliseconds kLookForAnother(4 * ModbusOutputSettings::kLongestPeriod_ms);

std::int64_t ns_of(Steady::time_point when) {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(when.time_since_epoch()).count();
}
microseconds span_of(TimeUs time) { return microseconds(time.count); }

/// The delay below which a share of all delays is, ms.
double share_of(const std::vector<std::uint64_t>& bins, std::uint64_t all, double share) {
  std::uint64_t below = 0;
  for (std::size_t i = 0; i < bins.size(); ++i)
    if ((below += bins[i]) >= static_cast<std::uint64_t>(share * static_cast<double>(all)) && below > 0)
      return 0.1 * static_cast<double>(i + 1);
  return 0;
}

}  // namespace

ModbusOutput::ModbusOutput(std::shared_ptr<ModbusLine> line, const ModbusOutputSettings& settings)
    : line_(std::move(line)), settings_(settings), delays_(kDelayBins) {
  for (std::size_t k = 0; k < settings_.axes.size(); ++k) {
    const ModbusOutputSettings::Axis& axis = settings_.axes[k];
    converters_.emplace_back(axis.scale);
    // The correction changes by this in a period; one more, because both ends are rounded.
    const std::int64_t ticks = (settings_.period.count + settings_.tick.count - 1) / settings_.tick.count;
    const std::int64_t most = std::min<std::int64_t>(axis.most_per_tick, INT32_MAX) * ticks;
    places_[k].most_per_period = RoundedRatio(axis.scale.codes, axis.scale.span).of(most) + 1;
  }
}

std::unique_ptr<ModbusOutput> ModbusOutput::open(std::shared_ptr<ModbusLine> line,
                                                 const ModbusOutputSettings& settings, std::string& error) {
  std::unique_ptr<ModbusOutput> output(new ModbusOutput(std::move(line), settings));
  error = output->begin();
  if (!error.empty()) return nullptr;
  output->thread_ = std::thread([raw = output.get()] { raw->run(); });
  return output;
}

/// Empty, or the reason why the controller cannot be used.
std::string ModbusOutput::begin() {
  const auto look = [&](std::uint16_t& number) {
    for (int i = 0; i < kTries; ++i)
      if (line_->read(settings_.unit, ModbusLine::Registers::kHolding, settings_.address, 1, &number))
        return true;
    return false;
  };
  std::uint16_t before = 0, after = 0;
  if (!look(before))
    return "the controller gives no valid answer to a request for the block: " + line_->why();
  for (const auto end = Clock::now() + kLookForAnother; Clock::now() < end;) {
    std::this_thread::sleep_for(span_of(settings_.period));
    if (!look(after)) return "the controller gives no valid answer any more: " + line_->why();
    if (before != after) return "another board writes the sequence number of this block";
  }
  if (!take_left_overs()) return "the controller gives no valid answer any more: " + line_->why();
  found_ = before;
  sequence_ = kept_ = static_cast<std::uint16_t>(std::random_device{}());
  good_ = written_ = Clock::now();
  for (const auto end = Clock::now() + span_of(settings_.timeout) + std::chrono::seconds(1);
       !healthy_ && Clock::now() < end;) {
    exchange();
    std::this_thread::sleep_for(span_of(settings_.period));
  }
  if (healthy_) return "";
  return foreign_ > 0 ? "another board writes the sequence number of this block"
                      : "the controller does not return the sequence number; test whether its program runs";
}

/// Registers of the block, as far as the last place that has an axis.
int ModbusOutput::registers() const {
  int places = 0;
  for (const ModbusOutputSettings::Axis& axis : settings_.axes) places = std::max(places, axis.place + 1);
  return ModbusOutputSettings::kValues + 2 * places;
}

/// Each value begins where an earlier process left it. A value beyond the range of its axis is none of a
/// board with these settings: it begins at the end of the range. False: no answer.
bool ModbusOutput::take_left_overs() {
  Block block{};
  bool answered = false;
  for (int i = 0; i < kTries && !answered; ++i)
    answered = line_->read(settings_.unit, ModbusLine::Registers::kHolding, settings_.address, registers(),
                           block.data());
  for (std::size_t k = 0; k < settings_.axes.size() && answered; ++k) {
    const std::size_t at =
        ModbusOutputSettings::kValues + 2 * static_cast<std::size_t>(settings_.axes[k].place);
    const auto found =
        static_cast<std::int32_t>(std::uint32_t{block[at]} << 16 | std::uint32_t{block[at + 1]});
    const AnalogueScale& scale = settings_.axes[k].scale;
    places_[k].sent = static_cast<std::int32_t>(
        std::clamp<std::int64_t>(found, scale.low - scale.zero, scale.high - scale.zero));
    places_[k].wanted = places_[k].sent;
    places_[k].left_over = places_[k].sent != 0;
  }
  return answered;
}

HalFault ModbusOutput::read_back(std::uint32_t axis, AxisTravel& correction) noexcept {
  if (axis >= converters_.size()) return HalFault::kNoDevice;
  const AnalogueScale& scale = converters_[axis].scale();
  correction = scale.correction_of(scale.zero + places_[axis].wanted.load());
  return HalFault::kNone;
}

ModbusOutput::~ModbusOutput() {
  if (!thread_.joinable()) return;
  const auto on_its_way = [](const Place& one) { return one.left_over && one.wanted == 0; };
  for (const auto end = Clock::now() + span_of(settings_.timeout);
       Clock::now() < end && std::any_of(places_.begin(), places_.end(), on_its_way);)
    std::this_thread::sleep_for(span_of(settings_.period));
  stop_ = true;
  thread_.join();
  lose();
  exchange(true);
}

HalFault ModbusOutput::write_correction(std::uint32_t axis, AxisTravel correction) noexcept {
  if (axis >= converters_.size()) return HalFault::kNoDevice;
  Place& place = places_[axis];
  const std::int64_t code = converters_[axis].code_for(correction);
  place.held_at_end += converters_[axis].wanted_code(correction) != code ? 1 : 0;
  const auto wanted = static_cast<std::int32_t>(code - converters_[axis].scale().zero);
  stored_ns_.store(ns_of(Clock::now()));
  const bool lost = place.refuse.exchange(false) || !healthy_;
  // Without a valid bit a correction can only go to zero: no board believes that its correction is used.
  if (!lost && !place.valid && std::abs(wanted) > std::abs(place.wanted.load())) return HalFault::kRefused;
  place.wanted.store(wanted);
  return lost ? HalFault::kRefused : HalFault::kNone;
}

AxisTravel ModbusOutput::within_range(std::uint32_t axis, AxisTravel correction) const noexcept {
  if (axis >= converters_.size()) return AxisTravel{};
  const AnalogueScale& scale = converters_[axis].scale();
  const std::int64_t a = scale.correction_of(scale.low).count, b = scale.correction_of(scale.high).count;
  return AxisTravel(std::clamp(correction.count, std::min(a, b), std::max(a, b)));
}

bool ModbusOutput::ticks_run(Clock::time_point now) const {
  const std::int64_t stored = stored_ns_.load();
  return stored != INT64_MIN && ns_of(now) - stored < settings_.timeout.count * 1000;
}

// After the loss the controller removes the correction by its own ramp; the values are zero when the board
// comes back. A tick must learn of the loss of a correction; without one its board is at zero already. A
// value of an earlier process has no valid bit; it goes on from where it is.
void ModbusOutput::lose() {
  repeat_ = false;
  for (std::size_t k = 0; k < settings_.axes.size(); ++k) {
    Place& place = places_[k];
    if (place.valid && (place.sent != 0 || place.wanted != 0)) place.refuse = true;
    place.valid = false;
    if (!place.left_over) place.sent = 0;
  }
}

/// Values of the next block: within the change that ticks make in a period; after a late exchange, of two.
void ModbusOutput::choose_values(Clock::time_point now, bool ticks_are_on) {
  const double passed =
      std::max(1.0, std::chrono::duration<double>(now - written_) / span_of(settings_.period));
  for (std::size_t k = 0; k < settings_.axes.size(); ++k) {
    Place& place = places_[k];
    const std::int64_t wanted = place.wanted.load();
    // A left-over value has no valid bit: the controller does not use it, however slow the exchange is.
    const double periods = place.left_over ? passed : std::min(passed, 2.0);
    const auto most = static_cast<std::int64_t>(static_cast<double>(place.most_per_period) * periods);
    if (place.valid || place.left_over)
      place.sent = static_cast<std::int32_t>(std::clamp(wanted, place.sent - most, place.sent + most));
    place.left_over = place.left_over && place.sent != 0;
    if (!place.valid)
      place.valid = healthy_ && ticks_are_on && wanted == 0 && !place.left_over && !place.refuse;
  }
}

bool ModbusOutput::echo_is_new(std::uint16_t echo, Clock::time_point now) const {
  const auto behind = static_cast<std::uint16_t>(sequence_ - echo);
  return behind < sent_at_.size() && now - sent_at_[echo & 0xff] <= span_of(settings_.timeout);
}

void ModbusOutput::judge(bool answered, std::uint16_t echo, Clock::time_point now, bool ticks_are_on) {
  if (answered && echo_is_new(echo, now)) {
    good_ = std::max(good_, sent_at_[echo & 0xff]);
    healthy_ = true;
  }
  const bool in_use =
      std::any_of(places_.begin(), places_.end(), [](const Place& one) { return one.valid.load(); });
  const bool silent = now - good_ > span_of(settings_.timeout);
  if (!(silent && healthy_) && !(in_use && !ticks_are_on)) return;
  const bool corrects =
      std::any_of(places_.begin(), places_.end(), [](const Place& one) { return one.sent != 0; });
  if (silent) healthy_ = false;
  lose();
  const std::scoped_lock lock(guard_);
  losses_ += silent || corrects ? 1 : 0;
}

/// The block, or its echo, has a number of another writer, or of a controller that was restarted and applies
/// no correction.
void ModbusOutput::lose_controller() {
  for (Place& place : places_) place.left_over = false;
  lose();
  still_since_ = Clock::now();
  const std::scoped_lock lock(guard_);
  ++foreign_;
  losses_ += healthy_.exchange(false) ? 1 : 0;
}

/// Before a block is written: the block in the controller must have a number of this board, or one that
/// stands still. Without an answer only a block without valid bits is written: perhaps only the answers do
/// not arrive.
bool ModbusOutput::may_write(Clock::time_point began, bool ticks_are_on) {
  std::uint16_t now = 0;
  if (!line_->read(settings_.unit, ModbusLine::Registers::kHolding, settings_.address, 1, &now)) {
    {
      const std::scoped_lock lock(guard_);
      ++exchanges_, ++failed_;
    }
    judge(false, 0, Clock::now(), ticks_are_on);
    if (still_since_) still_since_ = Clock::now();
    if (!healthy_ && !still_since_) write_block(began);
    return false;
  }
  const bool ours = static_cast<std::uint16_t>(now - kept_) <= static_cast<std::uint16_t>(sequence_ - kept_);
  if (!still_since_ && ours) return true;
  // A block of this board that the network held back: the controller must not use it for longer. Only a write
  // without an answer leaves one, and only one; otherwise another board has numbers near those of this board.
  if (!still_since_ && now != found_ && unanswered_writes_ > 0 &&
      static_cast<std::uint16_t>(sequence_ - now) < kOwnBefore) {
    --unanswered_writes_;
    lose();
    const std::scoped_lock lock(guard_);
    losses_ += healthy_.exchange(false) ? 1 : 0;
    return true;
  }
  if (now != found_) {
    lose_controller();
    found_ = now;
    const std::scoped_lock lock(guard_);
    ++exchanges_;
    return false;
  }
  if (still_since_ && Clock::now() - *still_since_ < kLookForAnother) return false;
  still_since_.reset();
  kept_ = sequence_;
  return true;
}

/// Writes values and valid bits with a new sequence number. False: no answer.
bool ModbusOutput::write_block(Clock::time_point began) {
  Block block{};
  block[ModbusOutputSettings::kSequence] = ++sequence_;
  sent_at_[sequence_ & 0xff] = began;
  for (std::size_t k = 0; k < settings_.axes.size(); ++k) {
    const auto place = static_cast<std::size_t>(settings_.axes[k].place);
    const auto value = static_cast<std::uint32_t>(places_[k].sent);
    block[ModbusOutputSettings::kValues + 2 * place] = static_cast<std::uint16_t>(value >> 16);
    block[ModbusOutputSettings::kValues + 2 * place + 1] = static_cast<std::uint16_t>(value);
    if (places_[k].valid)
      block[ModbusOutputSettings::kValid] =
          static_cast<std::uint16_t>(block[ModbusOutputSettings::kValid] | 1u << place);
  }
  const bool written = line_->write(settings_.unit, settings_.address, registers(), block.data());
  unanswered_writes_ += written ? 0 : 1;
  return written;
}

void ModbusOutput::exchange(bool last) {
  const Clock::time_point began = Clock::now();
  const bool ticks_are_on = ticks_run(began);
  // A process that stood still may not write the values of before.
  if (!last) judge(false, 0, began, ticks_are_on);
  if (last && still_since_) return;
  // The echo alone can hide another writer: a fast controller returns each number at once.
  const bool look = unanswered_ || (!healthy_ && losses_ > 0) || still_since_ || exchanges_ % kLookEvery == 0;
  if (look && !last && !may_write(began, ticks_are_on)) return;
  const std::int64_t stored = stored_ns_.load();
  if (!repeat_ && !last) choose_values(began, ticks_are_on);
  const bool written = write_block(began);
  const Clock::time_point answered_at = Clock::now();
  if (written) written_ = began, kept_ = sequence_, found_.reset();
  repeat_ = !written;
  std::uint16_t echo = 0;
  const bool answered =
      written && line_->read(settings_.unit, ModbusLine::Registers::kHolding, settings_.echo, 1, &echo);
  unanswered_ = !answered;
  {
    const std::scoped_lock lock(guard_);
    ++exchanges_;
    failed_ += answered ? 0 : 1;
    if (written && ticks_are_on && stored != delayed_) {  // the first answer to this tick
      delayed_ = stored;
      const std::int64_t tenths = (ns_of(answered_at) - stored) / 100'000;
      ++delays_[static_cast<std::size_t>(std::clamp<std::int64_t>(tenths, 0, kDelayBins - 1))];
    }
  }
  // An echo that none of this board's blocks can have caused.
  if (answered && healthy_ && static_cast<std::uint16_t>(sequence_ - echo) >= sent_at_.size())
    return lose_controller();
  judge(answered, echo, Clock::now(), ticks_are_on);
}

void ModbusOutput::run() {
  for (auto due = Clock::now(); !stop_;) {
    exchange();
    due = std::max(due + span_of(settings_.period), Clock::now());
    std::this_thread::sleep_until(due);
  }
}

std::string ModbusOutput::attempt(std::uint32_t) {
  // The thread exchanges; the echo was new within the time-out.
  std::this_thread::sleep_for(span_of(settings_.timeout));
  return healthy_ ? "" : "the controller does not return the sequence number";
}

std::string ModbusOutput::trial() const {
  return "the check wrote blocks with valid bits 0 and the present values of the registers (at most the "
         "range); the controller removes its present correction";
}

std::string ModbusOutput::account() const {
  const std::scoped_lock lock(guard_);
  std::uint64_t all = 0;
  for (const std::uint64_t one : delays_) all += one;
  char text[400];
  std::snprintf(
      text, sizeof text,
      "modbus-out register %d: %llu exchanges, %llu failed, %llu losses, %llu sequence numbers of "
      "another writer; from the tick to the answer "
      "median %.1f ms, 99 %% %.1f ms, largest %.1f ms; each value then stays for one period, %.3g ms",
      settings_.address, static_cast<unsigned long long>(exchanges_),
      static_cast<unsigned long long>(failed_), static_cast<unsigned long long>(losses_),
      static_cast<unsigned long long>(foreign_), share_of(delays_, all, 0.5), share_of(delays_, all, 0.99),
      share_of(delays_, all, 1.0), 1e-3 * static_cast<double>(settings_.period.count));
  return text;
}

}  // namespace vernier
