// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "tools/import/tables/column_map.h"

namespace vernier::importer {

struct PrinterOptions {
  std::string profile;           // name of a saved mesh; empty: the file's only one, or "default"
  std::string artefact = "bed";  // that the nozzle or the probe touched
  std::optional<std::array<double, 2>> offset_mm;  // probe − nozzle, X and Y; default: the file's own, else 0
  std::optional<double> u_um;                      // standard uncertainty of a touch; absent: no column
  std::optional<std::size_t> series;               // number of the survey in a log, from 1
};

/// Touches of a printer's bed.
struct PrinterFile {
  enum class Kind { kSavedMesh, kHeightMap, kProbeLog };
  Kind kind = Kind::kProbeLog;
  std::string name;                      // of the saved mesh
  std::array<double, 2> offset_mm = {};  // that was used
  std::size_t not_probed = 0;            // places of a height map without a reading
  std::size_t left_out = 0;              // touches of a log that the printer discarded
  ImportTable table;                     // X[mm], Y[mm], Z[mm], on, and if known u, t[s], temperatures
};

/// Reads the touches of a bed as positions of the axes:
/// - a configuration of Klipper with a saved mesh (section [bed_mesh NAME]),
/// - a log or console text of Klipper ("probe at X,Y is z=Z"; "Stats T:" lines give time and temperatures),
///   or of Marlin ("Bed X: X Y: Y Z: Z"),
/// - a height map of RepRapFirmware (heightmap.csv, version 2).
/// A mesh, a height map, Marlin's G30 and Klipper's newer line ("probe: at X,Y bed will contact at z=Z")
/// state where the probe touched: the axes stood at this point less the offset. Touches of a levelling and
/// repeats at one place (PROBE_ACCURACY) are left out. A log with several surveys of the bed needs `series`.
/// Throws InputError with file, line and word.
PrinterFile read_printer_file(const std::string& text, const std::string& file,
                              const PrinterOptions& options);

}  // namespace vernier::importer
