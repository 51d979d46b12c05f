// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/python/module.h"

#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <limits>
#include <optional>

#include "tools/diagnose/diagnosis.h"
#include "tools/effects/roles.h"
#include "tools/fit/coverage/domain.h"
#include "tools/fit/files/file_noise.h"
#include "tools/fit/fit.h"
#include "tools/fit/least_squares/statistics.h"
#include "tools/format/columns.h"
#include "tools/format/csv_file.h"
#include "tools/model/machine_reader.h"
#include "tools/model/machine_writer.h"
#include "tools/plan/advice.h"
#include "tools/python/records.h"
#include "tools/residual/structure.h"
#include "tools/results/diagnosis_json.h"
#include "tools/results/residual_csv.h"
#include "tools/results/results.h"
#include "tools/results/structure_json.h"
#include "tools/text/error.h"
#include "tools/text/files.h"
#include "tools/text/numbers.h"

namespace vernier::python {

std::shared_ptr<const MachineOfPython> machine_of_text(const std::string& path, std::string text) {
  auto made = std::make_shared<MachineOfPython>();
  made->path = path;
  made->machine = model::parse_machine(text, path);
  made->text = std::move(text);
  return made;
}

ResultOfPython fit_of_python(const MachineOfPython& machine, const MeasurementsOfPython& measurements) {
  ResultOfPython result;
  const auto m =
      std::make_shared<model::Measurement>(model::read_measurement(measurements.paths, machine.machine));
  fit::estimate_file_noise(machine.machine, *m);
  const fit::FitResult found = fit::fit(machine.machine, *m, {});
  if (!found.absurd.empty()) throw text::LimitNotMet(found.absurd);
  result.json = results::fit_json(found, *m);
  result.residual = found.residual;
  result.machine = machine_of_text(
      machine.path,
      fit::close_domains(model::update_machine_text(machine.text, found.machine, true), found.machine, *m));
  result.measurement = m;
  return result;
}

ResultOfPython compare_of_python(const MachineOfPython& machine, const MeasurementsOfPython& measurements) {
  ResultOfPython result;
  const auto m =
      std::make_shared<model::Measurement>(model::read_measurement(measurements.paths, machine.machine));
  result.residual = fit::residuals(machine.machine, *m);
  fit::file_noise_of_residual(*m, result.residual);
  result.json = results::compare_json(machine.machine, *m, result.residual);
  results::add_failure(result.json, residual::failure_picture(machine.machine, *m, result.residual));
  result.machine = std::make_shared<MachineOfPython>(machine);
  result.measurement = m;
  return result;
}

ResultOfPython diagnose_of_python(const MachineOfPython& machine, const MeasurementsOfPython& measurements,
                                  std::size_t most) {
  ResultOfPython result;
  model::Measurement m = model::read_measurement(measurements.paths, machine.machine);
  const std::vector<fit::FileNoise> noise = fit::estimate_file_noise(machine.machine, m);
  const std::vector<std::string> column_sentences = effects::complete_columns(machine.machine, m);
  diagnose::DiagnoseOptions options;
  options.effects = effects::effect_catalogue({});
  options.most_effects = most;
  diagnose::Diagnosis found = diagnose::diagnose(machine.text, machine.machine, m, options);
  for (const std::string& sentence : column_sentences) found.explanation += " " + sentence;
  for (const fit::FileNoise& one : noise) found.explanation += " " + one.sentence() + ".";
  found.next_measurement = plan::advice_for(machine.text, machine.machine, m, found, options.effects);
  result.json = results::diagnosis_json(found, m);
  // As --residuals of the command: what the machine at the end of the ladder leaves, read with its inputs.
  result.machine = machine_of_text(machine.path, found.machine_text);
  const auto again = std::make_shared<model::Measurement>(
      model::read_measurement(measurements.paths, result.machine->machine));
  result.residual = fit::residuals(result.machine->machine, *again);
  result.measurement = again;
  return result;
}

}  // namespace vernier::python

namespace {

namespace py = pybind11;
using vernier::python::MachineOfPython;
using vernier::python::MeasurementsOfPython;
using vernier::python::ResultOfPython;

std::string path_text(const py::handle& path) {
  return py::str(py::module_::import("os").attr("fspath")(path)).cast<std::string>();
}

MeasurementsOfPython measurements_of(const py::args& paths) {
  MeasurementsOfPython made;
  for (const py::handle& one : paths) {
    if (py::isinstance<py::list>(one) || py::isinstance<py::tuple>(one))
      for (const py::handle& path : one) made.paths.push_back(path_text(path));
    else
      made.paths.push_back(path_text(one));
  }
  if (made.paths.empty()) throw vernier::text::InputError("Measurements: no file");
  // Now, not at the first fit: is it there, and is it a table?
  for (const std::string& path : made.paths) vernier::format::parse_csv(vernier::text::read_file(path), path);
  return made;
}

/// The columns of --residuals, as numbers where they are numbers: what pandas.DataFrame takes.
py::dict table_of(const ResultOfPython& result) {
  const vernier::format::CsvFile csv = vernier::format::parse_csv(
      vernier::results::residual_csv(*result.measurement, result.residual), "residuals");
  py::dict table;
  for (std::size_t k = 0; k < csv.columns.size(); ++k) {
    const std::string& name = csv.columns[k].name;
    const vernier::format::ColumnGroup* const known = vernier::format::find_column(name);
    const bool words =
        name == "observation" || name == "unit" || name == "file" || (known != nullptr && known->words);
    py::list cells;
    for (const auto& row : csv.rows) {
      const auto number = words ? std::nullopt : vernier::text::parse_number(row[k]);
      if (words)
        cells.append(py::str(row[k]));
      else
        cells.append(number ? *number : std::numeric_limits<double>::quiet_NaN());
    }
    table[py::str(name)] = words ? py::object(cells) : py::object(py::array_t<double>(cells));
  }
  return table;
}

template <class Call>
ResultOfPython free_of_the_lock(const Call& call) {
  const py::gil_scoped_release release;
  return call();
}

}  // namespace

