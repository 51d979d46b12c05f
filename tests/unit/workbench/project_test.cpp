// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/workbench/files/project.h"

#include <sys/stat.h>

#include "tests/unit/workbench/rig.h"
#include "tools/text/error.h"
#include "tools/workbench/runs/history.h"

namespace vernier::project_test {

using namespace vernier::text;
using namespace vernier::workbench;
namespace {

TEST(ProjectName, TakesPlainNamesOnly) {
  for (const char* good :
       {"a.xml", "image/machine.vimg", "a/b/c.csv", "Messung 1.csv", "x+y (2).csv", "größe.csv"})
    EXPECT_TRUE(is_project_name(good)) << good;
  for (const char* bad : {"", "/", "/etc/passwd", "..", "../a", "a/../b", "a//b", "a/", ".hidden", "a/.b",
                          "-o", "a/-b", "~x", "a\\b", "c:x", "a\nb", " a", "a/b/c/d"})
    EXPECT_FALSE(is_project_name(bad)) << bad;
  EXPECT_FALSE(is_project_name(std::string_view("a\0b", 3)));
  EXPECT_FALSE(is_project_name(std::string(200, 'a')));
}

TEST(Project, FollowsNoLinkOutOfTheFolder) {
  const test::Folder folder;
  write_file(folder.beside("secret.csv"), "secret");
  std::filesystem::create_directories(folder.beside("outside"));
  std::filesystem::create_symlink(folder.beside("secret.csv"), folder.in("link.csv"));
  std::filesystem::create_directory_symlink(folder.beside("outside"), folder.in("sub"));
  const Project project(folder.project());
  EXPECT_THROW(project.existing("link.csv"), InputError);
  EXPECT_THROW(project.save("link.csv", "x"), InputError);
  EXPECT_THROW(project.save("sub/new.csv", "x"), InputError);
  EXPECT_EQ(read_file(folder.beside("secret.csv")), "secret");
  EXPECT_TRUE(std::filesystem::is_empty(folder.beside("outside")));
  EXPECT_TRUE(project.list().empty());  // links are not shown either
}

TEST(Project, WritesToNoDeviceOrPipeAndIntoNoFolderThatHoldsOne) {
  const test::Folder folder;
  write_file(folder.beside("secret.csv"), "secret");
  for (const char* name : {"linked", "piped", "good"}) std::filesystem::create_directory(folder.in(name));
  std::filesystem::create_symlink(folder.beside("secret.csv"), folder.in("linked/machine.xml"));
  ASSERT_EQ(::mkfifo(folder.in("piped/machine.vimg").c_str(), 0600), 0);
  ASSERT_EQ(::mkfifo(folder.in("pipe.csv").c_str(), 0600), 0);
  write_file(folder.in("good/machine.xml"), "old");
  const Project project(folder.project());
  EXPECT_THROW(project.save("pipe.csv", "x"), InputError);
  EXPECT_THROW(project.writable("linked"), InputError);
  EXPECT_THROW(project.writable("piped"), InputError);
  EXPECT_EQ(project.writable("good"), std::filesystem::canonical(folder.in("good")));
  EXPECT_EQ(read_file(folder.beside("secret.csv")), "secret");
}

TEST(Project, LooksForLinksInEveryFolderThatACommandWrites) {
  const test::Folder folder;
  write_file(folder.beside("secret.csv"), "secret");
  std::filesystem::create_directories(folder.in("out/image"));
  const Project project(folder.project());
  EXPECT_NO_THROW(project.writable("out"));
  std::filesystem::create_symlink(folder.beside("secret.csv"), folder.in("out/image/machine.vimg"));
  EXPECT_THROW(project.writable("out"), InputError);
}

TEST(Project, DeletesFilesOfTheFolderOnly) {
  const test::Folder folder;
  write_file(folder.beside("secret.csv"), "secret");
  std::filesystem::create_directories(folder.in("image/deep"));
  std::filesystem::create_directories(folder.in(".vernier"));
  for (const char* name : {"a.csv", "image/machine.vimg", "image/deep/x.txt", ".vernier/history.json"})
    write_file(folder.in(name), "x");
  std::filesystem::create_symlink(folder.beside("secret.csv"), folder.in("link.csv"));
  const Project project(folder.project());
  for (const char* name :
       {"../secret.csv", "link.csv", ".vernier/history.json", "image", "none.csv", "", "."})
    EXPECT_THROW(project.remove(name), InputError) << name;
  project.remove("a.csv");
  project.remove("image/deep/x.txt");
  EXPECT_FALSE(std::filesystem::exists(folder.in("a.csv")));
  EXPECT_FALSE(std::filesystem::exists(folder.in("image/deep"))) << "an empty folder goes with its last file";
  EXPECT_TRUE(std::filesystem::exists(folder.in("image/machine.vimg")));
  EXPECT_EQ(read_file(folder.beside("secret.csv")), "secret");
  EXPECT_EQ(read_file(folder.in(".vernier/history.json")), "x");
}

TEST(CommandHistory, FollowsNoLinkOutOfTheFolder) {
  const test::Folder folder;
  write_file(folder.beside("secret.json"), "[]");
  std::filesystem::create_directory(folder.in(".vernier"));
  std::filesystem::create_symlink(folder.beside("secret.json"), folder.in(".vernier/history.json"));
  const Project project(folder.project());
  EXPECT_THROW(CommandHistory history(project), InputError);
  std::filesystem::remove(folder.in(".vernier/history.json"));
  CommandHistory history(project);
  std::filesystem::create_symlink(folder.beside("secret.json"), folder.in(".vernier/history.json"));
  EXPECT_THROW(history.add("vernier effects", {}, {}), InputError);
  EXPECT_EQ(read_file(folder.beside("secret.json")), "[]");
}

TEST(Project, ListsFilesByKindAndOneLevelDown) {
  const test::Folder folder;
  std::filesystem::create_directories(folder.in("image"));
  for (const char* name : {"m.xml", "rows.csv", "bar.b5r", "r.html", ".hidden", "image/machine.vimg"})
    write_file(folder.in(name), "x");
  std::string seen;
  for (const ProjectFile& file : Project(folder.project()).list())
    seen += file.name + "=" + kind_name(file.kind) + " ";
  EXPECT_EQ(seen,
            "bar.b5r=instrument image/machine.vimg=image m.xml=machine r.html=report rows.csv=measurement ");
}

TEST(Project, NoFolderIsAnError) { EXPECT_THROW(Project("/no/such/folder"), InputError); }

}  // namespace
}  // namespace vernier::project_test
