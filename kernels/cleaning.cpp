#include "kernels/cleaning.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace actformer::kernels {
namespace {

/// Where each clip's frames lie, on the device.
struct FrameTable {
    FrameTable(Device& device, const ClipBatch& batch)
        : total(static_cast<std::uint32_t>(batch.total_frames())) {
        std::vector<std::uint32_t> starts{0}, owners;
        owners.reserve(total);
        for (std::uint32_t clip = 0; clip < batch.clips(); ++clip) {
            starts.push_back(starts.back() + batch.frames[clip]);
            owners.insert(owners.end(), batch.frames[clip], clip);
        }
        start = Buffer<std::uint32_t>(device, starts);
        owner = Buffer<std::uint32_t>(device, owners);
    }

    std::uint32_t total;
    Buffer<std::uint32_t> start;  ///< (clips + 1)
    Buffer<std::uint32_t> owner;  ///< (frames) clip of each
};

// Output frames that one work-item of smooth.cl makes.
constexpr std::uint32_t frames_a_block = 8;

/// A Gaussian that sums to one over its 2 * radius + 1 frames, between zeros for the frames out of a sum's reach.
std::vector<float> gaussian(const Smoothing& how) {
    const int radius = how.sigma > 0 ? static_cast<int>(how.radius) : 0;
    std::vector<double> taps;
    for (int r = -radius; r <= radius; ++r)
        taps.push_back(r == 0 ? 1 : std::exp(-0.5 * r * r / (double{how.sigma} * how.sigma)));
    const double sum = std::accumulate(taps.begin(), taps.end(), 0.0);
    std::vector<float> out(taps.size() + 2 * (frames_a_block - 1));
    std::transform(taps.begin(), taps.end(), out.begin() + frames_a_block - 1,
                   [sum](double tap) { return static_cast<float>(tap / sum); });
    return out;
}

/// (blocks) clip and first frame of every run of frames_a_block frames.
std::vector<cl_uint2> blocks_of(const ClipBatch& batch) {
    std::vector<cl_uint2> blocks;
    for (std::uint32_t clip = 0; clip < batch.clips(); ++clip)
        for (std::uint32_t frame = 0; frame < batch.frames[clip]; frame += frames_a_block)
            blocks.push_back({{clip, frame}});
    return blocks;
}

LimbRows fill_and_smooth(Device& device, const ClipBatch& batch, const FrameTable& table,
                         const Buffer<float>& limbs, const Smoothing& how) {
    const std::uint32_t numbers = batch.joints * 3, chunks = std::max(numbers + 15, 48U) / 16;
    const std::size_t rows = std::size_t{table.total} * batch.persons;
    const Buffer<float> times(device, batch.times), step(device, batch.step);
    const Buffer<std::uint32_t> first(device, batch.first);
    const Buffer<cl_uint2> pair(device, rows);
    const Buffer<float> weight(device, rows);
    launch(device, device.kernel("fill_gaps", "locate"), {batch.persons, table.total}, times, first,
           table.start, step, table.owner, pair, weight, batch.persons, table.total);

    const Buffer<float> taps(device, gaussian(how));
    const Buffer<cl_uint2> blocks(device, blocks_of(batch));
    // Times 8 frames in registers.
    const auto vec = how.vec != 0                       ? how.vec
                     : device.info().type != "CPU"      ? 4U
                     : device.info().vector_width >= 16 ? 16U
                                                        : 8U;
    const auto columns = chunks * 16 / vec;
    LimbRows out{Buffer<float>(device, rows * chunks * 16), chunks * 16};
    const auto count = static_cast<std::uint32_t>(blocks.size());
    launch(device, device.vector_kernel("smooth", "smooth", vec, fmt::format(" -DFRAMES={}", frames_a_block)),
           {std::size_t{batch.persons} * columns, count}, taps, blocks, table.start, pair, weight, limbs,
           out.values, how.sigma > 0 ? how.radius : 0U, batch.persons, columns, numbers, count);
    return out;
}

CleanedBatch normalise(Device& device, const ClipBatch& batch, const FrameTable& table,
                       const LimbRows& limbs) {
    const auto sequences = static_cast<std::uint32_t>(batch.clips()) * batch.persons;
    const std::uint32_t rows = table.total * batch.persons;
    const Buffer<float> bones(device, std::size_t{sequences} * batch.joints);
    const Buffer<cl_float4> roots(device, sequences);
    const Buffer<float> motion(device, std::size_t{rows} * batch.joints * 3);

    launch(device, device.kernel("normalise", "means"), {(batch.joints + 15) / 16, sequences}, limbs.values,
           table.start, bones, roots, batch.persons, batch.joints, limbs.pitch, sequences);
    launch(device, device.kernel("normalise", "unit_limbs"), {rows, 1}, limbs.values, table.owner, roots,
           motion, batch.persons, batch.joints, limbs.pitch, rows);
    auto memory = std::make_shared<Mapping<float>>(motion.map());
    return {memory->values(), bones.download(), memory};
}

}  // namespace

std::size_t ClipBatch::total_frames() const {
    return std::accumulate(frames.begin(), frames.end(), std::size_t{0});
}

Buffer<float> limb_buffer(Device& device, std::size_t detections, std::uint32_t joints) {
    constexpr std::size_t spare = 48;  // a row is read in vectors of 16 numbers, three at least
    return {device, detections * joints * 3, spare};
}

LimbRows fill_and_smooth(Device& device, const ClipBatch& batch, const Buffer<float>& limbs,
                         const Smoothing& how) {
    return fill_and_smooth(device, batch, FrameTable(device, batch), limbs, how);
}

CleanedBatch normalise(Device& device, const ClipBatch& batch, const LimbRows& limbs) {
    return normalise(device, batch, FrameTable(device, batch), limbs);
}

CleanedBatch clean(Device& device, const ClipBatch& batch, const Buffer<float>& limbs, const Smoothing& how) {
    const FrameTable table(device, batch);
    return normalise(device, batch, table, fill_and_smooth(device, batch, table, limbs, how));
}

}  // namespace actformer::kernels
