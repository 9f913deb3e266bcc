// What every trainer does alike. Includes torch headers: for model/'s own sources and tests only.
#pragma once

#include <ATen/ATen.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "ingest/dataset/dataset.hpp"
#include "ingest/dataset/view.hpp"
#include "model/train/trainer_settings.hpp"
#include "model/train/window_feed.hpp"

namespace actformer::model {

/// A well-mixed number for what is random in step `step`.
std::uint64_t step_seed(std::uint64_t seed, std::uint64_t step);

/// What step_seed() takes for a step where a generator's training draws for these parts; its generator's weights take the training's seed
/// itself. Scoring may share augmentation's number: it draws latents by what comes out, while augmentation mixes that with its own steps.
constexpr std::uint64_t latents_part = 0, discriminator_part = 1, augmentation_part = 2, scoring_part = 2;

/// Throws Error where this libtorch cannot work on `name`, as in "cpu" or "cuda:1"; `option` is what the user names it with.
at::Device torch_device(const std::string& name, const std::string& option = "device=");

/// For the whole process, which of a GPU's kernels a training takes: float32 is 24 bits everywhere but with `tf32`, also where libtorch
/// would have it otherwise; with `deterministic` what has no kernel of that kind is an error. Processors' kernels are exact and
/// deterministic as they are. Throws Error for `tf32` on a processor.
void set_tf32_and_determinism(const TrainerSettings& settings, const at::Device& device);

/// Of a configuration's "float32" or "float64".
at::ScalarType torch_type(const std::string& precision);

/// The one dataset at `data`, a configuration's key. Throws Error where it is empty or holds several.
ingest::Dataset dataset_to_train_on(const std::string& data);

/// The device that draws a training's windows, as the key `opencl` names it. None where that is `none`, or where nothing was named and
/// the machine has no OpenCL, which is noted: the processor draws the same windows then.
std::optional<kernels::Device> device_that_draws(const std::string& opencl,
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

/// Windows on their way to `device`: (count, channels, frames, joints) float32, and their labels (count) int64. On the
/// CPU the values are the feed's own memory, good until it moves on.
at::Tensor values_of(const Windows& windows, std::int64_t channels, std::int64_t frames, std::int64_t joints,
                     const at::Device& device);
at::Tensor labels_of(const Windows& windows, const at::Device& device);

}  // namespace actformer::model
