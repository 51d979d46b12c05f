// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tools/exchange/configuration_file.h"
#include "tools/exchange/printer/correction.h"

namespace vernier::exchange {

/// Firmware of 3D printers and small machines.
enum class Firmware : std::uint8_t { kKlipper, kRepRap, kMarlin, kGrbl };

/// Information from the user about the present configuration.
struct PresentSetting {
  /// For X, Y, Z: steps per mm (M92, $100), or for Klipper mm per turn (rotation_distance).
  std::optional<std::array<double, 3>> steps;
  /// Klipper: name of the file and of the sections [skew_correction NAME] and [bed_mesh NAME]. Two exports
  /// for one printer need two names: the later of two sections with one name replaces the other.
  std::string profile = "vernier";
};

/// Characters of a name that Klipper accepts as that of a section and as the value of LOAD=.
inline constexpr std::string_view kOfProfileName =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-";

/// Returns the parts of a correction that a firmware supports.
PrinterFeatures features_of(Firmware firmware, const PresentSetting& present);

/// Returns the configuration files for a firmware. The values of `correction` are rounded in the same way as
/// in these files. The sources are listed in tools/docs/exchange.md: Klipper klippy/extras/skew_correction.py
/// and bed_mesh.py; RepRapFirmware M556, M92, M425 and the height map file; Marlin M852, M420, M421, M92,
/// M425; grbl $100 to $102. `machine_name`: name of the machine for comments in the files.
std::vector<ConfigurationFile> firmware_files(Firmware firmware, const PresentSetting& present,
                                              const std::string& machine_name, PrinterCorrection& correction);

}  // namespace vernier::exchange
