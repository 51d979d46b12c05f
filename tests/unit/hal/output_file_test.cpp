// SPDX-License-Identifier: GPL-3.0-or-later
// What may stand where an output goes: nothing, a file, links, devices, pipes, a terminal, a folder.
#include "hal/support/output_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <sys/un.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <future>
#include <iterator>
#include <set>
#include <thread>

namespace vernier::output_file_test {
namespace {

namespace fs = std::filesystem;

std::string content(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

struct stat status_of(const fs::path& path) {
  struct stat status {};
  EXPECT_EQ(::lstat(path.c_str(), &status), 0) << path << ": " << std::strerror(errno);
  return status;
}

unsigned permissions(const fs::path& path) { return status_of(path).st_mode & 07777; }

/// All that comes from a pipe until it was written to.
std::string hear(int end, const std::atomic<bool>& written) {
  std::string text;
  for (char room[4096];;) {
    const bool over = written;
    const ssize_t got = ::read(end, room, sizeof(room));
    if (got > 0) text.append(room, static_cast<std::size_t>(got));
    if (got < 0 && over) return text;
    if (got < 0) std::this_thread::yield();
  }
}

class Output : public testing::Test {
 protected:
  Output() {
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "far");
  }
  ~Output() override { fs::remove_all(folder_); }

  fs::path in(const char* name) const { return folder_ / name; }
  void put(const char* name, const std::string& text) const { std::ofstream(in(name)) << text; }
  void link(const char* name, const char* target) const { fs::create_symlink(target, in(name)); }
  static std::string error(const fs::path& path, const std::string& text = "new\n") {
    const std::error_code failed = write_output(path.string(), text);
    return failed ? failed.message() : "";
  }
  /// All that lies in the folder, so that what is left behind shows.
  std::string listing() const {
    std::set<std::string> names;
    for (const auto& entry : fs::recursive_directory_iterator(folder_))
      names.insert(entry.path().lexically_relative(folder_).string());
    std::string text;
    for (const std::string& name : names) text += name + " ";
    return text;
  }

  const fs::path folder_ = testing::TempDir() + "output_" + std::to_string(getpid()) + "_" +
                           testing::UnitTest::GetInstance()->current_test_info()->name();
};

TEST_F(Output, NewFileHasThePermissionsThatTheUserGivesNewFiles) {
  const mode_t before = ::umask(027);
  EXPECT_EQ(error(in("a")), "");
  ::umask(before);
  EXPECT_EQ(content(in("a")), "new\n");
  EXPECT_EQ(permissions(in("a")), 0640U);
  EXPECT_EQ(listing(), "a far ");
}

TEST_F(Output, FileIsReplacedAsAWholeAndKeepsItsPermissions) {
  for (const unsigned mode : {0600U, 0640U, 0755U, 0444U}) {
    put("a", "old\n");
    ASSERT_EQ(::chmod(in("a").c_str(), mode), 0);
    std::ifstream reader(in("a"));
    EXPECT_EQ(error(in("a")), "");
    EXPECT_EQ(content(in("a")), "new\n");
    EXPECT_EQ(permissions(in("a")), mode);
    // Who had the old one open reads the old one to its end.
    EXPECT_EQ(std::string(std::istreambuf_iterator<char>(reader), {}), "old\n");
    fs::remove(in("a"));
  }
  EXPECT_EQ(listing(), "far ");
}

TEST_F(Output, FileKeepsItsOwner) {
  if (::geteuid() != 0) GTEST_SKIP() << "only root can give a file away";
  put("a", "old\n");
  ASSERT_EQ(::chown(in("a").c_str(), 12345, 23456), 0);
  EXPECT_EQ(error(in("a")), "");
  EXPECT_EQ(status_of(in("a")).st_uid, 12345U);
  EXPECT_EQ(status_of(in("a")).st_gid, 23456U);
}

TEST_F(Output, FullMediumLeavesTheOldFileAndNothingElse) {
  put("a", "old\n");
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit little{1000, before.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &little), 0);
  const std::string why = error(in("a"), std::string(5000, 'x')),
                    why_new = error(in("b"), std::string(5000, 'x'));
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(why, std::strerror(EFBIG));
  EXPECT_EQ(why_new, std::strerror(EFBIG));
  EXPECT_EQ(content(in("a")), "old\n");
  EXPECT_EQ(listing(), "a far ");
}

TEST_F(Output, LinkStaysAndWhatItLeadsToIsReplaced) {
  put("far/real", "old\n");
  ASSERT_EQ(::chmod(in("far/real").c_str(), 0600), 0);
  link("far/near", "../far/real");
  link("a", "far/near");
  std::ifstream reader(in("far/real"));
  EXPECT_EQ(error(in("a")), "");
  EXPECT_EQ(fs::read_symlink(in("a")), "far/near");
  EXPECT_EQ(fs::read_symlink(in("far/near")), "../far/real");
  EXPECT_TRUE(S_ISREG(status_of(in("far/real")).st_mode));
  EXPECT_EQ(content(in("far/real")), "new\n");
  EXPECT_EQ(permissions(in("far/real")), 0600U);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(reader), {}), "old\n");
  EXPECT_EQ(listing(), "a far far/near far/real ");
}

