// The stage-structured kind: the inertia that the eigenvalues give, the solutions of the dense matrix, nothing allocated, and an effort
// that grows with the horizon and no faster, whatever the stages are.
#include "tenon/solvers/newton_kkt/stage_kkt.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "tenon/tests/allocation_counter.hpp"
#include "tenon/tests/stage_systems.hpp"

namespace tenon {
namespace {

Inertia inertia_by_eigenvalues(const Eigen::MatrixXd& k) {
  Inertia inertia;
  const Vector eigenvalues = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(k, Eigen::EigenvaluesOnly).eigenvalues();
  const double zero = 1e-12 * eigenvalues.cwiseAbs().maxCoeff();
  for (const double value : eigenvalues) ++(std::abs(value) <= zero ? inertia.zero : value > 0 ? inertia.positive : inertia.negative);
  return inertia;
}

std::vector<StageShape> shapes() {
  return {
      {.intervals = 4},
      {.intervals = 6, .states = 4, .inputs = 1},
      {.intervals = 5, .states = 6, .inputs = 3, .inequalities = 2},
      {.intervals = 5, .states = 5, .inputs = 7},
      {.intervals = 4, .globals = 1},
      {.intervals = 4, .states = 4, .inputs = 1, .globals = 2, .inequalities = 1},
      {.intervals = 5, .equalities = 1},
      {.intervals = 5, .globals = 1, .equalities = 1, .inequalities = 1},
      {.intervals = 4, .implicit = true},
      {.intervals = 4, .globals = 1, .equalities = 1, .implicit = true},
      {.intervals = 4, .slacks = 2},
      {.intervals = 4, .states = 4, .inequalities = 2, .slacks = 5},
      {.intervals = 4, .globals = 1, .equalities = 2, .slacks = 3},
      {.intervals = 1, .states = 2, .inputs = 1},
      {.intervals = 3, .states = 1, .inputs = 1},
  };
}

template <class Change>
void for_each_instance(Change change) {
  for (StageShape shape : shapes()) {
    for (unsigned seed = 1; seed <= 5; ++seed) {
      for (const bool indefinite : {false, true}) {
        shape.indefinite = indefinite;
        StageGenerator generator(seed);
        StageInstance instance = generator.make(shape);
        SCOPED_TRACE(testing::Message() << "N = " << shape.intervals << ", nx = " << shape.states << ", nu = " << shape.inputs
                                        << ", globals " << shape.globals << ", equalities " << shape.equalities << ", inequalities "
                                        << shape.inequalities << (shape.implicit ? ", implicit" : "") << (indefinite ? ", indefinite" : "")
                                        << ", seed " << seed);
        change(instance, shape, generator);
      }
    }
  }
}

template <class Kkt = StageKkt<>>
void expect_conforms(const StageInstance& instance, StageGenerator& generator) {
  const Eigen::MatrixXd k = instance.matrix();
  Kkt kkt(instance.stages, instance.hessian_pattern, instance.jacobian_pattern);
  for (int repeat = 0; repeat < 2; ++repeat) {  // a second factorisation finds nothing of the first
    const Vector r_x = generator.normal_vector(instance.n), r_c = generator.normal_vector(instance.m);
    Vector dx(instance.n), dlambda(instance.m);
    AllocationCounter counter;
    const Inertia inertia = kkt.factor(instance.hessian, instance.jacobian, instance.sigma, instance.d);
    kkt.solve(r_x, r_c, dx, dlambda);
    EXPECT_EQ(counter.count(), 0);
    EXPECT_EQ(inertia, inertia_by_eigenvalues(k)) << inertia.positive << " " << inertia.negative << " " << inertia.zero;
    Vector solution(instance.n + instance.m), r(instance.n + instance.m);
    solution << dx, dlambda;
    r << r_x, r_c;
    EXPECT_LE((k * solution - r).lpNorm<Eigen::Infinity>(),
              1e-11 * (r.lpNorm<Eigen::Infinity>() + k.cwiseAbs().maxCoeff() * solution.lpNorm<Eigen::Infinity>()));
  }
}

TEST(StageKkt, GivesTheInertiaAndTheSolutionOfTheDenseMatrix) {
  for_each_instance(
      [](const StageInstance& instance, const StageShape&, StageGenerator& generator) { expect_conforms(instance, generator); });
}

TEST(StageKkt, GivesTheSameWithCompliantRows) {
  for_each_instance([](StageInstance& instance, const StageShape&, StageGenerator& generator) {
    for (double& d : instance.d) d = std::pow(10, 6 * generator.uniform() - 6);
    expect_conforms(instance, generator);
  });
}

TEST(StageKkt, GivesTheSameWithoutCurvatureInTheInputs) {
  for_each_instance([](StageInstance& instance, const StageShape& shape, StageGenerator& generator) {
    if (shape.equalities > 0 || shape.inputs > shape.states) return;
    const int size = shape.states + shape.inputs;
    for (int k = 0; k < shape.intervals; ++k) {
      for (int j = size * k + shape.states; j < size * (k + 1); ++j) {
        for (SparseMatrix::InnerIterator entry(instance.hessian, j); entry; ++entry) entry.valueRef() = 0;
      }
    }
    expect_conforms(instance, generator);
  });
}

TEST(StageKkt, HoldsFixedVariablesWhereverTheyAre) {
  for_each_instance([](StageInstance& instance, const StageShape& shape, StageGenerator& generator) {
    if (shape.equalities > 0 || shape.inputs < 2) return;
    const int size = shape.states + shape.inputs;
    std::vector<int> fixed = {shape.states, size + shape.states + 1};  // two inputs, the first state, half of the last one
    for (int i = 0; i < shape.states; ++i) fixed.push_back(i);
    for (int i = 0; i < shape.states / 2; ++i) fixed.push_back(size * shape.intervals + i);
    if (shape.globals > 0) fixed.push_back(instance.stages.globals.end - 1);
    for (const int i : fixed) instance.sigma[i] = 1e30;

    // the same with identity rows in their places
    Eigen::MatrixXd k = instance.matrix();
    const Vector r_c = generator.normal_vector(instance.m);
    Vector r_x = generator.normal_vector(instance.n);
    for (const int i : fixed) {
      k.row(i).setZero(), k.col(i).setZero();
      k(i, i) = 1, r_x[i] = 0;
    }
    StageKkt<> kkt(instance.stages, instance.hessian_pattern, instance.jacobian_pattern);
    EXPECT_EQ(kkt.factor(instance.hessian, instance.jacobian, instance.sigma, instance.d), inertia_by_eigenvalues(k));
    Vector solution(instance.n + instance.m), r(instance.n + instance.m), dx(instance.n), dlambda(instance.m);
    kkt.solve(r_x, r_c, dx, dlambda);
    solution << dx, dlambda;
    r << r_x, r_c;
    EXPECT_LE((k * solution - r).lpNorm<Eigen::Infinity>(),
              1e-11 * (r.lpNorm<Eigen::Infinity>() + k.cwiseAbs().maxCoeff() * solution.lpNorm<Eigen::Infinity>()));
    for (const int i : fixed) EXPECT_EQ(dx[i], 0);
  });
}

TEST(StageKkt, ReportsAZeroEigenvalueForADependentRowAndSurvivesIt) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    StageGenerator generator(seed);
    StageInstance instance = generator.make({.intervals = 5, .states = 3, .inputs = 3, .equalities = 2});
    const int row = 2 * 5 + 3;  // of stage 2: its second equality becomes twice the first
    for (int j = 0; j < instance.n; ++j) {
      for (SparseMatrix::InnerIterator entry(instance.jacobian, j); entry; ++entry) {
        if (entry.row() == row + 1) entry.valueRef() = 2 * instance.jacobian.coeff(row, j);
      }
    }
    StageKkt<> kkt(instance.stages, instance.hessian_pattern, instance.jacobian_pattern);
    EXPECT_EQ(kkt.factor(instance.hessian, instance.jacobian, instance.sigma, instance.d), inertia_by_eigenvalues(instance.matrix()));
    Vector dx(instance.n), dlambda(instance.m);
    kkt.solve(generator.normal_vector(instance.n), generator.normal_vector(instance.m), dx, dlambda);
    EXPECT_TRUE(dx.allFinite() && dlambda.allFinite());
    instance.d.setConstant(1e-6);
    expect_conforms(instance, generator);
  }
}

