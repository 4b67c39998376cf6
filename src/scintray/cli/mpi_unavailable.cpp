#include "scintray/cli/mpi_ranks.hpp"
#include "scintray/core/error.hpp"

namespace scintray::cli {

std::unique_ptr<simulation::Ranks> mpi_ranks() {
  if (launched_processes() == 1) return nullptr;
  throw core::SystemError(
      "this scintray was built without MPI, and was started as one of several processes by mpirun or srun\n"
      "  hint: build it with MPI (libopenmpi-dev; SCINTRAY_MPI=ON), or run it with --shard K/N");
}

}  // namespace scintray::cli
