#include "tenon/tests/sample_records.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tenon/core/csv.hpp"
#include "tenon/core/scenery.hpp"

namespace tenon {

namespace {

constexpr double kGravity = 9.81;

void write_row(CsvWriter& csv, const std::vector<double>& values) {
  for (const double v : values) csv << v;
  csv.end_row();
}

struct Flight {
  double begin, speed;  // the ball leaves the ground; its first flight begins at half time
};

/// The flights of a ball of height 1 with restitution e, until the next would last less than 1 ms.
std::vector<Flight> flights(double restitution) {
  const double fall = std::sqrt(2 / kGravity);
  std::vector<Flight> list{{-fall, kGravity * fall}};
  while (2 * list.back().speed / kGravity > 1e-3) {
    list.push_back({list.back().begin + 2 * list.back().speed / kGravity, restitution * list.back().speed});
  }
  return list;
}

/// h(tau) = -(v/w_d) exp(-zeta w tau) sin(w_d tau), of a linear law with restitution e and contact time t_c.
void write_fast_phase(CsvWriter& csv, double t, double speed, double restitution, double contact_time) {
  // e = exp(-2 zeta acos(zeta)/sqrt(1-zeta^2)), by bisection; t_c = 2 acos(zeta)/(w sqrt(1-zeta^2))
  double low = 0, high = 0.999;
  for (int k = 0; k < 60; ++k) {
    const double zeta = (low + high) / 2;
    (std::exp(-2 * zeta * std::acos(zeta) / std::sqrt(1 - zeta * zeta)) > restitution ? low : high) = zeta;
  }
  const double zeta = low, root = std::sqrt(1 - zeta * zeta), w = 2 * std::acos(zeta) / (contact_time * root), damped = w * root;
  for (int k = 0; k <= 60; ++k) {
    const double tau = contact_time * k / 60, decay = std::exp(-zeta * w * tau), s = std::sin(damped * tau), c = std::cos(damped * tau);
    const double h = -speed / damped * decay * s, rate = -speed * decay * (c - zeta / root * s);
    csv << t << "floor";
    write_row(csv, {tau, h, rate, -w * w * h - 2 * zeta * w * rate});
  }
}

}  // namespace

SampleRecord write_bouncing_ball(const ScratchFolder& folder, const std::string& title) {
  constexpr double kRestitution = 0.8, kRadius = 0.06, kEnd = 6, kStep = 1.0 / 240;
  const SampleRecord files{folder.path("ball.csv"), folder.path("ball_events.csv"), folder.path("ball_fast.csv")};
  CsvWriter csv(files[0], {"t", "x1", "vx1", "lambda_floor", "gap_floor", "mode_floor", "energy"});
  CsvWriter events(files[1], {"t", "contact", "from", "to", "gap", "gap_rate_before", "gap_rate_after", "impulse", "energy_before", "energy_after"});
  CsvWriter fast(files[2], {"t", "contact", "tau", "gap", "gap_rate", "gap_acceleration"});

  const std::vector<Flight> all = flights(kRestitution);
  int number = 0;
  double next = 0;
  for (std::size_t k = 0; k + 1 < all.size(); ++k) {
    const auto row = [&](double t) {
      const double tau = t - all[k].begin, h = all[k].speed * tau - kGravity * tau * tau / 2, v = all[k].speed - kGravity * tau;
      write_row(csv, {t, h, v, 0, h, 0, kGravity * h + v * v / 2});
    };
    const double impact = all[k + 1].begin, before = all[k].speed, after = all[k + 1].speed;
    for (; next < impact; next += kStep) row(next);
    row(impact);
    const bool rests = k + 2 == all.size();
    for (const auto& [from, to] : {std::pair{0, 1}, std::pair{1, rests ? 2 : 0}}) {
      events << impact << "floor" << from << to;
      write_row(events, {0, -before, from == 0 ? -before : (rests ? 0 : after), from == 0 ? 0 : before + (rests ? 0 : after), before * before / 2,
                         from == 0 ? before * before / 2 : (rests ? 0 : after * after / 2)});
    }
    ++number;
    if (number <= 3) write_fast_phase(fast, impact, before, kRestitution, 0.01);
  }
  write_row(csv, {all.back().begin, 0, 0, kGravity, 0, 2, 0});
  for (; next <= kEnd; next += kStep) write_row(csv, {next, 0, 0, kGravity, 0, 2, 0});
  csv.finish();
  events.finish();
  fast.finish();

  Scenery scenery;
  scenery.title = title;
  scenery.bodies = {{.name = "floor", .shapes = {SceneryShape::half_space({0, 1, 0})}},
                    {.name = "ball", .position = {0, "x1"}, .shapes = {SceneryShape::disc(kRadius).at({0, kRadius, 0})}}};
  scenery.arrows = {{.name = "floor's force", .at = {.body = "ball"}, .vector = {0, "lambda_floor"}}};
  write_scenery(scenery, files[0]);
  return files;
}

SampleRecord write_cradle(const ScratchFolder& folder) {
  constexpr int kBalls = 5;
  constexpr double kLength = 1, kRadius = 0.05, kAngle = 0.4;
  const double w = std::sqrt(kGravity / kLength), half = std::numbers::pi / w;
  const SampleRecord files{folder.path("cradle.csv"), folder.path("cradle_events.csv")};
  CsvWriter csv(files[0], {"t", "theta1", "theta2", "theta3", "theta4", "theta5", "mode_12", "energy"});
  CsvWriter events(files[1], {"t", "contact", "from", "to", "gap", "gap_rate_before", "gap_rate_after"});
  for (int k = 0; k <= 2400; ++k) {
    // The first ball swings while cos < 0 would bring it through the others; then the last one does.
    const double t = k / 240.0, swing = kAngle * std::cos(w * t);
    write_row(csv, {t, std::min(0.0, -swing), 0, 0, 0, std::max(0.0, -swing), 0, kGravity * (1 - std::cos(kAngle))});
  }
  for (int k = 0; (k + 0.5) * half < 10; ++k) {
    events << (k + 0.5) * half << (k % 2 == 0 ? "balls_1_2" : "balls_4_5") << 0 << 1;
    write_row(events, {0, -kAngle * w, 0});
  }
  csv.finish();
  events.finish();

  Scenery scenery;
  scenery.title = "Newton's cradle";
  scenery.bodies.push_back({.name = "beam", .shapes = {SceneryShape::box({kBalls * 2.6 * kRadius, 0.03, 0}).colored("frame")}});
  for (int i = 1; i <= kBalls; ++i) {
    const std::string n = std::to_string(i);
    const double x = (i - (kBalls + 1) / 2.0) * 2 * kRadius;
    scenery.bodies.push_back({.name = "ball " + n,
                              .position = {x, 0},
                              .angle = SceneryValue("theta" + n),
                              .shapes = {SceneryShape::line({{0, 0, 0}, {0, -kLength, 0}}).colored("link"),
                                         SceneryShape::disc(kRadius).at({0, -kLength, 0})}});
  }
  write_scenery(scenery, files[0]);
  return files;
}

SampleRecord write_long_flight(const ScratchFolder& folder) {
  constexpr int kRows = 60'000;
  const SampleRecord files{folder.path("flight.csv")};
  std::vector<std::string> names{"t", "x1", "y1", "z1", "qw1", "qx1", "qy1", "qz1", "u1", "u2", "spike"};
  for (int i = 1; i <= 10; ++i) names.push_back("noise" + std::to_string(i));
  CsvWriter csv(files[0], names);
  for (int k = 0; k < kRows; ++k) {
    const double t = 60.0 * k / (kRows - 1), turn = 0.4 * t;
    std::vector<double> row{t, std::cos(turn), std::sin(turn), 0.8 + 0.2 * std::sin(2 * turn), std::cos(turn / 2), 0, 0, std::sin(turn / 2),
                            2 + std::sin(t), 2 + std::cos(t), k == 31'415 ? 7.0 : 0.0};
    for (int i = 1; i <= 10; ++i) row.push_back(std::sin(1e3 * i * t * t));
    write_row(csv, row);
  }
  csv.finish();

  Scenery scenery;
  scenery.title = "long flight";
  scenery.space = Scenery::Space::spatial;
  const SceneryVector position{"x1", "y1", "z1"};
  scenery.bodies = {{.name = "ground", .shapes = {SceneryShape::half_space({0, 0, 1})}},
                    {.name = "box", .position = position, .quaternion = {{"qw1", "qx1", "qy1", "qz1"}}, .shapes = {SceneryShape::box({0.3, 0.2, 0.1})},
                     .trail = true},
                    {.name = "load", .parent = "box", .position = {0, 0, SceneryValue("u1", {-0.2, -0.05})}, .shapes = {SceneryShape::sphere(0.06)}}};
  scenery.links = {{.kind = SceneryLink::Kind::spring, .from = {.body = "box"}, .to = {.body = "load"}}};
  scenery.arrows = {{.name = "lift", .at = {.body = "box"}, .vector = {0, 0, "u1"}}};
  write_scenery(scenery, files[0]);
  return files;
}

}  // namespace tenon
