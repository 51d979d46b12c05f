// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>
#include <sodium.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstring>
#include <random>

#include "hal/linux/monotonic_clock.h"
#include "tables/checksum.h"
#include "tests/unit/firmware/upload_rig.h"

namespace vernier::upload_test {

using namespace vernier::upload;
namespace {

constexpr std::uint64_t kIssued = 1'000'000;
constexpr std::uint32_t kSecurity = 2;

class Upload : public testing::Test {
 protected:
  std::vector<std::uint8_t> upload(double scale, std::uint64_t issued = kIssued,
                                   std::uint32_t security = kSecurity) const {
    return make_upload(small_image_bytes(scale), key_, issued, security);
  }
  /// The correction of X that its drive holds, per mm of its position: minus the scale error of what runs.
  static double slope(UploadRig& rig) {
    AxisReading x;
    // Far enough out that a nanometre does not count, and not where the sense just turned.
    for (int i = 0; i < 60000; ++i) {
      rig.plant().read_axis(0, x);
      if (x.position.count > 200'000'000 && x.since.count > 20'000'000) break;
      rig.run(1);
    }
    return -static_cast<double>(rig.plant().written(0).count + 4000 * x.sense) /
           static_cast<double>(x.position.count);
  }

  SigningKey key_ = new_key();
  SimSlotStore store_{1 << 16};
};

TEST_F(Upload, BlankBoardCorrectsNothingUntilAnImageIsTried) {
  UploadRig rig(store_, key_);
  EXPECT_EQ(rig.boot_result().fault, UploadFault::kNone);
  rig.run(1000);
  EXPECT_EQ(rig.service().cycle().mode(), Mode::kChecking);
  ASSERT_EQ(rig.send(upload(2e-5)).fault, UploadFault::kNone);
  rig.run(3000);
  EXPECT_EQ(rig.service().cycle().mode(), Mode::kActive);
  EXPECT_NEAR(slope(rig), 2e-5, 1e-7);
  EXPECT_EQ(rig.uploader().confirm().fault, UploadFault::kNone);
}

TEST_F(Upload, IsTakenOverWithoutAStepAndRevertsOnItsTimer) {
  UploadRig rig(store_, key_);
  ASSERT_EQ(rig.send(upload(2e-5)).fault, UploadFault::kNone);
  ASSERT_EQ(rig.uploader().confirm().fault, UploadFault::kNone);
  rig.run(4000);
  ASSERT_EQ(rig.service().cycle().mode(), Mode::kActive);
  // WHEN another one is tried while the first is Active
  ASSERT_EQ(rig.send(upload(4e-5, kIssued + 1)).fault, UploadFault::kNone);
  rig.run(1500);
  // THEN it runs, no drive has moved faster than its slew limit, and the board never left Active
  EXPECT_NEAR(slope(rig), 4e-5, 1e-7);
  EXPECT_EQ(rig.service().cycle().mode(), Mode::kActive);
  // and nobody having confirmed it, the first one runs again
  rig.run(6000);
  EXPECT_NEAR(slope(rig), 2e-5, 1e-7);
  EXPECT_EQ(rig.uploader().slots().trial(), kNoSlot);
  EXPECT_EQ(rig.uploader().confirm().fault, UploadFault::kNoTrial);
  EXPECT_LE(rig.worst_step(0), kSmallSlewX);
  EXPECT_LE(rig.worst_step(1), kSmallSlewY);
  EXPECT_EQ(rig.service().cycle().health().faults, 0u);
}

TEST_F(Upload, ResetRevertsATrialAndKeepsAConfirmedOne) {
  {
    UploadRig rig(store_, key_);
    ASSERT_EQ(rig.send(upload(2e-5)).fault, UploadFault::kNone);
    ASSERT_EQ(rig.uploader().confirm().fault, UploadFault::kNone);
    ASSERT_EQ(rig.send(upload(4e-5, kIssued + 1)).fault, UploadFault::kNone);
    rig.run(3000);
  }
  UploadRig rig(store_, key_);
  rig.run(3000);
  EXPECT_NEAR(slope(rig), 2e-5, 1e-7);
  EXPECT_EQ(rig.uploader().slots().issued(), kIssued);
}

struct Refused {
  const char* name;
  UploadFault fault;
  std::function<void(std::vector<std::uint8_t>&, const SigningKey&)> spoil;
};

class UploadRefusal : public Upload, public testing::WithParamInterface<Refused> {};

TEST_P(UploadRefusal, SaysWhyAndChangesNothing) {
  UploadRig rig(store_, key_);
  ASSERT_EQ(rig.send(upload(2e-5)).fault, UploadFault::kNone);
  ASSERT_EQ(rig.uploader().confirm().fault, UploadFault::kNone);
  rig.run(3000);
  std::vector<std::uint8_t> bad = upload(4e-5, kIssued + 1);
  GetParam().spoil(bad, key_);
  const UploadResult result = rig.send(bad);
  EXPECT_EQ(result.fault, GetParam().fault) << describe(result);
  rig.run(1500);
  EXPECT_NEAR(slope(rig), 2e-5, 1e-7);
  EXPECT_EQ(rig.uploader().slots().trial(), kNoSlot);
  // and a good one is still taken
  EXPECT_EQ(rig.send(upload(3e-5, kIssued + 2)).fault, UploadFault::kNone);
}

std::vector<std::uint8_t> signed_again(const std::vector<std::uint8_t>& image, const SigningKey& key,
                                       std::uint64_t issued = kIssued + 1, std::uint32_t security = kSecurity,
                                       const std::string& board = {}) {
  return make_upload(image, key, issued, security, board);
}

/// The small machine with words of its file replaced.
std::vector<std::uint8_t> other_machine(const std::vector<std::pair<std::string, std::string>>& words) {
  std::string text = kSmallMachine;
  for (const auto& [from, to] : words) text.replace(text.find(from), from.size(), to);
  return small_image_bytes(2e-5, text);
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, UploadRefusal,
    testing::Values(
        Refused{"Unsigned", UploadFault::kSignature,
                [](auto& bytes, const auto&) {
                  std::fill_n(bytes.begin() + offsetof(UploadHeader, signature), 64, std::uint8_t{0});
                }},
        Refused{"ForeignKey", UploadFault::kForeignKey,
                [](auto& bytes, const auto&) {
                  bytes = signed_again({bytes.begin() + sizeof(UploadHeader), bytes.end()}, new_key());
                }},
        Refused{"ForeignKeyUnderOurName", UploadFault::kSignature,
                [](auto& bytes, const auto& key) {
                  bytes = signed_again({bytes.begin() + sizeof(UploadHeader), bytes.end()}, new_key());
                  std::memcpy(bytes.data() + offsetof(UploadHeader, key), key.public_part().data(), 24);
                }},
        Refused{"Truncated", UploadFault::kNotAnUpload,
                [](auto& bytes, const auto&) { bytes.resize(bytes.size() - 8); }},
        Refused{"OnlyAHeader", UploadFault::kNotAnUpload,
                [](auto& bytes, const auto&) { bytes.resize(sizeof(UploadHeader)); }},
        Refused{"LessThanAHeader", UploadFault::kNotAnUpload,
                [](auto& bytes, const auto&) { bytes.resize(100); }},
        Refused{"Oversized", UploadFault::kTooLarge, [](auto& bytes, const auto&) { bytes.resize(1 << 17); }},
        Refused{"LongerThanItSays", UploadFault::kNotAnUpload,
                [](auto& bytes, const auto&) { bytes.push_back(0); }},
        Refused{"NoImageInside", UploadFault::kImage,
                [](auto& bytes, const auto& key) {
                  std::vector<std::uint8_t> image(bytes.begin() + sizeof(UploadHeader), bytes.end());
                  image[0] = 'X';
                  bytes = signed_again(image, key);
                }},
        Refused{"WrongChecksum", UploadFault::kImage,
                [](auto& bytes, const auto& key) {
                  std::vector<std::uint8_t> image(bytes.begin() + sizeof(UploadHeader), bytes.end());
                  image.back() = static_cast<std::uint8_t>(image.back() ^ 1);
                  bytes = signed_again(image, key);
                }},
        Refused{"Mutated", UploadFault::kSignature,
                [](auto& bytes, const auto&) { bytes.back() = static_cast<std::uint8_t>(bytes.back() ^ 1); }},
        Refused{"HeaderChanged", UploadFault::kSignature,
                [](auto& bytes, const auto&) { bytes[offsetof(UploadHeader, issued)] ^= 1; }},
        Refused{
            "ForeignAxis", UploadFault::kForeignMachine,
            [](auto& bytes, const auto& key) {
              bytes = signed_again(other_machine({{"<Y rotary", "<W rotary"}, {"Y+cte*Y", "W+cte*W"}}), key);
            }},
        Refused{"ForeignSensor", UploadFault::kForeignMachine,
                [](auto& bytes, const auto& key) {
                  bytes = signed_again(other_machine({{"<T unit", "<T_air unit"}, {"(T-20)", "(T_air-20)"}}),
                                       key);
                }},
        Refused{"Replayed", UploadFault::kOlder,
                [](auto& bytes, const auto& key) {
                  bytes = signed_again({bytes.begin() + sizeof(UploadHeader), bytes.end()}, key, kIssued);
                }},
        Refused{"Older", UploadFault::kOlder,
                [](auto& bytes, const auto& key) {
                  bytes = signed_again({bytes.begin() + sizeof(UploadHeader), bytes.end()}, key, kIssued - 1);
                }},
        Refused{"AbsurdTime", UploadFault::kAbsurdTime,
                [](auto& bytes, const auto& key) {
                  bytes = signed_again({bytes.begin() + sizeof(UploadHeader), bytes.end()}, key, UINT64_MAX);
                }},
        Refused{
            "BelowTheSecurityCounter", UploadFault::kSecurity,
            [](auto& bytes, const auto& key) {
              bytes = signed_again({bytes.begin() + sizeof(UploadHeader), bytes.end()}, key, kIssued + 1, 1);
            }},
        Refused{"OfAnotherBoard", UploadFault::kOtherBoard,
                [](auto& bytes, const auto& key) {
                  bytes = signed_again({bytes.begin() + sizeof(UploadHeader), bytes.end()}, key, kIssued + 1,
                                       kSecurity, "mill-2");
                }},
        Refused{"NotAnUpload", UploadFault::kNotAnUpload, [](auto& bytes, const auto&) { bytes[0] = 'v'; }},
        Refused{"HeaderOfAnotherSize", UploadFault::kNotAnUpload,
                [](auto& bytes, const auto&) { bytes[offsetof(UploadHeader, header_bytes)] ^= 8; }},
        Refused{"OldForm", UploadFault::kOldForm,
                [](auto& bytes, const auto&) {
                  std::memcpy(bytes.data(), kUploadMagicV1, sizeof(kUploadMagicV1));
                }}),
    [](const auto& parameter) { return parameter.param.name; });

// Once signed and given up, an image does not come back, whoever sends it; nor does one below a counter that
// was raised.
TEST_F(Upload, WhatWasTriedOnceIsNeverTakenAgain) {
  UploadRig rig(store_, key_);
  ASSERT_EQ(rig.send(upload(2e-5)).fault, UploadFault::kNone);
  ASSERT_EQ(rig.uploader().confirm().fault, UploadFault::kNone);
  const auto given_up = upload(4e-5, kIssued + 5, kSecurity + 1);
  ASSERT_EQ(rig.send(given_up).fault, UploadFault::kNone);
  ASSERT_EQ(rig.uploader().revert().fault, UploadFault::kNone);
  rig.run(5);
  EXPECT_EQ(rig.send(given_up).fault, UploadFault::kOlder);
  EXPECT_EQ(rig.send(upload(3e-5, kIssued + 2, kSecurity + 1)).fault, UploadFault::kOlder);
  EXPECT_EQ(rig.send(upload(3e-5, kIssued + 9)).fault, UploadFault::kSecurity)
      << "the counter was raised by a trial";
  EXPECT_EQ(rig.send(upload(3e-5, kIssued + 9, kSecurity + 1)).fault, UploadFault::kNone);
}

TEST_F(Upload, RetiredKeyKeepsItsImageRunningAndSignsNoOther) {
  {
    UploadRig rig(store_, key_);
    ASSERT_EQ(rig.send(upload(2e-5)).fault, UploadFault::kNone);
    ASSERT_EQ(rig.uploader().confirm().fault, UploadFault::kNone);
  }
  const SigningKey next = new_key();
  const Wiring wiring{{{"X"}, {"Y"}}, {"T"}};
  Exchange exchange;
  BoardIdentity identity(next.public_part());
  identity.keys.push_back({.key = key_.public_part(), .name = "before", .retired = true});
  Uploader uploader(store_, wiring, exchange, {TimeUs(1000), identity});
  EXPECT_EQ(uploader.boot().fault, UploadFault::kNone);
  const auto send = [&](const std::vector<std::uint8_t>& bytes) {
    uploader.programs().guard(TimeUs{});
    EXPECT_EQ(uploader.begin(static_cast<std::uint32_t>(bytes.size())).fault, UploadFault::kNone);
    EXPECT_EQ(uploader.add(0, bytes.data(), static_cast<std::uint32_t>(bytes.size())).fault,
              UploadFault::kNone);
    return uploader.finish().fault;
  };
  EXPECT_EQ(send(upload(4e-5, kIssued + 1)), UploadFault::kKeyMayNot);
  EXPECT_EQ(send(make_upload(small_image_bytes(4e-5), next, kIssued + 2, kSecurity)), UploadFault::kNone);
  // A key that is taken out of the board file takes its image with it, and says so.
  Uploader without(store_, wiring, exchange, {TimeUs(1000), next.public_part()});
  EXPECT_EQ(without.boot().fault, UploadFault::kForeignKey);
  EXPECT_TRUE(without.image_lost());
}

TEST_F(Upload, KeyWithoutTheRightSignsNoImage) {
  const Wiring wiring{{{"X"}, {"Y"}}, {"T"}};
  for (const bool may : {true, false}) {
    Exchange exchange;
    BoardIdentity identity;
    identity.keys.push_back({.key = key_.public_part(), .name = {}, .upload = may});
    SimSlotStore store(1 << 16);
    Uploader uploader(store, wiring, exchange, {TimeUs(1000), identity});
    const auto bytes = upload(2e-5);
    const auto size = static_cast<std::uint32_t>(bytes.size());
    ASSERT_EQ(uploader.begin(size).fault, UploadFault::kNone);
    ASSERT_EQ(uploader.add(0, bytes.data(), size).fault, UploadFault::kNone);
    EXPECT_EQ(uploader.finish().fault, may ? UploadFault::kNone : UploadFault::kKeyMayNot);
  }
}

/// Writes the confirmed image of the small machine to a store as the version before did; `spoil` changes its
/// header before it is signed.
void write_old_store(
    SimSlotStore& store, const SigningKey& key,
    const std::function<void(UploadHeaderV1&)>& spoil = [](UploadHeaderV1&) {}) {
  const auto image = small_image_bytes(2e-5);
  const auto now = make_upload(image, key, kIssued, 0);
  UploadHeader header;
  std::memcpy(&header, now.data(), sizeof(header));
  UploadHeaderV1 old{};
  std::memcpy(old.magic, kUploadMagicV1, sizeof(old.magic));
  old.header_bytes = sizeof(old), old.image_bytes = header.image_bytes;
  old.issued = kIssued, old.fingerprint = header.fingerprint;
  std::memcpy(old.key, header.key, sizeof(old.key));
  spoil(old);
  crypto_sign_state state;
  crypto_sign_init(&state);
  crypto_sign_update(&state, reinterpret_cast<const std::uint8_t*>(&old), kSignedHeaderBytesV1);
  crypto_sign_update(&state, image.data(), image.size());
  crypto_sign_final_create(&state, old.signature, nullptr, key.secret.data());
  SlotRecordV1 record{kSlotMagicV1, 1, kIssued, 0, 0, kNoSlot, 0, 0};
  record.checksum = crc32c(reinterpret_cast<const std::uint8_t*>(&record), offsetof(SlotRecordV1, checksum));
  store.write_image(0, 0, reinterpret_cast<const std::uint8_t*>(&old), sizeof(old));
  store.write_image(0, sizeof(old), image.data(), static_cast<std::uint32_t>(image.size()));
  store.write_record(0, reinterpret_cast<const std::uint8_t*>(&record), sizeof(record));
}

TEST_F(Upload, StoreOfTheVersionBeforeRuns) {
  write_old_store(store_, key_);
  UploadRig rig(store_, key_);
  EXPECT_EQ(rig.boot_result().fault, UploadFault::kNone) << describe(rig.boot_result());
  rig.run(3000);
  EXPECT_NEAR(slope(rig), 2e-5, 1e-7);
  // The floor came along, and the next image is of this version.
  EXPECT_EQ(rig.send(upload(3e-5, kIssued)).fault, UploadFault::kOlder);
  EXPECT_EQ(rig.send(upload(3e-5, kIssued + 1)).fault, UploadFault::kNone);
}

/// Notes the most bytes of an image that were asked for in one piece.
class AskedStore : public SimSlotStore {
 public:
  using SimSlotStore::SimSlotStore;
  HalFault read_image(std::uint32_t slot, std::uint32_t offset, std::uint8_t* bytes,
                      std::uint32_t size) noexcept override {
    most = std::max(most, size);
    return SimSlotStore::read_image(slot, offset, bytes, size);
  }
  std::uint32_t most = 0;
};

// The memory for an image has the size of a slot without the header.
TEST_F(Upload, NoMoreThanAnImagesMemoryIsReadWhateverTheHeaderSays) {
  const std::uint32_t most = (1 << 16) - sizeof(UploadHeader);
  for (const std::uint32_t claimed : {most, most + 1, UINT32_MAX}) {
    AskedStore now(1 << 16), before(1 << 16);
    {
      UploadRig rig(now, key_);
      ASSERT_EQ(rig.send(upload(2e-5)).fault, UploadFault::kNone);
      ASSERT_EQ(rig.uploader().confirm().fault, UploadFault::kNone);
    }
    std::uint8_t bytes[4];
    std::memcpy(bytes, &claimed, sizeof(bytes));
    ASSERT_EQ(now.write_image(0, offsetof(UploadHeader, image_bytes), bytes, sizeof(bytes)), HalFault::kNone);
    write_old_store(before, key_, [&](UploadHeaderV1& header) { header.image_bytes = claimed; });
    for (AskedStore* const store : {&now, &before}) {
      store->most = 0;
      UploadRig rig(*store, key_);
      EXPECT_EQ(rig.boot_result().fault, UploadFault::kNotAnUpload) << claimed;
      EXPECT_EQ(store->most > 1000, claimed == most) << "only what fits is asked for";
      EXPECT_LE(store->most, most);
    }
  }
}

TEST_F(Upload, StoredHeaderOfTheVersionBeforeHasItsOwnSize) {
  write_old_store(store_, key_, [](UploadHeaderV1& header) { header.header_bytes += 8; });
  EXPECT_EQ(UploadRig(store_, key_).boot_result().fault, UploadFault::kNotAnUpload);
}

TEST_F(Upload, StoredImageOfTheVersionBeforeIsCheckedToo) {
  const auto fault = [&](const std::function<void(UploadHeaderV1&)>& spoil) {
    SimSlotStore store(1 << 16);
    write_old_store(store, key_, spoil);
    return UploadRig(store, key_).boot_result().fault;
  };
  EXPECT_EQ(fault([](UploadHeaderV1&) {}), UploadFault::kNone);
  EXPECT_EQ(fault([](UploadHeaderV1& header) { header.fingerprint ^= 1; }), UploadFault::kFingerprint);
  EXPECT_EQ(fault([](UploadHeaderV1& header) { header.key[0] ^= 1; }), UploadFault::kForeignKey);
  write_old_store(store_, key_);
  std::uint8_t byte = 0;
  ASSERT_EQ(store_.read_image(0, 700, &byte, 1), HalFault::kNone);
  byte ^= 8;
  ASSERT_EQ(store_.write_image(0, 700, &byte, 1), HalFault::kNone);
  EXPECT_EQ(UploadRig(store_, key_).boot_result().fault, UploadFault::kSignature);
}

TEST_F(Upload, RepairIsTriedAgainUntilTheMediumTakesIt) {
  {
    UploadRig rig(store_, key_);
    ASSERT_EQ(rig.send(upload(2e-5)).fault, UploadFault::kNone);
    ASSERT_EQ(rig.uploader().confirm().fault, UploadFault::kNone);
  }
  store_.cut_record(0, 10);
  UploadRig rig(store_, key_);
  ASSERT_TRUE(rig.uploader().damaged());
  store_.cut_power_after(0);
  EXPECT_FALSE(rig.uploader().repair());
  EXPECT_TRUE(rig.uploader().damaged());
  store_.restore_power();
  EXPECT_TRUE(rig.uploader().repair());
  EXPECT_FALSE(rig.uploader().damaged());
  const std::uint64_t written = store_.written();
  EXPECT_TRUE(rig.uploader().repair());
  EXPECT_EQ(store_.written(), written) << "nothing to repair";
}

TEST_F(Upload, EndOfATrialIsRecordedAgainUntilTheMediumTakesIt) {
  UploadRig rig(store_, key_);
  Uploader& uploader = rig.uploader();
  ASSERT_EQ(rig.send(upload(2e-5)).fault, UploadFault::kNone);
  rig.run(3);
  EXPECT_FALSE(uploader.look_after_store()) << "the trial runs";
  EXPECT_EQ(uploader.record().trial, 0);
  store_.cut_power_after(0);
  ASSERT_EQ(uploader.revert().fault, UploadFault::kNone);
  rig.run(3);
  EXPECT_FALSE(uploader.look_after_store());
  EXPECT_EQ(uploader.programs().trial(), Trial::kOver);
  EXPECT_NE(uploader.slots().trial(), kNoSlot) << "as the medium says";
  EXPECT_EQ(uploader.record().trial, kNoSlot) << "as it is";
  store_.restore_power();
  EXPECT_TRUE(uploader.look_after_store());
  EXPECT_EQ(uploader.programs().trial(), Trial::kNone);
  EXPECT_EQ(uploader.slots().trial(), kNoSlot);
}

TEST_F(Upload, GivenImageThatFindsNoMemoryIsRefused) {
  const Wiring wiring{{{"X"}, {"Y"}}, {"T"}};
  const auto image = small_image_bytes(2e-5);
  const auto size = static_cast<std::uint32_t>(image.size());
  const auto boot = [&](std::uint32_t image_bytes, bool taken) {
    Exchange exchange(16, 16);
    SimSlotStore store(image_bytes + sizeof(UploadHeader));
    Uploader uploader(store, wiring, exchange, {TimeUs(1000), key_.public_part(), TimeUs(60'000'000), 1});
    const ProgramRef other = taken ? uploader.programs().take() : nullptr;
    return uploader.boot_with(image).fault;
  };
  EXPECT_EQ(boot(size, false), UploadFault::kNone);
  EXPECT_EQ(boot(size - 1, false), UploadFault::kTooLarge);
  EXPECT_EQ(boot(size, true), UploadFault::kTooLarge) << "the only memory is in use";
}

TEST_F(Upload, BoardWithoutAKeyTrustsNobody) {
  const Wiring wiring{{{"X"}, {"Y"}}, {"T"}};
  Exchange exchange;
  Uploader uploader(store_, wiring, exchange, {});
  EXPECT_EQ(uploader.boot().fault, UploadFault::kNone);
  EXPECT_EQ(uploader.begin(1000).fault, UploadFault::kNoKey);
}

TEST_F(Upload, WithoutAPlaceItIsRefusedAndTheConfirmedOneStaysAtHand) {
  // GIVEN a board with places for two images, of which one runs
  const Wiring wiring{{{"X"}, {"Y"}}, {"T"}};
  Exchange exchange;
  Uploader uploader(store_, wiring, exchange, {TimeUs(1000), key_.public_part(), TimeUs(60'000'000), 2});
  Programs& programs = uploader.programs();
  BoundProgram before;
  const auto tick = [&] {  // takes over what is offered
    BoundProgram* const next = exchange.offered.exchange(nullptr);
    if (next != nullptr) exchange.retired.store(&before);
    programs.guard(TimeUs{});
    return next;
  };
  const auto send = [&](const std::vector<std::uint8_t>& bytes) {
    const auto size = static_cast<std::uint32_t>(bytes.size());
    const UploadFault fault = uploader.begin(size).fault;
    if (fault != UploadFault::kNone) return fault;
    EXPECT_EQ(uploader.add(0, bytes.data(), size).fault, UploadFault::kNone);
    return uploader.finish().fault;
  };
  ASSERT_EQ(send(upload(2e-5)), UploadFault::kNone);
  ASSERT_EQ(uploader.confirm().fault, UploadFault::kNone);
  programs.guard(TimeUs{});
  const BoundProgram* const first = tick();
  ASSERT_NE(first, nullptr);
  // WHEN one is tried and given up before the tick has taken it
  ASSERT_EQ(send(upload(4e-5, kIssued + 1)), UploadFault::kNone);
  programs.guard(TimeUs{});
  ASSERT_EQ(uploader.revert().fault, UploadFault::kNone);
  programs.guard(TimeUs{});
  // THEN it is never taken, its place is free, and the first one still runs
  EXPECT_EQ(tick(), nullptr);
  EXPECT_TRUE(uploader.look_after_store());
  ASSERT_EQ(send(upload(5e-5, kIssued + 2)), UploadFault::kNone);
  programs.guard(TimeUs{});
  ASSERT_NE(tick(), nullptr);
  // AND where it was taken, the first one comes back from memory, though there is no third place
  ASSERT_EQ(uploader.begin(1000).fault, UploadFault::kTrialRuns);
  ASSERT_EQ(uploader.revert().fault, UploadFault::kNone);
  programs.guard(TimeUs{});
  EXPECT_TRUE(uploader.look_after_store());
  EXPECT_EQ(uploader.begin(1000).fault, UploadFault::kStore) << "both places are in use until the next tick";
  EXPECT_EQ(tick(), first);
  EXPECT_EQ(uploader.begin(1000).fault, UploadFault::kNone);
}

// The lags of the confirmed image begin where its inputs are now; those of a running program are the tick's.
TEST_F(Upload, GoingBackStartsTheConfirmedImageAnewUnlessItRuns) {
  const Wiring wiring{{{"X"}, {"Y"}}, {"T"}};
  Exchange exchange;
  Uploader uploader(store_, wiring, exchange, {TimeUs(1000), key_.public_part(), TimeUs(60'000'000), 3});
  Programs& programs = uploader.programs();
  BoundProgram before;
  const auto tick = [&] {
    BoundProgram* const next = exchange.offered.exchange(nullptr);
    if (next != nullptr) exchange.retired.store(&before);
    programs.guard(TimeUs{});
    return next;
  };
  const auto send = [&](const std::vector<std::uint8_t>& bytes) {
    const auto size = static_cast<std::uint32_t>(bytes.size());
    ASSERT_EQ(uploader.begin(size).fault, UploadFault::kNone);
    ASSERT_EQ(uploader.add(0, bytes.data(), size).fault, UploadFault::kNone);
    ASSERT_EQ(uploader.finish().fault, UploadFault::kNone);
    programs.guard(TimeUs{});
  };
  const auto revert = [&] {
    ASSERT_EQ(uploader.revert().fault, UploadFault::kNone);
    programs.guard(TimeUs{});
    uploader.look_after_store();
  };
  send(upload(2e-5));
  ASSERT_EQ(uploader.confirm().fault, UploadFault::kNone);
  programs.guard(TimeUs{});
  BoundProgram* const first = tick();
  ASSERT_NE(first, nullptr);
  first->reads_input[kMaxInputs - 1] = true;  // a mark; a program that is bound again has it not
  // WHEN a trial ends before the tick has taken it THEN the confirmed image runs on as it is
  send(upload(4e-5, kIssued + 1));
  revert();
  EXPECT_EQ(tick(), nullptr);
  EXPECT_TRUE(first->reads_input[kMaxInputs - 1]);
  // WHEN the tick has taken the trial THEN the confirmed image begins anew
  send(upload(5e-5, kIssued + 2));
  ASSERT_NE(tick(), nullptr);
  revert();
  EXPECT_EQ(tick(), first);
  EXPECT_FALSE(first->reads_input[kMaxInputs - 1]);
}

/// The programs of a board, with the tick's part in the hands of the test.
struct ProgramsBench {
  Exchange exchange{16, 16};
  Programs programs{exchange, 2, 1024, 64};
  BoundProgram before;
  /// The tick takes what is offered; the guardian learns of it when the tick has put the old one away.
  void take() { EXPECT_NE(exchange.offered.exchange(nullptr), nullptr); }
  void put_away() { exchange.retired.store(&before); }
  void guard(std::int64_t now_us = 0) { programs.guard(TimeUs(now_us)); }
  LoadedProgram* run_trial(TimeUs trial = TimeUs(1000)) {
    ProgramRef program = programs.take();
    LoadedProgram* const raw = program.get();
    if (raw != nullptr) programs.run_trial(std::move(program), trial);
    return raw;
  }
};

TEST(Programs, TrialWhoseTimeEndsWhileItIsConfirmedIsKept) {
  ProgramsBench bench;
  LoadedProgram* const tried = bench.run_trial();
  bench.guard();
  bench.take(), bench.put_away(), bench.guard();
  ASSERT_TRUE(bench.programs.begin_to_keep());
  bench.guard(2000);  // after its time, while the record is being written
  EXPECT_EQ(bench.programs.trial(), Trial::kConfirming);
  EXPECT_EQ(bench.exchange.offered.load(), nullptr);
  bench.programs.kept(true);
  bench.guard(2001);
  EXPECT_EQ(bench.programs.trial(), Trial::kNone);
  EXPECT_EQ(bench.programs.look(), tried);
  bench.programs.look_away();
}

// Until the guardian has started a trial, its whole time is left, also after an earlier trial.
TEST(Programs, TrialEndsAtItsTimeAndTellsWhatIsLeft) {
  constexpr TimeUs kWhole(1000);
  for (const bool keep : {false, true}) {
    ProgramsBench bench;
    const auto left = [&](std::int64_t now_us) {
      return bench.programs.trial_left(TimeUs(now_us), kWhole).count;
    };
    bench.run_trial(kWhole);
    EXPECT_EQ(left(50), 1000);
    bench.guard(100);
    bench.take(), bench.put_away(), bench.guard(100);
    EXPECT_EQ(left(100), 1000);
    EXPECT_EQ(left(1099), 1);
    EXPECT_EQ(left(1100), 0);
    EXPECT_EQ(left(5000), 0);
    bench.guard(1099);
    EXPECT_EQ(bench.programs.trial(), Trial::kRunning);
    if (keep) {
      ASSERT_TRUE(bench.programs.begin_to_keep());
      bench.programs.kept(true);
      bench.guard(1100);
      EXPECT_EQ(bench.programs.trial(), Trial::kNone);
    } else {
      bench.guard(1100);
      EXPECT_EQ(bench.programs.trial(), Trial::kOver);
    }
    EXPECT_EQ(left(1200), 1000) << "of the next trial";
  }
}

TEST(Programs, TrialIsBeingGivenUpFromTheRequestUntilTheGuardianActs) {
  ProgramsBench bench;
  EXPECT_FALSE(bench.programs.give_up()) << "no trial";
  EXPECT_FALSE(bench.programs.giving_up());
  ASSERT_NE(bench.run_trial(), nullptr);
  bench.guard();
  EXPECT_FALSE(bench.programs.giving_up());
  EXPECT_TRUE(bench.programs.give_up());
  EXPECT_TRUE(bench.programs.giving_up());
  bench.guard();
  EXPECT_FALSE(bench.programs.giving_up());
}

// The guardian runs in the middle of a tick: the tick has taken the new program, and has not returned the
// old program yet.
TEST(Programs, ProgramThatCannotBeOfferedYetKeepsItsMemory) {
  ProgramsBench bench;
  ProgramRef first = bench.programs.take();
  bench.programs.run_confirmed(std::move(first));
  bench.guard();
  bench.take();
  LoadedProgram* const second = bench.run_trial();
  ASSERT_NE(second, nullptr);
  bench.guard();
  EXPECT_EQ(bench.exchange.offered.load(), nullptr);
  EXPECT_EQ(bench.programs.take(), nullptr) << "both memories are in use";
  bench.put_away(), bench.guard();
  EXPECT_EQ(bench.exchange.offered.load(), &second->bound);
}

TEST(Programs, ProgramThatALinkReadsKeepsItsMemoryUntilTheLinkLooksAway) {
  ProgramsBench bench;
  LoadedProgram* const tried = bench.run_trial();
  bench.guard();
  bench.take(), bench.put_away(), bench.guard();
  ASSERT_EQ(bench.programs.look(), tried);
  // WHEN its trial ends and the tick has left it
  ASSERT_TRUE(bench.programs.give_up());
  bench.guard();
  bench.take(), bench.put_away(), bench.guard();
  EXPECT_TRUE(tried->taken.load());
  bench.programs.look_away();
  bench.guard();
  EXPECT_FALSE(tried->taken.load());
}

// A medium that gives only a part of its records has had some.
// Each place has room for the largest image, whose size is not always a multiple of a word: what one program
// writes to its last byte, no other program and no other memory sees.
TEST(Programs, EachPlaceHasRoomForTheLargestImage) {
  for (std::uint32_t bytes = 1; bytes <= 40; ++bytes) {
    Exchange exchange(16, 16);
    Programs programs(exchange, Programs::kFewest, bytes, 0);
    EXPECT_EQ(programs.image_bytes(), bytes);
    std::vector<ProgramRef> taken;
    for (ProgramRef one = programs.take(); one != nullptr; one = programs.take()) {
      std::fill_n(one->image(), bytes, static_cast<std::uint8_t>(0xf0 + taken.size()));
      taken.push_back(std::move(one));
    }
    ASSERT_EQ(taken.size(), Programs::kFewest);
    for (std::size_t i = 0; i < taken.size(); ++i)
      EXPECT_EQ(std::count(taken[i]->image(), taken[i]->image() + bytes, 0xf0 + static_cast<int>(i)), bytes);
  }
}

TEST_F(Upload, RecordsThatAreCutAreALostImageAndNoNewBoard) {
  {
    UploadRig rig(store_, key_);
    ASSERT_EQ(rig.send(upload(2e-5)).fault, UploadFault::kNone);
    ASSERT_EQ(rig.uploader().confirm().fault, UploadFault::kNone);
  }
  for (const std::uint32_t place : {0u, 1u}) store_.cut_record(place, 10);
  UploadRig rig(store_, key_);
  rig.run(1000);
  EXPECT_EQ(rig.service().cycle().latched(), Fault::kImageLost);
}

TEST_F(Upload, FullStoreIsSaidAndTheOldImageRuns) {
  UploadRig rig(store_, key_);
  ASSERT_EQ(rig.send(upload(2e-5)).fault, UploadFault::kNone);
  ASSERT_EQ(rig.uploader().confirm().fault, UploadFault::kNone);
  store_.fill_up_to(500);
  EXPECT_EQ(rig.send(upload(4e-5, kIssued + 1)).fault, UploadFault::kStore);
  rig.run(3000);
  EXPECT_NEAR(slope(rig), 2e-5, 1e-7);
}

// Every sum takes all the terms there are: a program that passes the verifier, and stands for ever.
TEST_F(Upload, ImageThatIsTooMuchWorkForTheBoardIsRefusedWithThatReason) {
  const Wiring wiring{{{"X"}, {"Y"}}, {"T"}};
  Exchange exchange;
  Uploader::Options options{.identity = key_.public_part()};
  const auto send = [&](const WorkBudget& budget) {
    options.budget = budget;
    SimSlotStore store(1 << 16);
    Uploader uploader(store, wiring, exchange, options);
    const auto bytes = upload(2e-5);
    EXPECT_EQ(uploader.begin(static_cast<std::uint32_t>(bytes.size())).fault, UploadFault::kNone);
    EXPECT_EQ(uploader.add(0, bytes.data(), static_cast<std::uint32_t>(bytes.size())).fault,
              UploadFault::kNone);
    return uploader.finish();
  };
  const auto image = small_image();
  const std::uint64_t work = work_of(image->view.program().equation, image->view.program().channels.size);
  EXPECT_GT(work, 20u);
  EXPECT_EQ(send({work}).fault, UploadFault::kNone);
  EXPECT_EQ(send({work - 1}).fault, UploadFault::kTooMuchWork);
  EXPECT_STREQ(describe(send({1})),
               "the image needs more operations in each tick than this board can execute");
}

/// A look-up in 2048 uneven pieces.
struct LookUp {
  ErrorTable table;
  Instruction look{OpCode::kLookUp, 0, 0, 0, 0, 0, 0};
  LookUp() { table.pieces = 2048, table.columns = 1; }
  void put_in(Equation& equation) {
    equation.instructions = {&look, 1};
    equation.tables = {&table, 1};
  }
};

TEST_F(Upload, LinesThatNoCacheHoldsAreWorkToo) {
  // GIVEN a look-up in 2048 uneven pieces: a search through lines of memory, and the piece found
  LookUp look_up;
  Program program;
  look_up.put_in(program.equation);
  const std::uint64_t work = work_of(program.equation, 0), lines = lines_of(program.equation);
  EXPECT_GE(lines, 8u);
  EXPECT_LE(lines, 13u);
  // WHEN a line costs 7 THEN they count beside the operations
  EXPECT_TRUE((WorkBudget{work}.covers(program, {})));
  EXPECT_FALSE((WorkBudget{work, 7}.covers(program, {})));
  EXPECT_TRUE((WorkBudget{work + 7 * lines, 7}.covers(program, {})));
  EXPECT_FALSE((WorkBudget{work + 7 * lines - 1, 7}.covers(program, {})));
  // AND a line costs 2^30 at most
  constexpr std::uint64_t kMost = std::uint64_t{1} << 30;
  for (const std::uint64_t price : {kMost, kMost + 1, UINT64_MAX}) {
    EXPECT_TRUE((WorkBudget{work + kMost * lines, price}.covers(program, {}))) << price;
    EXPECT_FALSE((WorkBudget{work + kMost * lines - 1, price}.covers(program, {}))) << price;
  }
  EXPECT_TRUE((WorkBudget{work + (kMost - 1) * lines, kMost - 1}.covers(program, {})));
  // AND even stations need no search
  look_up.table.grid_multiplier = 1;
  EXPECT_LE(lines_of(program.equation), 2u);
}

// The link computes the shares of the effects beside the tick, of everything that they need.
TEST_F(Upload, SharesCountAllTheirWork) {
  LookUp look_up;
  ShareProgram shares;
  look_up.put_in(shares.equation);
  constexpr std::uint64_t kPrice = 7;
  const std::uint64_t beside = work_of(shares.equation, 0) + kPrice * lines_of(shares.equation);
  ASSERT_GT(work_of(shares.equation, 0), 20u);
  ASSERT_GT(lines_of(shares.equation), 4u);
  // Filled up to a multiple of the factor.
  const auto count = static_cast<std::uint32_t>(2 * kShareWorkFactor - beside % kShareWorkFactor);
  const std::vector<Share> some(count + 1);
  const WorkBudget budget{(beside + count) / kShareWorkFactor, kPrice};
  shares.shares = {some.data(), count};
  EXPECT_TRUE(budget.covers({}, shares));
  shares.shares = {some.data(), count + 1};
  EXPECT_FALSE(budget.covers({}, shares));
}

/// A clock whose first calls are 10 ns apart, and the further ones a millisecond.
struct SteppedClock : Clock {
  InstantNs now() noexcept override { return now_ = now_ + InstantNs(++calls_ <= 16 ? 10 : 1'000'000); }
  HalFault sleep_until(InstantNs) noexcept override { return HalFault::kNone; }

