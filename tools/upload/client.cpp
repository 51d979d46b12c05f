// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/upload/client.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <cstring>
#include <thread>

#include "comp/probing/latch.h"
#include "comp/probing/touch_filter.h"
#include "firmware/core/link/gate.h"
#include "firmware/core/link/uploader.h"
#include "tools/maths/factors.h"
#include "tools/text/error.h"
#include "tools/text/words.h"

namespace vernier::upload {
namespace {

constexpr double kNmPerMm = 1e6, kCountsPerDeg = static_cast<double>(kTurnCounts) / 360;
constexpr std::uint32_t kPieceBytes = kMaxRequestBytes - kRequestHeaderBytes - 4;
constexpr std::uint32_t kReadBytes = 232;  // a reply of the link holds them (tables/link_messages.h)
constexpr int kTriesWhileNotReady = 300;   // five seconds: a medium may be slow
constexpr auto kLongestRequest = std::chrono::seconds(30);  // with all its tries

void append(std::vector<std::uint8_t>& bytes, const void* from, std::size_t size) {
  const std::size_t before = bytes.size();
  bytes.resize(before + size);
  if (size > 0) std::memcpy(bytes.data() + before, from, size);
}

template <class T>
void put(std::vector<std::uint8_t>& bytes, const T& value) {
  append(bytes, &value, sizeof(T));
}

template <class T>
T get(const std::vector<std::uint8_t>& bytes, std::size_t offset) {
  T value{};
  if (offset > bytes.size() || sizeof(T) > bytes.size() - offset)
    throw text::InputError("the board's reply is too short");
  std::memcpy(&value, bytes.data() + offset, sizeof(T));
  return value;
}

// A name of a fixed length, which a zero may end.
std::string shown_name(const char* bytes, std::size_t most) {
  return text::printable({bytes, strnlen(bytes, most)});
}

[[noreturn]] void refused(const std::vector<std::uint8_t>& payload) {
  UploadResult result;
  const auto fault = get<std::uint8_t>(payload, 0), image = get<std::uint8_t>(payload, 1),
             binding = get<std::uint8_t>(payload, 2);
  if (fault >= kUploadFaultCount) throw text::LimitNotMet("the board refuses: unknown reason");
  result.fault = static_cast<UploadFault>(fault);
  result.image = static_cast<ImageFault>(image);
  result.bind = static_cast<BindFault>(binding);
  for (std::size_t i = 3; i < payload.size(); ++i) result.offender.add(static_cast<char>(payload[i]));
  throw text::LimitNotMet("the board refuses: " + text::printable(describe(result).c_str()));
}

}  // namespace

std::vector<std::uint8_t> Client::ask_once(const std::vector<std::uint8_t>& request) {
  const std::vector<std::uint8_t> reply = transport_->ask(request);
  if (reply.size() < kReplyHeaderBytes || reply[0] != request[0] || reply[1] != request[1])
    throw text::InputError("the board's reply does not belong to the request");
  return reply;
}

// Signed where the board wants that and there is a key: over its nonce and the next counter.
std::vector<std::uint8_t> Client::request_of(LinkOp op, const std::vector<std::uint8_t>& payload) {
  std::vector<std::uint8_t> request;
  if (!key_ || info_.hello.has_key == 0 || !signature_needed(op)) {
    put(request, static_cast<std::uint8_t>(op));
    put(request, ++sequence_);
    append(request, payload.data(), payload.size());
    return request;
  }
  const auto challenge = get<ChallengeReply>(ask(LinkOp::kChallenge), 0);
  require_same_start(challenge);
  SignedRequestHead head{};
  std::memcpy(head.magic, kRequestMagic, sizeof(head.magic));
  std::memcpy(head.nonce, challenge.nonce, sizeof(head.nonce));
  std::memcpy(head.challenge, challenge.challenge, sizeof(head.challenge));
  std::memcpy(head.board, info_.hello.board, sizeof(head.board));
  std::vector<std::uint8_t> rest;
  put(rest, static_cast<std::uint8_t>(op));
  append(rest, payload.data(), payload.size());
  put(request, static_cast<std::uint8_t>(LinkOp::kSigned));
  put(request, ++sequence_);
  put(request, sign_request(*key_, head, rest));
  append(request, rest.data(), rest.size());
  return request;
}

std::vector<std::uint8_t> Client::ask(LinkOp op, const std::vector<std::uint8_t>& payload) {
  const auto end = std::chrono::steady_clock::now() + kLongestRequest;
  for (int attempt = 0;; ++attempt) {
    const std::vector<std::uint8_t> reply = ask_once(request_of(op, payload));
    const std::vector<std::uint8_t> rest(reply.begin() + kReplyHeaderBytes, reply.end());
    switch (static_cast<LinkStatus>(reply[2])) {
      case LinkStatus::kDone:
        return rest;
      case LinkStatus::kRefused:
        refused(rest);
      case LinkStatus::kNotReady:
      case LinkStatus::kStale:  // another client was quicker
        if (attempt >= kTriesWhileNotReady || std::chrono::steady_clock::now() > end)
          throw text::InputError("the board is not ready");
        transport_->pause(std::chrono::milliseconds(attempt < 50 ? 2 : 20));
        continue;
      case LinkStatus::kUnknownOp:
        throw text::InputError("the board does not support this request");
      case LinkStatus::kNotAllowed:
        throw text::LimitNotMet("the board refuses this request over this link (`access` in the board file)");
      case LinkStatus::kUnsigned:
        throw text::LimitNotMet("the board refuses: the request must be signed (--key, or VERNIER_KEY)");
      case LinkStatus::kBadSignature:
        throw text::LimitNotMet("the board refuses: the key has no right for this request");
      case LinkStatus::kNotStored:
        throw text::LimitNotMet(
            "the board executed the request, but could not store the new setting: after a restart the board "
            "may use an older setting. Check the storage medium of the board, and send the request again");
      case LinkStatus::kBadLength:
      case LinkStatus::kBadValue:
        throw text::InputError("the board refuses the request, because the request has a wrong form");
    }
    throw text::InputError("the board's reply has an unknown status");
  }
}

std::optional<IdentifyReply> Client::proof_of(const std::string& name) {
  IdentityHead head{};
  const auto nonce = fresh_nonce();
  std::memcpy(head.magic, kIdentityMagic, sizeof(head.magic));
  std::memcpy(head.asked_nonce, nonce.data(), nonce.size());
  std::memcpy(head.board, name.data(), std::min(name.size(), sizeof(head.board)));
  const std::vector<std::uint8_t> payload(nonce.begin(), nonce.end());
  const auto first = ask_once(request_of(LinkOp::kIdentify, payload));
  if (static_cast<LinkStatus>(first[2]) == LinkStatus::kUnknownOp) return std::nullopt;
  const bool done = static_cast<LinkStatus>(first[2]) == LinkStatus::kDone;
  const auto proof = done ? get<IdentifyReply>(first, kReplyHeaderBytes)
                          : get<IdentifyReply>(ask(LinkOp::kIdentify, payload), 0);
  std::memcpy(head.start_nonce, proof.start_nonce, sizeof(head.start_nonce));
  PublicKey key{};
  std::memcpy(key.data(), proof.key, key.size());
  if (!signature_fits(bytes_of_head(head), {}, proof.signature, key))
    throw text::LimitNotMet("the board's proof of its identity is not valid: its signature is wrong");
  return proof;
}

std::optional<BoardPublicKey> Client::proved_key() {
  const auto proof = proof_of(info_.board);
  if (!proof) return std::nullopt;
  BoardPublicKey key{};
  std::memcpy(key.data(), proof->key, key.size());
  return key;
}

void Client::require_board(const BoardClaim& claim) {
  claim_ = {};
  if (claim.empty()) return;
  read_hello();
  if (!claim.name.empty() && info_.board != claim.name)
    throw text::LimitNotMet(fmt::format("the name of this board is {}, but {} was expected",
                                        info_.board.empty() ? "without a name" : info_.board, claim.name));
  if (claim.key) {
    const auto proof = proof_of(info_.board);
    if (!proof) throw text::LimitNotMet("this board has no key and cannot prove its identity");
    if (std::memcmp(proof->key, claim.key->data(), claim.key->size()) != 0)
      throw text::LimitNotMet("the key of this board differs from the expected key: this is another board");
    std::memcpy(proved_start_.data(), proof->start_nonce, proved_start_.size());
  }
  claim_ = claim;
}

// A signed request is valid only for the start of a board whose nonce it contains.
void Client::require_same_start(const ChallengeReply& challenge) {
  if (!claim_.key || std::memcmp(challenge.nonce, proved_start_.data(), proved_start_.size()) == 0) return;
  require_board(BoardClaim(claim_));
  if (std::memcmp(challenge.nonce, proved_start_.data(), proved_start_.size()) != 0)
    throw text::LimitNotMet("the challenge and the proof of identity came from different boards");
}

Client::Client(std::unique_ptr<Transport> transport) : transport_(std::move(transport)) {
  read_hello();
  const auto name = [this](std::uint8_t kind, std::uint8_t index, std::uint8_t& flags) {
    const auto reply = ask(LinkOp::kName, {kind, index});
    if (reply.size() != kImageNameBytes + 1) throw text::InputError("the board's reply is of the wrong size");
    flags = reply[kImageNameBytes];
    return shown_name(reinterpret_cast<const char*>(reply.data()), kImageNameBytes);
  };
  std::uint8_t flags = 0;
  for (std::uint8_t i = 0; i < info_.hello.axes; ++i) {
    BoardSignal axis;
    axis.name = name(0, i, flags);
    axis.rotary = (flags & kRotary) != 0;
    axis.rollover = (flags & kRollover) != 0;
    info_.axes.push_back(axis);
  }
  for (std::uint8_t i = 0; i < info_.hello.inputs; ++i) info_.inputs.push_back(name(1, i, flags));
}

void Client::read_hello() {
  const auto hello = ask(LinkOp::kHello);
  const auto version = get<std::uint16_t>(hello, 0);
  if (version != kLinkVersion)
    throw text::InputError(
        fmt::format("the board uses version {} of the link, this tool version {}", version, kLinkVersion));
  info_.hello = get<HelloReply>(hello, 0);
  info_.board = shown_name(info_.hello.board, sizeof(info_.hello.board));
  if (info_.hello.axes > kMaxAxes || info_.hello.inputs > kMaxInputs)
    throw text::InputError("the board reports more axes or inputs than possible");
}

std::size_t Client::tick_bytes() const {
  return sizeof(LinkTick) + info_.axes.size() * sizeof(LinkAxis) + info_.inputs.size() * sizeof(LinkInput);
}

BoardTick Client::parse_tick(const std::uint8_t* bytes) const {
  LinkTick head;
  std::memcpy(&head, bytes, sizeof(head));
  bytes += sizeof(head);
  BoardTick tick;
  tick.number = head.number;
  tick.time_s = static_cast<double>(head.time_us) * 1e-6;
  tick.feed_mm_per_min = static_cast<double>(head.feed_nm_per_min) / kNmPerMm;
  tick.mode = static_cast<Mode>(head.mode);
  tick.fault = static_cast<Fault>(head.fault);
  tick.holding = head.holding != 0;
  for (std::size_t i = 0; i < info_.axes.size(); ++i)
    tick.saturated.push_back((head.saturated >> i & 1) != 0);
  for (const BoardSignal& signal : info_.axes) {
    LinkAxis axis;
    std::memcpy(&axis, bytes, sizeof(axis));
    bytes += sizeof(axis);
    const double counts = signal.rotary ? kCountsPerDeg : kNmPerMm;
    tick.position.push_back(static_cast<double>(axis.position) / counts);
    tick.correction.push_back(axis.correction / counts);
    tick.sense.push_back(axis.sense);
  }
  for (std::size_t i = 0; i < info_.inputs.size(); ++i) {
    LinkInput input;
    std::memcpy(&input, bytes, sizeof(input));
    bytes += sizeof(input);
    tick.input.push_back(input.value * 1e-3);
  }
  return tick;
}

const char* name_of(ImageState image) {
  switch (image) {
    case ImageState::kNone:
      return "none";
    case ImageState::kConfirmed:
      return "confirmed";
    case ImageState::kTrial:
      return "on trial";
    case ImageState::kLost:
      return "lost";
  }
  return "unknown";
}

std::string limits_text(std::uint8_t limits) {
  constexpr std::pair<AxisLimitFlag, const char*> kWords[] = {{kAtImageLimit, "at the image's limit"},
                                                              {kAtBoardLimit, "at the board's limit"},
                                                              {kAtOutputLimit, "at the end of the output"},
                                                              {kOnItsWay, "on its way"}};
  std::string text;
  for (const auto& [flag, word] : kWords)
    if ((limits & flag) != 0) text += (text.empty() ? "" : ", ") + std::string(word);
  return text;
}

std::string settings_text(std::uint8_t settings) {
  std::string text;
  if ((settings & kSettingDamaged) != 0)
    text +=
        "DEACTIVATED: a stored setting of the operator was damaged or missing at the start; the weights may "
        "be older. Test the weights and the store of the board, then activate the correction\n";
  if ((settings & kImageRecordDamaged) != 0)
    text +=
        "DEACTIVATED: a record of the images was damaged or missing at the start; the image may be one that "
        "was replaced. Compare the fingerprint, test the store of the board, then upload the image again or "
        "activate the correction\n";
  if ((settings & kSettingRefused) != 0)
    text +=
        "NOT STORED: the store of the board refuses the newest setting of the operator; a start may restore "
        "an older setting. Test the medium of the store\n";
  return text;
}

BoardState Client::state() {
  const auto reply = ask(LinkOp::kState);
  if (reply.size() != sizeof(LinkState) + info_.axes.size() * sizeof(LinkAxisState))
    throw text::InputError("the board's reply is of the wrong size");
  const auto head = get<LinkState>(reply, 0);
  BoardState state;
  state.fingerprint = head.fingerprint;
  state.image = static_cast<ImageState>(head.image);
  state.since_s = static_cast<double>(head.since_us) * 1e-6;
  state.weight = head.weight / 65536.0;
  state.settings = head.settings;
  for (std::size_t i = 0; i < info_.axes.size(); ++i) {
    const auto axis = get<LinkAxisState>(reply, sizeof(LinkState) + i * sizeof(LinkAxisState));
    const double counts = info_.axes[i].rotary ? kCountsPerDeg : kNmPerMm;
    state.axes.push_back({axis.wanted / counts, axis.achieved / counts, axis.weight / 65536.0, axis.limits});
  }
  return state;
}

BoardTick Client::newest() {
  const auto reply = ask(LinkOp::kTick);
  if (reply.size() != tick_bytes()) throw text::InputError("the board's reply is of the wrong size");
  return parse_tick(reply.data());
}

BoardHistory Client::history(std::uint64_t first, std::uint16_t every) {
  std::vector<std::uint8_t> payload;
  put(payload, first);
  put(payload, every);
  const auto reply = ask(LinkOp::kHistory, payload);
  BoardHistory history;
  history.next = get<std::uint64_t>(reply, 0);
  history.lost = get<std::uint16_t>(reply, 8);
  if ((reply.size() - 10) % tick_bytes() != 0)
    throw text::InputError("the board's reply is of the wrong size");
  for (std::size_t at = 10; at < reply.size(); at += tick_bytes())
    history.ticks.push_back(parse_tick(reply.data() + at));
  return history;
}

HealthRecord Client::health() {
  constexpr std::size_t kCounters = sizeof(HealthRecord) / sizeof(std::uint64_t);  // of a health record
  std::uint64_t words[kCounters] = {};
  for (std::size_t have = 0; have < kCounters;) {
    const auto reply = ask(LinkOp::kHealth, {static_cast<std::uint8_t>(have)});
    if (get<std::uint8_t>(reply, 0) != kCounters || reply.size() < 9)
      throw text::InputError(
          "the number of counters of the board differs from the number in this tool; update the tool or the "
          "board");
    for (std::size_t at = 1; at + 8 <= reply.size() && have < kCounters; at += 8)
      words[have++] = get<std::uint64_t>(reply, at);
  }
  HealthRecord record;
  std::memcpy(&record, words, sizeof(record));
  return record;
}

std::string Client::share_name(std::uint16_t index, std::uint32_t programs) {
  std::vector<std::uint8_t> payload;
  put(payload, index);
  put(payload, programs);
  const auto name = get<ShareName>(ask(LinkOp::kShareName, payload), 0);
  return shown_name(name.text, sizeof(name.text));
}

std::vector<BoardShare> Client::shares() {
  std::vector<BoardShare> shares;
  if (health().programs == 0) return shares;
  std::uint16_t count = 0;
  do {
    std::vector<std::uint8_t> payload;
    put(payload, static_cast<std::uint16_t>(shares.size()));
    const auto reply = ask(LinkOp::kShares, payload);
    count = get<std::uint16_t>(reply, 0);
    const auto programs = get<std::uint32_t>(reply, 2);
    if (programs != named_program_) {
      share_names_.clear();
      for (std::uint16_t i = 0; i < count; ++i) share_names_.push_back(share_name(i, programs));
      named_program_ = programs;
    }
    const std::size_t before = shares.size();
    for (std::size_t at = 6; at + sizeof(LinkShare) <= reply.size() && shares.size() < share_names_.size();
         at += sizeof(LinkShare)) {
      const auto share = get<LinkShare>(reply, at);
      if (share.axis >= info_.axes.size())
        throw text::InputError("the board reports a value for an axis that it does not have");
      const double counts = info_.axes[share.axis].rotary ? kCountsPerDeg : kNmPerMm;
      shares.push_back({share.axis, share_names_[shares.size()], share.correction / counts});
    }
    if (shares.size() == before) break;  // no further share came, or the program changed meanwhile
  } while (shares.size() < count);
  return shares;
}

SlotsReply Client::slots() { return get<SlotsReply>(ask(LinkOp::kSlots), 0); }

void Client::upload(const std::vector<std::uint8_t>& bytes, const std::function<void(double)>& progress) {
  std::vector<std::uint8_t> payload;
  put(payload, static_cast<std::uint32_t>(bytes.size()));
  ask(LinkOp::kBegin, payload);
  for (std::size_t at = 0; at < bytes.size(); at += kPieceBytes) {
    payload.clear();
    put(payload, static_cast<std::uint32_t>(at));
    const std::size_t end = std::min<std::size_t>(bytes.size(), at + kPieceBytes);
    append(payload, bytes.data() + at, end - at);
    ask(LinkOp::kData, payload);
    progress(static_cast<double>(end) / static_cast<double>(bytes.size()));
  }
  ask(LinkOp::kFinish);
}

void Client::confirm() { ask(LinkOp::kConfirm); }
void Client::revert() { ask(LinkOp::kRevert); }

std::optional<std::vector<std::uint8_t>> Client::confirmed(const std::function<void(double)>& progress) {
  if (slots().confirmed == kNoSlot) return std::nullopt;
  const auto piece = [this](std::uint32_t offset, std::uint8_t size) {
    std::vector<std::uint8_t> payload;
    put(payload, offset);
    put(payload, size);
    return ask(LinkOp::kRead, payload);
  };
  // Sizes are at the same offset in every version.
  std::vector<std::uint8_t> bytes = piece(0, 16);
  const std::size_t total = std::size_t{get<std::uint32_t>(bytes, offsetof(UploadHeader, header_bytes))} +
                            get<std::uint32_t>(bytes, offsetof(UploadHeader, image_bytes));
  if (total > info_.hello.capacity) throw text::InputError("the board's image is larger than its slot");
  while (bytes.size() < total) {
    const auto size = static_cast<std::uint8_t>(std::min<std::size_t>(kReadBytes, total - bytes.size()));
    const auto more = piece(static_cast<std::uint32_t>(bytes.size()), size);
    if (more.size() != size) throw text::InputError("the board's reply is of the wrong size");
    append(bytes, more.data(), more.size());
    progress(static_cast<double>(bytes.size()) / static_cast<double>(total));
  }
  return bytes;
}

void Client::command(Command command) { ask(LinkOp::kCommand, {static_cast<std::uint8_t>(command)}); }

BoardTouches Client::touches(std::uint64_t first) {
  std::vector<std::uint8_t> payload;
  put(payload, first);
  const auto reply = ask(LinkOp::kTouches, payload);
  BoardTouches out;
  out.next = get<std::uint64_t>(reply, 0);
  out.lost = get<std::uint16_t>(reply, 8);
  const std::size_t touch_bytes = sizeof(LinkTouch) + info_.axes.size() * sizeof(LinkTouchAxis);
  if ((reply.size() - 10) % touch_bytes != 0)
    throw text::InputError("the board's reply is of the wrong size");
  for (std::size_t at = 10; at < reply.size(); at += touch_bytes) {
    const auto head = get<LinkTouch>(reply, at);
    BoardTouch touch;
    touch.number = head.number;
    touch.time_s = static_cast<double>(head.time_ns) * 1e-9;
    touch.has_position = static_cast<LatchFault>(head.fault) == LatchFault::kNone &&
                         static_cast<TouchKind>(head.kind) != TouchKind::kMissed;
    touch.totals = {head.lost_edges, head.lost_touches, head.spikes, head.missing};
    touch.bounces = head.bounces;
    for (std::size_t i = 0; i < info_.axes.size(); ++i) {
      const auto axis = get<LinkTouchAxis>(reply, at + sizeof(LinkTouch) + i * sizeof(LinkTouchAxis));
      const double counts = info_.axes[i].rotary ? kCountsPerDeg : kNmPerMm;
      touch.position.push_back(static_cast<double>(axis.position) / counts);
      touch.compensated.push_back(static_cast<double>(axis.compensated) / counts);
      touch.uncertainty.push_back(axis.uncertainty / counts);
    }
    if ((head.flags & kTouchInWorkpiece) != 0) {
      touch.workpiece.emplace();
      for (std::size_t i = 0; i < 3; ++i)
        (*touch.workpiece)[i] = static_cast<double>(head.workpiece_nm[i]) / kNmPerMm;
    }
    out.touches.push_back(std::move(touch));
  }
  return out;
}

void Client::workpiece(const std::array<double, 3>& origin_mm, double angle_deg) {
  constexpr double kMostMm = 1e8;  // of a register: 100 km
  WorkpieceFrame frame;
  for (std::size_t i = 0; i < 3; ++i) {
    if (!(std::abs(origin_mm[i]) < kMostMm))
      throw text::InputError("the position of the workpiece is beyond 100 km");
    frame.origin[i] = PositionNm(std::llround(origin_mm[i] * kNmPerMm));
  }
  if (!std::isfinite(angle_deg)) throw text::InputError("the angle of the workpiece is not a number");
  frame.cosine =
      static_cast<std::int32_t>(std::lround(std::cos(angle_deg * maths::kRadPerDeg) * WorkpieceFrame::kOne));
  frame.sine =
      static_cast<std::int32_t>(std::lround(std::sin(angle_deg * maths::kRadPerDeg) * WorkpieceFrame::kOne));
  std::vector<std::uint8_t> payload;
  put(payload, frame);
  ask(LinkOp::kWorkpiece, payload);
}

void Client::weight(std::uint8_t axis, double share) {
  std::vector<std::uint8_t> payload = {axis};
  put(payload, static_cast<std::uint32_t>(std::lround(share * kFullWeight.count)));
  ask(LinkOp::kWeight, payload);
}

}  // namespace vernier::upload
