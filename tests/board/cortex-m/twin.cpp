// SPDX-License-Identifier: GPL-3.0-or-later
// twin IMAGE TAKEN BEGUN: the ticks of the emulated board once more on this host, from the image's file:
// TAKEN ticks without a program, then with it, and from tick BEGUN on the hash of what the drives hold, which
// must be the board's.
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <vector>

#include "firmware/core/cycle/runner.h"
#include "tests/board/cortex-m/machine.h"

namespace {

using namespace vernier;

std::vector<std::uint64_t> words_of(const char* path, std::uint32_t& size) {
  std::vector<std::uint64_t> words(kMaxImageBytes / 8);
  std::FILE* const file = std::fopen(path, "rb");
  if (file == nullptr) return {};
  size = static_cast<std::uint32_t>(std::fread(words.data(), 1, kMaxImageBytes, file));
  std::fclose(file);
  return words;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) return std::fprintf(stderr, "usage: twin IMAGE TAKEN BEGUN\n"), 1;
  std::uint32_t size = 0;
  const std::vector<std::uint64_t> words = words_of(argv[1], size);
  const auto workspace = std::make_unique<ImageWorkspace>();
  const auto view = std::make_unique<ImageView>();
  const ImageFault fault =
      words.empty() ? ImageFault::kTruncated
                    : view->open(reinterpret_cast<const std::uint8_t*>(words.data()), size, *workspace);
  if (fault != ImageFault::kNone) return std::fprintf(stderr, "%s: %s\n", argv[1], describe(fault)), 1;
  const long taken = std::atol(argv[2]), begun = std::atol(argv[3]);
  const auto bound = std::make_unique<BoundProgram>(*view);
  TickClock clock;
  Machine machine;
  const auto cycle =
      std::make_unique<Cycle>(wiring_of(*view), TimeUs(1000), Board{clock, machine, machine, machine});
  const auto runner = std::make_unique<Runner>(*cycle, clock, TimeUs(1000));
  std::uint64_t hash = kFnvSeed;
  bool activated = false;
  for (long tick = 0; tick < begun + long{kTicks}; ++tick) {
    if (tick == taken) cycle->use(*bound);
    const bool now = !activated && cycle->mode() == Mode::kReady;
    activated = activated || now;
    runner->step(now ? Command::kActivate : Command::kNone);
    if (tick >= begun) hash = machine.mixed(hash);
  }
  std::printf("%08x%08x\n", static_cast<unsigned>(hash >> 32), static_cast<unsigned>(hash));
  return 0;
}
