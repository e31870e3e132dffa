// The pole between soft walls by exhaustive search: every sequence of contact modes over the horizon is a convex quadratic program in the
// inputs, and the best of them all is the plan. No solver of the project is in it.
//
//     mode 0: |p_k| <= w, free;   1: p_k >= w;   2: p_k <= -w;      x_{k+1} = (A + [mode] k D tip') x_k + B u_k -+ [mode] k w D
#pragma once

#include <array>
#include <cmath>
#include <limits>

#include "tenon/core/nonnegative_least_squares.hpp"
#include "tenon/problems/soft_walls/model.hpp"

namespace tenon::soft_walls {

class ExhaustiveSearch {
 public:
  ExhaustiveSearch(const Model& model, const Weights& weights, int intervals)
      : model_(model), weights_(weights), n_(intervals), terminal_(riccati_solution(model, weights)) {}

  /// The first input of the best plan from x.
  double command(const State& x) {
    best_ = std::numeric_limits<double>::infinity();
    inputs_.setZero(n_);
    Node root;
    root.response.setZero(4, n_);
    root.free = x;
    root.hessian = 2 * weights_.input * Eigen::MatrixXd::Identity(n_, n_);
    root.gradient.setZero(n_);
    descend(0, root);
    return inputs_[0];
  }

  double best_objective() const { return best_; }

 private:
  /// Up to some stage: x_k = response u + free, the objective u' hessian u / 2 + gradient' u + constant, and rows u <= limits.
  struct Node {
    Eigen::MatrixXd response;
    State free;
    Eigen::MatrixXd hessian;
    Vector gradient;
    double constant = 0;
    Eigen::MatrixXd rows;
    Vector limits;

    void add_cost(const Eigen::Matrix4d& weight) {
      hessian += 2 * response.transpose() * weight * response;
      gradient += 2 * response.transpose() * (weight * free);
      constant += free.dot(weight * free);
    }
    void add_row(const Eigen::RowVectorXd& row, double limit) {
      rows.conservativeResize(rows.rows() + 1, row.size());
      limits.conservativeResize(rows.rows());
      rows.bottomRows(1) = row;
      limits[rows.rows() - 1] = limit;
    }
  };

  void descend(int k, Node node) {
    if (k == n_) {
      node.add_cost(terminal_);
      solve(node);
      return;
    }
    node.add_cost(Eigen::Matrix4d(weights_.state.asDiagonal()));
    const double wall = model_.parameters().wall, stiffness = model_.parameters().stiffness, tip = model_.tip().dot(node.free);
    const Eigen::RowVectorXd moves = model_.tip().transpose() * node.response;
    for (const int side : {0, 1, -1}) {
      if (k == 0 && side != (tip > wall ? 1 : tip < -wall ? -1 : 0)) continue;  // where the start is, is given
      Node next = node;
      if (k > 0 && side == 0) next.add_row(moves, wall - tip);
      if (k > 0 && side <= 0) next.add_row(side == 0 ? Eigen::RowVectorXd(-moves) : moves, side == 0 ? wall + tip : -wall - tip);
      if (k > 0 && side > 0) next.add_row(-moves, tip - wall);
      Eigen::Matrix4d a = model_.a();
      State constant = State::Zero();
      if (side != 0) {
        a += stiffness * model_.d() * model_.tip().transpose();
        constant = -side * stiffness * wall * model_.d();
      }
      next.response = a * node.response;
      next.response.col(k) += model_.b();
      next.free = a * node.free + constant;
      descend(k + 1, std::move(next));
    }
  }

  // With H = L L', u = u_0 + L^-T v the program is  min |v|^2/2  s.t.  C v >= d,  by least distance programming [LH74, chapter 23].
  void solve(const Node& node) {
    const Eigen::LLT<Eigen::MatrixXd> factor(node.hessian);
    const Vector free = -factor.solve(node.gradient);
    const double lowest = node.constant + node.gradient.dot(free) / 2;
    if (lowest >= best_) return;
    if (node.rows.rows() == 0 || (node.rows * free - node.limits).maxCoeff() <= 0) {
      best_ = lowest;
      inputs_ = free;
      return;
    }
    const Eigen::MatrixXd c = -factor.matrixL().solve(node.rows.transpose()).transpose();
    const Vector d = node.rows * free - node.limits;
    Eigen::MatrixXd columns(n_ + 1, d.size());
    columns << c.transpose(), d.transpose();
    for (Eigen::Index j = 0; j < columns.cols(); ++j) columns.col(j).normalize();
    const Vector target = Vector::Unit(n_ + 1, n_);
    const Vector residual = columns * nonnegative_least_squares(columns, target) - target;
    if (std::abs(residual[n_]) < 1e-12) return;  // no input meets the rows
    const Vector v = -residual.head(n_) / residual[n_];
    if ((c * v - d).minCoeff() < -1e-7 * (1 + d.lpNorm<Eigen::Infinity>())) return;
    if (lowest + v.squaredNorm() / 2 >= best_) return;
    best_ = lowest + v.squaredNorm() / 2;
    inputs_ = free + factor.matrixU().solve(v);
  }

  Model model_;
  Weights weights_;
  int n_;
  Eigen::Matrix4d terminal_;
  double best_ = 0;
  Vector inputs_;
};

}  // namespace tenon::soft_walls
