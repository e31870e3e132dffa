// Those who share a sweep: one process alone, or the processes of an `mpirun`. The first one keeps the record.
#pragma once

#include <cstdint>
#include <vector>

#include "tenon/core/eigen.hpp"

namespace tenon {

/// A crew of one, and the face of larger ones. Called from one thread only.
class Crew {
 public:
  virtual ~Crew() = default;

  virtual int rank() const { return 0; }
  virtual int size() const { return 1; }
  bool is_first() const { return rank() == 0; }

  /// What the first has, to all; called by all.
  virtual void share(std::vector<std::uint64_t>& seeds) { static_cast<void>(seeds); }

  /// Of all but the first: a row for the record; and that no more will come.
  virtual void send(std::uint64_t seed, const Vector& row) { static_cast<void>(seed), static_cast<void>(row); }
  virtual void leave() {}

  /// Of the first: a row that has arrived, if one has. `row` has the right size.
  virtual bool receive(std::uint64_t& seed, Vector& row) {
    static_cast<void>(seed), static_cast<void>(row);
    return false;
  }
  /// Of the first: the others have all left.
  virtual bool is_alone() const { return true; }
};

}  // namespace tenon
