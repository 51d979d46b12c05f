// SPDX-License-Identifier: GPL-3.0-or-later
#include "tables/serial_frame.h"

#include <algorithm>
#include <memory>

#include "tests/fuzz/target.h"

namespace vernier::fuzz {
namespace {

/// The bytes as a line brings them; then framed, as a message that must come out again whatever came before.
void take(Bytes bytes) {
  const auto reader = std::make_unique<FrameReader>();
  for (const std::uint8_t byte : bytes)
    if (reader->take(byte)) expect(reader->size() <= kMaxReplyBytes, "a message longer than any");
  if (bytes.empty() || bytes.size() > kMaxReplyBytes) return;
  std::uint8_t frame[kMaxFrameBytes];
  const std::uint32_t size = write_frame(bytes.data(), static_cast<std::uint32_t>(bytes.size()), frame);
  expect(size <= kMaxFrameBytes, "a frame longer than any");
  bool whole = false;
  for (std::uint32_t i = 0; i < size; ++i) whole = reader->take(frame[i]);
  expect(whole && reader->size() == bytes.size() && std::equal(bytes.begin(), bytes.end(), reader->message()),
         "what was framed does not come out");
}

const Registered kTarget("serial_frame", take);

}  // namespace
}  // namespace vernier::fuzz
