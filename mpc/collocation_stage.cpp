#include "tenon/mpc/collocation_stage.hpp"

#include <algorithm>
#include <stdexcept>

#include "tenon/mpc/pattern_entries.hpp"

namespace tenon {

namespace {

/// R(x) = x.
class Identity final : public SmoothFunction {
 public:
  explicit Identity(int n) : n_(n) {}
  int num_arguments() const override { return n_; }
  int num_values() const override { return n_; }
  void values(ConstVectorRef z, VectorRef f) const override { f = z; }
  void jacobian(ConstVectorRef, Matrix jacobian) const override { jacobian.setIdentity(); }
  void hessian(ConstVectorRef, ConstVectorRef, Matrix hessian) const override { hessian.setZero(); }

 private:
  int n_;
};

Box concatenated(const Box& a, const Box& b) {
  Box out(static_cast<int>(a.lower.size() + b.lower.size()));
  out.lower << a.lower, b.lower;
  out.upper << a.upper, b.upper;
  return out;
}

Box equal_to_zero(int n) {
  Box box(n);
  box.lower.setZero(), box.upper.setZero();
  return box;
}

Box at_least_zero(int n) {
  Box box(n);
  box.lower.setZero();
  return box;
}

Box at_most(int n, double value) {
  Box box(n);
  box.upper.setConstant(value);
  return box;
}

}  // namespace

CollocationStage::CollocationStage(const Ocp& ocp, int phase)
    : dae_(ocp.dae),
      mode_(ocp.phases[static_cast<std::size_t>(phase)].mode),
      nx_(dae_->num_states()),
      ny_(dae_->num_algebraics()),
      nu_(dae_->num_inputs()) {
  if (ocp.phases.size() > 1) prefix_ = ocp.phases[static_cast<std::size_t>(phase)].name + ".";
}

CollocationStage CollocationStage::interval(const Ocp& ocp, int p, const Radau& method) {
  const OcpPhase& phase = ocp.phases[static_cast<std::size_t>(p)];
  CollocationStage stage(ocp, p);
  stage.method_ = method;
  stage.has_duration_ = phase.has_free_duration();
  stage.has_curvature_ = stage.dae_->has_hessian();
  const int s = method.points;
  stage.own_ = stage.nx_ + stage.nu_ + (s - 1) * (stage.nx_ + stage.ny_) + stage.ny_;
  stage.seen_ = stage.own_ + stage.nx_;
  stage.jacobian_pattern_ = stage.dae_->jacobian_pattern();
  stage.rate_pattern_ = stage.dae_->rate_jacobian_pattern();
  stage.input_pattern_ = stage.dae_->input_jacobian_pattern();
  if (stage.has_curvature_) stage.hessian_pattern_ = stage.dae_->hessian_pattern();
  for_each_entry(stage.rate_pattern_, [&](int r, int c, std::size_t) {
    stage.rate_places_.push_back(stage.jacobian_pattern_.find(r, c));
    if (stage.rate_places_.back() < 0)
      throw std::invalid_argument(ocp.name + ": the Dae's rate Jacobian is not within its Jacobian's pattern");
  });
  stage.num_rows_ = s * stage.rows_of_point();
  stage.rows_box_ = equal_to_zero(stage.num_rows_);
  for (int i = 1; i <= s; ++i) {
    if (phase.cost)
      stage.terms_.push_back({.function = phase.cost,
                              .arguments = stage.arguments_at(i, true),
                              .name = {},
                              .weight = method.weights[i - 1],
                              .is_integrand = true});
    if (phase.rows)
      stage.add_term({.function = phase.rows, .arguments = stage.arguments_at(i, true), .name = "path", .point = i}, phase.rows_box);
  }
  if (phase.contact) stage.add_contacts(*phase.contact);
  return stage;
}

CollocationStage CollocationStage::end(const Ocp& ocp, int p, bool has_next) {
  const OcpPhase& phase = ocp.phases[static_cast<std::size_t>(p)];
  CollocationStage stage(ocp, p);
  stage.own_ = stage.nx_;
  stage.seen_ = has_next ? 2 * stage.nx_ : stage.nx_;
  stage.rows_box_ = Box(0);
  const std::vector<int> state = stage.arguments_at(0, false);
  if (phase.end_cost) stage.terms_.push_back({.function = phase.end_cost, .arguments = state, .name = {}});
  if (phase.end_rows) stage.add_term({.function = phase.end_rows, .arguments = state, .name = "end"}, phase.end_rows_box);
  if (has_next) {
    const auto link = phase.link ? phase.link : std::make_shared<Identity>(stage.nx_);
    stage.add_term({.function = link, .arguments = state, .name = "link", .subtracted = stage.nx_}, equal_to_zero(stage.nx_));
  }
  return stage;
}

void CollocationStage::add_term(StageTerm term, const Box& box) {
  term.first_row = num_rows_;
  num_rows_ += term.function->num_values();
  rows_box_ = concatenated(rows_box_, box);
  terms_.push_back(std::move(term));
}

// h(X_i) >= 0, lambda h(X_0) <= eps, lambda h(X_s) <= eps;   or   w(X_i, Y_i, u) >= 0, lambda w(X_s, Y_s, u) <= eps          (8), (10)
void CollocationStage::add_contacts(const Complementarity& contact) {
  const int lambda = u_at() + contact.first_input, s = points();
  if (contact.product == Complementarity::Product::gap) {
    const int n = contact.gaps->num_values();
    for (int i = 1; i <= s; ++i)
      add_term({.function = contact.gaps, .arguments = arguments_at(i, false), .name = "gap", .point = i}, at_least_zero(n));
    for (const int i : {0, s})
      add_term({.function = contact.gaps, .arguments = arguments_at(i, false), .name = "force_times_gap", .point = i, .factors = lambda},
               at_most(n, contact.epsilon));
  }
  if (!contact.barrier) return;
  const int n = contact.barrier->num_values();
  for (int i = 1; i <= s; ++i) {
    add_term({.function = contact.barrier, .arguments = arguments_at(i, true), .name = "barrier", .point = i}, at_least_zero(n));
    if (i == s && contact.product == Complementarity::Product::baumgarte)
      add_term(
          {.function = contact.barrier, .arguments = arguments_at(i, true), .name = "force_times_barrier", .point = i, .factors = lambda},
          at_most(n, contact.epsilon));
  }
}

std::vector<int> CollocationStage::arguments_at(int i, bool with_y_and_u) const {
  std::vector<int> arguments;
  for (int c = 0; c < nx_; ++c) arguments.push_back(x_at(i) + c);
  if (!with_y_and_u) return arguments;
  for (int c = 0; c < ny_; ++c) arguments.push_back(y_at(i) + c);
  for (int c = 0; c < nu_; ++c) arguments.push_back(u_at() + c);
  return arguments;
}

std::vector<std::pair<int, int>> CollocationStage::jacobian_entries() const {
  std::vector<std::pair<int, int>> entries;
  for (int i = 1; i <= points(); ++i) {
    const int row = (i - 1) * rows_of_point();
    for_each_entry(jacobian_pattern_,
                   [&](int r, int c, std::size_t) { entries.emplace_back(row + r, c < nx_ ? x_at(i) + c : y_at(i) + c - nx_); });
    for_each_entry(rate_pattern_, [&](int r, int c, std::size_t) {
      for (int j = 0; j <= points(); ++j) entries.emplace_back(row + r, x_at(j) + c);
      if (has_duration_) entries.emplace_back(row + r, duration_index());
    });
    for_each_entry(input_pattern_, [&](int r, int c, std::size_t) { entries.emplace_back(row + r, u_at() + c); });
  }
  for (const StageTerm& term : terms_) {
    if (term.first_row < 0) continue;
    for (int k = 0; k < term.function->num_values(); ++k) {
      for (const int a : term.arguments) entries.emplace_back(term.first_row + k, a);
      if (term.factors >= 0) entries.emplace_back(term.first_row + k, term.factors + k);
      if (term.subtracted >= 0) entries.emplace_back(term.first_row + k, term.subtracted + k);
    }
  }
  return entries;
}

std::vector<std::pair<int, int>> CollocationStage::hessian_entries() const {
  std::vector<std::pair<int, int>> entries;
  const auto add = [&](int a, int b) { entries.emplace_back(std::max(a, b), std::min(a, b)); };
  for (int i = 1; i <= points(); ++i) {
    // The arguments that a variable of (xdot, x, y, u) stands for.
    const auto arguments = [&](int a) {
      std::vector<int> list;
      if (a < nx_) {
        for (int j = 0; j <= points(); ++j) list.push_back(x_at(j) + a);
        if (has_duration_) list.push_back(duration_index());
      } else {
        list.push_back(arguments_at(i, true)[static_cast<std::size_t>(a - nx_)]);
      }
      return list;
    };
    for_each_entry(hessian_pattern_, [&](int a, int b, std::size_t) {
      for (const int p : arguments(a)) {
        for (const int q : arguments(b)) add(p, q);
      }
    });
    if (!has_duration_) continue;
    for (int c = 0; c < nx_; ++c) {
      for (int j = 0; j <= points(); ++j) add(duration_index(), x_at(j) + c);
    }
    add(duration_index(), duration_index());
  }
  for (const StageTerm& term : terms_) {
    for (const int a : term.arguments) {
      for (const int b : term.arguments) add(a, b);
      if (term.is_integrand && has_duration_) add(duration_index(), a);
      for (int k = 0; term.factors >= 0 && k < term.function->num_values(); ++k) add(term.factors + k, a);
    }
  }
  return entries;
}

std::string CollocationStage::variable_name(int i, int k) const {
  if (i < nx_) return prefix_ + dae_->state_name(i) + "[" + std::to_string(k) + "]";
  if (i < nx_ + nu_) return prefix_ + dae_->input_name(i - nx_) + "[" + std::to_string(k) + "]";
  const int p = point_of_variable(i);
  const bool is_state = p < points() && i < x_at(p) + nx_;
  const std::string name = is_state ? dae_->state_name(i - x_at(p)) : dae_->algebraic_name(i - y_at(p));
  return prefix_ + name + "[" + std::to_string(k) + "." + std::to_string(p) + "]";
}

std::string CollocationStage::row_name(int j, int k) const {
  const int i = point_of_row(j);
  if (j < points() * rows_of_point()) {
    const int r = j % rows_of_point();
    return prefix_ + (r < nx_ ? "dynamics_" + dae_->state_name(r) : "equation_" + dae_->algebraic_name(r - nx_)) + "[" + std::to_string(k) +
           "." + std::to_string(i) + "]";
  }
  for (const StageTerm& term : terms_) {
    const int v = j - term.first_row;
    if (term.first_row < 0 || v < 0 || v >= term.function->num_values()) continue;
    if (term.subtracted >= 0) return prefix_ + "link_" + dae_->state_name(v);
    return prefix_ + term.name + "_" + term.function->value_name(v) +
           (points() == 0 ? "" : "[" + std::to_string(k) + "." + std::to_string(i) + "]");
  }
  return "";
}

int CollocationStage::point_of_variable(int i) const {
  for (int p = 1; p <= points(); ++p) {
    if (i >= nx_ + nu_ && i < y_at(p) + ny_) return p;
  }
  return 0;
}

int CollocationStage::point_of_row(int j) const {
  if (j < points() * rows_of_point()) return 1 + j / rows_of_point();
  for (const StageTerm& term : terms_) {
    if (term.first_row >= 0 && j >= term.first_row && j < term.first_row + term.function->num_values()) return term.point;
  }
  return 0;
}

}  // namespace tenon
