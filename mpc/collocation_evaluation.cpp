// The functions of one stage and their derivatives: collocation.md, sections 2 and 3.
#include <algorithm>

#include "tenon/mpc/collocation_stage.hpp"
#include "tenon/mpc/pattern_entries.hpp"

namespace tenon {

CollocationStage::At CollocationStage::make_at() const {
  At at;
  at.xdot.setZero(nx_, points());
  for (int i = 0; i < points(); ++i) at.workspaces.push_back(dae_->make_workspace());
  return at;
}

void CollocationStage::reserve(Storage& storage) const {
  Eigen::Index most = num_rows_, most_values = num_rows_;
  for (const StageTerm& term : terms_) {
    most = std::max(most, static_cast<Eigen::Index>(term.arguments.size()));
    most_values = std::max(most_values, static_cast<Eigen::Index>(term.function->num_values()));
  }
  const auto grow = [](Vector& v, Eigen::Index n) { v.resize(std::max(v.size(), n)); };
  grow(storage.z, most), grow(storage.f, most_values), grow(storage.multipliers, most_values);
  storage.jacobian.resize(std::max(storage.jacobian.rows(), most_values), std::max(storage.jacobian.cols(), most));
  storage.hessian.resize(std::max(storage.hessian.rows(), most), std::max(storage.hessian.cols(), most));
  if (points() == 0) return;
  storage.without_alpha.resize(static_cast<std::size_t>(jacobian_pattern_.nonzeros()));
  storage.with_alpha.resize(storage.without_alpha.size());
  storage.of_inputs.resize(static_cast<std::size_t>(input_pattern_.nonzeros()));
  storage.curvature.resize(static_cast<std::size_t>(hessian_pattern_.nonzeros()));
}

// xdot_i = (1/h) sum_j D_ij X_j                                                                                             (1)
void CollocationStage::prepare(At& at) const {
  for (int i = 0; i < points(); ++i) {
    at.xdot.col(i).setZero();
    for (int j = 0; j <= points(); ++j) at.xdot.col(i) += method_.d(i, j) * Eigen::Map<const Vector>(at.v + x_at(j), nx_);
    at.xdot.col(i) /= at.length();
  }
}

DaePoint CollocationStage::point(const At& at, int i) const {
  return {at.t + method_.abscissae[i] * at.length(), at.xdot.col(i - 1), Eigen::Map<const Vector>(at.v + x_at(i), nx_),
          Eigen::Map<const Vector>(at.v + y_at(i), ny_), Eigen::Map<const Vector>(at.v + u_at(), nu_)};
}

void CollocationStage::gather(const StageTerm& term, const At& at, Storage& storage) const {
  for (std::size_t a = 0; a < term.arguments.size(); ++a) storage.z[static_cast<Eigen::Index>(a)] = at.v[term.arguments[a]];
}

// sum_i b_i h L(X_i, Y_i, u) + E(x)                                                                                         (3)
double CollocationStage::objective(const At& at, Storage& storage) const {
  double sum = 0;
  for (const StageTerm& term : terms_) {
    if (term.first_row >= 0) continue;
    gather(term, at, storage);
    term.function->values(storage.z.head(static_cast<Eigen::Index>(term.arguments.size())), storage.f.head(1));
    sum += term.weight * (term.is_integrand ? at.length() : 1) * storage.f[0];
  }
  return sum;
}

void CollocationStage::add_gradient(const At& at, Storage& storage, double* gradient_of_v, double* gradient_of_duration) const {
  for (const StageTerm& term : terms_) {
    if (term.first_row >= 0) continue;
    const auto n = static_cast<Eigen::Index>(term.arguments.size());
    gather(term, at, storage);
    term.function->jacobian(storage.z.head(n), storage.jacobian.topLeftCorner(1, n));
    const double weight = term.weight * (term.is_integrand ? at.length() : 1);
    for (Eigen::Index a = 0; a < n; ++a) gradient_of_v[term.arguments[static_cast<std::size_t>(a)]] += weight * storage.jacobian(0, a);
    if (!term.is_integrand || !has_duration_) continue;
    term.function->values(storage.z.head(n), storage.f.head(1));
    *gradient_of_duration += term.weight * at.fraction * storage.f[0];
  }
}

void CollocationStage::rows(At& at, Storage& storage, VectorRef values) const {
  for (int i = 1; i <= points(); ++i) {
    dae_->residual(mode_, point(at, i), at.workspaces[static_cast<std::size_t>(i - 1)],
                   values.segment((i - 1) * rows_of_point(), rows_of_point()));
  }
  for (const StageTerm& term : terms_) {
    if (term.first_row < 0) continue;
    auto out = values.segment(term.first_row, term.function->num_values());
    gather(term, at, storage);
    term.function->values(storage.z.head(static_cast<Eigen::Index>(term.arguments.size())), out);
    if (term.factors >= 0) out.array() *= Eigen::Map<const Eigen::ArrayXd>(at.v + term.factors, out.size());
    if (term.subtracted >= 0) out -= Eigen::Map<const Vector>(at.v + term.subtracted, out.size());
  }
}

/// J without alpha in storage.without_alpha; dF/dxdot times alpha, at rate_places_, in storage.with_alpha.
void CollocationStage::differentiate_dynamics(At& at, Storage& storage, int i, double alpha) const {
  Dae::Workspace& workspace = at.workspaces[static_cast<std::size_t>(i - 1)];
  dae_->jacobian(mode_, point(at, i), 0, workspace, storage.without_alpha);
  dae_->jacobian(mode_, point(at, i), alpha, workspace, storage.with_alpha);
  for (const int e : rate_places_) storage.with_alpha[static_cast<std::size_t>(e)] -= storage.without_alpha[static_cast<std::size_t>(e)];
}

// dF_i/dX_j = D_ij/h F_xdot + delta_ij F_x,    dF_i/dT = -F_xdot xdot_i/T                                                   (4)
void CollocationStage::jacobian(At& at, Storage& storage, Matrix jacobian) const {
  jacobian.setZero();
  for (int i = 1; i <= points(); ++i) {
    const int row = (i - 1) * rows_of_point();
    const double alpha = 1 / at.length();
    differentiate_dynamics(at, storage, i, alpha);
    for_each_entry(jacobian_pattern_, [&](int r, int c, std::size_t e) {
      jacobian(row + r, c < nx_ ? x_at(i) + c : y_at(i) + c - nx_) = storage.without_alpha[e];
    });
    for_each_entry(rate_pattern_, [&](int r, int c, std::size_t e) {
      const double rate = storage.with_alpha[static_cast<std::size_t>(rate_places_[e])];
      for (int j = 0; j <= points(); ++j) jacobian(row + r, x_at(j) + c) += method_.d(i - 1, j) * rate;
      if (has_duration_) jacobian(row + r, duration_index()) -= rate * at.length() * at.xdot(c, i - 1) / at.duration;
    });
    if (nu_ == 0) continue;
    dae_->input_jacobian(mode_, point(at, i), at.workspaces[static_cast<std::size_t>(i - 1)], storage.of_inputs);
    for_each_entry(input_pattern_, [&](int r, int c, std::size_t e) { jacobian(row + r, u_at() + c) = storage.of_inputs[e]; });
  }
  for (const StageTerm& term : terms_) {
    if (term.first_row < 0) continue;
    const auto n = static_cast<Eigen::Index>(term.arguments.size()), m = static_cast<Eigen::Index>(term.function->num_values());
    gather(term, at, storage);
    term.function->jacobian(storage.z.head(n), storage.jacobian.topLeftCorner(m, n));
    if (term.factors >= 0) term.function->values(storage.z.head(n), storage.f.head(m));
    for (Eigen::Index k = 0; k < m; ++k) {
      const double factor = term.factors >= 0 ? at.v[term.factors + k] : 1;
      for (Eigen::Index a = 0; a < n; ++a)
        jacobian(term.first_row + k, term.arguments[static_cast<std::size_t>(a)]) = factor * storage.jacobian(k, a);
      if (term.factors >= 0) jacobian(term.first_row + k, term.factors + k) += storage.f[k];
      if (term.subtracted >= 0) jacobian(term.first_row + k, term.subtracted + k) = -1;
    }
  }
}

void CollocationStage::hessian(At& at, Storage& storage, double sigma, ConstVectorRef lambda, Matrix hessian) const {
  hessian.setZero();
  add_dynamics_hessian(at, storage, lambda, hessian);
  for (const StageTerm& term : terms_) add_term_hessian(term, at, storage, sigma, lambda, hessian);
}

// A variable of (xdot, x, y, u) at point i moves with:  xdot_c with X_j by D_ij/h and with T by -xdot_c/T, the others with themselves. (5)
void CollocationStage::add_dynamics_hessian(At& at, Storage& storage, ConstVectorRef lambda, Matrix hessian) const {
  if (!has_curvature_) return;
  const double alpha = 1 / at.length();
  for (int i = 1; i <= points(); ++i) {
    const auto weights = lambda.segment((i - 1) * rows_of_point(), rows_of_point());
    dae_->hessian(mode_, point(at, i), weights, at.workspaces[static_cast<std::size_t>(i - 1)], storage.curvature);
    const auto each_argument = [&](int a, auto&& visit) {
      if (a >= 2 * nx_ + ny_) return visit(u_at() + a - 2 * nx_ - ny_, 1.0);
      if (a >= 2 * nx_) return visit(y_at(i) + a - 2 * nx_, 1.0);
      if (a >= nx_) return visit(x_at(i) + a - nx_, 1.0);
      for (int j = 0; j <= points(); ++j) visit(x_at(j) + a, method_.d(i - 1, j) * alpha);
      if (has_duration_) visit(duration_index(), -at.xdot(a, i - 1) / at.duration);
    };
    for_each_entry(hessian_pattern_, [&](int a, int b, std::size_t e) {
      const double value = storage.curvature[e];
      if (value == 0) return;
      each_argument(a, [&](int p, double by_p) {
        each_argument(b, [&](int q, double by_q) {
          if (a == b && p < q) return;  // the pair comes again the other way round
          hessian(std::max(p, q), std::min(p, q)) += value * by_p * by_q * (a != b && p == q ? 2 : 1);
        });
      });
    });
    if (has_duration_) add_duration_hessian(at, storage, i, weights, alpha, hessian);
  }
}

// d2 xdot_c / dT dX_j = -D_ij/(h T),    d2 xdot_c / dT2 = 2 xdot_c/T^2,    both weighted by (F_xdot' lambda)_c               (6)
void CollocationStage::add_duration_hessian(At& at, Storage& storage, int i, ConstVectorRef weights, double alpha, Matrix hessian) const {
  differentiate_dynamics(at, storage, i, alpha);
  for (int c = 0; c < nx_; ++c) {
    double weight = 0;
    for (int e = rate_pattern_.outer[static_cast<std::size_t>(c)]; e < rate_pattern_.outer[static_cast<std::size_t>(c) + 1]; ++e)
      weight += weights[rate_pattern_.inner[static_cast<std::size_t>(e)]] *
                storage.with_alpha[static_cast<std::size_t>(rate_places_[static_cast<std::size_t>(e)])];
    for (int j = 0; j <= points(); ++j) hessian(duration_index(), x_at(j) + c) -= weight * method_.d(i - 1, j) / at.duration;
    hessian(duration_index(), duration_index()) += 2 * weight * at.length() * at.xdot(c, i - 1) / (at.duration * at.duration);
  }
}

void CollocationStage::add_term_hessian(const StageTerm& term, const At& at, Storage& storage, double sigma, ConstVectorRef lambda,
                                        Matrix hessian) const {
  const auto n = static_cast<Eigen::Index>(term.arguments.size()), m = static_cast<Eigen::Index>(term.function->num_values());
  auto multipliers = storage.multipliers.head(m);
  if (term.first_row < 0)
    multipliers[0] = sigma * term.weight * (term.is_integrand ? at.length() : 1);
  else
    multipliers = lambda.segment(term.first_row, m);
  gather(term, at, storage);
  const auto z = storage.z.head(n);
  auto jacobian = storage.jacobian.topLeftCorner(m, n);
  if (term.factors >= 0) {  // d2 (lambda_k f_k) / dlambda_k dz = f_k'
    term.function->jacobian(z, jacobian);
    for (Eigen::Index k = 0; k < m; ++k) {
      const int p = term.factors + static_cast<int>(k);
      for (Eigen::Index a = 0; a < n; ++a) {
        const int q = term.arguments[static_cast<std::size_t>(a)];
        hessian(std::max(p, q), std::min(p, q)) += multipliers[k] * jacobian(k, a) * (p == q ? 2 : 1);
      }
      multipliers[k] *= at.v[p];
    }
  }
  auto second = storage.hessian.topLeftCorner(n, n);
  term.function->hessian(z, multipliers, second);
  for (Eigen::Index b = 0; b < n; ++b) {
    for (Eigen::Index a = b; a < n; ++a) {
      const int p = term.arguments[static_cast<std::size_t>(a)], q = term.arguments[static_cast<std::size_t>(b)];
      hessian(std::max(p, q), std::min(p, q)) += second(a, b);
    }
  }
  if (!term.is_integrand || !has_duration_) return;
  term.function->jacobian(z, jacobian);
  for (Eigen::Index a = 0; a < n; ++a)
    hessian(duration_index(), term.arguments[static_cast<std::size_t>(a)]) += sigma * term.weight * at.fraction * jacobian(0, a);
}

}  // namespace tenon
