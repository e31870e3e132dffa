#include "tenon/solvers/newton_kkt/stage_system.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace tenon {
namespace {

[[noreturn]] void refuse(const std::string& what) {
  throw std::invalid_argument("stages: " + what);
}

int padded(int n) {
  return lanes::padded<double>(n);
}

}  // namespace

StageSystem::StageSystem(const Stages& stages, const SparsePattern& hessian, const SparsePattern& jacobian)
    : n_(hessian.cols), m_(jacobian.rows), globals_(stages.globals.size()), stages_(stages.stages.size()) {
  find_states(stages, jacobian);
  find_slacks(stages, hessian, jacobian);
  find_dynamics(stages, hessian, jacobian);
  reserve();
  place_hessian(hessian);
  place_jacobian(jacobian);
  fixed_states_.assign(stages_.size(), 0);
  for (auto* fixed : {&fixed_, &fixed_before_}) fixed->reserve(static_cast<std::size_t>(n_));
  placed_.setZero(jacobian.nonzeros());
}

// States of a stage: what the rows of the stage before touch. Those of the first stage, which no row touches, are chosen like the second's.
void StageSystem::find_states(const Stages& stages, const SparsePattern& jacobian) {
  homes_.assign(static_cast<std::size_t>(n_), {});
  row_stage_.assign(static_cast<std::size_t>(m_), -1);
  for (int k = 0; k < size(); ++k) {
    const auto& [variables, rows, slacks] = stages.stages[k];
    if (variables.begin < 0 || variables.end > n_ || rows.begin < 0 || rows.end > m_ || slacks.begin < 0 || slacks.end > n_)
      refuse("stage " + std::to_string(k) + " is out of range");
    for (int i = variables.begin; i < variables.end; ++i) homes_[i].stage = k;
    for (int i = slacks.begin; i < slacks.end; ++i) homes_[i].stage = k;
    for (int j = rows.begin; j < rows.end; ++j) row_stage_[j] = k;
  }
  const auto is_global = [&](int i) { return i >= stages.globals.begin && i < stages.globals.end; };
  std::vector<char> is_state(static_cast<std::size_t>(n_), 0);
  for (int i = 0; i < n_; ++i) {
    const int home = homes_[i].stage;
    if (is_global(i) == (home >= 0)) refuse("variable " + std::to_string(i) + " is in no stage, or in one and among the globals");
    for (int e = jacobian.outer[i]; e < jacobian.outer[i + 1]; ++e) {
      const int row = jacobian.inner[e], stage = row_stage_[row];
      if (stage < 0) refuse("row " + std::to_string(row) + " is in no stage");
      if (is_global(i)) continue;
      if (home != stage && home != stage + 1) {
        refuse("row " + std::to_string(row) + " of stage " + std::to_string(stage) + " touches variable " + std::to_string(i) +
               " of stage " + std::to_string(home) + " (expected one of its own or of the next stage)");
      }
      if (home == stage + 1) is_state[i] = 1;
    }
  }
  if (size() > 1) {
    const IndexRange first = stages.stages[0].variables, second = stages.stages[1].variables;
    if (first.size() >= second.size()) {
      for (int i = 0; i < second.size(); ++i) {
        is_state[first.begin + i] = is_state[second.begin + i];
      }
    }
  }
  for (int i = 0; i < n_; ++i) {
    Home& home = homes_[i];
    if (is_global(i)) continue;
    if (stages.stages[home.stage].slacks.contains(i)) continue;
    StageBlocks& stage = stages_[home.stage];
    (is_state[i] ? home.state : home.local) = is_state[i] ? stage.states++ : stage.locals++;
  }
  for (int k = 0; k < size(); ++k) {
    StageBlocks& b = stage(k);
    if (k + 1 < size()) b.own_next_states = stage(k + 1).states;
    b.next_states = k + 1 < size() ? b.own_next_states + globals_ : 0;
  }
  for (int g = 0; g < globals_; ++g) {
    homes_[stages.globals.begin + g] = {size() - 1, -1, stage(size() - 1).states + g};
  }
  for (StageBlocks& b : stages_) b.states += globals_;
}

