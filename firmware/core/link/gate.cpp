// SPDX-License-Identifier: Apache-2.0
#include "firmware/core/link/gate.h"

#include <cstring>

#include "firmware/core/link/sha512.h"

namespace vernier {

LinkAccess access_needed(LinkOp op) noexcept {
  switch (op) {
    case LinkOp::kCommand:
    case LinkOp::kWeight:
    case LinkOp::kWorkpiece:
    case LinkOp::kRevert:
      return LinkAccess::kCommand;
    case LinkOp::kBegin:
    case LinkOp::kData:
    case LinkOp::kFinish:
    case LinkOp::kConfirm:
    case LinkOp::kRead:
      return LinkAccess::kUpload;
    default:
      return LinkAccess::kRead;
  }
}

// The pieces of an upload need no signature: the complete upload is signed.
bool signature_needed(LinkOp op) noexcept {
  return op != LinkOp::kData && access_needed(op) != LinkAccess::kRead;
}

bool Gate::is_challenge(const std::uint8_t* request, std::uint32_t size) noexcept {
  return size == kRequestHeaderBytes && request[0] == static_cast<std::uint8_t>(LinkOp::kChallenge);
}

// The first bits of SHA-512 over seed, nonce and a counter of 64 bits: without the seed they are random.
ChallengeBytes Gate::fresh() noexcept {
  std::uint8_t counted[8], digest[Sha512::kBytes];
  ++counter_;
  std::uint64_t rest = counter_;
  for (std::uint8_t& byte : counted) {
    byte = static_cast<std::uint8_t>(rest);
    rest >>= 8;
  }
  Sha512 hash;
  hash.add(seed_.data(), static_cast<std::uint32_t>(seed_.size()));
  hash.add(nonce_.data(), static_cast<std::uint32_t>(nonce_.size()));
  hash.add(counted, sizeof(counted));
  hash.finish(digest);
  ChallengeBytes bytes;
  std::memcpy(bytes.data(), digest, bytes.size());
  return bytes;
}

Gate::Challenge* Gate::of(const Caller& from) noexcept {
  for (Challenge& challenge : open_)
    if (challenge.open && challenge.from == from) return &challenge;
  return nullptr;
}

Gate::Challenge& Gate::place_for(const Caller& from) noexcept {
  if (Challenge* const own = of(from); own != nullptr) return *own;
  Challenge* oldest = nullptr;
  for (Challenge& challenge : open_) {
    if (!challenge.open) return challenge;
    if (oldest == nullptr) oldest = &challenge;
    const bool same = challenge.from.link == from.link, found = oldest->from.link == from.link;
    if (same != found ? same : challenge.given < oldest->given) oldest = &challenge;
  }
  return *oldest;
}

void Gate::forget(const Caller& from) noexcept {
  if (Challenge* const own = of(from); own != nullptr) own->open = false;
}

ChallengeReply Gate::challenge(LinkAccess access, const Caller& from, TimeUs now) noexcept {
  ChallengeReply reply{};
  std::memcpy(reply.nonce, nonce_.data(), nonce_.size());
  // No request over a link that only reads is signed: it takes no place in the table.
  if (access != LinkAccess::kRead) {
    const ChallengeBytes bytes = fresh();
    place_for(from) = {true, from, bytes, now};
    std::memcpy(reply.challenge, bytes.data(), bytes.size());
  }
  reply.access = static_cast<std::uint8_t>(access);
  reply.keys = static_cast<std::uint8_t>(identity_.keys.size());
  return reply;
}

bool Gate::is_identify(const std::uint8_t* request, std::uint32_t size) noexcept {
  return size >= kRequestHeaderBytes && request[0] == static_cast<std::uint8_t>(LinkOp::kIdentify);
}

LinkStatus Gate::identify(const std::uint8_t* request, std::uint32_t size, IdentifyReply& reply) noexcept {
  if (own_key_ == nullptr) return LinkStatus::kUnknownOp;
  IdentityHead head{};
  if (size != kRequestHeaderBytes + sizeof(head.asked_nonce)) return LinkStatus::kBadLength;
  std::memcpy(head.magic, kIdentityMagic, sizeof(head.magic));
  std::memcpy(head.asked_nonce, request + kRequestHeaderBytes, sizeof(head.asked_nonce));
  std::memcpy(head.start_nonce, nonce_.data(), nonce_.size());
  std::memcpy(head.board, identity_.board.c_str(), identity_.board.size());
  const auto* const message = reinterpret_cast<const std::uint8_t*>(&head);
  if (own_key_->sign(message, sizeof(head), reply.signature) != HalFault::kNone) return LinkStatus::kNotReady;
  std::memcpy(reply.start_nonce, nonce_.data(), nonce_.size());
  std::memcpy(reply.key, own_key_->public_half(), sizeof(reply.key));
  return LinkStatus::kDone;
}

// request: a signed one, whole.
LinkStatus Gate::check(const std::uint8_t* request, std::uint32_t size, const Caller& from,
                       TimeUs now) noexcept {
  SignedRequest head;
  std::memcpy(&head, request + kRequestHeaderBytes, sizeof(head));
  const std::uint8_t* const rest = request + kRequestHeaderBytes + sizeof(head);
  const TrustedKey* const key = identity_.find(head.key, sizeof(head.key));
  const bool for_upload = access_needed(static_cast<LinkOp>(rest[0])) == LinkAccess::kUpload;
  if (key == nullptr || key->retired || !(for_upload ? key->upload : key->command))
    return LinkStatus::kBadSignature;
  Challenge* const challenge = of(from);
  if (challenge == nullptr || now - challenge->given > kOpenFor ||
      std::memcmp(challenge->bytes.data(), head.challenge, sizeof(head.challenge)) != 0)
    return LinkStatus::kStale;
  SignedRequestHead over{};
  std::memcpy(over.magic, kRequestMagic, sizeof(over.magic));
  std::memcpy(over.nonce, nonce_.data(), nonce_.size());
  std::memcpy(over.challenge, head.challenge, sizeof(over.challenge));
  std::memcpy(over.board, identity_.board.c_str(), identity_.board.size());
  const std::uint32_t rest_bytes = size - kRequestHeaderBytes - static_cast<std::uint32_t>(sizeof(head));
  if (!signature_fits(bytes_of_head(over), {rest, rest_bytes}, head.signature, key->key))
    return LinkStatus::kBadSignature;
  challenge->open = false;
  return LinkStatus::kDone;
}

Gate::Opened Gate::open(const std::uint8_t* request, std::uint32_t size, LinkAccess access,
                        const Caller& from, TimeUs now) noexcept {
  Opened opened{LinkStatus::kDone, request, size};
  if (size < kRequestHeaderBytes || size > kMaxRequestBytes) return opened;
  if (request[0] == static_cast<std::uint8_t>(LinkOp::kSigned)) {
    constexpr std::uint32_t kHead = kRequestHeaderBytes + static_cast<std::uint32_t>(sizeof(SignedRequest));
    if (size <= kHead) return {LinkStatus::kBadLength, request, size};
    const auto inner = static_cast<LinkOp>(request[kHead]);
    if (access_needed(inner) > access) return {LinkStatus::kNotAllowed, request, size};
    if (const LinkStatus status = check(request, size, from, now); status != LinkStatus::kDone)
      return {status, request, size};
    opened.is_signed = true;
    inner_[0] = request[kHead];
    inner_[1] = request[1];
    opened.size = kRequestHeaderBytes + size - kHead - 1;
    std::memcpy(inner_ + kRequestHeaderBytes, request + kHead + 1, size - kHead - 1);
    opened.request = inner_;
  }
  const auto op = static_cast<LinkOp>(opened.request[0]);
  if (access_needed(op) > access)
    opened.status = LinkStatus::kNotAllowed;
  else if (signature_needed(op) && !opened.is_signed && !identity_.keys.empty())
    opened.status = LinkStatus::kUnsigned;
  return opened;
}

}  // namespace vernier
