#include "tenon/problems/envelope/ray_program.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "tenon/problems/allocation/throttle_map.hpp"

namespace tenon {

namespace {

/// What one rotor contributes at (u, a), each as [ m d ; m (r x d) + s t d ].
struct Contribution {
  Contribution(const Rotor& rotor, double u, double a) : rotor_(rotor), u_(u) {
    const double along = rotor.axis.dot(rotor.zero);
    const Eigen::Vector3d fixed = along * rotor.axis;
    n = fixed + std::cos(a) * (rotor.zero - fixed) + std::sin(a) * rotor.axis.cross(rotor.zero);
    n_a = rotor.axis.cross(n);
    n_aa = rotor.axis.cross(n_a);
  }

  Wrench value(const Eigen::Vector3d& d) const { return along(d, throttle_map(rotor_.thrust, u_), throttle_map(rotor_.torque, u_)); }
  Wrench slope(const Eigen::Vector3d& d) const {
    return along(d, throttle_map_slope(rotor_.thrust, u_), throttle_map_slope(rotor_.torque, u_));
  }
  Wrench curvature(const Eigen::Vector3d& d) const { return along(d, curvature(rotor_.thrust), curvature(rotor_.torque)); }

  Eigen::Vector3d n, n_a, n_aa;

 private:
  Wrench along(const Eigen::Vector3d& d, double m, double t) const {
    Wrench w;
    w << m * d, m * rotor_.position.cross(d) + rotor_.spin * t * d;
    return w;
  }
  double curvature(const std::vector<double>& coefficients) const {
    double sum = 0;
    for (std::size_t k = coefficients.size(); k-- > 2;) sum = sum * u_ + static_cast<double>(k * (k - 1)) * coefficients[k];
    return sum;
  }

  const Rotor& rotor_;
  double u_;
};

}  // namespace

void RayProgram::set_ray(const Wrench& from, const Wrench& direction) {
  from_ = from;
  direction_ = direction;
}

SparsePattern RayProgram::hessian_pattern() const {
  std::vector<std::pair<int, int>> entries;
  for (int i = 0, n = num_rotors(); i < n; ++i) entries.insert(entries.end(), {{i, i}, {n + i, i}, {n + i, n + i}});
  return SparsePattern::from_entries(num_variables(), num_variables(), entries);
}

void RayProgram::bounds(Bounds& bounds) const {
  const int n = num_rotors();
  for (int i = 0; i < n; ++i) {
    const Rotor& rotor = rotors_[static_cast<std::size_t>(i)];
    bounds.x_lower[i] = rotor.throttle_lower;
    bounds.x_upper[i] = rotor.throttle_upper;
    bounds.x_lower[n + i] = rotor.tilt ? rotor.angle_lower : 0;
    bounds.x_upper[n + i] = rotor.tilt ? rotor.angle_upper : 0;
  }
  if (is_effort_) bounds.x_lower[2 * n] = bounds.x_upper[2 * n] = 0;
  bounds.c_lower = bounds.c_upper = from_;
}

double RayProgram::objective(ConstVectorRef x, Workspace&) const {
  return is_effort_ ? x.head(num_rotors()).squaredNorm() : -x[2 * num_rotors()];
}

void RayProgram::gradient(ConstVectorRef x, Workspace&, VectorRef gradient) const {
  gradient.setZero();
  if (is_effort_)
    gradient.head(num_rotors()) = 2 * x.head(num_rotors());
  else
    gradient[2 * num_rotors()] = -1;
}

void RayProgram::constraints(ConstVectorRef x, Workspace&, VectorRef values) const {
  const int n = num_rotors();
  values = -x[2 * n] * direction_;
  for (int i = 0; i < n; ++i) {
    const Contribution at(rotors_[static_cast<std::size_t>(i)], x[i], x[n + i]);
    values += at.value(at.n);
  }
}

void RayProgram::jacobian(ConstVectorRef x, Workspace&, std::span<double> values) const {
  const int n = num_rotors();
  Eigen::Map<Eigen::Matrix<double, 6, Dynamic>> J(values.data(), 6, num_variables());
  for (int i = 0; i < n; ++i) {
    const Contribution at(rotors_[static_cast<std::size_t>(i)], x[i], x[n + i]);
    J.col(i) = at.slope(at.n);
    J.col(n + i) = at.value(at.n_a);
  }
  J.col(2 * n) = -direction_;
}

void RayProgram::hessian(ConstVectorRef x, double sigma, ConstVectorRef lambda, Workspace&, std::span<double> values) const {
  const int n = num_rotors();
  for (int i = 0; i < n; ++i) {  // the pattern's order: column u_i holds (u, u) and (a, u), column a_i holds (a, a)
    const Contribution at(rotors_[static_cast<std::size_t>(i)], x[i], x[n + i]);
    const auto k = static_cast<std::size_t>(i);
    values[2 * k] = (is_effort_ ? 2 * sigma : 0) + lambda.dot(at.curvature(at.n));
    values[2 * k + 1] = lambda.dot(at.slope(at.n_a));
    values[2 * static_cast<std::size_t>(n) + k] = lambda.dot(at.value(at.n_aa));
  }
}

}  // namespace tenon
