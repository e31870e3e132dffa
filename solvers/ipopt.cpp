// Ipopt over `const Nlp&`: a TNLP that hands every question on, and back again the point in our sign convention.
//
//     Ipopt:  grad f + J' lambda - z_L + z_U = 0,  z_L, z_U >= 0          here:  z = z_U - z_L, the same lambda
//
// Ipopt removes fixed variables and returns no multiplier for them; theirs is z = -(grad f + J' lambda).
// Source: A. Waechter, L. T. Biegler, On the implementation of an interior-point filter line-search algorithm, Math. Program. 106 (2006).
#include "tenon/solvers/ipopt.hpp"

#include <IpIpoptApplication.hpp>
#include <IpIpoptCalculatedQuantities.hpp>
#include <IpTNLP.hpp>
#include <algorithm>
#include <chrono>

#include "tenon/solvers/adapter.hpp"

namespace tenon {

namespace {

using Clock = std::chrono::steady_clock;
using Ipopt::Index;
using Ipopt::Number;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

Eigen::Map<const Vector> view(const Number* values, int size) { return {values, size}; }
Eigen::Map<Vector> view(Number* values, int size) { return {values, size}; }

/// Row and column of each entry of a pattern, in its order.
void write_pattern(const SparsePattern& pattern, Index* row, Index* col) {
  for (int j = 0; j < pattern.cols; ++j) {
    for (int k = pattern.outer[static_cast<std::size_t>(j)]; k < pattern.outer[static_cast<std::size_t>(j) + 1]; ++k) {
      row[k] = pattern.inner[static_cast<std::size_t>(k)];
      col[k] = j;
    }
  }
}

class TenonTnlp final : public Ipopt::TNLP {
 public:
  TenonTnlp(const Nlp& problem, const Options& options)
      : n_(problem.num_variables()), m_(problem.num_constraints()), evaluate_(problem), options_(options),
        jacobian_(problem.jacobian_pattern()), hessian_(problem.hessian_pattern()) {}

  void start(Point& point, const Bounds& bounds) {
    point_ = &point;
    bounds_ = &bounds;
    evaluate_.reset();
    iterations_ = -1;
    out_of_time_ = false;
    started_ = Clock::now();
  }

  int iterations() const { return std::max(iterations_, 0); }
  bool has_iterated() const { return iterations_ >= 0; }
  bool out_of_time() const { return out_of_time_; }
  double elapsed() const { return seconds_since(started_); }

  bool get_nlp_info(Index& n, Index& m, Index& jacobian_nonzeros, Index& hessian_nonzeros, IndexStyleEnum& style) override {
    n = n_;
    m = m_;
    jacobian_nonzeros = jacobian_.nonzeros();
    hessian_nonzeros = hessian_.nonzeros();
    style = C_STYLE;
    return true;
  }

  bool get_bounds_info(Index n, Number* x_lower, Number* x_upper, Index m, Number* c_lower, Number* c_upper) override {
    view(x_lower, n) = bounds_->x_lower;  // +-infinity lies beyond nlp_lower/upper_bound_inf = -+1e19: absent
    view(x_upper, n) = bounds_->x_upper;
    view(c_lower, m) = bounds_->c_lower;
    view(c_upper, m) = bounds_->c_upper;
    return true;
  }

  bool get_starting_point(Index n, bool init_x, Number* x, bool init_z, Number* z_lower, Number* z_upper, Index m, bool init_lambda,
                          Number* lambda) override {
    if (init_x) view(x, n) = point_->x;
    if (init_z) {
      view(z_lower, n) = (-point_->z).cwiseMax(0);
      view(z_upper, n) = point_->z.cwiseMax(0);
    }
    if (init_lambda) view(lambda, m) = point_->lambda;
    return true;
  }

