#include "tenon/problems/contact/fast_phase.hpp"

#include <algorithm>
#include <cmath>

namespace tenon::contact {

namespace {

constexpr double kStandsStill = 1e-10;  // m/s: slower closing is none
constexpr double kRank = 1e-12;         // relative: a held contact that depends on others carries nothing of its own
constexpr double kStepsOfAContact = 4000;  // of the compliant laws, over one contact time
constexpr double kMostContactTimes = 400;

using Matrix = Eigen::MatrixXd;

/// Solves A_aa z = b over the chosen contacts, dependent ones at 0.
Vector solve_chosen(const Matrix& A, const std::vector<int>& chosen, const Vector& b) {
  const int k = static_cast<int>(chosen.size());
  if (k == 0) return Vector(0);
  Matrix sub(k, k);
  for (int i = 0; i < k; ++i) {
    for (int j = 0; j < k; ++j) sub(i, j) = A(chosen[static_cast<std::size_t>(i)], chosen[static_cast<std::size_t>(j)]);
  }
  Eigen::CompleteOrthogonalDecomposition<Matrix> decomposition(sub);
  decomposition.setThreshold(kRank);
  return decomposition.solve(b);
}

class Resolution {
 public:
  Resolution(const Matrix& A, const Vector& w, const std::vector<Touching>& touching) : A_(A), touching_(touching) {
    out_.rates = w;
    out_.impulses.setZero(w.size());
    out_.works.setZero(w.size());
    for (const Touching& t : touching) out_.is_held.push_back(t.is_held);
  }

  /// Pairs one after another, the fastest closing first, ties from the lowest index.
  FastPhase sequential(bool holds_all_touching) {
    for (int k = 0; k < kMostMicroEvents; ++k) {
      int fastest = -1;
      for (int i = 0; i < out_.rates.size(); ++i) {
        const double closing = -out_.rates[i];
        if (out_.is_held[at(i)] && closing <= kStandsStill) continue;
        if (closing > kStandsStill && (fastest < 0 || closing > -out_.rates[fastest] * (1 + 1e-12))) fastest = i;
      }
      if (fastest < 0) return std::move(out_);
      collide(fastest, holds_all_touching);
    }
    out_.failure = "the fast phase does not end within " + std::to_string(kMostMicroEvents) + " collisions";
    return std::move(out_);
  }

  /// Every touching contact a spring and damper of its own:  lambda = m (w^2 delta^power + 2 zeta w deltadot), while it is positive.
  FastPhase compliant(double power) {
    const int k = static_cast<int>(out_.rates.size());
    Vector stiffness(k), damping(k), delta = Vector::Zero(k), rates = out_.rates;
    double shortest = touching_.front().contact_time;
    for (int i = 0; i < k; ++i) {
      const Touching& t = touching_[at(i)];
      const Law law = law_of(std::max(t.restitution, 1e-6), t.contact_time);
      stiffness[i] = law.alpha0 / A_(i, i);
      damping[i] = law.alpha1 / A_(i, i);
      shortest = std::min(shortest, t.contact_time);
    }
    // Hertz's spring as stiff as the linear one where the linear one would be deepest
    const double speed = std::max(1e-12, -rates.minCoeff());
    if (power != 1) {
      for (int i = 0; i < k; ++i) stiffness[i] /= std::pow(speed * shortest / 4, power - 1);
    }
    const auto forces = [&](const Vector& d, const Vector& w, Vector& lambda) {
      for (int i = 0; i < k; ++i) {
        const double f = d[i] > 0 ? stiffness[i] * std::pow(d[i], power) - damping[i] * w[i] * (power == 1 ? 1 : std::pow(d[i] / (speed * shortest / 4), power - 1)) : 0;
        lambda[i] = std::max(f, 0.0);
      }
    };
    const double h = shortest / kStepsOfAContact;
    Vector l1(k), l2(k), l3(k), l4(k), d(k), w(k);
    const Vector before = rates;
    for (long step = 0; step < static_cast<long>(kMostContactTimes * kStepsOfAContact); ++step) {
      forces(delta, rates, l1);
      if (step > 0 && l1.maxCoeff() <= 0 && rates.minCoeff() >= -kStandsStill) {
        finish_compliant(before, static_cast<double>(step) * h);
        return std::move(out_);
      }
      // classical Runge-Kutta on deltadot = -w, wdot = A lambda
      const Vector w1 = rates;
      d = delta - 0.5 * h * w1, w = rates + 0.5 * h * (A_ * l1);
      forces(d, w, l2);
      const Vector w2 = w;
      d = delta - 0.5 * h * w2, w = rates + 0.5 * h * (A_ * l2);
      forces(d, w, l3);
      const Vector w3 = w;
      d = delta - h * w3, w = rates + h * (A_ * l3);
      forces(d, w, l4);
      const Vector lambda = (l1 + 2 * l2 + 2 * l3 + l4) / 6;
      delta -= h / 6 * (w1 + 2 * w2 + 2 * w3 + w);
      rates += h * (A_ * lambda);
      out_.impulses += h * lambda;
      out_.works += h * lambda.cwiseProduct(rates - 0.5 * h * (A_ * lambda));
      out_.rates = rates;
    }
    out_.failure = "the compliant fast phase does not end within " + std::to_string(static_cast<int>(kMostContactTimes)) + " contact times";
    return std::move(out_);
  }

