#include "tenon/solvers/newton_kkt/front.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "tenon/solvers/newton_kkt/lanes.hpp"
#include "tenon/solvers/newton_kkt/subtract_product.hpp"

namespace tenon {
namespace {

constexpr double kForcedThreshold = 1e-10;   // where columns may not be left over
constexpr double kPerturbation = 1.5e-8;     // sqrt(eps) of (4.5)
constexpr double kAlpha = 0.6403882032022076;  // (2.3)
constexpr double kZero = 64 * std::numeric_limits<double>::epsilon();  // (2.5)
constexpr double kTiny = 1e-150;       // of an equilibrated matrix, and still safe to square
constexpr double kWeakCoupling = 1e12;  // |d11 d22| / d21^2 of a 2x2 pivot
constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr int kBlock = 48;  // columns kept up to date one by one; those behind them are updated in one product

enum class Pivot { none, zero, one, two };

class Elimination {
 public:
  Elimination(Front& front, Inertia& inertia, double threshold)
      : front_(front), inertia_(inertia), threshold_(threshold), block_begin_(front.eliminated) {}

  void run(bool force);

 private:
  Pivot find_pivot(int k);
  double largest_beside(int k, int r);
  void exchange(int p, int q);
  void eliminate_zero(int k);
  void eliminate_one(int k);
  void eliminate_two(int k);
  void perturb(int k);
  void close_column(int k);
  void update_behind_block();

