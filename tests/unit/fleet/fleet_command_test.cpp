// SPDX-License-Identifier: GPL-3.0-or-later
// `vernier fleet` as a user calls it, on a file.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tools/fleet/sample_writer.h"
#include "tools/registry/open_database.h"
#include "tools/text/files.h"

namespace vernier::fleet_command_test {

using namespace vernier::text;
namespace {

constexpr const char* kMachineFile = R"xml(<machine name="m"><variables>
  <static><k value="0" nominal="0"/></static>
  <machineaxes><X rotary="false" min="0" max="600" maxcorrection="0.2" maxslew="5"/></machineaxes></variables>
  <transforms><sixdof n="1" X="X+k*X" Y="0" Z="0" rX="0" rY="0" rZ="0"/></transforms></machine>)xml";

class FleetCommand : public testing::Test {
 protected:
  FleetCommand() { std::filesystem::create_directories(folder_); }
  ~FleetCommand() override { std::filesystem::remove_all(folder_); }
  int run(const std::string& words) const {
    const int status = std::system(
        ("cd '" + folder_ + "' && export VERNIER_REGISTRY=fleet.db PATH=" VERNIER_BIN_DIR ":$PATH && { " +
         words + "; } >out.txt 2>&1")
            .c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  std::string said() const { return read_file(folder_ + "/out.txt"); }
  nlohmann::json json(const std::string& words) const {
    EXPECT_EQ(run(words + " --json answer.json"), 0) << said();
    return nlohmann::json::parse(read_file(folder_ + "/answer.json"));
  }
  const std::string folder_ = testing::TempDir() + "fleet_command_" + std::to_string(getpid()) + "_" +
                              testing::UnitTest::GetInstance()->current_test_info()->name();
};

TEST_F(FleetCommand, RecordsACalibrationAndItsChecks) {
  // GIVEN a machine that was fitted, compiled and checked
  write_file(folder_ + "/m.xml", kMachineFile);
  std::string rows = "X[mm],x[mm],u[mm]\n";
  for (int i = 0; i <= 20; ++i)
    rows += std::to_string(30 * i) + "," + std::to_string(30 * i + 0.003 * i + (i % 3) * 1e-4) + ",0.0002\n";
  write_file(folder_ + "/survey.csv", rows);
  ASSERT_EQ(run("vernier fit m.xml survey.csv -o fitted.xml && vernier compile fitted.xml -o image && "
                "vernier check fitted.xml survey.csv --history checks.json --label monday --json check.json"),
            0)
      << said();
  // WHEN it is entered
  ASSERT_EQ(run("vernier fleet add VMC-3 --url tcp://10.0.0.3 --check-days 7 && vernier fleet check VMC-3 "
                "--result check.json "
                "--history checks.json --at 2026-11-01 && vernier fleet record VMC-3 --model fitted.xml "
                "--image image "
                "--data survey.csv --signed-by inspector --against survey.csv"),
            0)
      << said();
  // THEN it stands there with all that it rests on, and is due
  const auto list = json("vernier fleet list")["machines"][0];
  EXPECT_EQ(list["calibration"]["signed_by"], "inspector");
  EXPECT_EQ(list["calibration"]["data_hash"], list["calibration"]["checked_hash"]);
  EXPECT_EQ(list["calibration"]["image"].get<std::string>().size(), 16u);
  EXPECT_EQ(json("vernier fleet due")["machines"][0]["why"], "not checked since its calibration");
  EXPECT_EQ(run("vernier fleet check VMC-3 --result check.json --history checks.json --at 2026-11-01"), 2)
      << "it is there";
  EXPECT_EQ(run("vernier fleet check VMC-3 --result check.json --at 2199-01-01"), 1) << "in the future";
  const auto alike = json("vernier fleet alike")["quantities"];
  ASSERT_FALSE(alike.empty());
  EXPECT_FALSE(alike[0]["judged"]) << "one machine is no fleet";
}

TEST_F(FleetCommand, AddChangesOnlyWhatIsSaid) {
  ASSERT_EQ(run("vernier fleet add V --url tcp://1.2.3.4 --check-days 7 --note hello && "
                "vernier fleet add V --check-days 3"),
            0)
      << said();
  const auto machine = json("vernier fleet list")["machines"][0];
  EXPECT_EQ(machine["url"], "tcp://1.2.3.4");
  EXPECT_EQ(machine["note"], "hello");
  EXPECT_EQ(machine["check_days"], 3);
  EXPECT_EQ(run("vernier fleet add V --check-days nan"), 1) << said();
}

TEST_F(FleetCommand, BoardOfAMachineIsEntered) {
  const std::string key(64, 'a'), other(64, 'b');
  ASSERT_EQ(run("vernier fleet add V --board mill-1 --board-key " + key + " && vernier fleet add V --note x"),
            0)
      << said();
  auto machine = json("vernier fleet list")["machines"][0];
  EXPECT_EQ(machine["board"], "mill-1");
  EXPECT_EQ(machine["board_key"], key);
  // Another name is another board, whose key is not known.
  ASSERT_EQ(run("vernier fleet add V --board mill-2"), 0) << said();
  EXPECT_TRUE(json("vernier fleet list")["machines"][0]["board_key"].is_null());
  ASSERT_EQ(run("vernier fleet add V --board-key " + other), 0) << said();
  EXPECT_EQ(run("vernier fleet add W --board mill-9 --board-key " + other), 2) << "the key is V's";
  EXPECT_EQ(run("vernier fleet add W --board-key " + key), 1) << "a key without a name";
  EXPECT_EQ(run("vernier fleet add W --board w --board-key 0123"), 1) << said();
  EXPECT_EQ(run("vernier fleet add W --board w --trust"), 1) << "stated and asked";
  EXPECT_EQ(run("vernier fleet add W --trust"), 1) << "no address";
}

// A state that nobody has refreshed never reads as one of now.
TEST_F(FleetCommand, StatusSaysHowOldAStateIsAndWhoseClockIsOff) {
  ASSERT_EQ(run("vernier fleet add m"), 0) << said();
  const auto hear = [&](std::uint64_t number, std::int64_t ahead_ms) {
    registry::Registry registry(registry::open_database(folder_ + "/fleet.db"));
    const auto ms = static_cast<std::uint64_t>(registry.database().now_us() / 1000 + ahead_ms);
    fleet::DeviceData one{"g", "m", {}};
    one.payload.metrics = {{"Board/Mode", std::string("active"), ms},
                           {"Board/Fault", std::string("none"), ms},
                           {std::string(fleet::kSpoolMetric), std::string("s"), ms},
                           {std::string(fleet::kNumberMetric), number, ms},
                           {std::string(fleet::kAfterMetric), number - 1, ms}};
    fleet::SampleWriter(registry).write({one});
  };
  hear(1, 0);
  EXPECT_EQ(json("vernier fleet status")["machines"][0]["state"], "online");
  EXPECT_FALSE(json("vernier fleet status")["machines"][0]["gateway_clock_off"]);
  hear(2, 6000);
  EXPECT_TRUE(json("vernier fleet status")["machines"][0]["gateway_clock_off"]);
  ASSERT_EQ(run("vernier fleet status"), 0);
  EXPECT_NE(said().find("the clock of gateway g has an error of +"), std::string::npos) << said();
  ASSERT_EQ(run("sleep 1; vernier fleet status --stale 0.5"), 0);
  EXPECT_NE(said().find("STALE    last heard: active"), std::string::npos) << said();
  EXPECT_EQ(said().find("online"), std::string::npos) << said();
  const auto stale = json("vernier fleet status --stale 0.5")["machines"][0];
  EXPECT_FALSE(stale["online"]);
  EXPECT_GT(stale["age_s"], 0.5);
}

TEST_F(FleetCommand, BadInputIsNamed) {
  ASSERT_EQ(run("vernier fleet add a"), 0) << said();
  for (const char* words : {"vernier fleet add a/b",
                            "vernier fleet add a --url nonsense://x",
                            "vernier fleet record b --model m.xml --signed-by w",
                            "vernier fleet check a --result out.txt",
                            "vernier fleet check b --result out.txt",
                            "vernier fleet status b",
                            "vernier fleet batch night --machine b fit {machine}.xml",
                            "vernier fleet batch night fit a.xml",
                            "vernier fleet batch night",
                            "vernier fleet batch night none {machine}",
                            "vernier fleet batch 'a b' fit {machine}.xml",
                            "vernier fleet batch night fit {machine}.xml --json -",
                            "vernier fleet batch night fleet add {machine}",
                            "vernier fleet collect none",
                            "vernier fleet task none a",
                            "vernier fleet gateway none.toml",
                            "vernier fleet alike --since yesterday",
                            "vernier fleet metrics --listen nowhere",
                            "vernier fleet list --registry /none/such/folder/f.db",
                            "vernier fleet add 'a b'",
                            "vernier fleet rename a 'a b'",
                            "vernier fleet list --registry fleeet.db",
                            "vernier fleet add 'a\nb'",
                            "vernier fleet due --at 2026-02-30",
                            "vernier fleet record a --model out.txt --signed-by w",
                            "vernier fleet ingest --broker localhost",
                            "vernier fleet ingest --broker tcp://localhost:mqtt"}) {
    EXPECT_EQ(run(words), 1) << words << "\n" << said();
    EXPECT_NE(said().find("vernier: "), std::string::npos) << words;
  }
  EXPECT_EQ(run("vernier fleet batch night --scheduler at fit {machine}.xml"), 1) << said();
  EXPECT_FALSE(std::filesystem::exists(folder_ + "/fleeet.db")) << "a misspelt registry made a file";
  write_file(folder_ + "/text",
             "this is no database, and long enough to be none in every way that there is of being one.");
  EXPECT_EQ(run("vernier fleet list --registry text"), 1) << said();
}

// The user's words never reach a shell: names and files with blanks, quotes and $ keep their bytes.
TEST_F(FleetCommand, BatchIsWorkedOffAndCollectedOnce) {
  // GIVEN three machines, one without measurements
  const std::string odd = "it's $HOME & more";
  std::filesystem::create_directories(folder_ + "/" + odd);
  for (const char* name : {"a", "b", "c"}) {
    ASSERT_EQ(run(std::string("vernier fleet add ") + name), 0) << said();
    write_file(folder_ + "/" + odd + "/" + name + ".xml", kMachineFile);
    if (name[0] != 'c')
      write_file(folder_ + "/" + name + ".csv",
                 "X[mm],x[mm],u[mm]\n0,0,0.1\n100,100.1,0.1\n200,200.2,0.1\n300,300.1,0.1\n");
  }
  const std::string words =
      "vernier fleet batch night compare \"it's \\$HOME & more/{machine}.xml\" {machine}.csv";
  ASSERT_EQ(run(words), 0) << said();
  EXPECT_NE(said().find("for 3 machines. Start the script: ./night/parallel.sh"), std::string::npos)
      << said();
  EXPECT_EQ(run(words), 1) << "there is one";
  // WHEN the tasks run as the scheduler runs them
  EXPECT_EQ(run("vernier fleet task night a && vernier fleet task night b && vernier fleet task night b"), 0)
      << said();
  EXPECT_EQ(run("vernier fleet task night d"), 1) << said();
  EXPECT_EQ(run("vernier fleet collect night --json answer.json"), 2) << said();
  EXPECT_EQ(nlohmann::json::parse(read_file(folder_ + "/answer.json"))["not_booked"][0]["state"], "missing");
  EXPECT_EQ(run("vernier fleet task night c"), 2) << said();
  EXPECT_EQ(run("vernier fleet collect night --json answer.json"), 2) << said();
  auto collected = nlohmann::json::parse(read_file(folder_ + "/answer.json"));
  EXPECT_EQ(collected["booked"], 0);
  EXPECT_EQ(collected["booked_before"], 2);
  EXPECT_EQ(collected["not_booked"][0]["state"], "failed");
  // THEN the repeated task is booked too, and a further collect changes nothing
  write_file(folder_ + "/c.csv", "X[mm],x[mm],u[mm]\n0,0,0.1\n100,100.1,0.1\n200,200.2,0.1\n300,300.1,0.1\n");
  ASSERT_EQ(run("vernier fleet task night c && vernier fleet collect night"), 0) << said();
  EXPECT_EQ(json("vernier fleet collect night")["booked"], 0);
  const auto answers = json("vernier fleet answers night")["answers"];
  ASSERT_EQ(answers.size(), 3u);
  EXPECT_EQ(answers[2]["machine"], "c");
  EXPECT_TRUE(answers[2]["result"].is_object()) << answers;
  EXPECT_EQ(run("vernier fleet collect ."), 1) << said();
}

TEST_F(FleetCommand, SlurmScriptNumbersTheMachines) {
  ASSERT_EQ(run("vernier fleet add a && vernier fleet add b && vernier fleet batch night --scheduler slurm "
                "-o 'a b' "
                "'vernier compare {machine}.xml {machine}.csv'"),
            0)
      << said();
  ASSERT_EQ(run("vernier fleet batch two --machine b --machine a compare {machine}.xml {machine}.csv && cat "
                "two/machines"),
            0)
      << said();
  EXPECT_NE(said().find("\na\nb\n"), std::string::npos) << said();
  ASSERT_EQ(
      run("vernier fleet batch one --machine b compare {machine}.xml {machine}.csv && cat one/machines"), 0)
      << said();
  EXPECT_NE(said().find("\nb\n"), std::string::npos) << said();
  const std::string script = read_file(folder_ + "/a b/slurm.sh");
  EXPECT_NE(script.find("#SBATCH --array=1-2\n"), std::string::npos) << script;
  EXPECT_EQ(run("cd 'a b' && sh -n slurm.sh"), 0) << said();
  const auto batch = nlohmann::json::parse(read_file(folder_ + "/a b/batch.json"));
  EXPECT_EQ(batch["command"].dump(), R"(["compare","{machine}.xml","{machine}.csv","--json","-"])");
}

// Names of older versions are listed with what to do.
TEST_F(FleetCommand, OldNameIsListedWithItsRemedy) {
  ASSERT_EQ(run("vernier fleet add a"), 0) << said();
  {
    registry::Registry registry(registry::open_database(folder_ + "/fleet.db"));
    registry.database().run(
        "INSERT INTO machine (name, url, note, check_days, added_us) VALUES ('my mill', '', '', 0, 1)");
  }
  const auto machines = json("vernier fleet list")["machines"];
  EXPECT_TRUE(machines[0]["name_allowed"]);
  EXPECT_FALSE(machines[1]["name_allowed"]);
  ASSERT_EQ(run("vernier fleet list"), 0) << said();
  EXPECT_NE(said().find("vernier fleet rename 'my mill' NEW_NAME"), std::string::npos) << said();
  EXPECT_EQ(run("vernier fleet batch night compare {machine}.xml {machine}.csv"), 1) << said();
  EXPECT_EQ(run("vernier fleet rename 'my mill' mill && vernier fleet batch night compare {machine}.xml "
                "{machine}.csv"),
            0)
      << said();
}

TEST_F(FleetCommand, GatewayAndIngestEndWhenTheyAreTold) {
  write_file(folder_ + "/g.toml",
             "[gateway]\nname = \"g\"\nstore = \"g.db\"\nbroker = \"tcp://127.0.0.1:1\"\n[[board]]\nmachine "
             "= \"m\"\nurl = \"tcp://127.0.0.1:1\"\n");
  EXPECT_EQ(run("timeout -s TERM 3 vernier fleet gateway g.toml; test $? = 124"), 0) << said();
  EXPECT_NE(said().find("no board answers"), std::string::npos) << said();
  EXPECT_EQ(run("timeout -s TERM 2 vernier fleet ingest --broker tcp://127.0.0.1:1; test $? = 124"), 0)
      << said();
  EXPECT_NE(said().find("no broker answers at this address"), std::string::npos) << said();
}

}  // namespace
}  // namespace vernier::fleet_command_test
