// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/workbench/server.h"

#include <sys/random.h>

#include <array>
#include <chrono>
#include <mutex>
#include <thread>

#include "tools/http/gated_server.h"
#include "tools/text/error.h"
#include "tools/workbench/assets.h"

namespace vernier::workbench {
namespace {

constexpr const char* kContentPolicy =
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; connect-src "
    "'self'; "
    "frame-ancestors 'none'; base-uri 'none'; form-action 'none'";

/// Compares in a time that does not depend on the position of a difference.
bool same_secret(const std::string& a, const std::string& b) {
  if (a.size() != b.size()) return false;
  unsigned difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    difference |= static_cast<unsigned>(static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]));
  return difference == 0;
}

/// The value of a cookie; empty if it is absent.
std::string cookie(const std::string& header, const std::string& name) {
  std::size_t at = 0;
  while (at < header.size()) {
    const std::size_t end = std::min(header.find(';', at), header.size());
    while (at < end && header[at] == ' ') ++at;
    if (header.compare(at, name.size() + 1, name + "=") == 0)
      return header.substr(at + name.size() + 1, end - at - name.size() - 1);
    at = end + 1;
  }
  return {};
}

void refuse(httplib::Response& response, int status, const char* why) {
  response.status = status;
  response.set_content(std::string("vernier workbench: ") + why + "\n", "text/plain");
}

/// Sets a body that is sent unchanged: the library would compress texts, which only takes time on one
/// computer.
void set_plain(httplib::Response& response, std::string_view bytes, const std::string& type,
               std::shared_ptr<const std::string> owner = nullptr) {
  if (bytes.empty()) return response.set_content("", type);
  response.set_content_provider(
      bytes.size(), type,
      [bytes, owner = std::move(owner)](std::size_t offset, std::size_t length, httplib::DataSink& sink) {
        return sink.write(bytes.data() + offset, length);
      });
}

struct Asset {
  const char *path, *type;
  std::string_view (*text)();
};
constexpr std::array<Asset, 3> kAssets = {
    {{"/", "text/html; charset=utf-8", workbench_page},
     {"/workbench.js", "text/javascript; charset=utf-8", workbench_script},
     {"/workbench.css", "text/css; charset=utf-8", workbench_style}}};

}  // namespace

std::string new_token() {
  std::array<unsigned char, 32> bytes{};
  if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
    throw text::InputError("the operating system gives no random numbers for the token of a session");
  std::string text;
  for (const unsigned char byte : bytes) {
    text += "0123456789abcdef"[byte >> 4];
    text += "0123456789abcdef"[byte & 15];
  }
  return text;
}

struct WorkbenchServer::Inside {
  explicit Inside(Api& api_) : api(api_), token(new_token()) {}

  using Handled = httplib::Server::HandlerResponse;
  Handled guard(const httplib::Request& request, httplib::Response& response) const;
  bool is_ours(const httplib::Request& request) const;
  bool welcome(const httplib::Request& request, httplib::Response& response) const;
  void answer(const httplib::Request& request, httplib::Response& response) const;
  std::string host() const { return "127.0.0.1:" + std::to_string(port); }
  // Cookies do not depend on ports: each workbench on this computer has a different cookie name.
  std::string cookie_name() const { return "vernier_" + std::to_string(port); }

  Api& api;
  std::string token;
  int port = 0;
  http::GatedServer server;
  std::mutex guarded;
  bool ended = false, serving = false;
};

bool WorkbenchServer::Inside::is_ours(const httplib::Request& request) const {
  if (request.get_header_value_count("Host") != 1) return false;
  // localhost is this computer too (RFC 6761, 6.3); an attacker may have bound any other name to its address.
  const std::string name = request.get_header_value("Host");
  if (name != host() && name != "localhost:" + std::to_string(port)) return false;
  if (!request.has_header("Origin")) return true;
  return request.get_header_value("Origin") == "http://" + name;
}

/// The first visit: the token of the address becomes a cookie, and the address loses it.
bool WorkbenchServer::Inside::welcome(const httplib::Request& request, httplib::Response& response) const {
  if (request.method != "GET" || request.path != "/" || !request.has_param("token")) return false;
  if (!same_secret(request.get_param_value("token"), token)) return false;
  response.set_header("Set-Cookie", cookie_name() + "=" + token + "; Path=/; HttpOnly; SameSite=Strict");
  // A redirect would come without the cookie where the address was opened from elsewhere; a page of our own
  // that moves on does not.
  response.set_content(
      "<!doctype html><meta charset=utf-8><link rel=icon href='data:,'><meta http-equiv=refresh "
      "content='0;url=/'>",
      "text/html");
  return true;
}

