// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/commands/survey.h"

#include "tools/commands/command.h"
#include "tools/effects/probe_offset.h"
#include "tools/effects/roles.h"
#include "tools/model/file_set_ups.h"
#include "tools/model/machine_reader.h"
#include "tools/simulate/corrected.h"
#include "tools/text/files.h"

namespace vernier::commands {

void add_survey(CLI::App& command, SurveyArguments& arguments) {
  command.add_option("MACHINE", arguments.machine, "machine file (XML)")->type_name(kReads)->required();
  command.add_option("MEAS", arguments.measurements, "measurement files (CSV)")
      ->type_name(kReads)
      ->required();
  command.add_option("--images", arguments.images, simulate::kImagesHelp)->type_name(kReadsFolder);
  command
      .add_option("--column", arguments.columns,
                  "NAME=ROLE: meaning of a logged column, if its unit and name suggest another meaning: "
                  "temperature, load, "
                  "vibration, set-point, other, ignore; may be repeated")
      ->allow_extra_args(false)
      ->type_name("NAME=ROLE");
}

Survey read_survey(const SurveyArguments& arguments,
                   const std::function<model::Machine(model::Machine)>& prepare) {
  Survey survey;
  survey.text = text::read_file(arguments.machine);
  const auto read = [&] {
    survey.machine = model::parse_machine(survey.text, arguments.machine);
    if (prepare) survey.machine = prepare(std::move(survey.machine));
    survey.rows = model::read_measurement(arguments.measurements, survey.machine,
                                          simulate::corrections_of_images(arguments.images));
  };
  read();
  std::vector<std::string> notes;
  for (const auto complete :
       {effects::with_probe_offset, model::with_set_ups_of_files, model::with_camera_mountings}) {
    model::CompletedText own = complete(survey.text, survey.machine, survey.rows);
    if (own.notes.empty()) continue;
    survey.text = std::move(own.text);
    notes.insert(notes.end(), own.notes.begin(), own.notes.end());
    read();
  }
  if (!arguments.columns.empty()) {
    std::vector<effects::ColumnRole> roles;
    for (const std::string& statement : arguments.columns)
      roles.push_back(effects::parse_column_role(statement));
    survey.text = effects::with_declared_columns(survey.text, survey.machine, survey.rows, roles);
    read();
    effects::leave_out(survey.rows, roles);
  }
  survey.machine.notes.insert(survey.machine.notes.end(), notes.begin(), notes.end());
  return survey;
}

}  // namespace vernier::commands
