// The report page in a real browser: it opens without a complaint or a request, draws, and does what its controls say.
#include <gtest/gtest.h>

#include <set>

#include "tenon/core/csv.hpp"
#include "tenon/tests/report_page.hpp"
#include "tenon/tests/sample_records.hpp"

namespace tenon {
namespace {

/// The picture of part 0 at the time that stands on its slider: {colours, sum}, read in the task that draws it.
constexpr const char* kPicture = R"((() => {
  const {animation, clock} = report.parts[0];
  animation.show(clock.t);
  const copy = document.createElement("canvas"), source = animation.canvas;
  [copy.width, copy.height] = [source.width, source.height];
  const context = copy.getContext("2d");
  context.drawImage(source, 0, 0);
  const pixels = new Uint32Array(context.getImageData(0, 0, copy.width, copy.height).data.buffer);
  let sum = 0;
  pixels.forEach((pixel, i) => (sum = (sum + pixel * (i % 9973 + 1)) % 4294967291));
  return {colors: new Set(pixels).size, sum};
})())";

TEST_F(ReportPage, EverySampleOpensWithoutAComplaintOrARequest) {
  for (const SampleRecord& record : {write_bouncing_ball(folder_), write_cradle(folder_), write_long_flight(folder_)}) {
    open(record, "", kAnimated);
    browser().evaluate("report.showAll()");
    expect_silence();
  }
}

TEST_F(ReportPage, TheAnimationIsDrawnAndMovesWithTheSlider) {
  for (const SampleRecord& record : {write_bouncing_ball(folder_), write_long_flight(folder_)}) {
    open(record, "#t=0.3", kAnimated);
    EXPECT_NEAR(browser().evaluate("report.parts[0].clock.t").get<double>(), 0.3, 1e-12);
    const nlohmann::json first = browser().evaluate(kPicture);
    EXPECT_GE(first["colors"].get<int>(), 50) << record.front();
    EXPECT_EQ(browser().evaluate(kPicture)["sum"], first["sum"]) << "the same time is the same picture";
    browser().evaluate("(() => { const slider = document.querySelector('input[type=range]'); slider.value = 1; slider.dispatchEvent(new Event('input')); })()");
    EXPECT_NEAR(browser().evaluate("report.parts[0].clock.t").get<double>(), 1, 1e-12);
    EXPECT_NE(browser().evaluate(kPicture)["sum"], first["sum"]) << record.front();
  }
}

TEST_F(ReportPage, EveryColumnThatVariesIsASeriesOfOnePlot) {
  open(write_long_flight(folder_));
  browser().evaluate("report.showAll()");
  const nlohmann::json plots = browser().evaluate("report.parts[0].plots.plots.map(({plot}) => plot.series.slice(1).map((s) => s.label))");
  std::multiset<std::string> drawn;
  for (const auto& plot : plots) {
    for (const auto& label : plot) drawn.insert(label.get<std::string>());
  }
  std::multiset<std::string> expected{"x1", "y1", "z1", "qw1", "qz1", "u1", "u2", "spike"};  // qx1, qy1 are constant
  for (int i = 1; i <= 10; ++i) expected.insert("noise" + std::to_string(i));
  EXPECT_EQ(drawn, expected);
}

TEST_F(ReportPage, AZoomAndTheLineOfTheClockAreThoseOfAllPlots) {
  open(write_bouncing_ball(folder_), "#t=1.5");
  browser().evaluate("report.showAll()");
  browser().evaluate("report.parts[0].plots.plots[1].plot.setScale('x', {min: 1, max: 2})");
  EXPECT_TRUE(browser().wait_for("report.parts[0].plots.plots.every(({plot}) => plot.scales.x.min === 1 && plot.scales.x.max === 2)"));
  EXPECT_TRUE(browser().wait_for("report.parts[0].plots.plots.every(({head}) => head.style.left === '50%')"));
  browser().evaluate("report.parts[0].plots.zoomOut()");
  EXPECT_TRUE(browser().wait_for("report.parts[0].plots.plots.every(({plot}) => plot.scales.x.min === 0 && plot.scales.x.max > 5.9)"));
}

TEST_F(ReportPage, KeysPlayPauseAndGoToEvents) {
  open(write_bouncing_ball(folder_));
  const auto press = [&](const std::string& key) {
    browser().evaluate("document.body.dispatchEvent(new KeyboardEvent('keydown', {key: '" + key + "', bubbles: true}))");
  };
  press("n");
  EXPECT_NEAR(browser().evaluate("report.parts[0].clock.t").get<double>(), std::sqrt(2 / 9.81), 1e-12);
  press("End");
  press("p");
  EXPECT_NEAR(browser().evaluate("report.parts[0].clock.t").get<double>(), 4.0637, 5e-3);
  press("Home");
  press("s");  // without slow motion, so that it gets somewhere
  press(" ");
  EXPECT_TRUE(browser().wait_for("report.parts[0].clock.t > 0.1"));
  press(" ");
  EXPECT_EQ(browser().evaluate("report.parts[0].clock.playing"), false);
}

TEST_F(ReportPage, ASceneCannotRunScriptByItsName) {
  const std::string evil = "</script><script>window.hacked = 1</script><img src=x onerror='window.hacked = 1'><!--\\\"";
  const SampleRecord record = write_bouncing_ball(folder_, evil);
  folder_.write("more.csv", "t,<img src=x onerror=window.hacked=1>\n0,1\n1,2\n");
  open({record[0], record[1], folder_.path("more.csv")}, "", kAnimated);
  browser().evaluate("report.showAll()");
  browser().evaluate("document.querySelectorAll('details').forEach((d) => (d.open = true))");
  EXPECT_TRUE(browser().wait_for("document.querySelectorAll('td').length > 0"));
  EXPECT_EQ(browser().evaluate("typeof window.hacked"), "undefined");
  EXPECT_EQ(browser().evaluate("document.querySelector('h2').textContent"), evil);
  EXPECT_EQ(browser().evaluate("document.querySelectorAll('main img, main script').length"), 0);
  expect_silence();
}

