// SPDX-License-Identifier: GPL-3.0-or-later
// Declared ranges hold at run time: beyond them the edge is held and the tick is flagged.
#include <gtest/gtest.h>

#include "tests/unit/compile/agreement.h"
#include "tests/unit/effects/candidates.h"
#include "tools/model/machine_reader.h"

namespace vernier::range_test {

using namespace vernier::model;
namespace {

class DeclaredRange : public testing::TestWithParam<std::string> {
 protected:
  DeclaredRange() : test_(disturbed(read_machine(diagnose_test::machine_path(GetParam())), 41)) {}

  /// Middle of every range, axis `moved` at a position.
  CycleInput pose(std::size_t moved, std::int64_t position) const {
    CycleInput input;
    for (std::size_t i = 0; i < test_.machine.axes.size(); ++i) {
      const Axis& axis = test_.machine.axes[i];
      input.axis[i].position =
          AxisPosition(std::llround((0.6 * *axis.min + 0.4 * *axis.max) / test_.axis_unit(i)));
      input.axis[i].since = AxisTravel(0);
    }
    for (std::size_t i = 0; i < test_.machine.inputs.size(); ++i)
      input.input[i] = InputMicro(std::llround(test_.machine.inputs[i].reference * 1e6));
    input.axis[moved].position = AxisPosition(position);
    return input;
  }
  CycleOutput run(const CycleInput& input) const {
    Compensator compensator(test_.loaded->view.program());
    CycleOutput output;
    for (int i = 0; i < 2000; ++i) output = compensator.step(input);  // past the slew limit
    return output;
  }
  const Channel* channel_of(std::size_t axis) const {
    for (const Channel& c : test_.loaded->view.program().channels)
      if (c.kind == ChannelKind::kPosition && c.index == axis) return &c;
    return nullptr;
  }

  TestMachine test_;
};

TEST_P(DeclaredRange, HoldsTheEdgeAndFlagsBeyondIt) {
  std::size_t limited = 0;
  for (std::size_t axis = 0; axis < test_.machine.axes.size(); ++axis) {
    const Channel* const channel = channel_of(axis);
    if (channel == nullptr || channel->wrap != 0) continue;  // not read, or turns without end
    ++limited;
    for (const auto& [edge, outwards] : {std::pair{channel->low, -1}, {channel->high, 1}}) {
      SCOPED_TRACE(test_.machine.axes[axis].name);
      const CycleOutput at = run(pose(axis, edge)), inside = run(pose(axis, edge - outwards));
      EXPECT_EQ(at.flags & kBeyondRange, 0u);
      EXPECT_EQ(inside.flags & kBeyondRange, 0u);
      for (const std::int64_t beyond : {std::int64_t{1}, std::int64_t{1000000000}}) {
        const CycleOutput out = run(pose(axis, edge + outwards * beyond));
        EXPECT_NE(out.flags & kBeyondRange, 0u);
        EXPECT_EQ(out.beyond_channels, 1u);
        for (std::size_t i = 0; i < kMaxAxes; ++i)
          EXPECT_EQ(out.correction[i].counts, at.correction[i].counts);
      }
    }
  }
  EXPECT_GT(limited, 0u);
}

INSTANTIATE_TEST_SUITE_P(Machines, DeclaredRange, testing::ValuesIn(diagnose_test::reference_machines()),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace vernier::range_test
