// SPDX-License-Identifier: GPL-3.0-or-later
// Offsets of a CANopen drive: each SYNC takes the value of the tick before, and what the board does about a
// drive or a bus that fails. Joined sockets and a drive in this file; tests/board/drive has another one.
#include <gtest/gtest.h>
#include <linux/can/error.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <map>
#include <mutex>
#include <random>
#include <thread>
#include <vector>

#include "hal/linux/can/canopen_axes.h"
#include "hal/linux/can/canopen_output.h"
#include "tests/conformance/linux_devices.h"

namespace vernier::canopen_test {
namespace {

constexpr std::int64_t kMs = 1'000'000, kMost = 20;  // ns; counts of the object from one SYNC to the next
constexpr std::uint16_t kEnabled = 0x1637, kSwitchedOn = 0x1633, kFault = 0x1618, kQuickStop = 0x1617,
                        kFaultReaction = 0x161f;

can_frame frame(std::uint32_t id, std::initializer_list<int> bytes) {
  can_frame made{};
  made.can_id = id;
  for (const int byte : bytes) made.data[made.can_dlc++] = static_cast<std::uint8_t>(byte);
  return made;
}
can_frame status_frame(std::uint16_t status, std::int32_t position) {
  const auto p = static_cast<std::uint32_t>(position);
  return frame(0x381,
               {status & 0xff, status >> 8, static_cast<int>(p & 0xff), static_cast<int>(p >> 8 & 0xff),
                static_cast<int>(p >> 16 & 0xff), static_cast<int>(p >> 24)});
}
can_frame offset_frame(std::int32_t offset) {
  const auto o = static_cast<std::uint32_t>(offset);
  return frame(0x501, {static_cast<int>(o & 0xff), static_cast<int>(o >> 8 & 0xff),
                       static_cast<int>(o >> 16 & 0xff), static_cast<int>(o >> 24)});
}
can_frame emergency_frame(int code) { return frame(0x81, {code & 0xff, code >> 8, 1, 0, 0, 0, 0, 0}); }

CanopenSettings settings() {
  CanopenSettings made;
  made.parts_per_sync = kMost * CanopenSettings::kPartsOfCount;
  return made;
}

/// 0.1 um in a count, 1 mm at most.
AnalogueScale scale() {
  AnalogueScale made;
  made.codes = 1'000'000, made.span = 100'000'000;
  made.zero = 1 << 30, made.low = made.zero - 10'000, made.high = made.zero + 10'000;
  return made;
}

/// CiA 402: Operation enabled, Quick stop active, Fault reaction active.
bool has_torque(int status) {
  return (status & 0x6f) == 0x27 || (status & 0x6f) == 0x07 || (status & 0x4f) == 0x0f;
}

/// A drive, its master, and a board that behaves as the cycle does: a refused value is repeated; after a
/// refusal the wanted correction is zero.
class Rig {
 public:
  explicit Rig(const CanopenSettings& made = settings()) : drive(made) {}

  bool sync = true, tpdo = true, heartbeat = true, bus = true;
  bool overtaken = false;  // the next SYNC comes before the offset
  std::uint16_t status = kEnabled;
  int nmt = 5;
  std::int64_t target = 0;

