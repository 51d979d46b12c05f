// SPDX-License-Identifier: GPL-3.0-or-later
// What every SlotStore owes the uploader: in memory, and as files.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <functional>
#include <memory>

#include "hal/linux/file_slot_store.h"
#include "hal/sim/sim_slot_store.h"

namespace vernier::slot_store_test {
namespace {

constexpr std::uint32_t kCapacity = 5000;

struct Backend {
  const char* name;
  std::function<std::unique_ptr<SlotStore>(const std::string&)> make;
};

class SlotStoreConformance : public testing::TestWithParam<Backend> {
 protected:
  SlotStoreConformance() { std::filesystem::create_directories(directory_); }
  ~SlotStoreConformance() override { std::filesystem::remove_all(directory_); }
  const std::string directory_ =
      testing::TempDir() + "slots_" + std::to_string(getpid()) + "_" + GetParam().name;
  std::unique_ptr<SlotStore> store_ = GetParam().make(directory_);
};

TEST_P(SlotStoreConformance, NothingIsReadBeforeItWasWritten) {
  std::uint8_t bytes[32] = {};
  EXPECT_EQ(store_->read_record(0, bytes, sizeof(bytes)), HalFault::kNoReading);
  EXPECT_EQ(store_->read_image(1, 0, bytes, sizeof(bytes)), HalFault::kNoReading);
}

TEST_P(SlotStoreConformance, CutRecordIsNoBlankOne) {
  std::uint8_t bytes[32] = {};
  ASSERT_EQ(store_->write_record(0, bytes, 8), HalFault::kNone);
  if (std::filesystem::exists(directory_ + "/record0")) {  // and of a file not even one byte is left
    EXPECT_EQ(store_->read_record(0, bytes, sizeof(bytes)), HalFault::kRefused);
    std::filesystem::resize_file(directory_ + "/record0", 0);
    EXPECT_EQ(store_->read_record(0, bytes, 1), HalFault::kRefused);
    return;
  }
  EXPECT_NE(store_->read_record(0, bytes, sizeof(bytes)), HalFault::kNone);
  EXPECT_EQ(store_->read_record(0, bytes, 8), HalFault::kNone);
}

TEST_P(SlotStoreConformance, GivesBackWhatWasWritten) {
  std::uint8_t record[32], image[3000], back[3000] = {};
  for (std::size_t i = 0; i < sizeof(record); ++i) record[i] = static_cast<std::uint8_t>(i);
  for (std::size_t i = 0; i < sizeof(image); ++i) image[i] = static_cast<std::uint8_t>(7 * i);
  ASSERT_EQ(store_->write_record(1, record, sizeof(record)), HalFault::kNone);
  for (std::uint32_t at = 0; at < sizeof(image); at += 500)
    ASSERT_EQ(store_->write_image(0, at, image + at, 500), HalFault::kNone);
  ASSERT_EQ(store_->finish_image(0, sizeof(image)), HalFault::kNone);
  ASSERT_EQ(store_->read_image(0, 0, back, sizeof(image)), HalFault::kNone);
  EXPECT_TRUE(std::equal(image, image + sizeof(image), back));
  ASSERT_EQ(store_->read_record(1, back, sizeof(record)), HalFault::kNone);
  EXPECT_TRUE(std::equal(record, record + sizeof(record), back));
  EXPECT_EQ(store_->read_record(0, back, sizeof(record)), HalFault::kNoReading)
      << "the other place is untouched";
  EXPECT_EQ(store_->read_image(1, 0, back, 1), HalFault::kNoReading);
}

TEST_P(SlotStoreConformance, ShorterImageEndsWhereItEnds) {
  const std::uint8_t bytes[200] = {};
  std::uint8_t back[200];
  ASSERT_EQ(store_->write_image(0, 0, bytes, 200), HalFault::kNone);
  ASSERT_EQ(store_->finish_image(0, 200), HalFault::kNone);
  ASSERT_EQ(store_->write_image(0, 0, bytes, 50), HalFault::kNone);
  ASSERT_EQ(store_->finish_image(0, 50), HalFault::kNone);
  EXPECT_EQ(store_->read_image(0, 0, back, 50), HalFault::kNone);
  EXPECT_EQ(store_->read_image(0, 0, back, 51), HalFault::kNoReading);
}

TEST_P(SlotStoreConformance, RefusesWhatItDoesNotHave) {
  std::uint8_t bytes[100] = {};
  EXPECT_EQ(store_->capacity(), kCapacity);
  EXPECT_EQ(store_->write_image(2, 0, bytes, 10), HalFault::kNoDevice);
  EXPECT_EQ(store_->write_image(0, kCapacity - 99, bytes, 100), HalFault::kNoDevice);
  EXPECT_EQ(store_->write_image(0, UINT32_MAX, bytes, 100), HalFault::kNoDevice);
  EXPECT_EQ(store_->write_record(4, bytes, 32), HalFault::kNoDevice);
  EXPECT_EQ(store_->read_record(4, bytes, 32), HalFault::kNoDevice);
  EXPECT_EQ(store_->read_image(2, 0, bytes, 1), HalFault::kNoDevice);
}

TEST_P(SlotStoreConformance, ARecordEndsWithItsLastByte) {
  std::uint8_t bytes[42] = {};
  ASSERT_EQ(store_->write_record(2, bytes, 42), HalFault::kNone);
  ASSERT_EQ(store_->write_record(2, bytes, 32), HalFault::kNone);
  EXPECT_EQ(store_->read_record(2, bytes, 32), HalFault::kNone);
  EXPECT_NE(store_->read_record(2, bytes, 33), HalFault::kNone);
}

INSTANTIATE_TEST_SUITE_P(
    Backends, SlotStoreConformance,
    testing::Values(Backend{"sim",
                            [](const std::string&) { return std::make_unique<SimSlotStore>(kCapacity); }},
                    Backend{"files",
                            [](const std::string& directory) {
                              return std::make_unique<FileSlotStore>(directory, kCapacity);
                            }}),
    [](const auto& parameter) { return parameter.param.name; });

// A pipe in the place of a file kept the daemon waiting for a writer.
TEST(FileSlotStore, OtherKindsOfFilesAreRefusedAndNeverWaitedFor) {
  const std::string directory = testing::TempDir() + "kinds_" + std::to_string(getpid());
  std::filesystem::create_directories(directory + "/record3");
  for (const char* const name : {"/record2", "/slot0.vup"})
    ASSERT_EQ(::mkfifo((directory + name).c_str(), 0600), 0);
  FileSlotStore store(directory, kCapacity);
  std::uint8_t bytes[32] = {};
  for (const std::uint32_t place : {2u, 3u}) {
    EXPECT_EQ(store.read_record(place, bytes, sizeof(bytes)), HalFault::kRefused);
    EXPECT_EQ(store.write_record(place, bytes, sizeof(bytes)), HalFault::kRefused);
  }
  EXPECT_EQ(store.read_image(0, 0, bytes, sizeof(bytes)), HalFault::kRefused);
  EXPECT_EQ(store.write_image(0, 0, bytes, sizeof(bytes)), HalFault::kRefused);
  std::filesystem::remove_all(directory);
}

TEST(FileSlotStore, MissingDirectoryAndFullMediumAreFaults) {
  const std::uint8_t bytes[32] = {};
  FileSlotStore nowhere("/nonexistent/slots", kCapacity);
  EXPECT_EQ(nowhere.write_record(0, bytes, sizeof(bytes)), HalFault::kRefused);
  EXPECT_EQ(nowhere.write_image(0, 0, bytes, sizeof(bytes)), HalFault::kRefused);
  // /dev/full answers every write with "no space left".
  const std::string directory = testing::TempDir() + "full_" + std::to_string(getpid());
  std::filesystem::create_directories(directory);
  std::filesystem::create_symlink("/dev/full", directory + "/slot0.vup");
  FileSlotStore full(directory, kCapacity);
  EXPECT_EQ(full.write_image(0, 0, bytes, sizeof(bytes)), HalFault::kRefused);
  std::filesystem::remove_all(directory);
}

}  // namespace
}  // namespace vernier::slot_store_test
