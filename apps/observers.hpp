// Who looks at the iterations of a solve: the table of --verbose, the record of --trace, and Ctrl-C.
#pragma once

#include <exception>
#include <functional>
#include <memory>
#include <string>

#include "tenon/apps/arguments.hpp"
#include "tenon/core/iteration.hpp"
#include "tenon/core/output_file.hpp"

namespace tenon {

/// One JSON object and a newline: a line of a trace, with the row it belongs to where that is not negative.
std::string trace_line(const Iteration& iteration, long row = -1);

/// One line of the iteration table; index 0 brings the header. With colours, for a terminal, a residual within the tolerance is green.
std::string table_line(const Iteration& iteration, double tolerance, bool with_colors);

class Observers {
 public:
  /// Opens the trace where one is asked for, so that a bad path shows before any work.
  explicit Observers(const Arguments& arguments);

  /// Whether --verbose or --trace asked for anything.
  bool wanted() const { return verbose_ || trace_ != nullptr; }
  /// For Options::on_iteration; refers to this. Asks the solver to stop once the user interrupts.
  std::function<bool(const Iteration&)> callback();
  /// The iterations that follow belong to this row of a log, from 0.
  void begin_row(long row) { row_ = row; }
  /// Closes the trace. Throws OutputError.
  void finish();

 private:
  bool verbose_;
  bool with_colors_;
  double tolerance_;
  long row_ = -1;
  std::unique_ptr<OutputFile> trace_;
  std::exception_ptr failure_;  // of writing the trace; thrown by finish()
};

}  // namespace tenon