  HalFault tick() {
    now_ = now_ + InstantNs(kMs);
    ++ticks_;
    if (sync && bus) {
      const bool torque = has_torque(status);
      const std::int64_t change = std::abs(std::int64_t{buffer_} - applied_);
      if (nmt == 5) {
        if (torque && torque_before_) largest_ = std::max(largest_, change);
        applied_ = buffer_;
      }
      torque_before_ = torque;
      drive.take(frame(0x80, {}), now_);
      if (late_is_there_) arrive(late_);
      late_is_there_ = false;
      if (tpdo && nmt == 5) drive.take(status_frame(status, 1000), now_);
    }
    if (heartbeat && bus && ticks_ % 100 == 1) drive.take(frame(0x701, {nmt}), now_);
    return write();
  }
  HalFault run(int ticks) {
    HalFault fault = HalFault::kNone;
    for (int i = 0; i < ticks; ++i)
      if (const HalFault one = tick(); one != HalFault::kNone) fault = one;
    return fault;
  }
  /// The drive has an offset of 1000 counts.
  void correct() {
    run(120);
    target = 1000;
    EXPECT_EQ(run(120), HalFault::kNone);
    EXPECT_EQ(applied_, 1000);
    largest_ = 0;
  }
  /// Ticks until a write is refused.
  int until_refused(int most = 1000) {
    for (int i = 1; i <= most; ++i)
      if (tick() != HalFault::kNone) return i;
    return -1;
  }
  /// Ticks until the drive has no offset.
  int until_zero(int most = 1000) {
    for (int i = 1; i <= most; ++i) {
      tick();
      if (applied_ == 0 && written_ == 0) return i;
    }
    return -1;
  }
  void restart_drive() {
    if (late_is_there_) arrive(late_);  // a start takes longer than a frame waits
    late_is_there_ = false;
    applied_ = buffer_ = 0;
    drive.take(frame(0x701, {0}), now_);
  }
  void clear() { latched_ = false; }
  void report(const char* what, int detected, int zero) const {
    std::printf("%s: refused after %d ticks, zero %d ticks later, largest step %lld of %lld counts\n", what,
                detected, zero, static_cast<long long>(largest_), static_cast<long long>(kMost));
  }
  std::int32_t applied() const { return applied_; }
  std::int32_t buffer() const { return buffer_; }
  std::int64_t written() const { return written_; }
  std::int64_t largest() const { return largest_; }
  bool latched() const { return latched_; }
  InstantNs now() const { return now_; }
  CanopenDrive drive;

 private:
  void arrive(std::int32_t offset) {
    if (nmt == 5) buffer_ = offset;
    drive.take(offset_frame(offset), now_);
  }
  HalFault write() {
    const std::int64_t wanted = latched_ ? 0 : target;
    const std::int64_t next = repeat_ ? pending_ : std::clamp(wanted, written_ - kMost, written_ + kMost);
    const CanopenDrive::Step step = drive.step(next, now_);
    if (step.send && !bus) drive.not_sent();
    if (step.send && bus) {
      drive.sent(step.offset, now_);
      if (overtaken) {
        late_ = step.offset;
        late_is_there_ = true;
      } else {
        arrive(step.offset);
      }
    }
    repeat_ = step.fault != HalFault::kNone || (step.send && !bus);
    latched_ = latched_ || repeat_;
    pending_ = next;
    if (!repeat_) written_ = next;
    return repeat_ ? HalFault::kRefused : HalFault::kNone;
  }

