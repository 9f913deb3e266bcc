// A training's dataset and split, and the device that draws windows from it.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "ingest/dataset/dataset.hpp"
#include "ingest/dataset/view.hpp"
#include "model/train/trainer_settings.hpp"

namespace actformer::model {

/// The one dataset at `data`, a configuration's key. Throws Error where it is empty or holds several.
ingest::Dataset dataset_to_train_on(const std::string& data);

/// Index into `devices` of the one that process `local` of a machine draws on, where `opencl` (else ACTFORMER_DEVICE) names one of them: by a
/// number it is the same for all; else those of the chosen one's type and driver take turns from it on, with memory of their own as it has, and
/// called so where part of a name is given. Throws Error as choose_device does.
std::size_t device_of_process(const std::vector<kernels::DeviceInfo>& devices, const std::string& opencl,
                              int local);

/// The device that draws the windows of a training's process `local` on this machine (Place), as the key `opencl` names it. None where that is
/// `none`, or where nothing was named and the machine has no OpenCL, which is noted: the processor draws the same windows then.
std::optional<kernels::Device> device_that_draws(const std::string& opencl, int local,
                                                 const std::function<void(const std::string&)>& note);

/// Throws Error with the remedy where `dataset` has no split `split`, which the configuration's `key` names.
void check_split(const ingest::Dataset& dataset, const std::string& key, const std::string& split);

/// A split to draw from, on that device.
ingest::View view_to_draw(std::optional<kernels::Device>& device, const ingest::Dataset& dataset,
                          const std::string& split, ingest::Joints joints = ingest::Joints::own);

/// Notes on what a training trains: split, clips and windows an epoch, then `tests`; and where it takes all clips of a dataset that has a split
/// `train`, that it does. `note` may be empty.
void tell_split(const ingest::Dataset& dataset, const TrainerSettings& settings, std::uint64_t clips,
                std::uint64_t windows_a_step, const std::string& tests,
                const std::function<void(const std::string&)>& note);

}  // namespace actformer::model
