#include <charconv>
#include <cstdlib>
#include <string_view>

#include "scintray/cli/mpi_ranks.hpp"

namespace scintray::cli {

namespace {

/// A count in the environment; 1 where there is none.
int count_in(const char* variable) {
  const char* text = std::getenv(variable);
  int count = 1;
  if (text) std::from_chars(text, text + std::string_view(text).size(), count);
  return count < 1 ? 1 : count;
}

}  // namespace

int launched_processes() {
  // Open MPI's mpirun; PMI-1 and PMI-2 (MPICH's mpiexec, Slurm); a PMIx server states only the rank, and
  // Slurm, which is one, the number of tasks of the step.
  for (const char* variable : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"})
    if (const int count = count_in(variable); count > 1) return count;
  return std::getenv("PMIX_RANK") ? count_in("SLURM_STEP_NUM_TASKS") : 1;
}

}  // namespace scintray::cli