  InstantNs now_;
  int ticks_ = 0;
  std::int32_t buffer_ = 0, applied_ = 0;  // of the drive: newest RPDO, offset in use
  std::int64_t written_ = 0, pending_ = 0, largest_ = 0;
  std::int32_t late_ = 0;
  bool late_is_there_ = false;  // an offset that waits for the bus
  bool repeat_ = false, latched_ = false, torque_before_ = false;
};

/// A count of 10 um and a limit of 0.2 um a SYNC: a whole count every 50 SYNCs, not a count at each.
TEST(Canopen, ALimitBelowOneCountHoldsOverSeveralSyncs) {
  for (const std::int64_t parts :
       {CanopenSettings::kPartsOfCount / 50, CanopenSettings::kPartsOfCount * 3 / 2}) {
    CanopenSettings made = settings();
    made.parts_per_sync = parts;
    Rig rig(made);
    rig.run(120);
    rig.target = 1000;
    std::vector<std::int64_t> applied;
    for (int i = 0; i < 500; ++i) {
      rig.tick();
      applied.push_back(rig.applied());
    }
    for (std::size_t first = 0; first < applied.size(); ++first)
      for (std::size_t last = first + 1; last < applied.size(); last += 7) {
        const double allowed = static_cast<double>(parts) * static_cast<double>(last - first) /
                               static_cast<double>(CanopenSettings::kPartsOfCount);
        ASSERT_LE(static_cast<double>(applied[last] - applied[first]), allowed + 1)
            << "the limit over " << last - first << " SYNCs, rounded to a count";
      }
    EXPECT_GT(applied.back(), parts < CanopenSettings::kPartsOfCount ? 7 : 700) << "and it is used";
  }
}

TEST(Canopen, EachSyncTakesTheOffsetOfTheTickBeforeToTheCount) {
  Rig rig;
  rig.run(120);
  std::int64_t before = 0;
  for (int i = 0; i < 100'000; ++i) {
    rig.target = static_cast<std::int64_t>(5000 * std::sin(i / 300.0));
    ASSERT_EQ(rig.tick(), HalFault::kNone) << i;
    ASSERT_EQ(rig.applied(), before) << "the value of the tick before, in tick " << i;
    ASSERT_EQ(rig.buffer(), rig.written()) << i;
    before = rig.written();
  }
  EXPECT_LE(rig.largest(), kMost);
  EXPECT_EQ(rig.drive.counts().losses, 0u);
}

TEST(Canopen, NewestOffsetIsInTheDriveAfterASyncOnly) {
  Rig rig;
  rig.correct();
  EXPECT_TRUE(rig.drive.has_newest_offset());
  rig.target = 0;
  int ticks = 0;
  while (rig.drive.offset() != 0 && ticks < 1000) {
    rig.tick(), ++ticks;
    EXPECT_FALSE(rig.drive.has_newest_offset()) << "tick " << ticks << " sends another one";
  }
  ASSERT_EQ(rig.drive.offset(), 0);
  rig.sync = false;
  rig.run(5);
  EXPECT_FALSE(rig.drive.has_newest_offset()) << "no SYNC has come since";
  EXPECT_NE(rig.applied(), 0);
  rig.sync = true;
  rig.run(2);
  EXPECT_TRUE(rig.drive.has_newest_offset());
  EXPECT_EQ(rig.applied(), 0);
}

TEST(CanopenLoss, OfSyncKeepsTheOffsetAndRampsOutWhenSyncReturns) {
  Rig rig;
  rig.correct();
  rig.sync = false;
  const int detected = rig.until_refused();
  EXPECT_LE(detected, 22) << "sync_timeout and two ticks";
  rig.run(500);
  EXPECT_EQ(rig.applied(), 1000) << "a drive without SYNC takes nothing";
  EXPECT_EQ(rig.buffer(), 1000) << "and finds no other value at its first SYNC";
  rig.sync = true;
  const int zero = rig.until_zero();
  rig.report("SYNC lost", detected, zero);
  EXPECT_TRUE(rig.latched());
  EXPECT_LE(zero, 1000 / kMost + 4);
  EXPECT_GT(zero, 0);
  EXPECT_LE(rig.largest(), kMost);
}

TEST(CanopenLoss, OfTheHeartbeatRampsOut) {
  Rig rig;
  rig.correct();
  rig.heartbeat = false;
  const int detected = rig.until_refused();
  EXPECT_LE(detected, 202) << "heartbeat_time and two ticks";
  const int zero = rig.until_zero();
  rig.report("heartbeat lost", detected, zero);
  EXPECT_TRUE(rig.latched());
  EXPECT_LE(zero, 1000 / kMost + 4);
  EXPECT_LE(rig.largest(), kMost);
}

TEST(CanopenLoss, EmergencyRampsOutAndLastsUntilItsReset) {
  Rig rig;
  rig.correct();
  rig.drive.take(emergency_frame(0x8611), rig.now());
  const int detected = rig.until_refused();
  EXPECT_EQ(detected, 1);
  const int zero = rig.until_zero();
  rig.report("EMCY", detected, zero);
  EXPECT_LE(zero, 1000 / kMost + 4);
  EXPECT_LE(rig.largest(), kMost);
  rig.clear();
  rig.run(200);
  EXPECT_EQ(rig.applied(), 0) << "the emergency is still there";
  EXPECT_FALSE(rig.drive.follows());
  rig.target = 0;
  rig.run(100);
  rig.drive.take(emergency_frame(0), rig.now());
  rig.target = 500;
  EXPECT_EQ(rig.run(100), HalFault::kNone);
  EXPECT_EQ(rig.applied(), 500);
  EXPECT_LE(rig.largest(), kMost);
  EXPECT_EQ(rig.drive.counts().last_emergency, 0x8611);
}

TEST(CanopenLoss, DriveThatIsNotOperationalKeepsItsOffset) {
  Rig rig;
  rig.correct();
  rig.nmt = 0x7f;
  const int detected = rig.until_refused();
  EXPECT_LE(detected, 102) << "the heartbeat tells of it";
  rig.run(300);
  EXPECT_EQ(rig.buffer(), 1000);
  rig.nmt = 5;
  const int zero = rig.until_zero();
  rig.report("not Operational", detected, zero);
  EXPECT_LE(rig.largest(), kMost);
  EXPECT_GT(zero, 0);
}

TEST(CanopenLoss, RestartOfTheDriveIsNoStep) {
  Rig rig;
  rig.correct();
  rig.restart_drive();
  rig.nmt = 0x7f;
  EXPECT_EQ(rig.until_refused(), 1);
  rig.run(200);
  rig.nmt = 5;
  EXPECT_GE(rig.until_zero(), 0);
  EXPECT_EQ(rig.applied(), 0);
  EXPECT_LE(rig.largest(), kMost);
}

// The drive is enabled again while the board still removes its correction: the offset must not come back.
TEST(CanopenLoss, DriveThatIsEnabledDuringTheRampOutGetsNoOffset) {
  Rig rig;
  rig.correct();
  rig.restart_drive();
  rig.status = kSwitchedOn;
  rig.run(3);
  rig.status = kEnabled;
  for (int i = 0; rig.written() != 0; ++i) {
    ASSERT_LT(i, 200);
    rig.tick();
    EXPECT_EQ(rig.applied(), 0) << "tick " << i;
  }
  rig.target = 0;
  rig.clear();
  rig.run(120);
  rig.target = 300;
  rig.run(120);
  EXPECT_EQ(rig.applied(), 300) << "after zero the correction comes in again";
}

TEST(CanopenLoss, BusOffIsDetectedAndNothingIsSentIntoIt) {
  Rig rig;
  rig.correct();
  can_frame off{};
  off.can_id = CAN_ERR_FLAG | CAN_ERR_BUSOFF, off.can_dlc = CAN_ERR_DLC;
  rig.drive.take(off, rig.now());
  rig.bus = false;
  const int detected = rig.until_refused();
  EXPECT_EQ(detected, 1);
  const std::uint64_t sent = rig.drive.counts().offsets;
  rig.run(400);
  EXPECT_EQ(rig.drive.counts().offsets, sent);
  off.can_id = CAN_ERR_FLAG | CAN_ERR_RESTARTED;
  rig.drive.take(off, rig.now());
  rig.bus = true;
  const int zero = rig.until_zero();
  rig.report("bus off", detected, zero);
  EXPECT_LE(rig.largest(), kMost);
  EXPECT_EQ(rig.drive.counts().bus_errors, 1u);
}

TEST(CanopenLoss, FramesOfWrongLengthAndKindAreNoSignOfTheDrive) {
  Rig rig;
  rig.correct();
  rig.tpdo = false;
  int detected = -1;
  for (int i = 1; i < 100 && detected < 0; ++i) {
    can_frame wrong = status_frame(kEnabled, 5);
    wrong.can_dlc = static_cast<std::uint8_t>(i % 6);
    rig.drive.take(wrong, rig.now());
    wrong.can_dlc = 8;
    rig.drive.take(wrong, rig.now());
    wrong = status_frame(kEnabled, 5);
    wrong.can_id |= i % 2 == 0 ? CAN_RTR_FLAG : CAN_EFF_FLAG;
    rig.drive.take(wrong, rig.now());
    rig.drive.take(frame(0x80, {1, 2}), rig.now());
    rig.drive.take(frame(0x701, {5, 5}), rig.now());
    rig.drive.take(frame(0x81, {0, 0, 0}), rig.now());
    if (rig.tick() != HalFault::kNone) detected = i;
  }
  EXPECT_GT(detected, 0);
  EXPECT_LE(detected, 22);
  EXPECT_EQ(rig.drive.counts().malformed, 6u * static_cast<unsigned>(detected));
  rig.tpdo = true;
  const int zero = rig.until_zero();
  rig.report("wrong length", detected, zero);
  EXPECT_LE(rig.largest(), kMost);
}

TEST(CanopenLoss, AnotherSenderOfTheOffsetIsDetected) {
  Rig rig;
  rig.correct();
  rig.drive.take(frame(0x501, {1, 0, 0, 0}), rig.now());
  EXPECT_EQ(rig.until_refused(), 1);
  EXPECT_LE(rig.until_zero(), 1000 / kMost + 4);
  EXPECT_EQ(rig.drive.counts().foreign, 1u);
}

TEST(Canopen, SyncThatOvertakesAnOffsetMakesNoStep) {
  Rig rig;
  rig.run(120);
  std::mt19937_64 random(1);
  for (int i = 0; i < 100'000; ++i) {
    rig.overtaken = random() % 3 == 0;
    rig.target = random() % 50 == 0 ? static_cast<std::int64_t>(random() % 2001) - 1000 : rig.target;
    ASSERT_EQ(rig.tick(), HalFault::kNone) << i;
    ASSERT_LE(rig.largest(), kMost) << i;
  }
}

TEST(CanopenLoss, FramesThatTheBusDoesNotTakeAreDetected) {
  JoinedSockets cable;
  CanopenOutput output(cable.near(), {"test", 1, {}, false}, settings(), scale());
  // GIVEN a drive that is heard, and a bus that does not take the frames of the board
  int refused = -1;
  for (int i = 0; i < 60 && refused < 0; ++i) {
    ASSERT_TRUE(cable.send(frame(0x80, {})) && cable.send(status_frame(kEnabled, 0)) &&
                cable.send(frame(0x701, {5})));
    if (output.write_correction(0, AxisTravel(100 * i)) != HalFault::kNone) refused = i;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_GT(refused, 1);
  EXPECT_LE(refused, 30);
  EXPECT_EQ(output.drive().counts().offsets, 1u) << "one frame waits at a time";
}

TEST(CanopenLoss, TicksThatStandStillBelieveNoOldFrame) {
  Rig rig;
  rig.correct();
  // GIVEN no tick for 200 ms WHEN it goes on THEN the frames from before say nothing: the offset stays
  const InstantNs later = rig.now() + InstantNs(200 * kMs);
  const CanopenDrive::Step step = rig.drive.step(1000, later);
  EXPECT_EQ(step.fault, HalFault::kRefused);
  EXPECT_FALSE(step.send);
}

TEST(CanopenState, OffsetIsZeroUnlessOperationIsEnabledAndComesBackWithoutAStep) {
  for (const std::uint16_t off : {kSwitchedOn, kFault, std::uint16_t{0x1631}, std::uint16_t{0x1650}}) {
    Rig rig;
    rig.correct();
    rig.status = off;
    EXPECT_EQ(rig.run(1), HalFault::kNone) << "no fault: the operator switches drives off each day";
    EXPECT_EQ(rig.buffer(), 1000) << "one statusword may be wrong";
    EXPECT_EQ(rig.run(1), HalFault::kNone);
    EXPECT_EQ(rig.buffer(), 0) << "no torque, no step";
    EXPECT_EQ(rig.drive.offset(), 0);
    EXPECT_FALSE(rig.drive.follows());
    rig.run(300);
    EXPECT_EQ(rig.applied(), 0);
    rig.status = kEnabled;
    EXPECT_EQ(rig.run(100), HalFault::kNone);
    EXPECT_EQ(rig.applied(), 1000);
    EXPECT_TRUE(rig.drive.follows());
    EXPECT_LE(rig.largest(), kMost);
    EXPECT_GE(rig.drive.counts().not_enabled, 300u);
  }
}

// A wrong bit in one statusword, while the drive is in Operation enabled: the offset must not step to zero.
TEST(CanopenState, WrongBitInOneStatuswordMakesNoStep) {
  for (int bit = 0; bit < 16; ++bit) {
    Rig rig;
    rig.correct();
    rig.status = static_cast<std::uint16_t>(kEnabled ^ 1u << bit);
    rig.run(1);
    rig.status = kEnabled;
    rig.run(1);
    EXPECT_LE(std::abs(rig.buffer() - 1000), kMost) << "bit " << bit;
    rig.run(20);
    EXPECT_EQ(rig.buffer(), 1000) << "bit " << bit;
    EXPECT_EQ(rig.drive.counts().losses, 0u);
  }
}

TEST(CanopenState, StoppingDriveStillMovesAndRampsOut) {
  for (const std::uint16_t stopping : {kQuickStop, kFaultReaction}) {
    Rig rig;
    rig.correct();
    rig.status = stopping;
    rig.run(20);
    EXPECT_GT(rig.applied(), 0);
    rig.run(1000 / kMost);
    EXPECT_EQ(rig.applied(), 0);
    EXPECT_LE(rig.largest(), kMost);
    std::printf("status 0x%04x: zero within %lld ticks\n", stopping,
                static_cast<long long>(1000 / kMost + 2));
  }
}

// Every fault at random and together; the invariants after each tick.
TEST(CanopenState, NoHistoryMakesAStepOrAnOffsetWithoutTorque) {
  std::mt19937_64 random(20260101);
  RecordProperty("seed", 20260101);
  Rig rig;
  const std::uint16_t kStates[] = {kEnabled, kEnabled,   kEnabled,      kSwitchedOn,
                                   kFault,   kQuickStop, kFaultReaction};
  std::uint64_t injected = 0, corrected = 0;
  bool off = false, told_off = false;  // the newest statusword has no torque; it came in the tick before
  for (int i = 0; i < 20'000'000; ++i) {
    const auto one_in = [&](std::uint64_t n) { return random() % n == 0 ? (++injected, true) : false; };
    if (one_in(400)) rig.sync = !rig.sync;
    if (one_in(600)) rig.tpdo = !rig.tpdo;
    if (one_in(900)) rig.heartbeat = !rig.heartbeat;
    if (one_in(500)) rig.bus = !rig.bus;
    if (const std::uint16_t next = kStates[random() % 7]; one_in(300)) {
      // A drive is switched on by its master, over the bus.
      const bool may = rig.nmt == 5 && rig.sync && rig.bus;
      if (may || !has_torque(next) || has_torque(rig.status)) rig.status = next;
    }
    if (one_in(700)) rig.nmt = random() % 3 == 0 ? 0x7f : 5;
    rig.overtaken = random() % 64 == 0;
    if (one_in(2000)) rig.restart_drive();
    if (one_in(800)) rig.drive.take(emergency_frame(random() % 2 == 0 ? 0x2310 : 0), rig.now());
    if (one_in(20)) {
      can_frame noise{};
      noise.can_id = 0x80 + static_cast<std::uint32_t>(random() % 2);
      noise.can_dlc = static_cast<std::uint8_t>(2 + random() % 5);
      rig.drive.take(noise, rig.now());
    }
    if (one_in(100)) rig.target = static_cast<std::int64_t>(random() % 2001) - 1000;
    if (i % 500 == 0) rig.sync = rig.tpdo = rig.heartbeat = rig.bus = true, rig.nmt = 5, rig.clear();
    const std::uint64_t sent = rig.drive.counts().offsets, told = rig.drive.counts().positions;
    const std::int32_t offset = rig.drive.offset();
    const bool was_off = off;
    rig.tick();
    off = !has_torque(rig.drive.status());
    // A second statusword without torque came, or the first one: the offset is zero, or stays.
    if (rig.drive.counts().offsets > sent && off && rig.drive.offset() != 0) {
      ASSERT_EQ(rig.drive.offset(), offset) << "tick " << i;
      ASSERT_FALSE(was_off && rig.drive.counts().positions > told && told_off) << "tick " << i;
    }
    told_off = off && rig.drive.counts().positions > told;
    corrected += rig.applied() != 0 ? 1 : 0;
    ASSERT_LE(rig.largest(), kMost) << "tick " << i;
    ASSERT_LE(std::abs(rig.applied()), 1000 + kMost);
  }
  EXPECT_GT(corrected, 500'000u);
  std::printf("%llu injections, %llu ticks with a correction, %llu losses, largest step %lld of %lld\n",
              static_cast<unsigned long long>(injected), static_cast<unsigned long long>(corrected),
              static_cast<unsigned long long>(rig.drive.counts().losses),
              static_cast<long long>(rig.largest()), static_cast<long long>(kMost));
}

class CanopenBus : public testing::Test {
 protected:
  void drive_speaks() {
    ASSERT_TRUE(cable_.send(frame(0x80, {})) && cable_.send(status_frame(kEnabled, 0)) &&
                cable_.send(frame(0x701, {5})));
  }
  JoinedSockets cable_;
  CanopenOutput output_{cable_.near(), {"test", 1, {}, false}, settings(), scale()};
};

TEST_F(CanopenBus, OffsetIsFourBytesLittleEndian) {
  drive_speaks();
  EXPECT_EQ(output_.write_correction(0, AxisTravel(0)), HalFault::kNone);
  can_frame got = cable_.receive();
  ASSERT_TRUE(cable_.send(got)) << "it comes back";
  EXPECT_EQ(got.can_id, 0x501u);
  EXPECT_EQ(got.can_dlc, 4);
  drive_speaks();
  EXPECT_EQ(output_.write_correction(0, AxisTravel(-1'749)), HalFault::kNone);  // -17.49 counts
  got = cable_.receive();
  EXPECT_EQ(got.data[0], 0xef);
  EXPECT_EQ(got.data[1], 0xff);
  EXPECT_EQ(got.data[3], 0xff);
  EXPECT_EQ(output_.within_range(0, AxisTravel(-1'749)), AxisTravel(-1'749));
  EXPECT_EQ(output_.within_range(0, AxisTravel(5'000'000)), AxisTravel(1'000'000));
  EXPECT_EQ(output_.write_correction(1, AxisTravel(0)), HalFault::kNoDevice);
  EXPECT_EQ(output_.attempt(0), "");
}

TEST_F(CanopenBus, SilentDriveIsNamedAndGetsNothing) {
  EXPECT_EQ(output_.attempt(0), "no SYNC arrives");
  EXPECT_EQ(output_.write_correction(0, AxisTravel(0)), HalFault::kNone);
  EXPECT_EQ(cable_.receive().can_id, 0u) << "nothing is sent";
  EXPECT_EQ(output_.write_correction(0, AxisTravel(1'000)), HalFault::kNone);
  EXPECT_EQ(output_.within_range(0, AxisTravel(1'000)), AxisTravel(0))
      << "the board knows that it is not used";
}

TEST_F(CanopenBus, BusThatTakesNothingRefusesTheTick) {
  drive_speaks();
  EXPECT_EQ(output_.write_correction(0, AxisTravel(0)), HalFault::kNone);
  ASSERT_TRUE(cable_.send(cable_.receive()));
  cable_.cut();
  EXPECT_EQ(output_.write_correction(0, AxisTravel(100)), HalFault::kRefused);
  EXPECT_NE(output_.account().find("1 not taken by the bus"), std::string::npos) << output_.account();
}

TEST_F(CanopenBus, SecondBoardIsFound) {
  EXPECT_TRUE(output_.lock());
  ASSERT_TRUE(cable_.send(frame(0x501, {1, 0, 0, 0})));
  EXPECT_FALSE(output_.lock());
}

TEST(CanopenAxis, PositionIsThatOfTheNewestTpdoAndWrapsAround) {
  JoinedSockets cable;
  PositionScale to_nm{100, 1, 5'000, false};  // 0.1 um a count
  CanopenAxes axes(cable.near(), {{settings(), to_nm}});
  AxisReading reading;
  const auto tick = [&] {
    axes.begin_tick();
    return axes.read_axis(0, reading) == HalFault::kNone ? reading.position.count : INT64_MIN;
  };
  EXPECT_EQ(tick(), INT64_MIN);
  ASSERT_TRUE(cable.send(status_frame(kEnabled, 7)) && cable.send(status_frame(kFault, -8)));
  EXPECT_EQ(tick(), 4'200);
  EXPECT_EQ(tick(), INT64_MIN) << "no new TPDO";
  // GIVEN a table that always turns one way WHEN its number wraps around THEN the position goes on
  std::uint32_t count = static_cast<std::uint32_t>(-8);
  for (int i = 0; i < 5; ++i) {
    count += 1u << 30;
    ASSERT_TRUE(cable.send(status_frame(kEnabled, static_cast<std::int32_t>(count))));
    EXPECT_EQ(tick(), 5'000 + 100 * (-8 + (std::int64_t{i} + 1) * (1 << 30)));
  }
  can_frame wrong = status_frame(kEnabled, 1);
  wrong.can_dlc = 5;
  ASSERT_TRUE(cable.send(wrong));
  EXPECT_EQ(tick(), INT64_MIN) << "a frame of a wrong length is no reading";
  EXPECT_EQ(axes.counts(0).malformed, 1u);
  EXPECT_EQ(axes.read_axis(1, reading), HalFault::kNoDevice);
}

/// The object dictionary of a drive, behind SDO.
class Dictionary {
 public:
  Dictionary() {
    set(0x1403, 1, 0x501), set(0x1403, 2, 1), set(0x1603, 0, 1), set(0x1603, 1, 0x60b00020);
    set(0x1401, 1, 0x80000501);  // off; the other numbers are left out
    set(0x1802, 1, 0x40000381), set(0x1802, 2, 1), set(0x1a02, 0, 2), set(0x1a02, 1, 0x60410010),
        set(0x1a02, 2, 0x60640020);
    set(0x60b0, 0, static_cast<std::uint32_t>(-77));
    server_ = std::thread([this] { serve(); });
  }
  ~Dictionary() {
    stop_ = true;
    server_.join();
  }
  void set(int index, int subindex, std::uint32_t value) {
    const std::scoped_lock lock(guard_);
    objects_[index << 8 | subindex] = value;
  }
  CanopenSdo client() { return {cable_.near(), 1}; }
  std::atomic<bool> deaf{false};

 private:
  void serve() {
    while (!stop_) {
      const can_frame asked = cable_.receive();
      if (asked.can_id != 0x601 || deaf) {
        std::this_thread::sleep_for(std::chrono::microseconds(200));
        continue;
      }
      const std::scoped_lock lock(guard_);
      const auto found = objects_.find(asked.data[2] << 16 | asked.data[1] << 8 | asked.data[3]);
      can_frame answer = asked;
      answer.can_id = 0x581;
      const std::uint32_t content = found == objects_.end() ? 0x06020000 : found->second;
      answer.data[0] = found == objects_.end() ? 0x80 : 0x43;
      for (int i = 0; i < 4; ++i) answer.data[4 + i] = static_cast<std::uint8_t>(content >> (8 * i));
      can_frame other = answer;  // of another request
      ++other.data[3];
      cable_.send(other);
      cable_.send(answer);
    }
  }
  JoinedSockets cable_;
  std::mutex guard_;
  std::map<int, std::uint32_t> objects_;
  std::atomic<bool> stop_{false};
  std::thread server_;
};

TEST(CanopenPdos, AreComparedWithThoseOfTheDrive) {
  Dictionary drive;
  CanopenSdo sdo = drive.client();
  EXPECT_EQ(sdo.check_offset(0x501, {}), "");
  EXPECT_EQ(sdo.check_position(0x381), "");
  std::uint32_t value = 0;
  EXPECT_EQ(sdo.read({}, value), "");
  EXPECT_EQ(static_cast<std::int32_t>(value), -77);
  EXPECT_EQ(sdo.check_offset(0x502, {}), "the drive has no active RPDO with the identifier 0x502");
  EXPECT_EQ(sdo.check_offset(0x501, {0x2010, 3}),
            "RPDO 0x1603: object 0x60B00020 is mapped, but the required object is 0x20100320");
  drive.set(0x1403, 2, 255);
  EXPECT_EQ(sdo.check_offset(0x501, {}),
            "RPDO 0x1403: transmission type 255, but the required type is 1: with each SYNC");
  drive.set(0x1403, 2, 0), drive.set(0x1603, 0, 2);
  EXPECT_EQ(sdo.check_offset(0x501, {}), "RPDO 0x1603: 2 mapped objects, but the required number is 1");
  EXPECT_EQ(sdo.read({0x2000, 0}, value), "0x2000:00 cannot be read (abort 0x06020000)");
  drive.deaf = true;
  EXPECT_EQ(sdo.read({}, value), "the drive does not answer a request for 0x60B0:00");
}

TEST(CanopenPdos, OfTwentyNineBitsOrRareOrWrittenTwiceAreRefused) {
  Dictionary drive;
  CanopenSdo sdo = drive.client();
  const std::uint32_t rpdo = 0x501, tpdo = 0x381;
  drive.set(0x1403, 1, rpdo | 0x20000000);
  EXPECT_EQ(sdo.check_offset(rpdo, {}),
            "RPDO 0x1403: the identifier 0x501 has 29 bits, but 11 bits are required");
  drive.set(0x1403, 1, rpdo), drive.set(0x1403, 2, 240);
  EXPECT_EQ(sdo.check_offset(rpdo, {}), "") << "each synchronous type of an RPDO: with the next SYNC";
  drive.set(0x1802, 1, tpdo | 0x20000000);
  EXPECT_EQ(sdo.check_position(tpdo),
            "TPDO 0x1802: the identifier 0x381 has 29 bits, but 11 bits are required");
  drive.set(0x1802, 1, tpdo);
  for (const std::uint32_t type : {0u, 2u, 240u}) {
    drive.set(0x1802, 2, type);
    EXPECT_EQ(sdo.check_position(tpdo), "TPDO 0x1802: transmission type " + std::to_string(type) +
                                            ", but the required type is 1: with each SYNC");
  }
  drive.set(0x1400, 1, 0x201), drive.set(0x1600, 0, 2), drive.set(0x1600, 1, 0x60400010);
  EXPECT_EQ(sdo.check_offset(rpdo, {}), "");
  drive.set(0x1600, 2, 0x60b00020);
  EXPECT_EQ(sdo.check_offset(rpdo, {}),
            "RPDO 0x1600: object 0x60B00020 is also mapped in this PDO; only the PDO of the board may "
            "contain this object");
  drive.set(0x1400, 1, 0x80000201);
  EXPECT_EQ(sdo.check_offset(rpdo, {}), "") << "that one is off";
  drive.set(0x1404, 1, rpdo);
  EXPECT_EQ(sdo.check_offset(rpdo, {}), "the drive has two active RPDOs with the identifier 0x501");
}

}  // namespace
}  // namespace vernier::canopen_test
