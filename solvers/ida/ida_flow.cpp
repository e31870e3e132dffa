#include "tenon/solvers/ida/ida_flow.hpp"

#include <ida/ida.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_version.h>
#include <sunlinsol/sunlinsol_klu.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

#include <algorithm>
#include <stdexcept>

namespace tenon {

namespace {

constexpr int kAlwaysDense = 30;      // unknowns up to which the dense LU is the faster one
constexpr double kSparseFill = 0.25;  // of the pattern, above which it is as well

constexpr double kFirstStep = 0.25, kFirstStepOn = 0.5;  // of a restart, in parts of the longest step since the one before
constexpr double kIndex2Convergence = 0.01;              // of Newton's method against the step's error; IDA's own is 0.33
constexpr int kRecoverable = 1;                          // IDA tries a smaller step

void check(int flag, const char* call) {
  if (flag < 0) throw std::runtime_error(std::string("IDA: ") + call + " fails with " + std::to_string(flag));
}

/// What SUNDIALS wants freed, in one place.
template <class T, void (*Free)(T)>
struct Deleter {
  using pointer = T;
  void operator()(T object) const { Free(object); }
};
void free_context(SUNContext context) {
  SUNContext_Free(&context);
}
void free_solver(SUNLinearSolver solver) {
  SUNLinSolFree(solver);
}
void free_memory(void* memory) {
  IDAFree(&memory);
}

/// A dense LU with partial pivoting behind the interface of SUNDIALS, whose own takes three times as long.
class DenseLu {
 public:
  static SUNLinearSolver make(int n, SUNContext context) {
    SUNLinearSolver solver = SUNLinSolNewEmpty(context);
    solver->content = new DenseLu(n);
    solver->ops->gettype = [](SUNLinearSolver) { return SUNLINEARSOLVER_DIRECT; };
    solver->ops->setup = [](SUNLinearSolver self, SUNMatrix A) { return of(self).factor(A); };
    solver->ops->solve = [](SUNLinearSolver self, SUNMatrix, N_Vector x, N_Vector b, realtype) { return of(self).solve(x, b); };
    solver->ops->free = [](SUNLinearSolver self) {
      delete &of(self);
      SUNLinSolFreeEmpty(self);
      return 0;
    };
    return solver;
  }

 private:
  explicit DenseLu(int n) : lu_(n) {}
  static DenseLu& of(SUNLinearSolver self) { return *static_cast<DenseLu*>(self->content); }

  int factor(SUNMatrix A) {
    const Eigen::Index n = SUNDenseMatrix_Rows(A);
    lu_.compute(Eigen::Map<const Eigen::MatrixXd>(SUNDenseMatrix_Data(A), n, n));
    return lu_.matrixLU().diagonal().cwiseAbs().minCoeff() > 0 ? 0 : SUNLS_LUFACT_FAIL;
  }
  int solve(N_Vector x, N_Vector b) {
    const Eigen::Index n = lu_.matrixLU().rows();
    Eigen::Map<Vector>(N_VGetArrayPointer(x), n) = lu_.solve(Eigen::Map<const Vector>(N_VGetArrayPointer(b), n));
    return 0;
  }

  Eigen::PartialPivLU<Eigen::MatrixXd> lu_;
};

using Context = std::unique_ptr<std::remove_pointer_t<SUNContext>, Deleter<SUNContext, free_context>>;
using NVector = std::unique_ptr<std::remove_pointer_t<N_Vector>, Deleter<N_Vector, N_VDestroy>>;
using Matrix = std::unique_ptr<std::remove_pointer_t<SUNMatrix>, Deleter<SUNMatrix, SUNMatDestroy>>;
using LinearSolver = std::unique_ptr<std::remove_pointer_t<SUNLinearSolver>, Deleter<SUNLinearSolver, free_solver>>;
using Memory = std::unique_ptr<void, Deleter<void*, free_memory>>;

class IdaFlow final : public Flow {
 public:
  IdaFlow(const Dae& dae, const IntegratorOptions& options)
      : dae_(dae),
        options_(options),
        nx_(dae.num_states()),
        ny_(dae.num_algebraics()),
        workspace_(dae.make_workspace()),
        newton_(dae),
        pattern_(dae.jacobian_pattern()),
        at_(initial_state_of(dae)) {
    values_.resize(pattern_.inner.size());
    SUNContext context = nullptr;
    check(SUNContext_Create(nullptr, &context), "SUNContext_Create");
    context_.reset(context);
    for (NVector* v : {&z_, &zdot_, &tolerance_, &kind_, &inside_}) v->reset(N_VNew_Serial(nx_ + ny_, context));
    make_matrix();
  }

