// SPDX-License-Identifier: GPL-3.0-or-later
// usage: linuxcnc_ticks IMAGE JOINTS INPUT... <TICKS
// What the image itself corrects at the joint positions of each tick, beside what the component added in it.
// TICKS: a line a tick: joint positions, then corrections, mm or deg. Prints a line for each shift of the
// corrections by -3 .. 5 ticks: shift, ticks, rms and largest difference in nm (or the rotary axes' own
// counts times 1e6/2^32*360).
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <iterator>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "firmware/core/cycle/bound_program.h"

namespace {

using namespace vernier;

struct Loaded {
  std::vector<std::uint64_t> words;
  ImageWorkspace workspace;
  ImageView view;
};

std::unique_ptr<Loaded> load(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  auto loaded = std::make_unique<Loaded>();
  loaded->words.resize((bytes.size() + 7) / 8);
  auto* const image = reinterpret_cast<std::uint8_t*>(loaded->words.data());
  std::copy(bytes.begin(), bytes.end(), image);
  if (loaded->view.open(image, static_cast<std::uint32_t>(bytes.size()), loaded->workspace) !=
      ImageFault::kNone)
    return nullptr;
  return loaded;
}

double counts_of(const AxisRecord& axis) {
  return (axis.flags & kRotary) != 0 ? static_cast<double>(kTurnCounts) / 360 : 1e6;
}

struct Tick {
  std::vector<double> position, correction;
};

std::vector<Tick> read_ticks(std::size_t joints) {
  std::vector<Tick> ticks;
  for (std::string line; std::getline(std::cin, line);) {
    std::istringstream words(line);
    Tick tick{std::vector<double>(joints), std::vector<double>(joints)};
    for (double& value : tick.position) words >> value;
    for (double& value : tick.correction) words >> value;
    if (words) ticks.push_back(std::move(tick));
  }
  return ticks;
}

/// By tick and joint, 1e-6 mm or deg; speeds from one tick to the next, without a filter.
std::vector<std::vector<double>> image_corrections(const ImageView& view, const std::vector<Tick>& ticks,
                                                   const std::vector<double>& inputs) {
  Compensator compensator(view.program());
  std::vector<std::vector<double>> corrections;
  CycleInput input;
  for (std::size_t i = 0; i < inputs.size(); ++i) input.input[i] = InputMicro(std::llround(inputs[i] * 1e6));
  for (std::size_t k = 0; k < ticks.size(); ++k) {
    std::vector<double> row;
    for (std::uint32_t i = 0; i < view.axes().size; ++i) {
      const double counts = counts_of(view.axes()[i]);
      const double travel = k == 0 ? 0 : ticks[k].position[i] - ticks[k - 1].position[i];
      input.axis[i].position = AxisPosition(std::llround(ticks[k].position[i] * counts));
      input.axis[i].velocity = AxisSpeed(std::llround(travel * 1000 * counts));
      if (travel * counts > 1 || travel * counts < -1)
        input.axis[i].sense = static_cast<std::int8_t>(travel > 0 ? 1 : -1);
    }
    const CycleOutput output = compensator.step(input);
    for (std::uint32_t i = 0; i < view.axes().size; ++i)
      row.push_back(output.correction[i].counts / counts_of(view.axes()[i]) * 1e6);
    corrections.push_back(std::move(row));
  }
  return corrections;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return 1;
  const auto image = load(argv[1]);
  if (!image) return 1;
  const auto joints = static_cast<std::size_t>(std::atoi(argv[2]));
  std::vector<double> inputs;
  for (int i = 3; i < argc; ++i) inputs.push_back(std::atof(argv[i]));
  const std::vector<Tick> ticks = read_ticks(joints);
  const auto wanted = image_corrections(image->view, ticks, inputs);
  constexpr int kWarmUp = 2000;  // the program's own slew from zero
  for (int shift = -3; shift <= 5; ++shift) {
    double sum = 0, largest = 0;
    std::size_t count = 0;
    for (std::size_t k = kWarmUp; k + 5 < ticks.size(); ++k)
      for (std::size_t i = 0; i < wanted[k].size(); ++i, ++count) {
        const double difference =
            ticks[k + static_cast<std::size_t>(shift + 3) - 3].correction[i] * 1e6 - wanted[k][i];
        sum += difference * difference;
        largest = std::fmax(largest, std::fabs(difference));
      }
    std::printf("%d %zu %.4f %.4f\n", shift, ticks.size(),
                count > 0 ? std::sqrt(sum / static_cast<double>(count)) : -1, largest);
  }
  return 0;
}