void StageSystem::find_slacks(const Stages& stages, const SparsePattern& hessian, const SparsePattern& jacobian) {
  for (const Stages::Stage& stage : stages.stages) {
    for (int i = stage.slacks.begin; i < stage.slacks.end; ++i) {
      const int entry = jacobian.outer[i], row = jacobian.outer[i + 1] == entry + 1 ? jacobian.inner[entry] : -1;
      if (row < stage.rows.begin || row >= stage.rows.end)
        refuse("the slack " + std::to_string(i) + " is not in one row of its stage (expected one)");
      slacks_.push_back({i, row, entry});
    }
  }
  std::vector<int> slack_of(static_cast<std::size_t>(n_), -1);
  for (std::size_t s = 0; s < slacks_.size(); ++s) slack_of[slacks_[s].variable] = static_cast<int>(s);
  for (int j = 0; j < n_; ++j) {
    for (int e = hessian.outer[j]; e < hessian.outer[j + 1]; ++e) {
      const int i = hessian.inner[e];
      if (slack_of[i] < 0 && slack_of[j] < 0) continue;
      if (i != j) refuse("the Hessian couples variables " + std::to_string(i) + " and " + std::to_string(j) + ", one of which is a slack");
      slacks_[slack_of[j]].curvature = e;
    }
  }
}