  bool restart(const DaeState& state) override {
    const bool goes_on = memory_ && view(z_).head(nx_) == state.x;
    at_ = state;
    begin_ = end_ = state.t;
    view(z_) << state.x, state.y;
    view(zdot_) << state.xdot, Vector::Zero(ny_);
    if (!memory_) {
      create();
      return true;
    }
    // Without a hint IDA would double its way up from 1/1000 of the interval. Where x goes on as it was, after a clock's tick, so do steps.
    return IDAReInit(memory_.get(), state.t, z_.get(), zdot_.get()) == IDA_SUCCESS &&
           IDASetInitStep(memory_.get(), (goes_on ? kFirstStepOn : kFirstStep) * longest_) == IDA_SUCCESS;
  }

  Step step(double t_limit, double h_max) override {
    check(IDASetStopTime(memory_.get(), t_limit), "IDASetStopTime");
    check(IDASetMaxStep(memory_.get(), std::min(h_max, 1e30)), "IDASetMaxStep");
    begin_ = end_;
    const int flag = IDASolve(memory_.get(), t_limit, &end_, z_.get(), zdot_.get(), IDA_ONE_STEP);
    if (flag < 0) {
      end_ = begin_;
      return flag == IDA_LSETUP_FAIL || flag == IDA_LSOLVE_FAIL || flag == IDA_RES_FAIL ? Step::failed : Step::collapsed;
    }
    if (!(end_ > begin_)) return Step::collapsed;  // IDA itself goes on with steps that no longer change t
    ++steps_;
    longest_ = begin_ == at_.t ? end_ - begin_ : std::max(longest_, end_ - begin_);
    return Step::taken;
  }

  bool interpolate(double t, DaeState& state) override {
    state.t = t;
    if (t == begin_ && steps_at(begin_)) {
      state.x = at_.x, state.xdot = at_.xdot, state.y = at_.y;
      return true;
    }
    if (IDAGetDky(memory_.get(), t, 0, inside_.get()) != IDA_SUCCESS) return false;
    state.x = view(inside_).head(nx_);
    state.y = view(inside_).tail(ny_);
    if (IDAGetDky(memory_.get(), t, 1, inside_.get()) != IDA_SUCCESS) return false;
    state.xdot = view(inside_).head(nx_);
    return !has_manifold() || follow(state);
  }

  bool interpolate_state(double t, DaeState& state) override { return interpolate(t, state); }

  bool land(double t, DaeState& state) override { return interpolate(t, state) && follow(state); }

 private:
  bool has_manifold() const { return dae_.has_manifold(at_.mode); }

  /// xdot and y follow from x; the interpolant's own are less accurate.
  bool follow(DaeState& state) { return make_consistent(dae_, newton_, state, workspace_); }

  static Eigen::Map<Vector> view(const NVector& v) { return {N_VGetArrayPointer(v.get()), N_VGetLength(v.get())}; }
  Eigen::Map<Vector> view(N_Vector v) const { return {N_VGetArrayPointer(v), nx_ + ny_}; }

  /// The first step begins where the flow was started, outside the reach of IDA's interpolant.
  bool steps_at(double t) const { return t == at_.t; }

  bool is_dense() const {
    const double n = nx_ + ny_;
    return n <= kAlwaysDense || pattern_.nonzeros() > kSparseFill * n * n;
  }

  void make_matrix() {
    const int n = nx_ + ny_;
    if (is_dense()) {
      matrix_.reset(SUNDenseMatrix(n, n, context_.get()));
      linear_.reset(DenseLu::make(n, context_.get()));
    } else {
      matrix_.reset(SUNSparseMatrix(n, n, pattern_.nonzeros(), CSC_MAT, context_.get()));
      linear_.reset(SUNLinSol_KLU(z_.get(), matrix_.get(), context_.get()));
    }
  }

