// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/commands/fit_findings.h"

#include <fmt/format.h>

#include <cstdio>

#include "tools/model/fit_record.h"
#include "tools/model/machine_reader.h"

namespace vernier::commands {

void repeat_findings(const model::Machine& machine) {
  if (!machine.fitted) return;
  for (const model::FitRecord::Finding& one : machine.fitted->findings)
    fmt::print(stderr, "found by the fit of {}: {} ({})\n", machine.file, one.text, one.code);
}

model::Machine read_model(const std::string& path) {
  model::Machine machine = model::read_machine(path);
  repeat_findings(machine);
  return machine;
}

}  // namespace vernier::commands
