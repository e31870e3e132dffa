// MOMAV hovers and rolls: one command every 4 ms.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include <tenon/problems/allocation/tick_allocator.hpp>
#include <tenon/problems/allocation/vehicle_file.hpp>
#include <tenon/solvers/newton_kkt/newton_kkt.hpp>

using Problem = tenon::WrenchAllocation<6>;
using Solver = tenon::NewtonKkt<Problem, tenon::KktOf<Problem>, tenon::NoRestoration, tenon::NoClock>;

int main() {
  const tenon::Vehicle vehicle = tenon::load_vehicle("momav").vehicle;   // or the path of a TOML file
  tenon::TickAllocator<6, Solver> allocator(vehicle, tenon::Options{});  // memory is allocated here and nowhere below

  const double weight = vehicle.mass * vehicle.gravity, dt = 0.004;
  double largest_error = 0;
  for (int k = 0; k <= 250; ++k) {
    const double roll = k * dt;  // at 1 rad/s about body x
    tenon::Wrench wrench;        // force and torque in body axes
    wrench << 0, weight * std::sin(roll), weight * std::cos(roll), 0, 0, 0;

    const tenon::Allocation& command = allocator.allocate(wrench, dt);
    largest_error = std::max(largest_error, command.error.cwiseAbs().maxCoeff());
    if (k % 125 == 0) std::printf("t = %.1f s: u1 = %.3f, a1 = %+.3f rad\n", k * dt, command.throttle[0], command.angle[0]);
  }
  std::printf("wrench met within 1e-6: %s\n", largest_error < 1e-6 ? "yes" : "no");
  return largest_error < 1e-6 ? 0 : 1;
}
