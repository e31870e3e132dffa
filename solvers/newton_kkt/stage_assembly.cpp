// Values into the blocks, and vectors between the order of the problem and that of the stages.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "tenon/solvers/newton_kkt/stage_products.hpp"
#include "tenon/solvers/newton_kkt/stage_system.hpp"

namespace tenon {
namespace {

constexpr double kFixed = 1e30;     // sigma that holds a variable
constexpr double kVanished = 1e-8;  // a coefficient of a next state that does not define it

int padded(int n) {
  return lanes::padded<double>(n);
}

}  // namespace

bool StageSystem::assemble(const SparseMatrix& hessian, const SparseMatrix& jacobian, ConstVectorRef sigma, ConstVectorRef d) {
  const Eigen::Map<const Vector> h(hessian.valuePtr(), hessian.nonZeros());
  if (!std::isfinite(h.sum() + sigma.sum() + d.sum())) return false;
  double* to = arena_.data();
  for (std::size_t e = 0; e < hessian_places_.size(); ++e) to[hessian_places_[e].first] = to[hessian_places_[e].mirror] = h[e];
  for (const int place : bare_diagonals_) to[place] = 0;
  for (std::size_t i = 0; i < diagonal_places_.size(); ++i) to[diagonal_places_[i]] += sigma[i];
  std::swap(fixed_, fixed_before_);
  find_fixed(sigma);
  const bool is_new = !holds(jacobian);
  if (is_new && !place(jacobian)) return false;
  for (std::size_t row = 0; row < row_places_.size(); ++row) compliance_[row_places_[row]] = d[row];
  eliminate_slacks(hessian, jacobian, sigma);
  if (scaled_) compliance_.array() *= row_scale_.array().square();
  for (const int variable : fixed_) take_out(variable);
  if (is_new) {
    for (const StageBlocks& b : stages_) {
      stage::transpose(b.a_s, b.next_stride, b.next_states, b.states, b.at_s, b.state_stride);
      stage::transpose(b.a_l, b.next_stride, b.next_states, b.locals, b.at_l, b.local_stride);
    }
  }
  return true;
}

// Whether the blocks hold these values, with these variables taken out: where rows are linear, they do at every iterate but the first.
bool StageSystem::holds(const SparseMatrix& jacobian) const {
  return holds_jacobian_ && fixed_ == fixed_before_ &&
         std::memcmp(jacobian.valuePtr(), placed_.data(), sizeof(double) * static_cast<std::size_t>(placed_.size())) == 0;
}

bool StageSystem::place(const SparseMatrix& jacobian) {
  const Eigen::Map<const Vector> j(jacobian.valuePtr(), jacobian.nonZeros());
  holds_jacobian_ = std::isfinite(j.sum());
  if (!holds_jacobian_) return false;
  placed_ = j;
  double* to = arena_.data();
  for (const Run& run : jacobian_runs_) {
    for (int e = 0; e < run.length; ++e) to[run.place + e] = j[run.source + e];
  }
  scaled_ = false;
  for (const auto& [source, place] : links_) {
    // the coefficient of a next state: its row is scaled so that it is -1; one that has vanished stays as it is
    const double value = j[source];
    const bool vanished = std::abs(value) < kVanished;
    link_[place] = vanished ? value : -1;
    row_scale_[place] = vanished || value == -1 ? 1 : -1 / value;
    scaled_ |= row_scale_[place] != 1;
  }
  if (scaled_) scale_dynamics();
  return true;
}

void StageSystem::scale_dynamics() {
  for (const StageBlocks& b : stages_) {
    for (int i = 0; i < b.own_next_states && b.is_explicit; ++i) {
      const double scale = row_scale_[b.at_dynamics + i];
      for (int j = 0; j < b.states; ++j) b.a_s[i + j * b.next_stride] *= scale;
      for (int j = 0; j < b.locals; ++j) b.a_l[i + j * b.next_stride] *= scale;
    }
  }
}

void StageSystem::find_fixed(ConstVectorRef sigma) {
  fixed_.clear();
  std::ranges::fill(fixed_states_, 0);
  if (!(sigma.maxCoeff() >= kFixed)) return;
  for (int i = 0; i < n_; ++i) {
    if (sigma[i] < kFixed || homes_[i].is_slack()) continue;
    fixed_.push_back(i);
    if (homes_[i].state >= 0) ++fixed_states_[homes_[i].stage];
  }
}

// h dx + a dlambda = r:   D += a^2/h in its row, whose right-hand side loses a r/h.  stage_kkt.md (1.2)
void StageSystem::eliminate_slacks(const SparseMatrix& hessian, const SparseMatrix& jacobian, ConstVectorRef sigma) {
  slack_inertia_ = {};
  for (Slack& slack : slacks_) {
    const double stiffness = sigma[slack.variable];
    const double pivot = stiffness + (slack.curvature >= 0 ? hessian.valuePtr()[slack.curvature] : 0);
    ++(pivot > 0 ? slack_inertia_.positive : pivot < 0 ? slack_inertia_.negative : slack_inertia_.zero);
    slack.inverse = pivot == 0 || stiffness >= kFixed ? 0 : 1 / pivot;
    const double a = jacobian.valuePtr()[slack.coefficient];
    slack.pull = a * slack.inverse;
    compliance_[row_places_[slack.row]] += a * slack.pull;
  }
}

// A variable held by sigma = 1e30 leaves the system: its row and column become those of the identity, its right-hand side 0.
void StageSystem::take_out(int variable) {
  const Home home = homes_[variable];
  const bool global = home.state >= stage(home.stage).states - globals_;
  const auto clear_in = [&](StageBlocks& b, int local, int state) {
    if (local >= 0) {
      for (int j = 0; j < b.locals; ++j) b.h_ll[j + local * b.local_stride] = b.h_ll[local + j * b.local_stride] = 0;
      for (int j = 0; j < b.states; ++j) b.h_sl[j + local * b.state_stride] = 0;
      for (int j = 0; j < b.next_states; ++j) b.a_l[j + local * b.next_stride] = 0;
      for (int j = 0; j < b.rows; ++j) b.c_l[local + j * b.local_stride] = 0;
    } else {
      for (int j = 0; j < b.states; ++j) b.h_ss[j + state * b.state_stride] = b.h_ss[state + j * b.state_stride] = 0;
      for (int j = 0; j < b.locals; ++j) b.h_sl[state + j * b.state_stride] = 0;
      for (int j = 0; j < b.own_next_states; ++j) b.a_s[j + state * b.next_stride] = 0;
      for (int j = 0; j < b.rows; ++j) b.c_s[state + j * b.state_stride] = 0;
    }
    if (!b.is_explicit) {
      const int stride = padded(b.own_next_states);
      for (int j = 0; j < b.own_next_states; ++j) (local >= 0 ? b.h_nl[j + local * stride] : b.h_ns[j + state * stride]) = 0;
    }
  };
  if (global) {
    for (int k = 0; k < size(); ++k) clear_in(stage(k), -1, home.state - stages_.back().states + stage(k).states);
  } else {
    clear_in(stage(home.stage), home.local, home.state);
    if (home.state >= 0 && home.stage > 0) {
      StageBlocks& before = stage(home.stage - 1);
      const int stride = padded(before.own_next_states);
      if (before.is_explicit) link_[before.at_dynamics + home.state] = 0;
      for (int j = 0; j < before.rows && !before.is_explicit; ++j) before.c_n[home.state + j * stride] = 0;
      for (int j = 0; j < before.states && !before.is_explicit; ++j) before.h_ns[home.state + j * stride] = 0;
      for (int j = 0; j < before.locals && !before.is_explicit; ++j) before.h_nl[home.state + j * stride] = 0;
    }
  }
  arena_[diagonal_places_[variable]] = 1;
}

void StageSystem::gather(ConstVectorRef r_x, ConstVectorRef r_c, double* vector) const {
  for (std::size_t i = 0; i < variable_places_.size(); ++i) vector[variable_places_[i]] = r_x[i];
  for (std::size_t j = 0; j < row_places_.size(); ++j) vector[row_places_[j]] = r_c[j];
  for (const Slack& slack : slacks_) vector[row_places_[slack.row]] -= slack.pull * r_x[slack.variable];
  if (!slacks_.empty()) vector[at_slacks_] = 0;
  if (scaled_) {
    for (const int place : row_places_) vector[place] *= row_scale_[place];
  }
  for (const int i : fixed_) vector[variable_places_[i]] = 0;
}

void StageSystem::scatter(const double* vector, ConstVectorRef r_x, VectorRef dx, VectorRef dlambda) const {
  for (std::size_t i = 0; i < variable_places_.size(); ++i) dx[i] = vector[variable_places_[i]];
  for (std::size_t j = 0; j < row_places_.size(); ++j) dlambda[j] = vector[row_places_[j]];
  if (scaled_) {
    for (std::size_t j = 0; j < row_places_.size(); ++j) dlambda[j] *= row_scale_[row_places_[j]];
  }
  for (const Slack& slack : slacks_) dx[slack.variable] = slack.inverse * r_x[slack.variable] - slack.pull * dlambda[slack.row];
}

}  // namespace tenon
