// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <memory>

#include "tools/commands/command.h"
#include "tools/commands/judge/evaluate_kinds.h"
#include "tools/commands/judge/evaluate_robot_pages.h"
#include "tools/evaluate/judgement.h"
#include "tools/evaluate/limits.h"
#include "tools/evaluate/positioning.h"
#include "tools/evaluate/robot_path.h"
#include "tools/format/columns.h"
#include "tools/maths/factors.h"
#include "tools/model/chain/chain.h"
#include "tools/model/machine_reader.h"
#include "tools/model/measurement.h"
#include "tools/text/error.h"
#include "tools/text/optional_json.h"

namespace vernier::commands::evaluate_cli {
namespace {

using Json = nlohmann::ordered_json;

struct RobotArguments {
  std::vector<std::string> measurements, tolerances;
  std::string machine, json;
  std::size_t stations = 50;
  bool path = false, distance = false, drift = false, align = false;
};

/// The commanded pose of the robot, from the axes and the nominal chain.
std::vector<evaluate::PoseReading> readings_by_machine(const RobotArguments& arguments) {
  const model::Machine machine = model::read_machine(arguments.machine);
  const model::Measurement m = model::read_measurement(arguments.measurements, machine);
  const model::Poses nominal = model::forward(model::nominal_machine(machine), model::commanded_states(m));
  std::vector<evaluate::PoseReading> rows(m.rows());
  std::vector<int> seen(m.rows());
  for (std::size_t row = 0; row < m.rows(); ++row) {
    const auto at = static_cast<Eigen::Index>(row);
    rows[row].run = m.states.run_names[m.states.run[row]];
    rows[row].commanded_mm = nominal.position.col(at);
    const Eigen::AngleAxisd turned(nominal.rotation[row]);
    rows[row].commanded_deg = maths::kDegPerRad * turned.angle() * turned.axis();
    rows[row].u_mm = m.uncertainty[at];
    rows[row].time_s = m.states.time[at];
    rows[row].measured_mm.setZero();
    rows[row].measured_deg = Eigen::Vector3d::Zero();
  }
  for (const model::Observation& o : m.observations) {
    const auto kind = static_cast<Eigen::Index>(o.kind);
    if (kind > static_cast<Eigen::Index>(model::ObservationKind::kRz)) continue;
    (kind < 3 ? rows[o.row].measured_mm[kind] : (*rows[o.row].measured_deg)[kind - 3]) = o.value;
    seen[o.row] |= 1 << kind;
  }
  std::vector<evaluate::PoseReading> readings;
  constexpr int kPosition = 7, kRotation = 56;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    if ((seen[row] & kPosition) != kPosition) continue;
    if ((seen[row] & kRotation) != kRotation) rows[row].measured_deg = std::nullopt;
    readings.push_back(rows[row]);
  }
  if (readings.empty())
    throw text::InputError({m.files.front(), 0}, format::columns::kPoint.front(), "no row has x, y and z");
  return readings;
}

std::vector<evaluate::PoseReading> readings_of(const RobotArguments& arguments) {
  if (!arguments.machine.empty()) return readings_by_machine(arguments);
  std::vector<evaluate::PoseReading> readings;
  for (const std::string& path : arguments.measurements)
    for (evaluate::PoseReading& one : evaluate::read_pose_readings(text::read_file(path), path))
      readings.push_back(std::move(one));
  return readings;
}

/// Requirements of the standard that this test does not meet.
Json shortcomings(const std::vector<evaluate::PoseReading>& readings, const RobotPage& page) {
  Json notes = Json::array();
  double u = 0;
  for (const evaluate::PoseReading& reading : readings) u = std::max(u, reading.u_mm);
  if (page.fewest < page.wanted)
    notes.push_back(
        fmt::format("the measurement has {} cycles, ISO 9283 requires {}", page.fewest, page.wanted));
  if (u == 0) notes.push_back("no uncertainty of the instrument is given (u): U contains only the scatter");
  if (2 * u > page.least_spread_mm / 4)
    notes.push_back(
        fmt::format("U of the instrument is {:.3g} um, more than a quarter of the repeatability of {:.3g} "
                    "um: the result contains the errors of the instrument",
                    2 * u * maths::kUmPerMm, page.least_spread_mm * maths::kUmPerMm));
  return notes;
}

RobotPage page_of(const RobotArguments& arguments, const std::vector<evaluate::PoseReading>& readings) {
  if (arguments.path) return pose_page(evaluate::evaluate_path(readings, arguments.stations).stations, true);
  if (arguments.distance) return distance_page(evaluate::evaluate_distances(readings));
  if (arguments.drift) return drift_page(evaluate::evaluate_drift(readings));
  return pose_page(evaluate::evaluate_poses(readings), false);
}

evaluate::JudgedValue judged_of(const Json& one) {
  return {one["name"], one["value_um"].get<double>(), one["u95_um"].get<double>(),
          one["tolerance_um"].get<double>()};
}

void print_characteristic(std::FILE* out, const Json& one) {
  if (!one.contains("conformity")) {
    fmt::print(out, "{} {:.3f} um, U {:.2g} um\n", one["name"].get<std::string>(),
               one["value_um"].get<double>(), one["u95_um"].get<double>());
    return;
  }
  const evaluate::JudgedText text = evaluate::judged_text(judged_of(one), evaluate::kPrintedDigits);
  fmt::print(out, "{} {} um, U {} um; tolerance {} um: {}\n", one["name"].get<std::string>(), text.value,
             text.uncertainty, text.tolerance, one["conformity"].get<std::string>());
}

void run_robot(const RobotArguments& arguments) {
  std::vector<std::pair<std::string, double>> limits;
  const std::vector<std::string> names = arguments.path       ? std::vector<std::string>{"AT", "RT"}
                                         : arguments.distance ? std::vector<std::string>{"AD", "RD"}
                                         : arguments.drift    ? std::vector<std::string>{"dAP", "dRP"}
                                                              : std::vector<std::string>{"AP", "RP"};
  for (const std::string& words : arguments.tolerances)
    limits.push_back(evaluate::limit_of(words, "--tolerance", names));
  std::vector<evaluate::PoseReading> readings = readings_of(arguments);
  if (arguments.align) evaluate::align_to_commanded(readings);
  const RobotPage page = page_of(arguments, readings);
  Json json = {{"standard", "ISO 9283:1998"},
               {"files", arguments.measurements},
               {"n_rows", readings.size()},
               {"characteristics", Json::array()}};
  std::string failed;
  std::vector<evaluate::JudgedValue> judged;
  for (const Judged& one : page.characteristics) {
    Json entry = {{"name", one.name},
                  {"value_um", one.value_mm * maths::kUmPerMm},
                  {"u95_um", one.expanded_mm * maths::kUmPerMm}};
    for (const auto& [name, limit] : limits) {
      if (name != one.name) continue;
      const evaluate::Conformity answer = evaluate::conformity(one.value_mm, limit, one.expanded_mm);
      entry["tolerance_um"] = limit * maths::kUmPerMm;
      entry["conformity"] = evaluate::conformity_text(answer);
      judged.push_back(judged_of(entry));
      if (answer == evaluate::Conformity::kNotMet) failed += (failed.empty() ? "" : ", ") + one.name;
    }
    json["characteristics"].push_back(std::move(entry));
  }
  json[page.key] = page.list;
  json["notes"] = shortcomings(readings, page);
  json["assurance"] = evaluate::assurance_of(judged, "um").json();
  write_json(arguments.json, json);
  std::FILE* out = human_stream(arguments.json);
  for (const std::string& line : page.lines) fmt::print(out, "{}\n", line);
  for (const Json& one : json["characteristics"]) print_characteristic(out, one);
  for (const Json& note : json["notes"]) fmt::print(out, "note: {}\n", note.get<std::string>());
  if (!failed.empty()) throw text::LimitNotMet("the tolerance of " + failed + " is not met");
}

}  // namespace

