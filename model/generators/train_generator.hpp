// Training a generator of any method.
#pragma once

#include <filesystem>

#include "model/train/config.hpp"
#include "model/train/training_events.hpp"

namespace actformer::model {

/// Trains as train() of model/train/trainer.hpp says; with `recogniser` generated motions are scored during training, by
/// the recogniser's accuracy and Fréchet distances. Where an EMA is kept it is what is scored.
///
/// With `data_parallel`, as one of the processes that torchrun, mpirun or srun started (see place_of).
TrainingResult train_generator(const Config& config, const std::filesystem::path& run, bool data_parallel,
                               const TrainingEvents& events);

}  // namespace actformer::model
