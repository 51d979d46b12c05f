// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>

#include "hal/linux/sampled_input.h"
#include "hal/linux/sysfs_attribute.h"

namespace vernier {

/// Scale of an IIO attribute: value = (value of the attribute + offset) * scale, in the unit of the input.
/// The kernel defines in_*_offset and in_*_scale in this way.
struct IioScale {
  double offset = 0;
  double scale = 1;
};

/// A sensor of the kernel's industrial I/O class (IIO), or of the class hwmon. The sensor is one attribute (a
/// file), for example in_temp0_input in 1/1000 degC, or in_voltage3_raw.
class IioInput : public SampledInput {
 public:
  /// `attribute`: path of the attribute. If the attribute cannot be opened, open() returns null and sets
  /// `error`. Not real-time safe.
  static std::unique_ptr<IioInput> open(const std::string& attribute, const IioScale& scale,
                                        std::uint32_t stale_reads, std::string& error);

 private:
  IioInput(SysfsAttribute attribute, const IioScale& scale, std::uint32_t stale_reads)
      : SampledInput(stale_reads), attribute_(std::move(attribute)), scale_(scale) {}
  HalFault take(std::int64_t& value) noexcept override;

  SysfsAttribute attribute_;
  IioScale scale_;
};

}  // namespace vernier
