// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <map>
#include <random>

#include "tables/checksum.h"
#include "tests/unit/compile/poses.h"

namespace vernier::image_test {
namespace {

constexpr unsigned kSeed = 60610;

/// Cases of a random test, of each machine: VERNIER_CASES=1000000 image_test makes a long night of it.
int cases() {
  const char* const asked = std::getenv("VERNIER_CASES");
  return asked != nullptr ? std::atoi(asked) : 40'000;
}

/// An image in aligned memory that ends where it ends, so that the sanitizer sees a step beyond.
class Bytes {
 public:
  explicit Bytes(const std::vector<std::uint8_t>& image)
      : size_(static_cast<std::uint32_t>(image.size())),
        data_(new (std::align_val_t{8}) std::uint8_t[image.size()]) {
    if (!image.empty()) std::memcpy(data_, image.data(), image.size());
  }
  Bytes(const Bytes&) = delete;
  Bytes& operator=(const Bytes&) = delete;
  ~Bytes() { operator delete[](data_, std::align_val_t{8}); }
  std::uint8_t* data() { return data_; }
  std::uint32_t size() const { return size_; }
  /// Makes header and sums consistent again, as an attacker would.
  void repair() {
    ImageHeader header;
    std::memcpy(&header, data_, sizeof(header));
    std::uint64_t fingerprint = kFnvSeed;
    for (std::uint32_t i = static_cast<std::uint32_t>(SectionType::kConstants); i < kSectionCount; ++i) {
      SectionEntry entry;
      std::memcpy(&entry, data_ + sizeof(ImageHeader) + i * sizeof(SectionEntry), sizeof(entry));
      const std::uint64_t length = std::uint64_t{entry.count} * entry.record_bytes;
      if (entry.offset > size_ || length > size_ - entry.offset) break;
      fingerprint = fnv1a(data_ + entry.offset, static_cast<std::uint32_t>(length), fingerprint);
    }
    header.fingerprint = fingerprint;
    std::memcpy(data_, &header, sizeof(header));
    header.checksum = crc32c(data_ + kChecksumStart, size_ - kChecksumStart);
    std::memcpy(data_, &header, sizeof(header));
  }

