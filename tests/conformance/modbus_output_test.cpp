// SPDX-License-Identifier: GPL-3.0-or-later
// Corrections as registers of a controller: values to the digit, and what a controller does that is gone,
// stuck or late. The controller is libmodbus's server; tests/board/plc has another one.
#include "hal/linux/modbus/modbus_output.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

#include "tests/conformance/line_disturber.h"
#include "tests/conformance/plc.h"

namespace vernier::modbus_output_test {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr std::int64_t kStep = 200;  // nm in a tick
constexpr auto kTick = 1ms, kPeriod = 5ms, kTimeout = 60ms;
/// Detection: the time-out, an answer that does not come (half the time-out), and two exchanges; and what a
/// busy computer adds.
constexpr auto kDetected = kTimeout + kTimeout / 2 + 2 * kPeriod + 150ms;

ModbusOutputSettings settings() {
  ModbusOutputSettings made;
  made.address = Plc::kBlock;
  made.echo = Plc::kEcho;
  made.period = TimeUs(5'000);
  made.timeout = TimeUs(60'000);
  AnalogueScale scale;  // 10 nm in a count, 1 mm at most
  scale.codes = 1'000'000, scale.span = 10'000'000;
  scale.zero = 1 << 30, scale.low = scale.zero - 100'000, scale.high = scale.zero + 100'000;
  made.axes = {{scale, 0, kStep}, {scale, 2, kStep}};
  return made;
}

std::unique_ptr<ModbusOutput> open(const Plc& plc, std::string& error,
                                   const ModbusOutputSettings& how = settings()) {
  const TimeUs wait = ModbusOutput::wait_for_answer(how.timeout, !plc.path().empty());
  auto line = plc.path().empty() ? ModbusLine::tcp("127.0.0.1", plc.port(), wait, error)
                                 : ModbusLine::rtu(plc.path(), 115200, 'N', wait, error);
  return line ? ModbusOutput::open(line, how, error) : nullptr;
}

/// Ticks that move axis 0 towards a target, as a board does: a refused value is repeated.
class Ticks {
 public:
  explicit Ticks(ModbusOutput& output) : output_(output), due_(Clock::now()) {}
  HalFault step(std::int64_t target) {
    due_ = std::max(due_ + kTick, Clock::now() - 20ms);
    std::this_thread::sleep_until(due_);
    const std::int64_t next = repeat_ ? pending_ : std::clamp(target, written_ - kStep, written_ + kStep);
    const auto began = Clock::now();
    const HalFault fault = output_.write_correction(0, AxisTravel(next));
    took_.push_back(Clock::now() - began);
    output_.write_correction(1, AxisTravel(-next));
    repeat_ = fault != HalFault::kNone;
    pending_ = next;
    if (!repeat_) written_ = next;
    asked_.push_back({Clock::now(), next});
    return fault;
  }
  void run(std::chrono::milliseconds time, std::int64_t target) {
    for (const auto end = Clock::now() + time; Clock::now() < end;) step(target);
  }
  /// Time until a write is refused.
  std::chrono::milliseconds until_refused(std::int64_t target) {
    const auto began = Clock::now();
    while (step(target) == HalFault::kNone && Clock::now() - began < 2s) {
    }
    return std::chrono::duration_cast<std::chrono::milliseconds>(Clock::now() - began);
  }
  std::int64_t written() const { return written_; }
  const auto& asked() const { return asked_; }
  Clock::duration slow_write() {  // of a hundred, the slowest but one
    std::sort(took_.begin(), took_.end());
    return took_[took_.size() * 99 / 100];
  }

 private:
  ModbusOutput& output_;
  Clock::time_point due_;
  std::int64_t written_ = 0, pending_ = 0;
  bool repeat_ = false;
  std::vector<Clock::duration> took_;
  std::vector<std::pair<Clock::time_point, std::int64_t>> asked_;
};

/// Largest change of a value from one valid block to the next; the controller ramps out without a valid bit,
/// so that a first valid block counts from zero.
std::int64_t largest_step(const std::vector<Plc::Block>& blocks) {
  std::int64_t largest = 0, before = 0;
  for (const Plc::Block& block : blocks) {
    const std::int64_t now = (block.valid & 1) != 0 ? block.values[0] : 0;
    if ((block.valid & 1) != 0) largest = std::max(largest, std::abs(now - before));
    before = now;
  }
  return largest;
}
/// Of two periods: kStep in each of ten ticks, in counts of 10 nm, and a rounding for each period.
constexpr std::int64_t kMostStep = 2 * (kStep * 5 / 10 + 1);

/// No value is wrong, however busy the computer is. Returns whether nine tenths of the blocks were valid, and
/// nine tenths of these the correction of a tick shortly before.
bool equal_and_in_time(Plc& plc, std::chrono::milliseconds most_late) {
  std::string error;
  const auto output = open(plc, error);
  EXPECT_NE(output, nullptr) << error;
  if (!output) return false;
  Ticks ticks(*output);
  ticks.run(60ms, 0);
  plc.forget();
  for (int i = 0; i < 2000; ++i) ticks.step(static_cast<std::int64_t>(20'000 * std::sin(i / 150.0)));
  const auto blocks = plc.blocks();
  std::size_t valid = 0, equal = 0;
  std::int32_t before = 0;
  for (const Plc::Block& block : blocks) {
    if ((block.valid & 1) == 0) continue;
    ++valid;
    // GIVEN a block WHEN it came THEN its value is the correction of an earlier tick, to the digit
    const auto asked_since = [&](Clock::time_point begin) {
      return std::any_of(ticks.asked().begin(), ticks.asked().end(), [&](const auto& asked) {
        const std::int64_t counts = (std::abs(asked.second) + 5) / 10 * (asked.second < 0 ? -1 : 1);
        return asked.first >= begin && asked.first <= block.when + kTick && counts == block.values[0];
      });
    };
    // or, after an exchange that was late, a value on the way that the limit of two periods gives.
    const bool limited = std::abs(block.values[0] - before) >= kMostStep / 2;
    EXPECT_TRUE(limited || asked_since({})) << block.values[0];
    equal += !limited && asked_since(block.when - most_late) ? 1 : 0;
    before = block.values[0];
    EXPECT_LE(std::abs(block.values[0] + block.values[2]), kStep / 10) << "the other axis, a tick apart";
    EXPECT_EQ(block.values[1], 0) << "a place without an axis";
  }
  EXPECT_LE(largest_step(blocks), kMostStep);
  EXPECT_LT(ticks.slow_write(), 200us) << "a tick waits for nothing";
  std::printf("%s\n", output->account().c_str());
  return valid > blocks.size() * 9 / 10 && equal > valid * 9 / 10;
}

void expect_equal_and_in_time(Plc& plc, std::chrono::milliseconds most_late) {
  constexpr int kTries = 5;  // a busy computer can be late
  bool in_time = false;
  for (int k = 0; k < kTries && !in_time; ++k) in_time = equal_and_in_time(plc, most_late);
  EXPECT_TRUE(in_time);
}

TEST(ModbusOutput, TcpRegistersAreTheCorrectionsOfTicksToTheDigit) {
  Plc plc;
  expect_equal_and_in_time(plc, 60ms);
}

TEST(ModbusOutput, RtuRegistersAreTheCorrectionsOfTicksToTheDigit) {
  Plc plc{Plc::Serial{}};
  expect_equal_and_in_time(plc, 80ms);
}

/// What follows every loss: no valid bit, zeros, and no step when the correction comes back.
void expect_return_without_a_step(Plc& plc, ModbusOutput& output, Ticks& ticks) {
  // GIVEN the correction that the board still has WHEN the controller is there again
  const std::int64_t held = ticks.written();
  EXPECT_GT(std::abs(held), 10 * kStep);
  ASSERT_TRUE(plc.wait_for_blocks(3));
  plc.forget();
  ticks.run(40ms, held);
  // THEN nothing is valid while the board has not come to zero
  for (const Plc::Block& block : plc.blocks()) {
    EXPECT_EQ(block.valid & 1, 0);
    EXPECT_EQ(block.values[0], 0);
  }
  const auto began = Clock::now();
  while (ticks.written() != 0 && Clock::now() - began < 2s) ticks.step(0);
  std::printf("from %lld nm to zero in %lld ms\n", static_cast<long long>(held),
              static_cast<long long>(
                  std::chrono::duration_cast<std::chrono::milliseconds>(Clock::now() - began).count()));
  ticks.run(60ms, 0);
  plc.forget();
  ticks.run(200ms, 20'000);
  EXPECT_EQ(plc.blocks().back().valid & 1, 1);
  EXPECT_GT(plc.blocks().back().values[0], 1000);
  EXPECT_LE(largest_step(plc.blocks()), kMostStep);
  EXPECT_EQ(output.attempt(0), "");
}

class ModbusOutputLoss : public testing::Test {
 protected:
  ModbusOutputLoss() : output_(open(plc_, error_)) {}
  void SetUp() override {
    ASSERT_NE(output_, nullptr) << error_;
    ticks_ = std::make_unique<Ticks>(*output_);
    ticks_->run(60ms, 0);
    ticks_->run(200ms, 20'000);
    ASSERT_EQ(plc_.blocks().back().valid & 1, 1);
  }
  void report(const char* what, std::chrono::milliseconds detected) {
    EXPECT_LE(detected, kDetected);
    std::printf("%s: refused after %lld ticks, largest step %lld counts of 10 nm\n", what,
                static_cast<long long>(detected.count()),
                static_cast<long long>(largest_step(plc_.blocks())));
    EXPECT_LE(largest_step(plc_.blocks()), kMostStep);
  }
  Plc plc_;
  std::string error_;
  std::unique_ptr<ModbusOutput> output_;
  std::unique_ptr<Ticks> ticks_;
};

TEST_F(ModbusOutputLoss, StuckEchoIsDetectedAndNothingStaysValid) {
  plc_.stuck = true;
  report("stuck echo", ticks_->until_refused(20'000));
  ASSERT_TRUE(plc_.wait_for_blocks(2));
  EXPECT_EQ(plc_.blocks().back().valid & 1, 0);
  EXPECT_EQ(plc_.blocks().back().values[0], 0);
  EXPECT_EQ(ticks_->step(20'000), HalFault::kRefused);
  plc_.stuck = false;
  expect_return_without_a_step(plc_, *output_, *ticks_);
}

TEST_F(ModbusOutputLoss, PeerThatIsGoneIsDetectedAndComesBackWithoutAStep) {
  plc_.gone = true;
  report("peer gone", ticks_->until_refused(20'000));
  ticks_->run(150ms, 20'000);
  plc_.gone = false;
  expect_return_without_a_step(plc_, *output_, *ticks_);
}

TEST_F(ModbusOutputLoss, AnswersThatAreTooLateAreALoss) {
  plc_.late_ms = 100;
  report("late answers", ticks_->until_refused(20'000));
  plc_.late_ms = 0;
  expect_return_without_a_step(plc_, *output_, *ticks_);
}

TEST_F(ModbusOutputLoss, SlowAnswersDelayNoTickAndMakeNoLargerStep) {
  plc_.late_ms = 10;
  ticks_->run(400ms, -20'000);
  EXPECT_LT(ticks_->slow_write(), 200us);
  EXPECT_EQ(plc_.blocks().back().valid & 1, 1);
  EXPECT_LT(plc_.blocks().back().values[0], 0);
  EXPECT_LE(largest_step(plc_.blocks()), kMostStep);
}

// A board that begins while the controller is not ready must not believe that its correction is used.
TEST(ModbusOutputStart, CorrectionWithoutAValidBitDoesNotGrow) {
  Plc plc;
  std::string error;
  const auto output = open(plc, error);
  ASSERT_NE(output, nullptr) << error;
  EXPECT_EQ(output->write_correction(0, AxisTravel(1000)), HalFault::kRefused) << "no tick was at zero";
  EXPECT_EQ(output->write_correction(0, AxisTravel(0)), HalFault::kNone);
  Ticks ticks(*output);
  ticks.run(40ms, 0);
  EXPECT_EQ(ticks.step(1000), HalFault::kNone);
}

TEST_F(ModbusOutputLoss, ShortOutageIsNoLossAndMakesNoStep) {
  plc_.gone = true;
  ticks_->run(25ms, -20'000);
  plc_.gone = false;
  ticks_->run(200ms, -20'000);
  EXPECT_EQ(plc_.blocks().back().valid & 1, 1);
  EXPECT_EQ(plc_.blocks().back().values[0], -2000);
  EXPECT_LE(largest_step(plc_.blocks()), kMostStep);
}

/// A corrected axis behind a serial line with its usual values.
class ModbusOutputSerial : public testing::Test {
 protected:
  void SetUp() override {
    ModbusOutputSettings usual = settings();
    usual.period = TimeUs(20'000);
    usual.timeout = TimeUs(400'000);
    std::string error;
    output_ = open(plc_, error, usual);
    ASSERT_NE(output_, nullptr) << error;
    ticks_ = std::make_unique<Ticks>(*output_);
    ticks_->run(100ms, 0);
    ticks_->run(200ms, 20'000);
    ASSERT_EQ(plc_.blocks().back().valid & 1, 1);
  }
  Plc plc_{Plc::Serial{}};
  std::unique_ptr<ModbusOutput> output_;
  std::unique_ptr<Ticks> ticks_;
};

// A serial line has no number for each request: after a lost answer it is quiet until no late answer can
// come.
TEST_F(ModbusOutputSerial, LostAnswerIsNoLoss) {
  for (int lost = 0; lost < 4; ++lost) {
    plc_.lost_answers = 1;
    ticks_->run(500ms + 7ms * lost, 20'000);
    EXPECT_EQ(plc_.lost_answers, 0);
    EXPECT_EQ(plc_.blocks().back().valid & 1, 1) << "answer " << lost;
  }
  EXPECT_NE(output_->account().find(" 0 losses"), std::string::npos) << output_->account();
}

/// A fault of the line, and its effect on the board.
struct LineCase {
  enum class Effect {
    kNone,        // no fault: the correction continues
    kLoss,        // a fault within the time of the page
    kLossHeard,   // the same; and the requests arrive: the controller learns that nothing is valid
    kAnyOutcome,  // the fault comes by chance: no step, whether it is a loss or not
  };
  const char* name;
  LineDisturber::Fault fault;
  int ms;
  Effect effect;
};
using Line = LineDisturber::Fault;
using Effect = LineCase::Effect;
// An answer has 100 ms: a quarter of the time-out.
constexpr LineCase kLines[] = {{"bytes 5 ms apart", Line::kSlowBytes, 5, Effect::kNone},
                               {"bytes 15 ms apart", Line::kSlowBytes, 15, Effect::kLossHeard},
                               {"answers of another unit", Line::kOtherUnit, 0, Effect::kLossHeard},
                               {"bit errors in answers", Line::kBitErrors, 0, Effect::kAnyOutcome},
                               {"bit errors in requests", Line::kBitsOfRequests, 0, Effect::kAnyOutcome},
                               {"exceptions", Line::kException, 0, Effect::kLossHeard},
                               {"no answers", Line::kNoAnswer, 0, Effect::kLossHeard},
                               {"line cut", Line::kCutLine, 0, Effect::kLoss},
                               {"old answers", Line::kOldAnswers, 0, Effect::kLoss},
                               {"answers after 40 ms", Line::kLate, 40, Effect::kNone},
                               {"answers after 130 ms", Line::kLate, 130, Effect::kLossHeard},
                               {"answers after 210 ms", Line::kLate, 210, Effect::kLossHeard},
                               {"answers after 300 ms", Line::kLate, 300, Effect::kLossHeard},
                               {"answers after 450 ms", Line::kLate, 450, Effect::kLossHeard},
                               {"garbage before answers", Line::kGarbage, 0, Effect::kAnyOutcome},
                               {"answers without an end", Line::kCutAnswers, 0, Effect::kAnyOutcome},
                               {"answers twice", Line::kTwice, 0, Effect::kNone},
                               {"answers again after 2 ms", Line::kAgain, 2, Effect::kAnyOutcome},
                               {"answers again after 30 ms", Line::kAgain, 30, Effect::kAnyOutcome},
                               {"own echo", Line::kOwnEcho, 0, Effect::kLossHeard}};

/// Measures how late the computer lets a thread run that sleeps for a millisecond.
class Lateness {
 public:
  Lateness() : thread_([this] { run(); }) {}
  ~Lateness() { end(); }
  Lateness(const Lateness&) = delete;
  Lateness& operator=(const Lateness&) = delete;
  Clock::duration end() {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
    return most_;
  }

 private:
  void run() {
    while (!stop_) {
      const auto due = Clock::now() + 1ms;
      std::this_thread::sleep_until(due);
      most_ = std::max(most_, Clock::now() - due);
    }
  }
  Clock::duration most_{};
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

/// Expects that no valid value makes a step. Returns true if the outcome is that of the case. The outcome is
/// a matter of milliseconds: a busy computer can change it.
bool no_step_and_outcome_on(const LineCase& line) {
  SCOPED_TRACE(line.name);
  Plc plc{Plc::Serial{}};
  LineDisturber disturber(plc.path());
  ModbusOutputSettings usual = settings();
  usual.period = TimeUs(20'000), usual.timeout = TimeUs(400'000);
  const auto wait = TimeUs(ModbusOutput::wait_for_answer(usual.timeout, true));
  std::string error;
  const auto end = ModbusLine::rtu(disturber.path(), 115200, 'N', wait, error);
  if (!end) return false;
  const auto output = ModbusOutput::open(end, usual, error);
  if (!output) return false;
  Ticks ticks(*output);
  ticks.run(100ms, 0);
  ticks.run(200ms, 20'000);
  if ((plc.blocks().back().valid & 1) == 0) return false;
  // WHEN the line is disturbed while the correction moves
  disturber.ms = line.ms;
  disturber.fault = line.fault;
  const auto began = Clock::now();
  const auto since_began = [&](Clock::time_point when) {
    return std::chrono::duration_cast<std::chrono::milliseconds>(when - began);
  };
  auto lost = -1ms, heard = -1ms;
  for (int i = 0; Clock::now() - began < 1300ms; ++i)
    if (ticks.step(lost < 0ms ? (i / 300 % 2 == 0 ? -20'000 : 20'000) : 0) != HalFault::kNone && lost < 0ms)
      lost = since_began(Clock::now());
  for (const Plc::Block& block : plc.blocks())
    if ((block.valid & 1) == 0 && block.when > began && heard < 0ms) heard = since_began(block.when);
  const std::uint16_t valid = plc.blocks().back().valid;
  // WHEN the line is sound again
  disturber.fault = Line::kNone;
  for (int i = 0; i < 3000 && ticks.written() != 0; ++i) ticks.step(0);
  for (int i = 0; i < 3000 && (plc.blocks().back().valid & 1) == 0; ++i) ticks.step(0);
  ticks.run(300ms, 20'000);
  std::printf("%-24s fault after %4d ms, valid bit 0 after %4d ms, largest step %4d counts of 10 nm\n",
              line.name, static_cast<int>(lost.count()), static_cast<int>(heard.count()),
              static_cast<int>(largest_step(plc.blocks())));
  // THEN no valid value makes a step, whatever came over the line
  EXPECT_LE(largest_step(plc.blocks()), 2 * (kStep * 20 / 10 + 1));
  // AND the correction comes back, and the outcome is the one of the page
  if ((plc.blocks().back().valid & 1) == 0 || plc.blocks().back().values[0] <= 1000) return false;
  constexpr auto kBusy = 150ms, kMost = 400ms + 200ms + 20ms + kBusy;
  if (line.effect == Effect::kAnyOutcome) return true;
  if (line.effect == Effect::kNone) return lost < 0ms && (valid & 1) == 1;
  if (lost < 0ms || lost > kMost) return false;
  // The line is quiet for 100 ms before the next request.
  return line.effect != Effect::kLossHeard ||
         (heard >= 0ms && heard <= lost + 100ms + 20ms + kBusy && (valid & 1) == 0);
}

/// Each try expects that no value makes a step. The outcome must be that of the case in one of the tries,
/// unless the computer was late in all: a late answer is then a fault of the computer.
void expect_no_step_and_outcome_on(const LineCase& line) {
  constexpr int kTries = 5;
  // An answer of "bytes 5 ms apart" takes 45 ms of its 100 ms, and three threads hand it on.
  constexpr auto kInTime = 15ms;
  bool as_expected = false, in_time = false;
  for (int k = 0; k < kTries && !as_expected; ++k) {
    Lateness lateness;
    as_expected = no_step_and_outcome_on(line);
    in_time = lateness.end() < kInTime || in_time;
  }
  if (!as_expected && !in_time) std::printf("%s: the computer was late in each try\n", line.name);
  EXPECT_TRUE(as_expected || !in_time) << line.name;
}

TEST(ModbusOutputLine, NoFaultOfASerialLineMakesAStep) {
  constexpr std::size_t kTogether = 7;  // each case waits most of its time
  for (std::size_t first = 0; first < std::size(kLines); first += kTogether) {
    std::vector<std::thread> threads;
    for (std::size_t i = first; i < std::min(first + kTogether, std::size(kLines)); ++i)
      threads.emplace_back([i] { expect_no_step_and_outcome_on(kLines[i]); });
    for (std::thread& one : threads) one.join();
  }
}

// The requests arrive: the controller must not keep a block that is valid.
TEST_F(ModbusOutputSerial, ControllerThatOnlyHearsLearnsThatNothingIsValid) {
  plc_.lost_answers = 1'000'000;
  ticks_->run(1500ms, 20'000);
  EXPECT_EQ(plc_.blocks().back().valid, 0);
  EXPECT_EQ(plc_.blocks().back().values[0], 0);
  plc_.lost_answers = 0;
  while (ticks_->written() != 0) ticks_->step(0);
  ticks_->run(400ms, 0);
  ticks_->run(400ms, 20'000);
  EXPECT_EQ(plc_.blocks().back().valid & 1, 1);
}

// The outage is no loss, but the controller has lost its block: it applies nothing, so that the board begins
// at zero as well.
TEST_F(ModbusOutputLoss, RestartOfTheControllerWithinTheTimeOutMakesNoStep) {
  ticks_->run(200ms, 20'000);
  plc_.forgets = true;
  plc_.gone = true;
  ticks_->run(20ms, 20'000);
  const std::size_t before = plc_.blocks().size();
  plc_.gone = false;
  ticks_->run(400ms, 20'000);
  const auto blocks = plc_.blocks();
  ASSERT_GT(blocks.size(), before);
  // The first block after the restart is not valid, and no valid one is far from zero.
  EXPECT_EQ(blocks[before].valid & 1, 0);
  std::vector<Plc::Block> since(blocks.begin() + static_cast<std::ptrdiff_t>(before), blocks.end());
  EXPECT_LE(largest_step(since), kMostStep);
  expect_return_without_a_step(plc_, *output_, *ticks_);
}

/// Largest change of a value from block to block, with and without a valid bit; before: of the first block.
std::int64_t largest_change(const std::vector<Plc::Block>& blocks, std::size_t place, std::int64_t before) {
  std::int64_t largest = 0;
  for (const Plc::Block& block : blocks) {
    largest = std::max(largest, std::abs(block.values[place] - before));
    before = block.values[place];
  }
  return largest;
}

// A start wrote zeros over the correction that a killed daemon had left.
TEST(ModbusOutputLeftOver, GoesToZeroWithinTheLimitAndWithoutAValidBit) {
  Plc plc;
  plc.leave(0, 2000), plc.leave(2, -1000);
  std::string error;
  const auto output = open(plc, error);
  ASSERT_NE(output, nullptr) << error;
  AxisTravel x, y;
  ASSERT_EQ(output->read_back(0, x), HalFault::kNone);
  ASSERT_EQ(output->read_back(1, y), HalFault::kNone);
  EXPECT_EQ(x, AxisTravel(20'000));
  EXPECT_EQ(y, AxisTravel(-10'000));
  EXPECT_EQ(output->read_back(2, y), HalFault::kNoDevice);
  ASSERT_TRUE(plc.wait_for_blocks(3));
  EXPECT_EQ(plc.blocks().back().values[0], 2000) << "nothing moves the value before a tick does";
  // WHEN ticks move the values to zero, in turn
  auto due = Clock::now();
  for (const std::uint32_t axis : {0u, 1u})
    for (std::int64_t left = axis == 0 ? 20'000 : -10'000; left != 0;) {
      left -= std::clamp(left, -kStep, kStep);
      ASSERT_EQ(output->write_correction(axis, AxisTravel(left)), HalFault::kNone);
      std::this_thread::sleep_until(due += kTick);
    }
  Ticks ticks(*output);
  ticks.run(60ms, 0);
  // THEN no block changes a value by more than two periods do, and no value has a valid bit before its zero
  EXPECT_LE(largest_change(plc.blocks(), 0, 2000), kMostStep);
  EXPECT_LE(largest_change(plc.blocks(), 2, -1000), kMostStep);
  for (const Plc::Block& block : plc.blocks()) {
    EXPECT_TRUE((block.valid & 1) == 0 || block.values[0] == 0) << block.values[0];
    EXPECT_TRUE((block.valid & 4) == 0 || block.values[2] == 0) << block.values[2];
  }
  EXPECT_EQ(plc.blocks().back().valid, 5);
  plc.forget();
  ticks.run(200ms, 20'000);
  EXPECT_GT(plc.blocks().back().values[0], 1000) << "and corrections follow";
  EXPECT_LE(largest_step(plc.blocks()), kMostStep);
}

// `vernierd --check` moves nothing.
TEST(ModbusOutputLeftOver, StaysInItsRegisterWithoutATick) {
  Plc plc;
  plc.leave(0, 2000);
  std::string error;
  auto output = open(plc, error);
  ASSERT_NE(output, nullptr) << error;
  EXPECT_EQ(output->attempt(0), "");
  output.reset();
  std::this_thread::sleep_for(20ms);
  EXPECT_EQ(largest_change(plc.blocks(), 0, 2000), 0);
  EXPECT_EQ(plc.blocks().back().valid, 0);
}

// `vernierd --zero` ends when it has written the zero.
TEST(ModbusOutputLeftOver, EndWaitsForTheZeroThatWasWritten) {
  Plc plc;
  plc.leave(0, 2000);
  std::string error;
  auto output = open(plc, error);
  ASSERT_NE(output, nullptr) << error;
  for (std::int64_t left = 20'000; left > 0;) {
    left -= kStep;
    output->write_correction(0, AxisTravel(left));
    std::this_thread::sleep_for(kTick);  // a late tick is not made up for: two at once would be a step
  }
  output.reset();
  const auto latest = Clock::now() + 5s;
  while (plc.blocks().back().values[0] != 0 && Clock::now() < latest) std::this_thread::sleep_for(kTick);
  EXPECT_EQ(plc.blocks().back().values[0], 0);
  EXPECT_EQ(plc.blocks().back().valid, 0);
  EXPECT_LE(largest_change(plc.blocks(), 0, 2000), kMostStep);
}

// A loss of the controller in the middle of the way changes nothing about the way.
TEST(ModbusOutputLeftOver, ALossOnItsWayMakesNoStep) {
  Plc plc;
  plc.leave(0, 2000);
  std::string error;
  const auto output = open(plc, error);
  ASSERT_NE(output, nullptr) << error;
  const auto began = Clock::now();
  for (std::int64_t left = 20'000; left > 0; left -= 20) {
    plc.stuck = Clock::now() > began + 300ms && Clock::now() < began + 500ms;
    output->write_correction(0, AxisTravel(left));
    std::this_thread::sleep_for(kTick);
  }
  EXPECT_LE(largest_change(plc.blocks(), 0, 2000), kMostStep);
  EXPECT_LT(plc.blocks().back().values[0], 1000);
  for (const Plc::Block& block : plc.blocks()) EXPECT_EQ(block.valid & 1, 0);
}

// Registers that had another use, or a board file with a smaller range.
TEST(ModbusOutputLeftOver, BeyondTheRangeBeginsAtItsEnd) {
  Plc plc;
  plc.leave(0, INT32_MIN), plc.leave(2, 100'001);
  std::string error;
  const auto output = open(plc, error);
  ASSERT_NE(output, nullptr) << error;
  AxisTravel x, y;
  output->read_back(0, x), output->read_back(1, y);
  EXPECT_EQ(x, AxisTravel(-1'000'000));
  EXPECT_EQ(y, AxisTravel(1'000'000));
}

// The first board may have the longest period that a board file allows.
TEST(ModbusOutputStart, SecondBoardIsRefusedBesideASlowOne) {
  Plc plc;
  std::string error;
  ModbusOutputSettings slow = settings();
  slow.period = TimeUs(50'000);
  slow.timeout = TimeUs(400'000);
  const auto first = open(plc, error, slow);
  ASSERT_NE(first, nullptr) << error;
  EXPECT_EQ(open(plc, error), nullptr);
  EXPECT_NE(error.find("another board writes"), std::string::npos) << error;
}

TEST_F(ModbusOutputLoss, TicksThatStandStillLeaveNothingValid) {
  std::this_thread::sleep_for(kDetected);
  EXPECT_EQ(plc_.blocks().back().valid & 1, 0);
  EXPECT_EQ(ticks_->step(20'000), HalFault::kRefused) << "the tick learns of it";
  expect_return_without_a_step(plc_, *output_, *ticks_);
}

// Everything of the process stands still, as in a debugger or under load: the controller has removed the
// correction meanwhile. One block can be on its way.
TEST_F(ModbusOutputLoss, StandstillOfTheProcessLeavesNothingValid) {
  ticks_->run(200ms, 20'000);
  ASSERT_EQ(plc_.blocks().back().valid & 1, 1);
  const auto before = Clock::now();
  const pid_t here = getpid(), child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    kill(here, SIGSTOP);
    std::this_thread::sleep_for(2 * kTimeout);
    kill(here, SIGCONT);
    _exit(0);
  }
  ticks_->run(300ms, 20'000);
  ASSERT_EQ(waitpid(child, nullptr, 0), child);
  std::size_t after = 0, valid = 0;
  auto newest = before;
  for (const Plc::Block& block : plc_.blocks()) {
    if (after == 0 && block.when - newest < kTimeout) {
      newest = std::max(newest, block.when);
      continue;
    }
    ++after;
    valid += (block.valid & 1) != 0 && block.values[0] != 0 ? 1 : 0;
  }
  EXPECT_GT(after, 10u);
  EXPECT_LE(valid, 1u);
  expect_return_without_a_step(plc_, *output_, *ticks_);
}

/// Another board at the same block of a controller.
class OtherBoard {
 public:
  static constexpr std::uint16_t kValue = 1900;
  explicit OtherBoard(const Plc& plc, std::uint16_t sequence = 40'000)
      : line_(ModbusLine::tcp("127.0.0.1", plc.port(), TimeUs(20'000), error_)), sequence_(sequence) {}
  bool write(std::chrono::milliseconds time) {
    bool all = true;
    longest_pause_ = {};
    auto before = Clock::now();
    for (const auto end = before + time; Clock::now() < end; std::this_thread::sleep_for(5ms)) {
      const std::uint16_t block[] = {++sequence_, 1, 0, kValue};
      all = line_->write(1, Plc::kBlock, 4, block) && all;
      const auto now = Clock::now();
      longest_pause_ = std::max(longest_pause_, now - before);
      before = now;
    }
    return all;
  }
  /// Writes until a busy computer made no pause in which this board may be taken for gone.
  bool write_without_a_pause(std::chrono::milliseconds time, const Plc& plc, std::size_t& from) {
    constexpr auto kTakenForGone = 4 * 50ms;  // four of the longest periods of a board
    bool all = true;
    for (const auto end = Clock::now() + 10s; Clock::now() < end;) {
      from = plc.blocks().size();
      all = write(time) && all;
      if (longest_pause_ < kTakenForGone / 2) return all;
    }
    ADD_FAILURE() << "the computer is too busy for this test";
    return false;
  }

 private:
  std::string error_;
  std::shared_ptr<ModbusLine> line_;
  std::uint16_t sequence_;
  Clock::duration longest_pause_{};
};
std::size_t blocks_beside(const std::vector<Plc::Block>& blocks, std::size_t from) {
  std::size_t count = 0;
  for (std::size_t i = from; i < blocks.size(); ++i)
    count += blocks[i].values[0] != OtherBoard::kValue ? 1 : 0;
  return count;
}

/// The numbers of the other board: anywhere, or behind those of this board as a block that was held back.
class AnotherBoard : public ModbusOutputLoss {
 protected:
  void expect_detected(OtherBoard other);
};
void AnotherBoard::expect_detected(OtherBoard other) {
  // A refused tick alone does not say that the other board was seen: on a busy computer ticks stand still.
  const auto seen = [&] {
    return output_->account().find(" 0 sequence numbers of another") == std::string::npos;
  };
  for (const auto end = Clock::now() + 2s; !seen() && Clock::now() < end;) {
    ASSERT_TRUE(other.write(25ms));
    ticks_->step(20'000);
  }
  ASSERT_TRUE(seen()) << output_->account();
  ASSERT_EQ(ticks_->step(20'000), HalFault::kRefused);
  std::size_t before = 0;
  ASSERT_TRUE(other.write_without_a_pause(400ms, plc_, before));
  EXPECT_EQ(blocks_beside(plc_.blocks(), before), 0u);
  EXPECT_EQ(ticks_->step(20'000), HalFault::kRefused);
  expect_return_without_a_step(plc_, *output_, *ticks_);
}

TEST_F(AnotherBoard, IsDetectedAndNotWrittenOver) { expect_detected(OtherBoard(plc_)); }
TEST_F(AnotherBoard, WithNumbersJustBehindIsDetected) {
  const auto newest = plc_.blocks().back().sequence;
  expect_detected(OtherBoard(plc_, static_cast<std::uint16_t>(newest - 500)));
}

// Another board may have begun while the controller could not be reached.
TEST_F(AnotherBoard, ThatBeganInALossIsNotWrittenOver) {
  plc_.stuck = true;
  ticks_->until_refused(20'000);
  OtherBoard other(plc_);
  ASSERT_TRUE(other.write(200ms));
  plc_.stuck = false;
  std::size_t before = 0;
  ASSERT_TRUE(other.write_without_a_pause(400ms, plc_, before));
  EXPECT_EQ(blocks_beside(plc_.blocks(), before), 0u);
  EXPECT_EQ(ticks_->step(20'000), HalFault::kRefused);
  expect_return_without_a_step(plc_, *output_, *ticks_);
}

// A board without an image writes nothing; its first image begins at zero, without a fault.
TEST(ModbusOutputStart, BoardThatBeginsLateIsNotRefused) {
  Plc plc;
  std::string error;
  const auto output = open(plc, error);
  ASSERT_NE(output, nullptr) << error;
  EXPECT_EQ(output->write_correction(0, AxisTravel(0)), HalFault::kNone);
  std::this_thread::sleep_for(kDetected);
  EXPECT_EQ(plc.blocks().back().valid, 0) << "no tick, nothing valid";
  Ticks ticks(*output);
  for (int i = 0; i < 60; ++i) EXPECT_EQ(ticks.step(0), HalFault::kNone);
  for (int i = 0; i < 60; ++i) EXPECT_EQ(ticks.step(20'000), HalFault::kNone);
  EXPECT_NE(output->account().find(" 0 losses"), std::string::npos) << output->account();
}

TEST_F(ModbusOutputLoss, EndOfTheBoardLeavesNothingValid) {
  output_.reset();
  std::this_thread::sleep_for(20ms);
  EXPECT_EQ(plc_.blocks().back().valid, 0);
  EXPECT_EQ(plc_.blocks().back().values[0], 0);
}

TEST_F(ModbusOutputLoss, SecondBoardIsRefused) {
  std::string error;
  EXPECT_EQ(open(plc_, error), nullptr);
  EXPECT_NE(error.find("another board writes"), std::string::npos) << error;
  EXPECT_EQ(ticks_->step(20'000), HalFault::kNone) << "the first one goes on";
}

TEST(ModbusOutputOpen, NamesWhatIsMissing) {
  std::string error;
  Plc plc;
  plc.stuck = true;
  EXPECT_EQ(open(plc, error), nullptr);
  EXPECT_NE(error.find("does not return the sequence number"), std::string::npos) << error;
  plc.gone = true;
  EXPECT_EQ(open(plc, error), nullptr);
  EXPECT_NE(error.find("gives no valid answer"), std::string::npos) << error;
  EXPECT_EQ(plc.blocks().back().valid, 0) << "nothing was valid";
}

TEST(ModbusOutputRange, BeyondTheRangeIsHeldAndCounted) {
  Plc plc;
  std::string error;
  const auto output = open(plc, error);
  ASSERT_NE(output, nullptr) << error;
  EXPECT_EQ(output->within_range(0, AxisTravel(5'000'000)), AxisTravel(1'000'000));
  EXPECT_EQ(output->within_range(0, AxisTravel(-5'000'000)), AxisTravel(-1'000'000));
  output->write_correction(0, AxisTravel(5'000'000));
  EXPECT_EQ(output->held_at_end(0), 1u);
  EXPECT_EQ(output->held_at_end(1), 0u);
  EXPECT_EQ(output->write_correction(2, AxisTravel(0)), HalFault::kNoDevice);
}

}  // namespace
}  // namespace vernier::modbus_output_test
