// tenon: reads the command line, runs the verb, and turns whatever went wrong into one line and an exit code.
#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <system_error>

#include "tenon/apps/command_line.hpp"
#include "tenon/apps/interrupt.hpp"
#include "tenon/core/input_error.hpp"
#include "tenon/core/output_file.hpp"

namespace {

int run(int argc, char** argv) {
  tenon::watch_for_interrupts();
  const auto invocation = tenon::read_command_line(argc, argv);
  const int code = invocation ? invocation->verb->run(invocation->arguments) : tenon::kFinished;
  if (std::fflush(stdout) != 0 || std::ferror(stdout)) {
    throw tenon::OutputError(fmt::format("standard output: cannot be written: {}", std::strerror(errno)));
  }
  return code;
}

int explain(const std::exception& error, tenon::ExitCode code) {
  fmt::print(stderr, "tenon: {}\n", error.what());
  return code;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const tenon::InputError& error) {
    return explain(error, tenon::kBadInput);
  } catch (const std::invalid_argument& error) {
    return explain(error, tenon::kBadInput);
  } catch (const tenon::OutputError& error) {
    return explain(error, tenon::kNoOutput);
  } catch (const std::system_error& error) {  // fmt, where its output does not fit the buffer of standard output
    return explain(tenon::OutputError("standard output: cannot be written: " + error.code().message()), tenon::kNoOutput);
  } catch (const std::exception& error) {
    return explain(error, tenon::kNotSolved);
  }
}
