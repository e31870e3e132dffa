// The processes of an `mpirun` as a crew.
#pragma once

#include "tenon/apps/sweep/crew.hpp"

namespace tenon {

/// One at a time in a process: it starts MPI and ends it.
class MpiCrew final : public Crew {
 public:
  MpiCrew();
  ~MpiCrew() override;
  MpiCrew(const MpiCrew&) = delete;
  MpiCrew& operator=(const MpiCrew&) = delete;

  int rank() const override { return rank_; }
  int size() const override { return size_; }
  void share(std::vector<std::uint64_t>& seeds) override;
  void send(std::uint64_t seed, const Vector& row) override;
  void leave() override;
  bool receive(std::uint64_t& seed, Vector& row) override;
  bool is_alone() const override { return members_ == 1; }

  /// Ends all processes: for one that cannot go on while the others would wait for it.
  void abort(int exit_code) const;

 private:
  int rank_ = 0, size_ = 1;
  int members_ = 1;  // that have not left, the first included
};

}  // namespace tenon