TEST_F(Output, LinkThatLeadsNowhereYetGetsItsTarget) {
  link("a", "far/b");
  link("far/b", "real");
  EXPECT_EQ(error(in("a")), "");
  EXPECT_EQ(content(in("far/real")), "new\n");
  EXPECT_EQ(fs::read_symlink(in("a")), "far/b");
  EXPECT_EQ(listing(), "a far far/b far/real ");
}

TEST_F(Output, PathOfThisFolderAloneIsTaken) {
  const fs::path before = fs::current_path();
  fs::current_path(folder_);
  link("a", "b");
  const std::string why = error("a"), why_again = error("a", "newer\n"), why_plain = error("c");
  fs::current_path(before);
  EXPECT_EQ(why + why_again + why_plain, "");
  EXPECT_EQ(content(in("b")), "newer\n");
  EXPECT_EQ(listing(), "a b c far ");
}

TEST_F(Output, LinksInACircleOrIntoNoFolderAreRefused) {
  link("a", "b");
  link("b", "a");
  link("c", "nowhere/d");
  EXPECT_EQ(error(in("a")), std::strerror(ELOOP));
  EXPECT_EQ(error(in("c")), std::strerror(ENOENT));
  EXPECT_EQ(error(in("nowhere/e")), std::strerror(ENOENT));
  EXPECT_EQ(error(""), std::strerror(ENOENT));
  EXPECT_EQ(listing(), "a b c far ");
}

