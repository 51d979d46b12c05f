// SPDX-License-Identifier: GPL-3.0-or-later
// A service whose ticks are the controller's own cycle, as in LinuxCNC's servo thread.
#include <gtest/gtest.h>

#include "tests/unit/firmware/upload_rig.h"
#include "tools/upload/live.h"

namespace vernier::in_controller_test {

using namespace vernier::compile;
using namespace vernier::model;
using namespace vernier::upload;
namespace {

struct Switch : DigitalInput {
  HalFault read_line(bool& value) noexcept override {
    value = on;
    return HalFault::kNone;
  }
  bool on = true;
};

class InController : public testing::Test {
 protected:
  InController() {
    ServiceOptions options;
    options.wiring = {{{"X"}, {"Y"}}, {"T"}};
    options.activate = options.clear_on_enable = options.in_controller = true;
    const Board board{
        .clock = clock_, .axes = plant_, .inputs = plant_, .corrections = plant_, .enable = &enable_};
    service_ = std::make_unique<Service>(options, board, store_);
    boot_ = service_->boot_with(small_image_bytes(2e-5));
    plant_.release();
  }
  void run(int ticks) {
    for (int i = 0; i < ticks; ++i) {
      plant_.advance();
      service_->look_after_programs();
      const AxisTravel before = plant_.written(1);
      service_->tick();
      worst_ = std::max(worst_, std::abs((plant_.written(1) - before).count));
    }
  }
  Cycle& cycle() { return service_->cycle(); }

