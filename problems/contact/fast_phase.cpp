#include "tenon/problems/contact/fast_phase.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tenon::contact {

namespace {

constexpr double kStandsStill = 1e-10;     // m/s: slower closing is none
constexpr double kSettled = 1e-3;          // of its rest_speed: a contact that opens more slowly after the last blow stays
constexpr double kRank = 1e-12;            // relative: a held contact that depends on others carries nothing of its own
constexpr double kStepsOfAContact = 4000;  // of the compliant laws, over one contact time
constexpr double kMostContactTimes = 400;

using Matrix = Eigen::MatrixXd;

/// Of contacts that depend on one another the least-norm impulses are taken.
Vector least_norm(const Matrix& B, const Vector& b) {
  if (b.size() == 1) return B(0, 0) != 0 ? Vector(b / B(0, 0)) : Vector::Zero(1);
  Eigen::CompleteOrthogonalDecomposition<Matrix> decomposition;
  decomposition.setThreshold(kRank);
  decomposition.compute(B);
  return decomposition.solve(b);
}

/// Of this contact at this closing speed.
Rebound rebound_of(const Touching& touching, double closing_speed) {
  if (touching.collision.alpha3 == 0) return {touching.restitution, touching.contact_time};
  return rebound_of(touching.collision, closing_speed);
}

class Resolution {
 public:
  Resolution(const Matrix& A, const Vector& w, const std::vector<Touching>& touching, int tangents)
      : A_(A), touching_(touching), k_(static_cast<int>(touching.size())), tangents_(tangents) {
    out_.rates = w;
    out_.impulses.setZero(w.size());
    out_.works.setZero(w.size());
    for (const Touching& t : touching) out_.is_held.push_back(t.is_held);
  }

  /// Pairs one after another, the fastest closing first, ties from the lowest index.
  FastPhase sequential(bool holds_all_touching) {
    for (int k = 0; k < kMostMicroEvents; ++k) {
      int fastest = -1;
      bool is_fast = false;
      for (int i = 0; i < k_; ++i) {
        const double closing = -out_.rates[i];
        if (closing <= kStandsStill) continue;
        is_fast |= closing >= touching_[at(i)].rest_speed;
        if (fastest < 0 || closing > -out_.rates[fastest] * (1 + 1e-12)) fastest = i;
      }
      if (fastest < 0) return std::move(out_);
      if (!is_fast) {
        settle(fastest);
        return std::move(out_);
      }
      collide(fastest, holds_all_touching);
    }
    out_.failure = "the fast phase does not end within " + std::to_string(kMostMicroEvents) + " collisions";
    return std::move(out_);
  }

  /// Every touching contact a spring and damper of its own:  lambda = m (w^2 delta^power + 2 zeta w deltadot), while it is positive.
  FastPhase compliant(double power) {
    const int k = k_;
    Vector stiffness(k), damping(k), cubic(k), delta = Vector::Zero(k);
    const Matrix A = A_.topLeftCorner(k, k);
    const double speed = std::max(1e-12, -out_.rates.head(k).minCoeff());
    double shortest = std::numeric_limits<double>::infinity();
    for (int i = 0; i < k; ++i) {
      const Touching& t = touching_[at(i)];
      const Rebound rebound = rebound_of(t, speed);
      const bool has_own = power == 1 && t.collision.alpha3 != 0;
      const Law law = has_own ? t.collision : law_of(std::max(rebound.restitution, 1e-6), rebound.time);
      stiffness[i] = law.alpha0 / A(i, i);
      damping[i] = law.alpha1 / A(i, i);
      cubic[i] = law.alpha3 / A(i, i);
      shortest = std::min(shortest, rebound.time);
    }
    // Hertz's spring as stiff as the linear one where the linear one would be deepest
    if (power != 1) {
      for (int i = 0; i < k; ++i) stiffness[i] /= std::pow(speed * shortest / 4, power - 1);
    }
    const auto forces = [&](const Vector& d, const Vector& w, Vector& lambda) {
      for (int i = 0; i < k; ++i) {
        const double soft = power == 1 ? 1 : std::pow(d[i] / (speed * shortest / 4), power - 1);
        const double f = d[i] >= 0 ? stiffness[i] * std::pow(d[i], power) + cubic[i] * std::pow(d[i], 3) - damping[i] * w[i] * soft : 0;
        lambda[i] = std::max(f, 0.0);
      }
    };
    const double h = shortest / kStepsOfAContact;
    Vector l1(k), l2(k), l3(k), l4(k), d(k), w(k), w1(k), w2(k), w3(k), p = Vector::Zero(out_.rates.size());
    const Vector before = out_.rates;
    for (long step = 0; step < static_cast<long>(kMostContactTimes * kStepsOfAContact); ++step) {
      w1 = out_.rates.head(k);
      forces(delta, w1, l1);
      if (step > 0 && l1.maxCoeff() <= 0 && w1.minCoeff() >= -kStandsStill) {
        finish_compliant(before, static_cast<double>(step) * h);
        return std::move(out_);
      }
      // classical Runge-Kutta on deltadot = -w, wdot = A lambda
      d = delta - 0.5 * h * w1, w2 = w1 + 0.5 * h * (A * l1);
      forces(d, w2, l2);
      d = delta - 0.5 * h * w2, w3 = w1 + 0.5 * h * (A * l2);
      forces(d, w3, l3);
      d = delta - h * w3, w = w1 + h * (A * l3);
      forces(d, w, l4);
      delta -= h / 6 * (w1 + 2 * w2 + 2 * w3 + w);
      p.head(k) = h / 6 * (l1 + 2 * l2 + 2 * l3 + l4);
      add_impulse(p);
      for (int i = 0; i < k && tangents_ > 0; ++i) rub(i, p[i]);
    }
    out_.failure = "the compliant fast phase does not end within " + std::to_string(static_cast<int>(kMostContactTimes)) + " contact times";
    return std::move(out_);
  }

