#include "tenon/mpc/mode_margins.hpp"

#include <cmath>
#include <complex>
#include <functional>
#include <limits>
#include <stdexcept>

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <unsupported/Eigen/MatrixFunctions>

namespace tenon {

namespace {

using Complex = std::complex<double>;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;

constexpr double kPi = 3.14159265358979323846;
constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr int kFrequencies = 2000;         // on a logarithmic scale, from kLowest Hz to half the sampling rate
constexpr double kLowest = 0.01;           // Hz
constexpr double kMostDelay = 100;         // periods
constexpr double kMostStiffness = 1e6;     // factor

void check(const LinearMode& mode) {
  const Eigen::Index n = mode.mass.rows();
  for (const MatrixXd* m : {&mode.mass, &mode.stiffness, &mode.damping, &mode.contact_stiffness, &mode.contact_damping}) {
    if (m->rows() != n || m->cols() != n || n == 0) {
      throw std::invalid_argument("mode " + mode.name + ": a matrix of " + std::to_string(m->rows()) + " x " + std::to_string(m->cols()) +
                                  " (expected all of the size of the mass)");
    }
  }
  if (!(mode.period > 0) || mode.delay < 0) throw std::invalid_argument("mode " + mode.name + ": no period, or a negative delay");
}

/// In coordinates in which the mass is 1.
LinearMode normalised(LinearMode mode) {
  const MatrixXd root = Eigen::SelfAdjointEigenSolver<MatrixXd>(mode.mass).operatorInverseSqrt();
  for (MatrixXd* m : {&mode.mass, &mode.stiffness, &mode.damping, &mode.contact_stiffness, &mode.contact_damping}) *m = root * *m * root;
  return mode;
}

/// exp of [A B; 0 0] t: the flow of x' = A x + B u with u held.
struct Held {
  MatrixXd a, b;
};
Held held(const MatrixXd& a, const MatrixXd& b, double t) {
  const Eigen::Index n = a.rows(), m = b.cols();
  MatrixXd both = MatrixXd::Zero(n + m, n + m);
  both.topLeftCorner(n, n) = a * t;
  both.topRightCorner(n, m) = b * t;
  const MatrixXd flow = both.exp();
  return {flow.topLeftCorner(n, n), flow.topRightCorner(n, m)};
}

/// (3): the spectral radius of the sampled loop.
bool is_stable(const LinearMode& mode, double delay, double stiffness_factor) {
  const Eigen::Index n = mode.mass.rows();
  const MatrixXd inverse = mode.mass.inverse();
  MatrixXd a = MatrixXd::Zero(2 * n, 2 * n), b = MatrixXd::Zero(2 * n, n), gain(n, 2 * n);
  a.topRightCorner(n, n).setIdentity();
  a.bottomLeftCorner(n, n) = -stiffness_factor * (inverse * mode.contact_stiffness);
  a.bottomRightCorner(n, n) = -std::sqrt(stiffness_factor) * (inverse * mode.contact_damping);
  b.bottomRows(n) = inverse;
  gain << -mode.stiffness, -mode.damping;

  const int d = static_cast<int>(std::floor(delay / mode.period + 1e-9));
  const double part = std::max(0.0, delay - d * mode.period);
  const Held late = held(a, b, part), rest = held(a, b, mode.period - part);
  const MatrixXd older = rest.a * late.b;  // B_1: of the input that still acts in the first part of the period

  // (x, u_{k-1}, ..., u_{k-d-1})
  const Eigen::Index size = 2 * n + (d + 1) * n;
  MatrixXd loop = MatrixXd::Zero(size, size);
  loop.topLeftCorner(2 * n, 2 * n) = rest.a * late.a;
  if (d == 0)
    loop.topLeftCorner(2 * n, 2 * n) += rest.b * gain;
  else
    loop.block(0, 2 * n + (d - 1) * n, 2 * n, n) += rest.b;
  loop.block(0, 2 * n + d * n, 2 * n, n) += older;
  loop.block(2 * n, 0, n, 2 * n) = gain;
  for (int i = 0; i < d; ++i) loop.block(2 * n + (i + 1) * n, 2 * n + i * n, n, n).setIdentity();
  return loop.eigenvalues().cwiseAbs().maxCoeff() < 1;
}

/// The largest value up to `most` at which it holds; infinite where it holds there. It holds at `from`; looked for by factors of 2, then by
/// bisection, so that the first end of stability counts and not a later one.
double largest(const std::function<bool(double)>& holds, double from, double first_step, double most) {
  double below = from, above = from + first_step;
  for (; holds(above); below = above, above = from + 1.25 * (above - from)) {
    if (above >= most) return kInfinite;
  }
  for (int i = 0; i < 40; ++i) {
    const double middle = (below + above) / 2;
    (holds(middle) ? below : above) = middle;
  }
  return below;
}

}  // namespace

ModeMargins mode_margins(const LinearMode& given) {
  check(given);
  const LinearMode mode = normalised(given);
  ModeMargins margins;
  margins.stable = is_stable(mode, mode.delay, 1);
  margins.modulus = kInfinite;
  const double highest = 0.5 / mode.period, late = mode.delay + mode.period / 2;
  margins.passive_below = highest;
  const auto identity = MatrixXcd::Identity(mode.mass.rows(), mode.mass.rows());
  bool passive = true;
  for (int k = 0; k <= kFrequencies; ++k) {
    const double frequency = kLowest * std::pow(highest / kLowest, static_cast<double>(k) / kFrequencies);
    const Complex s(0, 2 * kPi * frequency), turn = std::exp(-s * late);
    const MatrixXcd plant = s * s * mode.mass + s * mode.contact_damping + mode.contact_stiffness.cast<Complex>();
    const MatrixXcd law = turn * (mode.stiffness.cast<Complex>() + s * mode.damping);

    const MatrixXcd loop = law * plant.inverse();
    const double least = (identity + loop).jacobiSvd().singularValues().minCoeff();
    if (least < margins.modulus) margins.modulus = least, margins.modulus_frequency = frequency;

    const MatrixXcd admittance = s * (plant + law).inverse();
    const Eigen::SelfAdjointEigenSolver<MatrixXcd> real_part(admittance + admittance.adjoint(), Eigen::EigenvaluesOnly);
    const double scale = admittance.norm();
    if (passive && real_part.eigenvalues().minCoeff() < -1e-9 * scale) passive = false, margins.passive_below = frequency;
  }
  if (!margins.stable) return margins;
  margins.delay = largest([&](double delay) { return is_stable(mode, delay, 1); }, mode.delay, 0.01 * mode.period, kMostDelay * mode.period) - mode.delay;
  margins.contact_stiffness = mode.contact_stiffness.isZero(0)
                                  ? kInfinite
                                  : largest([&](double factor) { return is_stable(mode, mode.delay, factor); }, 1, 0.01, kMostStiffness);
  return margins;
}

}  // namespace tenon
