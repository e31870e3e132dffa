// How a report is made: what it takes, what it refuses, which rows it keeps, and that its text can never become markup.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "tenon/apps/json.hpp"
#include "tenon/apps/report/record_table.hpp"
#include "tenon/apps/report/report.hpp"
#include "tenon/apps/report/thinning.hpp"
#include "tenon/core/csv.hpp"
#include "tenon/core/scenery.hpp"
#include "tenon/problems/allocation/vehicle_file.hpp"
#include "tenon/problems/allocation/vehicle_scenery.hpp"
#include "tenon/problems/contact/scene_file.hpp"
#include "tenon/problems/delta/scene_file.hpp"
#include "tenon/tests/expect_message.hpp"
#include "tenon/tests/run_tenon.hpp"
#include "tenon/tests/sample_records.hpp"

namespace tenon {
namespace {

constexpr std::size_t kLargestPage = 1'500'000;  // bytes, without data

class Report : public testing::Test {
 protected:
  /// What is wrong with these files, as a report says it.
  std::string refusal(const std::vector<std::string>& files) {
    try {
      report_page(files);
    } catch (const InputError& error) {
      return error.what();
    }
    return "none";
  }
  /// With a scenery beside a small record.
  std::string refusal_of_scenery(const std::string& scenery) {
    folder_.write("run.csv", "t,x1,word\n0,1,a\n1,2,b\n");
    folder_.write("run.scene.json", scenery);
    return refusal({folder_.path("run.csv")});
  }

