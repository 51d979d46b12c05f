// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/workbench/files/file_desk.h"

#include <cmath>
#include <optional>

#include "tools/format/csv_file.h"
#include "tools/format/urdf_chain.h"
#include "tools/import/logs/printer_file.h"
#include "tools/lint/lint.h"
#include "tools/model/machine.h"
#include "tools/model/machine_reader.h"
#include "tools/results/safety_json.h"
#include "tools/safety/safety_sheet.h"
#include "tools/text/error.h"
#include "tools/text/files.h"
#include "tools/workbench/files/excluded.h"
#include "tools/workbench/files/sheets.h"
#include "tools/workbench/files/terms.h"

namespace vernier::workbench {
namespace {

using Json = nlohmann::ordered_json;

}  // namespace

struct FileDesk::Route {
  const char *method, *path;
  ApiReply (FileDesk::*answer)(const ApiRequest&);
};

const FileDesk::Route* FileDesk::find(const ApiRequest& request) {
  static constexpr Route kRoutes[] = {
      {"PUT", "/api/file", &FileDesk::check},       {"GET", "/api/excluded", &FileDesk::excluded},
      {"GET", "/api/rows", &FileDesk::rows},        {"GET", "/api/parameters", &FileDesk::parameters},
      {"POST", "/api/predict", &FileDesk::predict}, {"POST", "/api/explain", &FileDesk::explain},
      {"GET", "/api/names", &FileDesk::names},      {"POST", "/api/term", &FileDesk::term},
      {"GET", "/api/kind", &FileDesk::kind},        {"POST", "/api/sheet", &FileDesk::sheet},
      {"GET", "/api/robot", &FileDesk::robot},      {"GET", "/api/safety", &FileDesk::safety},
      {"GET", "/api/lint", &FileDesk::lint}};
  for (const Route& route : kRoutes)
    if (request.method == route.method && request.path == route.path) return &route;
  return nullptr;
}

bool FileDesk::answers(const ApiRequest& request) { return find(request) != nullptr; }

ApiReply FileDesk::reply(const ApiRequest& request) {
  return reply_of(project_, [&] { return answer(request); });
}

ApiReply FileDesk::answer(const ApiRequest& request) {
  const Route* const route = find(request);
  if (route == nullptr) return json_reply({{"message", "nothing here"}}, 404);
  return (this->*route->answer)(request);
}

/// Machines and measurements are read before they are stored: an error is shown where the file was dropped.
ApiReply FileDesk::check(const ApiRequest& request) {
  const std::string name = request.word("name");
  if (name.ends_with(".xml")) model::parse_machine(request.body, name);
  // What does not even begin as a measurement file may be a spreadsheet: kept, and imported from there.
  if (name.ends_with(".csv") && begins_as_measurement(request.body)) format::parse_csv(request.body, name);
  return json_reply({{"name", name}});
}

/// {"kind"}: "measurement", "printer" for the bed of a 3D printer, or "sheet" where a table has to be
/// imported.
ApiReply FileDesk::kind(const ApiRequest& request) {
  const std::string text = text::read_file(project_.existing(request.word("name")).string());
  const char* kind = "sheet";
  if (begins_as_measurement(text))
    kind = "measurement";
  else if (importer::is_printer_file(text))
    kind = "printer";
  return json_reply({{"kind", kind}});
}

/// {"ends"}: the links of the description of a robot (URDF) that can be the end of its arm.
ApiReply FileDesk::robot(const ApiRequest& request) {
  const std::string name = request.word("name");
  return json_reply(
      {{"ends", format::UrdfTree(text::read_file(project_.existing(name).string()), name).ends()}});
}

ApiReply FileDesk::sheet(const ApiRequest& request) {
  const auto json = body_json(request);
  const std::string name = text_at(json, "name");
  importer::SheetWords words = sheet_words(json);
  std::optional<model::Machine> machine;
  const auto reads = [&](const std::string& file) {
    return text::read_file(project_.existing(file).string());
  };
  if (json.contains("machine") && json["machine"].is_string() &&
      !json["machine"].get<std::string>().empty()) {
    const std::string file = text_at(json, "machine");
    machine = model::parse_machine(reads(file), file);
    for (const model::Axis& axis : machine->axes) words.axes.push_back(axis.name);
  }
  words.points = sheet_points(json, words, machine ? &*machine : nullptr, reads);
  return json_reply(sheet_preview(text::read_file(project_.existing(name).string()), name, words,
                                  machine ? &*machine : nullptr));
}

/// The sheet "safe to run?" of a machine file, before anything is compiled.
ApiReply FileDesk::safety(const ApiRequest& request) {
  const std::string name = request.word("machine");
  const safety::SafetySheet sheet =
      safety::safety_sheet(model::parse_machine(text::read_file(project_.existing(name).string()), name));
  return json_reply({{"ok", sheet.ok()},
                     {"refusal", sheet.refusal()},
                     {"stale", sheet.stale},
                     {"rules", results::safety_json(sheet)}});
}

/// {"findings"}: what `vernier lint` says of a machine and the measurements beside it.
ApiReply FileDesk::lint(const ApiRequest& request) {
  std::vector<std::string> names = request.words("measurement"), bytes;
  if (const std::string machine = request.word("machine"); !machine.empty())
    names.insert(names.begin(), machine);
  for (const std::string& name : names) bytes.push_back(text::read_file(project_.existing(name).string()));
  Json list = Json::array();
  for (const lint::LintedFile& file : lint::lint_contents(names, bytes))
    for (const lint::LintFinding& finding : file.findings) list.push_back(lint::finding_json(finding));
  return json_reply({{"findings", list}});
}

ApiReply FileDesk::excluded(const ApiRequest& request) {
  Json list = Json::array();
  for (const ExcludedRow& row :
       excluded_rows(text::read_file(project_.existing(request.word("name")).string())))
    list.push_back({{"line", row.line}, {"reason", row.reason}, {"row", row.row}});
  return json_reply({{"excluded", list}});
}

ApiReply FileDesk::rows(const ApiRequest& request) {
  return blob_reply(rows_blob(
      *cache_.get(request.word("machine"), request.words("measurement"), request.word("datum") == "1")));
}

ApiReply FileDesk::parameters(const ApiRequest& request) {
  return json_reply(parameters_json(
      *cache_.get(request.word("machine"), request.words("measurement"), request.word("datum") == "1")));
}

ApiReply FileDesk::predict(const ApiRequest& request) {
  const auto json = body_json(request);
  const auto rows =
      cache_.get(text_at(json, "machine"), texts_at(json, "measurements"), json.value("datum", false));
  std::map<std::string, double> values;
  if (!json.contains("values") || !json["values"].is_object())
    throw text::InputError("\"values\" is missing");
  for (const auto& [name, value] : json["values"].items()) {
    if (!value.is_number() || !std::isfinite(value.get<double>()))
      throw text::InputError("\"" + name + "\": no number");
    values[name] = value.get<double>();
  }
  return blob_reply(prediction_blob(*rows, values));
}

ApiReply FileDesk::explain(const ApiRequest& request) {
  const auto json = body_json(request);
  const auto rows = cache_.get(text_at(json, "machine"), texts_at(json, "measurements"), false);
  return blob_reply(explanation_blob(*rows, text_at(json, "add")));
}

ApiReply FileDesk::names(const ApiRequest& request) {
  const std::string name = request.word("machine");
  const model::Machine machine =
      model::parse_machine(text::read_file(project_.existing(name).string()), name);
  Json transforms = Json::array();
  for (const auto* branch : {&machine.tool, &machine.workpiece})
    for (const model::Transform& transform : *branch) {
      Json dofs = Json::array();
      for (std::size_t i = 0; i < transform.dof_count(); ++i)
        dofs.push_back({{"dof", transform.dof_name(i)}, {"text", transform.text[i]}});
      transforms.push_back(
          {{"branch", branch == &machine.tool ? "tool" : "workpiece"}, {"n", transform.n}, {"dofs", dofs}});
    }
  return json_reply({{"names", expression_names(machine)}, {"transforms", transforms}});
}

ApiReply FileDesk::term(const ApiRequest& request) {
  const auto json = body_json(request);
  const std::string name = text_at(json, "machine");
  model::Machine machine = model::parse_machine(text::read_file(project_.existing(name).string()), name);
  // Columns of the measurement that the machine does not know: `add` declares those that a term uses.
  if (json.contains("columns") && json["columns"].is_array()) {
    for (const auto& column : json["columns"]) {
      model::Input input;
      input.name = text_at(column, "name");
      input.unit = text_at(column, "unit");
      if (model::resolve_name(machine, input.name).kind == model::SymbolKind::kUnresolved)
        machine.inputs.push_back(input);
    }
  }
  return json_reply(check_term(machine, text_at(json, "term"), text_at(json, "unit")));
}

}  // namespace vernier::workbench
