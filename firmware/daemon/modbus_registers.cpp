// SPDX-License-Identifier: Apache-2.0
#include "firmware/daemon/modbus_registers.h"

#include <arpa/inet.h>
#include <netinet/in.h>

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>
#include <vector>

#include "hal/support/register_block.h"

namespace vernier {
namespace {

constexpr std::uint32_t kFirstMulticastNet = 224;  // first byte of an address; broadcast is above

/// A serial line, or a peer over TCP, under one name for all its spellings.
using Peer = std::string;

/// All addresses of 127.0.0.0/8 are this computer: a server may listen on all of them.
Peer tcp_peer(const SignalSource& source) {
  const std::string& address = modbus_address(source);
  return (address.starts_with("127.") ? "127.0.0.1" : address) + ":" +
         std::to_string(source.whole("port", 502, 1, 65535));
}

int unit_of(const SignalSource& source) { return static_cast<int>(source.whole("unit", 1, 1, 247)); }

/// Registers in use, with both ends.
struct Registers {
  enum class Use { kBlock, kEcho, kReading };
  const SignalSource* source;
  Peer peer;
  int unit;
  Use use;
  std::int64_t first, last;
  std::string block;  // modbus_block() of a block or its echo
};

std::string range(const Registers& one) {
  return one.first == one.last ? "register " + std::to_string(one.first)
                               : "registers " + std::to_string(one.first) + " to " + std::to_string(one.last);
}

const char* use_of(const Registers& one) {
  return one.use == Registers::Use::kBlock ? "block" : one.use == Registers::Use::kEcho ? "echo" : "reading";
}

bool exclude(const Registers& a, const Registers& b) {
  using Use = Registers::Use;
  if (a.peer != b.peer || a.unit != b.unit) return false;
  if (a.last < b.first || b.last < a.first) return false;
  if (a.use == Use::kReading && b.use == Use::kReading) return false;
  // Inside of one block: open_modbus_out() refuses the echo, and all its axes have one echo.
  return a.block != b.block || a.use == Use::kReading || b.use == Use::kReading;
}

class RegisterUses {
 public:
  void add(Registers use) {
    for (const Registers& other : all_)
      if (exclude(other, use))
        use.source->fail(std::string(use_of(use)) + ": " + range(use) + " at " + use.peer + " unit " +
                         std::to_string(use.unit) + " overlaps the " + use_of(other) + " (" + range(other) +
                         ") of " + other.source->where);
    all_.push_back(std::move(use));
  }

