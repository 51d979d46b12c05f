// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/fuzz/binary_seeds.h"

#include <cstring>

#include "tables/link_format.h"
#include "tables/slots.h"
#include "tools/compile/compile.h"
#include "tools/model/machine_reader.h"
#include "tools/text/files.h"
#include "tools/upload/signing.h"

namespace vernier::fuzz {

using namespace vernier::compile;
using namespace vernier::model;
using namespace vernier::text;
using namespace vernier::upload;
namespace {

template <class T>
std::string raw(const T& value) {
  return {reinterpret_cast<const char*>(&value), sizeof value};
}
std::string byte(int value) { return std::string(1, static_cast<char>(value)); }
std::string piece(const std::string& bytes) { return byte(static_cast<int>(bytes.size())) + bytes; }
std::string request(LinkOp op, const std::string& payload = {}) {
  return piece(byte(static_cast<int>(op)) + byte(1) + payload);
}

std::string image_of(const std::string& text) {
  const auto image = compile_machine(parse_machine(text, "m.xml"), text, {}).image;
  return {image.begin(), image.end()};
}
std::string small_image() {
  return image_of(
      "<machine name=\"small\"><variables><static><k value=\"1e-4\" nominal=\"0\"/><bl value=\"0.004\" "
      "nominal=\"0\" unit=\"mm\"/>"
      "<c value=\"1e-4\" nominal=\"0\"/></static><machineaxes><X min=\"0\" max=\"600\" maxcorrection=\"0.1\" "
      "maxslew=\"0.5\"/>"
      "<Y min=\"0\" max=\"200\" maxcorrection=\"1\" maxslew=\"2\"/></machineaxes>"
      "<inputs><T unit=\"degC\" reference=\"20\"/></inputs></variables><transforms branch=\"tool\">"
      "<sixdof n=\"1\" X=\"X+k*X+bl*dirX\" Y=\"Y+c*Y*(T-20)\"/></transforms></machine>");
}
std::string machine_file(const char* name) {
  return read_file(std::string(VERNIER_SOURCE_DIR) + "/tables/machines/" + name);
}

std::string upload() {
  const std::string image = small_image();
  const SigningKey key{};
  const auto bytes = make_upload({image.begin(), image.end()}, key, 5, 0);
  return {bytes.begin(), bytes.end()};
}

std::string uploading() {
  const std::string bytes = upload();
  std::string session = request(LinkOp::kBegin, raw(static_cast<std::uint32_t>(bytes.size())));
  for (std::size_t at = 0; at < bytes.size(); at += 200)
    session += request(LinkOp::kData, raw(static_cast<std::uint32_t>(at)) + bytes.substr(at, 200));
  return session + request(LinkOp::kFinish);
}

std::string signed_request(LinkOp op, const std::string& payload = {}) {
  return request(LinkOp::kChallenge) +
         request(LinkOp::kSigned, raw(SignedRequest{}) + byte(static_cast<int>(op)) + payload);
}

std::vector<std::string> link_seeds() {
  const std::string first(8, '\0');
  const std::string look = request(LinkOp::kHello) + request(LinkOp::kName, byte(0) + byte(1)) +
                           request(LinkOp::kTick) + request(LinkOp::kHistory, first + byte(1) + byte(0)) +
                           request(LinkOp::kHealth, byte(0)) + request(LinkOp::kSlots) +
                           request(LinkOp::kShares, byte(0) + byte(0)) + request(LinkOp::kState) +
                           request(LinkOp::kTouches, first) +
                           request(LinkOp::kShareName, byte(0) + byte(0) + raw(std::uint32_t{1}));
  const std::string steer = request(LinkOp::kCommand, byte(1)) +
                            request(LinkOp::kWeight, byte(0) + raw(std::uint32_t{30000})) + piece("\x01\x02");
  return {
      byte(2) + look + steer,
      byte(2) + uploading() + request(LinkOp::kConfirm) + look +
          request(LinkOp::kRead, raw(std::uint32_t{0}) + byte(200)) + steer,
      byte(2) + uploading() + request(LinkOp::kRevert) + look,
      byte(6) + uploading() + signed_request(LinkOp::kConfirm) + signed_request(LinkOp::kCommand, byte(1)),
      byte(0) + look + steer,
      byte(6) + steer + signed_request(LinkOp::kRevert)};
}

std::string mbap(const std::string& pdu) {
  const auto size = static_cast<int>(pdu.size() + 1);
  return std::string("\0\1\0\0", 4) + byte(size >> 8) + byte(size) + byte(1) + pdu;
}

std::vector<std::string> modbus_seeds() {
  const std::string mailbox = byte(kMailboxRegister >> 8) + byte(kMailboxRegister & 0xff);
  const std::string write = byte(16) + mailbox + byte(0) + byte(3) + byte(6) + std::string("\0\2\1\1\0\0", 6);
  const std::string read = byte(4) + mailbox + byte(0) + byte(125),
                    live = byte(4) + std::string("\0\0\0\x10", 4);
  const std::string command = byte(6) + std::string("\0\0\0\1", 4),
                    holding = byte(3) + mailbox + byte(0) + byte(4);
  const std::string later = byte(16) + mailbox + byte(0) + byte(2) + byte(4) + std::string("\0\1\xee\0", 4);
  std::string tcp = byte(0), rtu = byte(1);
  for (const std::string& pdu :
       {write, read, live, command, holding, later, read, std::string("\x2b\x0e", 2)}) {
    tcp += piece(mbap(pdu));
    rtu += piece(byte(1) + pdu);
  }
  return {tcp, rtu};
}

std::string reply(const std::string& payload, LinkStatus status = LinkStatus::kDone) {
  return piece(byte(0) + byte(0) + byte(static_cast<int>(status)) + payload);
}

std::vector<std::string> client_seeds() {
  HelloReply hello{};
  hello.link_version = kLinkVersion;
  hello.image_version = static_cast<std::uint16_t>(kImageFormatVersion);
  hello.tick_us = 1000;
  hello.capacity = 8192;
  hello.axes = 1;
  hello.inputs = 1;
  const std::string name = "X" + std::string(kImageNameBytes - 1, '\0') + byte(0);
  const std::string hi = reply(raw(hello)) + reply(name) + reply(name);
  const std::string tick = raw(LinkTick{}) + raw(LinkAxis{}) + raw(LinkInput{});
  std::string counters = byte(28);
  for (int i = 0; i < 28; ++i) counters += raw(std::uint64_t{1});
  const std::string state = reply(raw(LinkState{}) + raw(LinkAxisState{}));
  const std::string shares = reply(std::string("\1\0\1\0\0\0", 6) + raw(LinkShare{}));
  const std::string share_name = reply(std::string(64, 'a'));
  const std::string all =
      hi + reply(tick) + reply(counters) + reply(raw(SlotsReply{})) + shares + share_name + state;
  const std::string next = raw(std::uint64_t{2}) + std::string(2, '\0');
  return {byte(0) + all, byte(4) + all,
          byte(1) + hi + reply(next + tick) + reply(next + raw(LinkTouch{}) + raw(LinkTouchAxis{})),
          byte(2) + hi + reply(raw(SlotsReply{})) + reply(std::string(200, 'x')),
          byte(3) + hi + reply("") + reply("") + reply("") + reply("") + reply("", LinkStatus::kRefused)};
}

}  // namespace

std::vector<std::string> binary_seeds_of(const std::string& target) {
  if (target == "link") return link_seeds();
  if (target == "modbus") return modbus_seeds();
  if (target == "client") return client_seeds();
  if (target == "image")
    return {small_image(), image_of(machine_file("xy_ball_bar.xml")),
            image_of(machine_file("xy_hybrid_mill.xml"))};
  if (target == "serial_frame")
    return {"\xc0hello\xc0\xc0\xdb\xdc\xdb\xdd\xc0", std::string(240, 'a'), std::string("\x01\x01", 2)};
  if (target == "slots") {
    SlotRecord record{kSlotMagic, 1, 2, 0, 2, 0, 0, kNoSlot, 0, 0, 0}, tried = record;
    tried.sequence = 2;
    tried.trial = 1;
    return {byte(1) + raw(record) + byte(1) + raw(tried), byte(0) + raw(record) + byte(1) + raw(record)};
  }
  return {};
}

}  // namespace vernier::fuzz
