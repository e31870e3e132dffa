// A .nl problem evaluated by the AMPL solver library (ASL).
//
//     here:  L = sigma f + lambda' c      AMPL:  its multiplier of a row is the rate at which the best f changes with the row's bound,
//                                                -lambda where f is minimised, +lambda where it is maximised (we then minimise -f)
//
// The library keeps the values of all expressions at one x inside its own object, which is thus the one workspace of all evaluations: they
// give the same numbers in any order, but not from two threads at once. Three of its ways are minded here: it believes what it reads (so
// the scan comes first), it ends the program where an evaluation fails unless it is told to return, and its Hessian is that of the x at
// which f, c and their derivatives were evaluated last. One fault remains: where min, max or if choose among plain numbers, its Hessian may
// lack entries (version of 2019). The gradients are right there, so that answers are too; a solve may take more steps.
// Source: D. M. Gay, Hooking Your Solver to AMPL, Bell Laboratories report 97-4-06.
#include "tenon/problems/nl/ampl_program.hpp"

#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <limits>
#include <new>
#include <utility>

#include "tenon/core/input_error.hpp"
#include "tenon/core/output_file.hpp"
#include "tenon/problems/nl/nl_scan.hpp"

// The library's names are macros, so it comes last.
#include <asl_pfgh.h>
#undef filename
#undef exit
#undef printf
#undef fprintf

