// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::effects {

/// What a user says of a logged column: `T_stamp=ignore`, `coolant=temperature`.
struct ColumnRole {
  std::string column;
  bool ignored = false;  // as if it were not there
  model::InputRole role = model::InputRole::kGuessed;
};

/// Throws InputError for what has no `=` or an unknown role.
ColumnRole parse_column_role(const std::string& statement);

/// The machine file with these columns of `rows` declared as inputs of their roles; those that are ignored
/// are not. Throws InputError for a column that `rows` has not, or one that the machine file declares
/// already. tool.
std::string with_declared_columns(const std::string& text, const model::Machine& machine,
                                  const model::Measurement& rows, const std::vector<ColumnRole>& roles);

/// Takes the ignored columns out of the candidates.
void leave_out(model::Measurement& rows, const std::vector<ColumnRole>& roles);

}  // namespace vernier::effects
