// SPDX-License-Identifier: Apache-2.0
#include "firmware/core/link/link.h"

#include <algorithm>
#include <cstring>

#include "comp/fixed.h"

namespace vernier {

/// Reads values from a request; after a read beyond its end no further values are read.
class Link::Reader {
 public:
  Reader(const std::uint8_t* bytes, std::uint32_t size) : bytes_(bytes), left_(size) {}
  template <class T>
  T take() {
    T value{};
    if (left_ < sizeof(T)) return good_ = false, value;
    std::memcpy(&value, bytes_, sizeof(T));
    bytes_ += sizeof(T), left_ -= static_cast<std::uint32_t>(sizeof(T));
    return value;
  }
  const std::uint8_t* rest() const { return bytes_; }
  std::uint32_t left() const { return left_; }
  /// All values were present and no byte remains.
  bool complete() const { return good_ && left_ == 0; }
  bool good() const { return good_; }

 private:
  const std::uint8_t* bytes_;
  std::uint32_t left_;
  bool good_ = true;
};

/// Writes a reply; what does not fit is refused as a whole.
class Link::Writer {
 public:
  Writer(std::uint8_t* bytes, std::uint32_t room) : bytes_(bytes), room_(room) {}
  template <class T>
  bool put(const T& value) {
    return put_bytes(&value, sizeof(T));
  }
  bool put_bytes(const void* from, std::size_t size) {
    if (size > room_ - used_) return false;
    if (size > 0) std::memcpy(bytes_ + used_, from, size);
    used_ += static_cast<std::uint32_t>(size);
    return true;
  }
  void put_name(const Name& name) {
    char padded[kImageNameBytes] = {};
    std::memcpy(padded, name.c_str(), name.size());
    put_bytes(padded, sizeof(padded));
  }
  std::uint32_t used() const { return used_; }
  std::uint32_t room() const { return room_ - used_; }
  void cut(std::uint32_t used) { used_ = used; }
  std::uint8_t* at(std::uint32_t offset) { return bytes_ + offset; }

