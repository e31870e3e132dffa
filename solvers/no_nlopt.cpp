// In place of nlopt.cpp where NLopt was absent at the time of the build, or not wanted.
#include <stdexcept>

#include "tenon/solvers/nlopt.hpp"

namespace tenon {

namespace {

[[noreturn]] std::unique_ptr<Solver> not_available(const char* name) {
  throw std::invalid_argument(std::string("solver \"") + name + "\" is not available: NLopt was absent when tenon was built");
}

}  // namespace

SolverDescription describe_nlopt_slsqp() { return {"nlopt-slsqp", "sequential least-squares programming, NLopt", false, ""}; }
SolverDescription describe_nlopt_mma() { return {"nlopt-mma", "method of moving asymptotes, NLopt", false, ""}; }
SolverDescription describe_nlopt_ccsaq() { return {"nlopt-ccsaq", "conservative convex separable approximations, NLopt", false, ""}; }
SolverDescription describe_nlopt_auglag() { return {"nlopt-auglag", "augmented Lagrangian over L-BFGS, NLopt", false, ""}; }

std::unique_ptr<Solver> make_nlopt_slsqp(const Nlp&, const Options&) { not_available("nlopt-slsqp"); }
std::unique_ptr<Solver> make_nlopt_mma(const Nlp&, const Options&) { not_available("nlopt-mma"); }
std::unique_ptr<Solver> make_nlopt_ccsaq(const Nlp&, const Options&) { not_available("nlopt-ccsaq"); }
std::unique_ptr<Solver> make_nlopt_auglag(const Nlp&, const Options&) { not_available("nlopt-auglag"); }

}  // namespace tenon
