// What a report shows of a plan and of a belief: ghosts, ellipses, lenses and what is ahead on the plots, as the record has them; and a sweep's
// comparison with its baselines.
#include <array>
#include <cmath>
#include <numbers>

#include "tenon/core/csv.hpp"
#include "tenon/tests/report_page.hpp"
#include "tenon/tests/run_tenon.hpp"

namespace tenon {
namespace {

using nlohmann::json;

/// A pixel of the animation of part 0 at a point of its scene (m), [r, g, b].
constexpr const char* kPixelAt = R"(((x, y) => {
  const {animation, clock} = report.parts[0], {canvas, camera} = animation;
  animation.show(clock.t);
  const p = camera.position.clone().set(x, y, 0).project(camera);
  const copy = document.createElement("canvas");
  [copy.width, copy.height] = [canvas.width, canvas.height];
  const context = copy.getContext("2d");
  context.drawImage(canvas, 0, 0);
  return [...context.getImageData(Math.round((p.x + 1) / 2 * canvas.width), Math.round((1 - p.y) / 2 * canvas.height), 1, 1).data].slice(0, 3);
}))";

std::string call(const std::string& function, double x, double y) {
  return function + "(" + std::to_string(x) + "," + std::to_string(y) + ")";
}

/// A block that a plan has rise by 0.5 m in each of four intervals, and a mark that is believed to be at (mean_x, 0), turned by mean_a.
class ReportPlan : public ReportPage {
 protected:
  std::string write_record() {
    folder_.write("run.csv",
                  "t,x,y,plan_y1,plan_y2,plan_y3,plan_y4,mean_x,mean_a,truth_x,truth_a,xx,ax,aa\n"
                  "0,0,0,0.5,1,1.5,2,3,0.1,3.1,0.1,0.25,0.03,0.09\n"
                  "1,0,1,1.5,2,2.5,3,3,0.1,3.1,0.1,0.04,0.004,0.01\n");
    folder_.write("run.scene.json", R"({"schema": 1, "title": "plan", "space": "planar", "camera": {"extent": 12, "target": [0, 2, 0]},
      "bodies": [{"name": "block", "position": ["x", "y"], "shapes": [{"box": {"size": [2, 0.4, 0]}}]},
                 {"name": "mark", "position": ["mean_x", 0], "angle": "mean_a", "outline": true, "shapes": [{"line": {"points": [[0, 0, 0], [1, 0, 0]]}}]}],
      "ghosts": [{"body": "block", "count": 4, "position": ["x", "plan_y#"]}],
      "ellipses": [{"body": "mark", "at": [0, 0], "covariance": ["xx", 0, "ax", 0, 0, "aa"]},
                   {"body": "mark", "at": [1, 0], "covariance": [0, 0, 0, 0, 0, "aa"]}],
      "lenses": [{"name": "block", "body": "block", "at": [1, 0.2], "extent": 0.1}],
      "estimates": [{"title": "mark", "across": {"title": "x", "unit": "m", "mean": "mean_x", "truth": "truth_x"},
                     "upward": {"title": "a", "unit": "rad", "mean": "mean_a", "truth": "truth_a"}, "covariance": ["xx", "ax", "aa"]}],
      "plots": [{"title": "height", "unit": "m", "columns": ["y"], "foresights": [{"columns": "plan_y#", "count": 4, "step": 0.1}]},
                {"title": "mark", "unit": "m", "columns": ["mean_x"], "bands": [{"mean": "mean_x", "variance": "xx"}]}]})");
    return folder_.path("run.csv");
  }
  json value(const std::string& expression) { return browser().evaluate(expression); }
  void go(double t) { browser().evaluate("report.parts[0].clock.go(" + std::to_string(t) + ")"); }
};

TEST_F(ReportPlan, GhostsStandWhereThePlanHasTheBodyAndMoveWithTheClock) {
  open({write_record()}, "#theme=light", kAnimated);
  const std::string heights = "report.parts[0].animation.ghosts[0].ghosts.map(({group}) => Math.round(1e6 * group.position.y) / 1e6)";
  EXPECT_EQ(value(heights), (json{0.5, 1, 1.5, 2}));
  const json paper = value(call(kPixelAt, 0, 4.5));
  EXPECT_NE(value(call(kPixelAt, 0, 2.2)), paper) << "the upper edge of the last ghost";
  EXPECT_EQ(value(call(kPixelAt, 0, 2.0)), paper) << "an outline is empty";
  EXPECT_EQ(value(call(kPixelAt, 0, 3.2)), paper);
  go(0.5);
  EXPECT_EQ(value(heights), (json{1, 1.5, 2, 2.5}));
  go(1);
  EXPECT_NE(value(call(kPixelAt, 0, 3.2)), paper);
  const json near = value(call(kPixelAt, 0, 1.7)), far = value(call(kPixelAt, 0, 3.2));
  EXPECT_LT(near[0].get<int>(), far[0].get<int>()) << "the farther ahead the fainter";
  expect_silence();
}

