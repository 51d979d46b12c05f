// SPDX-License-Identifier: Apache-2.0
#include "hal/linux/iio/iio_input.h"

namespace vernier {

std::unique_ptr<IioInput> IioInput::open(const std::string& attribute, const IioScale& scale,
                                         std::uint32_t stale_reads, std::string& error) {
  auto opened = SysfsAttribute::open(attribute, SysfsAttribute::Use::kRead, error);
  if (!opened) return nullptr;
  return std::unique_ptr<IioInput>(new IioInput(std::move(*opened), scale, stale_reads));
}

HalFault IioInput::take(std::int64_t& value) noexcept {
  std::int64_t micro = 0;
  if (attribute_.read_micro(micro) != HalFault::kNone) return HalFault::kNoReading;
  return scaled(static_cast<double>(micro), scale_.offset, scale_.scale, value) ? HalFault::kNone
                                                                                : HalFault::kNoReading;
}

}  // namespace vernier
