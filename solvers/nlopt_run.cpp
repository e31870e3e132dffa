#include "tenon/solvers/nlopt_run.hpp"

#include <nlopt.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <memory>

#include "tenon/solvers/adapter.hpp"
#include "tenon/solvers/local_infeasibility.hpp"

namespace tenon {

namespace {

constexpr double kStep = 1e-15;  // ftol_rel = xtol_rel: stop where steps drown in rounding

nlopt_algorithm algorithm_of(NloptMethod method) {
  switch (method) {
    case NloptMethod::slsqp: return NLOPT_LD_SLSQP;
    case NloptMethod::mma: return NLOPT_LD_MMA;
    case NloptMethod::ccsaq: return NLOPT_LD_CCSAQ;
    case NloptMethod::auglag: return NLOPT_AUGLAG;
  }
  return NLOPT_NUM_ALGORITHMS;
}

class Session;

/// One side of a row as NLopt wants it: sign (c_row(x) - bound), = 0 or <= 0.
struct Side {
  int row;
  double sign, bound;
};

/// What NLopt hands back to a callback: all equalities, or all inequalities.
struct Sides {
  Session* session;
  std::vector<Side> list = {};
};

struct OptDeleter {
  void operator()(nlopt_opt_s* opt) const { nlopt_destroy(opt); }
};
using Opt = std::unique_ptr<nlopt_opt_s, OptDeleter>;

/// What NLopt's callbacks need, and what they leave behind.
class Session {
 public:
  Session(NloptMethod method, const Nlp& problem, const Bounds& bounds, const Options& options)
      : n_(problem.num_variables()), options_(options), bounds_(bounds), evaluate_(problem), rows_(problem.num_constraints()),
        jacobian_(problem.jacobian_pattern().zero_matrix()), opt_(make_opt(algorithm_of(method))) {
    for (int j = 0; j < problem.num_constraints(); ++j) {
      const double lower = bounds.c_lower[j], upper = bounds.c_upper[j];
      if (lower == upper) {
        equalities_.list.push_back({j, 1, lower});
        continue;
      }
      if (std::isfinite(upper)) inequalities_.list.push_back({j, 1, upper});
      if (std::isfinite(lower)) inequalities_.list.push_back({j, -1, lower});
    }
    nlopt_set_lower_bounds(opt_.get(), bounds.x_lower.data());
    nlopt_set_upper_bounds(opt_.get(), bounds.x_upper.data());
    nlopt_set_min_objective(opt_.get(), objective, this);
    const std::vector<double> tolerances(2 * static_cast<std::size_t>(rows_.size()), options.tolerance);
    const auto size = [](const Sides& sides) { return static_cast<unsigned>(sides.list.size()); };
    if (size(equalities_) > 0) nlopt_add_equality_mconstraint(opt_.get(), size(equalities_), rows, &equalities_, tolerances.data());
    if (size(inequalities_) > 0) nlopt_add_inequality_mconstraint(opt_.get(), size(inequalities_), rows, &inequalities_, tolerances.data());
    nlopt_set_stopval(opt_.get(), kNloptUnbounded);
    nlopt_set_maxeval(opt_.get(), options.max_iterations);
    if (std::isfinite(options.time_limit)) nlopt_set_maxtime(opt_.get(), std::max(options.time_limit, 1e-9));  // 0 would mean none
    if (method == NloptMethod::auglag) nlopt_set_local_optimizer(opt_.get(), make_opt(NLOPT_LD_LBFGS).get());
  }

  NloptRun optimize(const Vector& start) {
    NloptRun run;
    run.x = last_iterate_ = start;
    double value = 0;
    const auto started = std::chrono::steady_clock::now();
    const nlopt_result code = nlopt_optimize(opt_.get(), run.x.data(), &value);
    run.elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
    if (exception_) std::rethrow_exception(exception_);

    run.end = end_of(code);
    run.last_iterate = last_iterate_;
    run.evaluations = evaluations_;
    return run;
  }

 private:
  Opt make_opt(nlopt_algorithm algorithm) const {
    Opt opt(nlopt_create(algorithm, static_cast<unsigned>(n_)));
    nlopt_set_ftol_rel(opt.get(), kStep);
    nlopt_set_xtol_rel(opt.get(), kStep);
    return opt;
  }

