// SPDX-License-Identifier: Apache-2.0
#include "hal/linux/iio/iio_device.h"

#include <filesystem>
#include <fstream>

namespace vernier {
namespace {

std::string first_line(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  return line;
}

}  // namespace

std::string find_iio_device(const std::string& root, const std::string& device, std::string& error) {
  if (device.empty()) {
    error = "the name of an IIO device is empty";
    return {};
  }
  if (device.find('/') != std::string::npos) return device;
  std::error_code unreadable;
  std::string found;
  for (const auto& entry : std::filesystem::directory_iterator(root, unreadable)) {
    if (first_line(entry.path() / "name") != device && first_line(entry.path() / "label") != device) continue;
    if (!found.empty()) {
      error = root + ": several IIO devices have the name " + device +
              "; give the label or the path of the device";
      return {};
    }
    found = entry.path().string();
  }
  if (unreadable) error = root + ": " + unreadable.message();
  if (found.empty() && !unreadable) error = root + ": no IIO device " + device;
  return found;
}

}  // namespace vernier
