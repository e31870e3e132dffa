#include "tenon/core/explanation.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tenon/core/check_derivatives.hpp"
#include "tenon/core/dependent_rows.hpp"
#include "tenon/core/nlp_decorator.hpp"
#include "tenon/core/solver.hpp"

namespace tenon {

namespace {

constexpr std::size_t kMostNamed = 6;      // names in a sentence
constexpr int kMostDifferentiated = 200;   // variables of a problem whose derivatives are checked
constexpr double kDerivativeError = 1e-4;  // far above the error of differences: a wrong formula
constexpr double kActive = 1e-6;
constexpr double kRunaway = 1e6;  // mean |multiplier| of a hundred times this is none

std::string number(double value) {
  if (std::isnan(value)) return "nan";  // whose sign says nothing
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t k = 0; k < std::min(names.size(), kMostNamed); ++k) text += (k > 0 ? ", " : "") + names[k];
  if (names.size() > kMostNamed) text += " and " + std::to_string(names.size() - kMostNamed) + " more";
  return text;
}

std::string range(double lower, double upper) {
  return "[" + number(lower) + ", " + number(upper) + "]";
}

std::string standing(double value, double lower, double upper) {
  const auto at = [value](double bound) {
    return std::isfinite(bound) && std::abs(value - bound) <= kActive * std::max(1.0, std::abs(bound));
  };
  if (lower == upper) return at(lower) ? "met" : "not met";
  if (at(lower)) return "active at its lower bound";
  if (at(upper)) return "active at its upper bound";
  return value < lower || value > upper ? "outside" : "inactive";
}

/// A problem that names rows and variables together with their stage, where it has stages.
class NamedByStage final : public NlpDecorator {
 public:
  explicit NamedByStage(const Nlp& problem) : NlpDecorator(problem), stages_(problem.stages()) {}

  std::string variable_name(int i) const override {
    return problem_.variable_name(i) +
           place([i](const Stages::Stage& stage) { return stage.variables.contains(i) || stage.slacks.contains(i); });
  }
  std::string constraint_name(int j) const override {
    return problem_.constraint_name(j) + place([j](const Stages::Stage& stage) { return stage.rows.contains(j); });
  }

 private:
  template <class Holds>
  std::string place(Holds holds) const {
    const auto found = std::ranges::find_if(stages_.stages, holds);
    return found == stages_.stages.end() ? "" : " (stage " + std::to_string(found - stages_.stages.begin()) + ")";
  }

  Stages stages_;
};

/// Everything that is looked at, evaluated once.
class Examination {
 public:
  Examination(const Nlp& problem, const Point& point)
      : problem_(problem), point_(point), here_(problem, point.x), bounds_(problem.num_variables(), problem.num_constraints()) {
    problem.bounds(bounds_);
  }

  std::vector<std::string> not_finite() const {
    std::vector<std::string> found;
    const auto say = [&](const std::string& what, double value, const std::vector<int>& variables) {
      std::vector<std::string> at;
      for (const int i : variables) at.push_back(problem_.variable_name(i) + " = " + number(point_.x[i]));
      found.push_back(what + " is " + number(value) + (at.empty() ? "" : " at " + joined(at)));
    };
    for (int i = 0; i < n(); ++i) {
      if (!std::isfinite(point_.x[i])) say(problem_.variable_name(i), point_.x[i], {});
    }
    if (!std::isfinite(here_.objective)) say("the objective", here_.objective, suspects_of_objective());
    for (int j = 0; j < m(); ++j) {
      if (!std::isfinite(here_.constraints[j])) say("row " + problem_.constraint_name(j), here_.constraints[j], variables_of_row(j));
    }
    for (int i = 0; i < n(); ++i) {
      if (!std::isfinite(here_.gradient[i])) say("the objective's derivative by " + problem_.variable_name(i), here_.gradient[i], {i});
      for (SparseMatrix::InnerIterator entry(here_.jacobian, i); entry; ++entry) {
        const int j = static_cast<int>(entry.row());
        if (!std::isfinite(entry.value()))
          say("the derivative of row " + problem_.constraint_name(j) + " by " + problem_.variable_name(i), entry.value(),
              variables_of_row(j));
      }
    }
    if (found.empty()) add_hessian(say);
    return found;
  }

