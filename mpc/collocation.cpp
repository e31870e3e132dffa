#include "tenon/mpc/collocation.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace tenon {

namespace {

/// What the evaluations share: each stage where it stands, and storage for one stage at a time.
struct CollocationScratch final : Nlp::Scratch {
  Vector x;
  std::vector<CollocationStage::At> at;
  CollocationStage::Storage storage;
  Eigen::MatrixXd jacobian, hessian;
};
CollocationScratch& scratch_of(Nlp::Workspace& workspace) {
  return static_cast<CollocationScratch&>(*workspace);
}

std::vector<std::pair<int, int>> each_once(std::vector<std::pair<int, int>> entries) {
  std::sort(entries.begin(), entries.end());
  entries.erase(std::unique(entries.begin(), entries.end()), entries.end());
  return entries;
}

void check_mesh(const Ocp& ocp, const Mesh& mesh) {
  bool is_good = mesh.size() == ocp.phases.size();
  for (const std::vector<double>& borders : mesh) {
    is_good = is_good && borders.size() >= 2 && borders.front() == 0 && borders.back() == 1 &&
              std::adjacent_find(borders.begin(), borders.end(), [](double a, double b) { return !(a < b); }) == borders.end();
  }
  if (!is_good) throw std::invalid_argument(ocp.name + ": a mesh whose borders do not ascend from 0 to 1 in every phase");
}

}  // namespace

Mesh uniform_mesh(const Ocp& ocp) {
  Mesh mesh;
  for (const OcpPhase& phase : ocp.phases) {
    std::vector<double>& borders = mesh.emplace_back();
    for (int k = 0; k <= phase.intervals; ++k) borders.push_back(static_cast<double>(k) / std::max(1, phase.intervals));
  }
  return mesh;
}

Collocation::Collocation(Ocp ocp, int points, Mesh mesh) : ocp_(std::move(ocp)), mesh_(std::move(mesh)), method_(radau(points)) {
  validate(ocp_);
  check_mesh(ocp_, mesh_);
  const int phases = static_cast<int>(ocp_.phases.size());
  for (int p = 0; p < phases; ++p) {
    const auto add_kind = [&](CollocationStage functions) {
      std::vector<std::pair<int, int>> jacobian = each_once(functions.jacobian_entries()), hessian = each_once(functions.hessian_entries());
      kinds_.push_back({std::move(functions), std::move(jacobian), std::move(hessian)});
      return static_cast<int>(kinds_.size()) - 1;
    };
    const int interval = add_kind(CollocationStage::interval(ocp_, p, method_)),
              end = add_kind(CollocationStage::end(ocp_, p, p + 1 < phases));
    const int intervals = static_cast<int>(mesh_[static_cast<std::size_t>(p)].size()) - 1;
    for (int k = 0; k < intervals; ++k) add_stage(p, k, interval);
    add_stage(p, intervals, end);
  }
  first_global_ = num_variables_;
  for (const OcpPhase& phase : ocp_.phases) duration_variables_.push_back(phase.has_free_duration() ? num_variables_++ : -1);
  find_patterns();
}

void Collocation::add_stage(int phase, int interval, int kind) {
  const std::vector<double>& borders = mesh_[static_cast<std::size_t>(phase)];
  const auto k = static_cast<std::size_t>(interval);
  StagePlace stage{.phase = phase,
                   .interval = interval,
                   .kind = kind,
                   .begin = borders[k],
                   .first_variable = num_variables_,
                   .first_row = num_rows_,
                   .jacobian_positions = {},
                   .hessian_positions = {}};
  if (k + 1 < borders.size()) stage.fraction = borders[k + 1] - borders[k];
  num_variables_ += functions(stage).num_own();
  num_rows_ += functions(stage).num_rows();
  stages_.push_back(std::move(stage));
}

void Collocation::find_patterns() {
  std::vector<std::pair<int, int>> jacobian, hessian;
  for (const StagePlace& stage : stages_) {
    const Kind& kind = kinds_[static_cast<std::size_t>(stage.kind)];
    for (const auto& [row, argument] : kind.jacobian_entries) jacobian.emplace_back(stage.first_row + row, variable(stage, argument));
    for (const auto& [a, b] : kind.hessian_entries) hessian.emplace_back(variable(stage, a), variable(stage, b));
  }
  for (int p = 0; p < static_cast<int>(ocp_.phases.size()); ++p) {
    if (duration_variable(p) >= 0) hessian.emplace_back(duration_variable(p), duration_variable(p));
  }
  jacobian_pattern_ = SparsePattern::from_entries(num_rows_, num_variables_, std::move(jacobian));
  hessian_pattern_ = SparsePattern::from_entries(num_variables_, num_variables_, std::move(hessian));
  for (StagePlace& stage : stages_) {
    const Kind& kind = kinds_[static_cast<std::size_t>(stage.kind)];
    for (const auto& [row, argument] : kind.jacobian_entries)
      stage.jacobian_positions.push_back(jacobian_pattern_.find(stage.first_row + row, variable(stage, argument)));
    for (const auto& [a, b] : kind.hessian_entries)
      stage.hessian_positions.push_back(hessian_pattern_.find(variable(stage, a), variable(stage, b)));
  }
}