 private:
  std::uint8_t* bytes_;
  std::uint32_t room_, used_ = 0;
};

Link::Link(Exchange& exchange, Uploader& uploader, const Wiring& wiring, TimeUs tick,
           const BoardIdentity& identity)
    : exchange_(exchange), uploader_(uploader), wiring_(wiring), tick_(tick), identity_(identity) {}

std::uint32_t Link::answer(const std::uint8_t* request, std::uint32_t size, std::uint8_t* reply, TimeUs now) {
  if (size < kRequestHeaderBytes) return 0;
  reply[0] = request[0], reply[1] = request[1];
  Writer out(reply + kReplyHeaderBytes, kMaxReplyBytes - kReplyHeaderBytes);
  LinkStatus status = LinkStatus::kUnknownOp;
  if (size > kMaxRequestBytes) {
    status = LinkStatus::kBadLength;
  } else if (request[0] != 0 && request[0] < kLinkOpCount) {
    Reader in(request + kRequestHeaderBytes, size - kRequestHeaderBytes);
    status = run(static_cast<LinkOp>(request[0]), in, out, now);
  }
  // A refusal contains its reason; other failures have no reason.
  if (status != LinkStatus::kDone && status != LinkStatus::kRefused) out.cut(0);
  reply[2] = static_cast<std::uint8_t>(status);
  return kReplyHeaderBytes + out.used();
}

bool Link::needs_store(const std::uint8_t* request, std::uint32_t size) noexcept {
  if (size < kRequestHeaderBytes) return false;
  const auto op = static_cast<LinkOp>(request[0]);
  return op == LinkOp::kFinish || op == LinkOp::kConfirm || op == LinkOp::kRevert || op == LinkOp::kRead;
}

bool Link::may_need_store(const std::uint8_t* request, std::uint32_t size) noexcept {
  if (size < kRequestHeaderBytes) return false;
  const auto op = static_cast<LinkOp>(request[0]);
  return needs_store(request, size) || op == LinkOp::kBegin || op == LinkOp::kData || op == LinkOp::kSigned;
}

bool Link::is_setting(const std::uint8_t* request, std::uint32_t size) noexcept {
  if (size < kRequestHeaderBytes) return false;
  const auto op = static_cast<LinkOp>(request[0]);
  return op == LinkOp::kCommand || op == LinkOp::kWeight;
}

std::uint32_t Link::answer_with(LinkStatus status, const std::uint8_t* request,
                                std::uint8_t* reply) noexcept {
  reply[0] = request[0], reply[1] = request[1];
  reply[2] = static_cast<std::uint8_t>(status);
  return kReplyHeaderBytes;
}

LinkStatus Link::run(LinkOp op, Reader& in, Writer& out, TimeUs now) {
  switch (op) {
    case LinkOp::kHello:
      return in.complete() ? hello(out) : LinkStatus::kBadLength;
    case LinkOp::kName:
      return name(in, out);
    case LinkOp::kTick:
      return in.complete() ? newest(out) : LinkStatus::kBadLength;
    case LinkOp::kHistory:
      return history(in, out);
    case LinkOp::kHealth:
      return health(in, out);
    case LinkOp::kSlots:
      return in.complete() ? slots(out, now) : LinkStatus::kBadLength;
    case LinkOp::kRead:
      return read(in, out);
    case LinkOp::kCommand: {
      const auto command = in.take<std::uint8_t>();
      return in.complete() ? give(command) : LinkStatus::kBadLength;
    }
    case LinkOp::kWeight:
      return weight(in);
    case LinkOp::kShares:
      return shares(in, out);
    case LinkOp::kShareName:
      return share_name(in, out);
    case LinkOp::kState:
      return in.complete() ? state(out) : LinkStatus::kBadLength;
    case LinkOp::kTouches:
      return touches(in, out);
    case LinkOp::kWorkpiece:
      return workpiece(in);
    case LinkOp::kIdentify:
    case LinkOp::kChallenge:
    case LinkOp::kSigned:
      return LinkStatus::kUnknownOp;  // executed by Gate
    case LinkOp::kBegin:
    case LinkOp::kData:
    case LinkOp::kFinish:
    case LinkOp::kConfirm:
    case LinkOp::kRevert:
      return upload(op, in, out);
  }
  return LinkStatus::kUnknownOp;
}

LinkStatus Link::hello(Writer& out) const {
  HelloReply reply{};
  reply.link_version = kLinkVersion;
  reply.image_version = static_cast<std::uint16_t>(kImageFormatVersion);
  reply.tick_us = static_cast<std::uint32_t>(tick_.count);
  reply.capacity = uploader_.capacity();
  reply.axes = static_cast<std::uint8_t>(wiring_.axes.size());
  reply.inputs = static_cast<std::uint8_t>(wiring_.inputs.size());
  reply.has_key = identity_.keys.empty() ? 0 : 1;
  if (!identity_.keys.empty()) std::memcpy(reply.key, identity_.keys[0].key.data(), sizeof(reply.key));
  std::memcpy(reply.board, identity_.board.c_str(), identity_.board.size());
  std::memcpy(reply.board_class, identity_.board_class.c_str(), identity_.board_class.size());
  out.put(reply);
  return LinkStatus::kDone;
}

LinkStatus Link::name(Reader& in, Writer& out) const {
  const auto kind = in.take<std::uint8_t>();
  const auto index = in.take<std::uint8_t>();
  if (!in.complete()) return LinkStatus::kBadLength;
  const bool known = kind == 0 ? index < wiring_.axes.size() : kind == 1 && index < wiring_.inputs.size();
  if (!known) return LinkStatus::kBadValue;
  out.put_name(kind == 0 ? wiring_.axes[index].name : wiring_.inputs[index]);
  std::uint8_t flags = 0;
  if (kind == 0)
    flags = static_cast<std::uint8_t>((wiring_.axes[index].rotary ? std::uint32_t{kRotary} : 0u) |
                                      (wiring_.axes[index].rollover ? std::uint32_t{kRollover} : 0u));
  out.put(flags);
  return LinkStatus::kDone;
}

bool Link::put_tick(Writer& out, std::uint64_t number, const TickRecord& tick) const {
  const std::size_t bytes =
      sizeof(LinkTick) + wiring_.axes.size() * sizeof(LinkAxis) + wiring_.inputs.size() * sizeof(LinkInput);
  if (bytes > out.room()) return false;
  out.put(LinkTick{number, tick.time_us, tick.feed_nm_per_min, tick.mode, tick.fault, tick.holding,
                   tick.saturated});
  for (std::size_t i = 0; i < wiring_.axes.size(); ++i)
    out.put(LinkAxis{tick.position[i], tick.correction[i], tick.sense[i]});
  for (std::size_t i = 0; i < wiring_.inputs.size(); ++i)
    out.put(LinkInput{narrow(clamp<std::int64_t>(tick.input[i] / 1000, INT32_MIN, INT32_MAX))});
  return true;
}

LinkStatus Link::newest(Writer& out) const {
  const std::uint64_t count = exchange_.ticks.count();
  TickRecord tick;
  // Before the first tick this is the largest number, which was not written yet.
  if (!exchange_.ticks.read(count - 1, tick)) return LinkStatus::kNotReady;
  return put_tick(out, count - 1, tick) ? LinkStatus::kDone : LinkStatus::kNotReady;
}

LinkStatus Link::history(Reader& in, Writer& out) const {
  const auto first = in.take<std::uint64_t>();
  const auto every = in.take<std::uint16_t>();
  if (!in.complete()) return LinkStatus::kBadLength;
  if (every == 0) return LinkStatus::kBadValue;
  // Some distance from the end that is being overwritten: the named record is still present.
  const std::uint32_t distance = exchange_.ticks.size() / 64;
  const std::uint64_t oldest = exchange_.ticks.oldest() + (exchange_.ticks.oldest() > 0 ? distance : 0);
  std::uint64_t next = std::max(first, oldest);
  const std::uint64_t lost = next - first;
  out.put(next);
  out.put(static_cast<std::uint16_t>(std::min<std::uint64_t>(lost, UINT16_MAX)));
  for (TickRecord tick; exchange_.ticks.read(next, tick); next += every)
    if (!put_tick(out, next, tick)) break;
  std::memcpy(out.at(0), &next, sizeof(next));
  return LinkStatus::kDone;
}

LinkStatus Link::health(Reader& in, Writer& out) const {
  constexpr std::uint8_t kCounters = sizeof(HealthRecord) / sizeof(std::uint64_t);
  const auto first = in.take<std::uint8_t>();
  if (!in.complete()) return LinkStatus::kBadLength;
  if (first >= kCounters) return LinkStatus::kBadValue;
  HealthRecord record;
  if (!exchange_.health.read(record)) return LinkStatus::kNotReady;
  std::uint64_t words[kCounters];
  std::memcpy(words, &record, sizeof(record));
  out.put(kCounters);
  for (std::uint8_t i = first; i < kCounters; ++i)
    if (!out.put(words[i])) break;
  return LinkStatus::kDone;
}

LinkStatus Link::slots(Writer& out, TimeUs now) const {
  const SlotsRecord record = uploader_.record();
  SlotsReply reply{};
  reply.confirmed = record.confirmed;
  reply.trial = record.trial;
  reply.confirmed_fingerprint = record.confirmed_fingerprint;
  reply.trial_fingerprint = record.trial_fingerprint;
  reply.issued = record.issued;
  reply.newest_issued = record.newest_issued;
  reply.security = record.security;
  reply.trial_left_ms =
      static_cast<std::uint32_t>(clamp<std::int64_t>(uploader_.trial_left(now).count / 1000, 0, UINT32_MAX));
  out.put(reply);
  return LinkStatus::kDone;
}

LinkStatus Link::read(Reader& in, Writer& out) {
  const auto offset = in.take<std::uint32_t>();
  const auto size = in.take<std::uint8_t>();
  if (!in.complete()) return LinkStatus::kBadLength;
  std::uint8_t bytes[UINT8_MAX];
  if (size == 0 || size > out.room()) return LinkStatus::kBadValue;
  if (uploader_.read_confirmed(offset, bytes, size) != HalFault::kNone) return LinkStatus::kNotReady;
  out.put_bytes(bytes, size);
  return LinkStatus::kDone;
}

LinkStatus Link::give(std::uint8_t command) {
  if (command == 0 || command >= kCommandCount) return LinkStatus::kBadValue;
  Command none = Command::kNone;
  return exchange_.command.compare_exchange_strong(none, static_cast<Command>(command))
             ? LinkStatus::kDone
             : LinkStatus::kNotReady;
}

LinkStatus Link::weight(Reader& in) {
  const auto axis = in.take<std::uint8_t>();
  const auto weight = in.take<std::uint32_t>();
  if (!in.complete()) return LinkStatus::kBadLength;
  if (axis >= wiring_.axes.size() || weight > static_cast<std::uint32_t>(kFullWeight.count))
    return LinkStatus::kBadValue;
  exchange_.axis_weight[axis].store(static_cast<std::int32_t>(weight));
  return LinkStatus::kDone;
}

namespace {

/// The running program, protected from removal while it is read.
class Look {
 public:
  explicit Look(Programs& programs) : programs_(programs), program_(programs.look()) {}
  ~Look() { programs_.look_away(); }
  Look(const Look&) = delete;
  Look& operator=(const Look&) = delete;
  const LoadedProgram* program() const { return program_; }

