// The command line as a script sees it: exit codes, one line for what is wrong, files that are whole or not there.
#include <gtest/gtest.h>

#include "tenon/core/csv.hpp"
#include "tenon/tests/run_tenon.hpp"

namespace tenon {
namespace {

constexpr const char* kLog = "t,Fx,Fy,Fz,Mx,My,Mz\n0,0,0,24,0,0,0\n0.1,1,0,24,0,0.1,0\n0.2,2,0,24,0,0.1,0\n";

class CommandLine : public testing::Test {
 protected:
  Ended run(const std::string& arguments) { return run_tenon(folder_, arguments); }

  /// Exit 2, one line that begins so, no file left behind.
  void expect_bad_input(const std::string& arguments, const std::string& line) {
    tenon::expect_bad_input(folder_, arguments, line);
  }

  /// A bad log, allocated.
  void expect_bad_log(const std::string& text, const std::string& line) {
    folder_.write("log.csv", text);
    expect_bad_input("allocate momav --wrenches log.csv --output out.csv --trace trace.jsonl --solver pseudo-inverse", "log.csv" + line);
  }

  /// A bad vehicle: momav with a --set, or a file.
  void expect_bad_vehicle(const std::string& vehicle, const std::string& line) {
    folder_.write("log.csv", kLog);
    expect_bad_input("allocate " + vehicle + " --wrenches log.csv --output out.csv --solver pseudo-inverse", line);
  }