  void create() {
    memory_.reset(IDACreate(context_.get()));
    void* ida = memory_.get();
    check(IDAInit(ida, &residual, at_.t, z_.get(), zdot_.get()), "IDAInit");
    check(IDASetUserData(ida, this), "IDASetUserData");
    check(IDASetErrHandlerFn(
              ida, [](int, const char*, const char*, char*, void*) {}, nullptr),
          "IDASetErrHandlerFn");
    view(tolerance_).setConstant(options_.atol);
    if (has_manifold()) {
      // rounding in x comes into multipliers of index 2 divided by the step: Newton's method is judged by x, and more strictly
      view(tolerance_).tail(ny_).setConstant(std::sqrt(options_.atol));
      check(IDASetNonlinConvCoef(ida, kIndex2Convergence), "IDASetNonlinConvCoef");
    }
    check(IDASVtolerances(ida, options_.rtol, tolerance_.get()), "IDASVtolerances");
    view(kind_) << Vector::Ones(nx_), Vector::Zero(ny_);
    check(IDASetId(ida, kind_.get()), "IDASetId");
    check(IDASetSuppressAlg(ida, SUNTRUE), "IDASetSuppressAlg");
    check(IDASetMaxNumSteps(ida, -1), "IDASetMaxNumSteps");
    check(IDASetLinearSolver(ida, linear_.get(), matrix_.get()), "IDASetLinearSolver");
    check(IDASetJacFn(ida, &jacobian), "IDASetJacFn");
  }

  static int residual(realtype t, N_Vector z, N_Vector zdot, N_Vector F, void* self) {
    return static_cast<IdaFlow*>(self)->evaluate(t, z, zdot, F);
  }
  static int jacobian(realtype t, realtype alpha, N_Vector z, N_Vector zdot, N_Vector, SUNMatrix J, void* self, N_Vector, N_Vector,
                      N_Vector) {
    return static_cast<IdaFlow*>(self)->evaluate_jacobian(t, alpha, z, zdot, J);
  }

  int evaluate(double t, N_Vector z, N_Vector zdot, N_Vector F) {
    ++evaluations_;
    dae_.residual(at_.mode, DaePoint(t, view(zdot).head(nx_), view(z).head(nx_), view(z).tail(ny_), at_.u), workspace_, view(F));
    return view(F).allFinite() ? 0 : kRecoverable;
  }

  int evaluate_jacobian(double t, double alpha, N_Vector z, N_Vector zdot, SUNMatrix J) {
    dae_.jacobian(at_.mode, DaePoint(t, view(zdot).head(nx_), view(z).head(nx_), view(z).tail(ny_), at_.u), alpha, workspace_, values_);
    if (is_dense() && pattern_.nonzeros() == pattern_.rows * pattern_.cols) {
      std::copy(values_.begin(), values_.end(), SUNDenseMatrix_Data(J));
    } else if (is_dense()) {
      for (int j = 0; j < pattern_.cols; ++j) {
        realtype* column = SUNDenseMatrix_Column(J, j);
        for (auto k = static_cast<std::size_t>(pattern_.outer[static_cast<std::size_t>(j)]);
             k < static_cast<std::size_t>(pattern_.outer[static_cast<std::size_t>(j) + 1]); ++k) {
          column[pattern_.inner[k]] = values_[k];
        }
      }
    } else {
      std::copy(pattern_.outer.begin(), pattern_.outer.end(), SUNSparseMatrix_IndexPointers(J));
      std::copy(pattern_.inner.begin(), pattern_.inner.end(), SUNSparseMatrix_IndexValues(J));
      std::copy(values_.begin(), values_.end(), SUNSparseMatrix_Data(J));
    }
    return std::all_of(values_.begin(), values_.end(), [](double v) { return std::isfinite(v); }) ? 0 : kRecoverable;
  }

  const Dae& dae_;
  IntegratorOptions options_;
  int nx_, ny_;
  Dae::Workspace workspace_;
  ConsistentStart newton_;
  SparsePattern pattern_;
  DaeState at_;  // where the flow was started; its mode and u hold until the next start
  std::vector<double> values_;
  double longest_ = 0;  // step since the last start, s

  Context context_;
  NVector z_, zdot_, tolerance_, kind_, inside_;  // z = (x, y)
  Matrix matrix_;
  LinearSolver linear_;
  Memory memory_;
};

}  // namespace

std::string ida_version() {
  return "IDA of SUNDIALS " SUNDIALS_VERSION;
}

std::unique_ptr<Flow> make_ida_flow(const Dae& dae, const IntegratorOptions& options) {
  return std::make_unique<IdaFlow>(dae, options);
}

}  // namespace tenon
