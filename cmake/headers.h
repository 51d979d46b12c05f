// SPDX-License-Identifier: GPL-3.0-or-later
// What is precompiled: no header of the house, so that none is missing in a source unseen.
#pragma once
#include <fmt/format.h>
#if __has_include(<gtest/gtest.h>)
#include <gtest/gtest.h>
#endif

// Who reads a source by its flags, without this precompiled, may have no path to Eigen.
#if __has_include(<Eigen/Core>)
#include <Eigen/Core>
#include <Eigen/Geometry>
#endif

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <vector>
