// SPDX-License-Identifier: GPL-3.0-or-later
// What an operator set, and a latched fault, outlive a power failure.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <set>
#include <string>
#include <vector>

#include "tests/unit/firmware/upload_rig.h"

namespace vernier::operator_test {

using namespace vernier::upload;
namespace {

/// Changes bits of one byte of a record in the store.
template <class Record>
void spoil(SimSlotStore& store, std::uint32_t place, std::uint32_t byte, std::uint8_t bits) {
  std::uint8_t bytes[sizeof(Record)] = {};
  store.read_record(place, bytes, sizeof(bytes));
  bytes[byte] = static_cast<std::uint8_t>(bytes[byte] ^ bits);
  store.write_record(place, bytes, sizeof(bytes));
}

/// Writes a state to both places, as a board does.
void put(SimSlotStore& store, const OperatorState& state) {
  OperatorRecords records;
  for (int i = 0; i < 2; ++i) {
    const OperatorChange change = records.change_to(state);
    std::uint8_t bytes[sizeof(OperatorRecord)];
    std::memcpy(bytes, &change.record, sizeof(bytes));
    ASSERT_EQ(store.write_record(change.place, bytes, sizeof(bytes)), HalFault::kNone);
    records.stored(change);
  }
}

class OperatorSetting : public testing::Test {
 protected:
  OperatorSetting() {
    UploadRig rig(store_, key_);
    EXPECT_EQ(rig.send(make_upload(small_image_bytes(2e-5), key_, 5, 0)).fault, UploadFault::kNone);
    EXPECT_EQ(rig.uploader().confirm().fault, UploadFault::kNone);
  }
  static Exchange& exchange(UploadRig& rig) { return const_cast<Exchange&>(rig.service().exchange()); }
  static void give(UploadRig& rig, Command command, int ticks = 1000) {
    exchange(rig).command = command;
    rig.run(ticks);
  }
  static Mode mode(UploadRig& rig) { return rig.service().cycle().mode(); }
  SigningKey key_ = new_key();
  SimSlotStore store_{1 << 16};
};

TEST_F(OperatorSetting, BoardActivatesWhereNobodyHasSetAnything) {
  const std::uint64_t written = store_.written();
  UploadRig rig(store_, key_);
  rig.run(3000);
  EXPECT_EQ(mode(rig), Mode::kActive);
  EXPECT_EQ(store_.written(), written) << "nothing is worn by a board that nobody commands";
}

TEST_F(OperatorSetting, DeactivatedBoardStaysSoAfterAStartUntilItIsActivated) {
  {
    UploadRig rig(store_, key_);
    rig.run(3000);
    give(rig, Command::kDeactivate);
  }
  for (int start = 0; start < 2; ++start) {
    UploadRig rig(store_, key_);
    rig.run(3000);
    EXPECT_EQ(mode(rig), Mode::kReady);
    EXPECT_EQ(rig.plant().written(0), AxisTravel{});
  }
  {
    UploadRig rig(store_, key_);
    rig.run(1000);
    give(rig, Command::kActivate, 2000);
    EXPECT_EQ(mode(rig), Mode::kActive);
  }
  UploadRig rig(store_, key_);
  rig.run(3000);
  EXPECT_EQ(mode(rig), Mode::kActive) << "the last word was: activate";
}

TEST_F(OperatorSetting, DeactivateWhileCheckingCounts) {
  UploadRig rig(store_, key_);
  rig.run(10);
  ASSERT_EQ(mode(rig), Mode::kChecking);
  give(rig, Command::kDeactivate, 3000);
  EXPECT_EQ(mode(rig), Mode::kReady);
  EXPECT_EQ(rig.plant().written(0), AxisTravel{});
}

TEST_F(OperatorSetting, HeldBoardWaitsForTheOperatorAfterAStart) {
  {
    UploadRig rig(store_, key_);
    rig.run(3000);
    give(rig, Command::kHold);
    ASSERT_TRUE(rig.service().cycle().holding());
  }
  UploadRig rig(store_, key_);
  rig.run(3000);
  EXPECT_EQ(mode(rig), Mode::kReady);
  EXPECT_EQ(rig.plant().written(0), AxisTravel{});
}

TEST_F(OperatorSetting, ReleasedBoardActivatesAfterAStart) {
  {
    UploadRig rig(store_, key_);
    rig.run(3000);
    give(rig, Command::kHold);
    give(rig, Command::kRelease);
  }
  UploadRig rig(store_, key_);
  rig.run(3000);
  EXPECT_EQ(mode(rig), Mode::kActive);
}

TEST_F(OperatorSetting, WeightOfAnAxisOutlivesAStart) {
  {
    UploadRig rig(store_, key_);
    exchange(rig).axis_weight[0] = 0;
    exchange(rig).axis_weight[1] = kFullWeight.count / 4;
    rig.run(100);
  }
  UploadRig rig(store_, key_);
  rig.run(3000);
  EXPECT_EQ(mode(rig), Mode::kActive);
  EXPECT_EQ(rig.plant().written(0), AxisTravel{});
  EXPECT_NE(rig.plant().written(1), AxisTravel{});
  EXPECT_EQ(rig.service().cycle().axis_weight(1).count, kFullWeight.count / 4);
}

TEST_F(OperatorSetting, RecordHasTheAxesOfTheBoardAndNoFurtherOne) {
  UploadRig rig(store_, key_);
  exchange(rig).axis_weight[1] = kFullWeight.count / 4;
  exchange(rig).axis_weight[2] = kFullWeight.count / 2;  // of no axis
  rig.run(10);
  OperatorRecord record{};
  std::uint8_t bytes[sizeof(record)];
  ASSERT_EQ(store_.read_record(kOperatorPlace, bytes, sizeof(bytes)), HalFault::kNone);
  std::memcpy(&record, bytes, sizeof(record));
  EXPECT_EQ(record.state.axis[0], operator_axis("X", 1));
  EXPECT_EQ(record.state.axis[1], operator_axis("Y", 1));
  EXPECT_EQ(record.state.weight[1], kFullWeight.count / 4);
  for (std::size_t i = 2; i < kMaxAxes; ++i) {
    EXPECT_EQ(record.state.axis[i], 0u) << i;
    EXPECT_EQ(record.state.weight[i], 0) << i;
  }
}

TEST_F(OperatorSetting, StoredWeightThatNoAxisCanHaveIsIgnored) {
  const auto restored = [&](std::int32_t weight) {
    OperatorState state;
    state.axis[0] = operator_axis("X", 1), state.weight[0] = weight;
    put(store_, state);
    UploadRig rig(store_, key_);
    EXPECT_EQ(rig.service().operator_memory().found(), StoredPair::kIntact);
    return exchange(rig).axis_weight[0].load();
  };
  EXPECT_EQ(restored(0), 0);
  EXPECT_EQ(restored(kFullWeight.count / 2), kFullWeight.count / 2);
  EXPECT_EQ(restored(-1), kFullWeight.count);
  EXPECT_EQ(restored(kFullWeight.count + 1), kFullWeight.count);
}

// A later firmware may have stored this fault, and its cause may be still present.
TEST_F(OperatorSetting, StoredFaultThatThisFirmwareDoesNotKnowKeepsTheCorrectionOut) {
  OperatorState state;
  state.fault = kFaultCount - 1;
  put(store_, state);
  {
    UploadRig rig(store_, key_);
    EXPECT_EQ(rig.service().cycle().latched(), static_cast<Fault>(kFaultCount - 1));
    EXPECT_FALSE(rig.service().deactivated());
  }
  state.fault = kFaultCount;
  put(store_, state);
  UploadRig rig(store_, key_);
  EXPECT_EQ(rig.service().cycle().latched(), Fault::kNone);
  EXPECT_TRUE(rig.service().deactivated());
  rig.run(3000);
  EXPECT_EQ(mode(rig), Mode::kReady);
  EXPECT_EQ(rig.plant().written(0), AxisTravel{});
}

TEST_F(OperatorSetting, LatchedFaultOutlivesAStartUntilItIsCleared) {
  {
    UploadRig rig(store_, key_);
    rig.run(3000);
    rig.service().cycle().tick(TimeUs(1), Command::kNone, Fault::kOverrun);
    rig.run(1000);
    ASSERT_EQ(mode(rig), Mode::kFaulted);
  }
  UploadRig rig(store_, key_);
  rig.run(3000);
  EXPECT_EQ(mode(rig), Mode::kFaulted);
  EXPECT_EQ(rig.service().cycle().latched(), Fault::kOverrun);
  EXPECT_EQ(rig.plant().written(0), AxisTravel{});
  give(rig, Command::kClearFault, 1000);
  EXPECT_EQ(mode(rig), Mode::kReady) << "as without the start";
  give(rig, Command::kActivate, 2000);
  EXPECT_EQ(mode(rig), Mode::kActive);
}

TEST_F(OperatorSetting, ClearedBoardWaitsForTheActivationAfterAStartToo) {
  {
    UploadRig rig(store_, key_);
    rig.run(3000);
    ASSERT_EQ(mode(rig), Mode::kActive);
    rig.service().cycle().tick(TimeUs(1), Command::kNone, Fault::kOverrun);
    rig.run(1000);
    give(rig, Command::kClearFault, 1000);
    ASSERT_EQ(mode(rig), Mode::kReady);
  }
  UploadRig rig(store_, key_);
  rig.run(3000);
  EXPECT_EQ(mode(rig), Mode::kReady);
  EXPECT_EQ(rig.plant().written(0), AxisTravel{});
  give(rig, Command::kActivate, 2000);
  EXPECT_EQ(mode(rig), Mode::kActive);
}

TEST_F(OperatorSetting, UnreadableRecordsKeepTheCorrectionOut) {
  const std::uint8_t spoiled[sizeof(OperatorRecord)] = {1, 2, 3};
  store_.write_record(kOperatorPlace, spoiled, sizeof(spoiled));
  store_.write_record(kOperatorPlace + 1, spoiled, sizeof(spoiled));
  UploadRig rig(store_, key_);
  EXPECT_TRUE(rig.service().operator_memory().damaged());
  rig.run(3000);
  EXPECT_EQ(mode(rig), Mode::kReady);
  EXPECT_TRUE(rig.service().operator_memory().damaged()) << "until the operator decides";
  EXPECT_EQ(exchange(rig).setting_flags.load() & kSettingDamaged, kSettingDamaged);
  give(rig, Command::kActivate, 2000);
  EXPECT_EQ(mode(rig), Mode::kActive);
  EXPECT_FALSE(rig.service().operator_memory().damaged()) << "the operator has decided";
}

// The newest record may have said: deactivated. With one record only, and with an older one beside it that
// says activated, a damage brought the correction back.
TEST_F(OperatorSetting, AnyDamageOfOneRecordKeepsTheCorrectionOut) {
  const std::vector<std::vector<Command>> kHistories = {
      {Command::kDeactivate},
      {Command::kDeactivate, Command::kActivate},
      {Command::kDeactivate, Command::kActivate, Command::kDeactivate}};
  int starts = 0;
  for (const auto& history : kHistories) {
    SimSlotStore sound = store_;
    {
      UploadRig rig(sound, key_);
      rig.run(3000);
      for (const Command command : history) give(rig, command);
    }
    const bool out = history.back() == Command::kDeactivate;
    {
      SimSlotStore store = sound;
      UploadRig rig(store, key_);
      ASSERT_EQ(rig.service().operator_memory().found(), StoredPair::kIntact);
      ASSERT_EQ(rig.service().deactivated(), out) << "without a damage";
    }
    for (const std::uint32_t place : {kOperatorPlace, kOperatorPlace + 1}) {
      const auto expect_out = [&](SimSlotStore& store, const std::string& what) {
        UploadRig rig(store, key_);
        EXPECT_TRUE(rig.service().deactivated()) << what << ", place " << place;
        EXPECT_TRUE(rig.service().operator_memory().damaged()) << what << ", place " << place;
        if (++starts % 16 != 0) return;
        rig.run(3);
        // The next start finds the same decision in two sound records.
        UploadRig next(store, key_);
        EXPECT_TRUE(next.service().deactivated()) << what << ", place " << place;
        EXPECT_EQ(next.service().operator_memory().found(), StoredPair::kIntact) << what;
      };
      for (std::uint32_t byte = 0; byte < sizeof(OperatorRecord); ++byte) {
        SimSlotStore store = sound;
        spoil<OperatorRecord>(store, place, byte, 0x10);
        expect_out(store, "changed byte " + std::to_string(byte));
      }
      for (std::uint32_t size = 0; size < sizeof(OperatorRecord); ++size) {
        SimSlotStore store = sound;
        store.cut_record(place, size);
        expect_out(store, "cut to " + std::to_string(size));
      }
      SimSlotStore store = sound;
      const std::uint8_t zeros[sizeof(OperatorRecord)] = {};
      store.write_record(place, zeros, sizeof(zeros));
      expect_out(store, "zeros");
      store = sound;
      std::uint8_t longer[sizeof(OperatorRecord) + 10] = {};
      store.read_record(place, longer, sizeof(OperatorRecord));
      store.write_record(place, longer, sizeof(longer));
      expect_out(store, "ten bytes longer");
      store = sound;
      std::fill(std::end(longer) - 10, std::end(longer), std::uint8_t{0xff});
      store.write_record(place, longer, sizeof(longer));
      expect_out(store, "ten bytes of ones longer");
      // A copy of the other record, as from a backup.
      store = sound;
      std::uint8_t other[sizeof(OperatorRecord)];
      store.read_record(2 * kOperatorPlace + 1 - place, other, sizeof(other));
      store.write_record(place, other, sizeof(other));
      expect_out(store, "twice the same");
    }
  }
}

// The newest record may have confirmed another image.
TEST_F(OperatorSetting, AnyDamageOfOneImageRecordKeepsTheCorrectionOut) {
  for (const std::uint32_t place : {0u, 1u}) {
    const auto expect_out = [&](SimSlotStore& store, const std::string& what) {
      UploadRig rig(store, key_);
      // Without the second record: as after a power failure in the first trial, when nothing is confirmed.
      const bool nothing = rig.uploader().record().confirmed == kNoSlot && what == "cut to 0";
      EXPECT_TRUE(rig.service().uploader().damaged() || nothing) << what << ", place " << place;
      EXPECT_TRUE(rig.service().deactivated() || nothing) << what << ", place " << place;
      rig.run(3000);
      EXPECT_EQ(rig.plant().written(0), AxisTravel{}) << what << ", place " << place;
    };
    for (std::uint32_t byte = 0; byte < sizeof(SlotRecord); ++byte) {
      SimSlotStore store = store_;
      spoil<SlotRecord>(store, place, byte, 0x04);
      expect_out(store, "changed byte " + std::to_string(byte));
    }
    for (std::uint32_t size = 0; size < sizeof(SlotRecord); ++size) {
      SimSlotStore store = store_;
      store.cut_record(place, size);
      expect_out(store, "cut to " + std::to_string(size));
    }
    SimSlotStore store = store_;
    std::uint8_t longer[sizeof(SlotRecord) + 10] = {};
    store.read_record(place, longer, sizeof(SlotRecord));
    store.write_record(place, longer, sizeof(longer));
    expect_out(store, "ten bytes longer");
  }
}

TEST_F(OperatorSetting, ActivationRepairsTheImageRecords) {
  spoil<SlotRecord>(store_, 0, 20, 4);
  for (int start = 0; start < 2; ++start) {
    UploadRig rig(store_, key_);
    rig.run(3000);
    EXPECT_TRUE(rig.service().uploader().damaged()) << "until an operator decides, start " << start;
    EXPECT_EQ(mode(rig), Mode::kReady);
  }
  {
    UploadRig rig(store_, key_);
    rig.run(100);
    give(rig, Command::kActivate, 2000);
    EXPECT_EQ(mode(rig), Mode::kActive);
    EXPECT_FALSE(rig.service().uploader().damaged());
  }
  UploadRig rig(store_, key_);
  EXPECT_FALSE(rig.service().uploader().damaged());
  rig.run(3000);
  EXPECT_EQ(mode(rig), Mode::kActive);
}

// An older copy of one record, or a write that the medium lost, undoes nothing.
TEST_F(OperatorSetting, OlderCopyOfOneRecordUndoesNothing) {
  std::vector<SimSlotStore> history = {store_};
  const auto keep = [&](auto act) {
    SimSlotStore store = history.back();
    UploadRig rig(store, key_);
    rig.run(3000);
    act(rig);
    history.push_back(store);
  };
  keep([](UploadRig& rig) { give(rig, Command::kDeactivate); });
  keep([](UploadRig& rig) { give(rig, Command::kActivate); });
  keep([&](UploadRig& rig) {
    EXPECT_EQ(rig.send(make_upload(small_image_bytes(3e-5), key_, 6, 0)).fault, UploadFault::kNone);
    EXPECT_EQ(rig.uploader().confirm().fault, UploadFault::kNone);
  });
  keep([](UploadRig& rig) { give(rig, Command::kDeactivate); });
  const std::uint64_t newest = UploadRig(history.back(), key_).uploader().record().confirmed_fingerprint;
  const auto copy = [](SimSlotStore& from, SimSlotStore& to, std::uint32_t place, std::uint32_t size) {
    std::vector<std::uint8_t> bytes(size);
    if (from.read_record(place, bytes.data(), size) != HalFault::kNone) return false;
    return to.write_record(place, bytes.data(), size) == HalFault::kNone;
  };
  int copies = 0;
  for (SimSlotStore& old : history)
    for (const std::uint32_t place : {0u, 1u, kOperatorPlace, kOperatorPlace + 1}) {
      SimSlotStore store = history.back();
      if (!copy(old, store, place, place < kOperatorPlace ? sizeof(SlotRecord) : sizeof(OperatorRecord)))
        continue;
      ++copies;
      UploadRig rig(store, key_);
      EXPECT_TRUE(rig.service().deactivated()) << place;
      EXPECT_EQ(rig.uploader().record().confirmed_fingerprint, newest) << place;
    }
  EXPECT_GT(copies, 12);
}

// The power failed between the two writes of a deactivation, and the first one was not on the medium yet: the
// next start writes both places again.
TEST_F(OperatorSetting, StateInOnePlaceIsWrittenToBothAgain) {
  {
    UploadRig rig(store_, key_);
    rig.run(3000);
    give(rig, Command::kDeactivate);
    give(rig, Command::kActivate, 3000);
    store_.cut_power_after(sizeof(OperatorRecord));
    give(rig, Command::kDeactivate, 10);
  }
  store_.restore_power();
  const SimSlotStore half = store_;
  {
    UploadRig rig(store_, key_);
    ASSERT_TRUE(rig.service().deactivated());
    rig.run(10);
  }
  for (const std::uint32_t place : {kOperatorPlace, kOperatorPlace + 1}) {
    SimSlotStore lost = store_, old = half;
    std::uint8_t bytes[sizeof(OperatorRecord)] = {};
    ASSERT_EQ(old.read_record(place, bytes, sizeof(bytes)), HalFault::kNone);
    lost.write_record(place, bytes, sizeof(bytes));
    UploadRig rig(lost, key_);
    EXPECT_TRUE(rig.service().deactivated()) << place;
  }
  const std::uint64_t written = store_.written();
  UploadRig rig(store_, key_);
  rig.run(10);
  EXPECT_EQ(store_.written(), written) << "nothing more to write";
}

TEST_F(OperatorSetting, AnotherImageInTheSlotIsALostImage) {
  SimSlotStore store = store_;
  {
    UploadRig rig(store, key_);
    rig.run(3000);
    EXPECT_EQ(rig.send(make_upload(small_image_bytes(3e-5), key_, 6, 0)).fault, UploadFault::kNone);
    EXPECT_EQ(rig.uploader().confirm().fault, UploadFault::kNone);
  }
  UploadHeader header;
  std::vector<std::uint8_t> bytes(sizeof(header));
  store.read_image(0, 0, bytes.data(), sizeof(header));
  std::memcpy(&header, bytes.data(), sizeof(header));
  bytes.resize(sizeof(header) + header.image_bytes);
  store.read_image(0, 0, bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  store.write_image(1, 0, bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  UploadRig rig(store, key_);
  EXPECT_TRUE(rig.uploader().image_lost());
  rig.run(3000);
  EXPECT_EQ(rig.plant().written(0), AxisTravel{});
}

// Half a record was begun: its setting is unknown.
TEST_F(OperatorSetting, PowerLostInADeactivationNeverActivates) {
  for (const bool first : {true, false}) {
    SimSlotStore before = store_;
    if (!first) {
      UploadRig rig(before, key_);
      rig.run(3000);
      give(rig, Command::kHold);
      give(rig, Command::kRelease);
    }
    for (std::uint64_t cut = 0; cut <= 2 * sizeof(OperatorRecord); ++cut) {
      SimSlotStore store = before;
      {
        UploadRig rig(store, key_);
        rig.run(1000);
        store.cut_power_after(cut);
        give(rig, Command::kDeactivate, 10);
      }
      store.restore_power();
      UploadRig rig(store, key_);
      // The magic is that of the record before: nothing of the change is on the medium, and the operator has
      // no answer by then.
      EXPECT_EQ(rig.service().deactivated(), cut > (first ? 0 : sizeof(kOperatorMagic)))
          << cut << " bytes" << (first ? ", first setting" : "");
    }
  }
}

// The power fails after every byte that a change of the setting writes.
TEST_F(OperatorSetting, PowerLostAtAnyByteLeavesTheOldOrTheNewSetting) {
  {
    UploadRig rig(store_, key_);
    exchange(rig).axis_weight[0] = 0;
    rig.run(10);
  }
  std::set<std::int32_t> found;
  for (std::uint64_t cut = 0; cut <= 2 * sizeof(OperatorRecord); ++cut) {
    SimSlotStore store = store_;
    {
      UploadRig rig(store, key_);
      rig.run(10);
      store.cut_power_after(cut);
      exchange(rig).axis_weight[0] = kFullWeight.count / 2;
      rig.run(10);
      EXPECT_EQ(rig.service().operator_memory().refused(), cut < 2 * sizeof(OperatorRecord));
    }
    store.restore_power();
    UploadRig rig(store, key_);
    const std::int32_t weight = exchange(rig).axis_weight[0];
    ASSERT_TRUE(weight == 0 || weight == kFullWeight.count / 2) << weight << " after " << cut << " bytes";
    found.insert(weight);
  }
  EXPECT_EQ(found.size(), 2u);
}

}  // namespace
}  // namespace vernier::operator_test