  bool eval_f(Index n, const Number* x, bool, Number& value) override {
    value = evaluate_.objective(view(x, n));
    return std::isfinite(value);
  }
  bool eval_grad_f(Index n, const Number* x, bool, Number* gradient) override {
    evaluate_.gradient(view(x, n), view(gradient, n));
    return view(gradient, n).allFinite();
  }
  bool eval_g(Index n, const Number* x, bool, Index m, Number* values) override {
    evaluate_.constraints(view(x, n), view(values, m));
    return view(values, m).allFinite();
  }
  bool eval_jac_g(Index n, const Number* x, bool, Index, Index nonzeros, Index* row, Index* col, Number* values) override {
    if (values == nullptr) return write_pattern(jacobian_, row, col), true;
    evaluate_.jacobian(view(x, n), {values, static_cast<std::size_t>(nonzeros)});
    return view(values, nonzeros).allFinite();
  }
  bool eval_h(Index n, const Number* x, bool, Number sigma, Index m, const Number* lambda, bool, Index nonzeros, Index* row, Index* col,
              Number* values) override {
    if (values == nullptr) return write_pattern(hessian_, row, col), true;
    evaluate_.hessian(view(x, n), sigma, view(lambda, m), {values, static_cast<std::size_t>(nonzeros)});
    return view(values, nonzeros).allFinite();
  }

  bool intermediate_callback(Ipopt::AlgorithmMode, Index iteration, Number objective, Number primal, Number, Number mu, Number,
                             Number regularization, Number alpha_dual, Number alpha_primal, Index trials, const Ipopt::IpoptData*,
                             Ipopt::IpoptCalculatedQuantities* quantities) override {
    iterations_ = iteration;
    if (elapsed() >= options_.time_limit) out_of_time_ = true;  // by the wall: max_cpu_time counts the processor's time
    if (out_of_time_) return false;
    if (!options_.on_iteration) return true;

    return options_.on_iteration({.index = iteration,
                                  .objective = objective,
                                  .primal = primal,
                                  .dual = quantities->unscaled_curr_dual_infeasibility(Ipopt::NORM_MAX),
                                  .complementarity = quantities->unscaled_curr_complementarity(0, Ipopt::NORM_MAX),
                                  .mu = mu,
                                  .alpha_primal = alpha_primal,
                                  .alpha_dual = alpha_dual,
                                  .regularization = regularization,
                                  .trials = trials});
  }

  void finalize_solution(Ipopt::SolverReturn, Index n, const Number* x, const Number* z_lower, const Number* z_upper, Index m,
                         const Number*, const Number* lambda, Number, const Ipopt::IpoptData*,
                         Ipopt::IpoptCalculatedQuantities*) override {
    point_->x = view(x, n);
    point_->lambda = view(lambda, m);
    point_->z = view(z_upper, n) - view(z_lower, n);
  }

