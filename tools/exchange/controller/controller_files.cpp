// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/exchange/controller/controller_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "tools/exchange/controller/test_moves.h"
#include "tools/text/error.h"

namespace vernier::exchange {
namespace {

/// No "-0.000000".
double printed(double value) { return std::abs(value) < 5e-10 ? 0.0 : value; }

const char* const kMeasured =
    "The machine file describes errors that were measured with these compensations off. If the tables were\n"
    "on, add the present values to those of this file.";

std::string marked(const std::string& text, const std::string& mark) {
  std::string result = mark;
  for (const char letter : text) {
    result += letter;
    if (letter == '\n') result += mark;
  }
  return result + "\n";
}

// --- SINUMERIK ---

/// Positive values move the axis in its negative direction: a value is minus the correction.
std::string enc_comp(const ControllerTables& tables, const ControllerTable& table, int number,
                     const std::string& name) {
  const std::string axis = fmt::format("AX{}", number);
  const std::size_t count = table.forward.size();
  std::string text = fmt::format("%_N_{0}_EEC_INI\n; {1}: leadscrew and encoder errors of {2} ({0})\n", axis,
                                 name, kLetters[table.input]);
  text += marked(kMeasured, "; ");
  text += fmt::format(
      "; Needs MD38000 $MA_MM_ENC_COMP_MAX_POINTS[0,{0}] >= {1}. A change of MD38000 clears memory: save "
      "the\n"
      "; data first. MD32700 $MA_ENC_COMP_ENABLE[0,{0}] must be 0 while this file is loaded, then 1, and "
      "the\n"
      "; axis must be referenced again.\n",
      axis, count);
  text += "; Sign: a positive value moves the axis in its negative direction.\n";
  text += positioning_move(table, "; ", "change the sign of all values");
  text += "CHANDATA(1)\n";
  for (std::size_t k = 0; k < count; ++k)
    text += fmt::format("$AA_ENC_COMP[0,{},{}]={:.6f}\n", k, axis, printed(-table.forward[k]));
  text += fmt::format("$AA_ENC_COMP_STEP[0,{0}]={1:.6f}\n$AA_ENC_COMP_MIN[0,{0}]={2:.6f}\n", axis, table.step,
                      table.from);
  text += fmt::format("$AA_ENC_COMP_MAX[0,{0}]={1:.6f}\n$AA_ENC_COMP_IS_MODULO[0,{0}]=0\n", axis,
                      table.position(count - 1));
  if (tables.reversal[table.input] == 0)
    text += fmt::format(
        "; The model has no reversal error of {}: the next value switches a backlash compensation off. If\n"
        "; the control compensated a backlash in the measurement, keep its value.\n",
        kLetters[table.input]);
  text += fmt::format(
      "; Backlash, positive if the encoder is ahead of the machine part\n$MA_BACKLASH[0,{}]={:.6f}\n", axis,
      printed(tables.reversal[table.input]));
  return text + "M17\n";
}

std::string cec_table(const ControllerTable& table, std::size_t t, const std::array<int, 3>& number) {
  const std::size_t count = table.forward.size();
  std::string text =
      fmt::format("; Table {}: {} by the position of {}. Needs MD18342 $MN_MM_CEC_MAX_POINTS[{}] >= {}\n", t,
                  kLetters[table.output], kLetters[table.input], t, count);
  text += straightness_move(table, "; ", fmt::format("change the sign of all values of table {}", t));
  for (std::size_t k = 0; k < count; ++k)
    text += fmt::format("$AN_CEC[{},{}]={:.6f}\n", t, k, printed(-table.forward[k]));
  text += fmt::format("$AN_CEC_INPUT_AXIS[{0}]=(AX{1})\n$AN_CEC_OUTPUT_AXIS[{0}]=(AX{2})\n", t,
                      number[table.input], number[table.output]);
  text += fmt::format("$AN_CEC_STEP[{0}]={1:.6f}\n$AN_CEC_MIN[{0}]={2:.6f}\n$AN_CEC_MAX[{0}]={3:.6f}\n", t,
                      table.step, table.from, table.position(count - 1));
  return text +
         fmt::format("$AN_CEC_DIRECTION[{0}]=0\n$AN_CEC_MULT_BY_TABLE[{0}]=0\n$AN_CEC_IS_MODULO[{0}]=0\n", t);
}

std::vector<ConfigurationFile> siemens(const ControllerSetting& setting, const std::string& name,
                                       const ControllerTables& tables) {
  std::vector<ConfigurationFile> files;
  std::string cec;
  std::map<const ControllerTable*, std::size_t> number_of;  // of the $AN_CEC tables
  for (const ControllerTable& table : tables.tables)
    if (table.input == table.output) {
      files.push_back({fmt::format("AX{}_EEC.INI", setting.number[table.input]),
                       enc_comp(tables, table, setting.number[table.input], name)});
    } else {
      const std::size_t number = number_of.size();
      number_of[&table] = number;
      cec += cec_table(table, number, setting.number);
    }
  if (cec.empty()) return files;
  std::string text = fmt::format("%_N_NC_CEC_INI\n; {}: straightness and squareness\n", name);
  text += marked(kMeasured, "; ");
  text +=
      "; Enable each table with SD41300 $SN_CEC_TABLE_ENABLE and each output axis with MD32710\n"
      "; $MA_CEC_ENABLE; both must be off while this file is loaded. A change of MD18342 clears memory: "
      "save\n"
      "; the data first. The sign is that of the other compensation tables; no sentence of the\n"
      "; manual about the sign of these tables was found: do every test move.\n";
  text += squareness_moves(tables, "; ", [&](const ControllerTable* one, const ControllerTable* other) {
    if (one == nullptr || other == nullptr)
      return fmt::format("change the sign of all values of table {}",
                         number_of.at(one == nullptr ? other : one));
    return fmt::format("change the sign of all values of the tables {} and {}", number_of.at(one),
                       number_of.at(other));
  });
  text += "CHANDATA(1)\n";
  files.push_back({"NC_CEC.INI", text + cec + "M17\n"});
  return files;
}

// --- HEIDENHAIN ---

/// A table of one input axis: own values in the column of the axis and in BACKLASH (negative direction), the
/// other axes in their columns. A value is minus the correction.
std::string com_table(const ControllerTables& tables, std::size_t input) {
  const ControllerTable& own = *tables.find(input, input);
  std::string text = fmt::format("BEGIN {}.COM MM\nNR   AXISPOS     BACKLASH  ", kLetters[input]);
  for (const char* axis : kLetters) text += fmt::format("  {:<9}", axis);
  while (text.back() == ' ') text.pop_back();
  text += "\n";
  for (std::size_t k = 0; k < own.forward.size(); ++k) {
    text += fmt::format("{:<4} {:<+11.4f} {:<+10.4f}", k, printed(own.position(k)), printed(-own.reverse[k]));
    for (std::size_t output = 0; output < 3; ++output) {
      const ControllerTable* table = tables.find(input, output);
      text += fmt::format(" {:<+10.4f}", printed(table == nullptr ? 0 : -table->forward[k]));
    }
    while (text.back() == ' ') text.pop_back();
    text += "\n";
  }
  return text + "[END]\n";
}

std::vector<ConfigurationFile> heidenhain(const std::string& name, const ControllerTables& tables) {
  std::vector<ConfigurationFile> files;
  for (std::size_t input = 0; input < 3; ++input)
    files.push_back({fmt::format("{}.COM", kLetters[input]), com_table(tables, input)});
  files.push_back({"CONFIG.CMA",
                   "BEGIN CONFIG.CMA\n"
                   "NR   ACTIVE  X           Y           Z\n"
                   "0    *       X.COM       Y.COM       Z.COM\n"
                   "[END]\n"});
  std::string text = fmt::format("{}: nonlinear axis error compensation\n\n", name);
  text += std::string(kMeasured) + "\n\n";
  text +=
      "X.COM, Y.COM, Z.COM  compensation values, mm. AXISPOS is the position with respect to the machine "
      "datum\n"
      "                     (MP_refPosition). The column of the own axis holds the positive direction,\n"
      "                     BACKLASH the negative direction. Set MP_backLash (CfgAxisComp) to 0.\n"
      "CONFIG.CMA           assigns the tables to the axes; the * in ACTIVE activates its line.\n\n"
      "Copy the tables to the folder of System/Paths/CfgOemPath/oemTable, and CONFIG.CMA to that of\n"
      "System/Paths/CfgTablePath/TABCMA. The names of the columns must be those of CfgAxes/axisList.\n"
      "A value is the error that was measured: actual minus nominal position.\n"
      "The files were not tried on a control. If the control refuses the first or last line of a table, "
      "create\n"
      "the table in its editor and enter the values.\n\n";
  const auto column = [](const ControllerTable& table) {
    return fmt::format("the column {} of {}.COM", kLetters[table.output], kLetters[table.input]);
  };
  for (const ControllerTable& table : tables.tables)
    text += table.input == table.output
                ? positioning_move(table, "",
                                   fmt::format("change the sign of the columns {} and BACKLASH of {}.COM",
                                               kLetters[table.output], kLetters[table.input]))
                : straightness_move(table, "", "change the sign of " + column(table));
  text += squareness_moves(tables, "", [&](const ControllerTable* one, const ControllerTable* other) {
    if (one == nullptr || other == nullptr)
      return "change the sign of " + column(one == nullptr ? *other : *one);
    return fmt::format("change the sign of {} and of {}", column(*one), column(*other));
  });
  files.push_back({"README.txt", text});
  return files;
}

// --- FANUC ---

constexpr int kMostIncrement = 7, kMostMagnification = 100;

/// Values at the boundaries of the sections as whole multiples of unit * magnification, and the smallest
/// magnification at which each increment is within its range.
struct Increments {
  int magnification = 1;
  std::vector<int> value;  // of each section, in the positive direction
};

Increments increments_of(ControllerTable& table, double unit_mm, double reference) {
  const auto zero = static_cast<std::size_t>(std::lround((reference - table.from) / table.step));
  for (int magnification = 1; magnification <= kMostMagnification; ++magnification) {
    Increments result{magnification, {}};
    const double unit = unit_mm * magnification;
    const auto whole = [&](std::size_t k) {
      return std::lround((table.forward[k] - table.forward[zero]) / unit);
    };
    int largest = 0;
    for (std::size_t k = 0; k + 1 < table.forward.size(); ++k) {
      result.value.push_back(static_cast<int>(whole(k + 1) - whole(k)));
      largest = std::max(largest, std::abs(result.value.back()));
    }
    if (largest > kMostIncrement) continue;
    std::vector<double> values;
    for (std::size_t k = 0; k < table.forward.size(); ++k)
      values.push_back(static_cast<double>(whole(k)) * unit);
    table.forward = table.reverse = values;
    return result;
  }
  throw text::LimitNotMet(
      fmt::format("{}: the correction changes by more than {} um in {} mm: one value of the controller "
                  "cannot be larger; use a smaller --step",
                  kLetters[table.input], kMostIncrement * kMostMagnification * unit_mm * 1000, table.step));
}

std::vector<ConfigurationFile> fanuc(const ControllerSetting& setting, const std::string& name,
                                     ControllerTables& tables) {
  std::string text = "%\n", data;
  std::string notes = fmt::format("{}: stored pitch error compensation and backlash\n\n", name);
  notes += std::string(kMeasured) + "\n\n";
  notes += fmt::format(
      "PITCH.TXT holds the parameters 1851 (backlash) and 3620 to 3624 and the data (N10000 + number). Data "
      "and\n"
      "backlash are in detection units of {} um. 3620 is the number of the reference position, 3621 and "
      "3622\n"
      "the most negative and the most positive number, 3623 the magnification, 3624 the interval in mm. "
      "A\n"
      "positive value of the data moves the axis in its positive direction. The value of a section acts in "
      "its\n"
      "middle. Check that no other axis uses these numbers, and the smallest interval that the manual "
      "allows.\n"
      "Switch the power off and on after loading, then return to the reference position. The file was not\n"
      "tried on a control: compare the screens with PITCH.TXT.\n\n",
      setting.unit_um);
  int first = 0;
  for (ControllerTable& table : tables.tables) {
    const double reference = tables.reference[table.input];
    const Increments increments = increments_of(table, setting.unit_um / 1000, reference);
    const int before = static_cast<int>(std::lround((reference - table.from) / table.step));
    const int count = static_cast<int>(increments.value.size()), at_reference = first + before - 1;
    const int number = setting.number[table.input];
    const auto parameter = [&](int which, const std::string& value) {
      text += fmt::format("N{:05}Q1A{}P{}\n", which, number, value);
    };
    const long backlash = std::lround(1000 * tables.reversal[table.input] / setting.unit_um);
    tables.reversal[table.input] = static_cast<double>(backlash) * setting.unit_um / 1000;
    parameter(1851, fmt::format("{}", backlash));
    parameter(3620, fmt::format("{}", at_reference));
    parameter(3621, fmt::format("{}", first));
    parameter(3622, fmt::format("{}", first + count - 1));
    parameter(3623, fmt::format("{}", increments.magnification));
    parameter(3624, fmt::format("{:.3f}", table.step));
    for (int k = 0; k < count; ++k)
      data += fmt::format("N{}Q0P{}\n", 10000 + first + k, increments.value[static_cast<std::size_t>(k)]);
    notes += positioning_move(table, "",
                              fmt::format("change the sign of the data {} to {}", first, first + count - 1));
    first += count;
  }
  return {{"PITCH.TXT", text + data + "%\n"}, {"README.txt", notes}};
}

}  // namespace

ControllerRules rules_of(Controller controller, const ControllerSetting& setting) {
  ControllerRules rules;
  switch (controller) {
    case Controller::kSiemens:
      rules.most_own = 801;    // the largest table of the manual's examples
      rules.most_cross = 200;  // of each of the eight tables of the 828D
      break;
    case Controller::kHeidenhain:
      rules.most_own = rules.most_cross = 256;
      rules.own_reverse = rules.same_points = true;
      rules.value_step_mm = rules.position_step_mm = 1e-4;
      break;
    case Controller::kFanuc:
      rules.most_own = 129;  // boundaries of 128 sections
      rules.stairs = true;
      rules.value_step_mm = setting.unit_um / 1000;
      rules.position_step_mm = 1e-3;
      break;
  }
  return rules;
}

std::vector<ConfigurationFile> controller_files(Controller controller, const ControllerSetting& setting,
                                                const std::string& machine_name, ControllerTables& tables) {
  switch (controller) {
    case Controller::kSiemens:
      return siemens(setting, machine_name, tables);
    case Controller::kHeidenhain:
      return heidenhain(machine_name, tables);
    case Controller::kFanuc:
      break;
  }
  return fanuc(setting, machine_name, tables);
}

}  // namespace vernier::exchange