  SimClock clock_;
  SimSlotStore store_{1 << 16};
  Switch enable_;
  Roaming motion_{{{0, 600'000'000}, {0, 200'000'000}}, {InputMicro(21'000'000)}, TimeUs(1000), 0.1, 1};
  SimPlant plant_{motion_, 2, 1, {.faults = {{PlantFaultKind::kSensorLost, 0, 5000, 500}}}};
  std::unique_ptr<Service> service_;
  UploadResult boot_;
  std::int64_t worst_ = 0;
};

TEST_F(InController, GivenImageRunsUnsignedAndTheStoreKeepsWhatItHas) {
  EXPECT_EQ(boot_.fault, UploadFault::kNone);
  run(2000);
  EXPECT_EQ(cycle().mode(), Mode::kActive);
  EXPECT_EQ(service_->uploader().record().confirmed, kNoSlot);
  EXPECT_NE(service_->uploader().record().confirmed_fingerprint, 0u);
}

TEST_F(InController, AnswersAgreeOnAGivenImage) {
  run(1);
  const SlotsRecord record = service_->uploader().record();
  SlotsReply slots{};
  slots.confirmed = record.confirmed, slots.trial = record.trial;
  slots.confirmed_fingerprint = record.confirmed_fingerprint;
  BoardState state{};
  state.image = ImageState::kConfirmed, state.fingerprint = record.confirmed_fingerprint;
  const std::string text = live_text({}, {}, {}, slots, {}, state);
  EXPECT_NE(text.find(" confirmed (given at the start, not in the store)\n"), std::string::npos) << text;
  EXPECT_EQ(text.find("image none"), std::string::npos) << text;
  EXPECT_NE(confirmed_text(slots).find(" is confirmed (given at the start, not in the store)"),
            std::string::npos);
  EXPECT_EQ(confirmed_json(slots), live_json({}, {}, {}, slots, {}, state)["running"]);
  SlotsReply none{};
  none.confirmed = none.trial = kNoSlot;
  EXPECT_EQ(confirmed_text(none), "no image of the board was confirmed after a trial");
  EXPECT_EQ(confirmed_json(none), nullptr);
  none.confirmed = 1, none.confirmed_fingerprint = 0xab;
  EXPECT_EQ(confirmed_text(none), "00000000000000ab is confirmed");
}

TEST_F(InController, ClockThatStandsStillIsNoFault) {
  run(3000);
  EXPECT_EQ(cycle().latched(), Fault::kNone);
  EXPECT_EQ(service_->runner().time(), TimeUs(3'000'000));
  EXPECT_EQ(cycle().health().skipped, 0u);
}

TEST_F(InController, EnableSwitchedOnClearsTheFaultAndBringsTheCorrectionIn) {
  run(5400);
  EXPECT_EQ(cycle().latched(), Fault::kInputMissing);
  run(2000);
  EXPECT_EQ(cycle().mode(), Mode::kFaulted) << "not by itself, though the sensor is back";
  enable_.on = false;
  run(10);
  EXPECT_EQ(cycle().mode(), Mode::kFaulted);
  enable_.on = true;
  run(3000);
  EXPECT_EQ(cycle().latched(), Fault::kNone);
  EXPECT_EQ(cycle().mode(), Mode::kActive);
  EXPECT_LE(worst_, kSmallSlewY);
}

TEST_F(InController, ClearBringsTheCorrectionInAgainWhereItWasIn) {
  run(5400);
  ASSERT_EQ(cycle().latched(), Fault::kInputMissing);
  run(2000);
  ASSERT_EQ(cycle().mode(), Mode::kFaulted);
  service_->order(Command::kClearFault);
  run(3000);
  EXPECT_EQ(cycle().latched(), Fault::kNone);
  EXPECT_EQ(cycle().mode(), Mode::kActive);
  EXPECT_LE(worst_, kSmallSlewY);
}

TEST_F(InController, ClearWhileTheFaultIsStillRampedOutIsKeptUntilItIsOut) {
  for (int i = 0; i < 6000 && cycle().mode() != Mode::kRampOut; ++i) run(1);
  ASSERT_EQ(cycle().latched(), Fault::kInputMissing);
  ASSERT_EQ(cycle().mode(), Mode::kRampOut);
  service_->order(Command::kClearFault);
  run(3000);
  EXPECT_EQ(cycle().latched(), Fault::kNone);
  EXPECT_EQ(cycle().mode(), Mode::kActive) << "the sensor is back";
}

// The second command was refused, and the board forgot the clear.
TEST_F(InController, CommandThatIsRefusedMeanwhileDoesNotEndTheClear) {
  for (int i = 0; i < 6000 && cycle().mode() != Mode::kRampOut; ++i) run(1);
  ASSERT_EQ(cycle().mode(), Mode::kRampOut);
  service_->order(Command::kClearFault);
  run(1);
  service_->order(Command::kActivate);
  run(1);
  EXPECT_EQ(cycle().health().refused_commands, 1u) << "the operator learns of it";
  run(3000);
  EXPECT_EQ(cycle().latched(), Fault::kNone);
  EXPECT_EQ(cycle().mode(), Mode::kActive);
}

TEST_F(InController, ClearWithoutAFaultIsRefusedAndChangesNothing) {
  run(2000);
  ASSERT_EQ(cycle().mode(), Mode::kActive);
  service_->order(Command::kClearFault);
  run(10);
  EXPECT_EQ(cycle().mode(), Mode::kActive);
  EXPECT_EQ(cycle().health().refused_commands, 1u);
}

TEST_F(InController, ClearDoesNotBringInWhatWasTakenOut) {
  run(4000);
  service_->order(Command::kDeactivate);
  run(3400);
  ASSERT_EQ(cycle().latched(), Fault::kInputMissing);
  service_->order(Command::kClearFault);
  run(3000);
  EXPECT_EQ(cycle().latched(), Fault::kNone);
  EXPECT_EQ(cycle().mode(), Mode::kReady);
}

TEST_F(InController, WeightOfAllStandsOnTopOfTheAxes) {
  run(2000);
  service_->set_weight(WeightQ16(kFullWeight.count / 2));
  run(2000);
  EXPECT_EQ(cycle().axis_weight(1), WeightQ16(kFullWeight.count / 2));
  EXPECT_NEAR(static_cast<double>(plant_.written(1).count), static_cast<double>(cycle().wanted(1).count) / 2,
              1)
      << "a rounding";
  EXPECT_LE(worst_, kSmallSlewY);
}

TEST(InControllerChecking, SaysWhatItWaitsFor) {
  SimClock clock;
  SimSlotStore store{1 << 16};
  Roaming motion{{{0, 600'000'000}, {0, 200'000'000}}, {InputMicro(21'000'000)}, TimeUs(1000), 0.1, 1};
  SimPlant plant{motion, 2, 1, {.faults = {{PlantFaultKind::kSensorLost, 0, 0, 1000}}}};
  ServiceOptions options;
  options.wiring = {{{"X"}, {"Y"}}, {"T"}};
  options.in_controller = true;
  Service service(options, Board{clock, plant, plant, plant}, store);
  ASSERT_EQ(service.boot_with(small_image_bytes(2e-5)).fault, UploadFault::kNone);
  const auto run = [&](int ticks) {
    for (int i = 0; i < ticks; ++i) plant.advance(), service.tick();
  };
  run(500);
  EXPECT_EQ(service.cycle().mode(), Mode::kChecking);
  EXPECT_EQ(service.cycle().latched(), Fault::kNone);
  EXPECT_EQ(service.cycle().found(), Fault::kInputMissing);
  run(1000);
  EXPECT_EQ(service.cycle().mode(), Mode::kReady);
  EXPECT_EQ(service.cycle().found(), Fault::kNone);
}

TEST(InControllerChecking, DoesNotWaitForASensorThatNoTermReads) {
  SimClock clock;
  SimSlotStore store{1 << 16};
  Roaming motion{{{0, 600'000'000}, {0, 200'000'000}}, {InputMicro(21'000'000)}, TimeUs(1000), 0.1, 1};
  SimPlant plant{motion, 2, 1, {.faults = {{PlantFaultKind::kSensorLost, 0, 0, 100'000}}}};
  ServiceOptions options;
  options.wiring = {{{"X"}, {"Y"}}, {"T"}};
  options.in_controller = true;
  Service service(options, Board{clock, plant, plant, plant}, store);
  std::string unread = kSmallMachine;
  for (std::size_t at; (at = unread.find("(T-20)")) != std::string::npos;) unread.replace(at, 6, "1");
  ASSERT_NE(unread, kSmallMachine);
  ASSERT_EQ(service.boot_with(small_image_bytes(2e-5, unread)).fault, UploadFault::kNone);
  for (int i = 0; i < 500; ++i) plant.advance(), service.tick();
  EXPECT_EQ(service.cycle().found(), Fault::kNone);
  EXPECT_EQ(service.cycle().mode(), Mode::kReady);
}

TEST(GivenImage, OfAnotherMachineIsAFaultAndNothingRuns) {
  SimClock clock;
  SimSlotStore store{1 << 16};
  Roaming motion{{{0, 600'000'000}}, {}, TimeUs(1000), 0.1, 1};
  SimPlant plant{motion, 1, 0, {}};
  ServiceOptions options;
  options.wiring = {{{"X"}}, {}};
  options.in_controller = true;
  Service service(options, Board{clock, plant, plant, plant}, store);
  const UploadResult result = service.boot_with(small_image_bytes(2e-5));
  EXPECT_EQ(result.bind, BindFault::kUnknownAxis);
  EXPECT_EQ(result.offender, "Y");
  for (int i = 0; i < 300; ++i) service.tick();
  EXPECT_EQ(service.cycle().latched(), Fault::kImageLost);
}

TEST(ContinuousAxis, TakesAnImageInWhichItRollsOver) {
  const std::string text =
      R"(<machine name="turn"><variables><static><k value="0.01" nominal="0" unit="deg"/></static>
    <machineaxes><X min="0" max="1"/><C rotary="true" rollover="true" min="0" max="360" maxcorrection="1" maxslew="1"/></machineaxes></variables>
    <transforms branch="tool"><sixdof n="1" X="X" Y="0" Z="0" rX="0" rY="0" rZ="C+k"/></transforms></machine>)";
  const Machine machine = parse_machine(text, "turn.xml");
  const auto image = load_image(compile_machine(machine, text, {}).image, machine);
  Wiring wiring{{{"X"}, {.name = "C", .rotary = true}}, {}};
  BoundProgram bound(image->view);
  Name offender;
  EXPECT_EQ(bind(image->view, wiring, TimeUs(1000), bound, offender), BindFault::kAxisKind);
  wiring.axes = {{"X"}, {.name = "C", .rotary = true, .rollover = false, .continuous = true}};
  EXPECT_EQ(bind(image->view, wiring, TimeUs(1000), bound, offender), BindFault::kNone);
}

TEST(BoundAxis, ImageOfAnotherCycleTimeIsNotBound) {
  const auto image = small_image();
  BoundProgram bound(image->view);
  Name offender;
  EXPECT_EQ(bind(image->view, {{{"X"}, {"Y"}}, {"T"}}, TimeUs(500), bound, offender), BindFault::kTick);
  EXPECT_EQ(offender, "1000 us") << "what the image needs";
}

TEST(BoundAxis, RotaryAxisOfAnImageIsNoLinearAxisOfTheBoard) {
  const auto image = small_image();
  BoundProgram bound(image->view);
  Name offender;
  Wiring wiring{{{"X"}, {"Y"}}, {"T"}};
  EXPECT_EQ(bind(image->view, wiring, TimeUs(1000), bound, offender), BindFault::kNone);
  wiring.axes = {{"X"}, {.name = "Y", .rotary = true}};
  EXPECT_EQ(bind(image->view, wiring, TimeUs(1000), bound, offender), BindFault::kAxisKind);
  EXPECT_EQ(offender, "Y");
}

}  // namespace
}  // namespace vernier::in_controller_test
