// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/registry/batch.h"

#include <filesystem>

#include "tests/unit/fleet/databases.h"
#include "tools/registry/cells.h"
#include "tools/registry/machine_name.h"
#include "tools/text/error.h"
#include "tools/text/files.h"

namespace vernier::batch_test {

using namespace vernier::registry;
namespace {

class BatchTest : public OnBothDatabases {
 protected:
  Batch batch(const std::string& folder = "night") const {
    return write_batch(folder_ + "/" + folder,
                       {"", "night", folder_, {"diagnose", "{machine}.xml", "x y"}, {"b", "a", "c"}});
  }
  static Registry with_machines(Registry registry) {
    for (const char* name : {"a", "b", "c"}) registry.put(FleetMachine{name, "", "", 0, 1});
    return registry;
  }
  const std::string night_ = folder_ + "/night";
};
INSTANTIATE_TEST_SUITE_P(Fleet, BatchTest, testing::Values("sqlite", "postgres"), name_of_database);

TEST_P(BatchTest, IsReadAsItWasWritten) {
  const Batch written = batch(), read = read_batch(night_);
  EXPECT_EQ(read.id, written.id);
  EXPECT_EQ(read.machines, (std::vector<std::string>{"a", "b", "c"}));
  EXPECT_EQ(text::read_file(night_ + "/machines"), "a\nb\nc\n");
  EXPECT_EQ(command_of(read, "b"), (std::vector<std::string>{"diagnose", "b.xml", "x y"}));
  EXPECT_THROW(command_of(read, "d"), text::InputError);
  EXPECT_THROW(batch(), text::InputError) << "there is one";
  EXPECT_NE(batch("other").id, written.id) << "the same words are another batch";
  EXPECT_THROW(read_batch(folder_), text::InputError);
  text::write_file(night_ + "/batch.json", "{\"vernier_batch\": 1, \"name\": 3}");
  EXPECT_THROW(read_batch(night_), text::InputError);
}

TEST_P(BatchTest, BooksEachAnswerOnce) {
  Registry registry = with_machines(this->registry());
  const Batch night = batch();
  write_answer(night_, night, {"a", 0, {{"verdict", "valid"}}}, "");
  write_answer(night_, night, {"b", 2, {{"verdict", "changed"}}}, "it changed");
  write_answer(night_, night, {"c", 1, nullptr}, "no such file");
  Collected first = collect(registry, night_, night);
  EXPECT_EQ(first.booked, 2);
  ASSERT_EQ(first.not_booked.size(), 1u);
  EXPECT_EQ(first.not_booked[0].state, "failed");
  EXPECT_EQ(first.not_booked[0].why, "exit status 1: no such file");
  // WHEN the third answer is there
  write_answer(night_, night, {"c", 0, nullptr}, "");
  Registry other = this->registry();
  EXPECT_EQ(collect(other, night_, night).booked, 1);
  Collected last = collect(registry, night_, night);
  EXPECT_EQ(last.booked, 0);
  EXPECT_EQ(last.before, 3);
  EXPECT_TRUE(last.not_booked.empty());
  const auto booked = booked_answers(registry, "night");
  ASSERT_EQ(booked.size(), 3u);
  EXPECT_EQ(booked[1].result, "{\"verdict\":\"changed\"}");
  EXPECT_EQ(booked[1].status, 2);
  // An answer that is changed afterwards does not replace the booked one.
  write_answer(night_, night, {"a", 0, {{"verdict", "changed"}}}, "");
  last = collect(registry, night_, night);
  ASSERT_EQ(last.not_booked.size(), 1u);
  EXPECT_EQ(last.not_booked[0].state, "refused");
  EXPECT_EQ(booked_answers(registry, "night")[0].result, booked[0].result);
}

TEST_P(BatchTest, BooksNoAnswerOfAnotherMachineOrBatch) {
  Registry registry = with_machines(this->registry());
  const Batch night = batch(), other = batch("other");
  write_answer(folder_ + "/other", other, {"a", 0, 1}, "");
  write_answer(night_, night, {"b", 0, 1}, "");
  const std::string answers = night_ + "/answers/";
  std::filesystem::copy_file(folder_ + "/other/answers/a.json", answers + "a.json");
  std::filesystem::copy_file(answers + "b.json", answers + "c.json");
  std::filesystem::copy_file(answers + "b.json", answers + "d.json");
  const Collected collected = collect(registry, night_, night);
  EXPECT_EQ(collected.booked, 1);
  ASSERT_EQ(collected.not_booked.size(), 3u);
  for (const NotBooked& one : collected.not_booked) EXPECT_EQ(one.state, "refused") << one.machine;
  EXPECT_NE(collected.not_booked[0].why.find("another batch"), std::string::npos);
  EXPECT_NE(collected.not_booked[1].why.find("the answer of b"), std::string::npos);
  EXPECT_NE(collected.not_booked[2].why.find("no"), std::string::npos);
}

TEST_P(BatchTest, BooksNoHalfAnswer) {
  Registry registry = with_machines(this->registry());
  const Batch night = batch();
  write_answer(night_, night, {"a", 0, {{"verdict", "valid"}}}, "");
  const std::string file = night_ + "/answers/a.json", whole = text::read_file(file);
  // The last byte is the end of the line, the one before it closes the object.
  for (std::size_t size = 0; size + 1 < whole.size(); ++size) {
    text::write_file(file, whole.substr(0, size));
    EXPECT_EQ(collect(registry, night_, night).booked, 0) << size;
    EXPECT_FALSE(has_answer(night_, night, "a")) << size;
  }
  for (const char* key : {"batch", "machine", "status", "message", "result"}) {
    auto json = nlohmann::json::parse(whole);
    json.erase(key);
    text::write_file(file, json.dump());
    EXPECT_EQ(collect(registry, night_, night).not_booked.at(0).state, "incomplete") << key;
  }
  text::write_file(file, whole);
  EXPECT_EQ(collect(registry, night_, night).booked, 1);
}

TEST_P(BatchTest, MachineThatIsNotEnteredIsNotBooked) {
  Registry registry = this->registry();
  const Batch night = batch();
  write_answer(night_, night, {"a", 0, nullptr}, "");
  EXPECT_EQ(collect(registry, night_, night).not_booked.at(0).state, "refused");
  EXPECT_TRUE(booked_answers(registry, "").empty());
}

TEST(MachineName, HasPlainLettersOnly) {
  for (const char* name : {"a", "VMC-3", "7", "hall_2.mill-1", "x..y"})
    EXPECT_TRUE(is_machine_name(name)) << name;
  for (const char* name :
       {"", ".a", "-a", "_a", "a b", "a/b", "a'b", "a\nb", "a$b", "\u00b5", "{machine}", ".."})
    EXPECT_FALSE(is_machine_name(name)) << name;
  EXPECT_TRUE(is_machine_name(std::string(200, 'a')));
  EXPECT_FALSE(is_machine_name(std::string(201, 'a')));
  EXPECT_EQ(for_machine("{machine}/{machine}.xml", "{m}"), "{m}/{m}.xml");
}

}  // namespace
}  // namespace vernier::batch_test
