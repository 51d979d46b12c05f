// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "tools/import/columns/column_map.h"

namespace vernier::importer {

struct PrinterOptions {
  std::string profile;           // name of a saved mesh; empty: the only mesh of the file, or "default"
  std::string artefact = "bed";  // artefact that the nozzle or the probe touched
  std::optional<std::array<double, 2>> offset_mm;  // position of the probe minus position of the nozzle, X
                                                   // and Y; default: the value in the file
  std::optional<double> z_offset_mm;               // height of the nozzle at which the probe triggers on the
                                                   // bed, for Klipper's older line; default: z_offset in the
                                                   // file
  std::optional<double> u_um;                      // standard uncertainty of a touch; no value: the table has
                                                   // no column u
  /// How the compensation of an axis twist (Klipper, z_compensations) applies to the touches.
  enum class Twist : std::uint8_t {
    kIncluded,  // the heights include the compensation: they are heights of the nozzle
    kAdd,       // the touches are older than the compensation: the import adds it
    kIgnore     // the heights do not include the compensation, and the import does not add it
  };
  Twist twist = Twist::kIncluded;
  enum class Survey : std::uint8_t {
    kOnly,  // the only one of the log, or all of a bed at several temperatures
    kAll    // all surveys of the log as one table
  };
  std::variant<Survey, std::size_t> series = Survey::kOnly;  // number of the survey in a log, from 1
};

/// Touches on the bed of a 3D printer.
struct PrinterFile {
  enum class Kind { kSavedMesh, kHeightMap, kProbeLog };
  Kind kind = Kind::kProbeLog;
  std::string name;                      // name of the saved mesh
  std::array<double, 2> offset_mm = {};  // probe offset that was used
  bool twist = false;                    // the heights are those of the nozzle by z_compensations
  bool offset_known = true;              // false: a log of nozzle positions without a probe offset
  std::string zero;                      // what was subtracted from the heights, or that their zero is
                                         // unknown; empty: the file has heights of the nozzle
  bool zero_known = true;                // false: the heights contain the z_offset of a probe
  std::size_t not_probed = 0;            // number of positions of a height map without a reading
  std::size_t left_out = 0;              // number of touches in a log that the printer discarded
  std::string surveys;                   // of a log whose surveys are read as one table: the list of them;
                                         // empty: the log has one, or the user chose one
  std::vector<std::string> notes;        // about other meshes of the file, surveys that are not complete,
                                         // and the rotation_distance of the configuration
  ImportTable table;                     // columns X[mm], Y[mm], Z[mm], on; probeX[mm] and probeY[mm] if the
                                         // probe has an offset; if known u, t[s], temperatures
};

/// True if the bytes are a file of a printer by its first line or its marks: a height map, a saved mesh, or a
/// log with touches. `read_printer_file` may still refuse the file.
bool is_printer_file(const std::string& bytes);

/// Reads the touches on a printer's bed as positions of the axes, from one of these files:
/// - a configuration of Klipper with a saved mesh (section [bed_mesh NAME]),
/// - a log or console text of Klipper ("probe at X,Y is z=Z"; "Stats T:" lines give time and temperatures),
///   or of Marlin ("Bed X: X Y: Y Z: Z"),
/// - a height map of RepRapFirmware (heightmap.csv, version 2).
/// Meshes, height maps, Marlin's G30 and Klipper's newer line ("probe: at X,Y bed will contact at z=Z") state
/// the point that the probe touched. The position of the axes is the probed point minus the probe offset. If
/// neither the options nor a configuration in the file state the offset, throws InputError. The columns
/// probeX and probeY have the offset. If the file has z_compensations of [axis_twist_compensation], the
/// heights are those that the nozzle has at the touched point (PrinterOptions::twist): the position of the
/// axes is then the touched point, and the table has no columns probeX and probeY. Touches during levelling,
/// and repeated touches at one position (PROBE_ACCURACY), are excluded. A survey with fewer
/// points than another one of the log, or than its configuration states, and a survey that begins again at
/// its first point, get a note. Klipper's older line ("probe at X,Y is z=Z") has the height of the nozzle at
/// which the probe triggered: z_offset of the options, or of the last configuration before the touch, is
/// subtracted, as the firmware does for its mesh. If a log has several surveys of the bed, and not their
/// temperatures tell them apart, the option `series` is necessary. If the file is not valid, throws
/// InputError with file, line and word.
PrinterFile read_printer_file(const std::string& text, const std::string& file,
                              const PrinterOptions& options);

}  // namespace vernier::importer