 private:
  std::vector<Registers> all_;
};

/// The axes of one block have one connection and one echo: a setting of a further axis that differs would
/// have no effect.
void require_settings_of_first(const SignalSource& first, const SignalSource& source) {
  for (const char* const name : {"echo", "period_ms", "timeout_ms", "baud"})
    if (source.numbers.contains(name) && source.numbers.at(name) != first.number(name, -1))
      source.fail(std::string(name) +
                  ": all axes of one register block need the same value; the value differs from that of " +
                  first.where);
  if (source.texts.contains("parity") && source.text("parity") != first.text("parity", ""))
    source.fail(
        "parity: all axes of one register block need the same value; the value differs from that of " +
        first.where);
}

/// Adds the blocks of the outputs, each with all places of its axes, then the echoes.
void add_outputs(const BoardFile& board, RegisterUses& uses) {
  std::vector<Registers> blocks;
  for (const AxisEntry& axis : board.axes) {
    const SignalSource& source = axis.output;
    if (source.kind != "modbus-out") continue;
    const std::string name = modbus_block(source);
    const std::int64_t first = source.whole("register", 0, 65535),
                       last = first + RegisterBlock::kValues + 1 +
                              2 * source.whole("place", 0, 0, RegisterBlock::kPlaces - 1);
    const auto known =
        std::find_if(blocks.begin(), blocks.end(), [&](const Registers& one) { return one.block == name; });
    if (known == blocks.end()) {
      blocks.push_back(
          {&source, modbus_peer(source), unit_of(source), Registers::Use::kBlock, first, last, name});
      continue;
    }
    require_settings_of_first(*known->source, source);
    known->last = std::max(known->last, last);
  }
  for (const Registers& block : blocks) uses.add(block);
  for (Registers echo : blocks) {
    echo.use = Registers::Use::kEcho;
    echo.first = echo.last = echo.source->whole("echo", 0, 65535);
    uses.add(echo);
  }
}

void add_inputs(const BoardFile& board, RegisterUses& uses) {
  for (const AxisEntry& axis : board.axes) {
    const SignalSource& source = axis.position;
    if (source.kind != "modbus" || source.text("registers", "holding") != "holding") continue;
    const std::int64_t first = source.whole("register", 0, 65534),
                       sequence = source.whole("sequence", 0, 65535);
    for (const auto& [from, to] : {std::pair(first, first + 1), std::pair(sequence, sequence)})
      uses.add({&source, modbus_peer(source), unit_of(source), Registers::Use::kReading, from, to, ""});
  }
  for (const InputEntry& input : board.inputs) {
    const SignalSource& source = input.source;
    if (source.kind != "modbus-tcp" && source.kind != "modbus-rtu") continue;
    const Peer peer = source.kind == "modbus-rtu" ? serial_line(source) : tcp_peer(source);
    if (source.text("registers", "input") != "holding") continue;
    const std::string type = source.text("type", "int16");
    const std::int64_t first = source.whole("register", 0, 65534);
    uses.add({&source, peer, unit_of(source), Registers::Use::kReading, first,
              first + (type == "int32" || type == "float32" ? 1 : 0), ""});
  }
}

/// A block is written and read at all times: a further client, or the board's own server, on its serial line
/// would disturb every exchange. Sensors of one line share it.
void refuse_shared_lines(const BoardFile& board) {
  struct Line {
    const SignalSource* source;
    std::string name, sharing;  // sharing: of the uses that may be on one line together
  };
  std::vector<Line> lines;
  const auto add = [&](const SignalSource& source, const std::string& sharing) {
    const std::string name = serial_line(source);
    for (const Line& other : lines)
      if (other.name == name && (sharing.empty() || other.sharing != sharing))
        source.fail("the serial line " + name + " has another use in " + other.source->where);
    lines.push_back({&source, name, sharing});
  };
  for (const AxisEntry& axis : board.axes)
    if (axis.output.kind == "modbus-out" && is_serial(axis.output))
      add(axis.output, modbus_block(axis.output));
  for (const AxisEntry& axis : board.axes)
    if (axis.position.kind == "modbus" && is_serial(axis.position))
      add(axis.position, "positions " + std::to_string(axis.position.whole("sequence", 0, 65535)));
  for (const InputEntry& input : board.inputs)
    if (input.source.kind == "modbus-rtu") add(input.source, "sensors");
  for (const LinkEntry& link : board.links)
    if (link.source.kind == "modbus-rtu") add(link.source, "");
}

}  // namespace

const std::string& modbus_address(const SignalSource& source) {
  const std::string& address = source.text("address");
  in_addr numeric{};
  if (::inet_pton(AF_INET, address.c_str(), &numeric) != 1)
    source.fail("address: '" + address + "' is not a numeric address, for example 192.168.3.10");
  const std::uint32_t net = ntohl(numeric.s_addr) >> 24;
  if (net == 0 || net >= kFirstMulticastNet)
    source.fail("address: '" + address + "' is not the address of one device");
  return address;
}

std::string listening_address(const SignalSource& source) {
  const std::string address = source.text("address", "127.0.0.1");
  in_addr numeric{};
  if (::inet_pton(AF_INET, address.c_str(), &numeric) != 1)
    source.fail("address: '" + address + "' is not a numeric address, for example 192.168.3.2");
  return address;
}

std::string serial_line(const SignalSource& source) {
  const std::string& device = source.text("device");
  if (device.empty()) source.fail("device is empty");
  std::error_code failed;
  const std::filesystem::path real = std::filesystem::weakly_canonical(device, failed);
  return failed ? device : real.string();
}

std::string modbus_peer(const SignalSource& source) {
  const bool serial = is_serial(source), tcp = source.texts.contains("address");
  if (serial && tcp) source.fail("give device or address, not both");
  return serial ? serial_line(source) : tcp_peer(source);
}

std::string modbus_block(const SignalSource& source) {
  return modbus_peer(source) + " unit " + std::to_string(unit_of(source)) + " register " +
         std::to_string(source.whole("register", 0, 65535));
}

void refuse_shared_registers(const BoardFile& board) {
  RegisterUses uses;
  add_outputs(board, uses);
  add_inputs(board, uses);
  refuse_shared_lines(board);
}

}  // namespace vernier
