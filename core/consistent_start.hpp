// Consistent xdot and y at given t, x, u: Newton's method on F, with its own diagnosis of the index.
//
//     A [dxdot; dy] = -F,      A = [dF/dxdot, dF/dy]
//
// A is regular where the Dae is of index 1. Where it is not, the rows that hang together are named: those with weight in the left null
// vector of A, w'A = 0. Source: U. M. Ascher, L. R. Petzold, Computer Methods for ODEs and DAEs, SIAM (1998), sec. 9.2 and 10.1.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tenon/core/dae.hpp"

namespace tenon {

struct IndexDiagnosis {
  int size = 0;                   // nx + ny
  int rank = 0;                   // of A; less than size where the index is above 1
  std::vector<std::string> rows;  // those in the left null space of A, by the names of their variables
  std::string text() const;
};

class ConsistentStart {
 public:
  /// The Dae must outlive it. Analyses the pattern once.
  explicit ConsistentStart(const Dae& dae);
  ~ConsistentStart();

  /// Finds state.xdot and state.y, starting from those that stand there; false where Newton's method fails.
  bool solve(DaeState& state, Dae::Workspace& workspace);

  /// Rank of A at this state by a singular value decomposition: for small systems and for those who ask why.
  IndexDiagnosis diagnose(const DaeState& state, Dae::Workspace& workspace);

 private:
  void evaluate(const DaeState& state, Dae::Workspace& workspace);

  const Dae& dae_;
  SparsePattern pattern_;
  std::vector<double> with_alpha_, without_;  // Jacobian at alpha = 1 and 0: their difference is dF/dxdot
  SparseMatrix A_;
  struct Factorisation;
  std::unique_ptr<Factorisation> lu_;
  Vector F_, step_;
};

/// F = 0 solved for (xdot, y) in the way the Dae has: its own direct solve, else Newton's method. False where that is not possible.
bool make_consistent(const Dae& dae, ConsistentStart& newton, DaeState& state, Dae::Workspace& workspace);

}  // namespace tenon
