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
  bool ignored = false;  // handled as if it were absent
  model::InputRole role = model::InputRole::kGuessed;
};

/// Throws InputError for a text without `=` or with an unknown role.
ColumnRole parse_column_role(const std::string& statement);

/// Returns the text of the machine file with these columns of `rows` declared as inputs of their roles.
/// Ignored columns are not declared. Throws InputError for a column that is not in `rows`, or that the
/// machine file declares already.
std::string with_declared_columns(const std::string& text, const model::Machine& machine,
                                  const model::Measurement& rows, const std::vector<ColumnRole>& roles);

/// Removes the ignored columns from the candidates.
void leave_out(model::Measurement& rows, const std::vector<ColumnRole>& roles);

}  // namespace vernier::effects
