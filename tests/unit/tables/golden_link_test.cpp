// SPDX-License-Identifier: GPL-3.0-or-later
// Every message of the link, request and reply, byte for byte: tests/golden/link_v3.txt.
#include <gtest/gtest.h>
#include <sodium.h>

#include <array>
#include <cstring>

#include "comp/probing/latch.h"
#include "comp/probing/touch_filter.h"
#include "firmware/core/link/gate.h"
#include "firmware/core/link/link.h"
#include "firmware/core/link/signature.h"
#include "hal/sim/sim_slot_store.h"
#include "tests/unit/tables/golden_listing.h"
#include "tests/unit/tables/golden_machine.h"

namespace vernier::golden {

using namespace vernier::upload;
namespace {

using Bytes = std::vector<std::uint8_t>;

template <class T>
Bytes bytes_of(const T& value) {
  Bytes bytes(sizeof(T));
  std::memcpy(bytes.data(), &value, sizeof(T));
  return bytes;
}

Bytes operator+(Bytes a, const Bytes& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

// A value for each word, so that two which change places show.
TickRecord tick_record() {
  TickRecord tick;
  tick.time_us = 0x0102030405060708;
  tick.feed_nm_per_min = 0x1112131415161718;
  for (std::uint8_t i = 0; i < 3; ++i) {
    tick.position[i] = 0x2122232425262700 + i;
    tick.correction[i] = 0x31323300 + i;
    tick.sense[i] = static_cast<std::int8_t>(i - 1);
  }
  tick.input[0] = 0x41424344;
  tick.mode = static_cast<std::uint8_t>(Mode::kActive);
  tick.fault = static_cast<std::uint8_t>(Fault::kOverrun);
  tick.holding = 1;
  return tick;
}

HealthRecord health_record() {
  HealthRecord h;
  h.ticks = 0x100, h.active_ticks = 0x101, h.overruns = 0x102, h.skipped = 0x103;
  h.missing_readings = 0x104, h.missing_inputs = 0x105, h.frozen_readings = 0x106, h.jumps = 0x107;
  h.unreferenced = 0x108, h.implausible = 0x109, h.failed_writes = 0x10a;
  h.saturated = 0x10b, h.slewing = 0x10c, h.beyond_range = 0x10d;
  h.faults = 0x10e, h.refused_commands = 0x10f, h.programs = 1;
  for (int i = 0; i < 4; ++i) h.latency_ns[i] = 0x200 + i, h.execution_ns[i] = 0x300 + i;
  return h;
}

TouchRecord touch_record() {
  TouchRecord touch;
  touch.time_ns = 0x0102030405060708;
  for (std::uint8_t i = 0; i < 3; ++i) {
    touch.position[i] = 0x2122232425262700 + i;
    touch.compensated[i] = 0x3132333435363700 + i;
    touch.uncertainty[i] = 0x41424300 + i;
    touch.workpiece_nm[i] = 0x5152535455565700 + i;
  }
  touch.lost_edges = 0x61, touch.lost_touches = 0x62, touch.spikes = 0x63, touch.missing = 0x64;
  touch.kind = static_cast<std::uint8_t>(TouchKind::kReleaseMissing);
  touch.fault = static_cast<std::uint8_t>(LatchFault::kUneven);
  touch.flags = kTouchInWorkpiece;
  touch.bounces = 7;
  return touch;
}

/// A key of the board that is the same in every run.
class GoldenIdentity : public IdentityKey {
 public:
  const std::uint8_t* public_half() const noexcept override { return public_.data(); }
  HalFault sign(const std::uint8_t* message, std::uint32_t size, std::uint8_t* signature) noexcept override {
    crypto_sign_state state;
    crypto_sign_init(&state);
    crypto_sign_update(&state, message, size);
    return crypto_sign_final_create(&state, signature, nullptr, key_.secret.data()) == 0 ? HalFault::kNone
                                                                                         : HalFault::kRefused;
  }

 private:
  SigningKey key_ = golden_key();
  std::array<std::uint8_t, kPublicKeyBytes> public_ = key_.public_part();
};

/// A board of the golden machine that stands still, with everything published that can be asked for.
class Board {
 public:
  Board() {
    exchange_->ticks.add(tick_record());
    exchange_->ticks.add(tick_record());
    exchange_->health.publish(health_record());
    exchange_->touches.add(touch_record());
    StateRecord state;
    state.since_us = 0x0102030405060708, state.programs = 1, state.weight = 0x8000;
    for (std::uint8_t i = 0; i < 3; ++i) {
      state.wanted[i] = 0x51525300 + i, state.achieved[i] = 0x61626300 + i, state.axis_weight[i] = 0x10000;
      state.limits[i] = static_cast<std::uint8_t>(1u << i);
    }
    exchange_->state.publish(state);
    run_the_image();
  }
  /// As the service answers, except that what is not signed is carried out too.
  Bytes ask(const Bytes& request) {
    Bytes reply(kMaxReplyBytes);
    const auto size = static_cast<std::uint32_t>(request.size());
    if (Gate::is_challenge(request.data(), size)) {
      const ChallengeReply challenge = gate_.challenge(LinkAccess::kUpload, Caller{}, TimeUs{});
      reply.resize(Link::answer_with(LinkStatus::kDone, request.data(), reply.data()));
      return reply + bytes_of(challenge);
    }
    if (Gate::is_identify(request.data(), size)) {
      IdentifyReply proof{};
      const LinkStatus status = gate_.identify(request.data(), size, proof);
      reply.resize(Link::answer_with(status, request.data(), reply.data()));
      return status == LinkStatus::kDone ? reply + bytes_of(proof) : reply;
    }
    Gate::Opened opened{LinkStatus::kDone, request.data(), size};
    if (request[0] == static_cast<std::uint8_t>(LinkOp::kSigned))
      opened = gate_.open(request.data(), size, LinkAccess::kUpload, Caller{}, TimeUs{});
    reply.resize(opened.status == LinkStatus::kDone
                     ? link_.answer(opened.request, opened.size, reply.data(), TimeUs(1'000'000))
                     : Link::answer_with(opened.status, request.data(), reply.data()));
    reply[0] = request[0];
    return reply;
  }
  static Nonce nonce() {
    Nonce nonce;
    for (std::uint8_t i = 0; i < nonce.size(); ++i) nonce[i] = static_cast<std::uint8_t>(0xa0 + i);
    return nonce;
  }

 private:
  /// As if a tick had taken it over.
  void run_the_image() {
    ProgramRef program = uploader_.programs().take();
    const auto size = static_cast<std::uint32_t>(8 * image_.words.size());
    std::memcpy(program->image(), image_.words.data(), size);
    ImageWorkspace workspace;
    if (program->view.open(program->image(), image_.view.header().image_bytes, workspace) !=
        ImageFault::kNone)
      throw std::logic_error("image");
    std::destroy_at(&program->bound);
    std::construct_at(&program->bound, program->view);
    for (std::uint32_t i = 0; i < kMaxAxes; ++i) program->axis[i] = i;
    uploader_.programs().run_confirmed(std::move(program));
    uploader_.programs().guard(TimeUs{});
    exchange_->offered.store(nullptr);
    exchange_->retired.store(&before_);
    uploader_.programs().guard(TimeUs{});
    EquationRecord equation;
    equation.programs = 1;
    equation.state.channel_count = image_.view.program().equation.channel_count;
    for (std::uint32_t i = 0; i < equation.state.channel_count; ++i)
      equation.state.channel[i] = static_cast<int>(0x01020300 + 0x100 * i);
    exchange_->equation.publish(equation);
  }

  AlignedImage image_{bytes_in(golden_text("image_v" + std::to_string(kImageFormatVersion) + ".txt"))};
  SimSlotStore store_{1 << 16};
  Wiring wiring_{{{"X"}, {"Y"}, {"C", true, true}}, {"T"}};
  BoardIdentity identity_ = golden_identity();
  std::unique_ptr<Exchange> exchange_ = std::make_unique<Exchange>();
  Uploader uploader_{store_, wiring_, *exchange_, {TimeUs(1000), golden_identity(), TimeUs(60'000'000)}};
  BoundProgram before_;
  GoldenIdentity own_key_;
  Gate gate_{identity_, nonce(), ChallengeSeed{}, &own_key_};
  Link link_{*exchange_, uploader_, wiring_, TimeUs(1000), identity_};
  static BoardIdentity golden_identity() {
    BoardIdentity identity(golden_key().public_part());
    identity.board = "mill-1", identity.board_class = "mill";
    return identity;
  }
};

/// Asks the board and writes both sides down.
class Talk {
 public:
  void say(const std::string& what, LinkOp op, const Bytes& payload, const std::vector<Field>& asked,
           const std::vector<Field>& told) {
    const Bytes request = Bytes{static_cast<std::uint8_t>(op), ++sequence_} + payload;
    std::vector<Field> fields = {{"op", 1}, {"sequence", 1}};
    fields.insert(fields.end(), asked.begin(), asked.end());
    text += "\n# " + what + "\n= asked\n" + listed(request, fields) + "= told\n";
    fields = {{"op", 1}, {"sequence", 1}, {"status", 1}};
    fields.insert(fields.end(), told.begin(), told.end());
    text += listed(board.ask(request), fields);
  }

  Board board;
  std::string text;

 private:
  std::uint8_t sequence_ = 0x80;
};

const std::vector<Field> kTickFields = {{"number", 8},    {"time_us", 8},    {"feed_nm_per_min", 8},
                                        {"mode", 1},      {"fault", 1},      {"holding", 1},
                                        {"saturated", 1}, {"X position", 8}, {"X correction", 4},
                                        {"X sense", 1},   {"Y position", 8}, {"Y correction", 4},
                                        {"Y sense", 1},   {"C position", 8}, {"C correction", 4},
                                        {"C sense", 1},   {"T", 4}};

std::vector<Field> operator+(std::vector<Field> a, const std::vector<Field>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

void talk_of_state(Talk& talk) {
  talk.say("hello", LinkOp::kHello, {}, {},
           {{"link_version", 2},
            {"image_version", 2},
            {"tick_us", 4},
            {"capacity", 4},
            {"axes", 1},
            {"inputs", 1},
            {"has_key", 1},
            {"key", 24},
            {"board", 24},
            {"class", 24}});
  const std::vector<Field> name = {{"kind", 1}, {"index", 1}}, named = {{"name", 24}, {"flags", 1}};
  talk.say("name of an axis", LinkOp::kName, {0, 2}, name, named);
  talk.say("name of an input", LinkOp::kName, {1, 0}, name, named);
  talk.say("newest tick", LinkOp::kTick, {}, {}, kTickFields);
  talk.say("history", LinkOp::kHistory, bytes_of(std::uint64_t{0}) + bytes_of(std::uint16_t{1}),
           {{"first", 8}, {"every", 2}},
           std::vector<Field>{{"next", 8}, {"lost", 2}} + kTickFields + kTickFields);
  talk.say("health", LinkOp::kHealth, {0}, {{"first", 1}},
           {{"counters", 1},
            {"ticks", 8},
            {"active_ticks", 8},
            {"overruns", 8},
            {"skipped", 8},
            {"missing_readings", 8},
            {"missing_inputs", 8},
            {"frozen_readings", 8},
            {"jumps", 8},
            {"unreferenced", 8},
            {"implausible", 8},
            {"failed_writes", 8},
            {"saturated", 8},
            {"slewing", 8},
            {"beyond_range", 8},
            {"faults", 8},
            {"refused_commands", 8},
            {"programs", 8},
            {"latency p50", 8},
            {"latency p99", 8},
            {"latency p99.9", 8},
            {"latency maximum", 8},
            {"execution p50", 8},
            {"execution p99", 8},
            {"execution p99.9", 8},
            {"execution maximum", 8}});
  std::vector<Field> state = {{"fingerprint", 8}, {"since_us", 8}, {"weight", 4},
                              {"image", 1},       {"settings", 1}, {"reserved", 2}};
  for (int i = 0; i < 3; ++i)
    state = state + std::vector<Field>{{"wanted", 4}, {"achieved", 4}, {"weight", 4}, {"limits", 1}};
  talk.say("what runs", LinkOp::kState, {}, {}, state);
  talk.say("command", LinkOp::kCommand, {static_cast<std::uint8_t>(Command::kHold)}, {{"command", 1}}, {});
  talk.say("weight", LinkOp::kWeight, Bytes{1} + bytes_of(std::uint32_t{0x8000}),
           {{"axis", 1}, {"weight", 4}}, {});
}

const std::vector<Field> kRefusal = {{"upload fault", 1}, {"image fault", 1}, {"bind fault", 1}};
const std::vector<Field> kSlots = {{"confirmed_fingerprint", 8},
                                   {"trial_fingerprint", 8},
                                   {"issued", 8},
                                   {"newest_issued", 8},
                                   {"security", 4},
                                   {"trial_left_ms", 4},
                                   {"confirmed", 1},
                                   {"trial", 1},
                                   {"reserved", 6}};

void talk_of_signatures(Talk& talk) {
  talk.say("challenge", LinkOp::kChallenge, {}, {},
           {{"nonce", 16}, {"challenge", 16}, {"access", 1}, {"keys", 1}, {"reserved", 2}});
  SignedRequestHead head{};
  std::memcpy(head.magic, kRequestMagic, sizeof(head.magic));
  std::memcpy(head.nonce, Board::nonce().data(), sizeof(head.nonce));
  // Computed again beside the gate: SHA-512 of the seed (zeros), the nonce and the number 1.
  Bytes hashed(sizeof(ChallengeSeed) + sizeof(head.nonce) + 8), digest(crypto_hash_sha512_BYTES);
  std::memcpy(hashed.data() + sizeof(ChallengeSeed), head.nonce, sizeof(head.nonce));
  hashed[sizeof(ChallengeSeed) + sizeof(head.nonce)] = 1;
  crypto_hash_sha512(digest.data(), hashed.data(), hashed.size());
  std::memcpy(head.challenge, digest.data(), sizeof(head.challenge));
  std::memcpy(head.board, "mill-1", 6);
  const Bytes rest =
      Bytes{static_cast<std::uint8_t>(LinkOp::kWeight)} + Bytes{2} + bytes_of(std::uint32_t{0x4000});
  const std::vector<Field> fields = {{"key", 8},       {"challenge", 16}, {"signature", 64},
                                     {"weight op", 1}, {"axis", 1},       {"weight", 4}};
  const Bytes request = bytes_of(sign_request(golden_key(), head, rest)) + rest;
  talk.say("a signed weight", LinkOp::kSigned, request, fields, {});
  talk.say("the same once more", LinkOp::kSigned, request, fields, {});
}

/// What a board signs with its own key; the same bytes are checked as the asker checks them.
void talk_of_identity(Talk& talk) {
  Bytes nonce;
  for (int i = 0; i < 32; ++i) nonce.push_back(static_cast<std::uint8_t>(0xc0 + i));
  talk.say("who the board is, proved", LinkOp::kIdentify, nonce, {{"nonce", 32}},
           {{"start nonce", 16}, {"key", 32}, {"signature", 64}});
  const Bytes reply = talk.board.ask(Bytes{static_cast<std::uint8_t>(LinkOp::kIdentify), 0} + nonce);
  IdentifyReply proof;
  ASSERT_EQ(reply.size(), kReplyHeaderBytes + sizeof(proof));
  std::memcpy(&proof, reply.data() + kReplyHeaderBytes, sizeof(proof));
  IdentityHead head{};
  std::memcpy(head.magic, kIdentityMagic, sizeof(head.magic));
  std::memcpy(head.asked_nonce, nonce.data(), nonce.size());
  std::memcpy(head.start_nonce, Board::nonce().data(), sizeof(head.start_nonce));
  std::memcpy(head.board, "mill-1", 6);
  EXPECT_TRUE(signature_fits(bytes_of_head(head), {}, proof.signature, golden_key().public_part()));
  head.asked_nonce[0] ^= 1;
  EXPECT_FALSE(signature_fits(bytes_of_head(head), {}, proof.signature, golden_key().public_part()));
  talk.say("who the board is, without a nonce", LinkOp::kIdentify, {}, {}, {});
}

void talk_of_upload(Talk& talk) {
  const Bytes image = bytes_in(golden_text("image_v" + std::to_string(kImageFormatVersion) + ".txt"));
  const Bytes upload = make_upload(image, golden_key(), 0x0002030405060708, 5, "mill-1");
  const auto size = bytes_of(static_cast<std::uint32_t>(upload.size()));
  talk.say("begin of an upload", LinkOp::kBegin, size, {{"bytes", 4}}, {});
  constexpr std::uint32_t kPiece = 64;
  talk.say("data", LinkOp::kData, bytes_of(std::uint32_t{0}) + Bytes(upload.begin(), upload.begin() + kPiece),
           {{"offset", 4}, {"bytes", kPiece}}, {});
  for (std::uint32_t at = kPiece; at < upload.size(); at += kPiece) {
    const auto end = std::min<std::size_t>(upload.size(), at + kPiece);
    const Bytes reply =
        talk.board.ask(Bytes{static_cast<std::uint8_t>(LinkOp::kData), 0} + bytes_of(at) +
                       Bytes(upload.begin() + at, upload.begin() + static_cast<std::ptrdiff_t>(end)));
    ASSERT_EQ(reply.at(2), 0);
  }
  talk.say("end of the upload", LinkOp::kFinish, {}, {}, {});
  talk.say("slots", LinkOp::kSlots, {}, {}, kSlots);
  talk.say("an upload while one is on trial", LinkOp::kBegin, size, {{"bytes", 4}}, kRefusal);
  talk.say("confirm", LinkOp::kConfirm, {}, {}, {});
  talk.say("revert, without a trial", LinkOp::kRevert, {}, {}, kRefusal);
  talk.say("slots after it", LinkOp::kSlots, {}, {}, kSlots);
  talk.say("read of the confirmed upload", LinkOp::kRead, bytes_of(std::uint32_t{8}) + Bytes{16},
           {{"offset", 4}, {"size", 1}}, {{"bytes", 16}});
  talk.say("end without an upload", LinkOp::kFinish, {}, {}, kRefusal);
}

void talk_of_effects_and_touches(Talk& talk, std::size_t shares) {
  std::vector<Field> told = {{"shares", 2}, {"programs", 4}};
  for (std::size_t i = 0; i < shares; ++i) told = told + std::vector<Field>{{"axis", 1}, {"correction", 4}};
  talk.say("what the effects add", LinkOp::kShares, bytes_of(std::uint16_t{0}), {{"first", 2}}, told);
  talk.say("name of a share", LinkOp::kShareName, bytes_of(std::uint16_t{1}) + bytes_of(std::uint32_t{1}),
           {{"share", 2}, {"programs", 4}}, {{"name", 64}});
  std::vector<Field> touch = {{"next", 8},         {"lost", 2},        {"number", 8},      {"time_ns", 8},
                              {"workpiece X", 8},  {"workpiece Y", 8}, {"workpiece Z", 8}, {"lost_edges", 4},
                              {"lost_touches", 4}, {"spikes", 4},      {"missing", 4},     {"kind", 1},
                              {"fault", 1},        {"flags", 1},       {"bounces", 1}};
  for (int i = 0; i < 3; ++i)
    touch = touch + std::vector<Field>{{"position", 8}, {"compensated", 8}, {"uncertainty", 4}};
  talk.say("touches", LinkOp::kTouches, bytes_of(std::uint64_t{0}), {{"first", 8}}, touch);
  WorkpieceFrame frame;
  for (int i = 0; i < 3; ++i) frame.origin[i] = PositionNm(0x0102030405060 + i);
  frame.cosine = 0, frame.sine = WorkpieceFrame::kOne;
  talk.say("workpiece", LinkOp::kWorkpiece, bytes_of(frame),
           {{"origin X", 8}, {"origin Y", 8}, {"origin Z", 8}, {"cosine", 4}, {"sine", 4}}, {});
}

TEST(GoldenBytes, EveryMessageOfTheLinkIsAsBefore) {
  Talk talk;
  talk.text = "# link, version " + std::to_string(kLinkVersion) + "\n";
  talk_of_state(talk);
  talk_of_signatures(talk);
  talk_of_upload(talk);
  const AlignedImage image(bytes_in(golden_text("image_v" + std::to_string(kImageFormatVersion) + ".txt")));
  talk_of_effects_and_touches(talk, image.view.shares().shares.size);
  talk.say("an operation that there is not", static_cast<LinkOp>(kLinkOpCount), {}, {}, {});
  talk.say("a request that is too long", LinkOp::kHello, {0}, {{"too much", 1}}, {});
  talk.say("an axis that there is not", LinkOp::kName, {0, 3}, {{"kind", 1}, {"index", 1}}, {});
  talk.say("a second command before the first was taken", LinkOp::kCommand, {1}, {{"command", 1}}, {});
  talk_of_identity(talk);
  // Every operation has been asked for.
  for (int op = 1; op < kLinkOpCount; ++op) {
    char begin[32];
    std::snprintf(begin, sizeof(begin), "= asked\n%02x  # op", static_cast<unsigned>(op));
    EXPECT_NE(talk.text.find(begin), std::string::npos) << op;
  }
  expect_golden("link_v" + std::to_string(kLinkVersion) + ".txt", talk.text);
}

}  // namespace
}  // namespace vernier::golden