PYBIND11_MODULE(vernier, module) {
  module.doc() = "Error models of machines: fit, compare and diagnose as the program `vernier` does.";
  module.attr("__version__") = VERNIER_VERSION;
  // Kept for as long as the interpreter lives, and so never given back after its end.
  static const py::handle record = vernier::python::make_record_class().release();
  module.attr("Record") = record;
  py::register_exception<vernier::text::InputError>(module, "InputError", PyExc_ValueError);
  py::register_exception<vernier::text::LimitNotMet>(module, "Refused", PyExc_RuntimeError);

  py::class_<MachineOfPython, std::shared_ptr<MachineOfPython>>(module, "Machine", "A machine file.")
      .def(py::init([](const py::object& path) {
             const std::string name = path_text(path);
             return *vernier::python::machine_of_text(name, vernier::text::read_file(name));
           }),
           py::arg("path"))
      .def_readonly("path", &MachineOfPython::path)
      .def_readonly("text", &MachineOfPython::text,
                    "Text of the machine file, as it was read or as save() would write it.")
      .def_property_readonly("name", [](const MachineOfPython& self) { return self.machine.name; })
      .def_property_readonly("axes",
                             [](const MachineOfPython& self) {
                               std::vector<std::string> names;
                               for (const auto& axis : self.machine.axes) names.push_back(axis.name);
                               return names;
                             })
      .def(
          "save",
          [](const MachineOfPython& self, const py::object& path) {
            vernier::text::write_file(path_text(path), self.text);
          },
          py::arg("path"), "Writes the machine file.")
      .def("__repr__", [](const MachineOfPython& self) {
        return "<vernier.Machine \"" + self.machine.name + "\" from " + self.path + ">";
      });

  py::class_<MeasurementsOfPython>(module, "Measurements", "One or several measurement files.")
      .def(py::init([](const py::args& paths) { return measurements_of(paths); }))
      .def_readonly("paths", &MeasurementsOfPython::paths);

  py::class_<ResultOfPython>(module, "Result",
                             "Result of a call: the keys of the command's JSON are attributes.")
      .def_property_readonly("json",
                             [](const ResultOfPython& self) {
                               return vernier::python::python_of(self.json,
                                                                 py::reinterpret_borrow<py::object>(record));
                             })
      .def_property_readonly(
          "residuals", [](const ResultOfPython& self) { return self.residual; },
          "Value minus prediction of each reading, in the order of the files; mm or deg.")
      .def_property_readonly(
          "table", table_of,
          "Every reading with row, value, prediction, residual, u …; for pandas.DataFrame.")
      .def_property_readonly(
          "model", [](const ResultOfPython& self) { return *self.machine; },
          "The fitted machine, or the machine with the effects of the stepwise model.")
      .def("__getattr__",
           [](const ResultOfPython& self, const std::string& name) {
             if (!self.json.contains(name)) throw py::attribute_error(name);
             return vernier::python::python_of(self.json[name], py::reinterpret_borrow<py::object>(record));
           })
      .def("__dir__", [](const ResultOfPython& self) {
        std::vector<std::string> names = {"json", "model", "residuals", "table"};
        for (const auto& [key, value] : self.json.items()) names.push_back(key);
        return names;
      });

  module.def(
      "fit",
      [](const MachineOfPython& machine, const MeasurementsOfPython& meas) {
        return free_of_the_lock([&] { return vernier::python::fit_of_python(machine, meas); });
      },
      py::arg("machine"), py::arg("meas"), "Estimates the free parameters; .model is the fitted machine.");
  module.def(
      "compare",
      [](const MachineOfPython& machine, const MeasurementsOfPython& meas) {
        return free_of_the_lock([&] { return vernier::python::compare_of_python(machine, meas); });
      },
      py::arg("machine"), py::arg("meas"),
      "Compares the model with measurements: size of the residual, and where the model fails.");
  module.def(
      "diagnose",
      [](const MachineOfPython& machine, const MeasurementsOfPython& meas, std::size_t most) {
        return free_of_the_lock([&] { return vernier::python::diagnose_of_python(machine, meas, most); });
      },
      py::arg("machine"), py::arg("meas"),
      py::arg("most") = vernier::diagnose::DiagnoseOptions{}.most_effects,
      "Finds the physical effect that is missing; .model has the effects of the stepwise model.");
}
