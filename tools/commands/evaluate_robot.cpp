// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <memory>

#include "tools/commands/command.h"
#include "tools/commands/evaluate_kinds.h"
#include "tools/evaluate/limits.h"
#include "tools/evaluate/positioning.h"
#include "tools/evaluate/robot_path.h"
#include "tools/maths/factors.h"
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
  bool path = false, align = false;
};

/// Where the robot was told to be, from the axes and the nominal chain.
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
  if (readings.empty()) throw text::InputError({m.files.front(), 0}, "x", "no row has x, y and z");
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

Json vector_json(const Eigen::Vector3d& v, double unit) { return {v[0] * unit, v[1] * unit, v[2] * unit}; }

Json pose_json(const evaluate::PoseResult& pose, const char* accuracy, const char* repeatability) {
  const std::string ap = accuracy, rp = repeatability;
  Json json = {{"commanded_mm", vector_json(pose.commanded_mm, 1)},
               {"n", pose.count},
               {ap + "_um", pose.accuracy_mm * maths::kUmPerMm},
               {ap + "_xyz_um", vector_json(pose.deviation_mm, maths::kUmPerMm)},
               {ap + "_u95_um", 2 * pose.accuracy_std_mm * maths::kUmPerMm},
               {rp + "_um", pose.repeatability_mm * maths::kUmPerMm},
               {rp + "_interval_um", {pose.low_mm * maths::kUmPerMm, pose.high_mm * maths::kUmPerMm}},
               {"mean_distance_um", pose.mean_distance_mm * maths::kUmPerMm},
               {"S_um", pose.distance_spread_mm * maths::kUmPerMm},
               {"degrees_of_freedom", pose.freedom}};
  if (pose.accuracy_deg) json[ap + "_abc_deg"] = vector_json(*pose.accuracy_deg, 1);
  if (pose.repeatability_deg) json[rp + "_abc_deg"] = vector_json(*pose.repeatability_deg, 1);
  return json;
}

void print_pose(std::FILE* out, const Json& pose, const std::string& ap, const std::string& rp) {
  const Json &at = pose["commanded_mm"], &interval = pose[rp + "_interval_um"];
  fmt::print(out,
             "  {:>9.3f} {:>9.3f} {:>9.3f} mm {:>4} readings  {} {:.2f} um, U {:.2g}  {} {:.2f} um ({:.2f} "
             "to {:.2f})\n",
             at[0].get<double>(), at[1].get<double>(), at[2].get<double>(), pose["n"].get<std::size_t>(), ap,
             pose[ap + "_um"].get<double>(), pose[ap + "_u95_um"].get<double>(), rp,
             pose[rp + "_um"].get<double>(), interval[0].get<double>(), interval[1].get<double>());
}

struct Judged {
  std::string name;
  double value_mm = 0, expanded_mm = 0;
};

/// The largest of each characteristic, and how uncertain it is upwards.
std::vector<Judged> largest(const std::vector<evaluate::PoseResult>& poses, bool path) {
  Judged accuracy{path ? "AT" : "AP"}, repeatability{path ? "RT" : "RP"};
  for (const evaluate::PoseResult& pose : poses) {
    if (pose.accuracy_mm >= accuracy.value_mm)
      accuracy.value_mm = pose.accuracy_mm, accuracy.expanded_mm = 2 * pose.accuracy_std_mm;
    if (pose.repeatability_mm >= repeatability.value_mm)
      repeatability.value_mm = pose.repeatability_mm,
      repeatability.expanded_mm = pose.high_mm - pose.repeatability_mm;
  }
  return {accuracy, repeatability};
}

/// What the standard asks for and this test has not.
Json shortcomings(const std::vector<evaluate::PoseReading>& readings,
                  const std::vector<evaluate::PoseResult>& poses, bool path) {
  Json notes = Json::array();
  const std::size_t wanted = path ? 10 : 30;
  std::size_t fewest = wanted;
  double u = 0, least = HUGE_VAL;
  for (const evaluate::PoseResult& pose : poses) {
    fewest = std::min(fewest, pose.count);
    least = std::min(least, pose.repeatability_mm);
  }
  for (const evaluate::PoseReading& reading : readings) u = std::max(u, reading.u_mm);
  if (fewest < wanted) notes.push_back(fmt::format("{} cycles where ISO 9283 asks for {}", fewest, wanted));
  if (u == 0)
    notes.push_back("no uncertainty of the instrument is given (u): U is that of the scatter alone");
  if (2 * u > least / 4)
    notes.push_back(
        fmt::format("U of the instrument is {:.3g} um, more than a quarter of the {:.3g} um of "
                    "repeatability: it judges itself",
                    2 * u * maths::kUmPerMm, least * maths::kUmPerMm));
  return notes;
}

