// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <pybind11/pybind11.h>

#include <nlohmann/json.hpp>

namespace vernier::python {

/// Converts JSON to Python: null to None, lists, numbers, text. An object becomes a dict whose keys are also
/// attributes (class `Record` of the module).
pybind11::object python_of(const nlohmann::ordered_json& json, const pybind11::object& record_class);

/// Creates the class `Record` of the Python module.
pybind11::object make_record_class();

}  // namespace vernier::python