WorkbenchServer::Inside::Handled WorkbenchServer::Inside::guard(const httplib::Request& request,
                                                                httplib::Response& response) const {
  if (!is_ours(request)) {
    refuse(response, 403, "the request does not come from the page of the workbench");
    return Handled::Handled;
  }
  if (welcome(request, response)) return Handled::Handled;
  if (!same_secret(cookie(request.get_header_value("Cookie"), cookie_name()), token)) {
    refuse(response, 401, "open the page at the address that the command printed");
    return Handled::Handled;
  }
  if (request.method == "GET") return Handled::Unhandled;
  if (!request.has_header("X-Vernier")) {
    refuse(response, 403, "the request does not come from the page of the workbench");
    return Handled::Handled;
  }
  // Bodies have a known length and are not compressed: their size is limited.
  if (request.has_header("Transfer-Encoding") || request.has_header("Content-Encoding") ||
      (request.method != "DELETE" && !request.has_header("Content-Length"))) {
    refuse(response, 411, "a request with a body must state its length");
    return Handled::Handled;
  }
  if (request.get_header_value<std::uint64_t>("Content-Length") > kMostBodyBytes) {
    refuse(response, 413, "the body of the request is larger than 64 MiB");
    response.set_header("Connection", "close");
    return Handled::Handled;
  }
  return Handled::Unhandled;
}

void WorkbenchServer::Inside::answer(const httplib::Request& request, httplib::Response& response) const {
  for (const Asset& asset : kAssets) {
    if (request.method != "GET" || request.path != asset.path) continue;
    set_plain(response, asset.text(), asset.type);
    return;
  }
  ApiReply reply = api.reply({request.method, request.path, request.params, request.body});
  response.status = reply.status;
  for (const auto& [name, value] : reply.headers) response.set_header(name, value);
  const auto body = std::make_shared<const std::string>(std::move(reply.body));
  set_plain(response, *body, reply.type, body);
}

WorkbenchServer::WorkbenchServer(Api& api, std::uint16_t port) : inside_(std::make_unique<Inside>(api)) {
  httplib::Server& server = inside_->server;
  Inside* const inside = inside_.get();
  server.set_payload_max_length(kMostBodyBytes);
  server.set_tcp_nodelay(true);
  server.set_pre_routing_handler(
      [inside](const auto& request, auto& response) { return inside->guard(request, response); });
  // The pre-routing handler may have set another policy (reports).
  server.set_post_routing_handler([](const httplib::Request&, httplib::Response& response) {
    if (!response.has_header("Content-Security-Policy"))
      response.set_header("Content-Security-Policy", kContentPolicy);
    response.set_header("X-Content-Type-Options", "nosniff");
    response.set_header("X-Frame-Options", "SAMEORIGIN");
    response.set_header("Referrer-Policy", "no-referrer");
    response.set_header("Cross-Origin-Resource-Policy", "same-origin");
    response.set_header("Cache-Control", "no-store");
  });
  const auto answer = [inside](const httplib::Request& request, httplib::Response& response) {
    inside->answer(request, response);
  };
  server.Get(".*", answer);
  server.Post(".*", answer);
  server.Put(".*", answer);
  server.Delete(".*", answer);
  if (port == 0)
    inside_->port = server.bind_to_any_port("127.0.0.1");
  else
    inside_->port = server.bind_to_port("127.0.0.1", port) ? port : -1;
  if (inside_->port <= 0)
    throw text::InputError("port " + std::to_string(port) + " of 127.0.0.1 cannot be had");
}

WorkbenchServer::~WorkbenchServer() = default;

std::uint16_t WorkbenchServer::port() const { return static_cast<std::uint16_t>(inside_->port); }
const std::string& WorkbenchServer::token() const { return inside_->token; }
std::string WorkbenchServer::url() const { return "http://" + inside_->host() + "/?token=" + inside_->token; }
void WorkbenchServer::serve() {
  {
    const std::scoped_lock lock(inside_->guarded);
    if (inside_->ended) return;
    inside_->serving = true;
  }
  inside_->server.listen_after_bind();
  const std::scoped_lock lock(inside_->guarded);
  inside_->serving = false;
}

void WorkbenchServer::stop() {
  std::unique_lock lock(inside_->guarded);
  inside_->ended = true;
  // The library forgets a stop that comes before it has begun to listen.
  while (inside_->serving && !inside_->server.is_running()) {
    lock.unlock();
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    lock.lock();
  }
  if (inside_->serving) inside_->server.stop();
}

}  // namespace vernier::workbench