void run_robot(const RobotArguments& arguments) {
  std::vector<std::pair<std::string, double>> limits;
  const std::vector<std::string> names =
      arguments.path ? std::vector<std::string>{"AT", "RT"} : std::vector<std::string>{"AP", "RP"};
  for (const std::string& words : arguments.tolerances)
    limits.push_back(evaluate::limit_of(words, "--tolerance", names));
  std::vector<evaluate::PoseReading> readings = readings_of(arguments);
  if (arguments.align) evaluate::align_to_commanded(readings);
  const std::vector<evaluate::PoseResult> poses =
      arguments.path ? evaluate::evaluate_path(readings, arguments.stations).stations
                     : evaluate::evaluate_poses(readings);
  Json json = {{"standard", "ISO 9283:1998"},
               {"files", arguments.measurements},
               {"n_rows", readings.size()},
               {"characteristics", Json::array()}};
  std::string failed;
  for (const Judged& one : largest(poses, arguments.path)) {
    Json entry = {{"name", one.name},
                  {"value_um", one.value_mm * maths::kUmPerMm},
                  {"u95_um", one.expanded_mm * maths::kUmPerMm}};
    for (const auto& [name, limit] : limits) {
      if (name != one.name) continue;
      const evaluate::Conformity answer = evaluate::conformity(one.value_mm, limit, one.expanded_mm);
      entry["tolerance_um"] = limit * maths::kUmPerMm;
      entry["conformity"] = evaluate::conformity_text(answer);
      if (answer == evaluate::Conformity::kNotMet) failed += (failed.empty() ? "" : ", ") + one.name;
    }
    json["characteristics"].push_back(std::move(entry));
  }
  json[arguments.path ? "stations" : "poses"] = Json::array();
  for (const evaluate::PoseResult& pose : poses)
    json[arguments.path ? "stations" : "poses"].push_back(
        pose_json(pose, names[0].c_str(), names[1].c_str()));
  json["notes"] = shortcomings(readings, poses, arguments.path);
  write_json(arguments.json, json);
  std::FILE* out = human_stream(arguments.json);
  if (!arguments.path)
    for (const Json& pose : json["poses"]) print_pose(out, pose, names[0], names[1]);
  for (const Json& one : json["characteristics"])
    fmt::print(out, "{} {:.3f} um, U {:.2g} um{}\n", one["name"].get<std::string>(),
               one["value_um"].get<double>(), one["u95_um"].get<double>(),
               one.contains("conformity")
                   ? fmt::format("; tolerance {:g} um: {}", one["tolerance_um"].get<double>(),
                                 one["conformity"].get<std::string>())
                   : "");
  for (const Json& note : json["notes"]) fmt::print(out, "note: {}\n", note.get<std::string>());
  if (!failed.empty()) throw text::LimitNotMet("the tolerance of " + failed + " is not met");
}

}  // namespace

void add_robot_kind(CLI::App& evaluate) {
  const auto arguments = std::make_shared<RobotArguments>();
  CLI::App* kind =
      evaluate.add_subcommand("iso9283", "Pose accuracy and repeatability of a robot; of a path with --path");
  kind->add_option("MEAS", arguments->measurements, "measurement files (CSV)")->required();
  kind->add_option("--machine", arguments->machine,
                   "machine file: commanded poses by its nominal chain from the axes; else px py pz")
      ->type_name("FILE");
  kind->add_flag("--path", arguments->path, "rows are samples along one path, a cycle a run: AT and RT");
  kind->add_option("--stations", arguments->stations, "places along the path that are looked at")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  kind->add_flag("--align", arguments->align,
                 "the instrument's frame is not the robot's: best fit of both first");
  kind->add_option("--tolerance", arguments->tolerances,
                   "RP=100um (also AP; AT RT with --path); again for each")
      ->allow_extra_args(false);
  kind->add_option("--json", arguments->json, "result for programs; - for standard output");
  kind->footer(
      "Rows with one commanded pose belong together. AP = distance of their barycentre from it, RP = mean\n"
      "distance from the barycentre + 3 S. Exit status 0 done, 1 bad input, 2 a tolerance is not met\n"
      "(ISO 14253-1: beyond it by more than the uncertainty).");
  kind->callback([arguments] { run_robot(*arguments); });
}

}  // namespace vernier::commands::evaluate_cli
