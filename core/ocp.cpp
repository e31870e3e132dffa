#include "tenon/core/ocp.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>

namespace tenon {

namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

class Checker {
 public:
  Checker(const Ocp& ocp, const OcpPhase& phase) : dae_(*ocp.dae), where_(ocp.name + ", phase '" + phase.name + "': ") {}

  void require(bool holds, const std::string& what) const {
    if (!holds) throw std::invalid_argument(where_ + what);
  }
  void box(const Box& box, int size, const std::string& what) const {
    require(box.lower.size() == size && box.upper.size() == size,
            "bounds of " + what + " of the wrong length (expected " + std::to_string(size) + ")");
    for (int i = 0; i < size; ++i) {
      require(box.lower[i] <= box.upper[i], "bounds of " + what + ", entry " + std::to_string(i + 1) + ": " + std::to_string(box.lower[i]) +
                                                " above " + std::to_string(box.upper[i]));
    }
  }
  /// values < 0: any number of them.
  void function(const SmoothFunction* f, int arguments, int values, const std::string& what) const {
    if (f == nullptr) return;
    require(f->num_arguments() == arguments,
            what + " takes " + std::to_string(f->num_arguments()) + " arguments (expected " + std::to_string(arguments) + ")");
    require(values < 0 || f->num_values() == values,
            what + " has " + std::to_string(f->num_values()) + " values (expected " + std::to_string(values) + ")");
  }

  void phase(const OcpPhase& phase) const {
    const int nx = dae_.num_states(), ny = dae_.num_algebraics(), nu = dae_.num_inputs(), nz = nx + ny + nu;
    require(phase.intervals >= 1, std::to_string(phase.intervals) + " intervals (expected at least 1)");
    require(phase.duration > 0, "a duration of " + std::to_string(phase.duration) + " s (expected more than 0)");
    require(!phase.has_free_duration() || phase.shortest > 0, "a shortest duration of 0 s (expected more)");
    box(phase.x, nx, "x"), box(phase.y, ny, "y"), box(phase.u, nu, "u"), box(phase.start, nx, "the start"), box(phase.end, nx, "the end");
    function(phase.cost.get(), nz, 1, "the cost"), function(phase.end_cost.get(), nx, 1, "the end's cost");
    function(phase.rows.get(), nz, -1, "the rows"), function(phase.end_rows.get(), nx, -1, "the end's rows");
    function(phase.link.get(), nx, nx, "the link");
    if (phase.rows) box(phase.rows_box, phase.rows->num_values(), "the rows");
    if (phase.end_rows) box(phase.end_rows_box, phase.end_rows->num_values(), "the end's rows");
    if (phase.contact) contact(*phase.contact, nx, nz, nu);
  }

 private:
  void contact(const Complementarity& contact, int nx, int nz, int nu) const {
    const bool by_gap = contact.product == Complementarity::Product::gap;
    const SmoothFunction* const complement = by_gap ? contact.gaps.get() : contact.barrier.get();
    require(complement != nullptr, by_gap ? "contact without gaps" : "contact without a Baumgarte row");
    const int contacts = complement->num_values();
    function(contact.gaps.get(), nx, contacts, "the gaps"), function(contact.barrier.get(), nz, contacts, "the Baumgarte row");
    require(contact.first_input >= 0 && contact.first_input + contacts <= nu, "contact forces that are no inputs");
    require(contact.epsilon > 0, "an epsilon of " + std::to_string(contact.epsilon) + " (expected more than 0)");
  }

  const Dae& dae_;
  std::string where_;
};

}  // namespace

Box::Box(int n) : lower(Vector::Constant(n, -kInfinite)), upper(Vector::Constant(n, kInfinite)) {}

OcpPhase::OcpPhase(const Dae& dae)
    : mode(initial_state_of(dae).mode),
      x(dae.num_states()),
      y(dae.num_algebraics()),
      u(dae.num_inputs()),
      start(dae.num_states()),
      end(dae.num_states()) {}

void validate(const Ocp& ocp) {
  if (!ocp.dae) throw std::invalid_argument(ocp.name + ": no Dae");
  if (ocp.phases.empty()) throw std::invalid_argument(ocp.name + ": no phase (expected at least one)");
  for (const OcpPhase& phase : ocp.phases) Checker(ocp, phase).phase(phase);
}

void guess_at(const OcpPhase& phase, double fraction, VectorRef x, VectorRef y, VectorRef u) {
  x.setZero(), y.setZero(), u.setZero();
  if (phase.guess) return phase.guess(fraction, x, y, u);
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const double from = (phase.start.lower[i] + phase.start.upper[i]) / 2, to = (phase.end.lower[i] + phase.end.upper[i]) / 2;
    if (!std::isfinite(from) && !std::isfinite(to)) continue;
    x[i] = std::isfinite(from) ? from : to;
    if (std::isfinite(to)) x[i] += fraction * (to - x[i]);
  }
}

}  // namespace tenon
