// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware/core/cycle/cycle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "tables/link_format.h"
#include "tests/unit/firmware/rig.h"

namespace vernier::cycle_test {
namespace {

TEST(Cycle, CorrectionIsZeroUntilActivated) {
  Rig rig;
  for (int i = 0; i < 1000; ++i) rig.tick();
  EXPECT_EQ(rig.cycle().mode(), Mode::kReady);
  EXPECT_EQ(rig.plant().written(0), AxisTravel(0));
}

TEST(Cycle, ActiveCorrectionIsMinusTheDeviation) {
  Rig rig({}, {}, 1);
  ASSERT_TRUE(rig.run_to(Mode::kActive));
  int compared = 0;
  for (int i = 0; i < 20000; ++i) {
    const TickReport report = rig.tick();
    if ((report.output.flags & kSlewing) != 0) continue;
    AxisReading x, y;
    rig.plant().read_axis(0, x), rig.plant().read_axis(1, y);
    const double x_nm = static_cast<double>(x.position.count), y_nm = static_cast<double>(y.position.count);
    // The compiler's bound is below 2 nm for either axis.
    const double wanted = std::clamp(-(1e-4 * x_nm + 4000 * x.sense) / (1 + 1e-4), -30'000.0, 30'000.0);
    ASSERT_NEAR(static_cast<double>(rig.plant().written(0).count), wanted, 2);
    // Exactly: at the corrected position the growth is another, c = -k (y + c).
    ASSERT_NEAR(static_cast<double>(rig.plant().written(1).count), -1e-4 * y_nm / (1 + 1e-4), 2);
    ++compared;
  }
  EXPECT_GT(compared, 15000);
  EXPECT_GT(rig.cycle().health().saturated, 100u) << "the range goes beyond the limit of X";
}

TEST(Cycle, FeedIsTheSpeedOfTheLinearAxesWhereTheControllerTellsNone) {
  Rig rig;
  for (int i = 0; i < 500; ++i) rig.tick();
  AxisReading x, y;
  rig.plant().read_axis(0, x), rig.plant().read_axis(1, y);
  const double speed =
      std::hypot(static_cast<double>(x.velocity.count), static_cast<double>(y.velocity.count));
  ASSERT_GT(speed, 1e6);
  EXPECT_NEAR(static_cast<double>(rig.cycle().path().feed.count), 60 * speed, 61);
}

TEST(Cycle, ActiveBeginsWithTheWholeCorrection) {
  Rig rig({}, {}, 10);  // 200 um at the far end of Y: 100 ticks of slew beyond the ramp at most
  ASSERT_TRUE(rig.run_to(Mode::kReady));
  while (rig.cycle().mode() != Mode::kActive) {
    const TickReport report = rig.tick(rig.asked() ? Command::kNone : Command::kActivate);
    if (report.mode == Mode::kActive) {
      EXPECT_EQ(report.output.flags & kSlewing, 0u);
      EXPECT_EQ(rig.cycle().weight(), kFullWeight);
      EXPECT_EQ(rig.plant().written(1).count, report.output.correction[1].counts);
    }
  }
}

struct Injected {
  PlantFaultKind kind;
  std::uint32_t index;
  std::int64_t ticks, counts;
  Fault latched;
  std::uint64_t Health::*counter;
  const char* name;
};

class CycleFault : public testing::TestWithParam<Injected> {};

TEST_P(CycleFault, RampsOutLatchesAndIsCounted) {
  // GIVEN a machine in Active, and one thing that goes wrong at tick 1500
  const Injected& injected = GetParam();
  PlantOptions options;
  options.faults = {{injected.kind, injected.index, 1500, injected.ticks, injected.counts}};
  CycleLimits limits;
  limits.input[0] = {0, 40'000'000, 500'000};  // 0..40 degC, half a degree between two readings
  Rig rig(options, limits, 5);
  ASSERT_TRUE(rig.run_to(Mode::kActive));
  while (rig.plant().tick() < 1498) rig.tick();
  ASSERT_EQ(rig.cycle().latched(), Fault::kNone);
  ASSERT_NE(rig.plant().written(0), AxisTravel(0));

  // WHEN it happens
  bool ramped = false;
  for (int i = 0; i < 2000; ++i) {
    const AxisTravel before[2] = {rig.plant().written(0), rig.plant().written(1)};
    const TickReport report = rig.tick();
    ramped = ramped || report.mode == Mode::kRampOut;
    // THEN the correction only shrinks while it is taken out, within the slew limit; but a refused write is
    // repeated as it was
    if (report.mode == Mode::kRampOut && injected.kind != PlantFaultKind::kWriteFailure) {
      for (std::uint32_t axis = 0; axis < 2; ++axis)
        ASSERT_LE(std::abs(rig.plant().written(axis).count), std::abs(before[axis].count));
    }
    ASSERT_LE(std::abs((rig.plant().written(0) - before[0]).count), kSmallSlewX);
    ASSERT_LE(std::abs((rig.plant().written(1) - before[1]).count), kSmallSlewY);
  }
  // and the fault is latched and counted, and stays although its cause has gone
  EXPECT_TRUE(ramped);
  EXPECT_EQ(rig.cycle().mode(), Mode::kFaulted);
  EXPECT_EQ(rig.cycle().latched(), injected.latched);
  EXPECT_EQ(rig.cycle().health().faults, 1u);
  EXPECT_GT(rig.cycle().health().*injected.counter, 0u);
  EXPECT_EQ(rig.plant().written(0), AxisTravel(0));
  EXPECT_EQ(rig.plant().written(1), AxisTravel(0));

  // and after an explicit clearing it can be activated again
  rig.tick(Command::kClearFault);
  EXPECT_EQ(rig.cycle().mode(), Mode::kChecking);
  EXPECT_TRUE(rig.run_to(Mode::kActive));
}

// The numbers of firmware/docs/hazards.md. The tick of the fault counts; a tolerance of n ticks detects in
// tick n + 1. The removal takes the ticks of the ramp, within the slew limits of this machine.
TEST_P(CycleFault, IsDetectedInTheTicksOfThePage) {
  static const std::map<std::string, int> kTicks = {{"MissingPosition", 4}, {"Jump", 1},
                                                    {"SensorLost", 101},    {"WriteFailure", 1},
                                                    {"ReferenceLost", 1},   {"SensorBeyondItsRange", 1},
                                                    {"SensorJumps", 1}};
  const Injected& injected = GetParam();
  PlantOptions options;
  options.faults = {{injected.kind, injected.index, 1500, injected.ticks, injected.counts}};
  CycleLimits limits;
  limits.input[0] = {0, 40'000'000, 500'000};
  Rig rig(options, limits, 5);
  ASSERT_TRUE(rig.run_to(Mode::kActive));
  int ticks = 0, removal = 0;
  while (rig.cycle().latched() == Fault::kNone && ticks < 1000) {
    rig.tick();
    if (rig.plant().tick() >= 1500) ++ticks;
  }
  EXPECT_EQ(rig.cycle().latched(), injected.latched);
  while (rig.cycle().mode() == Mode::kRampOut && removal < 1000) {
    rig.tick();
    ++removal;
  }
  if (const auto expected = kTicks.find(injected.name); expected != kTicks.end()) {
    EXPECT_EQ(ticks, expected->second);
  } else {  // a frozen axis is detected after 0.2 mm of its speed
    const double speed_mm_s =
        1e-6 * static_cast<double>(rig.cycle().axis_state(injected.index).velocity.count);
    EXPECT_NEAR(ticks, 1000 * 0.2 / std::abs(speed_mm_s), 0.1 * ticks);
  }
  EXPECT_LE(removal, static_cast<int>(kRampTicks) + static_cast<int>(injected.ticks));
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, CycleFault,
    testing::Values(Injected{PlantFaultKind::kMissingPosition, 0, 50, 0, Fault::kPositionMissing,
                             &Health::missing_readings, "MissingPosition"},
                    Injected{PlantFaultKind::kFrozenAxis, 0, 300, 0, Fault::kPositionFrozen,
                             &Health::frozen_readings, "FrozenAxis"},
                    Injected{PlantFaultKind::kJump, 1, 1, 5'000'000, Fault::kPositionJump, &Health::jumps,
                             "Jump"},
                    Injected{PlantFaultKind::kSensorLost, 0, 200, 0, Fault::kInputMissing,
                             &Health::missing_inputs, "SensorLost"},
                    Injected{PlantFaultKind::kWriteFailure, 1, 20, 0, Fault::kWriteFailed,
                             &Health::failed_writes, "WriteFailure"},
                    Injected{PlantFaultKind::kReferenceLost, 1, 30, 0, Fault::kReferenceLost,
                             &Health::unreferenced, "ReferenceLost"},
                    Injected{PlantFaultKind::kSensorWild, 0, 40, 300'000'000, Fault::kInputImplausible,
                             &Health::implausible, "SensorBeyondItsRange"},
                    Injected{PlantFaultKind::kSensorWild, 0, 40, -700'000, Fault::kInputImplausible,
                             &Health::implausible, "SensorJumps"}),
    [](const testing::TestParamInfo<Injected>& parameter) { return parameter.param.name; });

TEST(Cycle, ShortSilenceIsCountedAndTolerated) {
  PlantOptions options;
  options.faults = {{PlantFaultKind::kMissingPosition, 0, 1500, 3},
                    {PlantFaultKind::kSensorLost, 0, 1600, 90}};
  Rig rig(options);
  ASSERT_TRUE(rig.run_to(Mode::kActive));
  while (rig.plant().tick() < 2000) rig.tick();
  EXPECT_EQ(rig.cycle().mode(), Mode::kActive);
  EXPECT_EQ(rig.cycle().health().missing_readings, 3u);
  EXPECT_EQ(rig.cycle().health().missing_inputs, 90u);
}

// A tick counts towards readiness if every axis has been read once, although so short a silence is no fault.
TEST(Cycle, AxisThatIsSilentAtFirstIsCheckedForAsLongAsTheOthers) {
  const auto ticks_to_ready = [](std::int64_t silent) {
    PlantOptions options;
    if (silent > 0) options.faults = {{PlantFaultKind::kMissingPosition, 1, 0, silent}};
    Rig rig(options);
    EXPECT_TRUE(rig.run_to(Mode::kReady));
    EXPECT_EQ(rig.cycle().health().faults, 0u);
    return rig.cycle().health().ticks;
  };
  EXPECT_EQ(ticks_to_ready(2), ticks_to_ready(0) + 2);
}

TEST(Cycle, SilentSensorFromTheStartKeepsItChecking) {
  PlantOptions options;
  options.faults = {{PlantFaultKind::kSensorLost, 0, 0, 100000}};
  Rig rig(options);
  for (int i = 0; i < 3000; ++i) rig.tick(Command::kActivate);
  EXPECT_EQ(rig.cycle().mode(), Mode::kChecking);
  EXPECT_EQ(rig.plant().written(0), AxisTravel(0));
}

/// The small machine, whose Y follows two thermometers.
std::unique_ptr<LoadedImage> image_with_two_inputs() {
  std::string text = kSmallMachine;
  const auto put = [&](const std::string& from, const std::string& to) {
    text.replace(text.find(from), from.size(), to);
  };
  put("<T unit", "<S unit=\"degC\" reference=\"20\"/><T unit");
  put("cte*Y*(T-20)", "cte*Y*(T-20)+cte*Y*(S-20)");
  const Machine machine = parse_machine(text, "small.xml");
  return load_image(compile_machine(machine, text, {}).image, machine);
}

/// Inputs of which one can be silent.
struct TwoInputs : InputReader {
  HalFault read_input(std::uint32_t input, InputMicro& value) noexcept override {
    ++reads[input];
    if (silent[input]) return HalFault::kNoReading;
    value = InputMicro(21'000'000);
    return HalFault::kNone;
  }
  bool silent[2] = {};
  int reads[kMaxInputs + 1] = {};
};

TEST(BoundProgram, IsInterpretedIfItsDenseFormHasTooLittleMemory) {
  const auto image = image_with_two_inputs();
  const std::uint32_t size = dense_size(image->view.program().equation);
  for (const std::uint32_t cells : {0u, size - 1, size}) {
    const DenseStore store(cells);
    EXPECT_EQ(store.memory().cells != nullptr, cells != 0);
    const BoundProgram bound(image->view, store.memory());
    EXPECT_EQ(bound.compensator.dense(), cells == size);
  }
  EXPECT_FALSE(BoundProgram(image->view).compensator.dense());
}

// A second reading would be of another instant, and a reading beyond the board's inputs of no device.
TEST(Cycle, EachInputIsReadOnceATickAndNoneBeyondThem) {
  const auto image = image_with_two_inputs();
  Roaming motion({{0, 600'000'000}, {0, 200'000'000}}, {}, TimeUs(1000), 0.1, 1);
  SimPlant plant(motion, 2, 0, {});
  SimClock clock;
  TwoInputs inputs;
  Cycle cycle(image->view, Board{clock, plant, inputs, plant}, CycleLimits{});
  for (int tick = 1; tick <= 100; ++tick) {
    plant.advance();
    cycle.tick(TimeUs(1000 * tick), Command::kNone);
  }
  EXPECT_EQ(inputs.reads[0], 100);
  EXPECT_EQ(inputs.reads[1], 100);
  EXPECT_EQ(inputs.reads[2], 0);
}

TEST(Cycle, EachInputOfTheProgramIsReadAndItsSilenceIsAFault) {
  const auto image = image_with_two_inputs();
  ASSERT_EQ(image->view.inputs().size, 2u);
  for (const std::size_t silent : {0u, 1u}) {
    Roaming motion({{0, 600'000'000}, {0, 200'000'000}}, {}, TimeUs(1000), 0.1, 1);
    SimPlant plant(motion, 2, 0, {});
    SimClock clock;
    TwoInputs inputs;
    Cycle cycle(image->view, Board{clock, plant, inputs, plant}, CycleLimits{});
    int ticks = 0;
    const auto run = [&](int count) {
      for (int i = 0; i < count; ++i) {
        plant.advance();
        cycle.tick(TimeUs(1000 * ++ticks),
                   cycle.mode() == Mode::kReady ? Command::kActivate : Command::kNone);
      }
    };
    run(2000);
    EXPECT_EQ(cycle.mode(), Mode::kActive);
    inputs.silent[silent] = true;
    run(200);
    EXPECT_EQ(cycle.latched(), Fault::kInputMissing) << "input " << silent;
  }
}

// The drive of an axis keeps its slew limit, so that the correction that an earlier program left is removed.
TEST(Cycle, AxisThatTheNextProgramDoesNotCorrectGoesToZero) {
  Rig rig({}, {}, 10);
  ASSERT_TRUE(rig.run_to(Mode::kActive));
  while (std::abs(rig.cycle().written(1).count) < 10'000) rig.tick();
  const auto image = small_image();
  BoundProgram bound(image->view);
  const Output of_x = bound.program.outputs[0];
  bound.program.outputs = {&of_x, 1};
  rig.cycle().use(bound);
  AxisTravel before = rig.cycle().written(1);
  for (int i = 0; i < 2000; ++i) {
    rig.tick();
    ASSERT_LE(std::abs(rig.cycle().written(1).count - before.count), kSmallSlewY);
    before = rig.cycle().written(1);
  }
  EXPECT_EQ(rig.cycle().written(1), AxisTravel{});
  EXPECT_EQ(rig.cycle().wanted(1), AxisTravel{});
  EXPECT_EQ(rig.cycle().limits(1), 0) << "an axis without a correction is at no limit";
  EXPECT_EQ(rig.cycle().mode(), Mode::kActive);
}

// GIVEN a correction of Y, and then a program with which Y may not move THEN the correction stays, and the
// next program, which corrects nothing, removes it.
TEST(Cycle, ProgramWhoseAxisMayNotMoveStrandsNoCorrection) {
  Rig rig({}, {}, 10);
  ASSERT_TRUE(rig.run_to(Mode::kActive));
  while (std::abs(rig.cycle().written(1).count) < 10'000) rig.tick();
  const auto image = small_image();
  BoundProgram still(image->view), empty;
  std::vector<Output> outputs(still.program.outputs.begin(), still.program.outputs.end());
  for (Output& out : outputs) out.slew = 0;
  still.program.outputs = {outputs.data(), static_cast<std::uint32_t>(outputs.size())};
  still.compensator = Compensator(still.program);
  const AxisTravel held = rig.cycle().written(1);
  rig.cycle().use(still);
  for (int i = 0; i < 100; ++i) rig.tick();
  EXPECT_EQ(rig.cycle().written(1), held);
  rig.cycle().use(empty);
  for (int i = 0; i < 2000; ++i) rig.tick();
  EXPECT_EQ(rig.cycle().written(1), AxisTravel{});
}

// The slowest drive moves by one count in a tick, on a board that had no program before.
TEST(Cycle, ProgramWithASlewOfOneCountMovesItsAxes) {
  const auto image = small_image();
  Roaming motion({{0, 600'000'000}, {0, 200'000'000}}, {InputMicro(20'000'000)}, TimeUs(1000), 0.1, 1);
  SimClock clock;
  SimPlant plant(motion, 2, 1, {});
  Cycle cycle({{{"X"}, {"Y"}}, {"T"}}, TimeUs(1000), Board{clock, plant, plant, plant});
  BoundProgram slow(image->view);
  std::vector<Output> outputs(slow.program.outputs.begin(), slow.program.outputs.end());
  for (Output& out : outputs) out.slew = 1;
  slow.program.outputs = {outputs.data(), static_cast<std::uint32_t>(outputs.size())};
  slow.compensator = Compensator(slow.program);
  cycle.use(slow);
  plant.release();
  for (int tick = 1; tick <= 1000; ++tick) {
    plant.advance();
    const AxisTravel before = cycle.written(0);
    const bool ready = cycle.mode() == Mode::kReady && cycle.weight() == WeightQ16{};
    cycle.tick(TimeUs(1000 * tick), ready ? Command::kActivate : Command::kNone);
    ASSERT_LE(std::abs(cycle.written(0).count - before.count), 1);
  }
  EXPECT_GT(std::abs(cycle.written(0).count), 500);
}

// GIVEN a machine with as many inputs as an image may have, each with another reference
// THEN the program knows each reference and reads each input.
TEST(BoundProgram, KnowsTheReferenceOfEachOfTheMostInputs) {
  std::string text = kSmallMachine, inputs, sum;
  for (std::uint32_t i = 0; i < kMaxInputs; ++i) {
    const std::string name = "S" + std::to_string(i), reference = std::to_string(10 + i);
    inputs += "<" + name + " unit=\"degC\" reference=\"" + reference + "\"/>";
    sum += "+cte*Y*(" + name + "-" + reference + ")";
  }
  const auto put = [&](const std::string& from, const std::string& to) {
    text.replace(text.find(from), from.size(), to);
  };
  put("<T unit=\"degC\" reference=\"20\"/>", inputs);
  put("+cte*Y*(T-20)", sum);
  const Machine machine = parse_machine(text, "small.xml");
  const auto image = load_image(compile_machine(machine, text, {}).image, machine);
  ASSERT_EQ(image->view.inputs().size, kMaxInputs);
  struct {
    alignas(BoundProgram) std::byte place[sizeof(BoundProgram)];
    std::int64_t behind = -77;
  } memory;
  const BoundProgram& bound = *std::construct_at(reinterpret_cast<BoundProgram*>(memory.place), image->view);
  EXPECT_EQ(memory.behind, -77) << "nothing is written behind the last reference";
  for (std::uint32_t i = 0; i < kMaxInputs; ++i) {
    EXPECT_EQ(bound.reference[i], InputMicro(1'000'000 * (10 + i))) << i;
    EXPECT_TRUE(bound.reads_input[i]) << i;
    EXPECT_EQ(bound.input[i], i);
  }
  std::destroy_at(&bound);
}

TEST(Cycle, TicksCountAsActiveOnlyWhileTheyAre) {
  Rig rig;
  ASSERT_TRUE(rig.run_to(Mode::kReady));
  for (int i = 0; i < 50; ++i) rig.tick();
  EXPECT_EQ(rig.cycle().health().active_ticks, 0u);
  std::uint64_t active = 0;
  const std::uint64_t before = rig.cycle().health().ticks;
  for (int i = 0; i < 1000; ++i) {
    const TickReport report = rig.tick(i == 0 ? Command::kActivate : Command::kNone);
    active += report.mode == Mode::kActive ? 1 : 0;
  }
  EXPECT_GT(active, 500u);
  EXPECT_EQ(rig.cycle().health().active_ticks, active);
  EXPECT_EQ(rig.cycle().health().ticks - before, 1000u);
}

TEST(Cycle, RefusedWriteIsRepeatedWithTheSameValue) {
  PlantOptions options;
  options.faults = {{PlantFaultKind::kWriteFailure, 0, 1500, 100}};
  Rig rig(options);
  ASSERT_TRUE(rig.run_to(Mode::kActive));
  while (rig.plant().tick() < 1499) rig.tick();
  const AxisTravel held = rig.plant().written(0);
  while (rig.plant().tick() < 1599) rig.tick();
  EXPECT_EQ(rig.plant().written(0), held);
  rig.tick();
  EXPECT_LE(std::abs((rig.plant().written(0) - held).count), kSmallSlewX);
  EXPECT_EQ(rig.cycle().health().failed_writes, 100u);
}

CycleLimits board_lets_10_um_out() {
  CycleLimits limits;
  limits.axis[0].own = true;
  limits.axis[0].limits = limits.linear;
  limits.axis[0].largest = 10'000;
  return limits;
}

// The image may correct X by 30 um and says so; the board lets 10 um out, whatever the image says.
TEST(Cycle, BoardsOwnLimitHoldsAndIsTold) {
  Rig rig({}, board_lets_10_um_out());
  ASSERT_TRUE(rig.run_to(Mode::kActive));
  bool held = false;
  for (int i = 0; i < 8000; ++i) {
    rig.tick();
    ASSERT_LE(std::abs(rig.plant().written(0).count), 10'000);
    const bool at_limit = (rig.cycle().limits(0) & kAtBoardLimit) != 0;
    ASSERT_EQ(at_limit, std::abs(rig.cycle().wanted(0).count) > 10'000);
    held = held || at_limit;
  }
  EXPECT_TRUE(held);
  EXPECT_GT(rig.cycle().health().saturated, 0u);
}

TEST(Cycle, EachSaturatedTickIsCountedOnce) {
  Rig rig({}, board_lets_10_um_out());
  ASSERT_TRUE(rig.run_to(Mode::kActive));
  const Health before = rig.cycle().health();
  std::uint64_t saturated = 0, by_image = 0, by_board = 0, slewing = 0, beyond = 0;
  for (int i = 0; i < 20'000; ++i) {
    const TickReport report = rig.tick();
    const bool image = (report.output.flags & kSaturated) != 0,
               board = (rig.cycle().limits(0) & kAtBoardLimit) != 0;
    saturated += image || board ? 1 : 0;
    slewing += (report.output.flags & kSlewing) != 0 ? 1 : 0;
    beyond += (report.output.flags & kBeyondRange) != 0 ? 1 : 0;
    by_image += image ? 1 : 0, by_board += board && !image ? 1 : 0;
  }
  EXPECT_GT(by_image, 0u) << "beyond 30 um";
  EXPECT_GT(by_board, 0u) << "between 10 and 30 um";
  EXPECT_EQ(rig.cycle().health().saturated - before.saturated, saturated);
  EXPECT_EQ(rig.cycle().health().slewing - before.slewing, slewing);
  EXPECT_EQ(rig.cycle().health().beyond_range - before.beyond_range, beyond);
  EXPECT_LT(beyond, 20'000u);
}

// With a limit of 0 every correction is at its limit, but no correction is not.
TEST(Cycle, AxisWithoutACorrectionIsAtNoLimit) {
  Rig rig;  // at 20 degC, where Y needs none
  const auto image = small_image();
  BoundProgram bound(image->view);
  std::vector<Output> outputs(bound.program.outputs.begin(), bound.program.outputs.end());
  for (Output& out : outputs) out.limit = 0;
  bound.program.outputs = {outputs.data(), static_cast<std::uint32_t>(outputs.size())};
  rig.cycle().use(bound);
  for (int i = 0; i < 100; ++i) rig.tick();
  EXPECT_NE(rig.cycle().wanted(0).count, 0);
  EXPECT_NE(rig.cycle().limits(0) & kAtImageLimit, 0);
  EXPECT_EQ(rig.cycle().wanted(1).count, 0);
  EXPECT_EQ(rig.cycle().limits(1) & kAtImageLimit, 0);
}

TEST(Cycle, InputAtTheEndOfItsPlausibleRangeIsPlausible) {
  Rig reference;
  ASSERT_TRUE(reference.run_to(Mode::kReady));
  const std::int64_t value = reference.cycle().input_value(0).count;
  const auto implausible = [&](std::int64_t low, std::int64_t high) {
    CycleLimits limits;
    limits.input[0] = {low, high, 1'000'000};
    Rig rig({}, limits);
    rig.run_to(Mode::kReady, 300);
    return rig.cycle().health().implausible != 0;
  };
  EXPECT_FALSE(implausible(value, value));
  EXPECT_TRUE(implausible(value + 1, value + 2));
  EXPECT_TRUE(implausible(value - 2, value - 1));
}

/// A plant whose drive takes 5 um at most.
class ShortPlant : public SimPlant {
 public:
  using SimPlant::SimPlant;
  AxisTravel within_range(std::uint32_t, AxisTravel correction) const noexcept override {
    return AxisTravel(std::clamp<std::int64_t>(correction.count, -5000, 5000));
  }
};

TEST(Cycle, EndOfAnOutputIsToldAndAchievedIsWhatItGives) {
  const auto image = small_image();
  Roaming motion({{0, 200'000'000}, {0, 200'000'000}}, {InputMicro(20'000'000)}, TimeUs(1000), 0.1, 1);
  SimClock clock;
  ShortPlant plant(motion, 2, 1, PlantOptions{});
  Cycle cycle(image->view, Board{clock, plant, plant, plant});
  plant.release();
  int free = 0;
  for (int i = 0; i < 4000; ++i) {
    plant.advance();
    const std::uint64_t before = cycle.health().saturated;
    const TickReport report =
        cycle.tick(TimeUs(1000 * i), cycle.mode() == Mode::kReady ? Command::kActivate : Command::kNone);
    const bool held = (report.output.flags & kSaturated) != 0 ||
                      ((cycle.limits(0) | cycle.limits(1)) & (kAtBoardLimit | kAtOutputLimit)) != 0;
    ASSERT_EQ(cycle.health().saturated - before, held ? 1u : 0u) << "tick " << i;
    free += held ? 0 : 1;
  }
  EXPECT_GT(free, 0) << "before it is active";
  ASSERT_EQ(cycle.mode(), Mode::kActive);
  EXPECT_GT(std::abs(cycle.written(0).count), 5000);
  EXPECT_EQ(std::abs(cycle.achieved(0).count), 5000);
  EXPECT_NE(cycle.limits(0) & kAtOutputLimit, 0);
}

/// A board whose axes and inputs give what the test says.
struct GivenDevices : AxisReader, InputReader, CorrectionWriter {
  void begin_tick() noexcept override {}
  HalFault read_axis(std::uint32_t axis, AxisReading& reading) noexcept override {
    ++axis_reads[axis];
    reading.velocity = AxisSpeed(speed[axis]);
    return HalFault::kNone;
  }
  HalFault read_path(PathReading& reading) noexcept override { return reading = path, path_fault; }
  bool gives_motion() const noexcept override { return true; }
  HalFault read_input(std::uint32_t input, InputMicro& value) noexcept override {
    ++input_reads[input];
    value = InputMicro(given);
    return HalFault::kNone;
  }
  HalFault write_correction(std::uint32_t, AxisTravel) noexcept override { return HalFault::kNone; }
  int axis_reads[kMaxAxes] = {}, input_reads[kMaxInputs] = {};
  std::int64_t speed[kMaxAxes] = {}, given = 0;
  PathReading path;
  HalFault path_fault = HalFault::kNone;
};

/// A cycle of given devices and a program that reads `of_axes` of `axes` and `of_inputs` of `inputs`.
struct GivenBench {
  GivenBench(std::uint32_t axes, std::uint32_t of_axes, std::uint32_t inputs, std::uint32_t of_inputs,
             const CycleLimits& limits = {}) {
    Wiring wiring;
    for (std::uint32_t i = 0; i < axes; ++i) wiring.axes.push_back({"X", i + 1 == axes && axes > 3});
    for (std::uint32_t i = 0; i < inputs; ++i) wiring.inputs.push_back("T");
    cycle = std::make_unique<Cycle>(wiring, TimeUs(1000), Board{clock, devices, devices, devices}, limits);
    for (std::uint32_t i = 0; i < kMaxAxes; ++i) bound->axis[i] = i;
    for (std::uint32_t i = 0; i < kMaxInputs; ++i) bound->input[i] = i, bound->reads_input[i] = i < of_inputs;
    bound->program.axis_count = of_axes;
    bound->program.input_count = of_inputs;
    cycle->use(*bound);
  }
  void tick() { cycle->tick(TimeUs(time += 1000), Command::kNone); }
  GivenDevices devices;
  SimClock clock;
  std::unique_ptr<BoundProgram> bound = std::make_unique<BoundProgram>();
  std::unique_ptr<Cycle> cycle;
  std::int64_t time = 0;
};

TEST(Cycle, EachAxisAndInputIsReadOnceATickWhateverTheProgramReads) {
  for (const std::uint32_t devices : {1u, 2u, 5u, kMaxAxes})
    for (std::uint32_t read = 0; read <= devices; ++read) {
      GivenBench bench(devices, read, devices, read);
      for (int i = 0; i < 3; ++i) bench.tick();
      for (std::uint32_t i = 0; i < kMaxAxes; ++i) {
        EXPECT_EQ(bench.devices.axis_reads[i], i < devices ? 3 : 0) << devices << " " << read << " " << i;
        EXPECT_EQ(bench.devices.input_reads[i], i < devices ? 3 : 0) << devices << " " << read << " " << i;
      }
    }
}

// A speed counts up to 1 m/s; the last of more than three axes is rotary here.
TEST(Cycle, FeedOfTheAxesIsTheRootRoundedDownAndEachSpeedIsLimited) {
  struct {
    std::uint32_t axes;
    std::int64_t speed[kMaxAxes], root;
  } const cases[] = {
      {2, {3'000'000, -4'000'000}, 5'000'000},
      {2, {1, 1}, 1},
      {2, {2, 2}, 2},
      {1, {999'999'999}, 999'999'999},
      {1, {1'000'000'000}, 1'000'000'000},
      {1, {1'000'000'001}, 1'000'000'000},
      {1, {-1'000'000'001}, 1'000'000'000},
      {1, {INT64_MIN}, 1'000'000'000},
      {4, {7, 0, 0, 1'000'000}, 7},
      {8,
       {INT64_MAX, INT64_MAX, INT64_MAX, INT64_MAX, INT64_MAX, INT64_MAX, INT64_MAX, INT64_MAX},
       2'645'751'311}};  // the root of 7 m/s
  for (const auto& wanted : cases) {
    GivenBench bench(wanted.axes, 0, 0, 0);
    std::copy_n(wanted.speed, kMaxAxes, bench.devices.speed);
    bench.tick();
    EXPECT_EQ(bench.cycle->path().feed.count, 60 * wanted.root) << wanted.axes << " " << wanted.speed[0];
  }
}

TEST(Cycle, StepOfAnInputAtTheLimitIsPlausibleAndOneMoreIsNot) {
  struct {
    std::int64_t before, after, step;
    bool jumps;
  } const cases[] = {{0, 1000, 1000, false},
                     {0, 1001, 1000, true},
                     {0, -1000, 1000, false},
                     {0, -1001, 1000, true},
                     {INT64_MIN, -1, INT64_MAX, false},
                     {INT64_MIN, 0, INT64_MAX, true},
                     {INT64_MAX, 0, INT64_MAX, false},
                     {INT64_MAX, INT64_MIN, INT64_MAX, true}};
  for (const auto& wanted : cases) {
    CycleLimits limits;
    limits.input[0].low = INT64_MIN, limits.input[0].high = INT64_MAX, limits.input[0].step = wanted.step;
    GivenBench bench(1, 1, 1, 1, limits);
    bench.devices.given = wanted.before;
    bench.tick();
    EXPECT_EQ(bench.cycle->health().implausible, 0u) << "the first has none before it";
    bench.devices.given = wanted.after;
    bench.tick();
    EXPECT_EQ(bench.cycle->health().implausible, wanted.jumps ? 1u : 0u)
        << wanted.before << " " << wanted.after;
    bench.tick();
    EXPECT_EQ(bench.cycle->health().implausible, wanted.jumps ? 1u : 0u) << "a jump is counted once";
  }
}

TEST(Cycle, PathOfTheControllerIsTakenAndKeptWhileItGivesNone) {
  GivenBench bench(2, 0, 0, 0);
  bench.devices.speed[0] = 1000;
  bench.devices.path.feed = FeedNmPerMin(7'000'000), bench.devices.path.tells_feed = true;
  bench.devices.path.curvature = CurvatureNanoPerMm(12);
  bench.tick();
  EXPECT_EQ(bench.cycle->path().feed, FeedNmPerMin(7'000'000));
  EXPECT_EQ(bench.cycle->path().curvature, CurvatureNanoPerMm(12));
  bench.devices.path.feed = FeedNmPerMin(8'000'000), bench.devices.path.curvature = CurvatureNanoPerMm(13);
  bench.devices.path_fault = HalFault::kNoReading;
  bench.tick();
  EXPECT_EQ(bench.cycle->path().feed, FeedNmPerMin(7'000'000)) << "no reading";
  EXPECT_EQ(bench.cycle->path().curvature, CurvatureNanoPerMm(12));
  bench.devices.path_fault = HalFault::kNone;
  bench.tick();
  EXPECT_EQ(bench.cycle->path().feed, FeedNmPerMin(8'000'000));
}

/// Two thermometers at temperatures that the test gives.
struct TwoTemperatures : InputReader {
  HalFault read_input(std::uint32_t input, InputMicro& value) noexcept override {
    return value = InputMicro(1'000'000 * degC[input]), HalFault::kNone;
  }
  std::int64_t degC[2] = {20, 20};
};

// Y grows by 1e-4 for each degree of each of the two.
TEST(Cycle, EachInputOfTheProgramActsOnTheCorrection) {
  const auto image = image_with_two_inputs();
  const auto correction_nm = [&](std::int64_t first_degC, std::int64_t second_degC) {
    Roaming motion({{0, 600'000'000}, {100'000'000, 200'000'000}}, {}, TimeUs(1000), 0.1, 1);
    SimPlant plant(motion, 2, 0, {});
    plant.release();
    SimClock clock;
    TwoTemperatures inputs;
    inputs.degC[0] = first_degC, inputs.degC[1] = second_degC;
    Cycle cycle(image->view, Board{clock, plant, inputs, plant}, CycleLimits{});
    for (int tick = 1; tick <= 3000; ++tick) {
      plant.advance();
      const bool ready = cycle.mode() == Mode::kReady && cycle.weight() == WeightQ16{};
      cycle.tick(TimeUs(1000 * tick), ready ? Command::kActivate : Command::kNone);
    }
    EXPECT_EQ(cycle.mode(), Mode::kActive);
    return plant.written(1).count;
  };
  const std::int64_t one = correction_nm(21, 20);
  EXPECT_LT(one, -9000) << "1e-4 of 100 mm at least";
  EXPECT_EQ(correction_nm(20, 21), one);
  EXPECT_NEAR(static_cast<double>(correction_nm(21, 21)), 2 * static_cast<double>(one), 8)
      << "4 nm for (1e-4)^2 of 200 mm twice, 2 nm for each of two roundings";
  EXPECT_EQ(correction_nm(20, 20), 0);
}

// The reversal error of X changes faster than its drive may move.
TEST(Cycle, SlewingTicksAreCounted) {
  Rig rig({}, {}, 1);
  ASSERT_TRUE(rig.run_to(Mode::kActive));
  const std::uint64_t before = rig.cycle().health().slewing;
  std::uint64_t slewing = 0;
  for (int i = 0; i < 40'000; ++i) slewing += (rig.tick().output.flags & kSlewing) != 0 ? 1 : 0;
  EXPECT_GT(slewing, 10u);
  EXPECT_EQ(rig.cycle().health().slewing, before + slewing);
}

}  // namespace
}  // namespace vernier::cycle_test
