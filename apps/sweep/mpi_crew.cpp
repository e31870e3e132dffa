#include "tenon/apps/sweep/mpi_crew.hpp"

#define OMPI_SKIP_MPICXX 1  // the C interface alone
#include <mpi.h>

namespace tenon {

namespace {

enum Tag : int { kSeed, kRow, kEnd };

}  // namespace

MpiCrew::MpiCrew() {
  int provided = 0;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &size_);
  members_ = size_;
}

MpiCrew::~MpiCrew() {
  MPI_Finalize();
}

void MpiCrew::abort(int exit_code) const {
  MPI_Abort(MPI_COMM_WORLD, exit_code);
}

void MpiCrew::share(std::vector<std::uint64_t>& seeds) {
  std::uint64_t count = seeds.size();
  MPI_Bcast(&count, 1, MPI_UINT64_T, 0, MPI_COMM_WORLD);
  seeds.resize(count);
  MPI_Bcast(seeds.data(), static_cast<int>(count), MPI_UINT64_T, 0, MPI_COMM_WORLD);
}

void MpiCrew::send(std::uint64_t seed, const Vector& row) {
  MPI_Send(&seed, 1, MPI_UINT64_T, 0, kSeed, MPI_COMM_WORLD);
  MPI_Send(row.data(), static_cast<int>(row.size()), MPI_DOUBLE, 0, kRow, MPI_COMM_WORLD);
}

void MpiCrew::leave() {
  MPI_Send(nullptr, 0, MPI_BYTE, 0, kEnd, MPI_COMM_WORLD);
}

bool MpiCrew::receive(std::uint64_t& seed, Vector& row) {
  for (;;) {
    int is_there = 0;
    MPI_Status status;
    MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &is_there, &status);
    if (!is_there) return false;
    if (status.MPI_TAG == kSeed) {
      MPI_Recv(&seed, 1, MPI_UINT64_T, status.MPI_SOURCE, kSeed, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
      MPI_Recv(row.data(), static_cast<int>(row.size()), MPI_DOUBLE, status.MPI_SOURCE, kRow, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
      return true;
    }
    MPI_Recv(nullptr, 0, MPI_BYTE, status.MPI_SOURCE, kEnd, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    --members_;
  }
}

}  // namespace tenon
