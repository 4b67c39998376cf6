#pragma once
/// The processes that mpirun, or srun, has started, as ranks of a run.

#include <memory>

#include "scintray/simulation/ranks.hpp"

namespace scintray::cli {

/// Number of processes that this one was started with by a launcher of MPI, by its environment: Open MPI's
/// mpirun, PMIx, PMI (MPICH's mpiexec, Slurm's srun --mpi=pmi2). 1 without a launcher.
int launched_processes();

/// The ranks of this process's MPI_COMM_WORLD. MPI is initialised by the first call of a process that a
/// launcher started with others, and otherwise never, so that a single process has no overhead.
/// @return null for a process alone
/// @throws SystemError when MPI cannot be initialised, or when this program was built without it
std::unique_ptr<simulation::Ranks> mpi_ranks();

}  // namespace scintray::cli
