// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware/core/probing.h"

#include <gtest/gtest.h>

#include <optional>

#include "tests/support/approach.h"
#include "tests/support/interrupted_write.h"
#include "tests/unit/firmware/upload_rig.h"
#include "tools/text/error.h"
#include "tools/upload/client.h"

namespace vernier::probing_test {

using namespace vernier::text;
using namespace vernier::upload;
namespace {

constexpr double kDelay = 6.16e-3;
constexpr InstantNs kResolution(1000);

ProbeSettings published_probe() {
  ProbeSettings probe;
  probe.delay = InstantNs(6'160'000);
  probe.settle = InstantNs(500'000);
  return probe;
}

// The root of the sum of the squares, rounded up to a nanosecond; a resolution has its twelfth.
TEST(ProbeSettings, UncertaintyOfTheInstantIsThatOfItsThreeParts) {
  const auto of = [](std::int64_t resolution, std::int64_t delay, std::int64_t age) {
    ProbeSettings probe;
    probe.delay_spread = InstantNs(delay), probe.age_spread = InstantNs(age);
    return probe.time_uncertainty(InstantNs(resolution)).count;
  };
  EXPECT_EQ(of(0, 0, 0), 0);
  EXPECT_EQ(of(0, 3, 4), 5);
  EXPECT_EQ(of(0, 3, 5), 6);                // 5.83
  EXPECT_EQ(of(6, 0, 0), 2);                // 1.73
  EXPECT_EQ(of(1'000'000, 0, 0), 288'676);  // 288675.13
  EXPECT_EQ(of(0, 500'000'000, 0), 500'000'000);
  EXPECT_EQ(of(0, 500'000'001, -1), 500'000'000) << "limited";
}

TEST(Probing, FindsTheContactInAccelerationConstantFeedAndDeceleration) {
  for (const double feed : {25.4, 127.0, 508.0, 1270.0, 2540.0}) {
    const Profile profile{.feed_mm_s = feed / 60, .cruise_mm = 0.6};
    const double ramp = profile.ramp_s(), cruise = profile.cruise_s();
    for (const double contact : {0.55 * ramp, ramp + 0.5 * cruise, ramp + cruise + 0.4 * ramp}) {
      TouchRig rig(profile, published_probe(), kResolution);
      rig.run(profile, {{contact + kDelay, true}, {contact + kDelay + 0.02, false}}, kResolution);
      const auto touches = rig.touches();
      ASSERT_EQ(touches.size(), 1u) << feed << " " << contact;
      ASSERT_EQ(touches[0].fault, 0);
      const double error_um =
          std::abs(static_cast<double>(touches[0].position[0]) - profile.at(contact) * 1e6) * 1e-3;
      EXPECT_LE(error_um, 0.1 + profile.feed_mm_s * 1e3 * 1e-6) << feed << " " << contact;
      EXPECT_LE(error_um * 1e3, 3 * static_cast<double>(touches[0].uncertainty[0]) + 2)
          << feed << " " << contact;
      EXPECT_NEAR(static_cast<double>(touches[0].position[1]),
                  (50 - (profile.at(contact) - profile.start_mm) / 3) * 1e6, 100 + 15);
      EXPECT_EQ(touches[0].workpiece_nm[2], -7'000'000);
      EXPECT_EQ(touches[0].flags, kTouchUncompensated | kTouchInWorkpiece);
    }
  }
}

TEST(Probing, PublishesWithinTwoTicksOfASettledEdgeEvenWithoutADelay) {
  const Profile profile{.feed_mm_s = 10};
  ProbeSettings probe;
  probe.settle = InstantNs(200'000);
  TouchRig rig(profile, probe, kResolution);
  for (int i = 0; i < 20; ++i) rig.plant.advance(), rig.service->tick();
  rig.plant.release();
  for (int i = 0; i < 100; ++i) rig.plant.advance(), rig.service->tick();
  rig.line.put(rig.clock.now() + InstantNs(300'000), true);  // between this tick and the next
  int ticks = 0;
  for (; rig.touches().empty() && ticks < 10; ++ticks) rig.plant.advance(), rig.service->tick();
  EXPECT_LE(ticks, 2 + 1) << "the tick after the edge is the first that can know of it";
}

TEST(Probing, CountsEveryEdgeAndTouchThatIsLost) {
  const Profile profile{.feed_mm_s = 10};
  TouchRig rig(profile, published_probe(), kResolution);
  rig.run(
      profile,
      {{0.10, true}, {0.12, false}, {0.14, true}, {0.1401, false}, {0.2, true}, {0.25, true}, {0.3, false}},
      kResolution);
  const auto touches = rig.touches();
  ASSERT_EQ(touches.size(), 3u);
  EXPECT_EQ(touches[2].kind, static_cast<std::uint8_t>(TouchKind::kReleaseMissing));
  EXPECT_EQ(touches[2].spikes, 1u);
  EXPECT_GE(touches[2].lost_edges, 1u);  // the queue saw two of a kind in a row
}

TEST(Probing, SaysThatTheRingHasForgottenALateEdge) {
  const Profile profile{.feed_mm_s = 10};
  ProbeSettings probe = published_probe();
  probe.delay = InstantNs(90'000'000);
  TouchRig rig(profile, probe, kResolution);
  rig.run(profile, {{0.2, true}, {0.22, false}}, kResolution);
  const auto touches = rig.touches();
  ASSERT_EQ(touches.size(), 1u);
  EXPECT_EQ(touches[0].fault, static_cast<std::uint8_t>(LatchFault::kTooOld));
}

// The contact opened without having closed: its time is unknown, and therefore it has no position.
TEST(Probing, MissedTouchIsToldWithoutAPosition) {
  const Profile profile{.feed_mm_s = 10};
  TouchRig rig(profile, published_probe(), kResolution);
  rig.run(profile, {{0.2, false}, {0.3, true}, {0.32, false}}, kResolution);
  const auto touches = rig.touches();
  ASSERT_EQ(touches.size(), 2u);
  EXPECT_EQ(touches[0].kind, static_cast<std::uint8_t>(TouchKind::kMissed));
  EXPECT_EQ(touches[0].fault, 0);
  EXPECT_EQ(touches[0].missing, 1u);
  EXPECT_EQ(touches[0].flags & kTouchInWorkpiece, 0);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(touches[0].position[i], 0);
    EXPECT_EQ(touches[0].workpiece_nm[i], 0);
  }
  EXPECT_EQ(touches[1].kind, static_cast<std::uint8_t>(TouchKind::kTouch));
  EXPECT_NE(touches[1].position[0], 0);
}

TEST(Probing, RotaryAxisNamedXIsNoCoordinateOfTheWorkpiece) {
  const Profile profile{.feed_mm_s = 10};
  TouchRig rig(profile, published_probe(), kResolution, {}, {.name = "X", .rotary = true});
  rig.run(profile, {{0.2, true}, {0.22, false}}, kResolution);
  const auto touches = rig.touches();
  ASSERT_EQ(touches.size(), 1u);
  EXPECT_EQ(touches[0].fault, 0);
  EXPECT_NE(touches[0].position[0], 0);
  EXPECT_EQ(touches[0].flags & kTouchInWorkpiece, 0);
  for (const std::int64_t coordinate : touches[0].workpiece_nm) EXPECT_EQ(coordinate, 0);
}

/// Encoders that are 5 um beyond the command; that of Y gives no reading.
class Encoders : public PositionReader {
 public:
  HalFault read_axis(std::uint32_t axis, AxisReading& reading) noexcept override {
    if (plant == nullptr || axis == 1) return HalFault::kNoReading;
    const HalFault fault = plant->read_axis(axis, reading);
    reading.position.count += 5000;
    return fault;
  }
  SimPlant* plant = nullptr;
};

TEST(Probing, TakesTheActualPositionAndTheCommandedOneOfAnAxisWithoutAReading) {
  const Profile profile{.feed_mm_s = 10};
  Encoders encoders;
  TouchRig commanded(profile, published_probe(), kResolution),
      actual(profile, published_probe(), kResolution, {}, {"X"}, &encoders);
  encoders.plant = &actual.plant;
  for (TouchRig* const rig : {&commanded, &actual})
    rig->run(profile, {{0.2, true}, {0.22, false}}, kResolution);
  ASSERT_EQ(commanded.touches().size(), 1u);
  ASSERT_EQ(actual.touches().size(), 1u);
  const TouchRecord by_command = commanded.touches()[0], by_encoder = actual.touches()[0];
  EXPECT_EQ(by_encoder.position[0], by_command.position[0] + 5000);
  EXPECT_EQ(by_encoder.position[1], by_command.position[1]) << "no reading";
  EXPECT_EQ(by_encoder.position[2], by_command.position[2] + 5000);
}

TEST(Probing, PositionIsThatOfAnEarlierInstantByItsAge) {
  const Profile profile{.feed_mm_s = 10};
  constexpr double kAge = 2e-3, kEdge = 0.2;
  ProbeSettings settings = published_probe();
  settings.position_age = InstantNs(2'000'000);
  TouchRig fresh(profile, published_probe(), kResolution), aged(profile, settings, kResolution);
  for (TouchRig* const rig : {&fresh, &aged})
    rig->run(profile, {{kEdge, true}, {kEdge + 0.02, false}}, kResolution);
  ASSERT_EQ(fresh.touches().size(), 1u);
  ASSERT_EQ(aged.touches().size(), 1u);
  // The rig reads positions without a delay: one that counts as older is that of a later place.
  const double contact = kEdge - kDelay;
  const double moved_nm = (profile.at(contact + kAge) - profile.at(contact)) * 1e6;
  EXPECT_GT(std::abs(moved_nm), 10'000);
  EXPECT_NEAR(static_cast<double>(aged.touches()[0].position[0] - fresh.touches()[0].position[0]), moved_nm,
              200);
}

TEST(Probing, TouchWaitsForAFrameThatIsBeingWritten) {
  const Profile profile{.feed_mm_s = 10};
  TouchRig rig(profile, published_probe(), kResolution);
  auto& exchange = const_cast<Exchange&>(rig.service->exchange());
  {
    const InterruptedWrite write(exchange.workpiece);
    rig.run(profile, {{0.2, true}, {0.22, false}}, kResolution);
    EXPECT_TRUE(rig.touches().empty());
  }
  rig.plant.advance(), rig.service->tick();
  EXPECT_EQ(rig.touches().size(), 1u);
}

TEST(Probing, TouchesThatWaitedArePublishedInTheirOrder) {
  const Profile profile{.feed_mm_s = 10};
  TouchRig rig(profile, published_probe(), kResolution);
  auto& exchange = const_cast<Exchange&>(rig.service->exchange());
  {
    const InterruptedWrite write(exchange.workpiece);
    rig.run(profile, {{0.20, true}, {0.21, false}, {0.24, true}, {0.25, false}, {0.28, true}, {0.29, false}},
            kResolution);
    EXPECT_TRUE(rig.touches().empty());
  }
  rig.plant.advance(), rig.service->tick();
  const auto touches = rig.touches();
  ASSERT_EQ(touches.size(), 3u);
  for (std::size_t i = 1; i < 3; ++i)
    EXPECT_NEAR(static_cast<double>(touches[i].time_ns - touches[i - 1].time_ns), 40e6, 2e3)
        << "two resolutions of the time stamps";
}

/// Deviation of X: 100 um in 100 mm.
constexpr const char* kScaledMachine = R"xml(<machine name="scaled">
  <variables>
    <static><k value="0.001" nominal="0" unit=""/></static>
    <machineaxes><X rotary="false" min="0" max="600" maxcorrection="1" maxslew="50"/></machineaxes>
  </variables>
  <transforms branch="tool"><sixdof n="1" X="X+k*X" Y="0" Z="0" rX="0" rY="0" rZ="0"/></transforms>
</machine>)xml";

// Without a correction the tool is at the counted position plus the deviation of the axis. With the whole
// correction the tool is at the counted position.
TEST(Probing, CompensatedPositionHasTheDeviationThatNoDriveCorrects) {
  const Machine machine = parse_machine(kScaledMachine, "scaled.xml");
  const auto image = compile_machine(machine, kScaledMachine, {}).image;
  const Profile profile{.feed_mm_s = 1};
  for (const bool active : {false, true}) {
    TouchRig rig(profile, published_probe(), kResolution);
    ASSERT_EQ(rig.service->boot_with(image).fault, UploadFault::kNone);
    if (active) {
      for (int i = 0; i < 500; ++i) rig.plant.advance(), rig.service->tick();
      rig.service->order(Command::kActivate);
      for (int i = 0; i < 3000; ++i) rig.plant.advance(), rig.service->tick();
    }
    rig.plant.release();
    for (int i = 0; i < 1000; ++i) rig.plant.advance(), rig.service->tick();
    rig.line.put(rig.clock.now(), true);
    for (int i = 0; i < 20; ++i) rig.plant.advance(), rig.service->tick();
    ASSERT_EQ(rig.service->cycle().mode(), active ? Mode::kActive : Mode::kReady);
    ASSERT_EQ(rig.touches().size(), 1u);
    const TouchRecord touch = rig.touches()[0];
    EXPECT_EQ(touch.flags & kTouchUncompensated, 0) << "the deviation is known";
    const double deviation = active ? 0 : 1e-3 * static_cast<double>(touch.position[0]);
    // At the corrected position the deviation is k X / (1 + k), k^2 X = 11 nm less at 11 mm; a tick of motion
    // (1 um) changes it by 1 nm.
    EXPECT_NEAR(static_cast<double>(touch.compensated[0] - touch.position[0]), deviation, 15);
    EXPECT_EQ(touch.compensated[2], touch.position[2]) << "the image corrects X alone";
  }
}

TEST(Probing, TouchOfAFaultedBoardIsMarked) {
  const Profile profile{.feed_mm_s = 10};
  for (const Fault fault : {Fault::kNone, Fault::kOverrun}) {
    TouchRig rig(profile, published_probe(), kResolution);
    rig.service->cycle().restore(fault);
    rig.run(profile, {{0.2, true}, {0.22, false}}, kResolution);
    ASSERT_EQ(rig.touches().size(), 1u);
    EXPECT_EQ((rig.touches()[0].flags & kTouchWhileFaulted) != 0, fault != Fault::kNone);
  }
}

TEST(Probing, TurnsIntoTheWorkpiecesCoordinates) {
  const Profile profile{.feed_mm_s = 10};
  TouchRig rig(profile, published_probe(), kResolution);
  WorkpieceFrame frame;
  frame.origin[0] = PositionNm(3'000'000), frame.origin[1] = PositionNm(-2'000'000),
  frame.origin[2] = PositionNm(1'000'000);
  frame.cosine = static_cast<std::int32_t>(std::lround(std::cos(0.5) * WorkpieceFrame::kOne));
  frame.sine = static_cast<std::int32_t>(std::lround(std::sin(0.5) * WorkpieceFrame::kOne));
  ASSERT_TRUE(frame.valid());
  const_cast<Exchange&>(rig.service->exchange()).workpiece.publish(frame);
  rig.run(profile, {{0.2, true}, {0.22, false}}, kResolution);
  const auto touches = rig.touches();
  ASSERT_EQ(touches.size(), 1u);
  const double x = static_cast<double>(touches[0].compensated[0]) - 3e6,
               y = static_cast<double>(touches[0].compensated[1]) + 2e6;
  EXPECT_NEAR(static_cast<double>(touches[0].workpiece_nm[0]), std::cos(0.5) * x + std::sin(0.5) * y, 2);
  EXPECT_NEAR(static_cast<double>(touches[0].workpiece_nm[1]), std::cos(0.5) * y - std::sin(0.5) * x, 2);
  EXPECT_EQ(touches[0].workpiece_nm[2], -8'000'000);
  frame.sine += 1 << 10;
  EXPECT_FALSE(frame.valid());
}

/// Requests that go straight into a board's link.
class Direct : public Transport {
 public:
  explicit Direct(Link& link) : link_(link) {}
  std::vector<std::uint8_t> ask(const std::vector<std::uint8_t>& request) override {
    std::vector<std::uint8_t> reply(kMaxReplyBytes);
    reply.resize(
        link_.answer(request.data(), static_cast<std::uint32_t>(request.size()), reply.data(), TimeUs(1)));
    return reply;
  }

 private:
  Link& link_;
};

TEST(Probing, GivesAReaderEveryTouchOrTheNumberOfThoseThatAreGone) {
  const Profile profile{.feed_mm_s = 10, .cruise_mm = 200};
  TouchRig rig(profile, published_probe(), kResolution);
  auto& exchange = const_cast<Exchange&>(rig.service->exchange());
  const Wiring wiring{{{"X"}, {"Y"}, {"Z"}}, {}};
  const BoardIdentity nobody;
  Link link(exchange, const_cast<Uploader&>(rig.service->uploader()), wiring, TimeUs(1000), nobody);
  Client client(std::make_unique<Direct>(link));
  client.workpiece({1, 2, 3}, 90);
  std::vector<std::pair<double, bool>> edges;
  for (int i = 0; i < 300; ++i) edges.insert(edges.end(), {{0.1 + 0.05 * i, true}, {0.12 + 0.05 * i, false}});
  rig.run(profile, edges, kResolution);
  std::uint64_t next = 0, lost = 0, read = 0;
  for (BoardTouches got; !(got = client.touches(next)).touches.empty(); next = got.next) {
    lost += got.lost;
    for (const BoardTouch& touch : got.touches) {
      EXPECT_EQ(touch.number, lost + read);
      ++read;
      ASSERT_TRUE(touch.has_position && touch.workpiece);
      EXPECT_NEAR((*touch.workpiece)[0], touch.position[1] - 2, 1e-5);
      EXPECT_NEAR((*touch.workpiece)[1], 1 - touch.position[0], 1e-5);
      EXPECT_NEAR((*touch.workpiece)[2], -10, 1e-5);
    }
  }
  EXPECT_EQ(read, Exchange::kTouches);
  EXPECT_EQ(lost + read, 300u);
  EXPECT_THROW(client.workpiece({1e9, 0, 0}, 0), InputError);
}

/// The devices of a board with axes that stand still, and a probe with as many edges as the test says.
class StandingBoard : public PositionReader,
                      public InputReader,
                      public CorrectionWriter,
                      public ProbeLine,
                      public Clock {
 public:
  void begin_tick() noexcept override {}
  HalFault read_axis(std::uint32_t axis, AxisReading& reading) noexcept override {
    reading.position = AxisPosition(1000 * (axis + 1));
    read |= 1u << axis;
    return HalFault::kNone;
  }
  HalFault read_input(std::uint32_t, InputMicro&) noexcept override { return HalFault::kNoReading; }
  HalFault write_correction(std::uint32_t, AxisTravel) noexcept override { return HalFault::kNone; }
  HalFault read_edge(ProbeEdge& edge) noexcept override {
    if (edges == 0) return HalFault::kNoReading;
    edge = {at, made = !made};
    at = at + InstantNs(spacing_ns);
    --edges;
    return HalFault::kNone;
  }
  InstantNs resolution() const noexcept override { return {}; }
  InstantNs now() noexcept override { return {}; }
  HalFault sleep_until(InstantNs) noexcept override { return HalFault::kNone; }
  std::uint32_t read = 0;  // bit i: axis i was read
  int edges = 0;
  bool made = false;
  InstantNs at;
  std::int64_t spacing_ns = 2'000'000;
};

/// A probe at a board with `axes` axes.
struct StandingBench {
  explicit StandingBench(std::uint32_t axes, std::uint8_t z = kMaxAxes) {
    settings.axes = axes;
    settings.xyz[0] = 0, settings.xyz[1] = 1, settings.xyz[2] = z;
    Wiring wiring;
    const char* const names[] = {"X", "Y", "Z", "A", "B", "C", "U", "V"};
    for (std::uint32_t i = 0; i < axes; ++i) wiring.axes.push_back({names[i]});
    cycle.emplace(wiring, TimeUs(1000), Board{devices, devices, devices, devices});
    probing.emplace(devices, settings, &actual);
  }
  void tick() {
    woke = woke + InstantNs(1'000'000);
    const TickReport report = cycle->tick(TimeUs(woke.count / 1000), Command::kNone);
    probing->after_tick(*cycle, report, woke, TimeUs(woke.count / 1000 + ahead_us), exchange);
  }
  StandingBoard devices, actual;
  ProbeSettings settings;
  std::optional<Cycle> cycle;
  std::optional<Probing> probing;
  Exchange exchange;
  InstantNs woke;
  std::int64_t ahead_us = 0;  // time t of the machine file, before the clock of the board
};

TEST(Probing, ReadsTheActualPositionsOfTheAxesOfTheBoardOnly) {
  for (const std::uint32_t axes : {1u, 3u, 7u, kMaxAxes}) {
    StandingBench bench(axes);
    bench.tick();
    EXPECT_EQ(bench.actual.read, (1u << axes) - 1) << axes;
  }
}

// The index kMaxAxes names no axis, also at a board that has so many.
TEST(Probing, BoardWithAllAxesAndWithoutAZHasNoWorkpiece) {
  struct {
    std::uint32_t axes;
    std::uint8_t z;
    bool in_workpiece;
  } const cases[] = {
      {kMaxAxes, kMaxAxes, false}, {kMaxAxes, kMaxAxes - 1, true}, {3, 3, false}, {3, 2, true}};
  for (const auto& wanted : cases) {
    StandingBench bench(wanted.axes, wanted.z);
    for (int i = 0; i < 8; ++i) bench.tick();
    bench.devices.edges = 1, bench.devices.at = bench.woke + InstantNs(300'000);
    for (int i = 0; i < 8; ++i) bench.tick();
    TouchRecord touch;
    ASSERT_TRUE(bench.exchange.touches.read(0, touch)) << wanted.axes;
    EXPECT_EQ(touch.fault, 0);
    EXPECT_EQ(touch.position[wanted.axes - 1], 1000 * wanted.axes);
    EXPECT_EQ((touch.flags & kTouchInWorkpiece) != 0, wanted.in_workpiece) << wanted.axes << " " << +wanted.z;
    EXPECT_EQ(touch.workpiece_nm[2], wanted.in_workpiece ? 1000 * (wanted.z + 1) : 0);
  }
}

// Further edges wait for the next tick.
TEST(Probing, ReadsSixteenEdgesInATick) {
  StandingBench bench(3);
  bench.tick();
  bench.devices.spacing_ns = 10, bench.devices.at = bench.woke;
  bench.devices.edges = static_cast<int>(Probing::kMostEdges) + 1;
  bench.tick();
  EXPECT_EQ(bench.devices.edges, 1);
  bench.tick();
  EXPECT_EQ(bench.devices.edges, 0);
}

// The time of a touch is that of the contact, a delay before the edge, as time t of the machine file.
TEST(Probing, TimeOfATouchIsThatOfTheContact) {
  for (const std::int64_t ahead_us : {0, 3600, -2000}) {
    StandingBench bench(3);
    bench.ahead_us = ahead_us;
    bench.probing->set_delay(InstantNs(1'200'000));
    for (int i = 0; i < 8; ++i) bench.tick();
    bench.devices.edges = 1, bench.devices.at = InstantNs(8'300'000);
    for (int i = 0; i < 8; ++i) bench.tick();
    TouchRecord touch;
    ASSERT_TRUE(bench.exchange.touches.read(0, touch));
    EXPECT_EQ(touch.time_ns, 8'300'000 - 1'200'000 + 1000 * ahead_us);
  }
}

}  // namespace
}  // namespace vernier::probing_test