  std::string runaway() const {
    std::string text = "the objective is " + number(here_.objective) + " and falls further";
    if (n() == 0) return text;
    Eigen::Index i = 0;
    point_.x.cwiseAbs().maxCoeff(&i);
    return text + "; " + problem_.variable_name(static_cast<int>(i)) + " has run furthest, to " + number(point_.x[i]) + ", within " +
           range(bounds_.x_lower[i], bounds_.x_upper[i]);
  }

  std::vector<std::string> worst_parts() const {
    std::vector<std::string> found;
    const Vector rows = here_.constraints - bounds_.compliance.cwiseProduct(point_.lambda - bounds_.preload);
    Eigen::Index j = 0, i = 0;
    if (m() > 0) {
      const double violation = (bounds_.c_lower - rows).cwiseMax(rows - bounds_.c_upper).maxCoeff(&j);
      if (violation > 0) {
        found.push_back("the largest violation of a row is " + number(violation) + ": " + problem_.constraint_name(static_cast<int>(j)) +
                        " = " + number(rows[j]) + ", not in " + range(bounds_.c_lower[j], bounds_.c_upper[j]));
      }
    }
    if (n() > 0) {
      const Vector pull = here_.jacobian.transpose() * point_.lambda;
      const double left = (here_.gradient + pull + point_.z).cwiseAbs().maxCoeff(&i);
      found.push_back("stationarity is worst, " + number(left) + ", in " + problem_.variable_name(static_cast<int>(i)) + " = " +
                      number(point_.x[i]) + " (" + standing(point_.x[i], bounds_.x_lower[i], bounds_.x_upper[i]) + "): objective " +
                      number(here_.gradient[i]) + ", rows " + number(pull[i]) + ", bounds " + number(point_.z[i]));
    }
    add_worst_complementarity(rows, found);
    return found;
  }

 private:
  int n() const { return problem_.num_variables(); }
  int m() const { return problem_.num_constraints(); }

  std::vector<int> variables_of_row(int j) const {
    std::vector<int> variables;
    for (int i = 0; i < n(); ++i) {
      for (SparseMatrix::InnerIterator entry(here_.jacobian, i); entry; ++entry) {
        if (entry.row() == j) variables.push_back(i);
      }
    }
    return variables;
  }

  /// The variables by which the objective has no finite derivative; where there is none, all.
  std::vector<int> suspects_of_objective() const {
    std::vector<int> suspects, all;
    for (int i = 0; i < n(); ++i) {
      all.push_back(i);
      if (!std::isfinite(here_.gradient[i])) suspects.push_back(i);
    }
    return suspects.empty() ? all : suspects;
  }

  template <class Say>
  void add_hessian(Say&& say) const {
    SparseMatrix hessian = problem_.hessian_pattern().zero_matrix();
    Nlp::Workspace workspace = problem_.make_workspace();
    problem_.prepare(point_.x, workspace);
    problem_.hessian(point_.x, 1, point_.lambda, workspace, values_of(hessian));
    for (int i = 0; i < n(); ++i) {
      for (SparseMatrix::InnerIterator entry(hessian, i); entry; ++entry) {
        const int k = static_cast<int>(entry.row());
        if (!std::isfinite(entry.value()))
          say("the Hessian's entry of " + problem_.variable_name(k) + " and " + problem_.variable_name(i), entry.value(), {k, i});
      }
    }
  }

  void add_worst_complementarity(const Vector& rows, std::vector<std::string>& found) const {
    double worst = 0;
    std::string sentence;
    const auto look = [&](const std::string& name, double value, double lower, double upper, double multiplier) {
      if (lower == upper || multiplier == 0) return;
      const double bound = multiplier > 0 ? upper : lower;
      const double product = std::abs(multiplier) * (std::isinf(bound) ? 1 : std::abs(value - bound));
      if (product <= worst) return;
      worst = product;
      sentence = "complementarity is worst, " + number(product) + ", in " + name + " = " + number(value) + " (" +
                 standing(value, lower, upper) + "): multiplier " + number(multiplier) + ", bounds " + range(lower, upper);
    };
    for (int j = 0; j < m(); ++j) look(problem_.constraint_name(j), rows[j], bounds_.c_lower[j], bounds_.c_upper[j], point_.lambda[j]);
    for (int i = 0; i < n(); ++i) look(problem_.variable_name(i), point_.x[i], bounds_.x_lower[i], bounds_.x_upper[i], point_.z[i]);
    if (worst > 0) found.push_back(sentence);
  }

