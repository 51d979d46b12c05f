// SPDX-License-Identifier: GPL-3.0-or-later
// An image of anybody: refused, or it runs on any positions without harm.
#include <cstring>
#include <memory>
#include <random>

#include "firmware/core/cycle/bound_program.h"
#include "tables/checksum.h"
#include "tables/image_view.h"
#include "tests/fuzz/target.h"

namespace vernier::fuzz {
namespace {

/// Puts sizes and sums right, so that what stands behind them is reached.
void mend_sums(std::uint8_t* bytes, std::uint32_t size) {
  ImageHeader header;
  constexpr std::uint32_t kBehind = sizeof(ImageHeader) + kSectionCount * sizeof(SectionEntry);
  if (size < kBehind) return;
  std::memcpy(&header, bytes, sizeof header);
  header.image_bytes = size;
  std::uint64_t print = kFnvSeed;
  for (std::uint32_t i = static_cast<std::uint32_t>(SectionType::kConstants); i < kSectionCount; ++i) {
    SectionEntry entry;
    std::memcpy(&entry, bytes + sizeof(ImageHeader) + i * sizeof(SectionEntry), sizeof entry);
    const std::uint64_t here = std::uint64_t{entry.count} * entry.record_bytes;
    if (entry.offset > size || here > size - entry.offset) return;
    print = fnv1a(bytes + entry.offset, static_cast<std::uint32_t>(here), print);
  }
  header.fingerprint = print;
  std::memcpy(bytes, &header, sizeof header);
  header.checksum = crc32c(bytes + kChecksumStart, size - kChecksumStart);
  std::memcpy(bytes, &header, sizeof header);
}

CycleInput anywhere(std::mt19937_64& random) {
  const auto anything = [&] { return static_cast<std::int64_t>(random()) >> (random() % 64); };
  CycleInput input;
  for (AxisInput& axis : input.axis)
    axis = {AxisPosition(anything()), AxisSpeed(anything()), AxisAcceleration(anything()),
            AxisTravel(anything()), static_cast<std::int8_t>(static_cast<int>(random() % 3) - 1)};
  for (InputMicro& value : input.input) value = InputMicro(anything());
  input.feed = FeedNmPerMin(anything());
  input.curvature = CurvatureNanoPerMm(anything());
  input.time = TimeUs(anything());
  input.visit = VisitCount(anything());
  return input;
}

void take(Bytes bytes) {
  if (bytes.size() > 1u << 16) return;
  const auto size = static_cast<std::uint32_t>(bytes.size());
  std::vector<std::uint64_t> words(size / 8 + 1);
  auto* const image = reinterpret_cast<std::uint8_t*>(words.data());
  std::copy(bytes.begin(), bytes.end(), image);
  mend_sums(image, size);
  static const auto workspace = std::make_unique<ImageWorkspace>();
  ImageView view;
  if (view.open(image, size, *workspace) != ImageFault::kNone) return;
  expect(std::strlen(view.name()) <= size, "a name without an end");
  const auto bound = std::make_unique<BoundProgram>(view);
  std::mt19937_64 random(size);
  for (int i = 0; i < 20; ++i) {
    const CycleOutput output = bound->compensator.step(anywhere(random));
    for (const Output& out : bound->program.outputs)
      expect(
          output.correction[out.axis].counts <= out.limit && output.correction[out.axis].counts >= -out.limit,
          "a correction beyond its limit");
  }
}

const Registered kTarget("image", take);

}  // namespace
}  // namespace vernier::fuzz
