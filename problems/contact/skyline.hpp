// A = L D L' of a symmetric matrix whose rows begin late: the envelope method. Row i is kept from column first(i) on, and so is L's.
//
// For the rows H M^-1 H' of a chain, sorted by their bodies, the cost is linear in the chain's length.
// Source: A. George, J. W. H. Liu, Computer Solution of Large Sparse Positive Definite Systems (1981), ch. 4.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "tenon/core/eigen.hpp"

namespace tenon::contact {

class Skyline {
 public:
  void reserve(int n) {
    first_.reserve(static_cast<std::size_t>(n));
    begin_.reserve(static_cast<std::size_t>(n) + 1);
    values_.reserve(static_cast<std::size_t>(n) * 8);
  }

  void clear() {
    first_.clear();
    values_.clear();
    begin_.assign(1, 0);
  }

  /// Appends a row of zeros with its entries from column `first` to the diagonal.
  void add_row(int first) {
    first_.push_back(first);
    values_.resize(values_.size() + static_cast<std::size_t>(size() - first), 0.0);
    begin_.push_back(static_cast<int>(values_.size()));
  }

  int size() const { return static_cast<int>(first_.size()); }
  int first(int i) const { return first_[static_cast<std::size_t>(i)]; }
  /// Entry (i, j), first(i) <= j <= i.
  double& operator()(int i, int j) { return values_[static_cast<std::size_t>(begin_[static_cast<std::size_t>(i)] + j - first(i))]; }
  double operator()(int i, int j) const { return const_cast<Skyline&>(*this)(i, j); }

  /// In place. Returns the number of pivots that fell below `tolerance` of their diagonal entry: the rank's defect. Those rows are given a
  /// pivot of infinity, which makes their unknown 0.
  int factorise(double tolerance) {
    int defect = 0;
    for (int i = 0; i < size(); ++i) {
      const double diagonal = (*this)(i, i);
      for (int j = first(i); j < i; ++j) {
        double sum = (*this)(i, j);
        for (int k = std::max(first(i), first(j)); k < j; ++k) sum -= (*this)(i, k) * (*this)(j, k);
        (*this)(i, j) = sum;  // L_ij d_j until the row is done
      }
      double pivot = diagonal;
      for (int j = first(i); j < i; ++j) {
        const double l = (*this)(i, j) / (*this)(j, j);
        pivot -= l * (*this)(i, j);
        (*this)(i, j) = l;
      }
      const bool is_singular = !(pivot > tolerance * diagonal);
      defect += is_singular;
      (*this)(i, i) = is_singular ? std::numeric_limits<double>::infinity() : pivot;
    }
    return defect;
  }

  void solve(VectorRef b) const {
    for (int i = 0; i < size(); ++i) {
      for (int j = first(i); j < i; ++j) b[i] -= (*this)(i, j) * b[j];
    }
    for (int i = 0; i < size(); ++i) b[i] /= (*this)(i, i);
    for (int i = size() - 1; i >= 0; --i) {
      for (int j = first(i); j < i; ++j) b[j] -= (*this)(i, j) * b[i];
    }
  }

 private:
  std::vector<int> first_, begin_{0};
  std::vector<double> values_;
};

}  // namespace tenon::contact
