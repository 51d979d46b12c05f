// SPDX-License-Identifier: GPL-3.0-or-later
// Runs N ticks of an image over seeded poses and prints a hash of all corrections: the host's half of the
// comparison with other targets (tests/bench/targets).
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <vector>

#include "tables/checksum.h"
#include "tests/bench/poses.h"

namespace {

std::unique_ptr<std::uint64_t[]> read_words(const char* path, std::uint32_t& size) {
  std::FILE* const file = std::fopen(path, "rb");
  if (file == nullptr) return nullptr;
  auto words = std::make_unique<std::uint64_t[]>(vernier::kMaxImageBytes / 8);
  size = static_cast<std::uint32_t>(std::fread(words.get(), 1, vernier::kMaxImageBytes, file));
  std::fclose(file);
  return words;
}

}  // namespace

// A name of its own, so that callgrind can collect inside it alone.
extern "C" __attribute__((noinline)) std::uint64_t bench_ticks(vernier::Compensator& compensator,
                                                               vernier::bench::Poses& poses, int ticks);
std::uint64_t bench_ticks(vernier::Compensator& compensator, vernier::bench::Poses& poses, int ticks) {
  std::uint64_t hash = vernier::kFnvSeed;
  for (int i = 0; i < ticks; ++i) hash = vernier::bench::mixed(hash, compensator.step(poses.next()));
  return hash;
}

namespace {
std::uint64_t interpreted_ticks(vernier::Compensator& compensator, vernier::bench::Poses& poses, int ticks) {
  std::uint64_t hash = vernier::kFnvSeed;
  for (int i = 0; i < ticks; ++i) hash = vernier::bench::mixed(hash, compensator.step(poses.next()));
  return hash;
}
}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return std::fprintf(stderr, "usage: tick_bench IMAGE TICKS\n"), 1;
  std::uint32_t size = 0;
  const auto words = read_words(argv[1], size);
  static vernier::ImageWorkspace workspace;
  vernier::ImageView view;
  if (!words || view.open(reinterpret_cast<const std::uint8_t*>(words.get()), size, workspace) !=
                    vernier::ImageFault::kNone)
    return std::fprintf(stderr, "%s: no valid image\n", argv[1]), 1;
  const int ticks = std::atoi(argv[2]);
  vernier::Compensator interpreted(view.program()), compensator(view.program());
  vernier::bench::Poses again(view);
  const std::uint64_t wanted = interpreted_ticks(interpreted, again, ticks);
  std::vector<vernier::DenseCell> cells(vernier::dense_size(view.program().equation));
  vernier::DenseFrame frame;
  compensator.use_dense({cells.data(), static_cast<std::uint32_t>(cells.size()), &frame});
  vernier::bench::Poses poses(view);
  const std::uint64_t hash = bench_ticks(compensator, poses, ticks);
  if (hash != wanted) return std::fprintf(stderr, "the dense and the interpreted form differ\n"), 1;
  std::printf("ticks %d operations %u hash %08x%08x\n", ticks, view.program().equation.instructions.size,
              static_cast<unsigned>(hash >> 32), static_cast<unsigned>(hash));
  return 0;
}
