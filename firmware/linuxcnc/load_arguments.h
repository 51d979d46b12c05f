// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <span>

#include "firmware/core/cycle/wiring.h"

namespace vernier {

/// The arguments of `loadrt vernier`, as rtapi_app sets them. A null pointer means that the argument is not
/// given.
struct LoadArguments {
  std::span<char*const> axes, inputs, rotary;
  const char* units = nullptr;
};

/// Settings of the component, from its arguments.
struct LoadedWiring {
  Wiring wiring;
  double mm_per_unit = 1;
};

/// Checks all arguments before any object is constructed. Returns false if an argument is wrong.
/// After a wrong argument, `why` is one line with the name of the argument and its error. Not
/// real-time safe.
bool read_load_arguments(const LoadArguments& arguments, LoadedWiring& loaded, std::span<char> why);

}  // namespace vernier
