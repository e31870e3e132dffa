// One problem of fixed size, solved on both storage paths of Newton-KKT: NewtonKkt<P> itself, and AsNlp<P> through the sparse back end.
#pragma once

#include <string>
#include <vector>

#include "tenon/core/as_nlp.hpp"
#include "tenon/solvers/make_solver.hpp"
#include "tenon/solvers/newton_kkt/newton_kkt.hpp"

namespace tenon {

struct Traced {
  Point point;
  Result result;
  std::vector<Iteration> trace;
};

/// Options whose observer also appends to `trace`, which has room for as many lines as a solve may take.
inline Options tracing(Options options, std::vector<Iteration>& trace) {
  trace.clear();
  trace.reserve(static_cast<std::size_t>(std::min(options.max_iterations, 3000)) + 1);
  options.on_iteration = [&trace, inner = options.on_iteration](const Iteration& iteration) {
    trace.push_back(iteration);
    return inner ? inner(iteration) : true;
  };
  return options;
}

template <class P>
PointOf<P> start_of(const P& problem) {
  PointOf<P> point;
  problem.initial_point(point.x);
  return point;
}

template <class P>
Point to_point(const PointOf<P>& fixed) {
  Point point(P::kVariables, P::kConstraints);
  point.x = fixed.x.template cast<double>();
  point.lambda = fixed.lambda.template cast<double>();
  point.z = fixed.z.template cast<double>();
  return point;
}

/// From the problem's own start, on the path of fixed size.
template <class P>
Traced run_dense(const P& problem, const Options& options = {}) {
  Traced run;
  NewtonKkt<P> solver(problem, tracing(options, run.trace));
  PointOf<P> point = start_of(problem);
  run.result = solver.solve(point);
  run.point = to_point<P>(point);
  return run;
}

/// The same with any back end, through Nlp.
template <class P>
Traced run_back_end(const std::string& name, const P& problem, const Options& options = {}) {
  const AsNlp<P> nlp(problem);
  Traced run{Point(P::kVariables, P::kConstraints), {}, {}};
  nlp.initial_point(run.point.x);
  run.result = make_solver(name, nlp, tracing(options, run.trace))->solve(run.point);
  return run;
}

/// Unscaled, as the path of fixed size is.
template <class P>
Traced run_sparse(const P& problem, Options options = {}) {
  options.scaling = false;
  return run_back_end("newton-kkt", problem, options);
}

}  // namespace tenon
