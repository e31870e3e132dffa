#include "tenon/apps/guarded_main.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <system_error>

#include "tenon/apps/exit_code.hpp"
#include "tenon/apps/interrupt.hpp"
#include "tenon/core/input_error.hpp"
#include "tenon/core/output_file.hpp"

namespace tenon {

namespace {

int explain(const std::exception& error, ExitCode code) {
  fmt::print(stderr, "tenon: {}\n", error.what());
  return code;
}

}  // namespace

int guarded_main(const std::function<int()>& run) {
  try {
    watch_for_interrupts();
    const int code = run();
    if (std::fflush(stdout) != 0 || std::ferror(stdout)) {
      throw OutputError(fmt::format("standard output: cannot be written: {}", std::strerror(errno)));
    }
    return code;
  } catch (const InputError& error) {
    return explain(error, kBadInput);
  } catch (const std::invalid_argument& error) {
    return explain(error, kBadInput);
  } catch (const OutputError& error) {
    return explain(error, kNoOutput);
  } catch (const std::system_error& error) {  // fmt, where its output does not fit the buffer of standard output
    return explain(OutputError("standard output: cannot be written: " + error.code().message()), kNoOutput);
  } catch (const std::exception& error) {
    return explain(error, kNotSolved);
  }
}

}  // namespace tenon