TEST_F(ReportPlan, EllipsesHaveTheDeviationsOfTheRecord) {
  open({write_record()}, "", kAnimated);
  const auto axes = [&](int i) { return value("report.parts[0].animation.ellipses[" + std::to_string(i) + "].axes"); };
  EXPECT_NEAR(axes(0)[0].get<double>(), 0.5, 1e-12) << "the body's origin: sqrt(xx), and its angle does not count";
  EXPECT_NEAR(axes(0)[1].get<double>(), 0, 1e-12);
  EXPECT_NEAR(axes(1)[0].get<double>(), 0.3, 1e-12) << "1 m away the angle's deviation, sqrt(aa), at right angles to the lever";
  EXPECT_NEAR(value("(report.parts[0].animation.ellipses[1].object.rotation.z + Math.PI) % Math.PI").get<double>(), std::numbers::pi / 2 + 0.1, 1e-9);
  go(1);
  EXPECT_NEAR(axes(0)[0].get<double>(), 0.2, 1e-12);
  EXPECT_NEAR(axes(1)[0].get<double>(), 0.1, 1e-12);
}

TEST_F(ReportPlan, AnEstimateIsDrawnAsItsEllipsesAtTheTimeOfTheClock) {
  open({write_record()}, "#theme=light", kAnimated);
  browser().evaluate("report.showAll()");
  const std::string state = "report.parts[0].estimates[0].state()";
  EXPECT_EQ(value(state)["deviations"], (json{0.5, 0.3}));
  // How much of the whole run's canvas is tinted: the ellipse of two deviations.
  const char* tinted = R"((() => {
    const {canvas} = report.parts[0].estimates[0].views[0], copy = document.createElement("canvas");
    [copy.width, copy.height] = [canvas.width, canvas.height];
    const context = copy.getContext("2d");
    context.drawImage(canvas, 0, 0);
    const pixels = context.getImageData(70, 10, canvas.width - 90, canvas.height - 60).data;
    let count = 0;
    for (let i = 3; i < pixels.length; i += 4) count += pixels[i] > 20 && pixels[i] < 120;
    return count;
  })())";
  const double before = value(tinted).get<double>();
  EXPECT_GT(before, 1000);
  go(1);
  const auto [xx, xa, aa] = std::array{0.04, 0.004, 0.01};
  const double middle = (xx + aa) / 2, radius = std::hypot((xx - aa) / 2, xa);
  EXPECT_NEAR(value(state)["major"].get<double>(), std::sqrt(middle + radius), 1e-12);
  EXPECT_NEAR(value(state)["minor"].get<double>(), std::sqrt(middle - radius), 1e-12);
  // Areas are as sqrt(det covariance).
  const double expected = std::sqrt((xx * aa - xa * xa) / (0.25 * 0.09 - 0.03 * 0.03));
  EXPECT_NEAR(value(tinted).get<double>() / before, expected, 0.25 * expected);
  EXPECT_NE(value("report.parts[0].estimates[0].note.textContent").get<std::string>().find("x 3 ± 0.2 (truth 3.1) m"), std::string::npos);
  expect_silence();
}

TEST_F(ReportPlan, ALensShowsItsPointEnlarged) {
  open({write_record()}, "#theme=light", kAnimated);
  EXPECT_EQ(value("document.querySelectorAll('.stage .lens').length"), 1);
  // The block's upper right corner is in the middle of the lens: below and to the left of it is the block, above is paper.
  const char* quarter = R"(((right, down) => {
    const {animation, clock} = report.parts[0], {canvas, lenses: [{box}]} = animation;
    animation.show(clock.t);
    const copy = document.createElement("canvas");
    [copy.width, copy.height] = [canvas.width, canvas.height];
    const context = copy.getContext("2d");
    context.drawImage(canvas, 0, 0);
    return context.getImageData(box.left + right * box.size, box.top + down * box.size, 1, 1).data[3];
  }))";
  EXPECT_GT(value(call(quarter, 0.25, 0.7)).get<int>(), 100);
  EXPECT_EQ(value(call(quarter, 0.25, 0.25)), 0);
  EXPECT_EQ(value(call(quarter, 0.75, 0.7)), 0);
}

