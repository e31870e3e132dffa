// Newton-KKT of fixed size, compiled with -fno-exceptions, as a controller would embed it: it is enough that this compiles.
#include "tenon/solvers/newton_kkt/newton_kkt.hpp"
#include "tenon/tests/fixed_size_problems.hpp"

#ifdef __cpp_exceptions
#error "this file is for a compiler without exceptions"
#endif

namespace tenon {

template <class Problem, class Solver>
Result solve_without_exceptions() {
  const Problem problem;
  Solver solver(problem);
  PointOf<Problem> point;
  problem.initial_point(point.x);
  return solver.solve(point);
}

using Small = TwoSidedRows<float>;
template Result solve_without_exceptions<TwoSidedRows<double>, NewtonKkt<TwoSidedRows<double>>>();
template Result solve_without_exceptions<Small, NewtonKkt<Small, KktOf<Small>, NoRestoration, NoClock>>();

}  // namespace tenon