TEST_F(Output, PipeIsWrittenToAndStays) {
  ASSERT_EQ(::mkfifo(in("pipe").c_str(), 0600), 0);
  link("a", "pipe");
  // Read and write, so that neither end waits for the other to open.
  const int end = ::open(in("pipe").c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  ASSERT_GE(end, 0);
  for (const char* name : {"pipe", "a"}) {
    // More than a pipe holds, so that it is written in pieces.
    const std::string text(300'000, *name);
    std::atomic<bool> written{false};
    auto heard = std::async(std::launch::async, [&] { return hear(end, written); });
    EXPECT_EQ(error(in(name), text), "");
    written = true;
    EXPECT_EQ(heard.get(), text);
    EXPECT_TRUE(S_ISFIFO(status_of(in("pipe")).st_mode));
  }
  ::close(end);
  EXPECT_EQ(listing(), "a far pipe ");
}

TEST_F(Output, DeviceIsWrittenToAndStays) {
  // Nodes of our own: were they replaced, no device of this machine would suffer.
  const auto make = [&](const char* name, unsigned minor) {
    return ::mknod(in(name).c_str(), S_IFCHR | 0600, makedev(1, minor)) == 0;
  };
  if (!make("null", 3) || !make("full", 7))
    GTEST_SKIP() << "no device can be made here: " << std::strerror(errno);
  if (const int fd = ::open(in("null").c_str(), O_WRONLY); fd < 0)
    GTEST_SKIP() << "devices of this folder are not to be used: " << std::strerror(errno);
  else
    ::close(fd);
  link("a", "null");
  EXPECT_EQ(error(in("null")), "");
  EXPECT_EQ(error(in("a")), "");
  EXPECT_EQ(error(in("full")), std::strerror(ENOSPC));
  for (const char* name : {"null", "full"}) EXPECT_TRUE(S_ISCHR(status_of(in(name)).st_mode)) << name;
  EXPECT_EQ(status_of(in("null")).st_rdev, makedev(1, 3));
  EXPECT_EQ(listing(), "a far full null ");
}

TEST_F(Output, TerminalIsWrittenTo) {
  const int master = ::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
  if (master < 0 || ::grantpt(master) != 0 || ::unlockpt(master) != 0)
    GTEST_SKIP() << "no terminal can be made here: " << std::strerror(errno);
  const std::string terminal = ::ptsname(master);
  const int held =
      ::open(terminal.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC);  // what it holds stays until it is read
  EXPECT_EQ(error(terminal, "seen"), "");
  EXPECT_TRUE(S_ISCHR(status_of(terminal).st_mode));
  char room[16] = {};
  EXPECT_EQ(::read(master, room, sizeof(room)), 4);
  EXPECT_STREQ(room, "seen");
  ::close(held);
  ::close(master);
}

TEST_F(Output, OpenFileOfThisProcessGoesOnWhereItWas) {
  const int fd = ::open(in("a").c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
  const std::string number = std::to_string(fd);
  if (!fs::exists("/proc/self/fd/" + number)) GTEST_SKIP() << "no /proc on this machine";
  link("b", ("/proc/self/fd/" + number).c_str());
  ASSERT_EQ(::write(fd, "1 ", 2), 2);
  EXPECT_EQ(error("/proc/self/fd/" + number, "2 "), "");
  EXPECT_EQ(error(in("b"), "3 "), "");
  ASSERT_EQ(::write(fd, "4", 1), 1);
  ::close(fd);
  EXPECT_EQ(content(in("a")), "1 2 3 4");
  EXPECT_EQ(error("/proc/self/fd/" + number), std::strerror(EBADF));
}

TEST_F(Output, FolderAndSocketAreRefusedAndStay) {
  const int fd = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const fs::path before = fs::current_path();
  fs::current_path(folder_);  // the address has room for 107 characters
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::strcpy(address.sun_path, "socket");
  const int bound = ::bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof(address));
  fs::current_path(before);
  ASSERT_EQ(bound, 0) << std::strerror(errno);
  EXPECT_EQ(error(in("socket")), std::strerror(ENXIO));
  EXPECT_TRUE(S_ISSOCK(status_of(in("socket")).st_mode));
  EXPECT_EQ(error(in("far")), std::strerror(EISDIR));
  EXPECT_EQ(error(in("socket") / "a"), std::strerror(ENOTDIR));
  EXPECT_EQ(listing(), "far socket ");
  ::close(fd);
}

TEST_F(Output, TemporaryNameThatIsTakenIsPassedOver) {
  // Names that a killed process left, one of them a link that somebody laid out.
  put("victim", "kept\n");
  for (int i = 0; i < 200; ++i)
    fs::create_symlink("victim", folder_ / (".vernier" + std::to_string(getpid()) + "." + std::to_string(i)));
  EXPECT_EQ(error(in("a")), "");
  EXPECT_EQ(content(in("a")), "new\n");
  EXPECT_EQ(content(in("victim")), "kept\n");
}

TEST_F(Output, LongestNameOfAFileIsTaken) {
  const std::string name(255, 'n');
  EXPECT_EQ(error(folder_ / name), "");
  EXPECT_EQ(content(folder_ / name), "new\n");
}

TEST_F(Output, FolderIsMadeThroughALink) {
  link("a", "far/away/folder");
  link("b", "far");
  put("file", "");
  for (const char* name : {"a/", "a", "b", "far", "new/and/below"})
    EXPECT_EQ(make_output_folder(in(name).string()), std::error_code()) << name;
  EXPECT_TRUE(fs::is_directory(in("far/away/folder")));
  EXPECT_TRUE(fs::is_directory(in("new/and/below")));
  EXPECT_TRUE(fs::is_symlink(in("a")));
  EXPECT_TRUE(make_output_folder(in("file").string()));
  EXPECT_TRUE(make_output_folder(in("file/below").string()));
  EXPECT_EQ(content(in("file")), "");
}

}  // namespace
}  // namespace vernier::output_file_test
