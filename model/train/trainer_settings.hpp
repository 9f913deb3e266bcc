// What every training may be told: data, schedule, device.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "model/train/key_table.hpp"

namespace actformer::model {

struct TrainerSettings {
    std::string data, train_split = "all";
    std::uint32_t batch = 64, epochs = 1;  ///< batch: windows, of each process
    std::vector<std::int64_t> rate_drops;  ///< epochs done before the rates are multiplied by rate_factor
    double rate_factor = 1;
    double checkpoint_minutes = 5;
    bool tensorboard = false;  ///< curves for TensorBoard beside the log
    std::uint64_t seed = 0;
    std::string device = "cpu",
                opencl;  ///< of libtorch, as in "cuda:0"; of the sampler, as --device elsewhere
    bool tf32 = false, deterministic = false;  ///< of CUDA's kernels: see set_tf32_and_determinism()
    int threads = 0;                           ///< 0: as many as the process may use

    /// What the rates are multiplied by in epoch `epoch`, from 0: rate_factor once for every drop that has come.
    double rate_share(std::uint64_t epoch) const {
        double share = 1;
        for (const auto drop : rate_drops)
            if (epoch >= static_cast<std::uint64_t>(drop)) share *= rate_factor;
        return share;
    }
};

/// Their keys, for settings that begin with these.
template <typename Settings>
void add_trainer_keys(KeyTable<Settings>& table) {
    table.add(&Settings::data, {.name = "data", .meaning = "dataset folder", .free = true})
        .add(&Settings::train_split, {.name = "train_split", .meaning = "clips to train on"})
        .add(&Settings::batch,
             {.name = "batch", .meaning = "windows a batch, of each process", .least = 1, .most = 65536})
        .add(&Settings::epochs, {.name = "epochs",
                                 .meaning = "of as many windows as there are clips",
                                 .least = 1,
                                 .most = 1e9,
                                 .free = true})
        .add(&Settings::rate_drops,
             {.name = "rate_drops",
              .meaning = "epochs done before each drop of the learning rates, as in [10, 50]",
              .least = 0,
              .most = 1e9})
        .add(&Settings::rate_factor,
             {.name = "rate_factor", .meaning = "by which a drop multiplies them", .least = 0, .most = 1})
        .add(&Settings::checkpoint_minutes,
             {.name = "checkpoint_minutes",
              .meaning = "between checkpoints; 0 saves as often as losses are read",
              .least = 0,
              .most = 1e6,
              .free = true})
        .add(&Settings::tensorboard, {.name = "tensorboard",
                                      .meaning = "keep the curves as TensorBoard reads them, too",
                                      .free = true})
        .add(&Settings::seed, {.name = "seed", .meaning = "of all that is random", .least = 0, .most = 9e15})
        .add(&Settings::device,
             {.name = "device", .meaning = "where libtorch trains: cpu, cuda or cuda:N", .free = true})
        .add(&Settings::opencl, {.name = "opencl",
                                 .meaning = "OpenCL device that draws windows and scores; empty for the "
                                            "usual one; none: the processor draws",
                                 .free = true})
        .add(&Settings::tf32,
             {.name = "tf32", .meaning = "CUDA: products of float32 with 10 bits behind the point, faster"})
        .add(&Settings::deterministic,
             {.name = "deterministic", .meaning = "CUDA: only kernels that give the same bits every time"})
        .add(&Settings::threads, {.name = "threads",
                                  .meaning = "processor threads; 0 takes OMP_NUM_THREADS, else all",
                                  .least = 0,
                                  .most = 1024,
                                  .free = true});
}

}  // namespace actformer::model
