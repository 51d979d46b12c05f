// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cmath>
#include <cstdlib>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "tools/compile/compile.h"
#include "tools/compile/symbolic/ranges.h"
#include "tools/model/chain/chain.h"
#include "tools/model/machine_reader.h"
#include "tools/text/files.h"

namespace vernier {

using namespace vernier::compile;
using namespace vernier::model;
using namespace vernier::text;

/// Number of random poses: VERNIER_POSES in the environment, else 1e5 (1e6 by the bench command of
/// tests/bench).
inline std::size_t pose_count() {
  const char* const wanted = std::getenv("VERNIER_POSES");
  return wanted != nullptr ? static_cast<std::size_t>(std::atoll(wanted)) : 100000;
}

inline std::string machine_path(const std::string& name) {
  return std::string(VERNIER_SOURCE_DIR) + "/tests/unit/compile/machines/" + name + ".xml";
}

/// The machine with every error that it can have: seeded values of all statics with a nominal and of all
/// tables; what the file leaves open for `compile` (nominal values, ranges of axes) is filled in.
inline Machine disturbed(Machine machine, unsigned seed) {
  std::mt19937_64 random(seed);
  const auto within = [&](double size) {
    return std::uniform_real_distribution<double>(-size, size)(random);
  };
  for (Static& s : machine.statics) {
    if (!s.hidden && !s.nominal) s.nominal = s.value;
    if (!s.nominal) continue;
    s.value += within(s.unit == "mm" ? 0.1 : s.unit == "deg" ? 0.01 : s.unit == "rad" ? 1e-4 : 1e-3);
  }
  for (Axis& axis : machine.axes) {
    if (!axis.min) axis.min = axis.rotary ? -180 : 0;
    if (!axis.max) axis.max = axis.rotary ? 180 : 1500;
  }
  for (Table& table : machine.tables)
    for (Station& station : table.stations)
      for (std::size_t c = 0; c < 6; ++c) station.value[c] += within(c < 3 ? 0.02 : 0.002);
  for (Table& table : machine.tables)
    if (table.periodic) table.stations.back().value = table.stations.front().value;
  return machine;
}

/// A machine of machines/, compiled and opened, with the random poses that its image and its double chain
/// both see.
struct TestMachine {
  Machine machine;
  CompiledMachine compiled;
  std::unique_ptr<LoadedImage> loaded;

  explicit TestMachine(const std::string& name)
      : TestMachine(read_machine(machine_path(name)), read_file(machine_path(name))) {}
  explicit TestMachine(Machine m, const std::string& text = {}, const CompileOptions& options = {})
      : machine(std::move(m)), compiled(compile_machine(machine, text, options)) {
    loaded = load_image(compiled.image, machine);
  }
  struct Uncompiled {};
  TestMachine(Machine m, Uncompiled) : machine(std::move(m)) {}

  /// The poses of another machine with these axes (not its image).
  static TestMachine poses_of(const Machine& m) { return TestMachine(m, Uncompiled()); }

  double axis_unit(std::size_t i) const { return machine.axes[i].rotary ? 360 / 4294967296.0 : 1e-6; }

  /// Consecutive ticks: positions, speeds and inputs uniform over their ranges, time in steps of 1 ms.
  std::vector<CycleInput> random_poses(std::size_t count, std::mt19937_64& random) const {
    const auto uniform = [&](double low, double high) {
      return std::uniform_real_distribution<double>(low, high)(random);
    };
    const auto counts = [&](double low, double high, double unit) {
      return std::llround(uniform(low, high) / unit);
    };
    std::vector<CycleInput> poses(count);
    const auto start_us = static_cast<std::int64_t>(uniform(0, 9e5) * 1e6);
    for (std::size_t n = 0; n < count; ++n) {
      CycleInput& p = poses[n];
      for (std::size_t i = 0; i < machine.axes.size(); ++i) {
        const Axis& axis = machine.axes[i];
        p.axis[i].position = AxisPosition(counts(*axis.min, *axis.max, axis_unit(i)));
        p.axis[i].velocity = AxisSpeed(counts(-900, 900, axis_unit(i)));
        p.axis[i].acceleration = AxisAcceleration(counts(-9000, 9000, axis_unit(i)));
        p.axis[i].since = AxisTravel(counts(0, *axis.max - *axis.min, axis_unit(i)));
        p.axis[i].sense = static_cast<std::int8_t>(static_cast<int>(uniform(0, 3)) - 1);
      }
      for (std::size_t i = 0; i < machine.inputs.size(); ++i) {
        const Interval range = input_range(machine, i);
        p.input[i] = InputMicro(counts(range.low, range.high, 1e-6));
        // A hidden axis is mostly a number that selects a tool.
        if (machine.inputs[i].hidden_axis) p.input[i] = InputMicro((p.input[i].count / 1000000) * 1000000);
      }
      p.feed = FeedNmPerMin(counts(0, 20000, 1e-6));
      p.curvature = CurvatureNanoPerMm(counts(0, 0.2, 1e-9));
      p.time = TimeUs(start_us + static_cast<std::int64_t>(n) * 1000);
      p.visit = VisitCount(static_cast<std::int64_t>(n));
    }
    return poses;
  }

  States states_of(const std::vector<CycleInput>& poses) const {
    States s = make_states(poses.size(), machine);
    for (std::size_t n = 0; n < poses.size(); ++n) {
      const auto at = static_cast<Eigen::Index>(n);
      for (std::size_t i = 0; i < machine.axes.size(); ++i) {
        s.axis[i][at] = static_cast<double>(poses[n].axis[i].position.count) * axis_unit(i);
        s.velocity[i][at] = static_cast<double>(poses[n].axis[i].velocity.count) * axis_unit(i);
        s.acceleration[i][at] = static_cast<double>(poses[n].axis[i].acceleration.count) * axis_unit(i);
        s.since[i][at] = static_cast<double>(poses[n].axis[i].since.count) * axis_unit(i);
        s.direction[i][at] = poses[n].axis[i].sense;
      }
      for (std::size_t i = 0; i < machine.inputs.size(); ++i)
        s.input[i][at] = static_cast<double>(poses[n].input[i].count) * 1e-6;
      s.feed[at] = static_cast<double>(poses[n].feed.count) * 1e-6;
      s.curvature[at] = static_cast<double>(poses[n].curvature.count) * 1e-9;
      s.time[at] = static_cast<double>(poses[n].time.count) * 1e-6;
      s.visit[at] = static_cast<double>(poses[n].visit.count);
    }
    return s;
  }

  /// Deviation of output k after a step, mm or deg, before limits, as the output stage rounds it.
  double deviation_units(const Compensator& compensator, std::size_t k) const {
    const Output& out = loaded->view.program().outputs[static_cast<std::uint32_t>(k)];
    return static_cast<double>(round_shift(
               std::int64_t{compensator.register_value(out.source)} * out.multiplier, out.shift)) *
           axis_unit(out.axis);
  }
};

}  // namespace vernier
