// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "firmware/core/cycle/exchange.h"
#include "firmware/core/link/uploader.h"
#include "tables/link_format.h"

namespace vernier {

/// Answers the requests of tables/link_format.h over any medium. A link runs outside the tick. A link checks
/// each byte of a request before it uses the byte.
class Link {
 public:
  /// All arguments must exist longer than the link. `identity`: identity of the board, which HelloReply
  /// contains. Not real-time safe.
  Link(Exchange& exchange, Uploader& uploader, const Wiring& wiring, TimeUs tick,
       const BoardIdentity& identity);

  /// Answers one request. `request`: any bytes; `reply`: memory for kMaxReplyBytes bytes. answer() returns
  /// the number of bytes in the reply; 0 if the request is too short for an answer. `now`: time of the clock
  /// that the uploader uses. Not real-time safe.
  std::uint32_t answer(const std::uint8_t* request, std::uint32_t size, std::uint8_t* reply, TimeUs now);

  /// True if the board must access the medium (storage) to execute the request. For a request that needs the
  /// medium, the store answers and may wait. Not real-time safe.
  static bool needs_store(const std::uint8_t* request, std::uint32_t size) noexcept;
  /// True if the request is for the store or is a step of an upload, or if a signed request may contain such
  /// a request. While the store works on a request, may_need_store() returns false. Not real-time safe.
  static bool may_need_store(const std::uint8_t* request, std::uint32_t size) noexcept;
  /// True if the request changes a setting that the board restores at its next start. Not real-time safe.
  static bool is_setting(const std::uint8_t* request, std::uint32_t size) noexcept;
  /// Writes the reply "ask again" (kNotReady). The board sends it if a request arrives while the store is
  /// busy. Not real-time safe.
  static std::uint32_t answer_busy(const std::uint8_t* request, std::uint8_t* reply) noexcept {
    return answer_with(LinkStatus::kNotReady, request, reply);
  }
  /// Writes a reply that contains only a status. `request`: at least two bytes. Not real-time safe.
  static std::uint32_t answer_with(LinkStatus status, const std::uint8_t* request,
                                   std::uint8_t* reply) noexcept;

  /// Writes mode, positions, corrections and inputs into the registers of a Modbus master that does not use
  /// the messages of the link. `values`: kLiveRegisters values. Not real-time safe.
  void fill_registers(std::uint16_t* values);
  /// Executes a command from a Modbus master that uses only registers. The command is refused if the number
  /// is not a command, or if the tick has not executed the previous command. Not real-time safe.
  LinkStatus give(std::uint8_t command);

 private:
  class Reader;
  class Writer;
  LinkStatus run(LinkOp op, Reader& in, Writer& out, TimeUs now);
  LinkStatus hello(Writer& out) const;
  LinkStatus name(Reader& in, Writer& out) const;
  LinkStatus newest(Writer& out) const;
  LinkStatus history(Reader& in, Writer& out) const;
  LinkStatus health(Reader& in, Writer& out) const;
  LinkStatus slots(Writer& out, TimeUs now) const;
  LinkStatus read(Reader& in, Writer& out);
  LinkStatus weight(Reader& in);
  /// The program that the tick executes.
  struct Running {
    std::uint64_t fingerprint = 0;
    ImageState image = ImageState::kNone;
  };
  Running running(const LoadedProgram* program) const;
  LinkStatus state(Writer& out);
  std::uint32_t setting_flags() const noexcept;
  void fill_state(std::uint16_t* values, const TickRecord& tick);
  LinkStatus shares(Reader& in, Writer& out);
  bool work_out_shares(const LoadedProgram& program);
  LinkStatus share_name(Reader& in, Writer& out);
  LinkStatus touches(Reader& in, Writer& out) const;
  LinkStatus workpiece(Reader& in);
  LinkStatus upload(LinkOp op, Reader& in, Writer& out);
  bool put_touch(Writer& out, std::uint64_t number, const TouchRecord& touch) const;
  bool put_tick(Writer& out, std::uint64_t number, const TickRecord& tick) const;

  Exchange& exchange_;
  Uploader& uploader_;
  const Wiring& wiring_;
  TimeUs tick_;
  const BoardIdentity& identity_;
  // Memory for the shares of the effects, which are computed on request.
  EquationRecord equation_;
  std::int32_t registers_[kMaxRegisters];
  Correction shares_[kMaxShares];
};

}  // namespace vernier
