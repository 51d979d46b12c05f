// SPDX-License-Identifier: GPL-3.0-or-later
// The server as somebody on the same computer, or a page of another site in the same browser, would attack
// it: real sockets, bytes as they come.
#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>

#include "tests/unit/workbench/rig.h"
#include "tools/text/error.h"

namespace vernier::security_test {

using namespace vernier::text;
using namespace vernier::workbench;
namespace {

/// Sends bytes to an address of this computer and reads until the other side is silent or gone; empty where
/// nobody listens. then_silent: nothing more will come, and the server is told so.
std::string talk(std::uint16_t port, const std::string& bytes, const char* host = "127.0.0.1",
                 bool then_silent = false) {
  const int fd = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  ::inet_pton(AF_INET, host, &address.sin_addr);
  std::string answer;
  if (::connect(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) {
    const timeval patience{10, 0};
    ::setsockopt(fd, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    (void)!::send(fd, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (then_silent) ::shutdown(fd, SHUT_WR);
    char piece[4096];
    for (ssize_t count = 1; (count = ::recv(fd, piece, sizeof piece, 0)) > 0;)
      answer.append(piece, static_cast<std::size_t>(count));
  }
  ::close(fd);
  return answer;
}

class Attack : public testing::Test {
 protected:
  Attack() {
    write_file(folder_.in("m.xml"), test::kSmallMachine);
    write_file(folder_.beside("secret.csv"), "secret");
    thread_ = std::thread([this] { server_.serve(); });
  }
  ~Attack() override {
    server_.stop();
    thread_.join();
  }
  std::string host() const { return "127.0.0.1:" + std::to_string(server_.port()); }
  std::string cookie() const {
    return "Cookie: vernier_" + std::to_string(server_.port()) + "=" + server_.token() + "\r\n";
  }
  /// A request as the page itself would send it, but for what the test changes.
  std::string ask(const std::string& method, const std::string& path, const std::string& headers,
                  const std::string& body = "") const {
    return talk(server_.port(),
                method + " " + path + " HTTP/1.1\r\nConnection: close\r\n" + headers + "\r\n" + body);
  }
  std::string ours() const { return "Host: " + host() + "\r\n" + cookie(); }
  std::string put(const std::string& name, const std::string& body) const {
    return ask("PUT", "/api/file?name=" + name,
               ours() + "X-Vernier: 1\r\nContent-Length: " + std::to_string(body.size()) + "\r\n", body);
  }
  static int status(const std::string& answer) {
    return answer.size() < 12 ? 0 : std::stoi(answer.substr(9, 3));
  }

  test::Folder folder_;
  Api api_{folder_.project(), test::program(), "test", test::described()};
  WorkbenchServer server_{api_, 0};
  std::thread thread_;
};

TEST_F(Attack, OnlyTheSessionsTokenOpensAnything) {
  EXPECT_EQ(server_.token().size(), 64u);
  EXPECT_NE(server_.token(), new_token());
  const std::string host_line = "Host: " + host() + "\r\n";
  for (const char* path : {"/", "/workbench.js", "/api/project", "/api/file?name=m.xml", "/?token=0000"})
    EXPECT_EQ(status(ask("GET", path, host_line)), 401) << path;
  std::string wrong = server_.token();
  wrong.back() = wrong.back() == '0' ? '1' : '0';
  EXPECT_EQ(status(ask("GET", "/?token=" + wrong, host_line)), 401);
  EXPECT_EQ(
      status(ask("GET", "/api/project",
                 host_line + "Cookie: vernier_" + std::to_string(server_.port()) + "=" + wrong + "\r\n")),
      401);
  // The token in the address is good for the first visit only: everything else wants the cookie.
  EXPECT_EQ(status(ask("GET", "/api/project?token=" + server_.token(), host_line)), 401);
  const std::string welcome = ask("GET", "/?token=" + server_.token(), host_line);
  EXPECT_EQ(status(welcome), 200);
  EXPECT_NE(welcome.find("; HttpOnly; SameSite=Strict"), std::string::npos);
  EXPECT_EQ(status(ask("GET", "/api/project", ours())), 200);
}

TEST_F(Attack, OtherNamesOfThisHostAreRefused) {
  for (const std::string& name :
       {std::string("evil.example"), std::string("localhost"),
        "localhost.evil.example:" + std::to_string(server_.port()), std::string("127.0.0.1"),
        "evil.example:" + std::to_string(server_.port()), host() + ".evil.example", std::string()})
    EXPECT_EQ(status(ask("GET", "/api/project", "Host: " + name + "\r\n" + cookie())), 403) << name;
  EXPECT_EQ(status(ask("GET", "/api/project", cookie())), 403);
  EXPECT_EQ(status(ask("GET", "/api/project", ours() + "Host: evil.example\r\n")), 403);
}

TEST_F(Attack, LocalhostIsThisComputer) {
  const std::string name = "localhost:" + std::to_string(server_.port());
  const std::string line = "Host: " + name + "\r\n" + cookie();
  EXPECT_EQ(status(ask("GET", "/api/project", line)), 200);
  EXPECT_EQ(status(ask("GET", "/api/project", line + "Origin: http://" + name + "\r\n")), 200);
  // A page of one name is no page of the other.
  EXPECT_EQ(status(ask("GET", "/api/project", line + "Origin: http://" + host() + "\r\n")), 403);
}

TEST_F(Attack, OtherOriginsAreRefusedEvenWithTheCookie) {
  for (const char* origin : {"http://evil.example", "null", "https://127.0.0.1", "http://127.0.0.1:1"})
    EXPECT_EQ(status(ask("GET", "/api/project", ours() + "Origin: " + origin + "\r\n")), 403) << origin;
  EXPECT_EQ(status(ask("GET", "/api/project", ours() + "Origin: http://" + host() + "\r\n")), 200);
  // A form of another site cannot set a header.
  EXPECT_EQ(status(ask("POST", "/api/history", ours() + "Content-Length: 13\r\n", "{\"do\":\"undo\"}")), 403);
  EXPECT_EQ(status(ask("OPTIONS", "/api/history", ours())), 403);
}

TEST_F(Attack, ListensOnOneLoopbackAddressOnly) {
  EXPECT_EQ(talk(server_.port(), "GET / HTTP/1.0\r\n\r\n", "127.0.0.2"), "");
  EXPECT_THROW(WorkbenchServer(api_, server_.port()), InputError);  // nobody shares the port
}

TEST_F(Attack, NothingOutsideOfTheFolderIsReadOrWritten) {
  std::filesystem::create_symlink(folder_.beside("secret.csv"), folder_.in("link.csv"));
  for (const char* name :
       {"../secret.csv", "%2e%2e/secret.csv", "..%2Fsecret.csv", "..%5Csecret.csv", "/etc/passwd",
        "%2Fetc%2Fpasswd", "link.csv", "a/../../secret.csv", "m.xml%00.csv", ".vernier/history.json", ""}) {
    EXPECT_EQ(status(ask("GET", std::string("/api/file?name=") + name, ours())), 422) << name;
    EXPECT_EQ(status(put(name, "X[mm],x[mm]\n1,2\n")), 422) << name;
  }
  const std::string writing = ours() + "X-Vernier: 1\r\n";
  for (const char* name : {"../secret.csv", "%2e%2e/secret.csv", "link.csv", ".vernier/history.json", ""})
    EXPECT_EQ(status(ask("DELETE", std::string("/api/file?name=") + name, writing)), 422) << name;
  for (const char* path : {"/../secret.csv", "/%2e%2e/secret.csv", "/etc/passwd", "//etc/passwd"})
    EXPECT_EQ(status(ask("GET", path, ours())), 404) << path;
  EXPECT_EQ(read_file(folder_.beside("secret.csv")), "secret");
  EXPECT_FALSE(std::filesystem::exists(folder_.in(".vernier")));
}

TEST_F(Attack, AFileIsReplacedOrDeletedOnlyWhereThePageAsksForIt) {
  write_file(folder_.in("a.csv"), test::kSmallRows);
  const std::string rows = "X[mm],x[mm]\n1,2\n", path = "/api/file?name=a.csv";
  const std::string length = "Content-Length: " + std::to_string(rows.size()) + "\r\n";
  // A new file never takes the place of another one; a link or a form of another site deletes nothing.
  EXPECT_EQ(status(ask("PUT", path + "&new=1", ours() + "X-Vernier: 1\r\n" + length, rows)), 422);
  EXPECT_EQ(status(ask("DELETE", path, ours())), 403);
  EXPECT_EQ(status(ask("DELETE", path, "Host: " + host() + "\r\nX-Vernier: 1\r\n")), 401);
  EXPECT_EQ(read_file(folder_.in("a.csv")), test::kSmallRows);
  // What cannot be read does not replace what can.
  EXPECT_EQ(status(put("a.csv", "X[mm],x[mm]\n1\n")), 422);
  EXPECT_EQ(read_file(folder_.in("a.csv")), test::kSmallRows);
  EXPECT_EQ(status(put("a.csv", rows)), 200);
  EXPECT_EQ(read_file(folder_.in("a.csv")), rows);
  EXPECT_EQ(status(ask("DELETE", path, ours() + "X-Vernier: 1\r\n")), 200);
  EXPECT_FALSE(std::filesystem::exists(folder_.in("a.csv")));
}

TEST_F(Attack, BodiesHaveALengthAndALimit) {
  const std::string writing = ours() + "X-Vernier: 1\r\n";
  EXPECT_EQ(status(ask("PUT", "/api/file?name=a.csv", writing + "Content-Length: 68719476736\r\n", "x")),
            413);
  EXPECT_EQ(status(ask("PUT", "/api/file?name=a.csv", writing + "Transfer-Encoding: chunked\r\n",
                       "1\r\nx\r\n0\r\n\r\n")),
            411);
  EXPECT_EQ(status(ask("PUT", "/api/file?name=a.csv",
                       writing + "Content-Encoding: gzip\r\nContent-Length: 1\r\n", "x")),
            411);
  EXPECT_EQ(status(ask("PUT", "/api/file?name=a.csv", writing, "x")), 411);
  EXPECT_FALSE(std::filesystem::exists(folder_.in("a.csv")));
}

TEST_F(Attack, SenselessRequestsAreAnsweredAndTheServerLives) {
  for (const std::string& bytes :
       {std::string("\r\n\r\n"), std::string(100000, 'A'), std::string("GET\r\n\r\n"),
        "GET / HTTP/1.1\r\nHost: " + std::string(50000, 'a') + "\r\n\r\n",
        std::string("\0\xff\xfe\r\n\r\n", 7)})
    talk(server_.port(), bytes, "127.0.0.1", true);
  for (const char* body :
       {"", "[]", "{", "{\"command\":[]}", "\"x\"", "{\"command\":\"fit\",\"machine\":{\"a\":1}}"})
    EXPECT_EQ(status(ask("POST", "/api/jobs",
                         ours() + "X-Vernier: 1\r\nContent-Length: " +
                             std::to_string(std::string(body).size()) + "\r\n",
                         body)),
              422)
        << body;
  for (const char* path : {"/api/jobs?id=-1", "/api/jobs?id=99", "/api/jobs?id=x", "/api/rows",
                           "/api/rows?machine=m.xml&measurement=m.xml", "/api/lines?name=m.xml&line=x",
                           "/api/live?to=ftp://x", "/api/names?machine=none.xml"})
    EXPECT_EQ(status(ask("GET", path, ours())), 422) << path;
  EXPECT_EQ(status(ask("GET", "/api/project", ours())), 200);
}

TEST_F(Attack, ABadFileIsRefusedWithFileLineAndWordAndNotKept) {
  const std::string answer = put(
      "bad.xml", "<machine name=\"m\">\n<variables><static><a value=\"x\"/></static></variables></machine>");
  EXPECT_EQ(status(answer), 422);
  EXPECT_NE(answer.find("bad.xml:2: "), std::string::npos) << answer;
  EXPECT_EQ(answer.find(folder_.project()), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(folder_.in("bad.xml")));
  EXPECT_EQ(status(put("rows.csv", "X[mm],x[mm]\n1\n")), 422);
  EXPECT_EQ(status(put("good.csv", test::kSmallRows)), 200);
}

TEST_F(Attack, EveryAnswerForbidsForeignScriptsAndReportsAreShutIn) {
  write_file(folder_.in("r.html"), "<script>fetch('/api/project')</script>");
  const std::string page = ask("GET", "/", ours()), report = ask("GET", "/api/file?name=r.html", ours());
  EXPECT_NE(page.find("default-src 'none'; script-src 'self'; style-src 'self'"), std::string::npos);
  EXPECT_EQ(page.find("unsafe"), std::string::npos);
  EXPECT_NE(report.find("Content-Security-Policy: sandbox allow-scripts allow-downloads; default-src 'none'"),
            std::string::npos);
  EXPECT_EQ(report.find("allow-same-origin"), std::string::npos);
  for (const std::string& answer : {page, report})
    for (const char* header :
         {"X-Content-Type-Options: nosniff", "Cache-Control: no-store", "Referrer-Policy: no-referrer"})
      EXPECT_NE(answer.find(header), std::string::npos) << header;
}

/// A board that takes connections and never answers.
class SilentBoard {
 public:
  SilentBoard() : fd_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    ::bind(fd_, reinterpret_cast<const sockaddr*>(&address), size);
    ::listen(fd_, 1);
    ::getsockname(fd_, reinterpret_cast<sockaddr*>(&address), &size);
    port_ = ntohs(address.sin_port);
  }
  ~SilentBoard() { ::close(fd_); }
  SilentBoard(const SilentBoard&) = delete;
  SilentBoard& operator=(const SilentBoard&) = delete;
  std::string port() const { return std::to_string(port_); }

 private:
  int fd_;
  std::uint16_t port_ = 0;
};

// The workbench waited for half-open requests, for a file that was read, for a board.
TEST(WorkbenchEnds, OneSecondAfterItsSignalWhateverRuns) {
  using Clock = std::chrono::steady_clock;
  const test::Folder folder;
  const SilentBoard board;
  const std::string url_file = folder.beside("url.json");
  const pid_t child =
      start_process(test::program(), {"workbench", folder.project(), "--no-browser", "--json", url_file},
                    folder.project(), {STDIN_FILENO, STDERR_FILENO, STDERR_FILENO});
  ASSERT_GT(child, 0);
  for (int i = 0; i < 500 && !std::filesystem::exists(url_file); ++i) ::usleep(10'000);
  const auto json = nlohmann::ordered_json::parse(read_file(url_file));
  const std::string url = json["url"], port = std::to_string(json["port"].get<int>());
  const std::string ours = "Host: 127.0.0.1:" + port + "\r\nCookie: vernier_" + port + "=" +
                           url.substr(url.find("token=") + 6) + "\r\n";
  std::thread watching([&] {
    talk(json["port"], "GET /api/live?to=tcp://127.0.0.1:" + board.port() + " HTTP/1.1\r\n" + ours + "\r\n");
  });
  std::thread half([&] { talk(json["port"], "GET / HTTP/1.1\r\n"); });
  ::usleep(300'000);
  const auto begin = Clock::now();
  ::kill(child, SIGTERM);
  int status = -1;
  ::waitpid(child, &status, 0);
  EXPECT_LT(Clock::now() - begin, std::chrono::milliseconds(2500));  // the grace, and a busy computer
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
  watching.join();
  half.join();
}

}  // namespace
}  // namespace vernier::security_test
