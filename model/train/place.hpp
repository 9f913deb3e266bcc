// A process's place among those that a launcher started: torchrun, mpirun or srun.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

namespace actformer::model {

struct Place {
    int rank = 0, size = 1;
    int local = 0;            ///< rank among those of the same machine: which GPU to take
    std::string address;      ///< where rank 0 is
    std::uint16_t port = 0;   ///< where the processes find one another
    bool store_runs = false;  ///< the launcher itself listens there (torchrun)
    std::string prefix;       ///< of the names kept there

    bool leads() const { return rank == 0; }
};

/// A variable of the environment; none where it is not set.
using Variables = std::function<std::optional<std::string>(const std::string&)>;

/// Reads RANK, WORLD_SIZE, LOCAL_RANK, MASTER_ADDR and MASTER_PORT as torchrun sets them; else what mpirun (Open MPI, MPICH,
/// Intel) or srun say, with MASTER_ADDR and MASTER_PORT on top where they are set. Throws Error where no launcher is
/// seen, a variable holds no number, or the address of rank 0 cannot be told.
Place place_of(const Variables& variables);

/// The process's own environment.
std::optional<std::string> environment(const std::string& name);

}  // namespace actformer::model
