// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <httplib.h>

#include <chrono>
#include <string>

namespace vernier::http {

using Clock = std::chrono::steady_clock;

/// Connection of a client, with the received bytes that no request has used yet.
struct Connection {
  explicit Connection(int socket);
  ~Connection();
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  /// Reads the bytes that have arrived, without waiting for more. Returns false if the client has closed the
  /// connection.
  bool take_bytes();
  /// True if the header has arrived completely. After the header has arrived completely, header_bytes and
  /// body_bytes are the sizes of the header and the body of the request.
  bool has_header();
  /// True if the header and the body have arrived completely. The test for a complete request does not wait
  /// for a body larger than `most_body`, or for a body whose length the header does not state.
  bool has_request(std::size_t most_body);

  int fd;
  std::string peer;  // IP address of the client
  std::string bytes;
  std::size_t header_bytes = 0, body_bytes = 0;  // sizes for the first request in `bytes`; 0: not yet known
  Clock::time_point due;
};

/// Stream that the HTTP library uses during one request. A single wait is not longer than `pause`, and no
/// wait ends later than `end`.
class RequestStream : public httplib::Stream {
 public:
  RequestStream(Connection& connection, Clock::duration pause, Clock::time_point end)
      : connection_(connection), pause_(pause), end_(end) {}
  /// The destructor removes the bytes that the request used.
  ~RequestStream() override {
    connection_.bytes.erase(0, at_);
    connection_.header_bytes = connection_.body_bytes = 0;
  }
  RequestStream(const RequestStream&) = delete;
  RequestStream& operator=(const RequestStream&) = delete;

  bool is_readable() const override;
  bool is_writable() const override;
  ssize_t read(char* bytes, std::size_t size) override;
  ssize_t write(const char* bytes, std::size_t size) override;
  void get_remote_ip_and_port(std::string& ip, int& port) const override;
  void get_local_ip_and_port(std::string& ip, int& port) const override;
  socket_t socket() const override { return connection_.fd; }

 private:
  bool wait(short events) const;

  Connection& connection_;
  Clock::duration pause_;
  Clock::time_point end_;
  std::size_t at_ = 0;  // number of bytes of the connection that were used
};

}  // namespace vernier::http