 private:
  Programs& programs_;
  const LoadedProgram* program_;
};

}  // namespace

Link::Running Link::running(const LoadedProgram* program) const {
  Running found;
  if (program != nullptr) found.fingerprint = program->header.fingerprint;
  const SlotsRecord slots = uploader_.record();
  const bool trial = slots.trial != kNoSlot && found.fingerprint == slots.trial_fingerprint;
  found.image = found.fingerprint == 0 ? (uploader_.image_lost() ? ImageState::kLost : ImageState::kNone)
                : trial                ? ImageState::kTrial
                                       : ImageState::kConfirmed;
  return found;
}

std::uint32_t Link::setting_flags() const noexcept {
  const std::uint32_t flags = exchange_.setting_flags.load(std::memory_order_relaxed);
  return uploader_.damaged() ? flags | kImageRecordDamaged : flags;
}

LinkStatus Link::state(Writer& out) {
  StateRecord record;
  if (exchange_.ticks.count() == 0 || !exchange_.state.read(record)) return LinkStatus::kNotReady;
  const Look look(uploader_.programs());
  const Running now = running(look.program());
  out.put(LinkState{now.fingerprint,
                    record.since_us,
                    record.weight,
                    static_cast<std::uint8_t>(now.image),
                    static_cast<std::uint8_t>(setting_flags()),
                    {}});
  for (std::size_t i = 0; i < wiring_.axes.size(); ++i)
    out.put(LinkAxisState{record.wanted[i], record.achieved[i],
                          static_cast<std::uint32_t>(record.axis_weight[i]), record.limits[i]});
  return LinkStatus::kDone;
}

// The published data may belong to a program that was removed, or that was not collected yet.
bool Link::work_out_shares(const LoadedProgram& program) {
  if (!exchange_.equation.read(equation_) || equation_.programs != program.number.load()) return false;
  return run_shares(program.view.shares(), program.view.program(), equation_.state, registers_, shares_);
}

LinkStatus Link::shares(Reader& in, Writer& out) {
  const auto first = in.take<std::uint16_t>();
  if (!in.complete()) return LinkStatus::kBadLength;
  const Look look(uploader_.programs());
  const LoadedProgram* const program = look.program();
  if (program == nullptr || !work_out_shares(*program)) return LinkStatus::kNotReady;
  const View<Share>& shares = program->view.shares().shares;
  if (first > shares.size) return LinkStatus::kBadValue;
  out.put(static_cast<std::uint16_t>(shares.size));
  out.put(equation_.programs);
  for (std::uint32_t i = first; i < shares.size; ++i)
    if (!out.put(LinkShare{static_cast<std::uint8_t>(program->axis[shares[i].axis]), shares_[i].counts}))
      break;
  return LinkStatus::kDone;
}

LinkStatus Link::share_name(Reader& in, Writer& out) {
  const auto index = in.take<std::uint16_t>();
  const auto programs = in.take<std::uint32_t>();
  if (!in.complete()) return LinkStatus::kBadLength;
  const Look look(uploader_.programs());
  const LoadedProgram* const program = look.program();
  if (program == nullptr || programs != program->number.load() || index >= program->view.share_names().size)
    return LinkStatus::kBadValue;
  out.put(program->view.share_names()[index]);
  return LinkStatus::kDone;
}

bool Link::put_touch(Writer& out, std::uint64_t number, const TouchRecord& touch) const {
  if (sizeof(LinkTouch) + wiring_.axes.size() * sizeof(LinkTouchAxis) > out.room()) return false;
  LinkTouch head{number,       touch.time_ns, {},         touch.lost_edges, touch.lost_touches,
                 touch.spikes, touch.missing, touch.kind, touch.fault,      touch.flags,
                 touch.bounces};
  for (int i = 0; i < 3; ++i) head.workpiece_nm[i] = touch.workpiece_nm[i];
  out.put(head);
  for (std::size_t i = 0; i < wiring_.axes.size(); ++i) {
    const auto uncertainty =
        static_cast<std::uint32_t>(clamp<std::int64_t>(touch.uncertainty[i], 0, UINT32_MAX));
    out.put(LinkTouchAxis{touch.position[i], touch.compensated[i], uncertainty});
  }
  return true;
}

LinkStatus Link::touches(Reader& in, Writer& out) const {
  const auto first = in.take<std::uint64_t>();
  if (!in.complete()) return LinkStatus::kBadLength;
  std::uint64_t next = std::max(first, exchange_.touches.oldest());
  out.put(next);
  out.put(static_cast<std::uint16_t>(std::min<std::uint64_t>(next - first, UINT16_MAX)));
  for (TouchRecord touch; exchange_.touches.read(next, touch); ++next)
    if (!put_touch(out, next, touch)) break;
  std::memcpy(out.at(0), &next, sizeof(next));
  return LinkStatus::kDone;
}

LinkStatus Link::workpiece(Reader& in) {
  const auto frame = in.take<WorkpieceFrame>();
  if (!in.complete()) return LinkStatus::kBadLength;
  if (!frame.valid()) return LinkStatus::kBadValue;
  exchange_.workpiece.publish(frame);
  return LinkStatus::kDone;
}

LinkStatus Link::upload(LinkOp op, Reader& in, Writer& out) {
  UploadResult result;
  if (op == LinkOp::kBegin) {
    const auto bytes = in.take<std::uint32_t>();
    if (!in.complete()) return LinkStatus::kBadLength;
    const Trial trial = uploader_.programs().trial();
    // The trial before is being put away.
    if (trial == Trial::kOver || trial == Trial::kKept) return LinkStatus::kNotReady;
    result = uploader_.begin(bytes);
  } else if (op == LinkOp::kData) {
    const auto offset = in.take<std::uint32_t>();
    if (!in.good()) return LinkStatus::kBadLength;
    result = uploader_.add(offset, in.rest(), in.left());
  } else if (!in.complete()) {
    return LinkStatus::kBadLength;
  } else {
    result = op == LinkOp::kFinish    ? uploader_.finish()
             : op == LinkOp::kConfirm ? uploader_.confirm()
                                      : uploader_.revert();
  }
  if (result.fault == UploadFault::kNone) return LinkStatus::kDone;
  out.put(static_cast<std::uint8_t>(result.fault));
  out.put(static_cast<std::uint8_t>(result.image));
  out.put(static_cast<std::uint8_t>(result.bind));
  out.put_bytes(result.offender.c_str(), result.offender.size());
  return LinkStatus::kRefused;
}

namespace {

void put_pair(std::uint16_t* at, std::int64_t value) {
  const auto word = static_cast<std::uint32_t>(clamp<std::int64_t>(value, INT32_MIN, INT32_MAX));
  at[0] = static_cast<std::uint16_t>(word >> 16);
  at[1] = static_cast<std::uint16_t>(word & 0xffff);
}

// Counts of 2^-32 turn in parts of a degree: parts_per_turn up to 360 million, counts below 2^31 turns.
std::int64_t turns_to(std::int64_t counts, std::int64_t parts_per_turn) {
  const std::int64_t turns = counts >> 32, rest = counts & 0xffffffff;
  return turns * parts_per_turn + ((rest * (parts_per_turn / 8)) >> 29);
}

// Shares of 65536 in hundredths of a percent.
std::uint16_t share_of(std::uint32_t weight) {
  return static_cast<std::uint16_t>((std::uint64_t{weight} * 10'000 + 32768) >> 16);
}

}  // namespace

void Link::fill_state(std::uint16_t* values, const TickRecord& tick) {
  StateRecord state;
  if (!exchange_.state.read(state)) return;
  const Look look(uploader_.programs());
  const Running now = running(look.program());
  values[kLiveImage] = static_cast<std::uint16_t>(now.image);
  values[kLiveWeight] = share_of(state.weight);
  values[kLiveLimits] = tick.saturated;
  put_pair(values + kLiveSince, now.fingerprint == 0 ? 0 : (tick.time_us - state.since_us) / 1'000'000);
  for (int i = 0; i < 4; ++i)
    values[kLiveFingerprint + i] = static_cast<std::uint16_t>(now.fingerprint >> (48 - 16 * i));
  for (std::uint32_t i = 0; i < wiring_.axes.size(); ++i)
    values[kLiveAxisWeights + static_cast<int>(i)] =
        share_of(static_cast<std::uint32_t>(state.axis_weight[i]));
}

void Link::fill_registers(std::uint16_t* values) {
  std::fill_n(values, int{kLiveRegisters}, std::uint16_t{0});
  values[kLiveLayout] = kLinkVersion;
  TickRecord tick;
  HealthRecord health;
  const std::uint64_t count = exchange_.ticks.count();
  if (!exchange_.ticks.read(count - 1, tick) || !exchange_.health.read(health)) return;
  values[kLiveMode] = tick.mode;
  values[kLiveFault] = tick.fault;
  values[kLiveHolding] = tick.holding;
  values[kLiveSettings] = static_cast<std::uint16_t>(setting_flags());
  fill_state(values, tick);
  put_pair(values + kLiveTicks, static_cast<std::int32_t>(static_cast<std::uint32_t>(count)));
  put_pair(values + kLiveOverruns, static_cast<std::int64_t>(health.overruns));
  values[kLiveLatency] =
      static_cast<std::uint16_t>(clamp<std::int64_t>(health.latency_ns[1] / 1000, 0, UINT16_MAX));
  for (std::size_t i = 0; i < wiring_.axes.size(); ++i) {
    std::uint16_t* const at = values + kLiveAxes + kLiveRegistersPerAxis * static_cast<int>(i);
    const bool rotary = wiring_.axes[i].rotary;
    put_pair(at, rotary ? turns_to(tick.position[i], 360'000) : tick.position[i] / 1000);
    put_pair(at + 2, rotary ? turns_to(tick.correction[i], 360'000'000) : tick.correction[i] / 10);
  }
  for (std::size_t i = 0; i < wiring_.inputs.size(); ++i)
    put_pair(values + kLiveInputs + 2 * static_cast<int>(i), tick.input[i] / 1000);
}

}  // namespace vernier