 private:
  InstantNs now_{};
  int calls_ = 0;
};

TEST_F(Upload, PriceOfALineIsItsTimeInOperations) {
  SteppedClock clock;
  std::vector<std::uint32_t> memory(16 * 16);  // 16 lines of 64 bytes
  const WorkBudget budget = measured_work_budget(clock, TimeUs(1000), memory);
  // The budget is what is done in 10 ns, over a quarter of a tick of 1 ms; a line takes 1 ms / 4096.
  const double done = static_cast<double>(budget.work) * 10 / 250'000;
  const double wanted = done * (1e6 / 4096) / 10;
  EXPECT_NEAR(static_cast<double>(budget.of_line), wanted, 1e-4 * wanted) << "both are rounded";
  EXPECT_EQ(memory[0], 0u) << "whole rounds through all lines end where they began";
}

// The measurement visits as many lines as fit, a power of two, each once; the words between stay.
TEST_F(Upload, PriceOfALineVisitsEachLineOnce) {
  struct {
    std::size_t words, lines;
  } const cases[] = {{32, 2}, {1023, 32}, {1024, 64}, {1025, 64}, {2048, 128}};
  for (const auto& wanted : cases) {
    constexpr std::uint32_t kUntouched = 0xdeadbeef;
    SteppedClock clock;
    std::vector<std::uint32_t> memory(wanted.words, kUntouched);
    measured_work_budget(clock, TimeUs(1000), memory);
    // The word of line 0 was replaced at the end: by 0, as whole rounds end where they began.
    std::vector<int> named(wanted.lines, 0);
    for (std::size_t i = 0; i < wanted.words; ++i)
      if (i % 16 != 0 || i / 16 >= wanted.lines) {
        EXPECT_EQ(memory[i], kUntouched) << wanted.words << " " << i;
      } else if (i > 0) {
        ASSERT_LT(memory[i], wanted.lines);
        ++named[memory[i]];
      }
    EXPECT_EQ(memory[0], 0u);
    EXPECT_EQ(std::count(named.begin(), named.end(), 1), static_cast<std::ptrdiff_t>(wanted.lines) - 1);
    EXPECT_EQ(std::count(named.begin(), named.end(), 0), 1) << "which line 0 named";
  }
  std::vector<std::uint32_t> less(31);
  SteppedClock clock;
  EXPECT_EQ(measured_work_budget(clock, TimeUs(1000), less).of_line, 0u) << "one line has no jump";
}

// The measurement has an end: eight tries of the operations, and eight of the jumps.
TEST_F(Upload, WorkIsMeasuredInSixteenTries) {
  struct : Clock {
    InstantNs now() noexcept override { return InstantNs(10 * ++calls); }
    HalFault sleep_until(InstantNs) noexcept override { return HalFault::kNone; }
    int calls = 0;
  } clock;
  std::vector<std::uint32_t> memory(16 * 16);
  measured_work_budget(clock, TimeUs(1000), memory);
  EXPECT_EQ(clock.calls, 2 * 16) << "two looks at the clock in a try";
}

TEST_F(Upload, WorkCountsTermsSoThatNoImageStallsTheTick) {
  std::vector<ProductTerm> terms(kMaxTerms, ProductTerm{0, 0, 40});
  std::vector<Instruction> steps(900, Instruction{OpCode::kDot, 20, kMaxTerms / 2, kMaxTerms / 2, 0, 0, 0});
  Equation equation;
  equation.channel_count = 1;
  equation.instructions = {steps.data(), 900};
  equation.terms = {terms.data(), kMaxTerms};
  equation.result_count = 900;
  EXPECT_GT(work_of(equation, 1), 3'600'000u);
  MonotonicClock clock;
  std::vector<std::uint32_t> memory(kWordsBeyondCaches);
  const WorkBudget measured = measured_work_budget(clock, TimeUs(1000), memory);
  const std::uint64_t budget = measured.work;
  std::printf("this computer: %llu a tick of 1 ms; the image of 3.7 million is %.1f quarters of one\n",
              static_cast<unsigned long long>(budget), 3.7e6 / static_cast<double>(budget));
  EXPECT_GT(budget, 2000u);
  EXPECT_LT(budget, 3'000'000u);
  std::printf("a line that no cache holds is %llu of it\n",
              static_cast<unsigned long long>(measured.of_line));
  EXPECT_GT(measured.of_line, 2u);
  EXPECT_LT(measured.of_line, budget / 10);
}

TEST_F(Upload, ConfirmedImageThatDoesNotLoadIsAFaultAndAnotherOneEndsIt) {
  {
    UploadRig rig(store_, key_);
    ASSERT_EQ(rig.send(upload(2e-5)).fault, UploadFault::kNone);
    ASSERT_EQ(rig.uploader().confirm().fault, UploadFault::kNone);
  }
  // GIVEN a slot in which a bit turned
  std::uint8_t byte = 0;
  ASSERT_EQ(store_.read_image(0, 700, &byte, 1), HalFault::kNone);
  byte = static_cast<std::uint8_t>(byte ^ 8);
  ASSERT_EQ(store_.write_image(0, 700, &byte, 1), HalFault::kNone);
  UploadRig rig(store_, key_);
  EXPECT_EQ(rig.boot_result().fault, UploadFault::kSignature);
  rig.run(1000);
  EXPECT_EQ(rig.service().cycle().mode(), Mode::kFaulted);
  EXPECT_EQ(rig.service().cycle().latched(), Fault::kImageLost);
  // WHEN another image is confirmed and the fault is cleared
  ASSERT_EQ(rig.send(upload(3e-5, kIssued + 1)).fault, UploadFault::kNone);
  ASSERT_EQ(rig.uploader().confirm().fault, UploadFault::kNone);
  std::atomic<Command>& command = const_cast<Exchange&>(rig.service().exchange()).command;
  command = Command::kClearFault;
  rig.run(3000);
  EXPECT_EQ(rig.service().cycle().mode(), Mode::kReady) << "as after every fault, an activation is needed";
  command = Command::kActivate;
  rig.run(3000);
  EXPECT_EQ(rig.service().cycle().mode(), Mode::kActive);
}

TEST_F(Upload, PiecesOutOfOrderAreRefusedAndARepeatedOneIsNot) {
  UploadRig rig(store_, key_);
  const std::vector<std::uint8_t> bytes = upload(2e-5);
  Uploader& uploader = rig.uploader();
  EXPECT_EQ(uploader.add(0, bytes.data(), 10).fault, UploadFault::kNoUpload);
  EXPECT_EQ(uploader.finish().fault, UploadFault::kNoUpload);
  ASSERT_EQ(uploader.begin(static_cast<std::uint32_t>(bytes.size())).fault, UploadFault::kNone);
  EXPECT_EQ(uploader.add(0, bytes.data(), 100).fault, UploadFault::kNone);
  EXPECT_EQ(uploader.add(0, bytes.data(), 100).fault, UploadFault::kNone);
  EXPECT_EQ(uploader.add(200, bytes.data() + 200, 100).fault, UploadFault::kOutOfOrder);
  EXPECT_EQ(uploader.add(50, bytes.data() + 50, 100).fault, UploadFault::kOutOfOrder);
  EXPECT_EQ(uploader.finish().fault, UploadFault::kIncomplete);
  EXPECT_EQ(uploader.add(100, bytes.data() + 100, 0).fault, UploadFault::kTooLarge) << "no piece at all";
  const auto rest = static_cast<std::uint32_t>(bytes.size() - 100);
  EXPECT_EQ(uploader.add(100, bytes.data() + 100, rest + 1).fault, UploadFault::kTooLarge);
  EXPECT_EQ(uploader.add(100, bytes.data() + 100, rest).fault, UploadFault::kNone);
  EXPECT_EQ(uploader.finish().fault, UploadFault::kNone);
}

// For every fault, every detail of it and the longest name.
TEST_F(Upload, LongestReasonFitsIntoItsLine) {
  UploadResult result;
  while (result.offender.size() + 1 < kImageNameBytes) result.offender.add('W');
  const std::string name = result.offender.c_str();
  std::size_t longest = 0;
  for (int fault = 0; fault < kUploadFaultCount; ++fault)
    for (int detail = 0; detail <= UINT8_MAX; ++detail) {
      result.fault = static_cast<UploadFault>(fault);
      result.image = static_cast<ImageFault>(detail);
      result.bind = static_cast<BindFault>(detail);
      const Line line = describe(result);
      const std::string text = line.c_str();
      EXPECT_EQ(text.substr(text.size() - name.size()), name) << text;
      longest = std::max(longest, text.size());
    }
  EXPECT_LT(longest, sizeof(Line::text) - 1) << "one byte is free at least";
}

TEST_F(Upload, FinishesOnce) {
  UploadRig rig(store_, key_);
  ASSERT_EQ(rig.send(upload(2e-5)).fault, UploadFault::kNone);
  EXPECT_EQ(rig.uploader().finish().fault, UploadFault::kNoUpload);
}

TEST_F(Upload, ImageThatFillsTheStoreIsTaken) {
  const std::vector<std::uint8_t> bytes = upload(2e-5);
  SimSlotStore exact(static_cast<std::uint32_t>(bytes.size())),
      less(static_cast<std::uint32_t>(bytes.size()) - 1);
  UploadRig fits(exact, key_), too_small(less, key_);
  EXPECT_EQ(fits.send(bytes).fault, UploadFault::kNone);
  EXPECT_EQ(too_small.send(bytes).fault, UploadFault::kTooLarge);
}

/// A store that notes the range of each write.
class NotingStore : public SimSlotStore {
 public:
  using SimSlotStore::SimSlotStore;
  HalFault write_image(std::uint32_t slot, std::uint32_t offset, const std::uint8_t* bytes,
                       std::uint32_t size) noexcept override {
    ranges.emplace_back(offset, size);
    return SimSlotStore::write_image(slot, offset, bytes, size);
  }
  std::vector<std::pair<std::uint32_t, std::uint32_t>> ranges;
};

// A small flash driver takes 4096 bytes in a write. No byte is written twice, and none is left out.
TEST_F(Upload, IsWrittenInPiecesOfAtMost4096Bytes) {
  constexpr auto kHeader = static_cast<std::uint32_t>(sizeof(UploadHeader));
  for (const std::uint32_t image : {1u, 4095u, 4096u, 4097u, 12'288u, 12'289u}) {
    NotingStore store(1 << 16);
    UploadRig rig(store, key_);
    std::vector<std::uint8_t> bytes(kHeader + image);
    for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(i * 7 + i / 256);
    EXPECT_EQ(rig.send(bytes, 200).fault, UploadFault::kNotAnUpload);
    std::uint32_t end = 0;
    for (const auto& [offset, size] : store.ranges) {
      EXPECT_EQ(offset, end);
      EXPECT_LE(size, 4096u);
      end = offset + size;
    }
    EXPECT_EQ(end, kHeader + image);
    EXPECT_EQ(store.ranges.size(), 1 + (image + 4095) / 4096);
    std::vector<std::uint8_t> stored(bytes.size());
    ASSERT_EQ(store.read_image(0, 0, stored.data(), kHeader + image), HalFault::kNone);
    EXPECT_EQ(stored, bytes);
    EXPECT_EQ(store.read_image(0, kHeader + image, stored.data(), 1), HalFault::kNoReading);
  }
}

TEST_F(Upload, BeginsWithTheSizeOfAHeaderToThatOfTheStore) {
  UploadRig rig(store_, key_);
  constexpr auto kHeader = static_cast<std::uint32_t>(sizeof(UploadHeader));
  EXPECT_EQ(rig.uploader().begin(kHeader - 1).fault, UploadFault::kNotAnUpload);
  EXPECT_EQ(rig.uploader().begin(kHeader).fault, UploadFault::kNone);
  EXPECT_EQ(rig.uploader().begin(store_.capacity()).fault, UploadFault::kNone);
  EXPECT_EQ(rig.uploader().begin(store_.capacity() + 1).fault, UploadFault::kTooLarge);
}

TEST_F(Upload, LatestTimeOfIssueIsTakenAndNoLaterOne) {
  UploadRig rig(store_, key_);
  EXPECT_EQ(rig.send(upload(2e-5, kLatestIssued + 1)).fault, UploadFault::kAbsurdTime);
  EXPECT_EQ(rig.send(upload(2e-5, kLatestIssued)).fault, UploadFault::kNone);
}

// An upload names one board, or a class of boards; no name at all names no board that has one.
TEST_F(Upload, IsTakenByTheBoardOrTheClassThatItNames) {
  const auto fault_of = [&](const char* own_class, const char* named) {
    SimSlotStore store(1 << 16);
    const Wiring wiring{{{"X"}, {"Y"}}, {"T"}};
    Exchange exchange(16, 16);
    Uploader::Options options;
    options.identity = key_.public_part();
    options.identity.board = "mill-1";
    options.identity.board_class = own_class;
    Uploader uploader(store, wiring, exchange, options);
    const std::vector<std::uint8_t> bytes =
        make_upload(small_image_bytes(2e-5), key_, kIssued, kSecurity, named);
    const auto size = static_cast<std::uint32_t>(bytes.size());
    EXPECT_EQ(uploader.begin(size).fault, UploadFault::kNone);
    EXPECT_EQ(uploader.add(0, bytes.data(), size).fault, UploadFault::kNone);
    return uploader.finish().fault;
  };
  EXPECT_EQ(fault_of("", "mill-1"), UploadFault::kNone);
  EXPECT_EQ(fault_of("mills", "mill-1"), UploadFault::kNone);
  EXPECT_EQ(fault_of("mills", "mills"), UploadFault::kNone);
  EXPECT_EQ(fault_of("mills", "lathes"), UploadFault::kOtherBoard);
  EXPECT_EQ(fault_of("mills", ""), UploadFault::kOtherBoard);
  EXPECT_EQ(fault_of("", ""), UploadFault::kOtherBoard);
}

TEST_F(Upload, StoreWhoseRecordsAreBothSpoiledHasLostItsImage) {
  {
    UploadRig rig(store_, key_);
    ASSERT_EQ(rig.send(upload(2e-5)).fault, UploadFault::kNone);
    ASSERT_EQ(rig.uploader().confirm().fault, UploadFault::kNone);
  }
  for (std::uint32_t place = 0; place < 2; ++place) {
    std::uint8_t record[sizeof(SlotRecord)];
    ASSERT_EQ(store_.read_record(place, record, sizeof(record)), HalFault::kNone);
    record[5] ^= 0x40;
    ASSERT_EQ(store_.write_record(place, record, sizeof(record)), HalFault::kNone);
    UploadRig rig(store_, key_);
    rig.run(500);
    // One of them is enough; without both nothing is made up, and it is said.
    EXPECT_EQ(rig.boot_result().fault, place == 0 ? UploadFault::kNone : UploadFault::kStore);
    EXPECT_EQ(rig.service().cycle().latched(), place == 0 ? Fault::kNone : Fault::kImageLost);
    if (place == 0) continue;
    EXPECT_STREQ(describe(rig.boot_result()), "the board's store is full or broken: both records");
    // and an image that is confirmed ends it
    ASSERT_EQ(rig.send(upload(3e-5, kIssued + 1)).fault, UploadFault::kNone);
    ASSERT_EQ(rig.uploader().confirm().fault, UploadFault::kNone);
    EXPECT_FALSE(rig.uploader().image_lost());
  }
}

TEST_F(Upload, ErasedFlashIsAnEmptyStore) {
  std::uint8_t ones[sizeof(SlotRecord)];
  std::fill(std::begin(ones), std::end(ones), std::uint8_t{0xff});
  for (std::uint32_t place = 0; place < 2; ++place)
    ASSERT_EQ(store_.write_record(place, ones, sizeof(ones)), HalFault::kNone);
  UploadRig rig(store_, key_);
  rig.run(500);
  EXPECT_EQ(rig.boot_result().fault, UploadFault::kNone);
  EXPECT_EQ(rig.service().cycle().latched(), Fault::kNone);
  ASSERT_EQ(rig.send(upload(2e-5)).fault, UploadFault::kNone);
  ASSERT_EQ(rig.uploader().confirm().fault, UploadFault::kNone);
}

// The power fails after every single byte that an upload, its trial and its confirmation write.
TEST_F(Upload, PowerLostAtAnyWriteLeavesOldOrNewTable) {
  SimSlotStore blank = store_;
  {
    UploadRig rig(blank, key_);
    ASSERT_EQ(rig.send(upload(2e-5)).fault, UploadFault::kNone);
    ASSERT_EQ(rig.uploader().confirm().fault, UploadFault::kNone);
  }
  const std::vector<std::uint8_t> next = upload(4e-5, kIssued + 1);
  const auto replace = [&](SimSlotStore& store) {
    UploadRig rig(store, key_);
    if (rig.send(next).fault != UploadFault::kNone) return false;
    return rig.uploader().confirm().fault == UploadFault::kNone;
  };
  SimSlotStore counted = blank;
  ASSERT_TRUE(replace(counted));
  const std::uint64_t bytes = counted.written() - blank.written();
  std::uint64_t old_ones = 0, new_ones = 0;
  for (std::uint64_t cut = 0; cut <= bytes; ++cut) {
    SimSlotStore store = blank;
    store.cut_power_after(cut);
    const bool said_done = replace(store);
    store.restore_power();
    UploadRig rig(store, key_);
    ASSERT_EQ(rig.boot_result().fault, UploadFault::kNone) << "cut after byte " << cut;
    const bool is_new = rig.uploader().slots().issued() == kIssued + 1;
    ASSERT_TRUE(is_new || rig.uploader().slots().issued() == kIssued);
    ASSERT_TRUE(is_new || !said_done) << "what was said to be done must stay";
    (is_new ? new_ones : old_ones) += 1;
  }
  std::printf("%llu cuts: %llu old, %llu new\n", static_cast<unsigned long long>(bytes + 1),
              static_cast<unsigned long long>(old_ones), static_cast<unsigned long long>(new_ones));
  EXPECT_GT(old_ones, 0u);
  EXPECT_GT(new_ones, 0u);
}

TEST_F(Upload, HoldKeepsEveryCorrectionAndReleaseMovesOnWithoutAStep) {
  UploadRig rig(store_, key_);
  ASSERT_EQ(rig.send(upload(2e-5)).fault, UploadFault::kNone);
  ASSERT_EQ(rig.uploader().confirm().fault, UploadFault::kNone);
  rig.run(4000);
  ASSERT_EQ(rig.service().cycle().mode(), Mode::kActive);
  auto& command = const_cast<Exchange&>(rig.service().exchange()).command;
  command = Command::kHold;
  rig.run(1);
  const AxisTravel held = rig.plant().written(0);
  rig.run(500);
  EXPECT_EQ(rig.plant().written(0), held);
  EXPECT_TRUE(rig.service().cycle().holding());
  command = Command::kRelease;
  rig.run(500);
  EXPECT_NE(rig.plant().written(0), held);
  EXPECT_NEAR(slope(rig), 2e-5, 1e-7);
  EXPECT_LE(rig.worst_step(0), kSmallSlewX);
}

TEST_F(Upload, WeightOfAnAxisScalesItsCorrectionAloneAndWithoutAStep) {
  UploadRig rig(store_, key_);
  ASSERT_EQ(rig.send(upload(2e-5)).fault, UploadFault::kNone);
  ASSERT_EQ(rig.uploader().confirm().fault, UploadFault::kNone);
  rig.run(4000);
  const_cast<Exchange&>(rig.service().exchange()).axis_weight[0] = kFullWeight.count / 2;
  rig.run(1000);
  AxisReading x, y;
  rig.plant().read_axis(0, x), rig.plant().read_axis(1, y);
  const double whole = -(2e-5 * static_cast<double>(x.position.count) + 4000 * x.sense);
  EXPECT_NEAR(static_cast<double>(rig.plant().written(0).count), whole / 2, 3);
  EXPECT_NEAR(static_cast<double>(rig.plant().written(1).count),
              -1e-4 * static_cast<double>(y.position.count), 3);
  EXPECT_LE(rig.worst_step(0), kSmallSlewX);
}

}  // namespace
}  // namespace vernier::upload_test
