// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::fit {

/// A domain is the range of quantities in which a learned term is valid. A term that was learned on features
/// is not valid outside the range of its training data. The machine file contains a learned term as
/// `weight*term`, an ordinary expression with ordinary hidden statics. Because a domain is only part of an
/// expression, model, fit, compile and board need no special code. The weight is the product, over the
/// quantities Q of the domain, of max(0,1-max(0,max(D_Q_low-Q,Q-D_Q_high))/D_Q_fade). The weight is 1 within
/// the range of the training data and decreases linearly to 0 over the distance D_Q_fade. D is the name of
/// the domain.
std::string domain_weight(const std::string& domain, const std::vector<std::string>& quantities);

/// Name, value and unit of a hidden static of a new domain. The limits of a new domain are open
/// (+-1e9) until a fit sets the limits.
struct DomainStatic {
  std::string name, unit;
  double value = 0;
};
std::vector<DomainStatic> open_domain(
    const std::string& domain, const std::vector<std::pair<std::string, std::string>>& quantity_and_unit);

/// Range of validity of one quantity in one domain of a machine. The hidden statics of a range are found by
/// their names.
struct DomainRange {
  std::string domain, quantity;
  model::Symbol symbol;
  double low = 0, high = 0, fade = 0;
  bool open = false;  // true: no fit has set the limits yet
};
std::vector<DomainRange> domain_ranges(const model::Machine& machine);

/// Returns the text of the machine file in which every open range has limits around the fit rows of a
/// measurement. The limits of a range are the lowest and highest value of its quantity in the fit rows. The
/// fade of a range is a tenth of the distance between its limits. If the quantity of a range did
/// not vary, the fade of the range is a tenth of the quantity's value. A range whose limits are
/// already set is not changed.
std::string close_domains(const std::string& text, const model::Machine& machine,
                          const model::Measurement& measurement);

/// Position of the rows of a measurement relative to the range of a domain.
struct DomainUse {
  DomainRange range;
  double least = 0, most = 0;       // lowest and highest value of the quantity over all rows
  std::size_t faded = 0, gone = 0;  // number of rows with a weight below 1, and with weight 0
};
std::vector<DomainUse> domain_use(const model::Machine& machine, const model::Measurement& measurement);

}  // namespace vernier::fit
