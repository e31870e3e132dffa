// A problem of one's own: objective and rows written once, derivatives exact.
#include <cstdio>

#include <tenon/core/automatic.hpp>
#include <tenon/solvers/newton_kkt/newton_kkt.hpp>

/// The box of largest volume whose surface is at most 6 m^2, its height at most half its width.
struct Box {
  static constexpr int kVariables = 3, kConstraints = 2;  // width, depth, height; surface, height - width/2

  template <class T>
  T objective(const std::array<T, 3>& x) const {
    return -x[0] * x[1] * x[2];
  }

  template <class T>
  void constraints(const std::array<T, 3>& x, std::array<T, 2>& c) const {
    c[0] = 2 * (x[0] * x[1] + x[1] * x[2] + x[2] * x[0]);
    c[1] = x[2] - x[0] / 2;
  }

  void bounds(tenon::BasicBounds<double, 3, 2>& bounds) const {
    bounds.x_lower.setZero();
    bounds.c_upper << 6, 0;
  }

  void initial_point(Eigen::Vector3d& x) const { x.setConstant(0.5); }
};

int main() {
  using Problem = tenon::Automatic<Box>;
  const Problem problem;
  tenon::NewtonKkt<Problem> solver(problem);
  tenon::PointOf<Problem> point;
  problem.initial_point(point.x);
  const tenon::Result result = solver.solve(point);
  std::printf("%s: %.4f x %.4f x %.4f m, %.4f m^3; one m^2 more would add %.4f m^3\n", to_string(result.status).data(), point.x[0], point.x[1],
              point.x[2], -result.objective, point.lambda[0]);
  return succeeded(result.status) ? 0 : 1;
}
