// Clips whose persons are seen in some frames and not in others, on their way to the device.
#pragma once

#include <algorithm>
#include <memory>
#include <span>
#include <vector>

#include "ingest/formats/format.hpp"
#include "kernels/cleaning.hpp"

namespace actformer::ingest {

/// What Format::clean returns for such clips: filled, smoothed and normalised. `Clip` has `frames`, and `bodies_of(clip)` its bodies, each
/// with `times`, rising, in frames, and `limbs` (times, joints, 3) in metres; as many bodies as `persons`.
template <typename Clip, typename BodiesOf>
kernels::CleanedBatch clean_detections(kernels::Device& device, std::uint32_t persons, std::uint32_t joints,
                                       std::span<const std::unique_ptr<RawClip>> clips, BodiesOf bodies_of,
                                       const kernels::Smoothing& smoothing,
                                       std::vector<std::uint32_t>& frames) {
    kernels::ClipBatch batch;
    batch.persons = persons;
    batch.joints = joints;
    batch.first = {0};
    for (const auto& raw : clips) {
        const auto& clip = static_cast<const Clip&>(*raw);
        batch.frames.push_back(clip.frames);
        batch.step.push_back(1);
        for (const auto& body : bodies_of(clip)) {
            for (const auto time : body.times) batch.times.push_back(static_cast<float>(time));
            batch.first.push_back(static_cast<std::uint32_t>(batch.times.size()));
        }
    }
    frames = batch.frames;
    auto limbs = kernels::limb_buffer(device, batch.times.size(), joints);
    limbs.write_with([&](std::span<float> to) {
        auto at = to.begin();
        for (const auto& raw : clips)
            for (const auto& body : bodies_of(static_cast<const Clip&>(*raw)))
                at = std::copy(body.limbs.begin(), body.limbs.end(), at);
    });
    return kernels::clean(device, batch, limbs, smoothing);
}

}  // namespace actformer::ingest
