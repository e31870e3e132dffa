// A user's own problem, solved and measured by the installed library:
//
//     min sum_i x_i    subject to    sum_i x_i^2 <= n        with the solution x_i = -1, lambda = 1/2
//
// Returns 0 where the ruler finds the solution good and another point bad, and the solver finds it too.
#include <cmath>
#include <cstdio>

#include <tenon/core/kkt_residual.hpp>
#include <tenon/solvers/newton_kkt/make_newton_kkt.hpp>

#ifdef __AVX__
#error "the library is built for newer processors than its user: this one is to be compiled without -march"
#endif

constexpr int n = 9;

class Ball final : public tenon::Nlp {
 public:
  int num_variables() const override { return n; }
  int num_constraints() const override { return 1; }
  tenon::SparsePattern jacobian_pattern() const override { return tenon::SparsePattern::full(1, n); }
  tenon::SparsePattern hessian_pattern() const override { return tenon::SparsePattern::full_lower(n); }
  void bounds(tenon::Bounds& bounds) const override { bounds.c_upper[0] = n; }

  double objective(tenon::ConstVectorRef x, Workspace&) const override { return x.sum(); }
  void gradient(tenon::ConstVectorRef, Workspace&, tenon::VectorRef gradient) const override { gradient.setOnes(); }
  void constraints(tenon::ConstVectorRef x, Workspace&, tenon::VectorRef values) const override { values[0] = x.squaredNorm(); }
  void jacobian(tenon::ConstVectorRef x, Workspace&, std::span<double> values) const override {
    for (int j = 0; j < n; ++j) values[j] = 2 * x[j];
  }
  void hessian(tenon::ConstVectorRef, double, tenon::ConstVectorRef lambda, Workspace&, std::span<double> values) const override {
    std::size_t k = 0;
    for (int j = 0; j < n; ++j) {
      for (int i = j; i < n; ++i) values[k++] = i == j ? 2 * lambda[0] : 0;
    }
  }
};

int main() {
  const Ball ball;
  tenon::Point point(n, 1);
  const double away = tenon::kkt_residual(ball, point).max();
  point.x.setConstant(-1);
  point.lambda[0] = 0.5;
  const double solved = tenon::kkt_residual(ball, point).max();
  std::printf("residual %g at the solution, %g at 0\n", solved, away);

  tenon::Point found(n, 1);
  const tenon::Result result = tenon::make_newton_kkt(ball, {})->solve(found);
  std::printf("newton-kkt: %s after %d iterations, x[0] = %.9f\n", tenon::to_string(result.status).data(), result.iterations, found.x[0]);
  return solved == 0 && away == 1 && result.status == tenon::Status::solved && std::abs(found.x[0] + 1) < 1e-6 ? 0 : 1;
}