 private:
  int n_, m_;
  PreparedNlp evaluate_;
  Options options_;
  SparsePattern jacobian_, hessian_;
  Point* point_ = nullptr;          // of the solve that runs
  const Bounds* bounds_ = nullptr;  // likewise
  int iterations_ = -1;
  bool out_of_time_ = false;
  Clock::time_point started_;
};

/// z_j = -(grad f + J' lambda)_j where x_lower = x_upper.
void complete_fixed_variables(const Nlp& problem, const Bounds& bounds, Point& point) {
  if (!(bounds.x_lower.array() == bounds.x_upper.array()).any()) return;

  PreparedNlp evaluate(problem);
  Vector gradient(problem.num_variables());
  SparseMatrix jacobian = problem.jacobian_pattern().zero_matrix();
  evaluate.gradient(point.x, gradient);
  evaluate.jacobian(point.x, values_of(jacobian));
  const Vector balance = gradient + jacobian.transpose() * point.lambda;
  point.z = (bounds.x_lower.array() == bounds.x_upper.array()).select(-balance, point.z);
}

/// What Ipopt says about its end, in our words. It judges the problem as it has scaled it: what is solved there need not be so by the ruler.
/// Where it claims no more than that it could not go on, the ruler speaks.
Status status_of(Ipopt::ApplicationReturnStatus code, const TenonTnlp& tnlp, const KktResidual& residual, double tolerance) {
  switch (code) {
    case Ipopt::Solve_Succeeded: return residual.max_scaled() <= tolerance ? Status::solved : Status::acceptable;
    case Ipopt::Infeasible_Problem_Detected: return Status::infeasible;
    case Ipopt::Diverging_Iterates: return Status::unbounded;
    case Ipopt::User_Requested_Stop: return tnlp.out_of_time() ? Status::time_limit : Status::stopped;
    case Ipopt::Maximum_Iterations_Exceeded: return Status::iteration_limit;
    case Ipopt::Maximum_CpuTime_Exceeded: return Status::time_limit;
    case Ipopt::Invalid_Number_Detected: return tnlp.has_iterated() ? Status::numerical_failure : Status::invalid_start;
    default: return judged(residual, tolerance);  // acceptable level, tiny direction, failed restoration, singular step, square problem
  }
}

/// Everything that is set beside tolerance and limits, as Ipopt's own option file would say it.
constexpr const char* kSettings =
    "bound_relax_factor 0, tol = constr_viol_tol = compl_inf_tol = tolerance, acceptable_tol = 100 tolerance; "
    "no Hessian: hessian_approximation limited-memory; warm start: warm_start_init_point yes, mu_init 1e-6, all warm_start pushes 1e-9";

class IpoptSolver final : public Solver {
 public:
  IpoptSolver(const Nlp& problem, const Options& options)
      : problem_(problem), options_(options), tnlp_(new TenonTnlp(problem, options)), application_(new Ipopt::IpoptApplication(false)) {
    validate(options);
    application_->RethrowNonIpoptException(true);  // what an observer throws is its caller's to catch
    const auto set = application_->Options();
    set->SetIntegerValue("print_level", 0);
    set->SetStringValue("sb", "yes");
    set->SetNumericValue("bound_relax_factor", 0);
    set->SetNumericValue("tol", options.tolerance);
    set->SetNumericValue("constr_viol_tol", options.tolerance);
    set->SetNumericValue("compl_inf_tol", options.tolerance);
    set->SetNumericValue("acceptable_tol", kAcceptableFactor * options.tolerance);
    set->SetIntegerValue("max_iter", options.max_iterations);
    if (problem.hessian_kind() == HessianKind::none) set->SetStringValue("hessian_approximation", "limited-memory");
    if (options.warm_start) {
      set->SetStringValue("warm_start_init_point", "yes");
      set->SetNumericValue("mu_init", 1e-6);
      for (const char* push : {"warm_start_bound_push", "warm_start_bound_frac", "warm_start_slack_bound_push",
                               "warm_start_slack_bound_frac", "warm_start_mult_bound_push"}) {
        set->SetNumericValue(push, 1e-9);
      }
    }
    application_->Initialize("");  // no option file: the directory one stands in shall not decide
  }

  Result solve(Point& point) override {
    validate(problem_, point);
    const Bounds bounds = hard_bounds(problem_, "Ipopt");

    tnlp_->start(point, bounds);
    const Ipopt::ApplicationReturnStatus code = application_->OptimizeTNLP(Ipopt::GetRawPtr(tnlp_));
    Result result;
    result.elapsed = tnlp_->elapsed();

    complete_fixed_variables(problem_, bounds, point);
    result.residual = kkt_residual(problem_, point);
    result.objective = PreparedNlp(problem_).objective(point.x);
    result.iterations = tnlp_->iterations();
    result.status = status_of(code, *tnlp_, result.residual, options_.tolerance);
    return result;
  }

 private:
  const Nlp& problem_;
  Options options_;
  Ipopt::SmartPtr<TenonTnlp> tnlp_;
  Ipopt::SmartPtr<Ipopt::IpoptApplication> application_;
};

}  // namespace

SolverDescription describe_ipopt() {
  return {"ipopt", "interior point with a line search filter, Ipopt " IPOPT_VERSION, true, kSettings};
}

std::unique_ptr<Solver> make_ipopt(const Nlp& problem, const Options& options) { return std::make_unique<IpoptSolver>(problem, options); }

}  // namespace tenon
