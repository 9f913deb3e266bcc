#include "model/train/place.hpp"

#include <charconv>
#include <cstdlib>

#include "base/error.hpp"

namespace actformer::model {
namespace {

/// The names under which a launcher tells a process its place.
struct Launcher {
    const char *name, *rank, *size, *local, *local_size;
};
constexpr Launcher launchers[] = {
    {"torchrun", "RANK", "WORLD_SIZE", "LOCAL_RANK", "LOCAL_WORLD_SIZE"},
    {"Open MPI's mpirun", "OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE", "OMPI_COMM_WORLD_LOCAL_RANK",
     "OMPI_COMM_WORLD_LOCAL_SIZE"},
    {"mpirun", "PMI_RANK", "PMI_SIZE", "MPI_LOCALRANKID", "MPI_LOCALNRANKS"},
    {"srun", "SLURM_PROCID", "SLURM_NTASKS", "SLURM_LOCALID", "SLURM_NTASKS_PER_NODE"}};

constexpr std::uint16_t usual_port = 29500;

std::optional<int> number(const Variables& variables, const std::string& name, int most) {
    const auto text = variables(name);
    if (!text) return std::nullopt;
    int value = -1;
    const auto [end, error] = std::from_chars(text->data(), text->data() + text->size(), value);
    if (error != std::errc() || end != text->data() + text->size() || value < 0 || value > most)
        throw Error("{}={}: the launcher's variable must be a whole number up to {}", name, *text, most);
    return value;
}

const Launcher& launcher_of(const Variables& variables) {
    for (const auto& launcher : launchers)
        if (variables(launcher.rank) && variables(launcher.size)) return launcher;
    throw Error(
        "--data-parallel: started by no launcher; as in torchrun --no_python --nproc_per_node 2 actformer "
        "train generator ... --data-parallel, or with mpirun -n 2, or srun -n 2");
}

/// The first host of a list as Slurm writes it: node[07-09,12] begins with node07.
std::string first_host(const std::string& list) {
    const auto end = list.find_first_of("[,");
    auto host = list.substr(0, end);
    if (end != std::string::npos && list[end] == '[')
        host += list.substr(end + 1, list.find_first_of("-,]", end) - end - 1);
    return host;
}

/// The process's number on its machine: the launcher's, else srun's where it placed the process (PMI has none). Variables of srun in a batch
/// script are of the script itself: its number is not the process's.
std::optional<int> local_of(const Variables& variables, const Launcher& launcher, int rank, int most) {
    if (const auto local = number(variables, launcher.local, most)) return local;
    if (number(variables, "SLURM_PROCID", most) != rank) return std::nullopt;
    return number(variables, "SLURM_LOCALID", most);
}

std::string address_of(const Variables& variables, const Launcher& launcher, int size) {
    if (const auto given = variables("MASTER_ADDR")) return *given;
    const auto here = number(variables, launcher.local_size, 1 << 20);
    if (size == 1 || (here && *here == size) || variables("SLURM_NNODES") == "1") return "127.0.0.1";
    for (const auto* list : {"SLURM_STEP_NODELIST", "SLURM_NODELIST", "SLURM_JOB_NODELIST"})
        if (const auto hosts = variables(list)) return first_host(*hosts);
    if (const auto launching = variables("SLURM_LAUNCH_NODE_IPADDR")) return *launching;
    throw Error("{} does not say where rank 0 is; set MASTER_ADDR to its host (mpirun -x MASTER_ADDR=...)",
                launcher.name);
}

/// Jobs of Slurm may share a machine: each takes a port of its own.
std::uint16_t port_of(const Variables& variables) {
    if (const auto given = number(variables, "MASTER_PORT", 65535)) return static_cast<std::uint16_t>(*given);
    if (const auto job = number(variables, "SLURM_JOB_ID", 2147483647))
        return static_cast<std::uint16_t>(20000 + *job % 20000);
    return usual_port;
}

}  // namespace

Place place_of(const Variables& variables) {
    const auto& launcher = launcher_of(variables);
    constexpr int most = 1 << 20;
    Place place;
    place.rank = *number(variables, launcher.rank, most);
    place.size = *number(variables, launcher.size, most);
    place.local = local_of(variables, launcher, place.rank, most).value_or(place.rank);
    if (place.rank >= place.size)
        throw Error("{}={}, but {}={}: ranks run from 0 below the number of processes", launcher.rank,
                    place.rank, launcher.size, place.size);
    place.address = address_of(variables, launcher, place.size);
    place.port = port_of(variables);
    place.store_runs = variables("TORCHELASTIC_USE_AGENT_STORE") == "True";
    place.prefix = "actformer/" + variables("TORCHELASTIC_RESTART_COUNT").value_or("0");
    return place;
}

std::optional<std::string> environment(const std::string& name) {
    const auto* value = std::getenv(name.c_str());
    if (!value) return std::nullopt;
    return value;
}

}  // namespace actformer::model
