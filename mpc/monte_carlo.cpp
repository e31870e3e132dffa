#include "tenon/mpc/monte_carlo.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

namespace tenon {

namespace {

constexpr std::chrono::milliseconds kPatience{5};  // between two looks at go_on

using Rows = std::vector<std::pair<std::uint64_t, Vector>>;

/// What workers have done and nobody has taken yet.
class DoneRows {
 public:
  explicit DoneRows(int workers) : working_(workers) {}

  void add(std::uint64_t seed, Vector row) {
    const std::lock_guard lock(mutex_);
    rows_.emplace_back(seed, std::move(row));
    changed_.notify_one();
  }
  void leave(std::exception_ptr failure) {
    const std::lock_guard lock(mutex_);
    if (failure && !failure_) failure_ = std::move(failure);
    --working_;
    changed_.notify_one();
  }

  /// Waits for rows, not longer than kPatience. False when all workers have left and nothing is to be taken.
  bool take(Rows& rows) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, kPatience, [&] { return !rows_.empty() || working_ == 0; });
    rows.clear();
    rows.swap(rows_);
    return working_ > 0 || !rows.empty();
  }
  std::exception_ptr failure() const { return failure_; }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  Rows rows_;
  int working_;
  std::exception_ptr failure_;
};

}  // namespace

void run_samples(const ExperimentFactory& make_experiment, std::span<const std::uint64_t> seeds, int threads, const MonteCarloHandlers& handlers) {
  if (threads < 1) throw std::invalid_argument("a Monte Carlo on " + std::to_string(threads) + " threads (expected at least 1)");
  const int workers = std::min(threads, static_cast<int>(seeds.size()));
  DoneRows done(workers);
  std::atomic<std::size_t> next = 0;
  std::atomic<bool> is_over = false;

  const auto work = [&] {
    std::exception_ptr failure;
    try {
      const std::unique_ptr<Experiment> experiment = make_experiment();
      Vector row(static_cast<int>(experiment->names().size()));
      for (std::size_t k = next++; k < seeds.size() && !is_over; k = next++) {
        experiment->run(seeds[k], row);
        done.add(seeds[k], row);
      }
    } catch (...) {
      failure = std::current_exception();
      is_over = true;
    }
    done.leave(failure);
  };

  std::vector<std::jthread> team;
  for (int i = 0; i < workers; ++i) team.emplace_back(work);
  try {
    for (Rows rows; done.take(rows);) {
      for (const auto& [seed, row] : rows) handlers.on_row(seed, row);
      if (handlers.go_on && !handlers.go_on()) is_over = true;
    }
  } catch (...) {
    is_over = true;
    throw;
  }
  if (done.failure()) std::rethrow_exception(done.failure());
}

}  // namespace tenon
