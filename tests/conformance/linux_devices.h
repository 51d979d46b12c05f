// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <linux/can.h>
#include <sys/socket.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "hal/linux/can/can_axis_frame.h"

namespace vernier {

/// A directory of its own, laid out as sysfs is, that goes away at the end.
class SysfsDirectory {
 public:
  explicit SysfsDirectory(const std::string& root) : root_(root) {
    std::filesystem::create_directories(root_);
  }
  ~SysfsDirectory() { std::filesystem::remove_all(root_); }
  SysfsDirectory(const SysfsDirectory&) = delete;
  SysfsDirectory& operator=(const SysfsDirectory&) = delete;

  const std::string& path() const { return root_; }
  void put(const std::string& name, const std::string& text) const {
    const std::filesystem::path path = root_ + "/" + name;
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path) << text << '\n';
  }
  /// The first line; a plain file keeps what a longer text has left behind it, an attribute does not.
  std::string get(const std::string& name) const {
    std::ifstream file(root_ + "/" + name);
    std::string line;
    std::getline(file, line);
    return line;
  }
  /// Every write to this attribute fails, as the device is full.
  void break_writes(const std::string& name) const {
    std::filesystem::remove(root_ + "/" + name);
    std::filesystem::create_symlink("/dev/full", root_ + "/" + name);
  }

 private:
  std::string root_;
};

/// A bus without a kernel that has one: two joined sockets that keep frames apart, as a CAN socket does.
class JoinedSockets {
 public:
  JoinedSockets() {
    int ends[2] = {-1, -1};
    if (::socketpair(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0, ends) == 0)
      near_ = ends[0], far_ = ends[1];
  }
  ~JoinedSockets() {
    if (far_ >= 0) ::close(far_);
  }
  JoinedSockets(const JoinedSockets&) = delete;
  JoinedSockets& operator=(const JoinedSockets&) = delete;

  /// The reader's end, which the reader closes.
  int near() const { return near_; }
  bool send(const can_frame& frame) const {
    return ::send(far_, &frame, sizeof(frame), 0) == static_cast<ssize_t>(sizeof(frame));
  }
  /// The next frame of the reader's end; without one, an empty frame.
  can_frame receive() const {
    can_frame frame{};
    if (::recv(far_, &frame, sizeof frame, MSG_DONTWAIT) != static_cast<ssize_t>(sizeof frame)) frame = {};
    return frame;
  }
  /// Nothing can be sent any more, in both directions.
  void cut() {
    if (far_ >= 0) ::close(far_);
    far_ = -1;
  }
  bool send(std::uint32_t id, const CanAxisFrame& content) const {
    can_frame frame{};
    frame.can_id = id;
    frame.can_dlc = CanAxisFrame::kBytes;
    encode_axis_frame(content, frame.data);
    return send(frame);
  }

 private:
  int near_ = -1, far_ = -1;
};

}  // namespace vernier