void Collocation::set_initial_state(ConstVectorRef x) {
  ocp_.phases.front().start.lower = x;
  ocp_.phases.front().start.upper = x;
}

Stages Collocation::stages() const {
  Stages stages;
  for (const StagePlace& stage : stages_) {
    stages.stages.push_back({{stage.first_variable, stage.first_variable + functions(stage).num_own()},
                             {stage.first_row, stage.first_row + functions(stage).num_rows()}});
  }
  stages.globals = {first_global_, num_variables_};
  return stages;
}

void Collocation::bounds(Bounds& bounds) const {
  const auto narrow = [&](int first, const Box& box) {
    const auto n = box.lower.size();
    bounds.x_lower.segment(first, n) = bounds.x_lower.segment(first, n).cwiseMax(box.lower);
    bounds.x_upper.segment(first, n) = bounds.x_upper.segment(first, n).cwiseMin(box.upper);
  };
  for (const StagePlace& stage : stages_) {
    const OcpPhase& phase = this->phase(stage.phase);
    const CollocationStage& functions = this->functions(stage);
    const int first = stage.first_variable;
    narrow(first, phase.x);
    if (stage.interval == 0) narrow(first, phase.start);
    if (is_end(stage)) {
      narrow(first, phase.end);
    } else {
      narrow(first + functions.u_at(), phase.u);
      for (int i = 1; i <= functions.points(); ++i) {
        if (i < functions.points()) narrow(first + functions.x_at(i), phase.x);
        narrow(first + functions.y_at(i), phase.y);
      }
      if (phase.contact) {
        const int n = (phase.contact->gaps ? phase.contact->gaps : phase.contact->barrier)->num_values();
        auto lambda = bounds.x_lower.segment(first + functions.u_at() + phase.contact->first_input, n);
        lambda = lambda.cwiseMax(0);
      }
    }
    bounds.c_lower.segment(stage.first_row, functions.num_rows()) = functions.rows_box().lower;
    bounds.c_upper.segment(stage.first_row, functions.num_rows()) = functions.rows_box().upper;
  }
  for (int p = 0; p < static_cast<int>(ocp_.phases.size()); ++p) {
    if (duration_variable(p) < 0) continue;
    bounds.x_lower[duration_variable(p)] = phase(p).shortest;
    bounds.x_upper[duration_variable(p)] = phase(p).longest;
  }
}

void Collocation::initial_point(VectorRef x) const {
  const int nx = ocp_.dae->num_states();
  Vector state(nx), algebraic(ocp_.dae->num_algebraics()), input(ocp_.dae->num_inputs());
  for (const StagePlace& stage : stages_) {
    const CollocationStage& functions = this->functions(stage);
    for (int i = 0; i <= std::max(0, functions.points()); ++i) {
      const double fraction = is_end(stage) ? 1 : stage.begin + method_.abscissae[i] * stage.fraction;
      guess_at(phase(stage.phase), fraction, state, algebraic, input);
      if (i < functions.points() || is_end(stage)) x.segment(stage.first_variable + functions.x_at(i), nx) = state;
      if (is_end(stage)) break;
      if (i == 0) x.segment(stage.first_variable + functions.u_at(), input.size()) = input;
      if (i > 0) x.segment(stage.first_variable + functions.y_at(i), algebraic.size()) = algebraic;
    }
  }
  for (int p = 0; p < static_cast<int>(ocp_.phases.size()); ++p) {
    if (duration_variable(p) >= 0) x[duration_variable(p)] = std::clamp(phase(p).duration, phase(p).shortest, phase(p).longest);
  }
}

std::size_t Collocation::stage_of_variable(int i) const {
  const auto after = std::upper_bound(stages_.begin(), stages_.end(), i, [](int v, const StagePlace& s) { return v < s.first_variable; });
  return static_cast<std::size_t>(after - stages_.begin()) - 1;
}

std::size_t Collocation::stage_of_row(int j) const {
  const auto after = std::upper_bound(stages_.begin(), stages_.end(), j, [](int r, const StagePlace& s) { return r < s.first_row; });
  return static_cast<std::size_t>(after - stages_.begin()) - 1;
}

Nlp::Workspace Collocation::make_workspace() const {
  auto scratch = std::make_unique<CollocationScratch>();
  scratch->x.resize(num_variables_);
  int rows = 0, arguments = 0;
  for (const StagePlace& stage : stages_) {
    const CollocationStage& functions = this->functions(stage);
    scratch->at.push_back(functions.make_at());
    functions.reserve(scratch->storage);
    rows = std::max(rows, functions.num_rows()), arguments = std::max(arguments, functions.num_arguments());
  }
  scratch->jacobian.resize(rows, arguments);
  scratch->hessian.resize(arguments, arguments);
  return scratch;
}

