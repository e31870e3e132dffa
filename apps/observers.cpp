#include "tenon/apps/observers.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>

#include "tenon/apps/interrupt.hpp"

namespace tenon {

namespace {

constexpr const char* kBold = "1";
constexpr const char* kGreen = "32";

/// Only a terminal gets colours, and not one whose owner set NO_COLOR.
bool wants_colors() {
  return isatty(STDERR_FILENO) != 0 && std::getenv("NO_COLOR") == nullptr;
}

std::string number(double value) {
  return std::isfinite(value) ? fmt::format("{}", value) : "null";
}

}  // namespace

std::string trace_line(const Iteration& it, long row) {
  return fmt::format(
      "{{{}\"index\":{},\"objective\":{},\"primal\":{},\"dual\":{},\"complementarity\":{},\"mu\":{},\"alpha_primal\":{},\"alpha_dual\":{},"
      "\"regularization\":{},\"trials\":{}}}\n",
      row < 0 ? "" : fmt::format("\"row\":{},", row), it.index, number(it.objective), number(it.primal), number(it.dual),
      number(it.complementarity), number(it.mu), number(it.alpha_primal), number(it.alpha_dual), number(it.regularization), it.trials);
}

std::string table_line(const Iteration& it, double tolerance, bool with_colors) {
  const auto colored = [&](const char* color, const std::string& text) {
    return with_colors && *color != 0 ? fmt::format("\x1b[{}m{}\x1b[0m", color, text) : text;
  };
  const auto residual = [&](double value) { return colored(value <= tolerance ? kGreen : "", fmt::format("{:>8.2e}", value)); };
  std::string text;
  if (it.index == 0) {
    text = colored(kBold, fmt::format("{:>5}  {:>16}  {:>8}  {:>8}  {:>8}  {:>8}  {:>7}  {:>7}  {:>8}  {:>6}", "iter", "objective", "primal", "dual",
                                      "compl", "mu", "alpha_p", "alpha_d", "reg", "trials")) +
           "\n";
  }
  return text + fmt::format("{:>5}  {:>16.9e}  {}  {}  {}  {:>8.2e}  {:>7.4f}  {:>7.4f}  {:>8.2e}  {:>6}\n", it.index, it.objective,
                            residual(it.primal), residual(it.dual), residual(it.complementarity), it.mu, it.alpha_primal, it.alpha_dual,
                            it.regularization, it.trials);
}

Observers::Observers(const Arguments& arguments)
    : verbose_(arguments.verbose), with_colors_(wants_colors()), tolerance_(arguments.options().tolerance) {
  if (!arguments.trace.empty()) trace_ = std::make_unique<OutputFile>(arguments.trace);
}

std::function<bool(const Iteration&)> Observers::callback() {
  return [this](const Iteration& iteration) {
    if (verbose_) fmt::print(stderr, "{}", table_line(iteration, tolerance_, with_colors_));
    try {
      if (trace_) trace_->append(trace_line(iteration, row_));
    } catch (const OutputError&) {  // must not cross a library's own loop
      failure_ = std::current_exception();
    }
    return !interrupted() && !failure_;
  };
}

void Observers::finish() {
  if (failure_) std::rethrow_exception(failure_);
  if (trace_) trace_->finish();
}

}  // namespace tenon
