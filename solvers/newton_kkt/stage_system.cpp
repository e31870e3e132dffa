#include "tenon/solvers/newton_kkt/stage_system.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "tenon/solvers/newton_kkt/stage_products.hpp"

namespace tenon {
namespace {

constexpr double kFixed = 1e30;      // sigma that holds a variable
constexpr double kVanished = 1e-8;  // a coefficient of a next state that does not define it

[[noreturn]] void refuse(const std::string& what) { throw std::invalid_argument("stages: " + what); }

int padded(int n) { return lanes::padded<double>(n); }

}  // namespace

StageSystem::StageSystem(const Stages& stages, const SparsePattern& hessian, const SparsePattern& jacobian)
    : n_(hessian.cols), m_(jacobian.rows), globals_(stages.globals.size()), stages_(stages.stages.size()) {
  find_states(stages, jacobian);
  find_dynamics(stages, hessian, jacobian);
  reserve();
  place_hessian(hessian);
  place_jacobian(jacobian);
  fixed_state_.assign(stages_.size(), 0);
  fixed_.reserve(static_cast<std::size_t>(n_));
}

// States of a stage: what the rows of the stage before touch. Those of the first stage, which no row touches, are chosen like the second's.
void StageSystem::find_states(const Stages& stages, const SparsePattern& jacobian) {
  homes_.assign(static_cast<std::size_t>(n_), {});
  row_stage_.assign(static_cast<std::size_t>(m_), -1);
  for (int k = 0; k < size(); ++k) {
    const auto& [variables, rows] = stages.stages[static_cast<std::size_t>(k)];
    if (variables.begin < 0 || variables.end > n_ || rows.begin < 0 || rows.end > m_) refuse("stage " + std::to_string(k) + " is out of range");
    for (int i = variables.begin; i < variables.end; ++i) homes_[static_cast<std::size_t>(i)].stage = k;
    for (int j = rows.begin; j < rows.end; ++j) row_stage_[static_cast<std::size_t>(j)] = k;
  }
  const auto is_global = [&](int i) { return i >= stages.globals.begin && i < stages.globals.end; };
  std::vector<char> is_state(static_cast<std::size_t>(n_), 0);
  for (int i = 0; i < n_; ++i) {
    const int home = homes_[static_cast<std::size_t>(i)].stage;
    if (is_global(i) == (home >= 0)) refuse("variable " + std::to_string(i) + " is in no stage, or in one and among the globals");
    for (int e = jacobian.outer[static_cast<std::size_t>(i)]; e < jacobian.outer[static_cast<std::size_t>(i) + 1]; ++e) {
      const int row = jacobian.inner[static_cast<std::size_t>(e)], stage = row_stage_[static_cast<std::size_t>(row)];
      if (stage < 0) refuse("row " + std::to_string(row) + " is in no stage");
      if (is_global(i)) continue;
      if (home != stage && home != stage + 1) {
        refuse("row " + std::to_string(row) + " of stage " + std::to_string(stage) + " touches variable " + std::to_string(i) + " of stage " +
               std::to_string(home) + " (expected one of its own or of the next stage)");
      }
      if (home == stage + 1) is_state[static_cast<std::size_t>(i)] = 1;
    }
  }
  if (size() > 1) {
    const IndexRange first = stages.stages[0].variables, second = stages.stages[1].variables;
    if (first.size() >= second.size()) {
      for (int i = 0; i < second.size(); ++i) {
        is_state[static_cast<std::size_t>(first.begin + i)] = is_state[static_cast<std::size_t>(second.begin + i)];
      }
    }
  }
  for (int i = 0; i < n_; ++i) {
    Home& home = homes_[static_cast<std::size_t>(i)];
    if (is_global(i)) continue;
    StageBlocks& stage = stages_[static_cast<std::size_t>(home.stage)];
    (is_state[static_cast<std::size_t>(i)] ? home.state : home.local) = is_state[static_cast<std::size_t>(i)] ? stage.states++ : stage.locals++;
  }
  for (int k = 0; k < size(); ++k) {
    StageBlocks& b = stage(k);
    if (k + 1 < size()) b.own_next_states = stage(k + 1).states;
    b.next_states = k + 1 < size() ? b.own_next_states + globals_ : 0;
  }
  for (int g = 0; g < globals_; ++g) {
    homes_[static_cast<std::size_t>(stages.globals.begin + g)] = {size() - 1, -1, stage(size() - 1).states + g};
  }
  for (StageBlocks& b : stages_) b.states += globals_;
}

// Explicit: as many rows touch the next state as it has entries, each of them one, all of them different, and no second derivative does.
void StageSystem::find_dynamics(const Stages& stages, const SparsePattern& hessian, const SparsePattern& jacobian) {
  std::vector<int> touched(static_cast<std::size_t>(m_), 0), touches(static_cast<std::size_t>(m_), -1);
  std::vector<char> fits(stages_.size(), 1);
  const auto home_of = [&](int i) { return homes_[static_cast<std::size_t>(i)]; };
  const auto is_global = [&](int i) { return i >= stages.globals.begin && i < stages.globals.end; };
  for (int i = 0; i < n_; ++i) {
    if (is_global(i)) continue;
    for (int e = jacobian.outer[static_cast<std::size_t>(i)]; e < jacobian.outer[static_cast<std::size_t>(i) + 1]; ++e) {
      const auto row = static_cast<std::size_t>(jacobian.inner[static_cast<std::size_t>(e)]);
      if (home_of(i).stage == row_stage_[row] + 1) ++touched[row], touches[row] = home_of(i).state;
    }
    for (int e = hessian.outer[static_cast<std::size_t>(i)]; e < hessian.outer[static_cast<std::size_t>(i) + 1]; ++e) {
      const int other = hessian.inner[static_cast<std::size_t>(e)];
      if (is_global(other)) continue;
      const int low = std::min(home_of(i).stage, home_of(other).stage), high = std::max(home_of(i).stage, home_of(other).stage);
      const int ahead = home_of(home_of(i).stage == high ? i : other).state;
      if (high > low + 1 || (high == low + 1 && ahead < 0)) {
        refuse("the Hessian couples variables " + std::to_string(i) + " and " + std::to_string(other) + " of stages " + std::to_string(low) +
               " and " + std::to_string(high));
      }
      if (high == low + 1) fits[static_cast<std::size_t>(low)] = 0;
    }
  }
  std::vector<std::vector<int>> defined(stages_.size());
  for (int k = 0; k < size(); ++k) defined[static_cast<std::size_t>(k)].assign(static_cast<std::size_t>(stage(k).own_next_states), 0);
  for (std::size_t row = 0; row < touched.size(); ++row) {
    const auto k = static_cast<std::size_t>(row_stage_[row]);
    if (touched[row] > 1) fits[k] = 0;
    if (touched[row] == 1) ++defined[k][static_cast<std::size_t>(touches[row])];
  }
  row_dynamics_.assign(touched.size(), -1);
  row_other_.assign(touched.size(), -1);
  for (int k = 0; k < size(); ++k) {
    const auto& counts = defined[static_cast<std::size_t>(k)];
    stage(k).is_explicit = fits[static_cast<std::size_t>(k)] && std::ranges::all_of(counts, [](int count) { return count == 1; });
  }
  for (std::size_t row = 0; row < touched.size(); ++row) {
    StageBlocks& b = stage(row_stage_[row]);
    if (b.is_explicit && touched[row] == 1) row_dynamics_[row] = touches[row];
    else row_other_[row] = b.rows++;
  }
}

void StageSystem::reserve() {
  const auto lay_out = [&](double* base) {
    std::size_t top = 0;
    const auto take = [&](double*& block, int rows, int columns) {
      block = base == nullptr ? nullptr : base + top;
      top += panel_size(rows, columns);
    };
    for (StageBlocks& b : stages_) {
      const int coupled = b.is_explicit ? 0 : b.own_next_states;
      take(b.h_ss, b.states, b.states), take(b.h_sl, b.states, b.locals), take(b.h_ll, b.locals, b.locals);
      take(b.a_s, b.next_states, b.states), take(b.a_l, b.next_states, b.locals);
      take(b.at_s, b.states, b.next_states), take(b.at_l, b.locals, b.next_states);
      take(b.c_s, b.states, b.rows), take(b.c_l, b.locals, b.rows), take(b.c_n, coupled, b.rows);
      take(b.h_ns, coupled, b.states), take(b.h_nl, coupled, b.locals);
      take(b.value, b.states, b.states), take(b.gain, b.states, b.locals), take(b.l_ll, b.locals, b.locals), take(b.d_inverse, b.locals, 1);
    }
    return top;
  };
  arena_.setZero(static_cast<Eigen::Index>(lay_out(nullptr)) + 4);  // the last lane takes what has no mirror
  lay_out(arena_.data());
  for (StageBlocks& b : stages_) {
    b.state_stride = padded(b.states), b.local_stride = padded(b.locals), b.next_stride = padded(b.next_states);
    const auto take = [&](int& at, int count) { at = vector_size_, vector_size_ += padded(count); };
    take(b.at_l_vector, b.locals), take(b.at_s_vector, b.states), take(b.at_dynamics, b.next_states), take(b.at_rows, b.rows);
    for (int g = 0; g < globals_ && b.next_states > 0; ++g) b.a_s[b.own_next_states + g + (b.states - globals_ + g) * b.next_stride] = 1;
  }
  for (Vector* v : {&compliance_, &link_, &row_scale_}) v->setZero(vector_size_);
  for (const StageBlocks& b : stages_) {
    if (b.next_states > 0) link_.segment(b.at_dynamics + b.own_next_states, globals_).setConstant(-1);
    row_scale_.segment(b.at_dynamics, b.next_states).setOnes();
  }
  for (const Home& home : homes_) {
    const StageBlocks& b = stage(home.stage);
    variable_places_.push_back(home.local >= 0 ? b.at_l_vector + home.local : b.at_s_vector + home.state);
  }
  for (std::size_t row = 0; row < row_stage_.size(); ++row) {
    const StageBlocks& b = stage(row_stage_[row]);
    row_places_.push_back(row_dynamics_[row] >= 0 ? b.at_dynamics + row_dynamics_[row] : b.at_rows + row_other_[row]);
  }
}

void StageSystem::place_hessian(const SparsePattern& hessian) {
  const int nowhere = static_cast<int>(arena_.size()) - 4;
  const auto is_global = [&](int i) { return homes_[static_cast<std::size_t>(i)].state >= stages_.back().states - globals_ && homes_[static_cast<std::size_t>(i)].stage == size() - 1 && globals_ > 0; };
  diagonal_places_.resize(static_cast<std::size_t>(n_));
  std::vector<char> has_diagonal(static_cast<std::size_t>(n_), 0);
  for (int j = 0; j < n_; ++j) {
    const Home home = homes_[static_cast<std::size_t>(j)];
    const StageBlocks& own = stage(home.stage);
    diagonal_places_[static_cast<std::size_t>(j)] =
        home.local >= 0 ? offset(own.h_ll + home.local * (own.local_stride + 1)) : offset(own.h_ss + home.state * (own.state_stride + 1));
    for (int e = hessian.outer[static_cast<std::size_t>(j)]; e < hessian.outer[static_cast<std::size_t>(j) + 1]; ++e) {
      const int i = hessian.inner[static_cast<std::size_t>(e)];
      if (i == j) {
        has_diagonal[static_cast<std::size_t>(j)] = 1;
        hessian_places_.push_back({diagonal_places_[static_cast<std::size_t>(j)], nowhere});
        continue;
      }
      Home a = homes_[static_cast<std::size_t>(i)], c = home;
      // a global meets a variable in that one's own stage
      const auto as_state_of = [&](int k, Home global) { return Home{k, -1, stage(k).states - stages_.back().states + global.state}; };
      if (is_global(i) && !is_global(j)) a = as_state_of(c.stage, a);
      if (is_global(j) && !is_global(i)) c = as_state_of(a.stage, c);
      if (a.stage < c.stage) std::swap(a, c);
      const StageBlocks& b = stage(c.stage);
      if (a.stage > c.stage) {  // a is a state of the next stage
        double* place = c.local >= 0 ? b.h_nl + a.state + c.local * padded(b.own_next_states) : b.h_ns + a.state + c.state * padded(b.own_next_states);
        hessian_places_.push_back({offset(place), nowhere});
      } else if (a.local >= 0 && c.local >= 0) {
        hessian_places_.push_back({offset(b.h_ll + a.local + c.local * b.local_stride), offset(b.h_ll + c.local + a.local * b.local_stride)});
      } else if (a.local < 0 && c.local < 0) {
        hessian_places_.push_back({offset(b.h_ss + a.state + c.state * b.state_stride), offset(b.h_ss + c.state + a.state * b.state_stride)});
      } else {
        if (a.local >= 0) std::swap(a, c);
        hessian_places_.push_back({offset(b.h_sl + a.state + c.local * b.state_stride), nowhere});
      }
    }
  }
  for (int j = 0; j < n_; ++j) {
    if (!has_diagonal[static_cast<std::size_t>(j)]) bare_diagonals_.push_back(diagonal_places_[static_cast<std::size_t>(j)]);
  }
}

// Entries that are neighbours here and there are moved together.
void StageSystem::place_jacobian(const SparsePattern& jacobian) {
  const auto place = [&](int source, const double* to) {
    if (!jacobian_runs_.empty()) {
      Run& last = jacobian_runs_.back();
      if (last.source + last.length == source && last.place + last.length == offset(to)) {
        ++last.length;
        return;
      }
    }
    jacobian_runs_.push_back({source, offset(to), 1});
  };
  for (int i = 0; i < n_; ++i) {
    Home home = homes_[static_cast<std::size_t>(i)];
    const bool global = globals_ > 0 && home.stage == size() - 1 && home.state >= stages_.back().states - globals_;
    for (int e = jacobian.outer[static_cast<std::size_t>(i)]; e < jacobian.outer[static_cast<std::size_t>(i) + 1]; ++e) {
      const auto row = static_cast<std::size_t>(jacobian.inner[static_cast<std::size_t>(e)]);
      const StageBlocks& b = stage(row_stage_[row]);
      const int state = global ? b.states - stages_.back().states + home.state : home.state;
      const bool ahead = !global && home.stage != row_stage_[row];
      if (row_dynamics_[row] >= 0) {
        if (ahead) links_.push_back({e, b.at_dynamics + row_dynamics_[row]});
        else if (home.local >= 0) place(e, b.a_l + row_dynamics_[row] + home.local * b.next_stride);
        else place(e, b.a_s + row_dynamics_[row] + state * b.next_stride);
      } else {
        if (ahead) place(e, b.c_n + home.state + row_other_[row] * padded(b.own_next_states));
        else if (home.local >= 0) place(e, b.c_l + home.local + row_other_[row] * b.local_stride);
        else place(e, b.c_s + state + row_other_[row] * b.state_stride);
      }
    }
  }
}

bool StageSystem::assemble(const SparseMatrix& hessian, const SparseMatrix& jacobian, ConstVectorRef sigma, ConstVectorRef d) {
  const Eigen::Map<const Vector> h(hessian.valuePtr(), hessian.nonZeros()), j(jacobian.valuePtr(), jacobian.nonZeros());
  if (!std::isfinite(h.sum() + j.sum() + sigma.sum() + d.sum())) return false;
  double* to = arena_.data();
  for (std::size_t e = 0; e < hessian_places_.size(); ++e) to[hessian_places_[e].first] = to[hessian_places_[e].mirror] = h[static_cast<Eigen::Index>(e)];
  for (const int place : bare_diagonals_) to[place] = 0;
  for (std::size_t i = 0; i < diagonal_places_.size(); ++i) to[diagonal_places_[i]] += sigma[static_cast<Eigen::Index>(i)];
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
  for (std::size_t row = 0; row < row_places_.size(); ++row) {
    const int place = row_places_[row];
    compliance_[place] = row_dynamics_[row] >= 0 ? d[static_cast<Eigen::Index>(row)] * row_scale_[place] * row_scale_[place] : d[static_cast<Eigen::Index>(row)];
  }
  if (any_fixed_ || sigma.maxCoeff() >= kFixed) take_out_fixed(sigma);
  for (const StageBlocks& b : stages_) {
    stage::transpose(b.a_s, b.next_stride, b.next_states, b.states, b.at_s, b.state_stride);
    stage::transpose(b.a_l, b.next_stride, b.next_states, b.locals, b.at_l, b.local_stride);
  }
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

// A variable held by sigma = 1e30 leaves the system: its row and column become those of the identity, its right-hand side 0.
void StageSystem::take_out_fixed(ConstVectorRef sigma) {
  std::ranges::fill(fixed_state_, 0);
  fixed_.clear();
  for (int i = 0; i < n_; ++i) {
    if (sigma[i] < kFixed) continue;
    fixed_.push_back(i);
    take_out(i);
  }
  any_fixed_ = !fixed_.empty();
}

void StageSystem::take_out(int variable) {
  const Home home = homes_[static_cast<std::size_t>(variable)];
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
    if (home.state >= 0) fixed_state_[static_cast<std::size_t>(home.stage)] = 1;
  }
  arena_[diagonal_places_[static_cast<std::size_t>(variable)]] = 1;
}

void StageSystem::gather(ConstVectorRef r_x, ConstVectorRef r_c, double* vector) const {
  for (std::size_t i = 0; i < variable_places_.size(); ++i) vector[variable_places_[i]] = r_x[static_cast<Eigen::Index>(i)];
  for (std::size_t j = 0; j < row_places_.size(); ++j) vector[row_places_[j]] = r_c[static_cast<Eigen::Index>(j)];
  if (scaled_) {
    for (std::size_t j = 0; j < row_places_.size(); ++j) {
      if (row_dynamics_[j] >= 0) vector[row_places_[j]] *= row_scale_[row_places_[j]];
    }
  }
  for (const int i : fixed_) vector[variable_places_[static_cast<std::size_t>(i)]] = 0;
}

void StageSystem::scatter(const double* vector, VectorRef dx, VectorRef dlambda) const {
  for (std::size_t i = 0; i < variable_places_.size(); ++i) dx[static_cast<Eigen::Index>(i)] = vector[variable_places_[i]];
  for (std::size_t j = 0; j < row_places_.size(); ++j) dlambda[static_cast<Eigen::Index>(j)] = vector[row_places_[j]];
  if (scaled_) {
    for (std::size_t j = 0; j < row_places_.size(); ++j) {
      if (row_dynamics_[j] >= 0) dlambda[static_cast<Eigen::Index>(j)] *= row_scale_[row_places_[j]];
    }
  }
}

}  // namespace tenon
