// SPDX-License-Identifier: GPL-3.0-or-later
// The tick allocates nothing: every way to the heap is counted while a tick runs, in this thread alone.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <thread>

#include "firmware/core/cycle/feature_inputs.h"
#include "tests/unit/firmware/upload_rig.h"

namespace {

thread_local bool in_tick = false;
std::atomic<int> allocations{0};

}  // namespace

// Under the sanitizers the heap is theirs and cannot be taken over.
#ifdef VERNIER_SANITIZED
constexpr bool kCountsAllocations = false;
#else
constexpr bool kCountsAllocations = true;

static void count() {
  if (in_tick) ++allocations;
}

extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* block, std::size_t size);
void __libc_free(void* block);

void* malloc(std::size_t size) {
  count();
  return __libc_malloc(size);
}
void* calloc(std::size_t number, std::size_t size) {
  count();
  return __libc_calloc(number, size);
}
void* realloc(void* block, std::size_t size) {
  count();
  return __libc_realloc(block, size);
}
void free(void* block) {
  count();
  __libc_free(block);
}
}
#endif

namespace vernier::no_allocation_test {

using namespace vernier::upload;
namespace {

TEST(Tick, TouchesNoHeapWhileImagesComeInAndFaultsHappen) {
  if (!kCountsAllocations) GTEST_SKIP() << "the sanitizers own the heap";
  const SigningKey key = new_key();
  SimSlotStore store(1 << 16);
  Roaming motion({{0, 600'000'000}, {0, 200'000'000}}, {InputMicro(21'000'000), InputMicro(0)}, TimeUs(1000),
                 0.1, 1);
  motion.vibrate(1, 1e6, 40);
  PlantOptions options;
  options.dropout = 0.001;
  options.faults = {{PlantFaultKind::kJump, 0, 12000, 1, 5'000'000}};
  options.faults.push_back({PlantFaultKind::kSensorLost, 1, 9000, 2000});
  SimPlant plant(motion, 2, 2, options);
  FeatureInputs features(plant, 4,
                         {{.input = 2, .of = 1, .window = 800}, {.input = 3, .of = 1, .corner_mHz = 5000}},
                         TimeUs(1000));
  ASSERT_EQ(features.refused(), kNoInput);
  SimClock clock;
  ServiceOptions service_options;
  service_options.wiring = {{{"X"}, {"Y"}}, {"T", "acc", "acc_RMS", "acc_travel"}};
  service_options.upload.identity = key.public_part();
  service_options.activate = true;
  Service service(service_options, Board{clock, plant, features, plant}, store);
  service.boot();
  plant.release();
  auto& uploader = const_cast<Uploader&>(service.uploader());
  for (int tick = 0; tick < 20000; ++tick) {
    if (tick % 2000 == 1000) {
      const auto upload =
          make_upload(small_image_bytes(1e-5 * (1 + tick / 2000)), key, static_cast<std::uint64_t>(tick), 0);
      service.look_after_programs();
      uploader.begin(static_cast<std::uint32_t>(upload.size()));
      uploader.add(0, upload.data(), static_cast<std::uint32_t>(upload.size()));
      ASSERT_EQ(uploader.finish().fault, UploadFault::kNone);
      ASSERT_EQ(uploader.confirm().fault, UploadFault::kNone);
    }
    service.look_after_programs();
    plant.advance();
    in_tick = true;
    service.tick();
    in_tick = false;
  }
  EXPECT_EQ(allocations, 0);
  EXPECT_EQ(service.cycle().health().programs, 10u);
  EXPECT_EQ(service.cycle().health().faults, 1u);
  EXPECT_GT(service.cycle().input_value(2).count, 500'000) << "the features were worked out";
  EXPECT_NE(service.cycle().input_value(3).count, 0) << "the displacement too";
  // The count counts: an allocation inside a tick would be seen.
  in_tick = true;
  void* volatile block = std::malloc(10);
  std::free(block);
  in_tick = false;
  EXPECT_EQ(allocations, 2);
}

}  // namespace
}  // namespace vernier::no_allocation_test
