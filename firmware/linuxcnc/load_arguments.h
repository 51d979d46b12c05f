// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <span>

#include "firmware/core/cycle/wiring.h"

namespace vernier {

/// The arguments of `loadrt vernier`, as rtapi_app fills them in; null: the argument is not given.
struct LoadArguments {
  std::span<char*const> axes, inputs, rotary;
  const char* units = nullptr;
};

/// Settings of the component.
struct LoadedWiring {
  Wiring wiring;
  double mm_per_unit = 1;
};

/// Checks every argument before any object is made. Returns true, or false with `why`: one line that names
/// the argument and its error. Not real-time safe.
bool read_load_arguments(const LoadArguments& arguments, LoadedWiring& loaded, std::span<char> why);

}  // namespace vernier