 private:
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }

  int tangent_of(int i) const { return k_ + i * tangents_; }  // its first row

  /// The work of an impulse over a velocity that changes linearly with it; returns that of all rows.
  double add_impulse(const Vector& p) {
    const Vector after = out_.rates + A_ * p, works = 0.5 * p.cwiseProduct(out_.rates + after);
    out_.rates = after;
    out_.impulses += p;
    out_.works += works;
    return works.sum();
  }

  /// The tangential impulse that stops contact i, as far as Coulomb's cone over this normal impulse reaches.
  void rub(int i, double normal) {
    const double most = touching_[at(i)].friction * normal;
    if (!(most > 0)) return;
    const int t = tangent_of(i);
    const Vector stop = least_norm(A_.block(t, t, tangents_, tangents_), -out_.rates.segment(t, tangents_));
    Vector p = Vector::Zero(out_.rates.size());
    p.segment(t, tangents_) = stop * std::min(1.0, most / std::max(stop.norm(), std::numeric_limits<double>::min()));
    add_impulse(p);
  }

  void finish_compliant(const Vector& before, double time) {
    for (int i = 0; i < k_; ++i) {
      out_.is_held[at(i)] = 0;
      const double work = out_.works[i] + out_.works.segment(tangent_of(i), tangents_).sum();
      if (out_.impulses[i] > 0) out_.events.push_back({i, time, before[i], out_.rates[i], out_.impulses[i], work});
    }
  }

  enum class Tangent { absent, sticks, slides };

  void collide(int n, bool holds_all_touching) {
    std::vector<int> chosen{n};  // n, then the contacts held
    for (int i = 0; i < k_; ++i) {
      const bool stands = std::abs(out_.rates[i]) <= kStandsStill;
      if (i != n && (out_.is_held[at(i)] || (holds_all_touching && stands))) chosen.push_back(i);
    }
    std::vector<Tangent> tangent(touching_.size(), Tangent::absent);
    for (const int i : chosen) {
      if (tangents_ > 0 && touching_[at(i)].friction > 0) tangent[at(i)] = Tangent::sticks;
    }
    const bool rests = -out_.rates[n] < touching_[at(n)].rest_speed;
    const Rebound rebound = rests ? stop(n) : rebound_of(touching_[at(n)], -out_.rates[n]);
    const double e = rebound.restitution;
    for (;;) {
      const Vector p = impulse(n, e, chosen, tangent);
      if (!(p[n] > 0) || !((out_.rates + A_ * p)[n] >= -(e * out_.rates[n]) - 1e-9 * std::abs(out_.rates[n]))) {
        if (chosen.size() == 1) return apply(n, -(1 + e) * out_.rates[n] / A_(n, n) * Vector::Unit(p.size(), n), rebound);
        chosen.resize(1);  // it cannot move while those are held: they take their share afterwards
        continue;
      }
      const auto worst = std::min_element(chosen.begin() + 1, chosen.end(), [&](int i, int j) { return p[i] < p[j]; });
      if (worst != chosen.end() && p[*worst] < -1e-12 * p[n] && !holds_all_touching) {
        out_.is_held[at(*worst)] = 0;
        tangent[at(*worst)] = Tangent::absent;
        chosen.erase(worst);
        continue;
      }
      const auto slips = std::find_if(chosen.begin(), chosen.end(), [&](int i) {
        return tangent[at(i)] == Tangent::sticks &&
               p.segment(tangent_of(i), tangents_).norm() > touching_[at(i)].friction * p[i] * (1 + 1e-9);
      });
      if (slips == chosen.end()) return apply(n, p, rebound);
      tangent[at(*slips)] = Tangent::slides;
    }
  }

