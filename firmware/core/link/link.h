// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "firmware/core/cycle/exchange.h"
#include "firmware/core/link/uploader.h"
#include "tables/link_format.h"

namespace vernier {

/// Answers the requests of tables/link_format.h on any medium. A link runs outside the tick; each byte of a
/// request is untrusted until it is checked.
class Link {
 public:
  /// All arguments outlive the link. identity: reported by HelloReply. Not real-time safe.
  Link(Exchange& exchange, Uploader& uploader, const Wiring& wiring, TimeUs tick,
       const BoardIdentity& identity);

  /// Answers one request. request: any bytes; reply: room for kMaxReplyBytes. answer() returns the bytes of
  /// the reply, 0 if the request is too short for an answer. now: time of the uploader's clock. Not real-time
  /// safe.
  std::uint32_t answer(const std::uint8_t* request, std::uint32_t size, std::uint8_t* reply, TimeUs now);

  /// True if the request needs the medium. The store then answers the request and may wait for the medium.
  /// Not real-time safe.
  static bool needs_store(const std::uint8_t* request, std::uint32_t size) noexcept;
  /// True if the request is, or may contain (signed), a request for the store or a step of an upload.
  /// may_need_store() is always false while the store works on a request. Not real-time safe.
  static bool may_need_store(const std::uint8_t* request, std::uint32_t size) noexcept;
  /// True if the request sets something that a start of the board restores. Not real-time safe.
  static bool is_setting(const std::uint8_t* request, std::uint32_t size) noexcept;
  /// The reply "ask again": the board sends this reply if a request arrives while the store is busy. Not
  /// real-time safe.
  static std::uint32_t answer_busy(const std::uint8_t* request, std::uint8_t* reply) noexcept {
    return answer_with(LinkStatus::kNotReady, request, reply);
  }
  /// A reply without payload. request: two bytes at least. Not real-time safe.
  static std::uint32_t answer_with(LinkStatus status, const std::uint8_t* request,
                                   std::uint8_t* reply) noexcept;

  /// The live registers for Modbus masters that use only registers; values: kLiveRegisters. Not real-time
  /// safe.
  void fill_registers(std::uint16_t* values);
  /// Passes on a command of a Modbus master that uses only registers. The command is refused if the number is
  /// not a command, or if the tick has not executed the previous command. Not real-time safe.
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
  /// The program of the tick.
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
  // Memory for the shares, which are computed on request.
  EquationRecord equation_;
  std::int32_t registers_[kMaxRegisters];
  Correction shares_[kMaxShares];
};

}  // namespace vernier
