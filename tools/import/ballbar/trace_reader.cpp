// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/ballbar/trace_reader.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "tools/import/ballbar/ballbar_file.h"
#include "tools/import/ballbar/json_place.h"
#include "tools/text/error.h"
#include "tools/text/files.h"

namespace vernier::importer {
namespace {

class TraceReader {
 public:
  TraceReader(const std::string& path, const TraceSetup& setup)
      : path_(path), text_(text::read_file(path)), setup_(setup) {}

  BallbarFile read() const {
    const nlohmann::json document = parse_json(path_, text_);
    if (!document.is_object()) fail("", "a trace file must be a JSON object");
    const std::string units = text_at(document, "ErrorUnits", "");
    if (units.empty()) fail("", "the file has no ErrorUnits");
    if (units != "millimetres")
      fail("/ErrorUnits", "the command can read only files with lengths in millimetres");
    BallbarFile file;
    file.path = path_;
    file.instrument = text_at(document, "BallbarModel", "");
    file.machine = text_at(document, "Machine", "");
    file.axis_a = setup_.axis_a;
    file.axis_b = setup_.axis_b;
    file.nominal_length_mm = setup_.length_mm;
    file.radius_mm = setup_.radius_mm;
    file.programmed_feed_mm_min = setup_.feed_mm_min;
    file.notes = {
        "a trace file contains no plane, radius, feed and start angle: the command uses the values of the "
        "command line",
        "Direction 0 is taken as " + std::string(setup_.direction_of_zero > 0 ? "CCW" : "CW")};
    const auto runs = document.find("Runs");
    if (runs == document.end()) fail("", "the file has no Runs");
    if (!runs->is_array() || runs->empty()) fail("/Runs", "must be a list of runs");
    for (std::size_t i = 0; i < runs->size(); ++i)
      file.runs.push_back(read_run((*runs)[i], "/Runs/" + std::to_string(i)));
    return file;
  }

 private:
  [[noreturn]] void fail(const std::string& pointer, const std::string& what) const {
    const auto value = pointer.empty() ? std::string("the document") : word_at(pointer);
    throw text::InputError({path_, pointer.empty() ? 1 : json_line(text_, pointer)}, value, what);
  }

  std::string word_at(const std::string& pointer) const {
    const nlohmann::json document = parse_json(path_, text_);
    const nlohmann::json::json_pointer place(pointer);
    return document.contains(place) ? document.at(place).dump().substr(0, 24) : pointer;
  }

  std::string text_at(const nlohmann::json& object, const char* key, const std::string& otherwise) const {
    const auto found = object.find(key);
    if (found == object.end()) return otherwise;
    if (!found->is_string()) fail(std::string("/") + key, "must be a text");
    return found->get<std::string>();
  }

  BallbarRun read_run(const nlohmann::json& node, const std::string& pointer) const {
    if (!node.is_object()) fail(pointer, "a run is an object");
    const auto direction = node.find("Direction");
    if (direction == node.end()) fail(pointer, "a run needs its Direction");
    if (*direction != 0 && *direction != 1) fail(pointer + "/Direction", "a direction is 0 or 1");
    const auto readings = node.find("Readings");
    if (readings == node.end()) fail(pointer, "a run needs its Readings");
    if (!readings->is_array() || readings->size() < 3)
      fail(pointer + "/Readings", "the value must be a list of at least three readings");
    BallbarRun run;
    run.direction = *direction == 0 ? setup_.direction_of_zero : -setup_.direction_of_zero;
    run.label = run.direction > 0 ? "CCW" : "CW";
    run.sample_rate_hz = setup_.sample_rate_hz;
    for (std::size_t i = 0; i < readings->size(); ++i) {
      if (!(*readings)[i].is_number())
        fail(pointer + "/Readings/" + std::to_string(i), "a reading is a number");
      run.reading_mm.push_back((*readings)[i].get<double>());
    }
    place_on_circle(run);
    return run;
  }

  // The readings' arc from the speed: sample k is at the start angle plus (or minus) k + 1/2 steps, as in a
  // result file.
  void place_on_circle(BallbarRun& run) const {
    run.start = 0;
    run.end = run.reading_mm.size() - 1;
    const double step_rad = setup_.feed_mm_min / 60 / setup_.radius_mm / setup_.sample_rate_hz;
    const double arc_deg = step_rad * static_cast<double>(run.reading_mm.size()) * 180 / std::acos(-1.0);
    run.first_deg = run.direction > 0 ? setup_.start_deg : setup_.start_deg - arc_deg;
    run.last_deg = run.first_deg + arc_deg;
  }

  std::string path_, text_;
  TraceSetup setup_;
};

}  // namespace

std::vector<BallbarFile> read_trace_circles(const std::vector<std::string>& paths, const TraceSetup& setup,
                                            const std::vector<TraceCircle>& circles) {
  const auto of_circle = [&](const TraceCircle& circle) {
    TraceSetup one = setup;
    one.axis_a = circle.plane.substr(0, 1);
    one.axis_b = circle.plane.substr(1, 1);
    one.start_deg = circle.start_deg;
    return one;
  };
  std::vector<BallbarFile> files;
  if (circles.size() == 1) {
    for (const std::string& path : paths) files.push_back(read_ballbar_trace(path, of_circle(circles[0])));
    return files;
  }
  std::size_t runs = 0;
  for (const std::string& path : paths) runs += read_ballbar_trace(path, of_circle(circles[0])).runs.size();
  if (runs % circles.size() != 0)
    throw text::InputError({paths.front(), 0}, std::to_string(runs) + " runs",
                           "do not divide evenly among " + std::to_string(circles.size()) + " planes");
  const std::size_t each = runs / circles.size();
  std::size_t next = 0;  // run of the whole path
  for (const std::string& path : paths) {
    // Angles depend on the circle: the file is read again for each circle that has a run in it.
    const std::size_t first = next, count = read_ballbar_trace(path, of_circle(circles[0])).runs.size();
    for (std::size_t c = first / each; c < circles.size() && c * each < first + count; ++c) {
      BallbarFile file = read_ballbar_trace(path, of_circle(circles[c]));
      std::vector<BallbarRun> own;
      for (; next < std::min((c + 1) * each, first + count); ++next) {
        own.push_back(std::move(file.runs[next - first]));
        own.back().label = circles[c].plane + " " + own.back().label;
      }
      file.runs = std::move(own);
      if (c * each > first) file.notes.clear();  // they are of the file, not of the circle
      files.push_back(std::move(file));
    }
  }
  return files;
}

BallbarFile read_ballbar_trace(const std::string& path, const TraceSetup& setup) {
  return TraceReader(path, setup).read();
}

}  // namespace vernier::importer