  const Nlp& problem_;
  const Point& point_;
  FirstOrder here_;
  Bounds bounds_;
};

std::string say(const Limit& limit) {
  return (limit.is_bound ? "the bounds of " : "row ") + limit.name + " = " + number(limit.value) + ", in " +
         range(limit.lower, limit.upper) + ": violated by " + number(limit.violation) + ", multiplier " + number(limit.multiplier);
}

void say_conflict(const std::vector<Limit>& limits, Explanation& out) {
  out.sentences.push_back(limits.size() == 1 ? "this cannot be met, to first order at the point:"
                                             : "these cannot be met together, to first order at the point:");
  for (const Limit& limit : limits) out.sentences.push_back("  " + say(limit));
}

void explain_infeasible(const Nlp& problem, const Point& point, Explanation& out) {
  out.conflict = conflict(problem, point.x);
  if (!out.conflict.empty()) return say_conflict(out.conflict, out);
  out.conflict = violated_limits(problem, point.x, kActive);
  if (out.conflict.empty()) return;
  out.sentences.push_back("these are violated, and no contradiction between them was found at the point:");
  for (const Limit& limit : out.conflict) out.sentences.push_back("  " + say(limit));
}

void explain_dependence(const Nlp& problem, const Point& point, Explanation& out) {
  for (const DependentRow& dependent : dependent_rows(problem, point.x)) {
    std::vector<std::string> others;
    for (const int j : dependent.on) others.push_back(problem.constraint_name(j));
    out.sentences.push_back(
        "the gradient of row " + problem.constraint_name(dependent.row) +
        (others.empty() ? " is 0 in all variables that are off their bounds" : " depends on that of " + joined(others)));
  }
}

void explain_derivatives(const Nlp& problem, const Point& point, Explanation& out) {
  if (problem.num_variables() > kMostDifferentiated) return;
  const DerivativeReport report = check_derivatives(problem, point.x, 1, point.lambda, kDerivativeError);
  for (const DerivativeError& error : report.worst) {
    if (error.what == "hessian" && problem.hessian_kind() != HessianKind::exact) continue;
    out.sentences.push_back("the " + error.what + (error.row.empty() ? "" : " of " + error.row) + " by " + error.variable + " is " +
                            number(error.analytic) + ", but differences say " + number(error.difference));
  }
}

}  // namespace

std::string Explanation::text() const {
  std::string text;
  for (const std::string& sentence : sentences) text += sentence + "\n";
  return text;
}

Explanation explain(const Nlp& unnamed, const Point& point, const Result& result) {
  validate(unnamed, point);
  Explanation out;
  if (result.status == Status::solved) return out;
  const NamedByStage problem(unnamed);
  const Examination examination(problem, point);
  out.sentences = examination.not_finite();
  if (!out.sentences.empty()) return out;
  explain_derivatives(problem, point, out);
  if (result.status == Status::infeasible) {
    explain_infeasible(problem, point, out);
    return out;
  }
  if (result.status == Status::unbounded) {
    out.sentences.push_back(examination.runaway());
    return out;
  }
  if (result.status == Status::numerical_failure && result.residual.primal <= kActive && result.residual.scale > kRunaway) {
    out.sentences.push_back("the rows are met, but their multipliers grow without limit (a hundred times " + number(result.residual.scale) +
                            " in the mean): a minimum may lie here that has none");
  }
  for (const std::string& sentence : examination.worst_parts()) out.sentences.push_back(sentence);
  if (result.residual.primal > kActive) {
    const std::vector<Limit> limits = conflict(problem, point.x);
    if (!limits.empty()) say_conflict(limits, out);
  }
  explain_dependence(problem, point, out);
  return out;
}

}  // namespace tenon