  ScratchFolder folder_;
};

TEST_F(CommandLine, AllocatesALogIntoAFileThatReadsBack) {
  folder_.write("log.csv", kLog);
  const Ended ended = run("allocate momav --wrenches log.csv --output out.csv --solver pseudo-inverse --set limits.hard=false");
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_NE(ended.out.find("3 solved, 0 best_effort, 0 fallback"), std::string::npos) << ended.out;
  EXPECT_EQ(folder_.read("out.csv").substr(0, folder_.read("out.csv").find('\n')),
            "t,u1,u2,u3,u4,u5,u6,a1,a2,a3,a4,a5,a6,status,iterations,fallback,objective,residual,Fx_error,Fy_error,Fz_error,Mx_error,My_error,"
            "Mz_error,time_us");
  const CsvTable table = read_csv(folder_.path("out.csv"), {{"t", "u1", "a6", "fallback", "Fx_error", "time_us"}, {}});
  EXPECT_EQ(table.rows(), 3);
  EXPECT_EQ(table["fallback"][2], 0);
  EXPECT_LT(std::abs(table["Fx_error"][2]), 1e-12);
  EXPECT_FALSE(folder_.has("out.csv.partial"));
}

TEST_F(CommandLine, AllocatesToStandardOutputWhereNoFileIsNamed) {
  folder_.write("log.csv", kLog);
  const Ended ended = run("allocate tilt-quad --wrenches log.csv --solver pseudo-inverse");
  EXPECT_EQ(ended.code, 0);
  EXPECT_EQ(std::count(ended.out.begin(), ended.out.end(), '\n'), 4);
  const Ended json = run("allocate flat-hexa --wrenches log.csv --solver pseudo-inverse --json");
  EXPECT_TRUE(json.out.starts_with("{\n  \"schema\": 1,")) << json.out;
  EXPECT_NE(json.out.find("force along body x"), std::string::npos);
}

TEST_F(CommandLine, StartsFromTheAnglesOfInitialOrEveryRowOnItsOwn) {
  folder_.write("log.csv", kLog);
  EXPECT_EQ(run("allocate momav --wrenches log.csv --output out.csv --initial -0.1,7,0,0,0,0 --solver pseudo-inverse").code, 0);
  EXPECT_LT(std::abs(read_csv(folder_.path("out.csv"), {{"a2"}, {}})["a2"][0] - 7), 0.7);  // 2 pi rad/s for 0.1 s
  EXPECT_EQ(run("allocate momav --wrenches log.csv --output out.csv --cold --solver pseudo-inverse").code, 0);
  EXPECT_EQ(run("allocate momav --wrenches log.csv --initial 1,2").code, 2);
  EXPECT_EQ(run("allocate momav --wrenches log.csv --initial 1,2,3,4,5,x").code, 2);
  EXPECT_EQ(run("allocate momav --wrenches log.csv --initial 1,2,3,4,5,6 --cold").code, 2);
}

TEST_F(CommandLine, ARotorFailsWhenItsTimeHasCome) {
  folder_.write("log.csv", kLog);
  const Ended ended = run("allocate momav --wrenches log.csv --output out.csv --solver pseudo-inverse --set rotor.2.fails_at=0.1");
  EXPECT_EQ(ended.code, 0);
  EXPECT_NE(ended.err.find("t = 0.1 s: rotor 2 fails"), std::string::npos) << ended.err;
  const CsvTable table = read_csv(folder_.path("out.csv"), {{"u2"}, {}});
  EXPECT_GT(table["u2"][0], 0);
  EXPECT_EQ(table["u2"][1], 0);
}

TEST_F(CommandLine, RefusesABadLog) {
  expect_bad_input("allocate momav --wrenches none.csv --output out.csv", "none.csv: cannot be read: No such file");
  expect_bad_log("", ":1:1: the file is empty");
  expect_bad_log("t,Fx,Fy,Fz,Mx,My,Mz\n0,0,0,24,0,0\n", ":2:13: the row has 6 cells (expected 7, as the header)");
  expect_bad_log("t,Fx,Fy,Fz,Mx,My,Mz\n0,0,0,heavy,0,0,0\n", ":2:7: column 'Fz' holds 'heavy' (expected a number)");
  expect_bad_log("t,Fx,Fy,Fz,Mx,My,Mz\n0,0,0,nan,0,0,0\n", ":2:7: column 'Fz' holds 'nan' (expected a finite number)");
  expect_bad_log("t,Fx,Fy,Fz,Mx,My,Mz\n0,0,0,inf,0,0,0\n", ":2:7: column 'Fz' holds 'inf'");
  expect_bad_log("time,force\n0,0\n", ":1:1: column 'Fx' is missing in 'time,force'");
  expect_bad_log("dt,Fx,Fy,Fz,Mx,My,Mz\n-0.01,0,0,24,0,0,0\n", ":2: dt is -0.01 s");
}

TEST_F(CommandLine, RefusesABadVehicle) {
  expect_bad_vehicle("momaw", "unknown vehicle 'momaw', the nearest is 'momav'");
  expect_bad_vehicle("none.toml", "none.toml: cannot be read");
  expect_bad_vehicle("momav --set rotor.1.axis=[0,0,0]", "--set rotor.1.axis=[0,0,0]: rotor 1: axis is zero");
  expect_bad_vehicle("momav --set rotor=[]", "--set rotor=[]: there are 0 rotors (expected 3 to 12)");
  folder_.write("v.toml", "mass = 2\nmas = 3\n");
  expect_bad_vehicle("v.toml", "v.toml:2:1: unknown key 'mas'; the nearest known key is 'mass'");
  std::string many = "mass = 1\n";
  for (int i = 0; i < 700; ++i) many += "[[rotor]]\nposition=[0,0,0]\naxis=[1,0,0]\nzero=[0,0,1]\nspin=1\nthrust=[0,1]\ntorque=[0,1]\n";
  folder_.write("v.toml", many);
  expect_bad_vehicle("v.toml", "v.toml:2:1: there are 700 rotors (expected 3 to 12)");
}

TEST_F(CommandLine, ANonUnitAxisIsNotedAndUsed) {
  folder_.write("log.csv", kLog);
  const Ended ended = run("allocate tilt-quad --wrenches log.csv --output out.csv --solver pseudo-inverse --set rotor.1.zero=[0,0,3]");
  EXPECT_EQ(ended.code, 0);
  EXPECT_TRUE(is_one_line(ended.err, "tenon: tilt-quad: rotor 1: zero has length 3, brought to 1")) << ended.err;
}

TEST_F(CommandLine, RefusesBadUsage) {
  expect_bad_input("", "no verb");
  expect_bad_input("simulate peg-in-hole", "peg-in-hole: not a scene for simulate (it is for mpc, plan, estimate, sweep)");
  expect_bad_input("mpc cradle", "cradle: not a scene for mpc (it is for simulate)");
  expect_bad_input("alocate", "unknown verb 'alocate', the nearest is 'allocate'");
  expect_bad_input("allocate momav", "allocate: nothing to allocate (expected --wrenches FILE.csv)");
  expect_bad_input("allocate --wrenches x", "allocate: nothing named (expected VEHICLE)");
  expect_bad_input("allocate momav --wrenchs x", "allocate: unknown flag '--wrenchs', the nearest is '--wrenches'");
  expect_bad_input("allocate momav --wrenches x --solver pseudo-invers", "");
  expect_bad_input("solve hs071 hs035", "solve: 'hs035' is one word too many");
  expect_bad_input("solve hs71", "unknown problem");
  expect_bad_input("solve envelope", "unknown problem \"envelope\"");  // a verb, but not here
  expect_bad_input("solve hs071 --solver ipop", "unknown solver");
  expect_bad_input("solve hs071 --tolerance much", "solve: --tolerance = much makes no sense (expected a number)");
  expect_bad_input("solve hs071 --tolerance nan", "solve: --tolerance: nan is not finite");
  expect_bad_input("solve hs071 --starts 0", "solve: --starts: Value 0 not in range");
  expect_bad_input("solve hs071 --tolerance -1", "option tolerance");
  expect_bad_input("compare hs071 --solvers ipop", "unknown solver 'ipop', the nearest is 'ipopt'");
  expect_bad_input("list fruit", "list: unknown kind 'fruit'");
  expect_bad_input("bench fruit", "bench: no row begins with 'fruit'");
  folder_.write("log.csv", kLog);
  expect_bad_input("allocate momav --wrenches log.csv --solver pseudo-invers --output out.csv --trace trace.jsonl", "unknown solver 'pseudo-invers'");
}

TEST_F(CommandLine, AFolderThatIsNotThereIsBadInput) {
  folder_.write("log.csv", kLog);
  expect_bad_input("allocate momav --wrenches log.csv --output none/out.csv", "none/out.csv: the folder 'none' is not there");
  expect_bad_input("solve hs071 --trace none/t.jsonl", "none/t.jsonl: the folder 'none' is not there");
}

TEST_F(CommandLine, AFullDiskEndsWithThree) {
  folder_.write("log.csv", kLog);
  const Ended to_file = run("allocate momav --wrenches log.csv --output /dev/full --solver pseudo-inverse");
  EXPECT_EQ(to_file.code, 3);
  EXPECT_TRUE(is_one_line(to_file.err, "tenon: /dev/full: cannot be written: No space left on device")) << to_file.err;
  for (const char* arguments : {"list", "allocate momav --wrenches log.csv --solver pseudo-inverse --quiet", "bench allocation/linear --json"}) {
    const int status = std::system(("cd '" + folder_.path("") + "' && '" TENON_BINARY "' " + arguments + " > /dev/full 2> stderr.txt").c_str());
    EXPECT_EQ(WEXITSTATUS(status), 3) << arguments;
    EXPECT_TRUE(is_one_line(folder_.read("stderr.txt"), "tenon: standard output: cannot be written")) << folder_.read("stderr.txt");
  }
}

TEST_F(CommandLine, CtrlCInTheMiddleKeepsCompleteRowsInPartial) {
  std::string log = "dt,Fx,Fy,Fz,Mx,My,Mz\n";
  for (int k = 0; k < 300000; ++k) log += "0.004,1,0,24,0,0.1,0\n";
  folder_.write("log.csv", log);
  for (const char* signal : {"INT", "TERM"}) {
    // Interrupts once the first rows are on the disk.
    const std::string script = "cd '" + folder_.path("") +
                               "' && { '" TENON_BINARY "' allocate momav --wrenches log.csv --output out.csv --solver pseudo-inverse 2> stderr.txt & } ;"
                               " while ! test -s out.csv.partial; do sleep 0.01; done; kill -" + signal + " $!; wait $!";
    const int status = std::system(script.c_str());
    EXPECT_EQ(WEXITSTATUS(status), 130);
    EXPECT_FALSE(folder_.has("out.csv"));
    const CsvTable rows = read_csv(folder_.path("out.csv.partial"), {{"t", "time_us"}, {}});
    EXPECT_GT(rows.rows(), 0);
    EXPECT_LT(rows.rows(), 300000);
    EXPECT_TRUE(folder_.read("out.csv.partial").ends_with('\n'));
    EXPECT_TRUE(is_one_line(folder_.read("stderr.txt"), "tenon: interrupted, ")) << folder_.read("stderr.txt");
    std::filesystem::remove(folder_.path("out.csv.partial"));
  }
}

TEST_F(CommandLine, ListsSolvesChecksComparesAndFits) {
  EXPECT_NE(run("list solvers").out.find("ipopt"), std::string::npos);
  EXPECT_NE(run("list missions").out.find("tumble"), std::string::npos);
  EXPECT_TRUE(run("list --json").out.starts_with("{\n  \"schema\": 1"));
  const Ended solved = run("solve hs071 --json --trace trace.jsonl --verbose");
  EXPECT_EQ(solved.code, 0);
  EXPECT_NE(solved.out.find("\"status\": \"solved\""), std::string::npos);
  EXPECT_NE(solved.err.find("objective"), std::string::npos);
  EXPECT_TRUE(folder_.read("trace.jsonl").starts_with("{\"index\":0,\"objective\":"));
  EXPECT_EQ(run("solve hs071 --max-iterations 1").code, 1);
  EXPECT_NE(run("solve hs071 --max-iterations 1").out.find("stationarity is worst"), std::string::npos);
  const Ended strewn = run("solve hs044 --starts 30 --seed 2");
  EXPECT_EQ(strewn.code, 0);
  EXPECT_TRUE(strewn.out.starts_with("30 starts, 0 failed; 2 distinct:")) << strewn.out;
  EXPECT_NE(strewn.out.find("found"), std::string::npos);
  EXPECT_NE(run("solve hs044 --starts 3 --json").out.find("\"tried\": 3"), std::string::npos);
  EXPECT_EQ(run("check hs071").code, 0);
  EXPECT_NE(run("compare hs071 hs035").out.find("hs035"), std::string::npos);
  folder_.write("bench.csv", "u,thrust,torque\n.3,3.93,.05\n.5,7,.09\n.7,10.83,.15\n.9,16.44,.22\n1,19.94,.27\n");
  EXPECT_TRUE(run("fit bench.csv").out.starts_with("thrust = [0, 8.0786"));
  EXPECT_NE(run("bench allocation/linear --json").out.find("\"median_s\""), std::string::npos);
}

TEST_F(CommandLine, AVehicleIsComparedOnRandomRows) {
  const Ended compared = run("compare momav --rows 3 --seed 2 --solvers newton-kkt,newton-kkt-sparse");
  EXPECT_EQ(compared.code, 0) << compared.err;
  EXPECT_TRUE(compared.out.starts_with("momav: 3 random rows, seed 2; soft limits, start from the linear solution\n")) << compared.out;
  EXPECT_NE(compared.out.find("newton-kkt-sparse"), std::string::npos);
  const Ended again = run("compare momav --rows 3 --seed 2 --solvers newton-kkt,newton-kkt-sparse --json");
  EXPECT_NE(again.out.find("\"rows\": 3"), std::string::npos) << again.out;
}

TEST_F(CommandLine, SimulatesASceneIntoATrajectoryAndItsEvents) {
  const Ended ended = run("simulate bouncing-ball --output out.csv --events events.csv");
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_NE(ended.out.find("reached at t = 2 s"), std::string::npos) << ended.out;
  const CsvTable table = read_csv(folder_.path("out.csv"), {{"t", "x1", "vx1", "lambda_ground", "gap_ground", "mode_ground", "energy"}, {}});
  EXPECT_EQ(table["t"].front(), 0);
  EXPECT_EQ(table["t"].back(), 2);
  EXPECT_EQ(table["mode_ground"].back(), 1) << "still settling";
  EXPECT_EQ(folder_.read("events.csv").substr(0, folder_.read("events.csv").find('\n')),
            "t,contact,from,to,gap,gap_rate_before,gap_rate_after,impulse,energy_before,energy_after");
}

TEST_F(CommandLine, ASceneTakesItsParametersByName) {
  const Ended ended = run("simulate bouncing-ball --set height=0.5 --set simulation.duration=0.1 --json");
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_NE(ended.out.find("\"t\": 0.1"), std::string::npos) << ended.out;
  expect_bad_input("simulate bouncing-ball --set heigth=2 --output out.csv", "--set heigth=2: unknown parameter 'heigth', the nearest is 'height'");
  expect_bad_input("simulate bouncing-ball --set height=-1 --output out.csv", "bouncing-ball:");
  expect_bad_input("simulate bouncing-boll --output out.csv", "unknown scene 'bouncing-boll', the nearest is 'bouncing-ball'");
  expect_bad_input("simulate cradle --set restitution=1.1 --output out.csv", "cradle:");
  expect_bad_input("simulate cradle --solver eda --output out.csv", "unknown integrator \"eda\"");
}

TEST_F(CommandLine, ARunThatCannotGoOnKeepsItsRecordAndSaysWhen) {
  folder_.write("scene.toml",
                "[simulation]\nduration = 1.0\n[[body]]\nname = \"b\"\nkind = \"line\"\nmass = 1.0\n[[force]]\nname = \"f\"\ntype = "
                "\"expression\"\non = \"b\"\nforce = [1.0, 0.0]\nexpression = \"sqrt(0.5 - t)\"\n");
  const Ended ended = run("simulate scene.toml --output out.csv");
  EXPECT_EQ(ended.code, 1);
  EXPECT_NE(ended.err.find("t = 0.5"), std::string::npos) << ended.err;
  EXPECT_FALSE(folder_.has("out.csv"));
  EXPECT_GE(read_csv(folder_.path("out.csv.partial"), {{"t", "x1"}, {}}).rows(), 45);
}

}  // namespace
}  // namespace tenon