  /// The impulses that reverse contact n by e, keep the held ones still and the sticking tangents at rest.  (16)
  Vector impulse(int n, double e, const std::vector<int>& chosen, const std::vector<Tangent>& tangent) const {
    const int size = static_cast<int>(A_.rows());
    std::vector<int> rows;      // what must come to a given speed
    std::vector<Vector> along;  // one unit of each unknown, over all rows
    Vector target(size * 2);
    for (const int i : chosen) {
      Vector unit = Vector::Unit(size, i);
      if (tangent[at(i)] == Tangent::slides) {
        const auto slip = out_.rates.segment(tangent_of(i), tangents_);
        if (slip.norm() > 0) unit.segment(tangent_of(i), tangents_) = -touching_[at(i)].friction * slip.normalized();
      }
      target[static_cast<int>(rows.size())] = i == n ? -(1 + e) * out_.rates[n] : -out_.rates[i];
      rows.push_back(i);
      along.push_back(unit);
    }
    for (const int i : chosen) {
      if (tangent[at(i)] != Tangent::sticks) continue;
      for (int t = tangent_of(i); t < tangent_of(i + 1); ++t) {
        target[static_cast<int>(rows.size())] = -out_.rates[t];
        rows.push_back(t);
        along.push_back(Vector::Unit(size, t));
      }
    }
    const int m = static_cast<int>(rows.size());
    Matrix B(m, m);
    for (int c = 0; c < m; ++c) {
      const Vector answer = A_ * along[at(c)];
      for (int r = 0; r < m; ++r) B(r, c) = answer[rows[at(r)]];
    }
    const Vector unknown = least_norm(B, target.head(m));
    Vector p = Vector::Zero(size);
    for (int c = 0; c < m; ++c) p += unknown[c] * along[at(c)];
    return p;
  }

  Rebound stop(int n) const { return {0, touching_[at(n)].contact_time}; }

  void apply(int n, const Vector& impulse, Rebound rebound) {
    const double before = out_.rates[n], work = add_impulse(impulse);
    time_ += rebound.time;
    out_.events.push_back({n, time_, before, out_.rates[n], impulse[n], work});
    if (rebound.restitution == 0) {
      out_.is_held[at(n)] = 1;
      out_.rates[n] = 0;
    }
    for (int i = 0; i < k_; ++i) {
      if (out_.is_held[at(i)] && std::abs(out_.rates[i]) < kStandsStill) out_.rates[i] = 0;
    }
  }

  /// One blow without rebound over all contacts: the active set grows by the contact that closes fastest and loses those that would pull.
  /// (17) Source: C. L. Lawson, R. J. Hanson, Solving Least Squares Problems (1974), ch. 23.
  void settle(int fastest) {
    const Matrix A = A_.topLeftCorner(k_, k_);
    Vector p = Vector::Zero(k_);
    std::vector<int> active;
    for (int round = 0; round < 10 * k_ + 10; ++round) {
      const Vector rates = out_.rates.head(k_) + A * p;
      int next = -1;
      for (int i = 0; i < k_; ++i) {
        if (std::count(active.begin(), active.end(), i) == 0 && rates[i] < -0.1 * kStandsStill && (next < 0 || rates[i] < rates[next]))
          next = i;
      }
      if (next < 0) break;
      active.push_back(next);
      for (;;) {
        const int m = static_cast<int>(active.size());
        const Vector s = stopping(active);
        double share = 1;
        int leaves = -1;
        for (int r = 0; r < m; ++r) {
          const double now = p[active[at(r)]];
          if (s[r] <= 0 && now / (now - s[r]) < share) share = now / (now - s[r]), leaves = r;
        }
        for (int r = 0; r < m; ++r) p[active[at(r)]] += share * (s[r] - p[active[at(r)]]);
        if (leaves < 0) break;
        p[active[at(leaves)]] = 0;
        active.erase(active.begin() + leaves);
        if (active.empty()) break;
      }
    }
    // of what rocks to rest one corner opens at each blow, ever more slowly: in the end they all stay, and the forces decide
    const Vector after = out_.rates.head(k_) + A * p;
    std::vector<int> still;
    for (int i = 0; i < k_; ++i) {
      if (p[i] > 0 || after[i] <= kSettled * touching_[at(i)].rest_speed) still.push_back(i);
    }
    Vector impulse = Vector::Zero(A_.rows());
    const Vector s = stopping(still);
    for (std::size_t r = 0; r < still.size(); ++r) impulse[still[r]] = s[static_cast<int>(r)];
    apply(fastest, impulse, stop(fastest));
    std::fill(out_.is_held.begin(), out_.is_held.end(), char{0});
    for (const int i : still) out_.is_held[at(i)] = 1, out_.rates[i] = 0;
  }

  /// The impulses of these contacts that bring them to a stop, the least ones where they depend on one another.
  Vector stopping(const std::vector<int>& chosen) const {
    const int m = static_cast<int>(chosen.size());
    Matrix B(m, m);
    Vector b(m);
    for (int r = 0; r < m; ++r) {
      b[r] = -out_.rates[chosen[at(r)]];
      for (int c = 0; c < m; ++c) B(r, c) = A_(chosen[at(r)], chosen[at(c)]);
    }
    return least_norm(B, b);
  }

  const Matrix& A_;
  const std::vector<Touching>& touching_;
  int k_, tangents_;
  FastPhase out_;
  double time_ = 0;
};

}  // namespace

FastPhase resolve(ImpactLaw law, const Matrix& A, const Vector& w, const std::vector<Touching>& touching, int tangents) {
  Resolution resolution(A, w, touching, tangents);
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

}  // namespace tenon::contact