 private:
  std::uint32_t size_;
  std::uint8_t* data_;
};

/// One random change: a bit, a byte, a word with a telling value, or a stretch copied from elsewhere.
void mutate(Bytes& bytes, std::mt19937_64& random) {
  const auto at = [&](std::uint32_t width) {
    return static_cast<std::uint32_t>(random() % (bytes.size() - width));
  };
  switch (random() % 4) {
    case 0:
      bytes.data()[at(1)] ^= static_cast<std::uint8_t>(1u << random() % 8);
      return;
    case 1:
      bytes.data()[at(1)] = static_cast<std::uint8_t>(random());
      return;
    case 2: {
      constexpr std::int32_t kTelling[] = {0, 1, -1, INT32_MAX, INT32_MIN, 0x7fff, 64, 63, 1 << 30, 1000000};
      const std::int32_t word =
          random() % 2 != 0 ? kTelling[random() % 10] : static_cast<std::int32_t>(random());
      std::memcpy(bytes.data() + at(8) / 4 * 4, &word, 4);
      return;
    }
    default: {
      const std::uint32_t length = 1 + static_cast<std::uint32_t>(random() % 32);
      std::memmove(bytes.data() + at(length), bytes.data() + at(length), length);
    }
  }
}

CycleInput hostile_input(std::mt19937_64& random) {
  CycleInput input;
  const auto any = [&] {
    return random() % 4 == 0   ? INT64_MIN
           : random() % 4 == 0 ? INT64_MAX
                               : static_cast<std::int64_t>(random()) >> random() % 60;
  };
  for (AxisInput& axis : input.axis) {
    axis.position = AxisPosition(any());
    axis.velocity = AxisSpeed(any());
    axis.acceleration = AxisAcceleration(any());
    axis.since = AxisTravel(any());
    axis.sense = static_cast<std::int8_t>(random());
  }
  for (InputMicro& value : input.input) value = InputMicro(any());
  input.feed = FeedNmPerMin(any());
  input.curvature = CurvatureNanoPerMm(any());
  input.time = TimeUs(any());
  input.visit = VisitCount(any());
  return input;
}

/// Opens it; an accepted image must run on anything, with every register inside the range that was proved for
/// it.
ImageFault open_and_run(Bytes& bytes, std::mt19937_64& random) {
  static ImageWorkspace workspace;
  ImageView view;
  const ImageFault fault = view.open(bytes.data(), bytes.size(), workspace);
  if (fault != ImageFault::kNone) return fault;
  Compensator compensator(view.program());
  for (int tick = 0; tick < 3; ++tick) {
    compensator.step(hostile_input(random));
    for (std::uint32_t i = 0; i < view.program().equation.register_count(); ++i) {
      EXPECT_GE(compensator.register_value(i), workspace.ranges[i].low) << "register " << i;
      EXPECT_LE(compensator.register_value(i), workspace.ranges[i].high) << "register " << i;
    }
  }
  return fault;
}

class Image : public testing::TestWithParam<const char*> {};

TEST_P(Image, RunsWithinItsProvedRangesOnHostileInputs) {
  const TestMachine test(GetParam());
  Bytes bytes(test.compiled.image);
  std::mt19937_64 random(kSeed);
  for (int i = 0; i < 3000; ++i) ASSERT_EQ(open_and_run(bytes, random), ImageFault::kNone);
}

TEST(ImageNames, ANameThatStandsTwiceIsRefused) {
  const TestMachine test("bridge");
  for (const SectionType type : {SectionType::kAxes, SectionType::kInputs}) {
    Bytes bytes(test.compiled.image);
    SectionEntry entry;
    std::memcpy(&entry, bytes.data() + sizeof(ImageHeader) + static_cast<std::size_t>(type) * sizeof(entry),
                sizeof(entry));
    if (entry.count < 2) continue;
    // WHEN the second record takes the name of the first
    std::memcpy(bytes.data() + entry.offset + entry.record_bytes, bytes.data() + entry.offset,
                kImageNameBytes);
    bytes.repair();
    static ImageWorkspace workspace;
    ImageView view;
    // THEN no view is given
    EXPECT_EQ(view.open(bytes.data(), bytes.size(), workspace),
              type == SectionType::kAxes ? ImageFault::kAxis : ImageFault::kInput);
  }
}

TEST_P(Image, IsNeverAcceptedOnceChanged) {
  const TestMachine test(GetParam());
  std::mt19937_64 random(kSeed);
  std::size_t changed = 0;
  for (int i = 0; i < cases(); ++i) {
    Bytes bytes(test.compiled.image);
    mutate(bytes, random);
    if (std::memcmp(bytes.data(), test.compiled.image.data(), bytes.size()) == 0) continue;
    ++changed;
    ASSERT_NE(open_and_run(bytes, random), ImageFault::kNone) << "seed " << kSeed << " case " << i;
  }
  EXPECT_GT(changed, static_cast<std::size_t>(cases()) * 3 / 4);
}

TEST_P(Image, CannotHarmWhenForged) {
  const TestMachine test(GetParam());
  std::mt19937_64 random(kSeed + 1);
  std::map<ImageFault, int> seen;
  for (int i = 0; i < cases(); ++i) {
    Bytes bytes(test.compiled.image);
    const std::uint64_t changes = 1 + random() % 3;
    for (std::uint64_t k = 0; k < changes; ++k) mutate(bytes, random);
    bytes.repair();
    ++seen[open_and_run(bytes, random)];
    if (HasFailure()) FAIL() << "seed " << kSeed + 1 << " case " << i;
  }
  std::printf("%s, seed %u:", GetParam(), kSeed + 1);
  for (const auto& [fault, count] : seen) std::printf(" [%s] %d", describe(fault), count);
  std::printf("\n");
  EXPECT_GT(seen[ImageFault::kNone], 0);  // a changed value in a table is a sound image
  EXPECT_LT(seen[ImageFault::kChecksum],
            cases() / 200);  // the forgery reaches the checks behind the sums, bar a changed length
  EXPECT_GT(seen.size(), 6u);
}

TEST_P(Image, IsRefusedAtEveryLengthButItsOwn) {
  const TestMachine test(GetParam());
  std::mt19937_64 random(kSeed);
  for (std::size_t length = 0; length < test.compiled.image.size(); length += length < 600 ? 1 : 97) {
    Bytes bytes(
        {test.compiled.image.begin(), test.compiled.image.begin() + static_cast<std::ptrdiff_t>(length)});
    ASSERT_EQ(open_and_run(bytes, random), ImageFault::kTruncated) << length;
  }
}

INSTANTIATE_TEST_SUITE_P(Machines, Image, testing::Values("bridge", "five_axis", "planar"));

TEST(ImageFaultNames, AreAllDifferent) {
  std::map<std::string, int> names;
  for (int i = 0; i <= static_cast<int>(ImageFault::kProgramOutput); ++i)
    ++names[describe(static_cast<ImageFault>(i))];
  EXPECT_EQ(names.size(), static_cast<std::size_t>(ImageFault::kProgramOutput) + 1);
  EXPECT_EQ(names.count("unknown fault"), 0u);
}

}  // namespace
}  // namespace vernier::image_test
