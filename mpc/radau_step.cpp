#include "tenon/mpc/radau_step.hpp"

#include <algorithm>
#include <cmath>

#include "tenon/mpc/pattern_entries.hpp"

namespace tenon {

namespace {
constexpr int kMostIterations = 30;
constexpr double kConverged = 1e-13;  // of a Newton step, relative: what is left after it is its square
}  // namespace

RadauStep::RadauStep(const Dae& dae, int points)
    : dae_(dae), method_(radau(points)), workspace_(dae.make_workspace()), pattern_(dae.jacobian_pattern()) {
  const int nx = dae.num_states(), ny = dae.num_algebraics(), size = points * (nx + ny);
  x.setZero(nx, points + 1);
  y.setZero(ny, points);
  without_alpha_.resize(static_cast<std::size_t>(pattern_.nonzeros()));
  with_alpha_.resize(without_alpha_.size());
  matrix_.setZero(size, size);
  residual_.setZero(size);
}

// Block (i, j) of the matrix, of (X_j, Y_j):  D_ij/h [F_xdot 0] + delta_ij [F_x F_y]
void RadauStep::evaluate(const DaeMode& mode, double t, double h, ConstVectorRef u) {
  const int nx = dae_.num_states(), n = nx + dae_.num_algebraics(), s = method_.points;
  matrix_.setZero();
  for (int i = 1; i <= s; ++i) {
    const Vector xdot = x * method_.d.row(i - 1).transpose() / h;
    const DaePoint at(t + method_.abscissae[i] * h, xdot, x.col(i), y.col(i - 1), u);
    dae_.residual(mode, at, workspace_, residual_.segment((i - 1) * n, n));
    dae_.jacobian(mode, at, 0, workspace_, without_alpha_);
    dae_.jacobian(mode, at, 1 / h, workspace_, with_alpha_);
    for_each_entry(pattern_, [&](int r, int c, std::size_t e) {
      const int row = (i - 1) * n + r;
      matrix_(row, (i - 1) * n + c) += without_alpha_[e];
      if (c >= nx) return;
      const double rate = with_alpha_[e] - without_alpha_[e];
      for (int j = 1; j <= s; ++j) matrix_(row, (j - 1) * n + c) += method_.d(i - 1, j) * rate;
    });
  }
}

bool RadauStep::advance(const DaeMode& mode, double t, double h, ConstVectorRef u) {
  const int nx = dae_.num_states(), n = nx + dae_.num_algebraics();
  double last = 0;
  for (int iteration = 0; iteration < kMostIterations; ++iteration) {
    evaluate(mode, t, h, u);
    const Vector step = matrix_.partialPivLu().solve(residual_);
    double size = 0;
    for (int i = 1; i <= method_.points; ++i) {
      x.col(i) -= step.segment((i - 1) * n, nx);
      y.col(i - 1) -= step.segment((i - 1) * n + nx, n - nx);
      for (int r = 0; r < n; ++r) {
        const double value = r < nx ? x(r, i) : y(r - nx, i - 1);
        size = std::max(size, std::abs(step[(i - 1) * n + r]) / (1 + std::abs(value)));
      }
    }
    if (!std::isfinite(size)) return false;
    if (size <= kConverged || (iteration > 2 && size <= 1e-9 && size >= last)) return true;  // or down to its rounding
    last = size;
  }
  return false;
}

}  // namespace tenon
