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

/// An axis or an input of a board, with the name that the board reports.
struct BoardSignal {
  std::string name;
  bool rotary = false, rollover = false;
};

/// Properties of a board (name, axes, inputs) that the board itself reports.
struct BoardInfo {
  HelloReply hello;
  std::string board;  // name of the board; empty: the board has no name
  std::vector<BoardSignal> axes;
  std::vector<std::string> inputs;
};

/// Data of one control tick that the board reported, in the units of the machine file: positions and
/// corrections in mm or deg, inputs in their own units.
struct BoardTick {
  std::uint64_t number = 0;
  double time_s = 0, feed_mm_per_min = 0;
  Mode mode = Mode::kBoot;
  Fault fault = Fault::kNone;
  bool holding = false;
  std::vector<bool> saturated;  // by axis; true: the correction of the axis is held at a limit
  std::vector<double> position, correction, input;
  std::vector<int> sense;
};

/// The requested control ticks of a board, and the number of earlier ticks that the board has already
/// overwritten.
struct BoardHistory {
  std::vector<BoardTick> ticks;
  std::uint64_t next = 0;
  std::uint32_t lost = 0;
};

/// The correction that the board computes for each axis, and the part of the correction that is applied; mm
/// or deg.
struct BoardState {
  std::uint64_t fingerprint = 0;  // fingerprint of the running correction image; 0: no image is running
  ImageState image = ImageState::kNone;
  double since_s = 0;  // time t of the board at which the running image became active
  double weight = 0;   // share of all corrections that is applied, 0..1
  struct Axis {
    double wanted = 0, achieved = 0, weight = 0;
    std::uint8_t limits = 0;  // flags of the type AxisLimitFlag
  };
  std::vector<Axis> axes;
  std::uint8_t settings = 0;  // flags of the type SettingFlag
};
/// Returns messages for the user about the operator's settings that the board has not stored, one line for
/// each flag. The text is empty if the board has stored all settings of the operator.
std::string settings_text(std::uint8_t settings);
/// Returns the state of a correction image as a word: "confirmed", "on trial", "lost" or "none". limits_text
/// returns the active limits of an axis, "at the image's limit, on its way", or an empty text.
const char* name_of(ImageState image);
std::string limits_text(std::uint8_t limits);

/// Present contribution of one effect or table to the correction of an axis, before limits and ramps are
/// applied; mm or deg.
struct BoardShare {
  std::size_t axis = 0;
  std::string name;
  double correction = 0;
};

/// Numbers of lost and rejected events at the signal of the touch probe, counted by the board until a touch.
struct TouchTotals {
  std::uint32_t lost_edges = 0, lost_touches = 0, spikes = 0, missing = 0;
};

/// A touch of the probe that the board reported; positions in mm or deg.
struct BoardTouch {
  std::uint64_t number = 0;
  double time_s = 0;
  bool has_position = false;  // false: an edge of the probe signal or the position samples near it were lost;
                              // the fields below `totals` are not valid
  TouchTotals totals;
  int bounces = 0;
  std::vector<double> position, compensated, uncertainty;  // one value per axis
  std::optional<std::array<double, 3>> workpiece;          // compensated position in workpiece coordinates,
                                                           // X, Y, Z, mm
};

/// The requested touches of a board, and the number of earlier touches that the board has already
/// overwritten.
struct BoardTouches {
  std::vector<BoardTouch> touches;
  std::uint64_t next = 0;
  std::uint32_t lost = 0;
};

/// Identity that a board must have. If the name is empty and there is no key, every board is accepted.
struct BoardClaim {
  std::string name;                   // name of the board in its board file
  std::optional<BoardPublicKey> key;  // public key of the board
  bool empty() const { return name.empty() && !key; }
};

/// Client of a board: sends requests to the board and reads its replies. Each function of Client throws
/// InputError if the board gives no valid reply, and LimitNotMet with the board's reason if the board refuses
/// the request.
class Client {
 public:
  explicit Client(std::unique_ptr<Transport> transport);
  /// Sets the key that signs all later requests that need a signature; without a key no request is signed.
  void sign_with(const std::optional<SigningKey>& key) { key_ = key; }

  /// Asks the board for its identity and compares the identity with the claim. If the claim has a key, the
  /// board must sign a new random nonce and its name with this key. After a proof by key, signed requests are
  /// valid only for this board, and only until the board is restarted. A board that was restarted after its
  /// proof must prove its identity again before it accepts a signed request. If the claim has no key, only
  /// the name of the board is compared. Throws LimitNotMet if the board has another identity or cannot prove
  /// its identity.
  void require_board(const BoardClaim& claim);
  /// Returns the public key of the board after the board has signed a new random nonce with its key;
  /// `nullopt` if the board has no key.
  std::optional<BoardPublicKey> proved_key();

  const BoardInfo& info() const { return info_; }
  BoardTick newest();
  BoardState state();
  /// Returns the stored control ticks of the board from number `first` on, only each `every`th tick.
  BoardHistory history(std::uint64_t first, std::uint16_t every);
  HealthRecord health();
  /// Returns the contributions of the effects and tables of the running correction program. The list is empty
  /// if no program is running, or if the program was exchanged during the request.
  std::vector<BoardShare> shares();
  SlotsReply slots();
  /// Sends an upload to the board, which checks it (format: tables/upload_format.h). When upload() returns,
  /// the board uses the new correction image on trial. progress: function that gets the transmitted share,
  /// 0..1.
  void upload(const std::vector<std::uint8_t>& bytes, const std::function<void(double)>& progress);
  void confirm();
  void revert();
  /// Returns the confirmed upload of the board (header and correction image), or nullopt if no image is
  /// confirmed.
  std::optional<std::vector<std::uint8_t>> confirmed(const std::function<void(double)>& progress);
  /// Sends a command, which the board executes in its next control tick. The mode and the counter
  /// `refused_commands` of the board show whether the board accepted the command.
  void command(Command command);
  void weight(std::uint8_t axis, double share);
  /// Returns the touches from number `first` on, as many as one reply of the board can contain. The list of
  /// touches is empty if the board has had no touch with the number `first` or a later number.
  BoardTouches touches(std::uint64_t first);
  /// Sets the location of the workpiece: origin in machine coordinates in mm, angle about Z in deg. The
  /// location of the workpiece applies to later touches.
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
  /// Nonce of the board's start at which the board proved its identity
  std::array<std::uint8_t, 16> proved_start_{};
  std::uint8_t sequence_ = 0;
  std::uint32_t named_program_ = 0;  // number of the program whose names are in share_names_
  std::vector<std::string> share_names_;
  BoardInfo info_{};
};

}  // namespace vernier::upload