// Explicit: as many rows touch the next state as it has entries, each of them one, all of them different, and no second derivative does.
void StageSystem::find_dynamics(const Stages& stages, const SparsePattern& hessian, const SparsePattern& jacobian) {
  std::vector<int> touched(static_cast<std::size_t>(m_), 0), touches(static_cast<std::size_t>(m_), -1);
  std::vector<char> fits(stages_.size(), 1);
  const auto home_of = [&](int i) { return homes_[i]; };
  const auto is_global = [&](int i) { return i >= stages.globals.begin && i < stages.globals.end; };
  for (int i = 0; i < n_; ++i) {
    if (is_global(i)) continue;
    for (int e = jacobian.outer[i]; e < jacobian.outer[i + 1]; ++e) {
      const auto row = static_cast<std::size_t>(jacobian.inner[static_cast<std::size_t>(e)]);
      if (home_of(i).stage == row_stage_[row] + 1) ++touched[row], touches[row] = home_of(i).state;
    }
    for (int e = hessian.outer[i]; e < hessian.outer[i + 1]; ++e) {
      const int other = hessian.inner[e];
      if (is_global(other)) continue;
      const int low = std::min(home_of(i).stage, home_of(other).stage), high = std::max(home_of(i).stage, home_of(other).stage);
      const int ahead = home_of(home_of(i).stage == high ? i : other).state;
      if (high > low + 1 || (high == low + 1 && ahead < 0)) {
        refuse("the Hessian couples variables " + std::to_string(i) + " and " + std::to_string(other) + " of stages " +
               std::to_string(low) + " and " + std::to_string(high));
      }
      if (high == low + 1) fits[low] = 0;
    }
  }
  std::vector<std::vector<int>> defined(stages_.size());
  for (int k = 0; k < size(); ++k) defined[k].assign(static_cast<std::size_t>(stage(k).own_next_states), 0);
  for (std::size_t row = 0; row < touched.size(); ++row) {
    const auto k = static_cast<std::size_t>(row_stage_[row]);
    if (touched[row] > 1) fits[k] = 0;
    if (touched[row] == 1) ++defined[k][touches[row]];
  }
  row_dynamics_.assign(touched.size(), -1);
  row_other_.assign(touched.size(), -1);
  for (int k = 0; k < size(); ++k) {
    const auto& counts = defined[k];
    stage(k).is_explicit = fits[k] && std::ranges::all_of(counts, [](int count) { return count == 1; });
  }
  for (std::size_t row = 0; row < touched.size(); ++row) {
    StageBlocks& b = stage(row_stage_[row]);
    if (b.is_explicit && touched[row] == 1)
      row_dynamics_[row] = touches[row];
    else
      row_other_[row] = b.rows++;
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
  at_slacks_ = vector_size_;
  if (!slacks_.empty()) vector_size_ += padded(1);
  for (Vector* v : {&compliance_, &link_}) v->setZero(vector_size_);
  row_scale_.setOnes(vector_size_);
  for (const StageBlocks& b : stages_) {
    if (b.next_states > 0) link_.segment(b.at_dynamics + b.own_next_states, globals_).setConstant(-1);
  }
  for (const Home& home : homes_) {
    const StageBlocks& b = stage(home.stage);
    variable_places_.push_back(home.is_slack()    ? at_slacks_
                               : home.local >= 0 ? b.at_l_vector + home.local
                                                 : b.at_s_vector + home.state);
  }
  for (std::size_t row = 0; row < row_stage_.size(); ++row) {
    const StageBlocks& b = stage(row_stage_[row]);
    row_places_.push_back(row_dynamics_[row] >= 0 ? b.at_dynamics + row_dynamics_[row] : b.at_rows + row_other_[row]);
  }
}

void StageSystem::place_hessian(const SparsePattern& hessian) {
  const int nowhere = static_cast<int>(arena_.size()) - 4;
  const auto is_global = [&](int i) { return homes_[i].stage == size() - 1 && homes_[i].state >= stages_.back().states - globals_; };
  diagonal_places_.resize(static_cast<std::size_t>(n_));
  std::vector<char> has_diagonal(static_cast<std::size_t>(n_), 0);
  for (int j = 0; j < n_; ++j) {
    const Home home = homes_[j];
    const StageBlocks& own = stage(home.stage);
    if (home.is_slack()) {
      diagonal_places_[j] = nowhere;
      for (int e = hessian.outer[j]; e < hessian.outer[j + 1]; ++e) hessian_places_.push_back({nowhere, nowhere});
      continue;
    }
    diagonal_places_[j] =
        home.local >= 0 ? offset(own.h_ll + home.local * (own.local_stride + 1)) : offset(own.h_ss + home.state * (own.state_stride + 1));
    for (int e = hessian.outer[j]; e < hessian.outer[j + 1]; ++e) {
      const int i = hessian.inner[e];
      if (i == j) {
        has_diagonal[j] = 1;
        hessian_places_.push_back({diagonal_places_[j], nowhere});
        continue;
      }
      Home a = homes_[i], c = home;
      // a global meets a variable in that one's own stage
      const auto as_state_of = [&](int k, Home global) { return Home{k, -1, stage(k).states - stages_.back().states + global.state}; };
      if (is_global(i) && !is_global(j)) a = as_state_of(c.stage, a);
      if (is_global(j) && !is_global(i)) c = as_state_of(a.stage, c);
      if (a.stage < c.stage) std::swap(a, c);
      const StageBlocks& b = stage(c.stage);
      if (a.stage > c.stage) {  // a is a state of the next stage
        double* place =
            c.local >= 0 ? b.h_nl + a.state + c.local * padded(b.own_next_states) : b.h_ns + a.state + c.state * padded(b.own_next_states);
        hessian_places_.push_back({offset(place), nowhere});
      } else if (a.local >= 0 && c.local >= 0) {
        hessian_places_.push_back(
            {offset(b.h_ll + a.local + c.local * b.local_stride), offset(b.h_ll + c.local + a.local * b.local_stride)});
      } else if (a.local < 0 && c.local < 0) {
        hessian_places_.push_back(
            {offset(b.h_ss + a.state + c.state * b.state_stride), offset(b.h_ss + c.state + a.state * b.state_stride)});
      } else {
        if (a.local >= 0) std::swap(a, c);
        hessian_places_.push_back({offset(b.h_sl + a.state + c.local * b.state_stride), nowhere});
      }
    }
  }
  for (int j = 0; j < n_; ++j) {
    if (!has_diagonal[j] && !homes_[j].is_slack()) bare_diagonals_.push_back(diagonal_places_[j]);
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
    Home home = homes_[i];
    if (home.is_slack()) continue;
    const bool global = globals_ > 0 && home.stage == size() - 1 && home.state >= stages_.back().states - globals_;
    for (int e = jacobian.outer[i]; e < jacobian.outer[i + 1]; ++e) {
      const auto row = static_cast<std::size_t>(jacobian.inner[static_cast<std::size_t>(e)]);
      const StageBlocks& b = stage(row_stage_[row]);
      const int state = global ? b.states - stages_.back().states + home.state : home.state;
      const bool ahead = !global && home.stage != row_stage_[row];
      if (row_dynamics_[row] >= 0) {
        if (ahead)
          links_.push_back({e, b.at_dynamics + row_dynamics_[row]});
        else if (home.local >= 0)
          place(e, b.a_l + row_dynamics_[row] + home.local * b.next_stride);
        else
          place(e, b.a_s + row_dynamics_[row] + state * b.next_stride);
      } else {
        if (ahead)
          place(e, b.c_n + home.state + row_other_[row] * padded(b.own_next_states));
        else if (home.local >= 0)
          place(e, b.c_l + home.local + row_other_[row] * b.local_stride);
        else
          place(e, b.c_s + state + row_other_[row] * b.state_stride);
      }
    }
  }
}

}  // namespace tenon