  ScratchFolder folder_;
};

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

TEST_F(Report, IsSmallAndAsksNobodyForAnything) {
  folder_.write("run.csv", "t,x1\n0,1\n1,2\n");
  const std::string page = report_page({folder_.path("run.csv")});
  EXPECT_LT(page.size(), kLargestPage);
  for (const char* outside : {"src=\"http", "href=\"http", "url(http", "@import", "REPORT_TITLE", "REPORT_DATA", "PAGE_SCRIPT"}) {
    EXPECT_EQ(page.find(outside), std::string::npos) << outside;
  }
  EXPECT_NE(page.find("default-src 'none'; script-src 'sha256-"), std::string::npos);
}

TEST_F(Report, NoTextOfARecordBecomesMarkup) {
  const std::size_t scripts = count(report_page(write_bouncing_ball(folder_)), "<script");
  const std::string page = report_page(write_bouncing_ball(folder_, "</script><script>alert(1)</script>"));
  EXPECT_EQ(count(page, "<script"), scripts);
  EXPECT_EQ(count(page, "</script><script>alert"), 0u);
  folder_.write("<b>&\".csv", "t,x1\n0,1\n1,2\n");
  const std::string titled = report_page({folder_.path("<b>&\".csv")});
  EXPECT_NE(titled.find("<title>&lt;b&gt;&amp;&quot;</title>"), std::string::npos);
}

TEST_F(Report, TellsRecordsByTheirColumns) {
  const auto kind = [](const std::string& header) {
    return record_kind(parse_csv(header + "\n" + std::string(static_cast<std::size_t>(std::count(header.begin(), header.end(), ',')), ',') + "\n", "x.csv", {{}, {}, true}));
  };
  EXPECT_EQ(kind("t,x1"), RecordKind::trajectory);
  EXPECT_EQ(kind("t,contact,from,to,gap"), RecordKind::events);
  EXPECT_EQ(kind("t,contact,tau,gap"), RecordKind::fast_phases);
  EXPECT_EQ(kind("problem,solver,status,time_s"), RecordKind::comparison);
  EXPECT_EQ(kind("cost,ratio,ipopt"), RecordKind::profile);
  EXPECT_EQ(kind("nx,ny,nz,force"), RecordKind::sphere);
  EXPECT_EQ(kind("frequency,impedance_off"), RecordKind::frequency);
  EXPECT_EQ(kind("seed,success,offset"), RecordKind::sweep);
}

TEST_F(Report, SaysWhatIsWrongWithARecord) {
  EXPECT_NE(refusal({folder_.path("none.csv")}).find("none.csv: cannot be read"), std::string::npos);
  EXPECT_NE(refusal({folder_.write("a.csv", "a,b\n1,2\n")}).find("a.csv:1:1: the columns a,b are of no record"), std::string::npos);
  EXPECT_NE(refusal({folder_.write("back.csv", "t,x\n0,1\n2,1\n1,1\n")}).find("back.csv:4:1: the time goes back"), std::string::npos);
  EXPECT_NE(refusal({folder_.write("nan.csv", "t,x\n0,nan\n")}).find("nan.csv:2:3"), std::string::npos);
  EXPECT_NE(refusal({folder_.write("e.csv", "t,contact,from,to\n0,a,0,1\n")}).find("these events follow no trajectory"), std::string::npos);
  EXPECT_NE(refusal({folder_.write("bad.jsonl", "{\"index\":0,\"mu\":1}\n{\"index\":,}\n")}).find("bad.jsonl:2:"), std::string::npos);
  EXPECT_NE(refusal({folder_.write("short.jsonl", "{\"index\":0,\"mu\":1}\n{\"index\":1}\n")}).find("short.jsonl:2: 'mu' is missing"), std::string::npos);
}

TEST_F(Report, SaysWhatIsWrongWithAScenery) {
  const std::string head = "{\"schema\": 1, \"space\": \"planar\", ";
  EXPECT_EQ(refusal_of_scenery(head + "\"bodies\": [{\"name\": \"a\", \"position\": [\"x1\", 0]}]}"), "none");
  EXPECT_NE(refusal_of_scenery(head + "\n\"bodies\": [}").find("run.scene.json:2:12: this is no JSON"), std::string::npos);
  EXPECT_NE(refusal_of_scenery("{\"schema\": 2}").find("schema is not 1"), std::string::npos);
  EXPECT_NE(refusal_of_scenery("{\"schema\": 1, \"space\": \"round\"}").find("space is 'round'"), std::string::npos);
  EXPECT_NE(refusal_of_scenery(head + "\"bodies\": [{\"name\": \"a\", \"position\": [\"x2\", 0]}]}").find("bodies[0].position names column 'x2'"), std::string::npos);
  EXPECT_NE(refusal_of_scenery(head + "\"bodies\": [{\"name\": \"a\", \"angle\": \"word\"}]}").find("names column 'word'"), std::string::npos);
  EXPECT_NE(refusal_of_scenery(head + "\"bodies\": [{\"name\": \"a\", \"parent\": \"b\"}]}").find("bodies[0].parent is 'b'"), std::string::npos);
  EXPECT_NE(refusal_of_scenery(head + "\"bodies\": [{\"name\": \"a\", \"shapes\": [{\"torus\": {}}]}]}").find("a shape of no known kind"), std::string::npos);
  const std::string body = head + "\"bodies\": [{\"name\": \"a\"}], ";
  EXPECT_EQ(refusal_of_scenery(body + "\"ghosts\": [{\"body\": \"a\", \"count\": 1, \"position\": [\"x#\"]}]}"), "none");
  EXPECT_NE(refusal_of_scenery(body + "\"ghosts\": [{\"body\": \"a\", \"count\": 2, \"position\": [\"x#\"]}]}").find("ghosts[0].position names column 'x2'"), std::string::npos);
  EXPECT_NE(refusal_of_scenery(body + "\"ghosts\": [{\"body\": \"a\", \"count\": 0}]}").find("ghosts[0].count is no count"), std::string::npos);
  EXPECT_NE(refusal_of_scenery(body + "\"ellipses\": [{\"body\": \"a\", \"covariance\": [1, 0, 1]}]}").find("ellipses[0].covariance has 3 values"), std::string::npos);
  EXPECT_NE(refusal_of_scenery(body + "\"lenses\": [{\"body\": \"b\", \"extent\": 1}]}").find("lenses[0].body is 'b'"), std::string::npos);
  EXPECT_NE(refusal_of_scenery(body + "\"estimates\": [{\"across\": {\"mean\": \"x1\"}}]}").find("estimates[0].upward is no object"), std::string::npos);
  EXPECT_NE(refusal_of_scenery(body + "\"plots\": [{\"columns\": [\"x1\"], \"bands\": [{\"mean\": \"x1\", \"variance\": \"xx\"}]}]}").find("plots[0].bands.variance names column 'xx'"), std::string::npos);
  EXPECT_NE(refusal_of_scenery(head + "\"arrows\": [{\"name\": \"f\", \"body\": \"a\"}]}").find("arrows[0].body is 'a'"), std::string::npos);
}

TEST_F(Report, AWrittenSceneryReadsBackWhateverItsNames) {
  const std::string name = "a \"name\" with \\ and \n and \x01";
  Scenery scenery;
  scenery.title = name;
  scenery.bodies = {{.name = name, .position = {SceneryValue("x1", {1, -0.5}), "x1"}, .shapes = {SceneryShape::box({1, 2, 3}).at({0, 1, 0}, 0.5).colored("frame")}}};
  const Json json = Json::parse(scenery.json(), "scene");
  EXPECT_EQ(json.at("title").as_text(), name);
  const Json body = json.at("bodies").elements().at(0);
  EXPECT_EQ(body.at("name").as_text(), name);
  EXPECT_EQ(body.at("position").elements().at(1).as_text(), "x1");
  EXPECT_EQ(body.at("shapes").elements().at(0).at("angle").number(), 0.5);
  EXPECT_EQ(refusal_of_scenery(scenery.json()), "none");
}

TEST_F(Report, ASceneryOfEveryBuiltInVehicleFitsItsAllocationRecord) {
  for (const std::string& name : builtin_vehicles()) {
    const Vehicle vehicle = load_vehicle(name).vehicle;
    std::string header = "t", first = "0", second = "1";
    for (const char* column : {"u", "a"}) {
      for (int i = 1; i <= vehicle.num_rotors(); ++i) {
        header += "," + (column + std::to_string(i));
        first += ",0", second += ",1";
      }
    }
    folder_.write("run.csv", header + "\n" + first + "\n" + second + "\n");
    folder_.write("run.scene.json", vehicle_scenery(vehicle).json());
    EXPECT_EQ(refusal({folder_.path("run.csv")}), "none") << name;
  }
}

TEST_F(Report, AShortRecordKeepsAllItsRows) {
  const CsvTable ball = read_record(write_bouncing_ball(folder_)[0]);
  EXPECT_EQ(thinned_rows(ball, {}, 1'000'000).size(), static_cast<std::size_t>(ball.rows()));
}

TEST_F(Report, ALongRecordKeepsTheExtremesOfEveryColumnItsEventsAndItsChangesOfMode) {
  CsvTable table{.file = "long", .names = {"t", "a", "mode_x"}, .columns = {{}, {}, {}}, .texts = {{}, {}, {}}, .lines = {}};
  for (int k = 0; k < 100'000; ++k) {
    table.columns[0].push_back(k);
    table.columns[1].push_back(k == 54'321 ? 9 : k == 12'345 ? -9 : std::sin(0.01 * k));
    table.columns[2].push_back(k >= 70'001);
    table.lines.push_back(k + 2);
  }
  constexpr std::size_t kValues = 6000;
  const std::vector<int> kept = thinned_rows(table, {33'333}, kValues);
  EXPECT_LE(kept.size(), kValues / 3);
  EXPECT_GE(kept.size(), kValues / 6);
  EXPECT_TRUE(std::is_sorted(kept.begin(), kept.end()));
  for (const int row : {0, 54'321, 12'345, 33'332, 33'333, 33'334, 70'000, 70'001, 99'999}) {
    EXPECT_TRUE(std::binary_search(kept.begin(), kept.end(), row)) << row;
  }
}

TEST_F(Report, ALongTraceKeepsTheSolvesThatTookMostIterations) {
  CsvTable trace{.file = "t.jsonl", .names = {"row", "index"}, .columns = {{}, {}}, .texts = {{}, {}}, .lines = {}};
  for (int row = 0; row < 10; ++row) {
    for (int k = 0; k <= row; ++k) {
      trace.columns[0].push_back(row);
      trace.columns[1].push_back(k);
      trace.lines.push_back(1);
    }
  }
  const std::vector<int> kept = longest_solves(trace, 20);
  EXPECT_EQ(kept.size(), 19u);  // rows 8 and 9
  for (const int k : kept) EXPECT_GE(trace["row"][static_cast<std::size_t>(k)], 8);
  EXPECT_EQ(longest_solves(trace, 1000).size(), static_cast<std::size_t>(trace.rows()));
}

TEST_F(Report, TheVerbsWriteRecordAndPageAndThePageCanBeMadeAgain) {
  folder_.write("log.csv", "t,Fx,Fy,Fz,Mx,My,Mz\n0,0,0,24,0,0,0\n0.1,1,0,24,0,0.1,0\n0.2,2,0,24,0,0.1,0\n");
  EXPECT_EQ(run_tenon(folder_, "allocate momav --wrenches log.csv --report run.html").code, 0);
  EXPECT_TRUE(folder_.has("run.csv") && folder_.has("run.scene.json") && folder_.has("run.html"));
  const Ended again = run_tenon(folder_, "report run.csv --output again.html");
  EXPECT_EQ(again.code, 0) << again.err;
  EXPECT_EQ(again.out, "again.html\n");
  EXPECT_EQ(folder_.read("again.html").size(), folder_.read("run.html").size());

  EXPECT_EQ(run_tenon(folder_, "compare hs071 hs035 --solvers newton-kkt --report compare.html").code, 0);
  EXPECT_TRUE(folder_.read("compare.csv").starts_with("problem,solver,status,objective,residual,iterations,time_s\nhs071,newton-kkt,solved,"));
  EXPECT_EQ(run_tenon(folder_, "solve hs071 --report solve.html").code, 0);
  EXPECT_EQ(run_tenon(folder_, "report compare.csv solve.jsonl run.csv --report all.html").code, 0);
  EXPECT_TRUE(folder_.has("all.html"));
}

TEST_F(Report, EveryBuiltInSceneDrawsItself) {
  std::vector<std::string> scenes = contact::builtin_scenes();
  const std::vector<std::string> with_robot = delta::builtin_scenes();
  scenes.insert(scenes.end(), with_robot.begin(), with_robot.end());
  for (const std::string& scene : scenes) {
    if (scene == "chain-fountain") continue;  // takes minutes
    const Ended ended = run_tenon(folder_, "simulate " + scene + " --set simulation.duration=0.2 --report run.html");
    EXPECT_EQ(ended.code, 0) << scene << "\n" << ended.err;
    EXPECT_NE(folder_.read("run.html").find("\"title\":\"" + scene + "\""), std::string::npos) << scene;
  }
}

TEST_F(Report, ABadPathOrRecordLeavesNoPage) {
  folder_.write("a.csv", "a,b\n1,2\n");
  const Ended bad = run_tenon(folder_, "report a.csv");
  EXPECT_EQ(bad.code, 2);
  EXPECT_TRUE(is_one_line(bad.err, "tenon: a.csv:1:1: the columns a,b")) << bad.err;
  EXPECT_FALSE(folder_.has("a.html") || folder_.has("a.html.partial"));
  EXPECT_EQ(run_tenon(folder_, "solve hs071 --report none/solve.html").code, 2);
  folder_.write("run.csv", "t,x\n0,1\n");
  EXPECT_EQ(run_tenon(folder_, "report run.csv --output /dev/full").code, 3);
}

}  // namespace
}  // namespace tenon