void Collocation::prepare(ConstVectorRef x, Workspace& workspace) const {
  CollocationScratch& scratch = scratch_of(workspace);
  scratch.x = x;
  double start = 0;
  for (std::size_t k = 0; k < stages_.size(); ++k) {
    const StagePlace& stage = stages_[k];
    CollocationStage::At& at = scratch.at[k];
    at.v = scratch.x.data() + stage.first_variable;
    at.duration = duration(stage.phase, x);
    at.fraction = stage.fraction;
    at.t = start + stage.begin * at.duration;
    functions(stage).prepare(at);
    if (is_end(stage)) start += at.duration;
  }
}

double Collocation::objective(ConstVectorRef x, Workspace& workspace) const {
  CollocationScratch& scratch = scratch_of(workspace);
  double sum = 0;
  for (std::size_t k = 0; k < stages_.size(); ++k) sum += functions(stages_[k]).objective(scratch.at[k], scratch.storage);
  for (int p = 0; p < static_cast<int>(ocp_.phases.size()); ++p) sum += phase(p).time_weight * duration(p, x);
  return sum;
}

void Collocation::gradient(ConstVectorRef, Workspace& workspace, VectorRef gradient) const {
  CollocationScratch& scratch = scratch_of(workspace);
  gradient.setZero();
  double unused = 0;
  for (std::size_t k = 0; k < stages_.size(); ++k) {
    const int duration = duration_variable(stages_[k].phase);
    functions(stages_[k])
        .add_gradient(scratch.at[k], scratch.storage, gradient.data() + stages_[k].first_variable,
                      duration < 0 ? &unused : &gradient[duration]);
  }
  for (int p = 0; p < static_cast<int>(ocp_.phases.size()); ++p) {
    if (duration_variable(p) >= 0) gradient[duration_variable(p)] += phase(p).time_weight;
  }
}

void Collocation::constraints(ConstVectorRef, Workspace& workspace, VectorRef values) const {
  CollocationScratch& scratch = scratch_of(workspace);
  for (std::size_t k = 0; k < stages_.size(); ++k)
    functions(stages_[k]).rows(scratch.at[k], scratch.storage, values.segment(stages_[k].first_row, functions(stages_[k]).num_rows()));
}

void Collocation::jacobian(ConstVectorRef, Workspace& workspace, std::span<double> values) const {
  CollocationScratch& scratch = scratch_of(workspace);
  for (std::size_t k = 0; k < stages_.size(); ++k) {
    const CollocationStage& functions = this->functions(stages_[k]);
    auto local = scratch.jacobian.topLeftCorner(functions.num_rows(), functions.num_arguments());
    functions.jacobian(scratch.at[k], scratch.storage, local);
    const auto& entries = kinds_[static_cast<std::size_t>(stages_[k].kind)].jacobian_entries;
    for (std::size_t e = 0; e < entries.size(); ++e)
      values[static_cast<std::size_t>(stages_[k].jacobian_positions[e])] = local(entries[e].first, entries[e].second);
  }
}

void Collocation::hessian(ConstVectorRef, double sigma, ConstVectorRef lambda, Workspace& workspace, std::span<double> values) const {
  CollocationScratch& scratch = scratch_of(workspace);
  std::fill(values.begin(), values.end(), 0.0);
  for (std::size_t k = 0; k < stages_.size(); ++k) {
    const CollocationStage& functions = this->functions(stages_[k]);
    auto local = scratch.hessian.topLeftCorner(functions.num_arguments(), functions.num_arguments());
    functions.hessian(scratch.at[k], scratch.storage, sigma, lambda.segment(stages_[k].first_row, functions.num_rows()), local);
    const auto& entries = kinds_[static_cast<std::size_t>(stages_[k].kind)].hessian_entries;
    for (std::size_t e = 0; e < entries.size(); ++e)
      values[static_cast<std::size_t>(stages_[k].hessian_positions[e])] += local(entries[e].first, entries[e].second);
  }
}

std::string Collocation::variable_name(int i) const {
  if (i >= first_global_) {
    const auto p = std::find(duration_variables_.begin(), duration_variables_.end(), i) - duration_variables_.begin();
    return (ocp_.phases.size() > 1 ? phase(static_cast<int>(p)).name + "." : "") + "duration";
  }
  const StagePlace& stage = stages_[stage_of_variable(i)];
  return functions(stage).variable_name(i - stage.first_variable, stage.interval);
}

std::string Collocation::constraint_name(int j) const {
  const StagePlace& stage = stages_[stage_of_row(j)];
  return functions(stage).row_name(j - stage.first_row, stage.interval);
}

}  // namespace tenon
