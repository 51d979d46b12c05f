// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "comp/probing/workpiece_frame.h"
#include "tables/codes.h"
#include "tables/link_format.h"
#include "tables/records.h"
#include "tables/slots.h"
#include "tools/upload/signing.h"
#include "tools/upload/transport.h"

namespace vernier::upload {

/// An axis or input with the name that the board gives.
struct BoardSignal {
  std::string name;
  bool rotary = false, rollover = false;
};

/// Properties of a board.
struct BoardInfo {
  HelloReply hello;
  std::string board;  // its name; empty: no name
  std::vector<BoardSignal> axes;
  std::vector<std::string> inputs;
};

/// Data of one tick that the board reported, in the units of the machine file: mm or deg, mm or deg, the
/// input's unit.
struct BoardTick {
  std::uint64_t number = 0;
  double time_s = 0, feed_mm_per_min = 0;
  Mode mode = Mode::kBoot;
  Fault fault = Fault::kNone;
  bool holding = false;
  std::vector<bool> saturated;  // by axis: its correction is held at a limit
  std::vector<double> position, correction, input;
  std::vector<int> sense;
};

/// The requested ticks, and the number of earlier ticks that were overwritten.
struct BoardHistory {
  std::vector<BoardTick> ticks;
  std::uint64_t next = 0;
  std::uint32_t lost = 0;
};

/// The correction that the board computes, and the part of it that is applied; mm or deg.
struct BoardState {
  std::uint64_t fingerprint = 0;  // of the running image; 0: no image
  ImageState image = ImageState::kNone;
  double since_s = 0;  // the board's t when it was taken over
  double weight = 0;   // share of every correction that is in
  struct Axis {
    double wanted = 0, achieved = 0, weight = 0;
    std::uint8_t limits = 0;  // AxisLimitFlag
  };
  std::vector<Axis> axes;
  std::uint8_t settings = 0;  // SettingFlag
};
/// Messages for the user about settings of the operator that are not stored, one line for each flag; empty if
/// the settings are stored.
std::string settings_text(std::uint8_t settings);
/// Returns "confirmed", "on trial", "lost" or "none". For limits of an axis: "at the image's limit, on its
/// way" or empty.
const char* name_of(ImageState image);
std::string limits_text(std::uint8_t limits);

/// Present contribution of one effect or table to the correction of an axis, before limits and ramps; mm or
/// deg.
struct BoardShare {
  std::size_t axis = 0;
  std::string name;
  double correction = 0;
};

/// Counters of a board for its probe's line until a touch.
struct TouchTotals {
  std::uint32_t lost_edges = 0, lost_touches = 0, spikes = 0, missing = 0;
};

/// A touch of the probe; mm or deg.
struct BoardTouch {
  std::uint64_t number = 0;
  double time_s = 0;
  bool has_position =
      false;  // false: an edge was lost, or the samples around it; the fields below `totals` are not valid
  TouchTotals totals;
  int bounces = 0;
  std::vector<double> position, compensated, uncertainty;  // by axis
  std::optional<std::array<double, 3>> workpiece;          // X, Y, Z, mm
};

/// The requested touches, and the number of earlier touches that were overwritten.
struct BoardTouches {
  std::vector<BoardTouch> touches;
  std::uint64_t next = 0;
  std::uint32_t lost = 0;
};

/// Required identity of a board; an empty name and no key require nothing.
struct BoardClaim {
  std::string name;                   // in its board file
  std::optional<BoardPublicKey> key;  // of the board's own key pair
  bool empty() const { return name.empty() && !key; }
};

/// Communicates with a board. Every call of Client throws InputError without a valid reply, and LimitNotMet
/// with the board's reason if the board refuses.
class Client {
 public:
  explicit Client(std::unique_ptr<Transport> transport);
  /// After this call, requests that must be signed are signed with this key; without a key no request is
  /// signed.
  void sign_with(const std::optional<SigningKey>& key) { key_ = key; }

  /// Requests the identity of the board. If the claim has a key, the board must sign a fresh nonce and its
  /// name with that key. After this call, every signed request is valid only until the next start of the
  /// board that gave this proof. A board that was restarted meanwhile must prove its identity again first. If
  /// the claim has no key, only the name is compared. Throws LimitNotMet if the board is another board or
  /// cannot prove its identity.
  void require_board(const BoardClaim& claim);
  /// Returns the key of the board after the board signed a fresh nonce with it; `nullopt` if the board has no
  /// key.
  std::optional<BoardPublicKey> proved_key();

  const BoardInfo& info() const { return info_; }
  BoardTick newest();
  BoardState state();
  /// Ticks from number `first`, each `every`th.
  BoardHistory history(std::uint64_t first, std::uint16_t every);
  HealthRecord health();
  /// Returns the shares of the running program; empty without a program, or if the program has just been
  /// exchanged.
  std::vector<BoardShare> shares();
  SlotsReply slots();
  /// Sends an upload (tables/upload_format.h); the board checks it. The upload is on trial when the call
  /// returns. progress: 0..1.
  void upload(const std::vector<std::uint8_t>& bytes, const std::function<void(double)>& progress);
  void confirm();
  void revert();
  /// The confirmed upload, header and image; empty without a confirmed image.
  std::optional<std::vector<std::uint8_t>> confirmed(const std::function<void(double)>& progress);
  /// Sends a command, which the next tick executes. The mode and `refused_commands` show whether the board
  /// accepted the command.
  void command(Command command);
  void weight(std::uint8_t axis, double share);
  /// Returns touches from number `first`, as many as one reply contains; empty if no touch occurred since.
  BoardTouches touches(std::uint64_t first);
  /// Sets the location of the workpiece: origin in machine coordinates, mm; angle about Z, deg. Applies to
  /// later touches.
  void workpiece(const std::array<double, 3>& origin_mm, double angle_deg);

 private:
  std::vector<std::uint8_t> ask(LinkOp op, const std::vector<std::uint8_t>& payload = {});
  void read_hello();
  std::optional<IdentifyReply> proof_of(const std::string& name);
  void require_same_start(const ChallengeReply& challenge);
  std::vector<std::uint8_t> request_of(LinkOp op, const std::vector<std::uint8_t>& payload);
  std::vector<std::uint8_t> ask_once(const std::vector<std::uint8_t>& request);
  std::string share_name(std::uint16_t index, std::uint32_t programs);
  BoardTick parse_tick(const std::uint8_t* bytes) const;
  std::size_t tick_bytes() const;

  std::unique_ptr<Transport> transport_;
  std::optional<SigningKey> key_;
  BoardClaim claim_;
  std::array<std::uint8_t, 16> proved_start_{};  // nonce of the start that proved the claim
  std::uint8_t sequence_ = 0;
  std::uint32_t named_program_ = 0;  // whose share names are kept
  std::vector<std::string> share_names_;
  BoardInfo info_{};
};

}  // namespace vernier::upload