TEST_F(ReportPage, EveryControlHasANameAndNothingStandsOutOfAPhone) {
  const SampleRecord record = write_bouncing_ball(folder_);
  folder_.write("sweep.csv", "seed,success,offset,force\n1,1,0.1,3\n2,0,0.4,9\n3,1,0.2,4\n");
  folder_.write("map.csv", "nx,ny,nz,force\n1,0,0,3\n0,1,0,4\n0,0,1,5\n-1,0,0,6\n0,-1,0,7\n0,0,-1,8\n");
  folder_.write("compare.csv", "problem,solver,status,objective,residual,iterations,time_s\na,s,solved,1,0,3,.1\na,r,solved,1,0,4,.2\nb,s,solved,2,0,3,.3\n");
  folder_.write("trace.jsonl", "{\"index\":0,\"objective\":2,\"primal\":1,\"dual\":1,\"complementarity\":0,\"mu\":0.1,\"alpha_primal\":1,"
                               "\"alpha_dual\":1,\"regularization\":0,\"trials\":1}\n");
  open({record[0], record[1], record[2], folder_.path("sweep.csv"), folder_.path("map.csv"), folder_.path("compare.csv"), folder_.path("trace.jsonl")},
       "", kReady, 390);
  browser().evaluate("report.showAll()");
  EXPECT_EQ(browser().evaluate("report.parts.length"), 5);
  EXPECT_LE(browser().evaluate("document.documentElement.scrollWidth").get<int>(), 390);
  EXPECT_EQ(browser().evaluate("[...document.querySelectorAll('button, select, input')].filter((e) => !(e.getAttribute('aria-label') || "
                               "e.textContent.trim() || e.closest('label'))).length"), 0);
  EXPECT_EQ(browser().evaluate("[...document.querySelectorAll('canvas[role=img]')].filter((e) => !e.getAttribute('aria-label')).length"), 0);
  expect_silence();
}

TEST_F(ReportPage, AMapOverDirectionsIsChosenByQuantityAndFailure) {
  std::string rows;
  for (const char* row : {"1,0,0,0.9,10,0.7,", "-1,0,0,0.8,11,,", "0,1,0,1,12,0.75,", "0,-1,0,1,13,0.8,", "0,0,1,1,14,0.9,8", "0,0,-1,1,15,0.95,9"}) rows += row + std::string("\n");
  open({folder_.write("envelope.csv", "nx,ny,nz,X1,force,X1_failed2,force_failed2\n" + rows)});
  browser().evaluate("report.showAll()");
  const auto choose = [&](const std::string& label, const std::string& value) {
    browser().evaluate("(() => { const s = document.querySelector('select[aria-label=" + label + "]'); s.value = '" + value +
                       "'; s.dispatchEvent(new Event('change')); })()");
  };
  const auto shown = [&](const std::string& what) { return browser().evaluate("report.parts[0]." + what); };
  EXPECT_EQ(shown("values[0]"), 0.9);
  EXPECT_EQ(shown("least"), 0.7) << "all cases of a quantity share a scale";
  EXPECT_EQ(shown("none.hidden"), true);
  choose("Failure", "2");
  EXPECT_EQ(shown("values[2]"), 0.75);
  EXPECT_EQ(shown("none.hidden"), false) << "the vehicle cannot hover along -x";
  choose("Quantity", "force");
  EXPECT_EQ(shown("values[5]"), 9);
  EXPECT_EQ(shown("most"), 15);
  EXPECT_EQ(browser().evaluate("document.querySelectorAll('select[aria-label=Quantity] option').length"), 2);
  // The middle of the map looks along +x, where the force is 10 on a scale from 8 to 15.
  choose("Failure", "0");
  const nlohmann::json middle = browser().evaluate(
      "(() => { const c = report.parts[0].map; return [...c.getContext('2d').getImageData(c.width / 2 + 12, c.height / 2 + 12, 1, 1).data]; })()");
  EXPECT_EQ(middle, (nlohmann::json{42, 101, 141, 255}));
  expect_silence();
}

TEST_F(ReportPage, LightTurnsToDark) {
  open(write_bouncing_ball(folder_), "#theme=light");
  const nlohmann::json light = browser().evaluate("getComputedStyle(document.body).backgroundColor");
  browser().evaluate("document.getElementById('theme').click()");
  EXPECT_NE(browser().evaluate("getComputedStyle(document.body).backgroundColor"), light);
}

TEST_F(ReportPage, TheDataComeOutAsTheyWentIn) {
  const SampleRecord record = write_bouncing_ball(folder_);
  open(record);
  const CsvTable before = read_csv(record[0]), after = parse_csv(browser().evaluate("report.parts[0].table.csv()").get<std::string>(), "page");
  EXPECT_EQ(after.names, before.names);
  EXPECT_EQ(after.columns, before.columns);  // a short record, in double precision
}

TEST_F(ReportPage, ASpikeOneRowWideIsThere) {
  open(write_long_flight(folder_));
  EXPECT_LT(browser().evaluate("report.parts[0].table.kept").get<int>(), 60'000);
  EXPECT_EQ(browser().evaluate("Math.max(...report.parts[0].table.numbers('spike'))"), 7);
}

}  // namespace
}  // namespace tenon
