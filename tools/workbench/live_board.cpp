// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/workbench/live_board.h"

#include <chrono>

#include "tools/text/error.h"
#include "tools/upload/live.h"
#include "tools/upload/open_transport.h"
#include "tools/workbench/runs/now.h"

namespace vernier::workbench {
namespace {

using namespace std::chrono_literals;
constexpr std::size_t kKept = 200;

}  // namespace

LiveBoard::~LiveBoard() { end(); }

void LiveBoard::end() {
  {
    const std::scoped_lock lock(guard_);
    stop_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
  const std::scoped_lock lock(guard_);
  stop_ = false;
}

void LiveBoard::look(const std::string& url) {
  upload::Client client(upload::open_transport(upload::parse_url(url)));
  const auto period = std::chrono::duration<double>(1 / kLiveRateHz);
  auto due = std::chrono::steady_clock::now();
  while (true) {
    nlohmann::ordered_json picture = upload::live_json(client.info(), client.newest(), client.health(),
                                                       client.slots(), client.shares(), client.state());
    std::unique_lock lock(guard_);
    picture["seq"] = next_++;
    picture["at_s"] = steady_s();
    kept_.push_back(std::move(picture));
    if (kept_.size() > kKept) kept_.pop_front();
    changed_.notify_all();
    due = std::max(due + std::chrono::duration_cast<std::chrono::steady_clock::duration>(period),
                   std::chrono::steady_clock::now());
    if (changed_.wait_until(lock, due, [&] { return stop_; }) || steady_s() - asked_s_ > kLetGoS) return;
  }
}

void LiveBoard::watch(const std::string& url) {
  std::string error;
  try {
    look(url);
  } catch (const std::exception& why) {
    error = why.what();
  }
  const std::scoped_lock lock(guard_);
  error_ = error;
  running_ = false;
  changed_.notify_all();
}

nlohmann::ordered_json LiveBoard::pictures(const std::string& url, std::uint64_t after) {
  upload::parse_url(url);
  {
    const std::scoped_lock exchange(ending_);
    std::unique_lock lock(guard_);
    asked_s_ = steady_s();
    if (url != url_ || !running_) {
      lock.unlock();
      end();
      lock.lock();
      if (url != url_) kept_.clear();
      url_ = url;
      error_.clear();
      running_ = true;
      thread_ = std::thread([this, url] { watch(url); });
    }
  }
  std::unique_lock lock(guard_);
  const auto newer = [&] { return !kept_.empty() && kept_.back()["seq"].get<std::uint64_t>() > after; };
  changed_.wait_for(lock, 500ms, [&] { return newer() || !running_ || stop_; });
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const auto& picture : kept_)
    if (picture["seq"].get<std::uint64_t>() > after) list.push_back(picture);
  return {{"pictures", list},
          {"error", error_.empty() ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(error_)}};
}

}  // namespace vernier::workbench