/// In place of the library's own allocator: zeroed memory. Its reader leaves some members of min, max and if unset where these stand in
/// conditions, and reads them later on.
extern "C" void* mymalloc(size_t size) {
  void* const memory = std::calloc(std::max<size_t>(size, 1), 1);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

namespace tenon {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// The sign of a place where something cannot be evaluated.
template <class Values>
void set_nan(Values& values) {
  std::fill_n(values.data(), values.size(), kNaN);
}

double* data_of(ConstVectorRef x) {
  return const_cast<double*>(x.data());  // the library writes nothing there, but does not say so
}

double bound_of(double value) {
  return std::abs(value) >= kNlNoBound ? std::copysign(kInfinity<double>, value) : value;
}

/// The bytes as a file under a name of its own, gone when this goes: the library opens files by name, and shall see what was checked.
class TemporaryNl {
 public:
  explicit TemporaryNl(const std::string& bytes) {
    path_ = (std::filesystem::temp_directory_path() / "tenon_XXXXXX.nl").string();
    const int descriptor = ::mkstemps(path_.data(), 3);
    if (descriptor < 0) throw OutputError(path_ + ": cannot be written: " + std::strerror(errno));
    for (std::size_t done = 0; done < bytes.size();) {
      const ssize_t count = ::write(descriptor, bytes.data() + done, bytes.size() - done);
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) {
        const std::string reason = std::strerror(errno);
        ::close(descriptor);
        std::remove(path_.c_str());
        throw OutputError(path_ + ": cannot be written: " + reason);
      }
      done += static_cast<std::size_t>(count);
    }
    ::close(descriptor);
  }
  ~TemporaryNl() { std::remove(path_.c_str()); }
  TemporaryNl(const TemporaryNl&) = delete;
  TemporaryNl& operator=(const TemporaryNl&) = delete;

  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

/// The library's object, and where it stands.
class AslAtX {
 public:
  explicit AslAtX(const std::string& bytes, const std::string& path) {
    static std::FILE* const nowhere = std::fopen("/dev/null", "w");
    Stderr = nowhere;  // a value that cannot be had is told by a NaN, not by a line on stderr
    asl = ASL_alloc(ASL_read_pfgh);
    const TemporaryNl file(bytes);
    return_nofile = 3;  // return where the file cannot be opened, or its head not be read
    want_xpi0 = 3;      // the guesses of x and of the multipliers
    std::FILE* const stream = jac0dim_ASL(asl, file.path().c_str(), static_cast<ftnlen>(file.path().size()));
    const int code = stream == nullptr ? ASL_readerr_nofile : pfgh_read_ASL(asl, stream, ASL_findgroups | ASL_return_read_err);
    if (code != 0) {
      ASL_free(&asl);
      throw InputError({path, 0, 0}, "the AMPL solver library cannot read this (its code " + std::to_string(code) + ")", "a .nl file");
    }
    x0len = static_cast<std::size_t>(n_var) * sizeof(double);  // x is new where any of it is, not only its nonlinear part
    x_.setConstant(n_var, kNaN);
    weights_.setZero(n_obj);
    gradient_.setZero(n_var);
    values_.setZero(n_con);
    jacobian_.resize(static_cast<std::size_t>(nzc));
  }
  ~AslAtX() { ASL_free(&asl); }
  AslAtX(const AslAtX&) = delete;
  AslAtX& operator=(const AslAtX&) = delete;

  /// Moves to x; false where some common expression cannot be evaluated there.
  bool move_to(ConstVectorRef x) {
    if (x == x_) return evaluates_;
    x_ = x;
    has_value_ = has_values_ = has_gradient_ = has_jacobian_ = false;
    fint error = 0;
    xunknown();
    xknowne(x_.data(), &error);
    return evaluates_ = error == 0;
  }

  double objective(int k) {
    fint error = 0;
    const double value = objval(k, x_.data(), &error);
    has_value_ = error == 0;
    return has_value_ ? value : kNaN;
  }
  /// The library ends the program where it has no value to differentiate, so values are seen to before derivatives.
  void gradient(int k, VectorRef out) {
    if (!has_value_) objective(k);
    if (!has_value_) return set_nan(out);
    fint error = 0;
    objgrd(k, x_.data(), out.data(), &error);
    has_gradient_ = error == 0;
    if (!has_gradient_) set_nan(out);
  }
  void constraints(VectorRef out) {
    fint error = 0;
    conval(x_.data(), out.data(), &error);
    has_values_ = error == 0;
    if (!has_values_) set_nan(out);
  }
  void jacobian(std::span<double> out) {
    if (!has_values_) constraints(values_);
    if (!has_values_) return set_nan(out);
    fint error = 0;
    jacval(x_.data(), out.data(), &error);
    has_jacobian_ = error == 0;
    if (!has_jacobian_) set_nan(out);
  }
  /// Of weight f + lambda' c. The library ends the program where a first derivative that it needs here fails, so they are seen to before.
  void hessian(int k, double weight, ConstVectorRef lambda, std::span<double> out) {
    const bool wants_objective = k >= 0, wants_constraints = n_con > 0;
    if (wants_objective && !has_gradient_) gradient(k, gradient_);
    if (wants_constraints && !has_jacobian_) jacobian(jacobian_);
    if ((wants_objective && !has_gradient_) || (wants_constraints && !has_jacobian_)) return set_nan(out);
    if (wants_objective) weights_[k] = weight;
    sphes(out.data(), -1, wants_objective ? weights_.data() : nullptr, wants_constraints ? data_of(lambda) : nullptr);
  }

  ASL* asl;

 private:
  Vector x_;
  bool evaluates_ = false;
  bool has_value_ = false, has_values_ = false;       // of the objective and the rows, at x_, without an error
  bool has_gradient_ = false, has_jacobian_ = false;  // likewise
  Vector weights_;                                    // of the objectives
  Vector values_, gradient_;                          // what nobody asked for but the Hessian
  std::vector<double> jacobian_;                      // likewise
};

class AmplProgram final : public Nlp {
 public:
  AmplProgram(const std::string& bytes, const std::string& path, NlNames names, int objective)
      : at_(std::make_unique<AslAtX>(bytes, path)), names_(std::move(names)), objective_(objective - 1) {
    ASL* const asl = at_->asl;
    n_ = n_var, m_ = n_con;
    sign_ = objective_ >= 0 && objtype[objective_] != 0 ? -1 : 1;
    find_jacobian();
    find_hessian();
    find_bounds();
    evaluate_once();
  }

  bool maximises() const { return sign_ < 0; }

  /// The file's guess of x, and of the multipliers in our sign.
  Point start() const {
    ASL* const asl = at_->asl;
    Point point(n_, m_);
    if (X0 != nullptr) std::copy_n(X0, n_, point.x.data());
    for (int j = 0; pi0 != nullptr && j < m_; ++j) point.lambda[j] = -sign_ * pi0[j];
    return point;
  }

  int num_variables() const override { return n_; }
  int num_constraints() const override { return m_; }
  SparsePattern jacobian_pattern() const override { return jacobian_; }
  SparsePattern hessian_pattern() const override { return hessian_; }
  void bounds(Bounds& bounds) const override { bounds = bounds_; }
  void initial_point(VectorRef x) const override { x = start().x; }

  void prepare(ConstVectorRef x, Workspace&) const override { at_->move_to(x); }

  double objective(ConstVectorRef x, Workspace&) const override {
    if (!at_->move_to(x)) return kNaN;
    return objective_ < 0 ? 0 : sign_ * at_->objective(objective_);
  }
  void gradient(ConstVectorRef x, Workspace&, VectorRef gradient) const override {
    gradient.setZero();
    if (!at_->move_to(x)) return set_nan(gradient);
    if (objective_ < 0) return;
    at_->gradient(objective_, gradient);
    gradient *= sign_;
  }
  void constraints(ConstVectorRef x, Workspace&, VectorRef values) const override {
    if (!at_->move_to(x)) return set_nan(values);
    if (m_ > 0) at_->constraints(values);
  }
  void jacobian(ConstVectorRef x, Workspace&, std::span<double> values) const override {
    if (!at_->move_to(x)) return set_nan(values);
    if (m_ > 0) at_->jacobian(values);
  }
  void hessian(ConstVectorRef x, double sigma, ConstVectorRef lambda, Workspace&, std::span<double> values) const override {
    if (!at_->move_to(x)) return set_nan(values);
    at_->hessian(objective_, sign_ * sigma, lambda, values);
  }

  std::string name() const override { return names_.problem; }
  std::string variable_name(int i) const override {
    return names_.variables.empty() ? Nlp::variable_name(i) : names_.variables[static_cast<std::size_t>(i)];
  }
  std::string constraint_name(int j) const override {
    return names_.constraints.empty() ? Nlp::constraint_name(j) : names_.constraints[static_cast<std::size_t>(j)];
  }

 private:
  /// The pattern in our order, and from now on the library's values in it.
  void find_jacobian() {
    ASL* const asl = at_->asl;
    std::vector<std::pair<int, int>> entries;
    for (int j = 0; j < m_; ++j) {
      for (const cgrad* term = Cgrad[j]; term != nullptr; term = term->next) entries.emplace_back(j, term->varno);
    }
    jacobian_ = SparsePattern::from_entries(m_, n_, std::move(entries));
    for (int j = 0; j < m_; ++j) {
      for (cgrad* term = Cgrad[j]; term != nullptr; term = term->next) term->goff = jacobian_.find(j, term->varno);
    }
  }

  void find_hessian() {
    ASL* const asl = at_->asl;
    constexpr int kLowerTriangle = 2;
    const fint nonzeros = sphsetup(-1, objective_ >= 0, m_ > 0, kLowerTriangle);
    hessian_.rows = hessian_.cols = n_;
    hessian_.outer.assign(sputinfo->hcolstarts, sputinfo->hcolstarts + n_ + 1);
    hessian_.inner.assign(sputinfo->hrownos, sputinfo->hrownos + nonzeros);
  }

  void find_bounds() {
    ASL* const asl = at_->asl;
    bounds_ = Bounds(n_, m_);
    for (int i = 0; i < n_; ++i) {
      bounds_.x_lower[i] = bound_of(LUv[2 * i]);
      bounds_.x_upper[i] = bound_of(LUv[2 * i + 1]);
    }
    for (int j = 0; j < m_; ++j) {
      bounds_.c_lower[j] = bound_of(LUrhs[2 * j]);
      bounds_.c_upper[j] = bound_of(LUrhs[2 * j + 1]);
    }
  }

  /// The library takes its last memory at the first Hessian: here, at the start, rather than in a solve. (Where the start has no Hessian,
  /// the first x that has one pays for it.)
  void evaluate_once() {
    std::vector<double> values(hessian_.inner.size());
    if (at_->move_to(start().x)) at_->hessian(objective_, 0, Vector::Zero(m_), values);
  }

  std::unique_ptr<AslAtX> at_;
  NlNames names_;
  int objective_;  // from 0; -1: none
  int n_, m_;
  double sign_;
  Bounds bounds_;
  SparsePattern jacobian_, hessian_;
};

}  // namespace

bool nl_files_are_available() {
  return true;
}

NlFile make_ampl_program(const std::string& bytes, const std::string& path, NlNames names, int objective) {
  auto program = std::make_unique<AmplProgram>(bytes, path, std::move(names), objective);
  NlFile made;
  made.start = program->start();
  made.maximises = program->maximises();
  made.objective = objective;
  made.problem = std::move(program);
  return made;
}

}  // namespace tenon
