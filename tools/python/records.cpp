// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/python/records.h"

#include <pybind11/eval.h>

#include <cmath>

namespace vernier::python {

namespace py = pybind11;

py::object make_record_class() {
  py::dict scope;
  scope["__builtins__"] = py::module_::import("builtins");
  py::exec(R"py(
class Record(dict):
    """A dict whose keys are also attributes."""
    __module__ = "vernier"
    def __getattr__(self, name):
        try:
            return self[name]
        except KeyError:
            raise AttributeError(name) from None
    def __dir__(self):
        return list(self) + dict.__dir__(self)
)py",
           scope);
  return scope["Record"];
}

py::object python_of(const nlohmann::ordered_json& json, const py::object& record_class) {
  if (json.is_object()) {
    py::object record = record_class();
    for (const auto& [key, value] : json.items()) record[py::str(key)] = python_of(value, record_class);
    return record;
  }
  if (json.is_array()) {
    py::list list;
    for (const auto& value : json) list.append(python_of(value, record_class));
    return list;
  }
  if (json.is_boolean()) return py::bool_(json.get<bool>());
  if (json.is_number_integer()) return py::int_(json.get<long long>());
  // What is not finite is null in the JSON of the commands.
  if (json.is_number()) {
    const double value = json.get<double>();
    return std::isfinite(value) ? py::object(py::float_(value)) : py::object(py::none());
  }
  if (json.is_string()) return py::str(json.get<std::string>());
  return py::none();
}

}  // namespace vernier::python
