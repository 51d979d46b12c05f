// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/bench/reference/flat_double.h"
#include "tools/compile/symbolic/functions.h"

#include <fmt/format.h>

#include <set>
#include <utility>

namespace vernier::bench {

using namespace vernier::compile;
using namespace vernier::model;
using namespace vernier::text;
namespace {

constexpr const char* kHead =
    "#include <algorithm>\n#include <cmath>\n\nnamespace {\n"
    "struct Spot {\n  std::ptrdiff_t near;\n  double fraction;\n};\n"
    "template <std::size_t N>\n[[maybe_unused]] Spot find(const double (&at)[N], double p) {\n"
    "  const auto far = std::clamp<std::ptrdiff_t>(std::upper_bound(at, at + N, p) - at, 1, "
    "std::ptrdiff_t{N} - 1);\n"
    "  return {far - 1, std::clamp((p - at[far - 1]) / (at[far] - at[far - 1]), 0.0, 1.0)};\n}\n"
    "template <std::size_t N>\n[[maybe_unused]] double between(const double (&v)[N][6], Spot s, int c) {\n"
    "  return v[s.near][c] + s.fraction * (v[s.near + 1][c] - v[s.near][c]);\n}\n";

class Printer {
 public:
  Printer(const Machine& machine, const Graph& graph, const std::vector<Channel>& channels)
      : machine_(machine), g_(graph), channels_(channels) {}

  std::string tables() const {
    std::string text;
    for (const Table& t : machine_.tables) {
      text += fmt::format("const double at_{}[{}] = {{", machine_.axes[t.axis].name, t.stations.size());
      for (const Station& s : t.stations) text += fmt::format("{:.17g},", s.loc);
      text +=
          fmt::format("}};\nconst double v_{}[{}][6] = {{", machine_.axes[t.axis].name, t.stations.size());
      for (const Station& s : t.stations) {
        text += "{";
        for (const double v : s.value) text += fmt::format("{:.17g},", v);
        text += "},";
      }
      text += "};\n";
    }
    return text;
  }

  std::string value(NodeId id) {
    const Node& n = g_[id];
    if (n.kind == NodeKind::kConstant) return fmt::format("{:.17g}", n.number);
    if (done_.insert(id).second) {
      const std::string text = expression(n);
      body += fmt::format("  const double n{} = {};\n", id, text);
    }
    return fmt::format("n{}", id);
  }

  std::string body;

 private:
  std::string expression(const Node& n) {
    const auto a = [&](std::size_t i) { return value(n.args[i]); };
    switch (n.kind) {
      case NodeKind::kChannel:
        return fmt::format("channel[{}]", channel_index(n));
      case NodeKind::kSum: {
        std::string text = n.number != 0 ? fmt::format("{:.17g}", n.number) : "";
        for (const Term& t : n.terms)
          text += (text.empty() ? "" : " + ") +
                  (t.coefficient == 1 ? value(t.node)
                                      : fmt::format("{:.17g} * {}", t.coefficient, value(t.node)));
        return text;
      }
      case NodeKind::kProduct:
        return a(0) + " * " + a(1);
      case NodeKind::kTable: {
        const std::string& axis = machine_.axes[n.index[0]].name;
        if (machine_.table_of(n.index[0])->interpolation == Interpolation::kCubic)
          throw InputError("a cubic table, which the double equation of the bench has not");
        // The deviation may be evaluated again at the corrected position: a spot a position.
        const std::string position = a(0);
        if (spots_.insert({n.index[0], n.args[0]}).second)
          body += fmt::format("  const Spot spot_{0}_{2} = find(at_{0}, {1});\n", axis, position, n.args[0]);
        return fmt::format("between(v_{0}, spot_{0}_{2}, {1})", axis, n.index[1], n.args[0]);
      }
      case NodeKind::kFunction:
        return function(n.function, a(0));
      case NodeKind::kAbs:
        return "std::abs(" + a(0) + ")";
      case NodeKind::kMin:
        return "std::min(" + a(0) + ", " + a(1) + ")";
      case NodeKind::kMax:
        return "std::max(" + a(0) + ", " + a(1) + ")";
      case NodeKind::kSign:
        return fmt::format("({0} > 0) - ({0} < 0)", a(0));
      case NodeKind::kEqual:
        return a(0) + " == " + a(1) + " ? 1.0 : 0.0";
      case NodeKind::kLess:
        return a(0) + " < " + a(1) + " ? 1.0 : 0.0";
      default:
        throw InputError("an operation that the double equation of the bench has not");
    }
  }
  static std::string function(Function f, const std::string& x) {
    constexpr const char* kRad = "0.017453292519943295";
    switch (f) {
      case Function::kSin:
        return fmt::format("std::sin({} * {})", kRad, x);
      case Function::kCos:
        return fmt::format("std::cos({} * {})", kRad, x);
      case Function::kExp:
        return "std::exp(" + x + ")";
      case Function::kLog:
        return "std::log(" + x + ")";
      case Function::kSqrt:
        return "std::sqrt(" + x + ")";
      case Function::kReciprocal:
        return "1 / " + x;
      case Function::kArcTangent:
        return fmt::format("std::atan({}) / {}", x, kRad);
    }
    return {};
  }

  std::size_t channel_index(const Node& n) const {
    for (std::size_t i = 0; i < channels_.size(); ++i)
      if (channels_[i].kind == n.channel && channels_[i].index == n.index[0]) return i;
    throw InputError("a channel that the program does not read");
  }

  const Machine& machine_;
  const Graph& g_;
  const std::vector<Channel>& channels_;
  std::set<NodeId> done_;
  std::set<std::pair<std::size_t, NodeId>> spots_;
};

}  // namespace

std::string print_flat_double(const Machine& machine, const Derivation& derivation,
                              const std::vector<Channel>& channels, const std::string& space) {
  Printer printer(machine, derivation.graph, channels);
  std::string results;
  for (std::size_t i = 0; i < derivation.outputs.size(); ++i)
    results += fmt::format("  deviation[{}] = {};\n", i, printer.value(derivation.outputs[i].value));
  return kHead + printer.tables() + fmt::format("}}  // namespace\n\nnamespace vernier::{} {{\n", space) +
         "void flat([[maybe_unused]] const double* channel, double* deviation);\n"
         "void flat([[maybe_unused]] const double* channel, double* deviation) {\n" +
         printer.body + results + fmt::format("}}\n}}  // namespace vernier::{}\n", space);
}

}  // namespace vernier::bench
