// tenon fit BENCH.csv: thrust and torque polynomials from calibration data, as lines for a vehicle's TOML.
#include "tenon/problems/allocation/fit.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdio>

#include "tenon/apps/json.hpp"
#include "tenon/apps/verb.hpp"

namespace tenon {

namespace {

Json fit_json(const PolynomialFit& fit) {
  return Json::object()
      .set("coefficients", fit.coefficients)
      .set("max_residual", fit.max_residual)
      .set("rms_residual", fit.rms_residual)
      .set("rises", fit.rises);
}

void print_fit(const char* name, const char* unit, const PolynomialFit& fit) {
  fmt::print("{} = [{:.9g}]  # {}, residual at most {:.3g}, rms {:.3g}\n", name, fmt::join(fit.coefficients, ", "), unit, fit.max_residual,
             fit.rms_residual);
}

}  // namespace

int run_fit(const Arguments& arguments) {
  const BenchFit fit = fit_bench(arguments.names.front(), arguments.degree, arguments.constant);
  if (arguments.json) {
    print(Json::object()
              .set("schema", 1)
              .set("file", arguments.names.front())
              .set("samples", fit.samples)
              .set("degree", arguments.degree)
              .set("thrust", fit_json(fit.thrust))
              .set("torque", fit_json(fit.torque)));
  } else {
    print_fit("thrust", "N", fit.thrust);
    print_fit("torque", "N m", fit.torque);
  }
  const auto warn = [](const char* name, const PolynomialFit& polynomial) {
    if (!polynomial.rises) {
      fmt::print(stderr, "tenon: {} falls somewhere between throttle 0 and 1, so that it cannot be inverted; try another --degree\n", name);
    }
  };
  warn("thrust", fit.thrust);
  warn("torque", fit.torque);
  return kFinished;
}

}  // namespace tenon