void add_robot_kind(CLI::App& evaluate) {
  const auto arguments = std::make_shared<RobotArguments>();
  CLI::App* kind = evaluate.add_subcommand(
      "iso9283", "Pose accuracy and repeatability of a robot; of paths, distances, drift");
  kind->add_option("MEAS", arguments->measurements, "measurement files (CSV)")->type_name(kReads)->required();
  kind->add_option("--machine", arguments->machine,
                   "machine file: the nominal chain computes the commanded poses from the axis positions; "
                   "without a machine file the columns px py pz are the commanded poses")
      ->type_name(kReads);
  CLI::Option* path =
      kind->add_flag("--path", arguments->path,
                     "the rows are samples along one path, and each run is one cycle: evaluate AT and RT");
  CLI::Option* distance =
      kind->add_flag("--distance", arguments->distance,
                     "evaluate the distance from each pose to the next pose in pairs of visits: AD and RD")
          ->excludes(path);
  kind->add_flag("--drift", arguments->drift,
                 "each run is a block of cycles of a long test: evaluate dAP and dRP, the drift from the "
                 "first block")
      ->excludes(path)
      ->excludes(distance);
  kind->add_option("--stations", arguments->stations,
                   "number of positions along the path at which the path is evaluated")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  kind->add_flag("--align", arguments->align,
                 "the frame of the instrument differs from the frame of the robot: align both by best fit "
                 "before the evaluation");
  kind->add_option("--tolerance", arguments->tolerances,
                   "tolerance of a characteristic: RP=100um (also AP; AT RT with --path, AD RD, dAP dRP); "
                   "repeat the option for each characteristic")
      ->allow_extra_args(false);
  kind->add_option("--json", arguments->json,
                   "file for the result as JSON, for programs; - for standard output");
  kind->footer(
      "All rows with the same commanded pose form one group. AP = distance of the barycentre of the group "
      "from the commanded\n"
      "pose, RP = mean distance from the barycentre + 3 S. AD = mean distance of two poses minus the "
      "commanded distance, RD = 3 S.\n"
      "dAP, dRP = largest change of AP, RP since the first block. Exit status 0 done, 1 bad input, 2 a "
      "tolerance is not met\n"
      "(ISO 14253-1: the value exceeds the tolerance by more than its uncertainty).");
  kind->callback([arguments] { run_robot(*arguments); });
}

}  // namespace vernier::commands::evaluate_cli