TEST(StageKkt, IsOfConstantSizeWhereTheStagesAre) {
  for (const auto& [indefinite, inequalities] : {std::pair{false, 0}, {true, 0}, {false, 2}, {true, 5}}) {
    StageGenerator generator(3);
    const StageInstance instance =
        generator.make({.intervals = 6, .states = 6, .inputs = 3, .inequalities = inequalities, .indefinite = indefinite});
    StageKkt<StageSizes<6, 3>> fixed(instance.stages, instance.hessian_pattern, instance.jacobian_pattern);
    StageKkt<> dynamic(instance.stages, instance.hessian_pattern, instance.jacobian_pattern);
    expect_conforms<StageKkt<StageSizes<6, 3>>>(instance, generator);
    const Vector r_x = generator.normal_vector(instance.n), r_c = generator.normal_vector(instance.m);
    Vector dx[2] = {Vector(instance.n), Vector(instance.n)}, dlambda[2] = {Vector(instance.m), Vector(instance.m)};
    EXPECT_EQ(fixed.factor(instance.hessian, instance.jacobian, instance.sigma, instance.d),
              dynamic.factor(instance.hessian, instance.jacobian, instance.sigma, instance.d));
    fixed.solve(r_x, r_c, dx[0], dlambda[0]);
    dynamic.solve(r_x, r_c, dx[1], dlambda[1]);
    EXPECT_EQ(dx[0], dx[1]);  // the same operations in the same order
    EXPECT_EQ(dlambda[0], dlambda[1]);
  }
}

