// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::effects {

/// The role that a user gives to a logged column: `T_stamp=ignore`, `coolant=temperature`.
struct ColumnRole {
  std::string column;
  bool ignored = false;  // true: the column is handled as if it were absent
  model::InputRole role = model::InputRole::kGuessed;
};

/// Throws InputError if the text has no `=` or if the role is unknown.
ColumnRole parse_column_role(const std::string& statement);

/// Returns the text of the machine file in which the columns of `roles` are declared as inputs with their
/// roles. Ignored columns are not declared. Throws InputError if a column is not in `rows`, or if the machine
/// file already declares it.
std::string with_declared_columns(const std::string& text, const model::Machine& machine,
                                  const model::Measurement& rows, const std::vector<ColumnRole>& roles);

/// Removes the ignored columns from the candidate inputs of a measurement.
void leave_out(model::Measurement& rows, const std::vector<ColumnRole>& roles);

/// Returns the mean of the cells of an undeclared column that have a value; 0 if none has one.
double mean_of_cells(const model::CandidateInput& candidate);

/// Returns one note for each measurement file that has no approach direction of a moving axis, although
/// another file of the survey has it. The model then predicts no reversal error in this file, and the file
/// contradicts a reversal error that the other files show.
std::vector<std::string> notes_of_missing_directions(const model::Machine& machine,
                                                     const model::Measurement& rows);

/// Gives every undeclared column a value in every row, so that all models of a search are fitted to the same
/// rows. In the rows of a file without the column, the column has the reference of an input
/// (usual_reference()), as an input that a file does not record. Rows with an empty cell in a file that has
/// the column are excluded; a column with more than a fifth of its cells empty in a file is not used instead,
/// nor is a column that counts the rows (Nr).
/// Returns one sentence for each change, and for each file without approach directions that another file has
/// (notes_of_missing_directions). `machine`: the machine of `rows`.
std::vector<std::string> complete_columns(const model::Machine& machine, model::Measurement& rows);

}  // namespace vernier::effects