  Front& front_;
  Inertia& inertia_;
  const double threshold_;
  int block_begin_;    // first pivot whose effect on the columns behind the block is outstanding
  int block_end_ = 0;
};

void Elimination::run(bool force) {
  int& k = front_.eliminated;
  block_end_ = std::min(front_.columns, k + kBlock);
  while (true) {
    // candidates k .. end-1; those without a pivot wait at end .. block_end_-1 and are tried again after any success
    int end = block_end_;
    bool progress = true;
    while (progress) {
      progress = false;
      end = block_end_;
      while (k < end) {
        const Pivot pivot = find_pivot(k);
        if (pivot == Pivot::none) {
          exchange(k, --end);
          continue;
        }
        progress = true;
        if (pivot == Pivot::zero) eliminate_zero(k), k += 1;
        if (pivot == Pivot::one) eliminate_one(k), k += 1;
        if (pivot == Pivot::two) eliminate_two(k), k += 2;
        end = std::max(end, k);
      }
      progress = progress && k < block_end_;
    }
    if (block_end_ == front_.columns) {
      if (!force || k == front_.columns) return;
      perturb(k);
      eliminate_one(k);
      ++k;
      continue;
    }
    update_behind_block();
    block_begin_ = k;
    block_end_ = std::min(front_.columns, block_end_ + kBlock);
  }
}

// (4.2) The smaller growth of  g1 = max_i |a_ik| / |a_kk|  and  g2 = max |D^-1| [max_i |a_ik|; max_i |a_ir|],  r the largest partner;
// none where both exceed 1/u. Brings a partner to k+1.
Pivot Elimination::find_pivot(int k) {
  double* a = front_.column(k);
  const double diagonal = std::abs(a[k]);
  const double below = lanes::max_abs(a, k + 1, front_.rows);
  if (!(std::max(diagonal, below) > std::max(kZero * front_.magnitude[k], kTiny))) return Pivot::zero;
  if (diagonal >= kAlpha * below) return Pivot::one;

  const double growth_one = diagonal > 0 ? below / diagonal : kInfinite;
  int r = k;
  double coupling = 0;
  for (int i = k + 1; i < block_end_; ++i) {
    if (std::abs(a[i]) > coupling) coupling = std::abs(a[i]), r = i;
  }
  if (r != k) {
    const double d21 = std::exchange(a[r], 0.0);
    const double beside_k = lanes::max_abs(a, k + 1, front_.rows);
    a[r] = d21;
    const double beside_r = largest_beside(k, r);
    const double t = a[k] / d21;
    const double s = front_.column(r)[r] / d21;
    const double c = 1 / (std::abs(d21) * std::abs(t * s - 1));
    const double growth_two = c * std::max(std::abs(s) * beside_k + beside_r, beside_k + std::abs(t) * beside_r);
    // a coupling far below the diagonal has nothing to offer, and would overflow
    if (std::abs(t * s) < kWeakCoupling && growth_two <= std::min(growth_one, 1 / threshold_)) {
      exchange(k + 1, r);
      return Pivot::two;
    }
  }
  return growth_one <= 1 / threshold_ ? Pivot::one : Pivot::none;
}

// max |a_ir| over rows and columns behind k, but for a_rr.
double Elimination::largest_beside(int k, int r) {
  double largest = lanes::max_abs(front_.column(r), r + 1, front_.rows);
  for (int j = k + 1; j < r; ++j) largest = std::max(largest, std::abs(front_.column(j)[r]));
  return largest;
}

// Exchanges rows and columns p < q of the block: of what is left, and the rows of L. Those of W have done their work there.
void Elimination::exchange(int p, int q) {
  if (p == q) return;
  for (int j = 0; j < p; ++j) std::swap(front_.column(j)[p], front_.column(j)[q]);
  double* a = front_.column(p);
  double* b = front_.column(q);
  std::swap(a[p], b[q]);
  for (int i = p + 1; i < q; ++i) std::swap(a[i], front_.column(i)[q]);
  for (int i = q + 1; i < front_.rows; ++i) std::swap(a[i], b[i]);
  std::swap(front_.ids[p], front_.ids[q]);
  std::swap(front_.magnitude[p], front_.magnitude[q]);
}

void Elimination::close_column(int k) {
  double* a = front_.column(k);
  for (int i = lanes::lane_of<double>(k); i <= k; ++i) a[i] = 0;
}

void Elimination::eliminate_zero(int k) {
  std::fill(front_.column(k) + lanes::lane_of<double>(k), front_.column(k) + front_.stride, 0.0);
  std::fill(front_.unscaled_column(k) + lanes::lane_of<double>(k), front_.unscaled_column(k) + front_.stride, 0.0);
  front_.d_inverse[k] = front_.d_inverse_below[k] = 0;
  ++inertia_.zero;
}

// (4.3) w = a_k,  l = w / d,  A <- A - l w'
void Elimination::eliminate_one(int k) {
  double* l = front_.column(k);
  double* w = front_.unscaled_column(k);
  ++(l[k] > 0 ? inertia_.positive : inertia_.negative);
  const double inverse = 1 / l[k];
  const double below = lanes::max_abs(l, k + 1, front_.rows);
  const lanes::Lane<double> change = lanes::Lane<double>::Constant(below);
  for (int i = lanes::lane_of<double>(k + 1); i < front_.rows; i += lanes::kLanes<double>) {
    lanes::Map<double> column(l + i), magnitude(front_.magnitude + i);
    lanes::Map<double>(w + i) = column;
    column *= inverse;
    magnitude = magnitude.max(column.abs() * change);  // (2.5)
  }
  front_.d_inverse[k] = inverse;
  front_.d_inverse_below[k] = 0;
  for (int j = k + 1; j < block_end_; ++j) lanes::subtract_scaled(w[j], l, front_.column(j), j, front_.rows);
  close_column(k);
}

// (4.4) [w_1 w_2] = [a_1 a_2],  [l_1 l_2] = [w_1 w_2] D^-1,  A <- A - l_1 w_1' - l_2 w_2'
void Elimination::eliminate_two(int k) {
  double* l1 = front_.column(k);
  double* l2 = front_.column(k + 1);
  double* w1 = front_.unscaled_column(k);
  double* w2 = front_.unscaled_column(k + 1);
  const double d21 = l1[k + 1];
  const double t = l1[k] / d21;
  const double s = l2[k + 1] / d21;
  const double c = 1 / (d21 * (t * s - 1));
  if (t * s < 1) {
    ++inertia_.positive, ++inertia_.negative;
  } else {
    (l1[k] > 0 ? inertia_.positive : inertia_.negative) += 2;
  }
  front_.d_inverse[k] = s * c;
  front_.d_inverse[k + 1] = t * c;
  front_.d_inverse_below[k] = -c;
  front_.d_inverse_below[k + 1] = 0;

  const double below1 = lanes::max_abs(l1, k + 2, front_.rows);
  const double below2 = lanes::max_abs(l2, k + 2, front_.rows);
  const lanes::Lane<double> change1 = lanes::Lane<double>::Constant(below1);
  const lanes::Lane<double> change2 = lanes::Lane<double>::Constant(below2);
  for (int i = lanes::lane_of<double>(k + 2); i < front_.rows; i += lanes::kLanes<double>) {
    lanes::Map<double> column1(l1 + i), column2(l2 + i), magnitude(front_.magnitude + i);
    const lanes::Lane<double> a1 = column1, a2 = column2;
    lanes::Map<double>(w1 + i) = a1;
    lanes::Map<double>(w2 + i) = a2;
    column1 = (a1 * s - a2) * c;
    column2 = (a2 * t - a1) * c;
    magnitude = magnitude.max(column1.abs() * change1 + column2.abs() * change2);  // (2.5)
  }
  for (int j = k + 2; j < block_end_; ++j) lanes::subtract_scaled(w1[j], l1, w2[j], l2, front_.column(j), j, front_.rows);
  l1[k + 1] = 0;
  close_column(k);
  close_column(k + 1);
}

// (4.5) The pivot grows to sqrt(eps) of its column. Counted as a zero eigenvalue, in the place of the sign that eliminate_one will count.
void Elimination::perturb(int k) {
  double* a = front_.column(k);
  const double size = kPerturbation * std::max(lanes::max_abs(a, k + 1, front_.rows), front_.magnitude[k]);
  a[k] = a[k] < 0 ? -size : size;
  --(a[k] > 0 ? inertia_.positive : inertia_.negative);
  ++inertia_.zero;
}

void Elimination::update_behind_block() {
  if (block_begin_ == front_.eliminated) return;
  subtract_product(front_.column(block_begin_) + block_end_, front_.unscaled_column(block_begin_) + block_end_, front_.stride,
                   front_.eliminated - block_begin_, front_.column(block_end_) + block_end_, front_.stride, front_.columns - block_end_,
                   front_.rows - block_end_);
}

}  // namespace

void eliminate_stable(Front& front, Inertia& inertia, double threshold) { Elimination(front, inertia, threshold).run(false); }

void eliminate_rest(Front& front, Inertia& inertia) { Elimination(front, inertia, kForcedThreshold).run(true); }

}  // namespace tenon