TEST(StageKkt, TakesAFrontOnlyWhereAStageIsNotRegularHoweverLongTheHorizon) {
  for (const int intervals : {10, 20, 40, 80}) {
    StageGenerator generator(5);
    StageInstance instance = generator.make({.intervals = intervals, .states = 4, .inputs = 2});
    StageKkt<> kkt(instance.stages, instance.hessian_pattern, instance.jacobian_pattern);
    EXPECT_EQ(kkt.factor(instance.hessian, instance.jacobian, instance.sigma, instance.d).zero, 0);
    EXPECT_EQ(kkt.fronts(), 0) << intervals;
    instance.sigma.tail(4).setConstant(1e30);  // the end is prescribed: two stages steer four states there
    EXPECT_EQ(kkt.factor(instance.hessian, instance.jacobian, instance.sigma, instance.d).zero, 0);
    EXPECT_LE(kkt.fronts(), 3) << intervals;
  }
}

TEST(StageKkt, RefusesAMatrixThatIsNotFinite) {
  StageGenerator generator(1);
  StageInstance instance = generator.make({});
  StageKkt<> kkt(instance.stages, instance.hessian_pattern, instance.jacobian_pattern);
  instance.hessian.coeffRef(0, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(kkt.factor(instance.hessian, instance.jacobian, instance.sigma, instance.d), (Inertia{0, 0, instance.n + instance.m}));
}

TEST(StageKkt, RefusesStagesThatDoNotFitThePatterns) {
  StageGenerator generator(1);
  const StageInstance instance = generator.make({.intervals = 4});
  const auto make = [&](const Stages& stages) { StageKkt<>(stages, instance.hessian_pattern, instance.jacobian_pattern); };
  EXPECT_NO_THROW(make(instance.stages));
  Stages left_out = instance.stages;
  left_out.stages.back().variables.end -= 1;
  EXPECT_THROW(make(left_out), std::invalid_argument);
  Stages too_far = instance.stages;  // the first stage's last input becomes the third stage's
  std::swap(too_far.stages[0].variables, too_far.stages[2].variables);
  EXPECT_THROW(make(too_far), std::invalid_argument);
  Stages beyond = instance.stages;
  beyond.stages.back().variables.end += 1;
  EXPECT_THROW(make(beyond), std::invalid_argument);
}

}  // namespace
}  // namespace tenon
