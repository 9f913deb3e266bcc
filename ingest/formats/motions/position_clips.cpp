#include "ingest/formats/motions/position_clips.hpp"

#include <algorithm>

#include "base/error.hpp"

namespace actformer::ingest {
namespace {

constexpr kernels::Smoothing smoothing{3, 12};  // as NTU's

using PositionClips = std::span<const PositionClip* const>;

kernels::ClipBatch batch_of(PositionClips clips, const DatasetHeader& header) {
    kernels::ClipBatch batch;
    batch.persons = header.persons;
    batch.joints = static_cast<std::uint32_t>(header.topology.joints());
    batch.first = {0};
    for (const auto* clip : clips) {
        batch.frames.push_back(clip->frames);
        batch.step.push_back(1);
        for (std::uint32_t p = 0; p < header.persons; ++p) {
            for (std::uint32_t t = 0; t < clip->frames; ++t) batch.times.push_back(static_cast<float>(t));
            batch.first.push_back(static_cast<std::uint32_t>(batch.times.size()));
        }
    }
    return batch;
}

/// The clips' values on the device, a person after the other, as the kernels want detections.
kernels::Buffer<float> by_person(kernels::Device& device, PositionClips clips,
                                 const kernels::ClipBatch& batch) {
    auto values = kernels::limb_buffer(device, batch.times.size(), batch.joints);
    values.write_with([&](std::span<float> to) {
        const std::size_t body = std::size_t{batch.joints} * 3;
        auto at = to.begin();
        for (const auto* clip : clips)
            for (std::size_t p = 0; p < batch.persons; ++p)
                for (std::size_t t = 0; t < clip->frames; ++t)
                    at = std::copy_n(clip->values.data() + (t * batch.persons + p) * body, body, at);
    });
    return values;
}

kernels::CleanedBatch limbs_of(kernels::Device& device, PositionClips clips, const DatasetHeader& header,
                               bool smooth) {
    const auto batch = batch_of(clips, header);
    if (smooth) return kernels::clean(device, batch, by_person(device, clips, batch), smoothing);
    auto rows = kernels::limb_buffer(device, batch.times.size(), batch.joints);
    rows.write_with([&](std::span<float> to) {
        auto at = to.begin();
        for (const auto* clip : clips) at = std::copy(clip->values.begin(), clip->values.end(), at);
    });
    return kernels::normalise(device, batch, {rows, batch.joints * 3});
}

/// Takes the mean root over all frames and persons from every joint of a clip.
void centre(std::span<float> values, const DatasetHeader& header) {
    const std::size_t body = header.topology.joints() * 3, bodies = values.size() / body;
    std::array<double, 3> mean{};
    for (std::size_t b = 0; b < bodies; ++b)
        for (std::size_t d = 0; d < 3; ++d) mean[d] += values[b * body + d] / static_cast<double>(bodies);
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = static_cast<float>(static_cast<double>(values[i]) - mean[i % 3]);
}

/// Positions, smoothed or not, about the clip's mean root.
kernels::CleanedBatch positions_of(kernels::Device& device, PositionClips clips, const DatasetHeader& header,
                                   bool smooth) {
    kernels::CleanedBatch out;
    const auto motion = std::make_shared<std::vector<float>>();
    for (const auto* clip : clips) {
        motion->insert(motion->end(), clip->values.begin(), clip->values.end());
        out.bone_length.insert(out.bone_length.end(), clip->bone_length.begin(), clip->bone_length.end());
    }
    if (smooth) {
        const auto batch = batch_of(clips, header);
        const auto rows = kernels::fill_and_smooth(device, batch, by_person(device, clips, batch), smoothing);
        const auto smoothed = rows.values.map();
        const std::size_t body = std::size_t{batch.joints} * 3;
        for (std::size_t b = 0; b < motion->size() / body; ++b)
            std::copy_n(smoothed.values().data() + b * rows.pitch, body, motion->data() + b * body);
    }
    std::size_t at = 0;
    for (const auto* clip : clips) {
        centre(std::span(*motion).subspan(at, clip->values.size()), header);
        at += clip->values.size();
    }
    out.motion = *motion;
    out.memory = motion;
    return out;
}

}  // namespace

void PositionClip::take(ClipPositions&& positions) {
    frames = positions.frames;
    values = std::move(positions.values);
    bone_length = std::move(positions.bone_length);
    positions.span.add_doubts(doubts);
    if (positions.filled) doubts.emplace_back("not seen all the time: filled in between");
}

/// Which axis of the recording each axis of the dataset is, from 1, negative where it points the other way.
std::array<int, 3> axes_below(Up up) {
    switch (up) {
        case Up::y:
            return {1, 2, 3};
        case Up::z:
            return {1, 3, -2};
        case Up::minus_y:
            return {1, -2, -3};
        case Up::minus_z:
            return {1, -3, 2};
        case Up::x:
            return {-2, 1, 3};
        case Up::minus_x:
            return {2, -1, 3};
    }
    return {1, 2, 3};
}

std::variant<std::unique_ptr<PositionClip>, Rejection> position_clip(const NumpyArray& array, Up up,
                                                                     const DatasetHeader& header) {
    if (array.shape.empty() || array.shape[0] == 0) throw Error("no frame");
    PositionsRequest request;
    request.topology = &header.topology;
    request.axes = axes_below(up);
    request.limbs = header.representation != Representation::xyz;
    auto read = read_positions(JointArray(array, header.topology.joints(), "tkc"), 0, request);
    if (auto* rejection = std::get_if<Rejection>(&read)) return std::move(*rejection);
    auto clip = std::make_unique<PositionClip>();
    clip->take(std::move(std::get<ClipPositions>(read)));
    return clip;
}

kernels::CleanedBatch cleaned(kernels::Device& device, std::span<const std::unique_ptr<RawClip>> clips,
                              const DatasetHeader& header, std::vector<std::uint32_t>& frames) {
    std::vector<const PositionClip*> positions;
    frames.clear();
    for (const auto& raw : clips) {
        positions.push_back(static_cast<const PositionClip*>(raw.get()));
        frames.push_back(positions.back()->frames);
    }
    return cleaned(device, positions, header, false);
}

kernels::CleanedBatch cleaned(kernels::Device& device, std::span<const PositionClip* const> clips,
                              const DatasetHeader& header, bool smooth) {
    return header.representation == Representation::xyz ? positions_of(device, clips, header, smooth)
                                                        : limbs_of(device, clips, header, smooth);
}

}  // namespace actformer::ingest
