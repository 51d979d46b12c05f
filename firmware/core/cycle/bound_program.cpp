// SPDX-License-Identifier: Apache-2.0
#include "firmware/core/cycle/bound_program.h"

#include <algorithm>

#include "firmware/core/cycle/printed_model.h"

namespace vernier {

Wiring wiring_of(const ImageView& view) {
  Wiring wiring;
  for (const AxisRecord& axis : view.axes())
    wiring.axes.push_back({axis.name, (axis.flags & kRotary) != 0, (axis.flags & kRollover) != 0});
  for (const InputRecord& input : view.inputs()) wiring.inputs.push_back(input.name);
  return wiring;
}

BoundProgram::BoundProgram(const ImageView& view, const DenseMemory& dense) noexcept
    : program(view.program()),
      compensator(view.program()),
      shares(view.shares()),
      share_names(view.share_names()) {
  for (std::uint32_t i = 0; i < kMaxAxes; ++i) axis[i] = i;
  for (std::uint32_t i = 0; i < kMaxInputs; ++i) input[i] = i;
  for (std::uint32_t i = 0; i < view.inputs().size; ++i)
    reference[i] = InputMicro(view.inputs()[i].reference);
  for (const Channel& channel : program.channels)
    if (channel.kind == ChannelKind::kInput) reads_input[channel.index] = true;
  const PrintedModel printed = printed_model();
  if (printed.equation != nullptr && printed.fingerprint == view.header().fingerprint)
    compensator.use_printed(printed.equation);
  if (dense.cells != nullptr) compensator.use_dense(dense);
}

namespace {

// "1000 us".
Name in_us(std::uint32_t time) noexcept {
  Name text;
  std::uint32_t unit = 1;
  while (unit <= time / 10) unit *= 10;
  for (; unit > 0; unit /= 10) text.add(static_cast<char>('0' + time / unit % 10));
  for (const char letter : {' ', 'u', 's'}) text.add(letter);
  return text;
}

}  // namespace

BindFault bind(const ImageView& view, const Wiring& wiring, TimeUs tick, BoundProgram& bound,
               Name& offender) {
  offender = in_us(view.header().tick_us);
  if (view.header().tick_us != tick.count) return BindFault::kTick;
  const Wiring wanted = wiring_of(view);
  for (std::uint32_t i = 0; i < wanted.axes.size(); ++i) {
    const Wiring::Axis& axis = wanted.axes[i];
    offender = axis.name;
    const auto found = std::find_if(wiring.axes.begin(), wiring.axes.end(),
                                    [&](const Wiring::Axis& other) { return other.name == axis.name; });
    if (found == wiring.axes.end()) return BindFault::kUnknownAxis;
    const bool same_turns = found->rollover == axis.rollover || found->continuous;
    if (found->rotary != axis.rotary || !same_turns) return BindFault::kAxisKind;
    bound.axis[i] = static_cast<std::uint32_t>(found - wiring.axes.begin());
  }
  for (std::uint32_t i = 0; i < wanted.inputs.size(); ++i) {
    offender = wanted.inputs[i];
    const auto found = std::find(wiring.inputs.begin(), wiring.inputs.end(), wanted.inputs[i]);
    if (found == wiring.inputs.end()) return BindFault::kUnknownInput;
    bound.input[i] = static_cast<std::uint32_t>(found - wiring.inputs.begin());
  }
  offender = {};
  return BindFault::kNone;
}

}  // namespace vernier