TEST_F(ReportPlan, PlotsHaveRoomForWhatIsAheadAndForTheBand) {
  open({write_record()});
  browser().evaluate("report.showAll()");
  EXPECT_GT(value("report.parts[0].plots.plots[0].plot.scales.y.max").get<double>(), 3) << "plan_y4";
  EXPECT_LT(value("report.parts[0].plots.plots[1].plot.scales.y.min").get<double>(), 3 - 2 * 0.2) << "of the second half";
  EXPECT_EQ(value("document.querySelector('.plots details summary').textContent").get<std::string>().find("More curves ("), 0u);
}

TEST_F(ReportPlan, APegsReportHasItsHorizonAndItsBelief) {
  const Ended run = run_tenon(folder_, "mpc peg-in-hole --seed 3 --report peg.html --quiet");
  ASSERT_EQ(run.code, 0) << run.err;
  browser().open(folder_.path("peg.html") + "#t=0.4", kAnimated);
  const CsvTable record = read_csv(folder_.path("peg.csv"));
  const std::size_t row = 20;  // of 50 Hz
  const json ghosts = value("report.parts[0].animation.ghosts[0].ghosts.map(({group}) => "
                            "[group.position.x, group.position.y, 2 * Math.asin(group.quaternion.z)])");
  ASSERT_EQ(ghosts.size(), 15u);
  for (std::size_t i = 0; i < ghosts.size(); ++i) {
    const std::array<const char*, 3> names{"plan_x", "plan_z", "plan_theta"};
    for (std::size_t axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(ghosts[i][axis].get<double>(), record[names[axis] + std::to_string(i + 1)][row], 1e-9) << names[axis] << i + 1;
  }
  EXPECT_LT(ghosts[14][1].get<double>(), record["z"][row] - 5e-3) << "0.3 s at 25 mm/s";
  const json deviations = value("report.parts[0].estimates[0].state().deviations");
  EXPECT_NEAR(deviations[0].get<double>(), std::sqrt(record["cov_estimate_hole_x_estimate_hole_x"][row]), 1e-12);
  EXPECT_NEAR(deviations[1].get<double>(), std::sqrt(record["cov_estimate_hole_theta_estimate_hole_theta"][row]), 1e-12);
  EXPECT_EQ(value("report.parts[0].animation.ellipses.length"), 2);
  browser().evaluate("report.showAll()");
  expect_silence();
  browser().open(folder_.path("peg.html"), kAnimated, 390);
  browser().evaluate("report.showAll()");
  EXPECT_LE(value("document.documentElement.scrollWidth").get<int>(), 390) << "of a phone";
}

TEST_F(ReportPlan, ASweepWithBaselinesHasAMapALineAndACurveForEach) {
  std::string rows = "seed,hole_x,success,time,soft.success,soft.time\n";
  for (int k = 1; k <= 20; ++k) {
    rows += std::to_string(k) + "," + std::to_string(1e-4 * k) + ",1," + std::to_string(1 + 0.01 * k) +
            (k > 15 ? ",0,5\n" : ",1," + std::to_string(1.5 + 0.01 * k) + "\n");
  }
  open({folder_.write("sweep.csv", rows)});
  browser().evaluate("report.showAll()");
  const json cells = value("[...document.querySelectorAll('tbody tr')].map((line) => [...line.cells].map((cell) => cell.textContent))");
  // Nearest rank, as the program prints it: the 10th and the 19th of 20.
  ASSERT_EQ(cells.size(), 2u);
  EXPECT_EQ(cells[0][0], "mpc");
  EXPECT_EQ(cells[0][3], "1.1 / 1.19");
  EXPECT_EQ(cells[1][1], "15 of 20");
  EXPECT_EQ(cells[1][3], "1.6 / 5");
  EXPECT_EQ(value("document.querySelectorAll('.success-map').length"), 2);
  EXPECT_TRUE(browser().wait_for("report.parts[0].contestants[1].canvas.places"));
  // The pointer beside the last dot of the second map.
  const char* point = R"((() => {
    const {canvas, note} = report.parts[0].contestants[1], [x, y] = canvas.places[19], box = canvas.getBoundingClientRect();
    canvas.dispatchEvent(new PointerEvent("pointermove", {clientX: box.left + x + 1, clientY: box.top + y, bubbles: true}));
    return note.textContent;
  })())";
  EXPECT_EQ(value(point), "--seed 20: failed");
  EXPECT_EQ(value("[...document.querySelectorAll('summary')].map((s) => s.textContent)"), (json{"Failures of mpc (0)", "Failures of soft (5)"}));
  EXPECT_EQ(value("[...document.querySelectorAll('h3')].map((h) => h.textContent)"), (json{"Where", "What came of it", "What was drawn"}));
  expect_silence();
}

}  // namespace
}  // namespace tenon