  NloptEnd end_of(nlopt_result code) const {
    switch (code) {
      case NLOPT_MAXEVAL_REACHED: return NloptEnd::evaluations;
      case NLOPT_MAXTIME_REACHED: return NloptEnd::time;
      case NLOPT_STOPVAL_REACHED: return NloptEnd::unbounded;
      case NLOPT_FORCED_STOP: return stopped_ ? NloptEnd::observer : NloptEnd::not_finite;
      default: return NloptEnd::no_progress;
    }
  }

  /// NLopt is C: an exception of the problem's or the observer's waits here until it has returned.
  template <class Evaluation>
  void guarded(const Evaluation& evaluation) {
    try {
      if (!evaluation()) nlopt_force_stop(opt_.get());
    } catch (...) {
      exception_ = std::current_exception();
      nlopt_force_stop(opt_.get());
    }
  }

  /// The rows at x, evaluated once for objective, equalities, inequalities and observer together.
  const Vector& constraints(const Eigen::Map<const Vector>& x) {
    if (x_of_rows_.size() == 0 || x_of_rows_ != x) {
      x_of_rows_ = x;
      evaluate_.constraints(x_of_rows_, rows_);
    }
    return rows_;
  }

  /// +infinity where anything is not finite: all of NLopt's methods then try a shorter step.
  static double objective(unsigned n, const double* x_data, double* gradient_data, void* data) {
    Session& session = *static_cast<Session*>(data);
    const Eigen::Map<const Vector> x(x_data, n);
    double value = kInfinity<double>;
    session.guarded([&] {
      const double here = session.evaluate_.objective(x);
      bool finite = std::isfinite(here) && session.constraints(x).allFinite();
      if (gradient_data != nullptr) {
        Eigen::Map<Vector> gradient(gradient_data, n);
        session.evaluate_.gradient(x, gradient);
        finite = finite && gradient.allFinite();
        if (finite) session.last_iterate_ = x;
        else gradient.setZero();
      }
      if (finite) value = here;
      ++session.evaluations_;
      return session.report(x, value);
    });
    return value;
  }

  /// NLopt tells neither dual residual nor steps: those stay 0.
  bool report(const Eigen::Map<const Vector>& x, double value) {
    if (!options_.on_iteration) return true;
    const double primal = rows_.size() == 0 ? 0 : signed_violation(constraints(x), bounds_).lpNorm<Eigen::Infinity>();
    stopped_ = !options_.on_iteration({.index = evaluations_ - 1, .objective = value, .primal = primal, .trials = 1});
    return !stopped_;
  }

  /// Values (m) and, where asked for, gradients (m x n, row by row) of all equalities or all inequalities. Rows that are not finite belong
  /// to a point whose objective is +infinity: 0 keeps NLopt's arithmetic going.
  static void rows(unsigned m, double* values, unsigned n, const double* x_data, double* gradient_data, void* data) {
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const Sides& sides = *static_cast<Sides*>(data);
    Session& session = *sides.session;
    const Eigen::Map<const Vector> x(x_data, n);
    session.guarded([&] {
      const Vector& c = session.constraints(x);
      for (unsigned k = 0; k < m; ++k) {
        const Side& side = sides.list[k];
        values[k] = std::isfinite(c[side.row]) ? side.sign * (c[side.row] - side.bound) : 0;
      }
      if (gradient_data == nullptr) return true;

      session.evaluate_.jacobian(x, values_of(session.jacobian_));
      const Eigen::MatrixXd dense = session.jacobian_;
      Eigen::Map<RowMajor> gradient(gradient_data, m, n);
      for (unsigned k = 0; k < m; ++k) gradient.row(k) = sides.list[k].sign * dense.row(sides.list[k].row);
      return dense.allFinite();
    });
  }

  int n_;
  const Options& options_;
  const Bounds& bounds_;
  PreparedNlp evaluate_;
  Vector rows_, x_of_rows_;
  SparseMatrix jacobian_;
  Sides equalities_{this}, inequalities_{this};
  Opt opt_;
  Vector last_iterate_;
  int evaluations_ = 0;
  bool stopped_ = false;  // by the observer
  std::exception_ptr exception_;
};

}  // namespace

NloptRun run_nlopt(NloptMethod method, const Nlp& problem, const Bounds& bounds, const Options& options, const Vector& start) {
  return Session(method, problem, bounds, options).optimize(start);
}

std::string nlopt_library_version() {
  int major = 0, minor = 0, bugfix = 0;
  nlopt_version(&major, &minor, &bugfix);
  return std::to_string(major) + "." + std::to_string(minor) + "." + std::to_string(bugfix);
}

}  // namespace tenon
