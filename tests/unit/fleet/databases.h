// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Every test of the registry runs in a file and on a server: a PostgreSQL of the test's own, in its folder
// and on a socket there.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>

#include "tools/registry/open_database.h"
#include "tools/registry/registry.h"

namespace vernier {

inline bool runs(const std::string& line) { return std::system((line + " >/dev/null 2>&1").c_str()) == 0; }

/// A server; as root it runs as the user nobody, since it refuses to be root.
class PostgresServer {
 public:
  explicit PostgresServer(const std::string& folder) : folder_(folder) {
    for (const auto& entry : std::filesystem::directory_iterator("/usr/lib/postgresql"))
      bin_ = std::max(bin_, entry.path().string() + "/bin/");
    std::filesystem::create_directories(folder_);
    if (getuid() == 0) {
      prefix_ = "setpriv --reuid=nobody --regid=nogroup --clear-groups ";
      runs("chown nobody '" + folder_ + "'");
    }
    up_ = runs("cd / && " + prefix_ + bin_ + "initdb -D '" + folder_ +
               "/data' -U vernier -A trust -E UTF8 --no-locale -N") &&
          runs("cd / && " + prefix_ + bin_ + "pg_ctl -w -D '" + folder_ + "/data' -l '" + folder_ +
               "/log' -o \"-k '" + folder_ + "' -c listen_addresses= -c fsync=off\" start") &&
          runs(bin_ + "createdb -h '" + folder_ + "' -U vernier vernier");
  }
  ~PostgresServer() {
    runs("cd / && " + prefix_ + bin_ + "pg_ctl -D '" + folder_ + "/data' -m immediate stop");
  }
  PostgresServer(const PostgresServer&) = delete;
  PostgresServer& operator=(const PostgresServer&) = delete;
  bool up() const { return up_; }
  std::string url() const { return "postgresql://vernier@/vernier?host=" + folder_; }
  static bool is_installed() { return runs("ls /usr/lib/postgresql/*/bin/initdb"); }

 private:
  std::string folder_, bin_, prefix_;
  bool up_ = false;
};

/// Parameter: "sqlite" or "postgres".
class OnBothDatabases : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(folder_);
    place_ = folder_ + "/registry.db";
    if (GetParam() != "postgres") return;
    if (!PostgresServer::is_installed()) GTEST_SKIP() << "no PostgreSQL server on this computer (postgresql)";
    // A socket's path is short.
    server_ = std::make_unique<PostgresServer>("/tmp/vernier_pg_" + std::to_string(getpid()));
    ASSERT_TRUE(server_->up());
    place_ = server_->url();
  }
  void TearDown() override {
    server_.reset();
    std::filesystem::remove_all("/tmp/vernier_pg_" + std::to_string(getpid()));
    std::filesystem::remove_all(folder_);
  }
  registry::Registry registry() const { return registry::Registry(registry::open_database(place_)); }

  const std::string folder_ = testing::TempDir() + "fleet_" + std::to_string(getpid());
  std::string place_;
  std::unique_ptr<PostgresServer> server_;
};

inline std::string name_of_database(const testing::TestParamInfo<std::string>& info) { return info.param; }

}  // namespace vernier
