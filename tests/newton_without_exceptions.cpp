// Newton-KKT of fixed size, compiled with -fno-exceptions, as a controller would embed it: it is enough that this compiles.
#include "tenon/solvers/newton_kkt/newton_kkt.hpp"
#include "tenon/tests/fixed_size_problems.hpp"

#ifdef __cpp_exceptions
#error "this file is for a compiler without exceptions"
#endif

namespace tenon {

template class NewtonKkt<TwoSidedRows<double>>;
template class NewtonKkt<TwoSidedRows<float>, KktOf<TwoSidedRows<float>>, NoRestoration, NoClock>;

Result solve_without_exceptions() {
  const TwoSidedRows<double> problem;
  NewtonKkt<TwoSidedRows<double>> solver(problem);
  PointOf<TwoSidedRows<double>> point;
  problem.initial_point(point.x);
  return solver.solve(point);
}

}  // namespace tenon
