// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware/core/link/link.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <random>
#include <set>

#include "tests/support/interrupted_write.h"
#include "tests/unit/firmware/upload_rig.h"
#include "tools/text/words.h"
#include "tools/upload/client.h"

namespace vernier::link_test {

using namespace vernier::text;
using namespace vernier::upload;
namespace {

/// A client whose requests go straight into the board's link; between two of them the board ticks.
class Direct : public Transport {
 public:
  Direct(Link& link, UploadRig& rig) : link_(link), rig_(rig) {}
  std::vector<std::uint8_t> ask(const std::vector<std::uint8_t>& request) override {
    std::vector<std::uint8_t> reply(kMaxReplyBytes);
    reply.resize(
        link_.answer(request.data(), static_cast<std::uint32_t>(request.size()), reply.data(), TimeUs(1)));
    rig_.run(2);
    return reply;
  }

 private:
  Link& link_;
  UploadRig& rig_;
};

class LinkTest : public testing::Test {
 protected:
  SigningKey key_ = new_key();
  SimSlotStore store_{1 << 16};
  UploadRig rig_{store_, key_};
  Wiring wiring_{{{"X"}, {"Y"}}, {"T"}};
  BoardIdentity identity_{key_.public_part()};
  Link link_{const_cast<Exchange&>(rig_.service().exchange()), rig_.uploader(), wiring_, TimeUs(1000),
             identity_};
  Client client() { return Client(std::make_unique<Direct>(link_, rig_)); }
};

TEST_F(LinkTest, WholeJourneyOfAnImage) {
  rig_.run(10);
  Client board = client();
  EXPECT_EQ(board.info().axes[1].name, "Y");
  EXPECT_EQ(board.info().inputs[0], "T");
  EXPECT_EQ(board.slots().confirmed, kNoSlot);
  EXPECT_FALSE(board.confirmed([](double) {}).has_value());
  const auto upload = make_upload(small_image_bytes(2e-5), key_, 5, 0);
  double share = 0;
  board.upload(upload, [&](double now) { share = now; });
  EXPECT_EQ(share, 1);
  EXPECT_EQ(board.slots().trial, 0);
  board.confirm();
  EXPECT_EQ(board.slots().confirmed, 0);
  EXPECT_EQ(board.confirmed([](double) {}), upload);
  rig_.run(3000);
  const BoardTick tick = board.newest();
  EXPECT_EQ(tick.mode, Mode::kActive);
  EXPECT_NEAR(tick.correction[1], -1e-4 * tick.position[1], 3e-6);
  EXPECT_NEAR(tick.input[0], 21, 1e-3);
  EXPECT_GT(board.health().active_ticks, 1000u);
  board.command(Command::kDeactivate);
  rig_.run(1000);
  EXPECT_EQ(board.newest().mode, Mode::kReady);
}

TEST(Printable, ReplacesControlsDirectionMarksAndWhatIsNotUtf8) {
  const std::pair<std::string, std::string> kCases[] = {
      {"mill 7/A", "mill 7/A"},
      {"Fr\u00e4se \u2116 7 \U0001f6e0", "Fr\u00e4se \u2116 7 \U0001f6e0"},
      {"\x1b]0;owned\x07", "?]0;owned?"},
      {"a\tb\r\nc\x7f", "a?b??c?"},
      {"\u009b31m", "?31m"},  // a C1 control in UTF-8
      {"\x9b\x33", "?3"},     // and as one byte
      {"\u202egpj.exe", "?gpj.exe"},
      {"\xc0\x9b|\xe0\x80\x9b|\xed\xa0\x80", "??|???|???"},  // too long, a surrogate
      {"\xe2\x82", "??"}};
  for (const auto& [text, shown] : kCases) EXPECT_EQ(printable(text), shown);
}

TEST_F(LinkTest, NamesOfABoardHaveNoControlCharacters) {
  rig_.run(10);
  identity_.board = Name(std::string_view("\x1b[2Jmill"));
  const Wiring wiring{{{"X\x1b[31m"}, {"Y"}}, {"T\x9b\x07"}};
  Link link(const_cast<Exchange&>(rig_.service().exchange()), rig_.uploader(), wiring, TimeUs(1000),
            identity_);
  Client board(std::make_unique<Direct>(link, rig_));
  EXPECT_EQ(board.info().board, "?[2Jmill");
  EXPECT_EQ(board.info().axes[0].name, "X?[31m");
  EXPECT_EQ(board.info().inputs[0], "T??");
}

/// A board that refuses each upload and names what is wrong as it likes.
struct Refuses : Direct {
  using Direct::Direct;
  std::vector<std::uint8_t> ask(const std::vector<std::uint8_t>& request) override {
    if (request[0] != static_cast<std::uint8_t>(LinkOp::kConfirm)) return Direct::ask(request);
    std::vector<std::uint8_t> reply = {request[0],
                                       request[1],
                                       static_cast<std::uint8_t>(LinkStatus::kRefused),
                                       static_cast<std::uint8_t>(UploadFault::kForeignMachine),
                                       0,
                                       static_cast<std::uint8_t>(BindFault::kUnknownAxis)};
    for (const char c : {'Q', '\x1b', '[', 'A'}) reply.push_back(static_cast<std::uint8_t>(c));
    return reply;
  }
};

TEST_F(LinkTest, ReasonOfARefusalHasNoControlCharacters) {
  rig_.run(10);
  Client board(std::make_unique<Refuses>(link_, rig_));
  try {
    board.confirm();
    FAIL() << "refused";
  } catch (const LimitNotMet& refusal) {
    EXPECT_NE(std::string(refusal.what()).find("Q?[A"), std::string::npos) << refusal.what();
    EXPECT_EQ(printable(refusal.what()), refusal.what());
  }
}

/// Goes through the service's own link.
struct Through : Transport, CommandLink {
  Through(Service& s, UploadRig& r) : service(s), rig(r) {}
  std::vector<std::uint8_t> ask(const std::vector<std::uint8_t>& request) override {
    pending = request;
    service.serve(*this, TimeUs(0), rights);
    rig.run(2);
    return answer;
  }
  HalFault serve(CommandHandler& handler, TimeUs) noexcept override {
    if (registers != 0) {
      given = handler.give(registers) != CommandGiven::kRefused;
      registers = 0;
      return HalFault::kNone;
    }
    answer.resize(kMaxReplyBytes);
    handler.comes_over(connection);
    answer.resize(handler.answer(pending.data(), static_cast<std::uint32_t>(pending.size()), answer.data()));
    return HalFault::kNone;
  }
  bool give(std::uint16_t command) {
    registers = command;
    service.serve(*this, TimeUs(0), rights);
    return given;
  }
  Service& service;
  UploadRig& rig;
  LinkRights rights;
  std::uint16_t registers = 0;
  std::uint64_t connection = 0;
  bool given = false;
  std::vector<std::uint8_t> pending, answer;
};

TEST(LinkShares, NameWhatEachEffectAddsAndSumToTheCorrection) {
  const SigningKey key = new_key();
  SimSlotStore store(1 << 16);
  UploadRig rig(store, key);
  rig.run(10);
  Client board(std::make_unique<Through>(rig.service(), rig));
  board.sign_with(key);
  EXPECT_TRUE(board.shares().empty());
  board.upload(make_upload(small_image_bytes(2e-5), key, 5, 0), [](double) {});
  board.confirm();
  rig.run(4000);
  const std::vector<BoardShare> shares = board.shares();
  // Scale and reversal of X, growth of Y; what the second evaluation adds stands beside them.
  EXPECT_EQ(std::count_if(shares.begin(), shares.end(),
                          [](const BoardShare& share) { return share.name.rfind("evaluation", 0) != 0; }),
            3);
  double sum[2] = {};
  for (const BoardShare& share : shares) {
    EXPECT_FALSE(share.name.empty());
    sum[share.axis] += share.correction;
  }
  // They are at most a tenth of a second old, in which the axes go 6 and 2 mm.
  const BoardTick tick = board.newest();
  EXPECT_NEAR(sum[0], tick.correction[0], 0.01);
  EXPECT_NEAR(sum[1], tick.correction[1], 0.01);
  EXPECT_GT(std::abs(sum[0]), 0.002);
}

/// A board with keys of all roles, and clients that reach it over links of different rights.
class GateTest : public testing::Test {
 protected:
  GateTest() {
    rig_.run(10);
    auto direct = std::make_unique<Through>(rig_.service(), rig_);
    way_ = direct.get();
    board_ = std::make_unique<Client>(std::move(direct));
  }
  std::string refused(const std::function<void()>& act) {
    try {
      act();
    } catch (const std::exception& error) {
      return error.what();
    }
    return "";
  }
  void over(LinkAccess access, bool plain = false) { way_->rights = {access, plain}; }
  SigningKey key_ = new_key();
  SimSlotStore store_{1 << 16};
  UploadRig rig_{store_, key_};
  Through* way_ = nullptr;
  std::unique_ptr<Client> board_;
};

TEST_F(GateTest, WithoutASignatureABoardWithKeysShowsItsStateAndDoesNothing) {
  const auto upload = make_upload(small_image_bytes(2e-5), key_, 5, 0);
  const std::function<void()> acts[] = {[&] { board_->command(Command::kActivate); },
                                        [&] { board_->weight(0, 0.5); },
                                        [&] {
                                          board_->workpiece({1, 2, 3}, 0);
                                        },
                                        [&] { board_->upload(upload, [](double) {}); },
                                        [&] { board_->confirm(); },
                                        [&] { board_->revert(); }};
  for (const auto& act : acts)
    EXPECT_EQ(refused(act), "the board refuses: the request must be signed (--key, or VERNIER_KEY)");
  EXPECT_FALSE(way_->give(1)) << "nor by register";
  board_->sign_with(new_key());
  for (const auto& act : acts)
    EXPECT_EQ(refused(act), "the board refuses: the key has no right for this request");
  EXPECT_EQ(refused([&] { board_->newest(), board_->slots(); }), "");
  board_->sign_with(key_);
  EXPECT_NO_THROW(board_->upload(upload, [](double) {}));
  EXPECT_NO_THROW(board_->confirm());
  board_->sign_with(std::nullopt);
  EXPECT_NE(refused([&] { board_->confirmed([](double) {}); }), "") << "nor is the image given to anybody";
  board_->sign_with(key_);
  EXPECT_EQ(board_->confirmed([](double) {}), upload);
}

TEST_F(GateTest, LinkIsUsedForWhatItMayBeUsedForWhoeverSigns) {
  board_->sign_with(key_);
  const std::string not_allowed =
      "the board refuses this request over this link (`access` in the board file)";
  over(LinkAccess::kRead, true);
  EXPECT_EQ(refused([&] { board_->command(Command::kActivate); }), not_allowed);
  EXPECT_EQ(refused([&] { board_->confirm(); }), not_allowed);
  EXPECT_FALSE(way_->give(1));
  EXPECT_NO_THROW(board_->newest());
  over(LinkAccess::kCommand, true);
  EXPECT_EQ(refused([&] { board_->command(Command::kActivate); }), "");
  rig_.run(5);
  EXPECT_TRUE(way_->give(2)) << "a line that the board file trusts";
  EXPECT_EQ(refused([&] { board_->upload(make_upload(small_image_bytes(2e-5), key_, 5, 0), [](double) {}); }),
            not_allowed);
}

TEST_F(GateTest, SignedRequestIsTakenOnceAndByThisStartOfThisBoardOnly) {
  const auto challenge_of = [&](Through& way) {
    const auto reply = way.ask({static_cast<std::uint8_t>(LinkOp::kChallenge), 1});
    ChallengeReply challenge;
    std::memcpy(&challenge, reply.data() + kReplyHeaderBytes, sizeof(challenge));
    return challenge;
  };
  const ChallengeReply challenge = challenge_of(*way_);
  const auto request_with = [&](std::uint8_t nonce_bit, const ChallengeReply& answers, const char* board,
                                Command command) {
    SignedRequestHead head{};
    std::memcpy(head.magic, kRequestMagic, sizeof(head.magic));
    std::memcpy(head.nonce, challenge.nonce, sizeof(head.nonce));
    head.nonce[3] = static_cast<std::uint8_t>(head.nonce[3] ^ nonce_bit);
    std::memcpy(head.challenge, answers.challenge, sizeof(head.challenge));
    std::memcpy(head.board, board, std::strlen(board));
    const std::vector<std::uint8_t> rest = {static_cast<std::uint8_t>(LinkOp::kCommand),
                                            static_cast<std::uint8_t>(command)};
    const SignedRequest proof = sign_request(key_, head, rest);
    std::vector<std::uint8_t> request(2 + sizeof(proof) + rest.size());
    request[0] = static_cast<std::uint8_t>(LinkOp::kSigned), request[1] = 9;
    std::memcpy(request.data() + 2, &proof, sizeof(proof));
    std::copy(rest.begin(), rest.end(), request.end() - static_cast<std::ptrdiff_t>(rest.size()));
    return request;
  };
  const auto status = [&](const std::vector<std::uint8_t>& request) {
    return static_cast<LinkStatus>(way_->ask(request).at(2));
  };
  const auto good = request_with(0, challenge, "", Command::kHold);
  EXPECT_EQ(status(request_with(1, challenge, "", Command::kHold)), LinkStatus::kBadSignature);
  EXPECT_EQ(status(request_with(0, challenge, "mill-2", Command::kHold)), LinkStatus::kBadSignature);
  std::vector<std::uint8_t> changed = good;
  changed.back() = static_cast<std::uint8_t>(Command::kActivate);
  EXPECT_EQ(status(changed), LinkStatus::kBadSignature);
  EXPECT_EQ(status(good), LinkStatus::kDone);
  EXPECT_EQ(status(good), LinkStatus::kStale) << "replayed";
  ChallengeReply guessed = challenge_of(*way_);
  guessed.challenge[15] = static_cast<std::uint8_t>(guessed.challenge[15] ^ 1);
  EXPECT_EQ(status(request_with(0, guessed, "", Command::kHold)), LinkStatus::kStale) << "of no challenge";
  // A challenge belongs to its connection.
  way_->connection = 1;
  const auto of_first = request_with(0, challenge_of(*way_), "", Command::kHold);
  way_->connection = 2;
  const auto of_second = request_with(0, challenge_of(*way_), "", Command::kHold);
  EXPECT_EQ(status(of_first), LinkStatus::kStale) << "over another connection";
  EXPECT_EQ(status(of_second), LinkStatus::kDone) << "the attempt did not use it up";
  way_->connection = 1;
  EXPECT_EQ(status(of_first), LinkStatus::kDone);
  // What was held back on its way is worth nothing after ten seconds, though nothing else was signed since.
  const ChallengeReply later = challenge_of(*way_);
  const auto held_back = request_with(0, later, "", Command::kRelease);
  rig_.run(10'100);
  EXPECT_EQ(status(held_back), LinkStatus::kStale);
}

ChallengeBytes challenge_in(const ChallengeReply& reply) {
  ChallengeBytes bytes;
  std::memcpy(bytes.data(), reply.challenge, bytes.size());
  return bytes;
}

// With a counter of 32 bits a used request was valid again 2^32 challenges later.
TEST(Challenges, NeverRepeatAndDifferBetweenStarts) {
  const BoardIdentity identity(new_key().public_part());
  Gate gate(identity, Nonce{1}, ChallengeSeed{1}), same_nonce(identity, Nonce{1}, ChallengeSeed{2}),
      same_seed(identity, Nonce{2}, ChallengeSeed{1});
  std::set<ChallengeBytes> seen;
  std::array<int, 128> ones{};
  constexpr int kChallenges = 20'000;
  for (int i = 0; i < kChallenges; ++i)
    for (Gate* const one : {&gate, &same_nonce, &same_seed}) {
      const ChallengeBytes bytes = challenge_in(one->challenge(LinkAccess::kUpload, {}, TimeUs(i)));
      EXPECT_TRUE(seen.insert(bytes).second);
      for (std::size_t bit = 0; bit < ones.size(); ++bit) ones[bit] += bytes[bit / 8] >> (bit % 8) & 1;
    }
  // Each bit is one in half of them, within six standard deviations of a fair coin.
  const double mean = 1.5 * kChallenges, most = 6 * std::sqrt(0.75 * kChallenges);
  for (const int count : ones) EXPECT_NEAR(count, mean, most);
}

/// A signed request (its op and payload) that answers a challenge.
std::vector<std::uint8_t> signed_request(const SigningKey& key, const ChallengeReply& answers,
                                         const std::vector<std::uint8_t>& rest) {
  SignedRequestHead head{};
  std::memcpy(head.magic, kRequestMagic, sizeof(head.magic));
  std::memcpy(head.nonce, answers.nonce, sizeof(head.nonce));
  std::memcpy(head.challenge, answers.challenge, sizeof(head.challenge));
  const SignedRequest proof = sign_request(key, head, rest);
  std::vector<std::uint8_t> request(kRequestHeaderBytes + sizeof(proof) + rest.size());
  request[0] = static_cast<std::uint8_t>(LinkOp::kSigned), request[1] = 1;
  std::memcpy(request.data() + kRequestHeaderBytes, &proof, sizeof(proof));
  std::copy(rest.begin(), rest.end(), request.end() - static_cast<std::ptrdiff_t>(rest.size()));
  return request;
}

std::vector<std::uint8_t> signed_hold(const SigningKey& key, const ChallengeReply& answers) {
  return signed_request(
      key, answers, {static_cast<std::uint8_t>(LinkOp::kCommand), static_cast<std::uint8_t>(Command::kHold)});
}

// Four clients without a key that asked for challenges were enough.
TEST(Challenges, OfOthersDoNotUseUpTheOperatorsOne) {
  const SigningKey key = new_key();
  const BoardIdentity identity(key.public_part());
  Gate gate(identity, Nonce{1}, ChallengeSeed{1});
  constexpr Caller kOperator{1, 1};
  const auto opened = [&](const ChallengeReply& challenge) {
    const auto request = signed_hold(key, challenge);
    return gate
        .open(request.data(), static_cast<std::uint32_t>(request.size()), LinkAccess::kCommand, kOperator,
              TimeUs(2000))
        .status;
  };
  // WHEN all other places of the operator's link ask a thousand times, and another link's, at any rate
  ChallengeReply challenge = gate.challenge(LinkAccess::kCommand, kOperator, TimeUs(0));
  for (std::uint64_t i = 0; i < 20'000; ++i) {
    gate.challenge(LinkAccess::kCommand, {1, 2 + i % 19}, TimeUs(1000));
    gate.challenge(LinkAccess::kCommand, {2, i % 20}, TimeUs(1000));
    gate.challenge(LinkAccess::kRead, {3, i}, TimeUs(1000));
  }
  EXPECT_EQ(opened(challenge), LinkStatus::kDone);
  // WHEN another link opens ever new connections: ended ones leave no challenge, open ones use up their own
  challenge = gate.challenge(LinkAccess::kCommand, kOperator, TimeUs(0));
  for (std::uint64_t i = 0; i < 20'000; ++i) {
    gate.challenge(LinkAccess::kCommand, {2, 100 + i}, TimeUs(1000));
    if (i % 2 == 0) gate.forget({2, 100 + i});
  }
  EXPECT_EQ(opened(challenge), LinkStatus::kDone);
  gate.challenge(LinkAccess::kCommand, kOperator, TimeUs(0));
  gate.forget(kOperator);
  EXPECT_EQ(opened(gate.challenge(LinkAccess::kCommand, {1, 2}, TimeUs(0))), LinkStatus::kStale)
      << "of another connection";
}

// The gate keeps a challenge for ten seconds, and 48 of them. A signed request has at least the byte of its
// op.
TEST(Challenges, AreValidToTheEndOfTheirTimeAndOfTheTable) {
  const SigningKey key = new_key();
  const BoardIdentity identity(key.public_part());
  constexpr Caller kOperator{1, 1};
  const auto status_after = [&](std::int64_t time_us, std::uint64_t others) {
    Gate gate(identity, Nonce{1}, ChallengeSeed{1});
    const auto request = signed_hold(key, gate.challenge(LinkAccess::kCommand, kOperator, TimeUs(7)));
    for (std::uint64_t i = 0; i < others; ++i) gate.challenge(LinkAccess::kCommand, {1, 2 + i}, TimeUs(8));
    return gate
        .open(request.data(), static_cast<std::uint32_t>(request.size()), LinkAccess::kCommand, kOperator,
              TimeUs(7 + time_us))
        .status;
  };
  EXPECT_EQ(status_after(0, 0), LinkStatus::kDone);
  EXPECT_EQ(status_after(10'000'000, 0), LinkStatus::kDone) << "exactly ten seconds";
  EXPECT_EQ(status_after(10'000'001, 0), LinkStatus::kStale);
  EXPECT_EQ(status_after(10, 47), LinkStatus::kDone) << "the table is full";
  EXPECT_EQ(status_after(10, 48), LinkStatus::kStale) << "the oldest was removed";
  Gate gate(identity, Nonce{1}, ChallengeSeed{1});
  const auto request = signed_hold(key, gate.challenge(LinkAccess::kCommand, kOperator, TimeUs(0)));
  constexpr std::uint32_t kHead = kRequestHeaderBytes + sizeof(SignedRequest);
  const auto status_of = [&](std::uint32_t size) {
    return gate.open(request.data(), size, LinkAccess::kCommand, kOperator, TimeUs(0)).status;
  };
  EXPECT_EQ(status_of(kHead - 1), LinkStatus::kBadLength);
  EXPECT_EQ(status_of(kHead), LinkStatus::kBadLength) << "no op";
  EXPECT_EQ(status_of(kHead + 1), LinkStatus::kBadSignature) << "an op, which was signed with its payload";
}

TEST(SignedRequests, AreTakenForTheRightsOfTheirKeyUntilItIsRetired) {
  const auto status = [](const TrustedKey& rights, LinkOp op) {
    const SigningKey key = new_key();
    BoardIdentity identity;
    TrustedKey trusted = rights;
    trusted.key = key.public_part();
    identity.keys.push_back(trusted);
    Gate gate(identity, Nonce{1}, ChallengeSeed{1});
    const auto request = signed_request(key, gate.challenge(LinkAccess::kUpload, {}, TimeUs(0)),
                                        {static_cast<std::uint8_t>(op), 1});
    return gate
        .open(request.data(), static_cast<std::uint32_t>(request.size()), LinkAccess::kUpload, {}, TimeUs(0))
        .status;
  };
  TrustedKey operators, engineers, former;
  operators.upload = engineers.command = false, former.retired = true;
  EXPECT_EQ(status({}, LinkOp::kCommand), LinkStatus::kDone);
  EXPECT_EQ(status({}, LinkOp::kConfirm), LinkStatus::kDone);
  EXPECT_EQ(status(operators, LinkOp::kCommand), LinkStatus::kDone);
  EXPECT_EQ(status(operators, LinkOp::kConfirm), LinkStatus::kBadSignature);
  EXPECT_EQ(status(engineers, LinkOp::kCommand), LinkStatus::kBadSignature);
  EXPECT_EQ(status(engineers, LinkOp::kConfirm), LinkStatus::kDone);
  EXPECT_EQ(status(former, LinkOp::kCommand), LinkStatus::kBadSignature);
  EXPECT_EQ(status(former, LinkOp::kConfirm), LinkStatus::kBadSignature);
}

// The gate does not copy a request that is too long. The link then answers that the length is wrong.
TEST_F(GateTest, RequestOfAnImpossibleSizeIsNeitherOpenedNorExecuted) {
  const BoardIdentity identity(key_.public_part());
  Gate gate(identity, Nonce{1}, ChallengeSeed{1});
  std::vector<std::uint8_t> request(kMaxRequestBytes, 0);
  const auto opened = [&] {
    return gate.open(request.data(), static_cast<std::uint32_t>(request.size()), LinkAccess::kUpload, {},
                     TimeUs(0));
  };
  const auto answer = [&](LinkOp op) {
    request[0] = static_cast<std::uint8_t>(op);
    return static_cast<LinkStatus>(way_->ask(request).at(2));
  };
  request[0] = static_cast<std::uint8_t>(LinkOp::kCommand);
  EXPECT_EQ(opened().status, LinkStatus::kUnsigned) << "the longest request";
  request.push_back(0);
  EXPECT_EQ(opened().status, LinkStatus::kDone);
  EXPECT_EQ(opened().request, request.data());
  for (const LinkOp op : {LinkOp::kCommand, LinkOp::kSigned, LinkOp::kHello})
    EXPECT_EQ(answer(op), LinkStatus::kBadLength) << static_cast<int>(op);
  request = {static_cast<std::uint8_t>(LinkOp::kCommand)};
  EXPECT_EQ(opened().status, LinkStatus::kDone);
  EXPECT_TRUE(way_->ask(request).empty()) << "half a head";
  request[0] = static_cast<std::uint8_t>(LinkOp::kIdentify);
  EXPECT_FALSE(Gate::is_identify(request.data(), 1));
  request.push_back(1);
  EXPECT_TRUE(Gate::is_identify(request.data(), 2));
}

// The right of the link is tested before the signature.
TEST_F(GateTest, RequestBeyondTheRightsOfItsLinkIsNotAllowedUnsignedEither) {
  const auto status = [&](std::vector<std::uint8_t> request) {
    return static_cast<LinkStatus>(way_->ask(request).at(2));
  };
  over(LinkAccess::kRead);
  EXPECT_EQ(status({static_cast<std::uint8_t>(LinkOp::kCommand), 1, 1}), LinkStatus::kNotAllowed);
  over(LinkAccess::kUpload);
  EXPECT_EQ(status({static_cast<std::uint8_t>(LinkOp::kCommand), 1, 1}), LinkStatus::kUnsigned);
  std::vector<std::uint8_t> cover(kRequestHeaderBytes + sizeof(SignedRequest));
  cover[0] = static_cast<std::uint8_t>(LinkOp::kSigned);
  EXPECT_EQ(status(cover), LinkStatus::kBadLength) << "a cover without a request";
}

// What touches the store is executed beside the links: exactly these requests, also without any payload.
TEST(LinkRequests, EachIsExecutedWhereItMayTakeItsTime) {
  const std::set<LinkOp> store = {LinkOp::kFinish, LinkOp::kConfirm, LinkOp::kRevert, LinkOp::kRead};
  const std::set<LinkOp> may = {LinkOp::kFinish, LinkOp::kConfirm, LinkOp::kRevert, LinkOp::kRead,
                                LinkOp::kBegin,  LinkOp::kData,    LinkOp::kSigned};
  const std::set<LinkOp> setting = {LinkOp::kCommand, LinkOp::kWeight};
  for (std::uint8_t i = 1; i < kLinkOpCount; ++i) {
    const auto op = static_cast<LinkOp>(i);
    const std::uint8_t request[kRequestHeaderBytes] = {i, 0};
    EXPECT_EQ(Link::needs_store(request, kRequestHeaderBytes), store.contains(op)) << int{i};
    EXPECT_EQ(Link::may_need_store(request, kRequestHeaderBytes), may.contains(op)) << int{i};
    EXPECT_EQ(Link::is_setting(request, kRequestHeaderBytes), setting.contains(op)) << int{i};
    EXPECT_FALSE(Link::needs_store(request, kRequestHeaderBytes - 1)) << "no request";
    EXPECT_FALSE(Link::may_need_store(request, kRequestHeaderBytes - 1)) << "no request";
    EXPECT_FALSE(Link::is_setting(request, kRequestHeaderBytes - 1)) << "no request";
  }
}

TEST_F(LinkTest, RefusalTellsTheReason) {
  rig_.run(10);
  Client board = client();
  try {
    board.upload(make_upload(small_image_bytes(2e-5), new_key(), 5, 0), [](double) {});
    FAIL();
  } catch (const LimitNotMet& refusal) {
    EXPECT_STREQ(refusal.what(),
                 "the board refuses: the image is signed with a key that the board does not trust");
  }
}

TEST_F(LinkTest, HistoryIsCompleteOrSaysWhatIsLost) {
  rig_.run(100);
  Client board = client();
  const std::uint64_t first = board.newest().number;
  std::uint64_t next = first, seen = 0;
  while (next < first + 500) {
    const BoardHistory history = board.history(next, 1);
    EXPECT_EQ(history.lost, 0u);
    for (const BoardTick& tick : history.ticks)
      EXPECT_EQ(tick.number, next + static_cast<std::uint64_t>(&tick - history.ticks.data()));
    seen += history.ticks.size();
    next = history.next;
  }
  EXPECT_EQ(seen, next - first);
  rig_.run(2 * Exchange::kHistory);
  const BoardHistory late = board.history(first, 1);
  EXPECT_GT(late.lost, Exchange::kHistory / 2);
  EXPECT_EQ(late.ticks.front().number, first + late.lost);
}

// A small board keeps few ticks; its history must not be all distance to the end that is overwritten.
TEST_F(LinkTest, ShortHistoryIsGivenToo) {
  Exchange small(64, 8);
  const BoardIdentity nobody;
  Link link(small, rig_.uploader(), wiring_, TimeUs(1000), nobody);
  for (int i = 0; i < 200; ++i) small.ticks.add(TickRecord{});
  std::uint8_t request[12] = {static_cast<std::uint8_t>(LinkOp::kHistory), 1}, reply[kMaxReplyBytes];
  request[10] = 1;  // every tick from number 0 on
  const std::uint32_t size = link.answer(request, sizeof(request), reply, TimeUs(1));
  const std::size_t tick = sizeof(LinkTick) + 2 * sizeof(LinkAxis) + sizeof(LinkInput);
  EXPECT_EQ((size - kReplyHeaderBytes - 10) / tick, (kMaxReplyBytes - kReplyHeaderBytes - 10) / tick);
  std::uint64_t number = 0;
  std::memcpy(&number, reply + kReplyHeaderBytes + 10, sizeof(number));
  EXPECT_EQ(number, 200u - 64u + 1u);
  // The next request begins with the first tick that had no room.
  std::uint64_t next = 0;
  std::memcpy(&next, reply + kReplyHeaderBytes, sizeof(next));
  EXPECT_EQ(next, number + (size - kReplyHeaderBytes - 10) / tick);
}

TEST_F(LinkTest, LiveRegistersSayWhatTheTickSays) {
  rig_.run(10);
  Client board = client();
  board.upload(make_upload(small_image_bytes(2e-5), key_, 5, 0), [](double) {});
  rig_.run(3000);
  std::uint16_t registers[kLiveRegisters];
  link_.fill_registers(registers);
  const std::uint64_t count = rig_.service().exchange().ticks.count();
  TickRecord tick;
  ASSERT_TRUE(rig_.service().exchange().ticks.read(count - 1, tick));
  const auto pair = [&](int at) {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(registers[at]) << 16 | registers[at + 1]);
  };
  EXPECT_EQ(registers[kLiveMode], static_cast<std::uint16_t>(Mode::kActive));
  EXPECT_EQ(pair(kLiveTicks), static_cast<std::int32_t>(count));
  EXPECT_EQ(pair(kLiveAxes), tick.position[0] / 1000);
  EXPECT_EQ(pair(kLiveAxes + 2), tick.correction[0] / 10);
  EXPECT_EQ(pair(kLiveInputs), tick.input[0] / 1000);
  for (int axis = 0; axis < 2; ++axis) EXPECT_EQ(registers[kLiveAxisWeights + axis], 10'000) << axis;
  EXPECT_EQ(registers[kLiveAxisWeights + 2], 0) << "no third axis";
}

TEST_F(LinkTest, LiveRegistersOfTheFirstTickAndOfABoardWithoutAnImage) {
  std::uint16_t registers[kLiveRegisters];
  const auto pair = [&](int at) {
    link_.fill_registers(registers);
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(registers[at]) << 16 | registers[at + 1]);
  };
  EXPECT_EQ(pair(kLiveTicks), 0);
  rig_.run(1);
  EXPECT_EQ(pair(kLiveTicks), 1);
  // Without an image no time counts.
  rig_.run(2500);
  EXPECT_EQ(pair(kLiveSince), 0);
  EXPECT_EQ(registers[kLiveImage], static_cast<std::uint16_t>(ImageState::kNone));
  // The seconds count from the tick that took the image.
  ASSERT_EQ(rig_.send(make_upload(small_image_bytes(2e-5), key_, 5, 0)).fault, UploadFault::kNone);
  rig_.run(3500);
  EXPECT_EQ(pair(kLiveSince), 3);
}

TEST_F(LinkTest, ImageIsOnTrialWhileTheOneOnTrialRuns) {
  const auto image = [&] {
    std::uint16_t registers[kLiveRegisters];
    link_.fill_registers(registers);
    return static_cast<ImageState>(registers[kLiveImage]);
  };
  ASSERT_EQ(rig_.send(make_upload(small_image_bytes(2e-5), key_, 5, 0)).fault, UploadFault::kNone);
  rig_.run(10);
  EXPECT_EQ(image(), ImageState::kTrial);
  ASSERT_EQ(rig_.uploader().confirm().fault, UploadFault::kNone);
  rig_.run(10);
  EXPECT_EQ(image(), ImageState::kConfirmed);
  // A trial that the tick has not taken does not run yet.
  ASSERT_EQ(rig_.send(make_upload(small_image_bytes(3e-5), key_, 6, 0)).fault, UploadFault::kNone);
  EXPECT_EQ(image(), ImageState::kConfirmed);
  rig_.run(10);
  EXPECT_EQ(image(), ImageState::kTrial);
}

/// The status of a request without a payload, or with a given one.
LinkStatus status_of(Link& link, LinkOp op, const std::vector<std::uint8_t>& payload = {}) {
  std::vector<std::uint8_t> request = {static_cast<std::uint8_t>(op), 1};
  request.insert(request.end(), payload.begin(), payload.end());
  std::uint8_t reply[kMaxReplyBytes] = {};
  link.answer(request.data(), static_cast<std::uint32_t>(request.size()), reply, TimeUs(1));
  return static_cast<LinkStatus>(reply[2]);
}

TEST_F(LinkTest, CountersBeginWithAnyThatIsThere) {
  rig_.run(10);
  constexpr std::uint8_t kCounters = sizeof(HealthRecord) / sizeof(std::uint64_t);
  EXPECT_EQ(status_of(link_, LinkOp::kHealth, {kCounters - 1}), LinkStatus::kDone);
  EXPECT_EQ(status_of(link_, LinkOp::kHealth, {kCounters}), LinkStatus::kBadValue);
}

TEST_F(LinkTest, BeforeTheFirstTickThereIsNoState) {
  for (const LinkOp op : {LinkOp::kTick, LinkOp::kState}) {
    UploadRig blank(store_, key_);
    Link link(const_cast<Exchange&>(blank.service().exchange()), blank.uploader(), wiring_, TimeUs(1000),
              identity_);
    EXPECT_EQ(status_of(link, op), LinkStatus::kNotReady);
    blank.run(1);
    EXPECT_EQ(status_of(link, op), LinkStatus::kDone);
  }
}

TEST_F(LinkTest, TickHasEveryAxisAndEveryInputOfTheBoard) {
  const Wiring wiring{{{"X"}, {"Y"}}, {"S", "T", "U"}};
  Link link(const_cast<Exchange&>(rig_.service().exchange()), rig_.uploader(), wiring, TimeUs(1000),
            identity_);
  rig_.run(10);
  const std::uint8_t request[] = {static_cast<std::uint8_t>(LinkOp::kTick), 1};
  std::uint8_t reply[kMaxReplyBytes];
  EXPECT_EQ(link.answer(request, sizeof(request), reply, TimeUs(1)),
            kReplyHeaderBytes + sizeof(LinkTick) + 2 * sizeof(LinkAxis) + 3 * sizeof(LinkInput));
}

TEST_F(LinkTest, LiveRegistersOfARotaryAxisAreThousandthsOfADegree) {
  const Wiring wiring{{{"X"}, {"C", true, false}}, {"T"}};
  Exchange& exchange = const_cast<Exchange&>(rig_.service().exchange());
  Link link(exchange, rig_.uploader(), wiring, TimeUs(1000), identity_);
  rig_.run(10);
  TickRecord tick;
  ASSERT_TRUE(exchange.ticks.read(exchange.ticks.count() - 1, tick));
  tick.position[1] = (std::int64_t{9} << 32) / 4;  // 2.25 turns
  tick.correction[1] = -(1 << 30);                 // a quarter of a turn back
  tick.position[2] = tick.input[1] = tick.correction[2] = 5'000'000;
  exchange.ticks.add(tick);
  HealthRecord health;
  ASSERT_TRUE(exchange.health.read(health));
  health.latency_ns[1] = 12'345'678;
  exchange.health.publish(health);
  std::uint16_t registers[kLiveRegisters];
  link.fill_registers(registers);
  const auto pair = [&](int at) {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(registers[at]) << 16 | registers[at + 1]);
  };
  EXPECT_EQ(pair(kLiveAxes), tick.position[0] / 1000);
  EXPECT_EQ(pair(kLiveAxes + kLiveRegistersPerAxis), 810'000);
  EXPECT_EQ(pair(kLiveAxes + kLiveRegistersPerAxis + 2), -90'000'000);
  EXPECT_EQ(pair(kLiveAxes + 2 * kLiveRegistersPerAxis), 0) << "no third axis";
  EXPECT_EQ(pair(kLiveAxes + 2 * kLiveRegistersPerAxis + 2), 0) << "no third axis";
  EXPECT_EQ(pair(kLiveInputs + 2), 0) << "no second input";
  EXPECT_EQ(registers[kLiveLatency], 12'345) << "us";
}

// Until the history is full, it begins with number 0. After that its oldest 64th is left out, because the
// tick overwrites it. The number of lost ticks has 16 bits.
TEST_F(LinkTest, HistoryBeginsWhereItIsNotBeingOverwritten) {
  struct {
    std::uint32_t ticks;
    std::uint64_t first, next, lost;
  } const cases[] = {{256, 0, 0, 0},
                     {257, 0, 5, 5},
                     {257, 4, 5, 1},
                     {257, 5, 5, 0},
                     {257, 6, 6, 0},
                     {65'787, 0, 65'535, 65'535},
                     {65'788, 0, 65'536, 65'535},
                     {65'788, 1, 65'536, 65'535}};
  for (const auto& wanted : cases) {
    Exchange exchange(256, 8);
    const BoardIdentity nobody;
    Link link(exchange, rig_.uploader(), wiring_, TimeUs(1000), nobody);
    for (std::uint32_t i = 0; i < wanted.ticks; ++i) exchange.ticks.add(TickRecord{});
    std::uint8_t request[12] = {static_cast<std::uint8_t>(LinkOp::kHistory), 1}, reply[kMaxReplyBytes];
    std::memcpy(request + 2, &wanted.first, sizeof(wanted.first));
    request[10] = 1;
    link.answer(request, sizeof(request), reply, TimeUs(1));
    std::uint16_t lost = 0;
    std::uint64_t number = 0;
    std::memcpy(&lost, reply + kReplyHeaderBytes + 8, sizeof(lost));
    std::memcpy(&number, reply + kReplyHeaderBytes + 10, sizeof(number));
    EXPECT_EQ(number, wanted.next) << wanted.ticks << " " << wanted.first;
    EXPECT_EQ(lost, wanted.lost) << wanted.ticks << " " << wanted.first;
  }
}

// The last value that a request may have, and the next one.
TEST_F(LinkTest, RequestIsTakenToTheLimitOfItsValues) {
  rig_.run(10);
  const auto status = [&](std::vector<std::uint8_t> request) {
    std::uint8_t reply[kMaxReplyBytes];
    const auto size = static_cast<std::uint32_t>(request.size());
    Exchange exchange(64, 8);
    Link link(exchange, rig_.uploader(), wiring_, TimeUs(1000), identity_);
    link.answer(request.data(), size, reply, TimeUs(1));
    return static_cast<LinkStatus>(reply[2]);
  };
  constexpr auto kCommandOp = static_cast<std::uint8_t>(LinkOp::kCommand);
  EXPECT_EQ(status({kCommandOp, 1, 0}), LinkStatus::kBadValue);
  EXPECT_EQ(status({kCommandOp, 1, 1}), LinkStatus::kDone);
  EXPECT_EQ(status({kCommandOp, 1, kCommandCount - 1}), LinkStatus::kDone);
  EXPECT_EQ(status({kCommandOp, 1, kCommandCount}), LinkStatus::kBadValue);
  EXPECT_EQ(status({kCommandOp, 1}), LinkStatus::kBadLength);
  EXPECT_EQ(status({kCommandOp, 1, 1, 0}), LinkStatus::kBadLength);
  constexpr auto kWeightOp = static_cast<std::uint8_t>(LinkOp::kWeight);
  EXPECT_EQ(status({kWeightOp, 1, 1, 0, 0, 1, 0}), LinkStatus::kDone) << "the full weight, last axis";
  EXPECT_EQ(status({kWeightOp, 1, 1, 1, 0, 1, 0}), LinkStatus::kBadValue);
  EXPECT_EQ(status({kWeightOp, 1, 2, 0, 0, 1, 0}), LinkStatus::kBadValue) << "no third axis";
  EXPECT_EQ(status({0, 1}), LinkStatus::kUnknownOp);
  EXPECT_EQ(status({kLinkOpCount, 1}), LinkStatus::kUnknownOp);
  std::vector<std::uint8_t> longest(kMaxRequestBytes, 0);
  longest[0] = static_cast<std::uint8_t>(LinkOp::kData);
  EXPECT_EQ(status(longest), LinkStatus::kRefused) << "no upload has begun";
  longest.push_back(0);
  EXPECT_EQ(status(longest), LinkStatus::kBadLength);
}

// A register pair has 32 bits with a sign, a latency 16 bits without; weights are rounded to 0.01 %.
TEST_F(LinkTest, LiveRegistersStopAtTheEndOfTheirRange) {
  Exchange& exchange = const_cast<Exchange&>(rig_.service().exchange());
  rig_.run(10);
  TickRecord tick;
  StateRecord state;
  HealthRecord health;
  ASSERT_TRUE(exchange.ticks.read(exchange.ticks.count() - 1, tick));
  ASSERT_TRUE(exchange.state.read(state));
  ASSERT_TRUE(exchange.health.read(health));
  std::uint16_t registers[kLiveRegisters];
  const auto pair = [&](int at) {
    exchange.ticks.add(tick), exchange.state.publish(state), exchange.health.publish(health);
    link_.fill_registers(registers);
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(registers[at]) << 16 | registers[at + 1]);
  };
  for (const std::int64_t end : {std::int64_t{INT32_MAX}, std::int64_t{INT32_MIN}})
    for (const int beyond : {-1, 0, 1}) {
      const std::int64_t value = end + beyond;
      tick.position[0] = tick.input[0] = 1000 * value;
      const std::int64_t shown = std::clamp<std::int64_t>(value, INT32_MIN, INT32_MAX);
      EXPECT_EQ(pair(kLiveAxes), shown);
      EXPECT_EQ(pair(kLiveInputs), shown);
    }
  struct {
    std::int64_t latency_ns;
    std::uint16_t us;
  } const latencies[] = {{-1000, 0}, {999, 0}, {1000, 1}, {65'535'999, 65'535}, {65'536'000, 65'535}};
  for (const auto& wanted : latencies) {
    health.latency_ns[1] = wanted.latency_ns;
    pair(0);
    EXPECT_EQ(registers[kLiveLatency], wanted.us);
  }
  struct {
    std::int32_t weight;
    std::uint16_t share;
  } const weights[] = {{0, 0},          {3, 0},           {4, 1},          {32'768, 5'000},
                       {65'532, 9'999}, {65'533, 10'000}, {65'536, 10'000}};
  for (const auto& wanted : weights) {
    state.axis_weight[1] = wanted.weight;
    pair(0);
    EXPECT_EQ(registers[kLiveAxisWeights + 1], wanted.share) << wanted.weight;
  }
}

// The tick may be interrupted at any point. A link then shows no state, and never half of a state.
TEST_F(LinkTest, HalfWrittenStateIsNotShown) {
  rig_.run(10);
  auto& exchange = const_cast<Exchange&>(rig_.service().exchange());
  std::uint16_t registers[kLiveRegisters];
  const auto mode = [&] {
    link_.fill_registers(registers);
    return static_cast<Mode>(registers[kLiveMode]);
  };
  {
    const InterruptedWrite write(exchange.state);
    EXPECT_EQ(status_of(link_, LinkOp::kState), LinkStatus::kNotReady);
    EXPECT_EQ(status_of(link_, LinkOp::kTick), LinkStatus::kDone);
    EXPECT_EQ(mode(), Mode::kChecking);
  }
  {
    const InterruptedWrite write(exchange.health);
    EXPECT_EQ(status_of(link_, LinkOp::kHealth, {0}), LinkStatus::kNotReady);
    EXPECT_EQ(mode(), Mode::kBoot) << "registers of zeros";
  }
  EXPECT_EQ(mode(), Mode::kChecking);
  EXPECT_EQ(status_of(link_, LinkOp::kState), LinkStatus::kDone);
}

TEST_F(LinkTest, SharesAreThoseOfTheRunningProgramOrNone) {
  constexpr int kPublishedEvery = 100;  // ticks; Service::kTicksPerEquation
  const auto shares = [&] { return status_of(link_, LinkOp::kShares, {0, 0}); };
  auto& exchange = const_cast<Exchange&>(rig_.service().exchange());
  EXPECT_EQ(shares(), LinkStatus::kNotReady) << "nothing runs";
  for (const std::uint64_t issued : {5u, 6u}) {
    const auto image = make_upload(small_image_bytes(1e-5 * static_cast<double>(issued)), key_, issued, 0);
    ASSERT_EQ(rig_.send(image).fault, UploadFault::kNone);
    rig_.run(3);
    ASSERT_EQ(rig_.uploader().confirm().fault, UploadFault::kNone);
    rig_.run(3);
    EXPECT_EQ(shares(), LinkStatus::kNotReady) << "published of the program before, or of none";
    rig_.run(kPublishedEvery);
    EXPECT_EQ(shares(), LinkStatus::kDone);
  }
  const InterruptedWrite write(exchange.equation);
  EXPECT_EQ(shares(), LinkStatus::kNotReady);
}

TEST_F(LinkTest, NameOfAShareBelongsToOneProgram) {
  ASSERT_EQ(rig_.send(make_upload(small_image_bytes(2e-5), key_, 5, 0)).fault, UploadFault::kNone);
  rig_.run(10);
  const auto name = [&](std::uint16_t index, std::uint32_t programs) {
    std::vector<std::uint8_t> payload(6);
    std::memcpy(payload.data(), &index, sizeof(index));
    std::memcpy(payload.data() + 2, &programs, sizeof(programs));
    return status_of(link_, LinkOp::kShareName, payload);
  };
  const auto names = static_cast<std::uint16_t>(rig_.service().cycle().program().share_names.size);
  ASSERT_GT(names, 0);
  EXPECT_EQ(name(static_cast<std::uint16_t>(names - 1), 1), LinkStatus::kDone);
  EXPECT_EQ(name(names, 1), LinkStatus::kBadValue) << "beyond the shares";
  EXPECT_EQ(name(0, 2), LinkStatus::kBadValue) << "of another program";
}

// The previous trial has ended, but the medium or the guardian has not recorded its end yet.
TEST_F(LinkTest, UploadBeginsWhenTheTrialBeforeIsPutAway) {
  const auto begin = [&] { return status_of(link_, LinkOp::kBegin, {0, 1, 0, 0}); };
  Uploader& uploader = rig_.uploader();
  const auto guard = [&] { uploader.programs().guard(TimeUs(1)); };
  ASSERT_EQ(rig_.send(make_upload(small_image_bytes(2e-5), key_, 5, 0)).fault, UploadFault::kNone);
  guard();
  EXPECT_EQ(begin(), LinkStatus::kRefused) << "on trial";
  ASSERT_EQ(uploader.confirm().fault, UploadFault::kNone);
  EXPECT_EQ(begin(), LinkStatus::kNotReady) << "the guardian does not know it yet";
  guard();
  EXPECT_EQ(begin(), LinkStatus::kDone);
  ASSERT_EQ(rig_.send(make_upload(small_image_bytes(3e-5), key_, 6, 0)).fault, UploadFault::kNone);
  guard();
  ASSERT_EQ(uploader.revert().fault, UploadFault::kNone);
  guard();
  EXPECT_EQ(begin(), LinkStatus::kNotReady) << "the medium does not say it yet";
  ASSERT_TRUE(uploader.look_after_store());
  EXPECT_EQ(begin(), LinkStatus::kDone);
}

// A reply contains whole records only, and as many as fit, on a board of any number of axes and inputs.
TEST_F(LinkTest, ReplyHasAsManyWholeTicksAndTouchesAsFit) {
  constexpr std::size_t kHead = kReplyHeaderBytes + 10, kRoom = kMaxReplyBytes - kHead;
  Exchange exchange(64, 64);
  for (int i = 0; i < 40; ++i) exchange.ticks.add(TickRecord{}), exchange.touches.add(TouchRecord{});
  const BoardIdentity nobody;
  Wiring wiring;
  for (std::size_t axes = 1; axes <= kMaxAxes; ++axes) {
    wiring.axes.push_back({"X"});
    wiring.inputs = {};
    for (std::size_t inputs = 0; inputs <= kMaxInputs; ++inputs) {
      Link link(exchange, rig_.uploader(), wiring, TimeUs(1000), nobody);
      const auto size_of_reply = [&](LinkOp op, std::uint32_t size) {
        std::uint8_t request[12] = {static_cast<std::uint8_t>(op), 1}, reply[kMaxReplyBytes] = {};
        request[10] = 1;  // every tick from number 0 on
        const std::uint32_t answered = link.answer(request, size, reply, TimeUs(1));
        EXPECT_EQ(static_cast<LinkStatus>(reply[2]), LinkStatus::kDone);
        return answered;
      };
      const std::size_t tick = sizeof(LinkTick) + axes * sizeof(LinkAxis) + inputs * sizeof(LinkInput),
                        touch = sizeof(LinkTouch) + axes * sizeof(LinkTouchAxis);
      ASSERT_EQ(size_of_reply(LinkOp::kHistory, 12), kHead + kRoom / tick * tick) << axes << " " << inputs;
      ASSERT_EQ(size_of_reply(LinkOp::kTouches, 10), kHead + kRoom / touch * touch) << axes;
      if (inputs < kMaxInputs) wiring.inputs.push_back("T");
    }
  }
}

TEST_F(LinkTest, ReadsOneByteOfTheConfirmedImageToAsManyAsFit) {
  ASSERT_EQ(rig_.send(make_upload(small_image_bytes(2e-5), key_, 5, 0)).fault, UploadFault::kNone);
  rig_.run(10);
  ASSERT_EQ(rig_.uploader().confirm().fault, UploadFault::kNone);
  constexpr std::uint8_t kMost = kMaxReplyBytes - kReplyHeaderBytes;
  const auto read = [&](std::uint8_t bytes) { return status_of(link_, LinkOp::kRead, {0, 0, 0, 0, bytes}); };
  EXPECT_EQ(read(0), LinkStatus::kBadValue);
  EXPECT_EQ(read(1), LinkStatus::kDone);
  EXPECT_EQ(read(kMost), LinkStatus::kDone);
  EXPECT_EQ(read(kMost + 1), LinkStatus::kBadValue);
}

TEST_F(LinkTest, OnlyAxesAndInputsHaveNames) {
  rig_.run(1);
  const auto status = [&](std::uint8_t kind, std::uint8_t index) {
    const std::uint8_t request[] = {static_cast<std::uint8_t>(LinkOp::kName), 1, kind, index};
    std::uint8_t reply[kMaxReplyBytes] = {};
    link_.answer(request, sizeof(request), reply, TimeUs(1));
    return static_cast<LinkStatus>(reply[2]);
  };
  EXPECT_EQ(status(0, 1), LinkStatus::kDone);
  EXPECT_EQ(status(0, 2), LinkStatus::kBadValue);
  EXPECT_EQ(status(1, 0), LinkStatus::kDone);
  EXPECT_EQ(status(1, 1), LinkStatus::kBadValue) << "beyond the inputs";
  EXPECT_EQ(status(2, 0), LinkStatus::kBadValue) << "neither an axis nor an input";
}

TEST_F(LinkTest, EachFieldOfATouchArrivesInItsPlace) {
  Exchange exchange(64, 8);
  const BoardIdentity nobody;
  Link link(exchange, rig_.uploader(), wiring_, TimeUs(1000), nobody);
  TouchRecord touch{};
  touch.time_ns = 11;
  for (int i = 0; i < 3; ++i) touch.workpiece_nm[i] = 21 + i;
  touch.lost_edges = 31, touch.lost_touches = 32, touch.spikes = 33, touch.missing = 34;
  touch.kind = 1, touch.fault = 2, touch.flags = 3, touch.bounces = 4;
  touch.position[0] = 41, touch.position[1] = 42, touch.compensated[0] = 51, touch.compensated[1] = 52;
  touch.uncertainty[1] = std::int64_t{UINT32_MAX} + 1;
  exchange.touches.add(touch);
  std::uint8_t request[kRequestHeaderBytes + 8] = {static_cast<std::uint8_t>(LinkOp::kTouches), 1},
                                             reply[kMaxReplyBytes];
  const std::uint32_t size = link.answer(request, sizeof(request), reply, TimeUs(1));
  ASSERT_EQ(size, kReplyHeaderBytes + 10 + sizeof(LinkTouch) + 2 * sizeof(LinkTouchAxis));
  LinkTouch got;
  std::memcpy(&got, reply + kReplyHeaderBytes + 10, sizeof(got));
  EXPECT_EQ(got.time_ns, 11);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(std::int64_t{got.workpiece_nm[i]}, 21 + i);
  EXPECT_EQ(std::uint32_t{got.lost_edges}, 31u);
  EXPECT_EQ(std::uint32_t{got.lost_touches}, 32u);
  EXPECT_EQ(std::uint32_t{got.spikes}, 33u);
  EXPECT_EQ(std::uint32_t{got.missing}, 34u);
  EXPECT_EQ(got.kind, 1);
  EXPECT_EQ(got.fault, 2);
  EXPECT_EQ(got.flags, 3);
  EXPECT_EQ(got.bounces, 4);
  LinkTouchAxis axes[2];
  std::memcpy(axes, reply + kReplyHeaderBytes + 10 + sizeof(got), sizeof(axes));
  EXPECT_EQ(std::int64_t{axes[0].position}, 41);
  EXPECT_EQ(std::int64_t{axes[1].position}, 42);
  EXPECT_EQ(std::int64_t{axes[0].compensated}, 51);
  EXPECT_EQ(std::int64_t{axes[1].compensated}, 52);
  EXPECT_EQ(std::uint32_t{axes[0].uncertainty}, 0u);
  EXPECT_EQ(std::uint32_t{axes[1].uncertainty}, UINT32_MAX) << "the most that the field holds";
}

std::uint64_t from_environment(const char* name, std::uint64_t value) {
  const char* text = std::getenv(name);
  return text != nullptr ? std::strtoull(text, nullptr, 10) : value;
}

// Any bytes get an answer of bounded size, harm nothing, and never bring an image in. VERNIER_SEED and
// VERNIER_COUNT repeat or extend a run.
TEST_F(LinkTest, AnyRequestIsAnsweredAndNoneGetsAnImageIn) {
  const std::uint64_t seed = from_environment("VERNIER_SEED", 20241),
                      count = from_environment("VERNIER_COUNT", 200000);
  std::printf("seed %llu, %llu requests\n", static_cast<unsigned long long>(seed),
              static_cast<unsigned long long>(count));
  rig_.run(50);
  std::mt19937_64 random(seed);
  // Good uploads of a stranger are part of the attack.
  const auto stranger = make_upload(small_image_bytes(9e-5), new_key(), 1'000'000, 0);
  std::uint64_t answered = 0;
  for (std::uint64_t i = 0; i < count; ++i) {
    std::uint8_t request[kMaxRequestBytes + 20], reply[kMaxReplyBytes];
    auto size = static_cast<std::uint32_t>(random() % sizeof(request));
    for (std::uint8_t& byte : request) byte = static_cast<std::uint8_t>(random());
    if (random() % 2 == 0) request[0] = static_cast<std::uint8_t>(random() % (kLinkOpCount + 1));
    if (random() % 3 == 0) size = static_cast<std::uint32_t>(random() % 12);
    const auto op = static_cast<LinkOp>(request[0]);
    if (op == LinkOp::kBegin && random() % 2 == 0) {
      const auto bytes =
          static_cast<std::uint32_t>(random() % 2 == 0 ? stranger.size() : random() % (1 << 17));
      std::memcpy(request + 2, &bytes, sizeof(bytes)), size = 6;
    }
    if (op == LinkOp::kData && random() % 2 == 0) {
      const auto offset = static_cast<std::uint32_t>(random() % stranger.size() / 230 * 230);
      const auto piece = std::min<std::uint32_t>(230, static_cast<std::uint32_t>(stranger.size()) - offset);
      std::memcpy(request + 2, &offset, sizeof(offset)),
          std::memcpy(request + 6, stranger.data() + offset, piece);
      size = 6 + piece;
    }
    const std::uint32_t bytes = link_.answer(request, size, reply, TimeUs(1));
    ASSERT_LE(bytes, kMaxReplyBytes);
    if (size < kRequestHeaderBytes) {
      ASSERT_EQ(bytes, 0u);
      continue;
    }
    ASSERT_GE(bytes, kReplyHeaderBytes);
    ASSERT_EQ(std::memcmp(reply, request, 2), 0);
    ASSERT_LT(reply[2], kLinkStatusCount);
    ++answered;
    ASSERT_EQ(rig_.uploader().slots().trial(), kNoSlot);
    ASSERT_EQ(rig_.uploader().slots().confirmed(), kNoSlot);
    if (i % 1000 == 0) rig_.run(1);
  }
  EXPECT_GT(answered, count / 2);
}

}  // namespace
}  // namespace vernier::link_test