 private:
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }

  void finish_compliant(const Vector& before, double time) {
    for (int i = 0; i < before.size(); ++i) {
      out_.is_held[at(i)] = 0;
      if (out_.impulses[i] > 0) out_.events.push_back({i, time, before[i], out_.rates[i], out_.impulses[i], out_.works[i]});
    }
  }

  void collide(int n, bool holds_all_touching) {
    std::vector<int> held;
    for (int i = 0; i < out_.rates.size(); ++i) {
      const bool stands = std::abs(out_.rates[i]) <= kStandsStill;
      if (i != n && (out_.is_held[at(i)] || (holds_all_touching && stands))) held.push_back(i);
    }
    const double before = out_.rates[n];
    Vector impulse, along;
    for (;;) {
      along.resize(static_cast<int>(held.size()));
      for (std::size_t k = 0; k < held.size(); ++k) along[static_cast<int>(k)] = A_(held[k], n);
      const Vector answer = solve_chosen(A_, held, along);  // A_aa^-1 A_an
      double inverse_mass = A_(n, n);
      for (std::size_t k = 0; k < held.size(); ++k) inverse_mass -= along[static_cast<int>(k)] * answer[static_cast<int>(k)];
      if (inverse_mass <= kRank * A_(n, n)) {  // it cannot move while those are held: they share the blow
        held.clear();
        continue;
      }
      const double e = -before < touching_[at(n)].rest_speed ? 0 : touching_[at(n)].restitution;
      const double p = -(1 + e) * before / inverse_mass;
      // (16), the held contacts' share; the one that would pull hardest lets go
      impulse.setZero(out_.rates.size());
      impulse[n] = p;
      int worst = -1;
      for (std::size_t k = 0; k < held.size(); ++k) {
        impulse[held[k]] = -answer[static_cast<int>(k)] * p;
        const double pull = -impulse[held[k]];
        if (pull > 1e-12 * p && (worst < 0 || pull > -impulse[held[static_cast<std::size_t>(worst)]])) worst = static_cast<int>(k);
      }
      if (worst < 0 || holds_all_touching) {
        apply(n, impulse, e);
        return;
      }
      out_.is_held[at(held[static_cast<std::size_t>(worst)])] = 0;
      held.erase(held.begin() + worst);
    }
  }

  void apply(int n, const Vector& impulse, double e) {
    const Vector after = out_.rates + A_ * impulse;
    // the work of an impulse over a velocity that changes linearly with it
    const Vector works = 0.5 * impulse.cwiseProduct(out_.rates + after);
    const Touching& t = touching_[at(n)];
    time_ += t.contact_time;
    out_.events.push_back({n, time_, out_.rates[n], after[n], impulse[n], works.sum()});
    out_.rates = after;
    out_.impulses += impulse;
    out_.works += works;
    if (e == 0) {
      out_.is_held[at(n)] = 1;
      out_.rates[n] = 0;
    }
    for (int i = 0; i < out_.rates.size(); ++i) {
      if (out_.is_held[at(i)] && std::abs(out_.rates[i]) < kStandsStill) out_.rates[i] = 0;
    }
  }

  const Matrix& A_;
  const std::vector<Touching>& touching_;
  FastPhase out_;
  double time_ = 0;
};

}  // namespace

FastPhase resolve(ImpactLaw law, const Matrix& A, const Vector& w, const std::vector<Touching>& touching) {
  Resolution resolution(A, w, touching);
  switch (law) {
    case ImpactLaw::compliant:
      return resolution.compliant(1);
    case ImpactLaw::hertz:
      return resolution.compliant(1.5);
    case ImpactLaw::coupled:
      return resolution.sequential(true);
    case ImpactLaw::sequential:
      break;
  }
  return resolution.sequential(false);
}

std::vector<FastPoint> collision_path(const Law& law, double closing_speed, int points) {
  // h'' + alpha1 h' + alpha0 h = 0 from h = 0, h' = -v:  two exponentials, complex below zeta = 1  (11)
  const double w = std::sqrt(law.alpha0), zeta = law.alpha1 / (2 * w), end = contact_time_of(law);
  std::vector<FastPoint> path;
  for (int k = 0; k <= points; ++k) {
    const double t = end * k / points, decay = std::exp(-zeta * w * t), d = std::abs(zeta * zeta - 1);
    double s = t, c = 1;  // of the critical law
    if (d > 1e-12) {
      const double wd = w * std::sqrt(d);
      s = zeta < 1 ? std::sin(wd * t) / wd : std::sinh(wd * t) / wd;
      c = zeta < 1 ? std::cos(wd * t) : std::cosh(wd * t);
    }
    const double gap = -closing_speed * decay * s, rate = -closing_speed * decay * (c - zeta * w * s);
    path.push_back({t, gap, rate, -law.alpha1 * rate - law.alpha0 * gap});
  }
  return path;
}

}  // namespace tenon::contact
