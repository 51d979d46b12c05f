#include "tools/workbench/project.h"

#include "tests/unit/workbench/rig.h"
#include "tools/model/error.h"

namespace vernier {
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
}  // namespace vernier
