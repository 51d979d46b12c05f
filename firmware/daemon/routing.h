// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <vector>

#include "hal/axis_reader.h"
#include "hal/correction_writer.h"
#include "hal/input_reader.h"

namespace vernier {

/// Connection of a device of the board to a backend (driver object) and to its index there.
template <class Port>
struct Route {
  Port* port = nullptr;     // null: the device is not connected
  std::uint32_t index = 0;  // index of the device in the backend
};

/// Returns each backend of the routes once, so that begin_tick is called once for a backend with several
/// devices.
template <class Port>
std::vector<Port*> backends_of(const std::vector<Route<Port>>& routes) {
  std::vector<Port*> backends;
  for (const auto& route : routes)
    if (route.port != nullptr && std::find(backends.begin(), backends.end(), route.port) == backends.end())
      backends.push_back(route.port);
  return backends;
}

/// The axes of the board, which may belong to several backends. The backend of the first route gives the data
/// of the path (feed, curvature).
class RoutedAxes : public AxisReader {
 public:
  explicit RoutedAxes(std::vector<Route<AxisReader>> routes)
      : routes_(std::move(routes)), backends_(backends_of(routes_)) {}
  void begin_tick() noexcept override {
    for (AxisReader* const backend : backends_) backend->begin_tick();
  }
  HalFault read_axis(std::uint32_t axis, AxisReading& reading) noexcept override {
    if (axis >= routes_.size()) return HalFault::kNoDevice;
    return routes_[axis].port->read_axis(routes_[axis].index, reading);
  }
  HalFault read_path(PathReading& reading) noexcept override {
    return routes_.empty() ? HalFault::kNoDevice : routes_.front().port->read_path(reading);
  }
  bool gives_motion() const noexcept override {
    for (const auto& route : routes_)
      if (!route.port->gives_motion()) return false;
    return true;
  }

 private:
  std::vector<Route<AxisReader>> routes_;
  std::vector<AxisReader*> backends_;
};

/// The inputs of the board, which may belong to several backends.
class RoutedInputs : public InputReader {
 public:
  explicit RoutedInputs(std::vector<Route<InputReader>> routes)
      : routes_(std::move(routes)), backends_(backends_of(routes_)) {}
  void begin_tick() noexcept override {
    for (InputReader* const backend : backends_) backend->begin_tick();
  }
  HalFault read_input(std::uint32_t input, InputMicro& value) noexcept override {
    if (input >= routes_.size()) return HalFault::kNoDevice;
    return routes_[input].port->read_input(routes_[input].index, value);
  }

 private:
  std::vector<Route<InputReader>> routes_;
  std::vector<InputReader*> backends_;
};

/// The outputs of the board, which may belong to several backends. If an axis has no output, a correction for
/// this axis is refused unless it is zero. The reason is that an image that corrects an axis without an
/// output must not appear to work.
class RoutedOutputs : public CorrectionWriter {
 public:
  explicit RoutedOutputs(std::vector<Route<CorrectionWriter>> routes) : routes_(std::move(routes)) {}
  HalFault write_correction(std::uint32_t axis, AxisTravel correction) noexcept override {
    if (axis >= routes_.size()) return HalFault::kNoDevice;
    if (routes_[axis].port == nullptr)
      return correction == AxisTravel{} ? HalFault::kNone : HalFault::kNoDevice;
    return routes_[axis].port->write_correction(routes_[axis].index, correction);
  }
  AxisTravel within_range(std::uint32_t axis, AxisTravel correction) const noexcept override {
    if (axis >= routes_.size() || routes_[axis].port == nullptr) return AxisTravel{};
    return routes_[axis].port->within_range(routes_[axis].index, correction);
  }

 private:
  std::vector<Route<CorrectionWriter>> routes_;
};

}  // namespace vernier
