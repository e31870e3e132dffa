// Conformance of the KKT kinds: whatever the kind, factor() gives the inertia that the eigenvalues give, solve() is backward stable row
// by row, and neither allocates.
#include "tenon/solvers/newton_kkt/dense_kkt.hpp"
#include "tenon/solvers/newton_kkt/sparse_kkt.hpp"
#include "tenon/tests/allocation_counter.hpp"
#include "tenon/tests/kkt_instances.hpp"

#include <optional>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

namespace tenon {
namespace {

// Inertia by the eigenvalues of S K S, equilibrated so that 1e30 and 1e-8 can stand in one matrix. None where an eigenvalue is neither
// zero nor clearly not.
std::optional<Inertia> inertia_by_eigenvalues(Eigen::MatrixXd k) {
  for (int sweep = 0; sweep < 10; ++sweep) {
    const Vector scale = k.cwiseAbs().rowwise().maxCoeff().unaryExpr([](double x) { return x > 0 ? 1 / std::sqrt(x) : 1.0; });
    k = scale.asDiagonal() * k * scale.asDiagonal();
  }
  Inertia inertia;
  const Vector eigenvalues = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(k, Eigen::EigenvaluesOnly).eigenvalues();
  for (double value : eigenvalues) {
    if (std::abs(value) > 1e-15 && std::abs(value) < 1e-11) return std::nullopt;
    ++(std::abs(value) <= 1e-15 ? inertia.zero : value > 0 ? inertia.positive : inertia.negative);
  }
  return inertia;
}

std::string text(const Inertia& inertia) {
  return "(" + std::to_string(inertia.positive) + ", " + std::to_string(inertia.negative) + ", " + std::to_string(inertia.zero) + ")";
}

template <class Kkt, class HessianType, class JacobianType>
void expect_solves(Kkt& kkt, const HessianType& hessian, const JacobianType& jacobian, const KktInstance& instance,
                   const std::string& kind) {
  const Eigen::MatrixXd k = instance.matrix();
  const std::optional<Inertia> expected = inertia_by_eigenvalues(k);
  KktGenerator generator(7);
  for (int repeat = 0; repeat < 2; ++repeat) {  // a second factorisation finds nothing of the first
    const Vector r = generator.normal_vector(instance.n + instance.m);
    const Vector r_x = r.head(instance.n);
    const Vector r_c = r.tail(instance.m);
    Vector dx(instance.n), dlambda(instance.m);
    AllocationCounter counter;
    const Inertia inertia = kkt.factor(hessian, jacobian, instance.sigma, instance.d);
    const double relative_residual = kkt.solve(r_x, r_c, dx, dlambda);
    const long allocations = counter.count();
    EXPECT_EQ(allocations, 0) << kind << ", " << instance.name;
    EXPECT_TRUE(dx.allFinite() && dlambda.allFinite()) << kind << ", " << instance.name;
    // a singular matrix shows in its pivots or, rarely, in the residual alone; so does one of which the eigenvalues do not say what it is
    const bool regular = expected && expected->zero == 0;
    if (!regular && inertia.zero == 0 && relative_residual > 1e-4) continue;
    if (expected) {
      EXPECT_EQ(inertia, *expected) << kind << ", " << instance.name << ": " << text(inertia) << " for " << text(*expected);
    }
    if (inertia.zero > 0) continue;
    Vector solution(instance.n + instance.m);
    solution << dx, dlambda;
    const Vector error = (k * solution - r).cwiseAbs();
    const Vector allowed = 1e-12 * (k.cwiseAbs() * solution.cwiseAbs() + r.cwiseAbs());
    EXPECT_LE((error.array() / allowed.array()).maxCoeff(), 1) << kind << ", " << instance.name;
  }
}

void expect_conforms(const KktInstance& instance) {
  SCOPED_TRACE(instance.name + ", n = " + std::to_string(instance.n) + ", m = " + std::to_string(instance.m));
  const Eigen::MatrixXd hessian = instance.hessian;
  const Eigen::MatrixXd jacobian = instance.jacobian;
  DenseKkt<double, Dynamic, Dynamic> dynamic(instance.n, instance.m);
  expect_solves(dynamic, hessian, jacobian, instance, "dense");
  SparseKkt sparse(instance.hessian_pattern, instance.jacobian_pattern);
  expect_solves(sparse, instance.hessian, instance.jacobian, instance, "sparse");
  if (instance.n == 12 && instance.m == 6) {
    DenseKkt<double, 12, 6> fixed;
    expect_solves(fixed, Eigen::Matrix<double, 12, 12>(hessian), Eigen::Matrix<double, 6, 12>(jacobian), instance, "dense 12 + 6");
  }
}

struct Shape {
  int n, m;
  Structure structure;
};

std::vector<Shape> shapes() {
  std::vector<Shape> shapes;
  for (auto [n, m] : {std::pair(1, 0), {1, 1}, {2, 1}, {5, 0}, {12, 6}, {30, 29}, {60, 20}}) shapes.push_back({n, m, Structure::dense});
  for (Structure structure : {Structure::random, Structure::banded, Structure::arrow}) {
    for (auto [n, m] : {std::pair(20, 10), {100, 60}, {200, 0}, {120, 119}}) shapes.push_back({n, m, structure});
  }
  return shapes;
}

// Runs `change` on a convex instance of every shape, three seeds each.
template <class Change>
void for_each_instance(const std::string& name, Change change) {
  for (const Shape& shape : shapes()) {
    for (unsigned seed = 1; seed <= 3; ++seed) {
      KktGenerator generator(seed);
      KktInstance instance = generator.convex(shape.n, shape.m, shape.structure);
      instance.name = name;
      if (change(instance, generator)) expect_conforms(instance);
    }
  }
}

TEST(KktKinds, SolveAConvexQuadraticProgram) {
  for_each_instance("convex", [](KktInstance&, KktGenerator&) { return true; });
}

TEST(KktKinds, CountTheEigenvaluesOfAnIndefiniteHessian) {
  for_each_instance("indefinite", [](KktInstance& instance, KktGenerator& generator) {
    for (int j = 0; j < instance.n; ++j) instance.hessian.coeffRef(j, j) = generator.normal();
    return true;
  });
}

TEST(KktKinds, SolveALinearProgramNearItsVertex) {
  for_each_instance("H = 0", [](KktInstance& instance, KktGenerator& generator) {
    instance.hessian *= 0;
    for (double& sigma : instance.sigma) sigma = std::pow(10.0, generator.uniform(-9, 9));
    return true;
  });
}

TEST(KktKinds, SolveWhereEveryDiagonalEntryIsZero) {
  for_each_instance("zero diagonal", [](KktInstance& instance, KktGenerator&) {
    for (int j = 0; j < instance.n; ++j) instance.hessian.coeffRef(j, j) = 0;
    return instance.n > 1 || instance.m == 1;
  });
}

TEST(KktKinds, ReportAZeroEigenvalueForADependentHardRow) {
  for_each_instance("dependent rows", [](KktInstance& instance, KktGenerator&) {
    if (instance.m < 2) return false;
    // the last row becomes twice the first, within the pattern of both
    std::vector<std::pair<int, int>> entries;
    for (int j = 0; j < instance.n; ++j) {
      for (SparseMatrix::InnerIterator entry(instance.jacobian, j); entry; ++entry) {
        entries.emplace_back(entry.row(), j);
        if (entry.row() == 0) entries.emplace_back(instance.m - 1, j);
      }
    }
    instance.jacobian_pattern = SparsePattern::from_entries(instance.m, instance.n, std::move(entries));
    SparseMatrix jacobian = instance.jacobian_pattern.zero_matrix();
    for (int j = 0; j < instance.n; ++j) {
      for (SparseMatrix::InnerIterator entry(jacobian, j); entry; ++entry) {
        entry.valueRef() = entry.row() == instance.m - 1 ? 2 * instance.jacobian.coeff(0, j) : instance.jacobian.coeff(entry.row(), j);
      }
    }
    instance.jacobian = jacobian;
    expect_conforms(instance);
    SparseKkt sparse(instance.hessian_pattern, instance.jacobian_pattern);
    EXPECT_EQ(sparse.factor(instance.hessian, instance.jacobian, instance.sigma, instance.d).zero, 1);
    instance.name = "dependent rows, D = 1e-8";
    instance.d.setConstant(1e-8);
    return true;
  });
}

TEST(KktKinds, ReportAZeroEigenvalueForAVariableThatNothingHolds) {
  for_each_instance("an empty column", [](KktInstance& instance, KktGenerator&) {
    if (instance.m > 0 && 2 * instance.m >= instance.n) return false;
    const int free = instance.n / 2;
    for (int j = 0; j < instance.n; ++j) {
      for (SparseMatrix::InnerIterator entry(instance.hessian, j); entry; ++entry) {
        if (entry.row() == free || j == free) entry.valueRef() = 0;
      }
    }
    for (SparseMatrix::InnerIterator entry(instance.jacobian, free); entry; ++entry) entry.valueRef() = 0;
    return true;
  });
}

TEST(KktKinds, HoldAFixedVariableWithSigmaOf1e30) {
  for_each_instance("sigma = 1e30", [](KktInstance& instance, KktGenerator&) {
    // not a row's own variable: with all its variables fixed a hard row has no multiplier
    std::vector<bool> own(static_cast<std::size_t>(instance.n), false);
    for (int i = 0; i < instance.m; ++i) own[static_cast<std::size_t>(i * instance.n / instance.m)] = true;
    for (int j = 0; j < instance.n; j += 3) {
      if (!own[static_cast<std::size_t>(j)]) instance.sigma[j] = 1e30;
    }
    return true;
  });
}

TEST(KktKinds, SolveABadlyScaledSystem) {
  for_each_instance("badly scaled", [](KktInstance& instance, KktGenerator& generator) {
    Vector x_scale(instance.n), c_scale(instance.m);
    for (double& scale : x_scale) scale = std::pow(10.0, generator.uniform(-4, 4));
    for (double& scale : c_scale) scale = std::pow(10.0, generator.uniform(-4, 4));
    for (int j = 0; j < instance.n; ++j) {
      for (SparseMatrix::InnerIterator entry(instance.hessian, j); entry; ++entry) entry.valueRef() *= x_scale[entry.row()] * x_scale[j];
      for (SparseMatrix::InnerIterator entry(instance.jacobian, j); entry; ++entry) entry.valueRef() *= c_scale[entry.row()] * x_scale[j];
    }
    return true;
  });
}

TEST(KktKinds, SolveWithCompliantRows) {
  for_each_instance("compliant rows", [](KktInstance& instance, KktGenerator& generator) {
    for (double& d : instance.d) d = std::pow(10.0, generator.uniform(-8, 4));
    for (double& sigma : instance.sigma) sigma = std::pow(10.0, generator.uniform(-8, 8));
    return true;
  });
}

TEST(KktKinds, RefuseAMatrixThatIsNotFinite) {
  for_each_instance("not a number", [](KktInstance& instance, KktGenerator&) {
    instance.hessian.coeffRef(instance.n - 1, instance.n - 1) = std::numeric_limits<double>::quiet_NaN();
    DenseKkt<double, Dynamic, Dynamic> dense(instance.n, instance.m);
    EXPECT_EQ(dense.factor(Eigen::MatrixXd(instance.hessian), Eigen::MatrixXd(instance.jacobian), instance.sigma, instance.d).zero,
              instance.n + instance.m);
    SparseKkt sparse(instance.hessian_pattern, instance.jacobian_pattern);
    EXPECT_EQ(sparse.factor(instance.hessian, instance.jacobian, instance.sigma, instance.d).zero, instance.n + instance.m);
    return false;
  });
}

TEST(MultifrontalLdlt, TakesPivotsAsTheyAreWhereThereIsNoRoomToDelayThem) {
  int perturbed = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    KktGenerator generator(seed);
    const KktInstance instance = generator.convex(150, 0, Structure::random);
    SparseMatrix matrix = instance.hessian;  // with a zero diagonal hardly a column has a pivot of its own
    for (int j = 0; j < instance.n; ++j) matrix.coeffRef(j, j) = 0;
    const Vector r = generator.normal_vector(instance.n);
    for (std::size_t least : {0, 100, 1000}) {
      MultifrontalLdlt ldlt(instance.hessian_pattern, instance.n, {.times = 0, .least = least});
      const Inertia inertia = ldlt.factor(matrix.valuePtr());
      Vector x = r;
      ldlt.solve_in_place(x.data());
      EXPECT_EQ(inertia.positive + inertia.negative + inertia.zero, instance.n);
      EXPECT_TRUE(x.allFinite());
      perturbed += inertia.zero;
    }
  }
  EXPECT_GT(perturbed, 0);
}

}  // namespace
}  // namespace tenon
